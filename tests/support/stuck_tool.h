/* Says of a flow in which nobody goes on whether somebody could, by the descriptions and by who is where. */
#ifndef TESTS_SUPPORT_STUCK_TOOL_H
#define TESTS_SUPPORT_STUCK_TOOL_H

#include "support/tool_log.h"

/* Where wafers lie and which places are free: of the state, or as it would be. */
typedef struct {
    int32_t wafers[LOG_PLACES]; /* by place: one that lies there or comes, or -1 */
    int32_t places[LOG_WAFERS]; /* by wafer: where it lies or comes to, or -1 */
    int32_t steps[LOG_WAFERS];  /* by wafer: in which step that is */
} board_t;

static inline board_t board_of(const tool_log_t *log, const wh_flow_state_t *state) {
    board_t board;
    for (size_t p = 0; p < log->tool->place_count; ++p) {
        const wh_flow_place_t *place = &state->places[p];
        board.wafers[p] = place->wafer >= 0 ? place->wafer : place->coming;
    }
    for (size_t w = 0; w < log->plan->wafer_count; ++w) {
        board.places[w] = state->wafers[w].place;
        board.steps[w] = log->wafers[w].step;
    }
    for (size_t p = 0; p < log->tool->place_count; ++p) {
        const int32_t coming = state->places[p].coming;
        if (coming >= 0) {
            board.places[coming] = (int32_t)p;
            board.steps[coming] = state->wafers[coming].toward;
        }
    }
    return board;
}

static inline bool stuck_is_down(const wh_flow_state_t *state, int32_t station) {
    return state->stations[station].down_us != WH_FLOW_NEVER;
}

/* True if the robot may put the wafer into the place: it serves the station, on its side; the place is free. */
static inline bool stuck_may_put(const tool_log_t *log, const wh_flow_state_t *state, const board_t *board,
                                 int32_t robot, int32_t place) {
    const int32_t station = log->tool->place_stations[place];
    const size_t of = (size_t)robot * log->tool->station_count + (size_t)station;
    const wh_flow_side_t slot = log->tool->slot_sides[place], side = log->tool->sides[of];
    return log->tool->serves[of] && board->wafers[place] < 0 && !stuck_is_down(state, station) &&
           (slot == WH_FLOW_BOTH || side == WH_FLOW_BOTH || slot == side);
}

/* True if some robot could carry the wafer from one place to the other. */
static inline bool stuck_leads(const tool_log_t *log, const wh_flow_state_t *state, const board_t *board,
                               int32_t from, int32_t to) {
    bool leads = false;
    for (int32_t r = 0; r < (int32_t)log->tool->robot_count; ++r) {
        const size_t of = (size_t)r * log->tool->station_count + (size_t)log->tool->place_stations[from];
        leads = leads || (log->tool->serves[of] && stuck_may_put(log, state, board, r, to));
    }
    return leads;
}

/* A set of places. */
typedef struct {
    bool has[LOG_PLACES];
} places_t;

/* The places of the wafer's step to which some robot carries it from one of these; the last one of them in `end`. False:
 * there is none. */
static inline bool stuck_step(const tool_log_t *log, const wh_flow_state_t *state, const board_t *board,
                              int32_t wafer, int32_t step, places_t *places, int32_t *end) {
    places_t there = {{false}};
    bool any = false;
    for (int32_t to = 0; to < (int32_t)log->tool->place_count; ++to) {
        for (int32_t from = 0; from < (int32_t)log->tool->place_count && log_fits(log, wafer, step, to);
             ++from) {
            const bool leads = places->has[from] && from != to && stuck_leads(log, state, board, from, to);
            there.has[to] = there.has[to] || leads;
        }
        *end = there.has[to] ? to : *end;
        any = any || there.has[to];
    }
    *places = there;
    return any;
}

