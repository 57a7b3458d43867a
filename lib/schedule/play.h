/* Plays an accepted schedule by a tool's timed robots: each robot carries out its picks, places and swaps,
 * and each lock turns, in the schedule's order, each as soon as it can be. */
#ifndef WH_SCHEDULE_PLAY_H
#define WH_SCHEDULE_PLAY_H

#include "../flow/figures.h"
#include "schedule.h"

/* Zero it at the beginning. */
typedef struct {
    wh_flow_plan_t plan;
    wh_flow_figures_t figures;
    bool is_played;
    int64_t makespan_us;          /* of the schedule: the end of its last placing */
    size_t wafers, resting;       /* carried, and never carried: those are left out */
    size_t actions;               /* rows that pick, place or swap */
    size_t played, differing;     /* those that came about; those of them that begin at another time */
    size_t first_row, widest_row; /* of them, SIZE_MAX: none */
    int64_t first_us, widest_us;  /* when they begin as played */
    char message[600];            /* why it was not played; empty: it was */
} wh_schedule_play_t;

/* False, with a message, if no flow can be made of it: a wafer that is left aboard. The tool is a layout's,
 * and wh_schedule_first_bar found nothing with it. Close the play in any case. */
bool wh_schedule_play(wh_schedule_play_t *play, const wh_schedule_t *schedule, const wh_flow_tool_t *tool);
void wh_schedule_play_close(wh_schedule_play_t *play, const wh_flow_tool_t *tool);

#endif
