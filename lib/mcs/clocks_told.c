/* Events of stations that take time: each is kept and told, and some fail the run by name. */
#include <stdio.h>

#include "clocks.h"
#include "flow_played.h"
#include "ports.h"

#define TEXT_BYTES 500

static const char *station_name(const struct wh_clocks *clocks, const wh_clocked_t *of) {
    return clocks->mcs->layout->stations[of->station].name;
}

static const char *wafer_name(const struct wh_clocks *clocks, int32_t wafer) {
    return clocks->mcs->layout->wafers[wafer].name;
}

/* The line of the command that runs, or of the last one. */
static int line_of(const wh_mcs_t *mcs) {
    const wh_record_t *record = mcs->recorder.record;
    if (mcs->recorder.running != WH_NONE) {
        return record->commands[mcs->recorder.running].line;
    }
    return record->command_count > 0 ? record->commands[record->command_count - 1].line : 0;
}

void wh_clocks_imply(const wh_mcs_t *mcs, const char *text, bool ok) {
    wh_record_add_implied(mcs->recorder.record, line_of(mcs), text, ok);
    if (!ok) {
        wh_mcs_tell(mcs, WH_MCS_EXPECTED, NULL);
    }
}

static void judge_stay(const struct wh_clocks *clocks, const wh_clocked_t *of, int32_t wafer,
                       double stay_us) {
    char text[TEXT_BYTES];
    if (of->of.window_us == WH_FLOW_NEVER || clocks->state->tells_late) {
        return;
    }
    const double over_us = stay_us - (double)of->of.window_us;
    const int length =
        snprintf(text, sizeof text, "%s leaves %s at most %.10g s after its process",
                 wafer_name(clocks, wafer), station_name(clocks, of), (double)of->of.window_us / 1e6);
    if (over_us > 0) {
        snprintf(text + length, sizeof text - (size_t)length, "; it stayed %.10g s, %.10g s too long",
                 stay_us / 1e6, over_us / 1e6);
    }
    wh_clocks_imply(clocks->mcs, text, over_us <= 0);
}

static void judge_cut(const struct wh_clocks *clocks, const wh_clocked_t *of, const wh_clock_event_t *event) {
    char text[TEXT_BYTES];
    const bool is_clean = event->kind == WH_CLOCK_CLEAN_CUT;
    const wh_clock_place_t *place = &clocks->places[of->first + (size_t)event->slot];
    const bool lies = clocks->seen[of->first + (size_t)event->slot].wafer == event->wafer;
    snprintf(text, sizeof text, "the %s %s in %s comes to its end; the wafer %s after %.10g of %.10g s",
             is_clean ? "clean around" : "process of", wafer_name(clocks, event->wafer),
             station_name(clocks, of), lies ? "came to lie badly" : "was taken", (double)event->us / 1e6,
             (double)(is_clean ? of->of.clean_us : wh_clock_process_us(&of->of, place)) / 1e6);
    wh_clocks_imply(clocks->mcs, text, false);
}

static void judge_unprocessed(const struct wh_clocks *clocks, const wh_clocked_t *of,
                              const wh_clock_event_t *event) {
    char text[TEXT_BYTES];
    if (clocks->places[of->first + (size_t)event->slot].is_forced) {
        return;
    }
    snprintf(text, sizeof text,
             "the process of %s in %s comes to its end; the wafer was taken before it began",
             wafer_name(clocks, event->wafer), station_name(clocks, of));
    wh_clocks_imply(clocks->mcs, text, false);
}

static void judge_missed(const struct wh_clocks *clocks, const wh_clocked_t *of,
                         const wh_clock_event_t *event) {
    char text[TEXT_BYTES];
    const bool runs = clocks->places[of->first + (size_t)event->slot].phase == WH_CLOCK_CLEANING;
    snprintf(text, sizeof text, "%s comes into %s slot %d when it is clean; it came %s, %.10g s",
             wafer_name(clocks, event->wafer), station_name(clocks, of), (int)event->slot + 1,
             runs ? "before the end of a clean" : "in place of a clean", (double)event->us / 1e6);
    wh_clocks_imply(clocks->mcs, text, false);
}

void wh_clocks_tell(void *user, const wh_clock_event_t *event) {
    const wh_clocks_telling_t *telling = user;
    const struct wh_clocks *clocks = telling->clocks;
    wh_record_add_station_event(clocks->mcs->recorder.record,
                                &(wh_station_event_record_t){telling->of->station, *event});
    wh_mcs_tell(clocks->mcs, WH_MCS_STATION_TOLD, NULL);
    const bool is_judged = wh_flow_played_hear(clocks->mcs, telling, event);
    if (event->kind == WH_CLOCK_TAKEN && !is_judged) {
        judge_stay(clocks, telling->of, event->wafer, (double)event->us);
    } else if (event->kind == WH_CLOCK_PROCESS_CUT || event->kind == WH_CLOCK_CLEAN_CUT) {
        judge_cut(clocks, telling->of, event);
    } else if (event->kind == WH_CLOCK_UNPROCESSED) {
        judge_unprocessed(clocks, telling->of, event);
    } else if (event->kind == WH_CLOCK_CLEAN_MISSED) {
        judge_missed(clocks, telling->of, event);
    }
}

/* A wafer that is neither in its slot nor held has stayed until it was moved. */
static void judge_place(const struct wh_clocks *clocks, const wh_clocked_t *of, int32_t slot) {
    const wh_clock_place_t *place = &clocks->places[of->first + (size_t)slot];
    wh_clocks_telling_t telling = {clocks, of};
    const wh_clock_teller_t teller = {wh_clocks_tell, &telling};
    if (place->wafer == WH_FLOW_NONE) {
        return;
    }
    const bool lies = !place->is_away || clocks->mcs->state.wafers[place->wafer].holder != WH_NONE;
    const int64_t stay_us = wh_clock_judge(&of->of, place, slot, lies, clocks->state->utime, &teller);
    if (stay_us > of->of.window_us) {
        judge_stay(clocks, of, place->wafer, (double)stay_us);
    }
}

void wh_mcs_judge_stays(const wh_mcs_t *mcs) {
    const struct wh_clocks *clocks = mcs->clocks;
    for (size_t i = 0; clocks && i < clocks->count; ++i) {
        for (int32_t slot = 0; slot < clocks->of[i].of.slots; ++slot) {
            judge_place(clocks, &clocks->of[i], slot);
        }
    }
    wh_ports_judge(clocks ? clocks->ports : NULL);
}