/* True if the wafer can go to its end alone, while the others stay: along free places. */
static inline bool stuck_walks(const tool_log_t *log, const wh_flow_state_t *state, const board_t *board,
                               int32_t wafer, int32_t *end) {
    places_t places = {{false}};
    bool walks = true;
    places.has[board->places[wafer]] = true;
    *end = board->places[wafer];
    for (int32_t next = log_next(log, wafer, board->steps[wafer], -1, state->now_us + 1); next > 0 && walks;
         next = log_next(log, wafer, next, -1, state->now_us + 1)) {
        walks = stuck_step(log, state, board, wafer, next, &places, end);
    }
    return walks;
}

/* True if places of some step are to stay empty: nobody looks then. */
static inline bool stuck_keeps_empty(const tool_log_t *log) {
    bool keeps = false;
    for (size_t i = 0; i < log->plan->route_count; ++i) {
        for (size_t k = 1; k < log->plan->routes[i].step_count; ++k) {
            keeps = keeps || log->plan->routes[i].steps[k].kept_empty > 0;
        }
    }
    return keeps;
}

/* Takes wafers away that can go to their ends alone. Returns how many, and in `left` how many cannot. */
static inline size_t stuck_let_go(const tool_log_t *log, const wh_flow_state_t *state, board_t *board,
                                  size_t *left) {
    size_t gone = 0;
    *left = 0;
    for (int32_t w = 0; w < (int32_t)log->plan->wafer_count; ++w) {
        int32_t end = -1;
        if (state->wafers[w].is_over || board->places[w] < 0 || board->steps[w] == 0) {
            continue;
        }
        if (stuck_walks(log, state, board, w, &end)) {
            board->wafers[board->places[w]] = -1;
            board->wafers[end] = w;
            board->places[w] = -1;
            ++gone;
        } else {
            ++*left;
        }
    }
    return gone;
}

/* True if one after another each wafer inside can go to its end alone. */
static inline bool stuck_is_safe(const tool_log_t *log, const wh_flow_state_t *state, board_t board) {
    size_t left = 0;
    while (stuck_let_go(log, state, &board, &left) > 0) {
    }
    return left == 0 && !stuck_keeps_empty(log);
}

static inline bool stuck_has_arm(const tool_log_t *log, const wh_flow_state_t *state, int32_t robot,
                                 int32_t wafer) {
    const wh_flow_route_t *route = log_route(log, wafer);
    const int32_t step = log->wafers[wafer].step;
    const bool second_alone = (size_t)step < route->step_count && route->steps[step].second_arm;
    bool has = false;
    for (int32_t arm = second_alone ? 1 : 0; arm < log->tool->robots[robot].arms; ++arm) {
        has = has || state->robots[robot].arms[arm] < 0;
    }
    return has;
}

/* True if the wafer lies somewhere, done, and this robot could take it. */
static inline bool stuck_may_take(const tool_log_t *log, const wh_flow_state_t *state, int32_t robot,
                                  int32_t wafer) {
    const wh_flow_wafer_state_t *at = &state->wafers[wafer];
    if (at->is_over || at->place < 0 || at->is_moving || at->taker >= 0) {
        return false;
    }
    const int32_t station = log->tool->place_stations[at->place];
    const log_wafer_t *known = &log->wafers[wafer];
    const bool is_done = known->step == 0 || (known->done_us >= 0 && known->free_us <= state->now_us);
    return is_done && !stuck_is_down(state, station) && stuck_has_arm(log, state, robot, wafer) &&
           log->tool->serves[(size_t)robot * log->tool->station_count + (size_t)station];
}

/* The board once the wafer has come into this place. */
static inline board_t stuck_then(const board_t *board, int32_t wafer, int32_t place, int32_t step) {
    board_t then = *board;
    if (then.places[wafer] >= 0) {
        then.wafers[then.places[wafer]] = -1;
    }
    then.wafers[place] = wafer;
    then.places[wafer] = place;
    then.steps[wafer] = step;
    return then;
}

/* True if a place is free for the wafer in the step behind its own, in this station or in any (-1). Where places are to
 * stay empty nobody looks. */
