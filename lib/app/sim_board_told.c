#include "sim_board_told.h"

#include <inttypes.h>
#include <stdio.h>

#include "app.h"
#include "connection.h"

/* ------------------------------------------------------------------------------------------------ verdict */

static int64_t slices_of(const wh_sim_board_told_t *told) {
    return wh_plant_slice(told->plant);
}

/* Counts of which each fails a run, unless it is lenient and they are of the line, and their words. */
typedef struct {
    uint64_t count;
    const char *one, *many;
    bool is_of_line;
} reason_t;

enum { REASONS = 10 };

static void list_reasons(const wh_sim_board_told_t *told, reason_t reasons[REASONS]) {
    const wh_exchange_counters_t *c = &told->exchange->counters;
    const wh_plant_found_t *found = &told->plant->found;
    const reason_t all[REASONS] = {
        {found->complaints, "complaint of the cell", "complaints of the cell", false},
        {found->refused, "command whose axes were refused", "commands whose axes were refused", false},
        {found->jumps, "jump of an axis", "jumps of an axis", true},
        {c->held, "slice without an answer in time", "slices without an answer in time", true},
        {told->in->damaged, "damaged frame", "damaged frames", true},
        {c->frames[WH_EXCHANGE_OTHER_AXES], "command of another number of axes",
         "commands of another number of axes", true},
        {c->frames[WH_EXCHANGE_UNKNOWN], "answer to a state that was not sent",
         "answers to states that were not sent", true},
        {c->resets, "reset of the board", "resets of the board", true},
        {told->line->unsent, "state that the line did not take", "states that the line did not take", true},
        {(uint64_t)told->pacing->late, "slice that began late here", "slices that began late here", true}};
    for (size_t i = 0; i < REASONS; ++i) {
        reasons[i] = all[i];
    }
}

/* Why the run ended before its time, or did not begin; null: it did neither. */
static const char *find_end(const wh_sim_board_told_t *told) {
    if (slices_of(told) == 0) {
        return "no answer of a board came: nothing was simulated";
    }
    if (told->is_gone || told->is_silent) {
        return told->is_gone ? "the serial line was gone before the end" : "the board fell silent";
    }
    if (told->is_cut) {
        return "a signal came before the end of --seconds";
    }
    return told->refusal != WH_OK ? wh_status_text(told->refusal) : NULL;
}

/* Writes why the run failed; an empty text: it passed. */
static void find_reason(const wh_sim_board_told_t *told, char *text, size_t size) {
    const char *end = find_end(told);
    reason_t reasons[REASONS];
    list_reasons(told, reasons);
    (void)snprintf(text, size, "%s", end ? end : "");
    for (size_t i = 0; i < REASONS && text[0] == '\0'; ++i) {
        if (reasons[i].count > 0 && !(reasons[i].is_of_line && told->lenient)) {
            (void)snprintf(text, size, "%" PRIu64 " %s", reasons[i].count,
                           reasons[i].count == 1 ? reasons[i].one : reasons[i].many);
        }
    }
}

/* ------------------------------------------------------------------------------------------------- people */

static void say_line(const wh_sim_board_told_t *told, const wh_node_t *node) {
    const wh_exchange_counters_t *c = &told->exchange->counters;
    const uint64_t lost = wh_exchange_lost(told->exchange);
    const uint64_t late = c->held - lost;
    const uint64_t answered = (uint64_t)slices_of(told) - c->held;
    wh_node_say(node,
                "%" PRIu64 " slice%s answered in time, %" PRIu64 " held: %" PRIu64 " late, %" PRIu64
                " lost; %" PRIu64 " answer%s lost on the way",
                answered, WH_PLURAL(answered), c->held, late, lost, c->lost_answers,
                WH_PLURAL(c->lost_answers));
    wh_node_say(node,
                "frames: %" PRIu32 " damaged, %" PRIu64 " doubled, %" PRIu64 " of other runs, %" PRIu64
                " of other machines, %" PRIu64 " of strangers, %" PRIu64 " not sent; %" PRIu32
                " byte%s of no frame; %" PRIu64 " reset%s of the board",
                told->in->damaged, c->frames[WH_EXCHANGE_DOUBLED], c->frames[WH_EXCHANGE_UNKNOWN],
                c->frames[WH_EXCHANGE_OTHER_AXES], told->strangers + told->line->refused, told->line->unsent,
                told->in->skipped, WH_PLURAL(told->in->skipped), c->resets, WH_PLURAL(c->resets));
    if (c->answers > 0) {
        wh_node_say(node, "answers took %.3f ms in the mean, %.3f ms at most",
                    (double)c->sum_us / (double)c->answers / 1e3, (double)c->slowest_us / 1e3);
    }
}

static void say_clock(const wh_sim_board_told_t *told, const wh_node_t *node) {
    const wh_pacing_t *p = told->pacing;
    if (told->lockstep) {
        wh_node_say(node, "the wall clock was not looked at (--lockstep)");
    } else if (told->begun_us > 0) {
        wh_node_say(node,
                    "clock: %" PRId64
                    " slice%s began late here, the latest by %.3f ms; later ones were moved "
                    "by %.3f ms in all",
                    p->late, WH_PLURAL(p->late), (double)p->latest_us / 1e3, (double)p->moved_us / 1e3);
    }
}

