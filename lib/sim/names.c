#include "names_internal.h"

void wh_names_put(const wh_event_names_t *names, wh_words_t *words, wh_name_kind_t kind, int32_t index) {
    static const char *const kinds[] = {"wafer ", "gripper ", "part "};
    const char *name = names->find ? names->find(names->user, kind, index) : NULL;
    if (name) {
        wh_words_put(words, name);
    } else if (index == WH_NONE) {
        wh_words_put(words, "none");
    } else {
        wh_words_put(words, kinds[kind]);
        wh_words_integer(words, (int64_t)index + names->first);
    }
}