static inline bool stuck_has_room(const tool_log_t *log, const wh_flow_state_t *state, const board_t *board,
                                  int32_t robot, int32_t wafer, int32_t station, bool is_safe) {
    const int32_t next =
        log_next(log, wafer, log->wafers[wafer].step, board->places[wafer], state->now_us + 1);
    bool has = false;
    for (int32_t p = 0; next > 0 && !has && !stuck_keeps_empty(log) && p < (int32_t)log->tool->place_count;
         ++p) {
        const bool fits =
            log_fits(log, wafer, next, p) && (station < 0 || log->tool->place_stations[p] == station);
        has = fits && stuck_may_put(log, state, board, robot, p) &&
              (!is_safe || stuck_is_safe(log, state, stuck_then(board, wafer, p, next)));
    }
    return has;
}

static inline bool stuck_say(tool_log_t *log, const wh_flow_state_t *state, int32_t robot, int32_t wafer,
                             const char *what) {
    (void)snprintf(log->going, sizeof log->going, "%s could %s %s", state->tool->robots[robot].name, what,
                   log_wafer_name(log, wafer));
    return true;
}

/* A robot of a shipped rule: none that exchanges wafers. */
static inline bool stuck_by_rule(tool_log_t *log, const wh_flow_state_t *state, const board_t *board,
                                 int32_t robot) {
    const bool swaps = log->plan->rule == WH_FLOW_SWAPPING && log->tool->robots[robot].arms > 1;
    for (int32_t w = 0; !swaps && w < (int32_t)log->plan->wafer_count; ++w) {
        if (stuck_may_take(log, state, robot, w) &&
            stuck_has_room(log, state, board, robot, w, -1, log->plan->is_safe)) {
            return stuck_say(log, state, robot, w, "carry");
        }
    }
    return false;
}

/* True if the wafer's next step leads to the station. */
static inline bool stuck_goes_to(const tool_log_t *log, const wh_flow_state_t *state, int32_t wafer,
                                 int32_t station) {
    const int32_t next =
        log_next(log, wafer, log->wafers[wafer].step, state->wafers[wafer].place, state->now_us + 1);
    bool leads = false;
    for (int32_t p = 0; next > 0 && p < (int32_t)log->tool->place_count; ++p) {
        leads = leads || (log->tool->place_stations[p] == station && log_fits(log, wafer, next, p));
    }
    return leads;
}

static inline bool stuck_lies_in(const tool_log_t *log, const wh_flow_state_t *state, int32_t wafer,
                                 int32_t station) {
    const wh_flow_wafer_state_t *at = &state->wafers[wafer];
    return !at->is_over && at->place >= 0 && log->tool->place_stations[at->place] == station;
}

/* True if another wafer lies in the lock, or goes there next: then it may stay where it is for that one. */
static inline bool stuck_is_wanted(const tool_log_t *log, const wh_flow_state_t *state, int32_t wafer,
                                   int32_t lock) {
    bool wanted = false;
    for (int32_t w = 0; w < (int32_t)log->plan->wafer_count; ++w) {
        const wh_flow_wafer_state_t *at = &state->wafers[w];
        const bool is_there = !at->is_over && (at->place >= 0 || at->robot >= 0);
        wanted = wanted || (w != wafer && is_there &&
                            (stuck_lies_in(log, state, w, lock) || stuck_goes_to(log, state, w, lock)));
    }
    return wanted;
}

/* A lock has the robot's pressure, or turns to it for this wafer by itself. */
static inline bool stuck_pressure_fits(const tool_log_t *log, const wh_flow_state_t *state, int32_t robot,
                                       int32_t wafer, int32_t station) {
    const wh_flow_side_t side = log->tool->sides[(size_t)robot * log->tool->station_count + (size_t)station];
    return !log->tool->stations[station].is_lock || side == WH_FLOW_BOTH ||
           side == state->stations[station].side ||
           (!state->stations[station].is_listed && !stuck_is_wanted(log, state, wafer, station));
}