/* Frames have no place for some things: nobody is to take them as looked at. */
static void say_unlooked(const wh_sim_board_told_t *told, const wh_node_t *node) {
    const wh_layout_t *layout = told->plant->layout;
    if (!layout->collision) {
        wh_node_say(node, "collisions were not looked for: the layout has no collision = true");
    }
    if (layout->beam_count + layout->scanner_count > 0) {
        wh_node_say(node, "%zu beam%s and %zu edge sensor%s were not armed: no frame has an order for them",
                    layout->beam_count, WH_PLURAL(layout->beam_count), layout->scanner_count,
                    WH_PLURAL(layout->scanner_count));
    }
}

static void say_all(const wh_sim_board_told_t *told, const char *reason) {
    const wh_node_t *node = told->plant->simulation->node;
    const int64_t wall_us = told->begun_us > 0 ? told->ended_us - told->begun_us : 0;
    const int64_t slices = slices_of(told);
    wh_node_say(node, "%" PRId64 " slice%s, %.3f s simulated in %.3f s, hash %016" PRIx64, slices,
                WH_PLURAL(slices), (double)(slices * told->plant->layout->slice_us) / 1e6,
                (double)wall_us / 1e6, wh_protocol_server_hash(&told->plant->simulation->server));
    say_line(told, node);
    say_clock(told, node);
    say_unlooked(told, node);
    if (reason[0] == '\0') {
        wh_node_say(node, "passed%s",
                    told->lenient ? ", whatever frames, board and clock did (--lenient)" : "");
    } else {
        wh_node_warn(node, "failed: %s", reason);
    }
}

/* ----------------------------------------------------------------------------------------------- programs */

static json_t *whole(uint64_t value) {
    return json_integer((json_int_t)value);
}

json_t *wh_sim_board_counts(const wh_plant_found_t *found) {
    json_t *events = json_object();
    for (size_t kind = 0; kind < WH_EVENT_KINDS; ++kind) {
        if (found->events[kind] > 0) {
            wh_json_put(events, wh_event_name((wh_event_kind_t)kind), whole(found->events[kind]));
        }
    }
    if (found->jammed > 0) {
        wh_json_put(events, "jammed", whole(found->jammed));
    }
    if (found->missed > 0) {
        wh_json_put(events, "missed", whole(found->missed));
    }
    return events;
}

static void add_line(const wh_sim_board_told_t *told, json_t *root) {
    const wh_exchange_counters_t *c = &told->exchange->counters;
    const uint64_t lost = wh_exchange_lost(told->exchange);
    (void)wh_json_add(root, "answered held late lost lost_answers doubled",
                      whole((uint64_t)slices_of(told) - c->held), whole(c->held), whole(c->held - lost),
                      whole(lost), whole(c->lost_answers), whole(c->frames[WH_EXCHANGE_DOUBLED]), NULL);
    (void)wh_json_add(root, "damaged skipped_bytes unknown other_axes strangers unsent resets",
                      whole(told->in->damaged), whole(told->in->skipped),
                      whole(c->frames[WH_EXCHANGE_UNKNOWN]), whole(c->frames[WH_EXCHANGE_OTHER_AXES]),
                      whole(told->strangers + told->line->refused), whole(told->line->unsent),
                      whole(c->resets), NULL);
    (void)wh_json_add(root, "answer_mean_s answer_most_s",
                      c->answers > 0 ? wh_json_real((double)c->sum_us / (double)c->answers / 1e6)
                                     : json_null(),
                      c->answers > 0 ? wh_json_real((double)c->slowest_us / 1e6) : json_null(), NULL);
}

static bool print_told(const wh_sim_board_told_t *told, const char *reason) {
    const wh_protocol_server_t *server = &told->plant->simulation->server;
    const wh_plant_found_t *found = &told->plant->found;
    const wh_pacing_t *pacing = told->pacing;
    json_t *root =
        wh_json_add(json_object(), "layout layout_hash run slices hash ok reason lenient lockstep",
                    wh_json_text(server->layout->path), wh_json_hash(server->identity.layout_hash),
                    wh_json_hash((uint64_t)told->plant->identity.run), json_integer(slices_of(told)),
                    wh_json_hash(wh_protocol_server_hash(server)), json_boolean(reason[0] == '\0'),
                    reason[0] == '\0' ? json_null() : wh_json_text(reason), json_boolean(told->lenient),
                    json_boolean(told->lockstep), NULL);
    add_line(told, root);
    (void)wh_json_add(root, "late_slices latest_s moved_s",
                      told->lockstep ? json_null() : json_integer(pacing->late),
                      told->lockstep ? json_null() : wh_json_real((double)pacing->latest_us / 1e6),
                      told->lockstep ? json_null() : wh_json_real((double)pacing->moved_us / 1e6), NULL);
    (void)wh_json_add(root, "complaints refused jumps events", whole(found->complaints),
                      whole(found->refused), whole(found->jumps), wh_sim_board_counts(found), NULL);
    return wh_app_is_printed(wh_json_print(root, stdout));
}

int wh_sim_board_tell(wh_sim_board_told_t *told, bool json) {
    char reason[WH_PLANT_TEXT];
    find_reason(told, reason, sizeof reason);
    if (slices_of(told) > 0) {
        wh_plant_tell_over(told->plant, reason[0] == '\0', reason);
    }
    say_all(told, reason);
    if (json && !print_told(told, reason)) {
        return WH_EXIT_USAGE;
    }
    if (slices_of(told) == 0 || told->is_silent) {
        return WH_EXIT_NO_ANSWER;
    }
    return reason[0] == '\0' ? WH_EXIT_MET : WH_EXIT_FAILED;
}
