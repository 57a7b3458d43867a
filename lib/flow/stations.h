/* Stations take time: processes, cleans, pumps, failures; and lots arrive. */
#ifndef WH_FLOW_STATIONS_H
#define WH_FLOW_STATIONS_H

#include "state.h"

/* A wafer was placed, or one was taken out: at this instant. */
void wh_flow_station_entered(wh_flow_state_t *state, int32_t wafer);
void wh_flow_station_left(wh_flow_state_t *state, int32_t place);

/* Ends what ends at this instant in the stations. */
void wh_flow_stations_end(wh_flow_state_t *state);

/* Lots arrive, failures, cleans and pumps begin. */
void wh_flow_stations_begin(wh_flow_state_t *state);

/* The next instant after now at which something ends or begins in the stations by itself. Cleans for want
 * of wafers are left out: they bring nobody further. `idle_us` receives the next of them. */
int64_t wh_flow_stations_next(wh_flow_state_t *state, int64_t *idle_us);

#endif
