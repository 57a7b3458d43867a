/* The parts that not every run has, as C source: rims, edge sensors, beams, grips. */
#include <inttypes.h>

#include "segments_internal.h"

/* -------------------------------------------------------------------------------------------------- rims */

/* The rims by wafer, of edge sensors or beams; null: the run has neither. */
static const wh_rim_t *const *find_rims(const wh_played_t *run) {
    return run->parts.set_scanning ? run->parts.scanning.rims : run->parts.latching.rims;
}

static bool has_rims(const wh_played_t *run) {
    return (run->parts.set_scanning || run->parts.set_latching) && run->wafer_count > 0;
}

/* Wafers of one rim mostly follow each other. */
static bool is_new_rim(const wh_played_t *run, size_t wafer) {
    const wh_rim_t *const *rims = find_rims(run);
    return wafer == 0 || (rims[wafer] != rims[wafer - 1] && rims[wafer] != rims[0]);
}

static void put_rim(FILE *out, const wh_rim_t *rim) {
    fputs("    {", out);
    wh_segments_put_real(out, rim->radius);
    fputs(", ", out);
    wh_segments_put_doubles(out,
                            (const double[]){rim->notch.direction, rim->notch.depth, rim->notch.opening,
                                             rim->notch.bottom, rim->notch.corner},
                            5);
    for (size_t i = 0; i < WH_RIM_FLATS; ++i) {
        fputs(i > 0 ? ", " : ", {", out);
        wh_segments_put_doubles(out, (const double[]){rim->flats[i].direction, rim->flats[i].length}, 2);
    }
    fputs("}, {", out);
    for (int32_t i = 0; i < rim->chip_count || i == 0; ++i) {
        const wh_chip_t *chip = &rim->chips[i];
        fputs(i > 0 ? ", " : "", out);
        wh_segments_put_doubles(out, (const double[]){chip->direction, chip->width, chip->depth}, 3);
    }
    fprintf(out, "}, %" PRId32, rim->chip_count);
    const double rest[] = {rim->bow, rim->saddle, rim->saddle_direction, rim->transmission};
    for (size_t i = 0; i < sizeof rest / sizeof rest[0]; ++i) {
        fputs(", ", out);
        wh_segments_put_real(out, rest[i]);
    }
    fputs("}", out);
}

/* By wafer, which of the rims it has. */
static void put_rim_of(const wh_segments_writer_t *writer) {
    const wh_played_t *run = &writer->of->run;
    const wh_rim_t *const *rims = find_rims(run);
    size_t last = 0;
    fprintf(writer->out, "static const wh_rim_t *const %s_rim_of[%zu] = {", writer->prefix, run->wafer_count);
    for (size_t w = 0; w < run->wafer_count; ++w) {
        const char *before = w > 0 ? ",\n    " : "\n    ";
        last += w > 0 && is_new_rim(run, w) ? 1 : 0;
        fprintf(writer->out, "%s&%s_rims[%zu]", w % 4 > 0 ? ", " : before, writer->prefix,
                rims[w] == rims[0] ? 0 : last);
    }
    fputs("};\n\n", writer->out);
}

static void put_rims(const wh_segments_writer_t *writer) {
    const wh_played_t *run = &writer->of->run;
    if (!has_rims(run)) {
        return;
    }
    fprintf(writer->out, "static const wh_rim_t %s_rims[] = {\n", writer->prefix);
    for (size_t w = 0; w < run->wafer_count; ++w) {
        if (is_new_rim(run, w)) {
            fputs(w > 0 ? ",\n" : "", writer->out);
            put_rim(writer->out, find_rims(run)[w]);
        }
    }
    fputs("};\n\n", writer->out);
    put_rim_of(writer);
}

/* ----------------------------------------------------------------------------------------------- sensors */

static void put_scanner(const wh_segments_writer_t *writer, size_t i) {
    const wh_scanner_t *scanner = &writer->of->run.parts.scanning.scanners[i];
    const wh_sensor_t *sensor = &scanner->sensor;
    const double line[] = {sensor->direction, sensor->middle, sensor->length, sensor->pixel};
    FILE *out = writer->out;
    fputs("    {{", out);
    for (size_t k = 0; k < sizeof line / sizeof line[0]; ++k) {
        wh_segments_put_real(out, line[k]);
        fputs(", ", out);
    }
    fprintf(out, "%" PRId32 ", %" PRId32 ", ", sensor->samples, sensor->encoder);
    wh_segments_put_real(out, sensor->noise);
    fputs(", ", out);
    wh_segments_put_real(out, sensor->tilt);
    fputs(", ", out);
    wh_segments_put_doubles(
        out,
        (const double[]){sensor->error.offset, sensor->error.zero, sensor->error.gain, sensor->error.latency},
        4);
    for (int32_t k = 0; k < sensor->hidden_count || k == 0; ++k) {
        fputs(k > 0 ? ", " : ", {", out);
        wh_segments_put_doubles(out, (const double[]){sensor->hidden[k].from, sensor->hidden[k].width}, 2);
    }
    fprintf(out, "}, %" PRId32 "}, %" PRId32 ", UINT64_C(%" PRIu64 "),\n     ", sensor->hidden_count,
            scanner->gripper, scanner->seed);
    wh_segments_put_pose(out, &scanner->base_from_station);
    fputs("}", out);
}

