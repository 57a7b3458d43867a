#include "unlooked.h"

static void put(const wh_print_unlooked_t *unlooked, const char *text, size_t count, const char *why,
                FILE *out) {
    if (count > 0) {
        fprintf(out, "%s%s in %zu %s%s: %s\n", unlooked->before, text, count, unlooked->what,
                count == 1 ? "" : "s", why);
    }
}

void wh_print_unlooked_add(wh_print_unlooked_t *unlooked, const wh_sweep_point_t *point) {
    if (point->verdict == WH_SWEEP_OK || point->verdict == WH_SWEEP_FAILED) {
        unlooked->unchecked += !point->checked && !point->is_timed ? 1 : 0;
        unlooked->timed += point->is_timed ? 1 : 0;
        unlooked->partly += point->has_timed ? 1 : 0;
        unlooked->cut += point->is_cut ? 1 : 0;
    }
}

void wh_print_unlooked(const wh_print_unlooked_t *unlooked, FILE *out) {
    put(unlooked, "collisions were not looked for", unlooked->unchecked, "the layout has no collision = true",
        out);
    put(unlooked, "places, ways and collisions were not looked for", unlooked->timed,
        "the robots are times alone", out);
    put(unlooked, "places, ways and collisions of some robots were not looked for", unlooked->partly,
        "they are times alone", out);
    put(unlooked, "the flow was cut", unlooked->cut, "wafers are not at their ends", out);
}
