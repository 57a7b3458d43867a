/* Tells what sensors saw when it is complete: edge scans with the estimate, and what beams told. */
#include <math.h>
#include <stdlib.h>

#include "../record/scans.h"
#include "../text/array.h"
#include "mcs_process_internal.h"

/* The longest words fit a datagram together with the samples. */
typedef char
    part_fits[WH_LINK_SAMPLES * 9 + WH_SCAN_LINES * (WH_SCAN_LINE_BYTES + 4) + 400 <= WH_LINK_DATAGRAM ? 1
                                                                                                       : -1];
typedef char lines_fit[WH_SCAN_LINES <= WH_LINK_LINES ? 1 : -1];

/* The values that are told for each sample, and the words. */
typedef struct {
    int32_t *samples;
    float *residual;
    int8_t *counts;
    wh_scan_words_t words;
    char *lines[WH_SCAN_LINES];
} told_t;

static void put_result(waferhand_edge_scan *message, wh_status_t status, const wh_align_result_t *result) {
    message->verdict = (int32_t)(status != WH_OK ? status : result->verdict);
    message->radius = result->circle.radius;
    message->x = result->circle.x;
    message->y = result->circle.y;
    message->sd_centre = result->circle.sd_centre;
    message->mark = (int32_t)result->mark;
    message->mark_at = wh_edge_scan_mark_at(result);
    message->turn = result->turn;
    message->sd_turn = result->sd_turn;
}

static void estimate(const wh_mcs_t *mcs, told_t *told, waferhand_edge_scan *message) {
    const wh_mcs_edge_t *edge = &wh_mcs_measuring(mcs)->edge;
    const wh_edge_scan_t scan = {.number = edge->number,
                                 .gripper = edge->order.gripper,
                                 .count = edge->order.count,
                                 .first = edge->order.first,
                                 .taken = edge->taken,
                                 .missed = edge->missed,
                                 .samples = edge->samples};
    wh_edge_point_t *samples = wh_array_new((size_t)edge->taken + 1, sizeof *samples);
    wh_align_result_t result;
    const wh_edge_wish_t wish = wh_edge_wish_of(wh_mcs_running_text(mcs));
    const wh_status_t status = wh_edge_scan_estimate(&scan, wh_mcs_layout(mcs), wish, samples, &result);
    put_result(message, status, &result);
    wh_edge_scan_words(&scan, status, &result, &told->words);
    for (int32_t i = 0; i < edge->taken; ++i) {
        told->residual[i] = (float)samples[i].residual;
        told->counts[i] = samples[i].counts ? 1 : 0;
    }
    free(samples);
}

/* Tells one part, from sample `begin` on. */
static void tell_part(wh_mcs_process_t *control, waferhand_edge_scan *message, const told_t *told,
                      int32_t begin) {
    const int32_t left = message->taken - begin;
    message->part = begin / WH_LINK_SAMPLES + 1;
    message->begin = begin;
    message->sample_count = left < WH_LINK_SAMPLES ? left : WH_LINK_SAMPLES;
    message->samples = &told->samples[begin];
    message->residual = &told->residual[begin];
    message->counts = &told->counts[begin];
    const int size = waferhand_edge_scan_encode(control->encoded, 0, (int)sizeof control->encoded, message);
    if (size > 0) {
        (void)wh_node_publish(control->node, WH_CHANNEL_EDGE_SCAN, control->encoded, (size_t)size);
    }
}

