/* A station's own doings, as motion control tells them: the text of the phase STATION on WAFERHAND_MCS, whose
 * command is the station's name.
 *
 *     kind=process_begins station=3 slot=1 wafer=0 side=both at=5770000 us=60000000
 *
 * station, slot and wafer are numbers, slots from 1, the others from 0; -1: none. `at` and `us` are as in
 * wh_clock_event_t. For a load port the step and the carrier's name follow, the name up to the end:
 *
 *     kind=port_ends station=3 slot=-1 wafer=-1 side=both at=5770000 us=3000000 step=dock carrier=C1
 */
#ifndef WH_LINK_STATION_TOLD_H
#define WH_LINK_STATION_TOLD_H

#include "../record/record.h"

#define WH_STATION_TOLD_BYTES 280

void wh_station_told_write(const wh_station_event_record_t *event, char text[WH_STATION_TOLD_BYTES]);

/* False if the text is not of this form, or names what a layout with these counts has not. */
bool wh_station_told_read(const char *text, size_t station_count, size_t wafer_count,
                          wh_station_event_record_t *event);

#endif
