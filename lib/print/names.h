/* Names for a record's indices. Every function returns null for WH_NONE, an index out of range and a record
 * without a layout; the strings are the layout's. */
#ifndef WH_PRINT_NAMES_H
#define WH_PRINT_NAMES_H

#include "../record/throughput.h"

const char *wh_record_wafer_name(const wh_record_t *record, int32_t wafer);
const char *wh_record_gripper_name(const wh_record_t *record, int32_t gripper);
const char *wh_record_station_name(const wh_record_t *record, int32_t station);

/* Which puts count as wafers, in words; null when there are none. */
const char *wh_record_rank_text(wh_rank_t rank);

#endif