/* The wafer that a line means, of those that lie where it takes them: the one that is named, or entered first. */
static inline int32_t stuck_meant(const tool_log_t *log, const wh_flow_state_t *state,
                                  const wh_flow_line_t *line) {
    int32_t meant = -1;
    for (int32_t w = 0; w < (int32_t)log->plan->wafer_count; ++w) {
        const bool fits = (line->wafer < 0 || line->wafer == w) && stuck_lies_in(log, state, w, line->from) &&
                          stuck_goes_to(log, state, w, line->to);
        if (fits && (meant < 0 || state->wafers[w].entered_us < state->wafers[meant].entered_us)) {
            meant = w;
        }
    }
    return meant;
}

/* A wafer that the line brings from an arm could be brought. */
static inline bool stuck_brings(tool_log_t *log, const wh_flow_state_t *state, const board_t *board,
                                int32_t robot, const wh_flow_line_t *line) {
    for (int32_t arm = 0; arm < 2; ++arm) {
        const int32_t w = state->robots[robot].arms[arm];
        if (w >= 0 && (line->wafer < 0 || line->wafer == w) &&
            stuck_pressure_fits(log, state, robot, w, line->to) &&
            stuck_has_room(log, state, board, robot, w, line->to, false)) {
            return stuck_say(log, state, robot, w, "bring");
        }
    }
    return false;
}

/* The wafer that the line means could be carried. */
static inline bool stuck_carries(tool_log_t *log, const wh_flow_state_t *state, const board_t *board,
                                 int32_t robot, const wh_flow_line_t *line) {
    const int32_t meant = stuck_meant(log, state, line);
    return meant >= 0 && stuck_may_take(log, state, robot, meant) &&
           stuck_pressure_fits(log, state, robot, meant, line->from) &&
           stuck_has_room(log, state, board, robot, meant, line->to, false) &&
           stuck_say(log, state, robot, meant, "transfer");
}

/* The next line of a robot's list: one that brings a wafer, carries it from place to place, or lets a lock pump. */
static inline bool stuck_by_list(tool_log_t *log, const wh_flow_state_t *state, const board_t *board,
                                 int32_t robot) {
    const wh_flow_list_t *list = &log->plan->lists[robot];
    const size_t number = (size_t)state->robots[robot].mark;
    const wh_flow_line_t *line = number < list->count ? &list->lines[number] : NULL;
    if (!line || line->what == WH_FLOW_KEEP) {
        return false;
    }
    if (line->what == WH_FLOW_PUMP) {
        return !stuck_is_down(state, line->to) && stuck_say(log, state, robot, -1, "let pump");
    }
    if (line->what == WH_FLOW_BRING) {
        return stuck_brings(log, state, board, robot, line);
    }
    return stuck_carries(log, state, board, robot, line);
}

/* A robot in front of its place, with the wafer. */
static inline bool stuck_waits(tool_log_t *log, const wh_flow_state_t *state, int32_t robot) {
    const wh_flow_robot_state_t *at = &state->robots[robot];
    const bool is_free =
        at->to >= 0 && state->places[at->to].wafer < 0 &&
        !stuck_is_down(state, log->tool->place_stations[at->to]) &&
        stuck_pressure_fits(log, state, robot, at->order.wafer, log->tool->place_stations[at->to]);
    return is_free && stuck_say(log, state, robot, at->order.wafer, "place");
}

/* Fills `goes_on` and `going` of the log. */
static inline void stuck_look(tool_log_t *log, const wh_flow_state_t *state) {
    const board_t board = board_of(log, state);
    for (int32_t r = 0; r < (int32_t)log->tool->robot_count && !log->goes_on; ++r) {
        const wh_flow_action_t action = state->robots[r].action;
        if (action == WH_FLOW_WAITING) {
            log->goes_on = stuck_waits(log, state, r);
        } else if (action == WH_FLOW_IDLE && log->plan->rule != WH_FLOW_OWN) {
            log->goes_on = log->plan->rule == WH_FLOW_LISTS ? stuck_by_list(log, state, &board, r)
                                                            : stuck_by_rule(log, state, &board, r);
        }
    }
}

#endif
