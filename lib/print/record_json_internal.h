/* Within the JSON of a record: its parts. */
#ifndef WH_PRINT_RECORD_JSON_INTERNAL_H
#define WH_PRINT_RECORD_JSON_INTERNAL_H

#include "../record/record.h"
#include "../text/json_values.h"

/* The record that is being written. */
static inline const wh_record_t *wh_json_record(const wh_json_writer_t *writer) {
    return (const wh_record_t *)writer->subject;
}

/* How the smallest gaps went over time: clearance_curves among the lists, for the kinds that were ever near. */
void wh_json_put_curves(wh_json_writer_t *writer, json_t *root);

/* Throughput and split in the head; cycles, gantt and reach among the lists; a command's split. */
void wh_json_put_sums(wh_json_writer_t *writer, json_t *root);
void wh_json_put_figures(wh_json_writer_t *writer, json_t *root);
json_t *wh_json_split(wh_json_writer_t *writer, const int64_t shares[WH_SHARES]);

#endif