static waferhand_edge_scan begin_message(wh_mcs_process_t *control, const wh_mcs_t *mcs) {
    const wh_mcs_edge_t *edge = &wh_mcs_measuring(mcs)->edge;
    const wh_sensor_t *sensor = &wh_layout_scanner(wh_mcs_layout(mcs), edge->order.gripper)->sensor;
    const waferhand_mcs now = wh_mcs_process_message(control, 0, 0, WH_OK, "", "");
    return (waferhand_edge_scan){.utime = edge->seq * wh_mcs_layout(mcs)->slice_us,
                                 .seq = edge->seq,
                                 .run = now.run,
                                 .layout_hash = now.layout_hash,
                                 .number = (int32_t)edge->number,
                                 .gripper = edge->order.gripper,
                                 .count = edge->order.count,
                                 .first = edge->order.first,
                                 .taken = edge->taken,
                                 .missed = edge->missed,
                                 .turn_samples = sensor->samples,
                                 .pixels = wh_sensor_pixels(sensor),
                                 .pixel = sensor->pixel,
                                 .inner = sensor->middle - sensor->length / 2,
                                 .direction = sensor->direction,
                                 .parts = edge->taken > 0 ? (edge->taken - 1) / WH_LINK_SAMPLES + 1 : 1};
}

void wh_mcs_process_tell_edge(wh_mcs_process_t *control, const wh_mcs_t *mcs) {
    const wh_mcs_edge_t *edge = &wh_mcs_measuring(mcs)->edge;
    const size_t room = (size_t)edge->taken + 1;
    told_t told = {.samples = edge->samples,
                   .residual = wh_array_new(room, sizeof(float)),
                   .counts = wh_array_new(room, sizeof(int8_t))};
    waferhand_edge_scan message = begin_message(control, mcs);
    estimate(mcs, &told, &message);
    for (size_t i = 0; i < WH_SCAN_LINES; ++i) {
        told.lines[i] = told.words.lines[i];
    }
    message.line_count = WH_SCAN_LINES;
    message.lines = told.lines;
    for (int32_t i = 0; i < message.parts; ++i) {
        tell_part(control, &message, &told, i * WH_LINK_SAMPLES);
    }
    free(told.residual);
    free(told.counts);
}

/* -------------------------------------------------------------------------------------------------- beams */

static waferhand_crossing crossing_of(const wh_pass_crossing_t *from, wh_crossing_use_t use) {
    const wh_crossing_t *crossing = &from->crossing;
    const waferhand_crossing message = {crossing->beam, (int32_t)crossing->edge,
                                        (int32_t)use,   from->time,
                                        crossing->x,    crossing->y,
                                        crossing->vx,   crossing->vy};
    return message;
}

static waferhand_centre centre_of(const wh_centre_t *from) {
    const waferhand_centre message = {from->x,    from->y,        from->radius, from->sd_x,
                                      from->sd_y, from->mismatch, from->used};
    return message;
}

void wh_mcs_process_tell_centring(wh_mcs_process_t *control, const wh_mcs_t *mcs) {
    const wh_pass_t *pass = &wh_mcs_measuring(mcs)->pass;
    const wh_centring_record_t *centring = &wh_mcs_measuring(mcs)->centring;
    waferhand_crossing crossings[WH_CROSSINGS];
    waferhand_centre centres[2];
    const waferhand_mcs now = wh_mcs_process_message(control, 0, 0, WH_OK, "", "");
    for (size_t i = 0; i < centring->count; ++i) {
        crossings[i] = crossing_of(&centring->crossings[i], centring->centres.candidates[0].use[i]);
    }
    for (int32_t i = 0; i < centring->centres.count; ++i) {
        centres[i] = centre_of(&centring->centres.candidates[i]);
    }
    const waferhand_centring message = {.utime = pass->seq * wh_mcs_layout(mcs)->slice_us,
                                        .seq = pass->seq,
                                        .run = now.run,
                                        .layout_hash = now.layout_hash,
                                        .number = (int32_t)pass->number,
                                        .station = centring->station,
                                        .gripper = centring->gripper,
                                        .status = (int32_t)centring->status,
                                        .missed = (int32_t)centring->missed,
                                        .crossing_count = (int32_t)centring->count,
                                        .centre_count = centring->centres.count,
                                        .crossings = crossings,
                                        .centres = centres};
    const int size = waferhand_centring_encode(control->encoded, 0, (int)sizeof control->encoded, &message);
    if (size > 0) {
        (void)wh_node_publish(control->node, WH_CHANNEL_LATCH, control->encoded, (size_t)size);
    }
}
