#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../text/array.h"
#include "calls.h"
#include "failed.h"
#include "flow.h"
#include "safe.h"
#include "transfer.h"

typedef struct {
    char *text;
    size_t length, capacity;
} text_t;

__attribute__((format(printf, 2, 3))) static void say(text_t *text, const char *format, ...) {
    char part[300];
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(part, sizeof part, format, arguments);
    va_end(arguments);
    const size_t more = length < (int)sizeof part ? (size_t)length : sizeof part - 1;
    text->text = wh_array_reserve(text->text, text->length + more + 1, &text->capacity, 1);
    memcpy(text->text + text->length, part, more + 1);
    text->length += more;
}

static const char *station_name(const wh_flow_state_t *state, int32_t station) {
    return state->tool->stations[station].name;
}

/* A wafer that stands in the way of this one in a station, or WH_FLOW_NONE: there is room. */
static int32_t find_other(const wh_flow_state_t *state, int32_t wafer, const wh_flow_station_t *station) {
    int32_t other = WH_FLOW_NONE;
    const int32_t end = wh_flow_end_of(state->plan, wafer, wh_flow_next_step(state, wafer));
    for (int32_t p = station->first_place; p < station->first_place + station->slots; ++p) {
        const wh_flow_place_t *place = &state->places[p];
        const int32_t here = place->wafer != WH_FLOW_NONE ? place->wafer : place->coming;
        if (end != WH_FLOW_NONE && end != p) {
            continue;
        }
        if (here == WH_FLOW_NONE || here == wafer) {
            return WH_FLOW_NONE;
        }
        other = other == WH_FLOW_NONE ? here : other;
    }
    return other;
}

/* The robot that would carry the wafer, whose arms are all taken, or WH_FLOW_NONE: one of them has a free
 * one. */
static int32_t find_laden(const wh_flow_state_t *state, int32_t wafer) {
    int32_t laden = WH_FLOW_NONE;
    for (int32_t r = 0; r < (int32_t)state->tool->robot_count; ++r) {
        if (wh_flow_is_carrier(state, r, wafer)) {
            if (wh_flow_free_arm(state, r, wafer) != WH_FLOW_NONE) {
                return WH_FLOW_NONE;
            }
            laden = r;
        }
    }
    return laden;
}

static void say_laden(const wh_flow_state_t *state, int32_t robot, text_t *text) {
    const wh_flow_robot_state_t *at = &state->robots[robot];
    const int32_t has = at->arms[0] != WH_FLOW_NONE ? at->arms[0] : at->arms[1];
    say(text, ", and for %s, which has %s", state->tool->robots[robot].name,
        has == WH_FLOW_NONE ? "no arm for it" : state->plan->wafers[has].name);
}

/* The pressure of a lock, if that is not the one of a robot that would carry the wafer. `lies`: out of it. */
static void say_pressure(const wh_flow_state_t *state, int32_t wafer, int32_t station, bool lies,
                         text_t *text) {
    const wh_flow_tool_t *tool = state->tool;
    const wh_flow_side_t side = state->stations[station].side;
    bool is_other = false;
    for (int32_t r = 0; r < (int32_t)tool->robot_count; ++r) {
        const bool goes = lies ? wh_flow_is_carrier(state, r, wafer)
                               : state->wafers[wafer].robot == r || wh_flow_is_carrier(state, r, wafer);
        const size_t of = wh_flow_of(tool, r, station);
        is_other = is_other || (goes && tool->serves[of] && !wh_flow_sides_agree(tool->sides[of], side));
    }
    if (tool->stations[station].is_lock && is_other) {
        say(text, " (at %s)", wh_flow_side_words[side]);
    }
}

static void say_down(const wh_flow_state_t *state, int32_t station, text_t *text) {
    if (state->stations[station].down_us != WH_FLOW_NEVER) {
        say(text, " (down for ever)");
    }
    if (wh_flow_is_port_shut(state, station)) {
        say(text, " (no carrier is open there)");
    }
}

/* A wafer that could not come to its end if this one went to a free place of the station: `safe` leaves that
 * out. WH_FLOW_NONE: it may go to one, none is free, or nobody looks. */