static void put_touch(FILE *out, const wh_touch_face_t *touch) {
    fputs("{", out);
    wh_segments_put_doubles(out, touch->middle, 3);
    fputs(", ", out);
    wh_segments_put_doubles(out, touch->normal, 3);
    fputs(", ", out);
    wh_segments_put_doubles(out, touch->edge, 3);
    fputs(", ", out);
    wh_segments_put_real(out, touch->along);
    fputs(", ", out);
    wh_segments_put_real(out, touch->aside);
    fputs(", ", out);
    wh_segments_put_doubles(out, touch->ball, 3);
    fputs(", ", out);
    wh_segments_put_real(out, touch->radius);
    fputs("}", out);
}

static void put_beam(const wh_segments_writer_t *writer, size_t i) {
    static const char *const stuck[] = {
        [WH_BEAM_WORKS] = "WORKS", [WH_BEAM_DARK] = "DARK", [WH_BEAM_LIT] = "LIT"};
    const wh_door_beam_t *door = &writer->of->run.parts.latching.beams[i];
    const wh_beam_t *beam = &door->beam;
    const double times[] = {door->delay_on, door->delay_off, door->jitter};
    FILE *out = writer->out;
    fputs("    {", out);
    wh_segments_put_doubles(
        out, (const double[]){beam->x, beam->y, beam->z, beam->ex, beam->ey, beam->ez, beam->low, beam->high},
        8);
    for (size_t k = 0; k < sizeof times / sizeof times[0]; ++k) {
        fputs(", ", out);
        wh_segments_put_real(out, times[k]);
    }
    fprintf(out, ", UINT64_C(%" PRIu64 "), WH_BEAM_%s, WH_DOOR_%s,\n     ", door->seed, stuck[door->stuck],
            door->kind == WH_DOOR_TOUCH ? "TOUCH" : "LIGHT");
    put_touch(out, &door->touch);
    fprintf(out, ", %" PRId32 ", ", door->gripper);
    wh_segments_put_real(out, door->noise);
    fputs("}", out);
}

static void put_blade(const wh_segments_writer_t *writer, size_t g) {
    const wh_blade_outline_t *blade = &writer->of->run.parts.latching.blades[g];
    fprintf(writer->out, "    {%" PRId32 ", ", blade->count);
    wh_segments_put_doubles(writer->out, blade->x, (size_t)blade->count);
    fputs(", ", writer->out);
    wh_segments_put_doubles(writer->out, blade->y, (size_t)blade->count);
    fputs("}", writer->out);
}

static void put_order(const wh_segments_writer_t *writer, size_t i) {
    static const char *const scans[] = {
        [WH_SCAN_KEEP] = "KEEP", [WH_SCAN_ARM] = "ARM", [WH_SCAN_DISARM] = "DISARM"};
    static const char *const latches[] = {
        [WH_LATCH_KEEP] = "KEEP", [WH_LATCH_ARM] = "ARM", [WH_LATCH_DISARM] = "DISARM"};
    const wh_played_order_t *order = &writer->of->run.orders[i];
    fprintf(writer->out,
            "    {%" PRId64 ", {WH_SCAN_%s, %" PRId32 ", %" PRId32 ", %" PRId64 "}, {WH_LATCH_%s, %" PRId32
            ", %" PRId32 "}}",
            order->seq, scans[order->scan.kind], order->scan.gripper, order->scan.count, order->scan.first,
            latches[order->latch.kind], order->latch.first, order->latch.count);
}

/* ------------------------------------------------------------------------------------------------- grips */

static void put_grip(const wh_segments_writer_t *writer, size_t g) {
    static const char *const kinds[] = {
        [WH_GRIP_VACUUM] = "VACUUM", [WH_GRIP_EDGE] = "EDGE", [WH_GRIP_PASSIVE] = "PASSIVE"};
    const wh_grip_t *grip = &writer->of->run.parts.grips.grips[g];
    const wh_edge_t *edge = &grip->edge;
    fprintf(writer->out, "    {WH_GRIP_%s, ", kinds[grip->kind]);
    wh_segments_put_doubles(writer->out,
                            (const double[]){edge->radius, edge->rest, edge->plunger, edge->alpha,
                                             edge->clearance, edge->retracted, edge->gripped_from,
                                             edge->gripped_to, edge->end, edge->speed},
                            10);
    fputs("}", writer->out);
}

