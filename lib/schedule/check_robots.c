/* Robots: rules 1, 2, 6, 7 and 14. */
#include "check_internal.h"

#include <stdio.h>

/* Rule 1. An action that begins while another one runs. */
static bool is_busy(wh_schedule_state_t *check, int32_t row, wh_check_robot_t *robot) {
    return robot->row != WH_CHECK_NO_ROW &&
           wh_check_is_early(check, WH_SCHEDULE_RULE_BUSY, row, wh_check_row(check, robot->row)->end_us,
                             robot->row);
}

/* Rule 6. From where it stands to where the row begins, and of a move to where it ends. */
static void check_way(wh_schedule_state_t *check, int32_t row, const wh_check_robot_t *robot) {
    const wh_schedule_row_t *of = wh_check_row(check, row);
    const int32_t to = check->stations[of->station].tool;
    const int64_t way_us = wh_flow_move_us(check->tool, robot->tool, robot->station, to);
    if (wh_check_is_behind(robot->free_us + way_us, of->begin_us)) {
        wh_check_found(check, WH_SCHEDULE_RULE_MOVE, row, robot->row,
                       "begin_s: %.10g (expected %.10g or later: %s is free at %s%s from %.10g on, and moves "
                       "for %.10g s)",
                       wh_check_seconds(of->begin_us), wh_check_seconds(robot->free_us + way_us),
                       check->tool->robots[robot->tool].name, check->tool->stations[robot->station].name,
                       robot->row == WH_CHECK_NO_ROW && check->tool->robots[robot->tool].is_at_assumed
                           ? ", its first station, as nobody says otherwise,"
                           : "",
                       wh_check_seconds(robot->free_us), wh_check_seconds(way_us));
    }
    if (of->action != WH_SCHEDULE_MOVE) {
        return;
    }
    const int64_t move_us = wh_flow_move_us(check->tool, robot->tool, to, check->stations[of->to].tool);
    if (wh_check_is_behind(of->begin_us + move_us, of->end_us)) {
        wh_check_found(check, WH_SCHEDULE_RULE_MOVE, row, WH_CHECK_NO_ROW,
                       "end_s: %.10g (expected %.10g or later: the layout's move takes %.10g s)",
                       wh_check_seconds(of->end_us), wh_check_seconds(of->begin_us + move_us),
                       wh_check_seconds(move_us));
    }
}

void wh_check_length(wh_schedule_state_t *check, int32_t row, int64_t least_us) {
    const wh_schedule_row_t *of = wh_check_row(check, row);
    if (wh_check_is_behind(of->begin_us + least_us, of->end_us)) {
        wh_check_found(check, WH_SCHEDULE_RULE_SHORT, row, WH_CHECK_NO_ROW,
                       "end_s: %.10g (expected %.10g or later: %s %s takes %.10g s here)",
                       wh_check_seconds(of->end_us), wh_check_seconds(of->begin_us + least_us),
                       wh_schedule_article(of->action), wh_schedule_words[of->action],
                       wh_check_seconds(least_us));
    }
}

static void check_access_length(wh_schedule_state_t *check, int32_t row) {
    const wh_schedule_row_t *of = wh_check_row(check, row);
    const size_t pair = wh_check_pair(check, of);
    if (of->action == WH_SCHEDULE_PICK) {
        wh_check_length(check, row, check->tool->pick_us[pair]);
    } else if (of->action == WH_SCHEDULE_PLACE) {
        wh_check_length(check, row, check->tool->place_us[pair]);
    } else if (of->action == WH_SCHEDULE_SWAP) {
        wh_check_length(check, row, check->tool->swap_us[pair]);
    }
}

/* Rule 14. */
static void check_serves(wh_schedule_state_t *check, int32_t row, int32_t station) {
    const wh_schedule_row_t *of = wh_check_row(check, row);
    const int32_t robot = check->robots[of->robot].tool;
    if (!check->tool->serves[wh_flow_of(check->tool, robot, check->stations[station].tool)]) {
        wh_check_found(check, WH_SCHEDULE_RULE_SERVES, row, WH_CHECK_NO_ROW,
                       "robot: %s (expected a robot that serves %s)",
                       wh_schedule_text(&check->schedule->robots, of->robot),
                       wh_schedule_text(&check->schedule->stations, station));
    }
}

/* Rule 14 of a slot: robots of the other side do not fill it. */
static void check_slot(wh_schedule_state_t *check, int32_t row) {
    const wh_schedule_row_t *of = wh_check_row(check, row);
    const wh_flow_station_t *station = wh_check_station(check, of->station);
    const bool fills = of->action == WH_SCHEDULE_PLACE || of->action == WH_SCHEDULE_SWAP;
    if (fills && !wh_flow_sides_agree(check->tool->slot_sides[station->first_place + of->slot - 1],
                                      check->tool->sides[wh_check_pair(check, of)])) {
        wh_check_found(check, WH_SCHEDULE_RULE_SERVES, row, WH_CHECK_NO_ROW,
                       "slot: %d (expected one of %s that %s may fill)", (int)of->slot, station->name,
                       wh_schedule_text(&check->schedule->robots, of->robot));
    }
}

void wh_check_robot_begins(wh_schedule_state_t *check, int32_t row) {
    const wh_schedule_row_t *of = wh_check_row(check, row);
    wh_check_robot_t *robot = &check->robots[of->robot];
    const bool busy = is_busy(check, row, robot);
    if (check->tool) {
        if (!busy) {
            check_way(check, row, robot);
        }
        check_access_length(check, row);
        check_serves(check, row, of->station);
        check_slot(check, row);
        if (of->action == WH_SCHEDULE_MOVE) {
            check_serves(check, row, of->to);
        }
        robot->station = check->stations[of->action == WH_SCHEDULE_MOVE ? of->to : of->station].tool;
    }
    if (robot->row == WH_CHECK_NO_ROW || of->end_us >= wh_check_row(check, robot->row)->end_us) {
        robot->row = row;
        robot->free_us = of->end_us;
    }
}

/* Rule 2. */
void wh_check_takes_aboard(wh_schedule_state_t *check, int32_t row, int32_t wafer, int32_t arm) {
    const wh_schedule_row_t *of = wh_check_row(check, row);
    wh_check_robot_t *robot = &check->robots[of->robot];
    const char *name = wh_schedule_text(&check->schedule->robots, of->robot);
    ++robot->aboard;
    check->wafers[wafer].arm = arm;
    if (robot->arms > 0 && robot->aboard > robot->arms) {
        wh_check_found(
            check, WH_SCHEDULE_RULE_ARMS, row, WH_CHECK_NO_ROW,
            "robot: %s (expected one with a free arm: it has %d, and this would be wafer %d aboard)", name,
            (int)robot->arms, (int)robot->aboard);
    } else if (robot->arms > 0 && arm > robot->arms) {
        wh_check_found(check, WH_SCHEDULE_RULE_ARMS, row, WH_CHECK_NO_ROW,
                       "arm: %d (expected at most %d: that many has %s)", (int)arm, (int)robot->arms, name);
    } else if (arm > 0 && robot->on[arm - 1] != WH_FLOW_NONE && robot->on[arm - 1] != wafer) {
        wh_check_found(check, WH_SCHEDULE_RULE_ARMS, row, check->wafers[robot->on[arm - 1]].row,
                       "arm: %d (expected a free one: on it is %s)", (int)arm,
                       wh_schedule_text(&check->schedule->wafers, robot->on[arm - 1]));
    }
    if (arm > 0) {
        robot->on[arm - 1] = wafer;
    }
}