static int32_t find_shut_in(const wh_flow_state_t *state, int32_t wafer, const wh_flow_station_t *station) {
    int32_t shut_in = WH_FLOW_NONE;
    const int32_t end = wh_flow_end_of(state->plan, wafer, wh_flow_next_step(state, wafer));
    for (int32_t p = station->first_place; p < station->first_place + station->slots; ++p) {
        const wh_flow_into_t into = {wafer, p};
        const bool is_free =
            state->places[p].wafer == WH_FLOW_NONE && state->places[p].coming == WH_FLOW_NONE;
        if (!state->checks_safety || !is_free || (end != WH_FLOW_NONE && end != p)) {
            continue;
        }
        const int32_t blocked = wh_flow_find_blocked(state, &into, 1);
        if (blocked == WH_FLOW_NONE) {
            return WH_FLOW_NONE;
        }
        shut_in = shut_in == WH_FLOW_NONE ? blocked : shut_in;
    }
    return shut_in;
}

/* The wafer whose way would be closed, and who is at its end, if somebody is. */
static void say_shut_in(const wh_flow_state_t *state, int32_t wafer, text_t *text) {
    const int32_t back = state->plan->wafers[wafer].back;
    const int32_t there = back == WH_FLOW_NONE ? WH_FLOW_NONE : state->places[back].wafer;
    say(text, " (free, but safe keeps it out: %s could not come to its end", state->plan->wafers[wafer].name);
    if (there != WH_FLOW_NONE && there != wafer) {
        say(text, ", %s slot %d, where %s is)", station_name(state, state->tool->place_stations[back]),
            (int)wh_flow_slot(state->tool, back), state->plan->wafers[there].name);
    } else {
        say(text, " then)");
    }
}

/* "waits for B, where W1 is" */
static void say_next(const wh_flow_state_t *state, int32_t wafer, int32_t number, text_t *text) {
    const wh_flow_station_t *station = &state->tool->stations[number];
    const int32_t other = find_other(state, wafer, station);
    say(text, "%s", station->name);
    say_down(state, number, text);
    say_pressure(state, wafer, number, false, text);
    if (other != WH_FLOW_NONE) {
        say(text, ", where %s is", state->plan->wafers[other].name);
        return;
    }
    const int32_t shut_in = find_shut_in(state, wafer, station);
    if (shut_in != WH_FLOW_NONE) {
        say_shut_in(state, shut_in, text);
    }
}

/* "W2 in X waits for B, where W1 is" */
static void say_wafer(const wh_flow_state_t *state, int32_t wafer, text_t *text) {
    const wh_flow_wafer_state_t *at = &state->wafers[wafer];
    const int32_t step = wh_flow_next_step(state, wafer);
    const wh_flow_step_t *next = step == WH_FLOW_NONE ? NULL : wh_flow_step_of(state->plan, wafer, step);
    say(text, "%s%s ", text->length > 0 ? "; " : "", state->plan->wafers[wafer].name);
    if (at->robot != WH_FLOW_NONE) {
        say(text, "on %s", state->tool->robots[at->robot].name);
    } else {
        say(text, "in %s", station_name(state, state->tool->place_stations[at->place]));
        say_down(state, state->tool->place_stations[at->place], text);
        say_pressure(state, wafer, state->tool->place_stations[at->place], true, text);
    }
    for (size_t i = 0; next && i < next->station_count; ++i) {
        say(text, "%s", i == 0 ? " waits for " : " or ");
        say_next(state, wafer, next->stations[i], text);
    }
    const int32_t laden = at->robot == WH_FLOW_NONE ? find_laden(state, wafer) : WH_FLOW_NONE;
    if (laden != WH_FLOW_NONE) {
        say_laden(state, laden, text);
    }
}

/* True if the wafer lies in its first place, and no place of its next step is free for it, or `safe` keeps
 * it out of those that are. */