static void put_shape(const wh_segments_writer_t *writer, size_t w) {
    const wh_edge_wafer_t *shape = &writer->of->run.parts.grips.shapes[w];
    fputs("    ", writer->out);
    wh_segments_put_doubles(writer->out,
                            (const double[]){shape->radius, shape->x, shape->y, shape->depth, shape->opening,
                                             shape->bottom, shape->notch_x, shape->notch_y},
                            8);
}

static void put_support(const wh_segments_writer_t *writer, size_t i) {
    fputs("    ", writer->out);
    wh_segments_put_pose(writer->out, &writer->of->run.parts.grips.supports[i]);
}

static size_t count_shapes(const wh_played_t *run) {
    return run->parts.grips.shapes ? run->wafer_count : 0;
}

/* ------------------------------------------------------------------------------------------------- parts */

void wh_segments_put_parts(const wh_segments_writer_t *writer) {
    const wh_played_t *run = &writer->of->run;
    const wh_played_parts_t *parts = &run->parts;
    const size_t grippers = run->machine->gripper_count;
    put_rims(writer);
    wh_segments_put_array(writer, "wh_scanner_t", "scanners", parts->scanning.scanner_count, put_scanner);
    wh_segments_put_array(writer, "wh_door_beam_t", "beams", parts->latching.beam_count, put_beam);
    wh_segments_put_array(writer, "wh_blade_outline_t", "blades", parts->latching.blades ? grippers : 0,
                          put_blade);
    wh_segments_put_array(writer, "wh_played_order_t", "orders", run->order_count, put_order);
    wh_segments_put_array(writer, "wh_grip_t", "grips", parts->set_grips ? grippers : 0, put_grip);
    wh_segments_put_array(writer, "wh_edge_wafer_t", "shapes", count_shapes(run), put_shape);
    wh_segments_put_array(writer, "wh_pose_t", "supports", parts->grips.support_count, put_support);
}

/* ", NAME", or ", NULL" if it is not there. */
static void put_name(const wh_segments_writer_t *writer, const char *name, bool is_there) {
    if (is_there) {
        fprintf(writer->out, ", %s_%s", writer->prefix, name);
    } else {
        fputs(", NULL", writer->out);
    }
}

static void put_calls(FILE *out, const wh_played_parts_t *parts) {
    const struct {
        bool is_used;
        const char *name;
    } calls[] = {{parts->take_ways != NULL, "wh_track_take_ways"},
                 {parts->take_vias != NULL, "wh_track_take_vias"},
                 {parts->begin_slowly != NULL, "wh_track_begin_slowly"},
                 {parts->set_scanning != NULL, "wh_simulator_set_scanning"},
                 {parts->set_latching != NULL, "wh_simulator_set_latching"},
                 {parts->set_doors != NULL, "wh_simulator_set_doors"},
                 {parts->set_grips != NULL, "wh_simulator_set_grips"}};
    for (size_t i = 0; i < sizeof calls / sizeof calls[0]; ++i) {
        fprintf(out, "%s%s", i > 0 ? ", " : "    {", calls[i].is_used ? calls[i].name : "NULL");
    }
}

void wh_segments_put_parts_member(const wh_segments_writer_t *writer) {
    const wh_played_t *run = &writer->of->run;
    const wh_played_parts_t *parts = &run->parts;
    FILE *out = writer->out;
    put_calls(out, parts);
    fputs(",\n     {", out);
    wh_segments_put_reference(writer, "scanners", parts->scanning.scanner_count);
    put_name(writer, "rim_of", parts->set_scanning && has_rims(run));
    fputs("}, {", out);
    wh_segments_put_reference(writer, "beams", parts->latching.beam_count);
    put_name(writer, "rim_of", parts->set_latching && has_rims(run));
    put_name(writer, "blades", parts->latching.blades != NULL);
    fputs("}, {", out);
    wh_segments_put_real(out, (double)parts->grips.thickness);
    fputs(", ", out);
    wh_segments_put_real(out, parts->grips.dt);
    put_name(writer, "grips", parts->set_grips != NULL);
    put_name(writer, "shapes", count_shapes(run) > 0);
    fputs(", ", out);
    wh_segments_put_reference(writer, "supports", parts->grips.support_count);
    fputs(", NULL, NULL, NULL}},\n", out);
}
