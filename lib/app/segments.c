#include "segments.h"

#include <inttypes.h>
#include <stdio.h>

#include "../text/output.h"

static void write_numbers(FILE *out, const wh_real_t values[], size_t count) {
    fputs("{", out);
    for (size_t i = 0; i < count; ++i) {
        fprintf(out, "%s%a", i > 0 ? ", " : "", values[i]);
    }
    fputs("}", out);
}

static void write_pose(FILE *out, const wh_pose_t *pose) {
    fputs("{{{", out);
    for (size_t row = 0; row < 3; ++row) {
        fputs(row > 0 ? ", " : "", out);
        write_numbers(out, pose->R.m[row], 3);
    }
    fprintf(out, "}}, {%a, %a, %a}}", pose->r.x, pose->r.y, pose->r.z);
}

static void write_limits(FILE *out, const wh_limits_t *limits) {
    fprintf(out, "{%a, %a, %a}", limits->speed, limits->acceleration, limits->jerk);
}

/* ------------------------------------------------------------------------------------------------ machine */

static void write_robot(FILE *out, const wh_robot_t *robot) {
    fputs("    .robot = {.travel = {", out);
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        fprintf(out, "%s{%a, %a}", axis > 0 ? ", " : "", robot->travel[axis].min, robot->travel[axis].max);
    }
    fputs("},\n              .limits = {", out);
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        fputs(axis > 0 ? ", " : "", out);
        write_limits(out, &robot->limits[axis]);
    }
    fputs("},\n              .home = ", out);
    write_numbers(out, robot->home, WH_ROBOT_AXES);
    fputs("},\n", out);
}

static void write_machine(FILE *out, const wh_machine_t *machine) {
    fputs("static const wh_machine_t played_machine = {\n", out);
    write_robot(out, &machine->robot);
    fputs("    .chuck_limits = ", out);
    write_limits(out, &machine->chuck_limits);
    fprintf(out, ",\n    .axis_count = %zu,\n    .gripper_count = %zu,\n    .mounts = {\n",
            machine->axis_count, machine->gripper_count);
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        fprintf(out, "        {%" PRId32 ", ", machine->mounts[g].axis);
        write_pose(out, &machine->mounts[g].base_from_station);
        fputs(machine->mounts[g].is_shifted ? ", true, " : ", false, ", out);
        write_pose(out, &machine->mounts[g].effector_from_gripper);
        fputs("},\n", out);
    }
    fputs("    }};\n\n", out);
}

/* ----------------------------------------------------------------------------------------------- segments */

static void write_valves(FILE *out, const int32_t valves[]) {
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        fprintf(out, "%s%" PRId32, g > 0 ? ", " : ".valves = {", valves[g]);
    }
    fputs("}", out);
}

static void write_segment(FILE *out, const wh_segment_t *segment) {
    switch (segment->kind) {
    case WH_SEGMENT_AXES:
        fputs("    {.kind = WH_SEGMENT_AXES, .target = ", out);
        write_numbers(out, segment->target, WH_AXES);
        break;
    case WH_SEGMENT_LINE:
        fprintf(out, "    {.kind = WH_SEGMENT_LINE, .travel = {%a, %a, %a}, .speed = %a, .acceleration = %a",
                segment->travel.x, segment->travel.y, segment->travel.z, segment->speed,
                segment->acceleration);
        break;
    case WH_SEGMENT_VALVES:
        fputs("    {.kind = WH_SEGMENT_VALVES, ", out);
        write_valves(out, segment->valves);
        break;
    case WH_SEGMENT_DWELL:
        fprintf(out, "    {.kind = WH_SEGMENT_DWELL, .seconds = %a", segment->seconds);
        break;
    case WH_SEGMENT_SENSOR:
        fprintf(out, "    {.kind = WH_SEGMENT_SENSOR, .gripper = %" PRId32 ", .seconds = %a",
                segment->gripper, segment->seconds);
        break;
    }
    fputs("},\n", out);
}

static void write_segments(FILE *out, const wh_mcs_t *mcs) {
    fputs("static const wh_segment_t played_segments[] = {\n", out);
    for (size_t i = 0; i < mcs->segment_count; ++i) {
        write_segment(out, &mcs->segments[i]);
    }
    /* C99 has no empty arrays, so one segment that does nothing follows the counted ones. */
    fprintf(out, "    {.kind = WH_SEGMENT_DWELL}};\nstatic const size_t played_segment_count = %zu;\n\n",
            mcs->segment_count);
}

/* ------------------------------------------------------------------------------------------------- wafers */

static void write_config(FILE *out, const wh_grasp_config_t *config) {
    fprintf(out,
            "static const wh_grasp_config_t played_config = {\n    .tolerance = {%a, %a, %a},\n"
            "    .check = %s,\n    .seat = %s,\n    .near_projz = %a,\n    .near_projxy = %a};\n\n",
            config->tolerance.projz, config->tolerance.projxy, config->tolerance.planar,
            config->check == WH_CHECK_SWEPT ? "WH_CHECK_SWEPT" : "WH_CHECK_SAMPLED",
            config->seat ? "true" : "false", config->near_projz, config->near_projxy);
}

static void write_wafers(FILE *out, const wh_layout_t *layout) {
    fputs("static const wh_pose_t played_wafers[] = {\n", out);
    for (size_t w = 0; w < layout->wafer_count; ++w) {
        fputs("    ", out);
        write_pose(out, &layout->start[w].base_from_wafer);
        fputs(",\n", out);
    }
    fprintf(out,
            "    {{{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}}, {0, 0, 0}}};\nstatic const size_t played_wafer_count "
            "= %zu;\n\n",
            layout->wafer_count);
}

static void write_all(FILE *out, const wh_mcs_t *mcs) {
    fprintf(out, "/* The motion of a run, as waferhand " WH_VERSION " played it: see wh_track_begin.\n"
                 " * Arrays have one entry more than their counts say. */\n#include <waferhand.h>\n\n");
    write_machine(out, &mcs->layout->machine);
    fprintf(out, "static const int64_t played_slice_us = %" PRId64 ";\n\n", mcs->layout->slice_us);
    write_segments(out, mcs);
    write_config(out, &mcs->layout->grasp);
    write_wafers(out, mcs->layout);
    fprintf(out, "static const int64_t played_slices = %" PRId64 ";\n", mcs->recorder.record->slices);
    fprintf(out, "static const uint64_t played_hash = UINT64_C(0x%016" PRIx64 ");\n",
            mcs->recorder.record->hash);
}

int wh_segments_write(const wh_mcs_t *mcs, const char *path) {
    wh_output_t output = {0};
    if (!wh_output_open(&output, path)) {
        return -1;
    }
    if (mcs->layout) {
        write_all(output.file, mcs);
    }
    return wh_output_commit(&output) ? 0 : -1;
}