static bool is_kept_out(const wh_flow_state_t *state, int32_t wafer) {
    const wh_flow_wafer_state_t *at = &state->wafers[wafer];
    bool kept_out = at->place != WH_FLOW_NONE && at->step == 0 && !at->is_over;
    if (kept_out) {
        const wh_flow_step_t *next = wh_flow_step_of(state->plan, wafer, wh_flow_next_step(state, wafer));
        for (size_t i = 0; i < next->station_count; ++i) {
            const wh_flow_station_t *station = &state->tool->stations[next->stations[i]];
            kept_out = kept_out && (find_other(state, wafer, station) != WH_FLOW_NONE ||
                                    find_shut_in(state, wafer, station) != WH_FLOW_NONE);
        }
    }
    return kept_out;
}

static bool is_inside(const wh_flow_state_t *state, int32_t wafer) {
    const wh_flow_wafer_state_t *at = &state->wafers[wafer];
    return !at->is_over && (at->robot != WH_FLOW_NONE || (at->place != WH_FLOW_NONE && at->step > 0));
}

/* Says these wafers, up to a dozen; returns how many there are. */
static int say_all(const wh_flow_state_t *state, bool (*is_meant)(const wh_flow_state_t *, int32_t),
                   text_t *text) {
    int said = 0;
    for (int32_t w = 0; w < (int32_t)state->plan->wafer_count && said < 12; ++w) {
        if (is_meant(state, w)) {
            say_wafer(state, w, text);
            ++said;
        }
    }
    return said;
}

/* Lots whose carriers have not come, though their time is there. */
static void say_lots(const wh_flow_state_t *state, text_t *text) {
    for (size_t i = state->next.lot; i < state->plan->lot_count; ++i) {
        const wh_flow_lot_t *lot = &state->plan->lots[i];
        if (!state->calls.has_come[i] && lot->call > 0 && lot->arrives_us <= state->now_us) {
            const wh_flow_wafer_t *first = &state->plan->wafers[lot->first_wafer];
            say(text, "%sthe lot of %s waits for its carrier at %s", text->length > 0 ? "; " : "",
                first->name, station_name(state, state->tool->place_stations[first->home]));
        }
    }
}

/* "{ LLA, PM1, W3 }", as it stands in a list. */
static void say_line(const wh_flow_state_t *state, const wh_flow_line_t *line, text_t *text) {
    const char *from = line->from == WH_FLOW_NONE ? "keep" : station_name(state, line->from);
    const char *to = line->to == WH_FLOW_NONE ? "keep" : station_name(state, line->to);
    if (line->what == WH_FLOW_PUMP) {
        say(text, "{ pump, %s, %s }", to, wh_flow_side_words[line->side]);
        return;
    }
    say(text, "{ %s, %s", from, to);
    if (line->wafer != WH_FLOW_NONE) {
        say(text, ", %s", state->plan->wafers[line->wafer].name);
    }
    say(text, " }");
}

/* The line that the robot has come to: "; R1 stands at line 3 of its list, { LLA, PM1 }". */
static void say_list(const wh_flow_state_t *state, int32_t robot, text_t *text) {
    const wh_flow_list_t *list = &state->plan->lists[robot];
    const wh_flow_robot_state_t *at = &state->robots[robot];
    const bool is_under_way = at->action != WH_FLOW_IDLE && at->action != WH_FLOW_MOVING;
    const int32_t number = is_under_way && at->mark > 0 ? at->mark - 1 : at->mark;
    say(text, "; %s ", state->tool->robots[robot].name);
    if (list->count == 0) {
        say(text, "has no list");
    } else if ((size_t)number >= list->count) {
        say(text, "has come to the end of its list");
    } else {
        say(text, "stands at line %d of its list, ", (int)number + 1);
        say_line(state, &list->lines[number], text);
    }
}

/* The wafers inside; if there are none, those that cannot leave their first places. */
char *wh_flow_stuck_text(const wh_flow_state_t *state) {
    text_t text = {0};
    const int said = say_all(state, is_inside, &text);
    if (said == 0) {
        (void)say_all(state, is_kept_out, &text);
    }
    say_lots(state, &text);
    if (text.length == 0) {
        say(&text, "no robot takes the next wafer out of its first place");
    }
    for (int32_t r = 0; state->plan->rule == WH_FLOW_LISTS && r < (int32_t)state->tool->robot_count; ++r) {
        say_list(state, r, &text);
    }
    return text.text;
}
