/* The cell of a played run as C source: robots, doors, machine, stations, wafers. */
#include <inttypes.h>

#include "segments_internal.h"

/* ------------------------------------------------------------------------------------------------ robots */

/* The number of a robot's first arm among all carriers. */
static size_t number_of(const wh_machine_t *machine, const wh_carrier_t *carrier) {
    size_t number = 0;
    for (const wh_carrier_t *one = machine->carrier; one != carrier; one = one->next) {
        number += one->second ? 2 : 1;
    }
    return number;
}

static size_t count_carriers(const wh_machine_t *machine) {
    return number_of(machine, NULL);
}

static void put_axes(FILE *out, const wh_chain_t *chain) {
    fputs("{", out);
    for (size_t axis = 0; axis < WH_CHAIN_AXES; ++axis) {
        fputs(axis > 0 ? ", " : "", out);
        wh_segments_put_travel(out, &chain->travel[axis]);
    }
    fputs("},\n      {", out);
    for (size_t axis = 0; axis < WH_CHAIN_AXES; ++axis) {
        fputs(axis > 0 ? ", " : "", out);
        wh_segments_put_limits(out, &chain->limits[axis]);
    }
    fputs("},\n      ", out);
    wh_segments_put_reals(out, chain->home, WH_CHAIN_AXES);
}

static void put_chain(FILE *out, const wh_chain_t *chain) {
    static const char *const kinds[] = {
        [WH_CHAIN_TRZY] = "TRZY", [WH_CHAIN_TRZ] = "TRZ", [WH_CHAIN_SCARA] = "SCARA"};
    const bool has[] = {chain->has_rail, chain->has_tilt, chain->has_flip, chain->is_placed};
    const wh_real_t lengths[] = {chain->arm_heading, chain->height, chain->flip_height};
    fprintf(out, "     {WH_CHAIN_%s, ", kinds[chain->kind]);
    for (size_t i = 0; i < sizeof has / sizeof has[0]; ++i) {
        wh_segments_put_bool(out, has[i]);
        fputs(", ", out);
    }
    wh_segments_put_pose(out, &chain->base_from_robot);
    for (size_t i = 0; i < sizeof lengths / sizeof lengths[0]; ++i) {
        fputs(", ", out);
        wh_segments_put_real(out, (double)lengths[i]);
    }
    fputs(", ", out);
    wh_segments_put_reals(out, chain->links, 2);
    fputs(",\n      ", out);
    put_axes(out, chain);
    fputs("},\n", out);
}

/* A pointer to one of the carriers, or NULL. */
static void put_pointer(const wh_segments_writer_t *writer, bool is_there, size_t number) {
    if (is_there) {
        fprintf(writer->out, "&%s_robots[%zu]", writer->prefix, number);
    } else {
        fputs("NULL", writer->out);
    }
}

static void put_carrier(const wh_segments_writer_t *writer, const wh_carrier_t *carrier, size_t next,
                        size_t second) {
    FILE *out = writer->out;
    fputs("    {", out);
    put_pointer(writer, next > 0, next);
    fputs(", ", out);
    put_pointer(writer, second > 0, second);
    fputs(",\n", out);
    put_chain(out, &carrier->chain);
    fprintf(out, "     %zu, {", carrier->axis_count);
    for (size_t axis = 0; axis < carrier->axis_count; ++axis) {
        fprintf(out, "%s%u", axis > 0 ? ", " : "", (unsigned)carrier->axes[axis]);
    }
    fputs("}, WH_CARRIER_CALLS}", out);
}

/* The arms of all robots, each robot's second behind its first. */
static void put_robots(const wh_segments_writer_t *writer, const wh_machine_t *machine) {
    const size_t count = count_carriers(machine);
    size_t number = 0;
    if (count == 0) {
        return;
    }
    fprintf(writer->out, "static const wh_carrier_t %s_robots[%zu] = {\n", writer->prefix, count);
    for (const wh_carrier_t *carrier = machine->carrier; carrier; carrier = carrier->next) {
        const size_t second = carrier->second ? number + 1 : 0;
        const size_t next = number + (carrier->second ? 2 : 1);
        put_carrier(writer, carrier, carrier->next ? next : 0, second);
        if (carrier->second) {
            fputs(",\n", writer->out);
            put_carrier(writer, carrier->second, 0, 0);
        }
        fputs(carrier->next ? ",\n" : "};\n\n", writer->out);
        number = next;
    }
}

/* ----------------------------------------------------------------------------------------------- machine */

static void put_door(const wh_segments_writer_t *writer, size_t i) {
    const wh_door_t *door = &writer->of->run.machine->doors[i];
    fputs("    {", writer->out);
    wh_segments_put_vector(writer->out, &door->way);
    fputs(", ", writer->out);
    wh_segments_put_real(writer->out, (double)door->travel);
    fputs(", ", writer->out);
    wh_segments_put_bool(writer->out, door->is_open);
    fputs(", ", writer->out);
    wh_segments_put_limits(writer->out, &door->limits);
    fputs("}", writer->out);
}

static void put_robot(FILE *out, const wh_robot_t *robot) {
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        fputs(axis > 0 ? ", " : "    {{", out);
        wh_segments_put_travel(out, &robot->travel[axis]);
    }
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        fputs(axis > 0 ? ", " : "},\n     {", out);
        wh_segments_put_limits(out, &robot->limits[axis]);
    }
    fputs("},\n     ", out);
    wh_segments_put_reals(out, robot->home, WH_ROBOT_AXES);
    fputs("},\n    ", out);
}

static void put_mount(FILE *out, const wh_mount_t *mount) {
    static const char *const kinds[] = {[WH_MOUNT_CHUCK] = "CHUCK",
                                        [WH_MOUNT_STAGE] = "STAGE",
                                        [WH_MOUNT_PINS] = "PINS",
                                        [WH_MOUNT_FLIPPER] = "FLIPPER"};
    fprintf(out, "{%" PRId32 ", ", mount->axis);
    wh_segments_put_pose(out, &mount->base_from_station);
    fprintf(out, ", %s, %d, %d, ", mount->is_shifted ? "true" : "false", mount->robot, mount->arm);
    wh_segments_put_pose(out, &mount->effector_from_gripper);
    fprintf(out, ", WH_MOUNT_%s, ", kinds[mount->kind]);
    wh_segments_put_travel(out, &mount->travel);
    fputs(", ", out);
    wh_segments_put_limits(out, &mount->limits);
    fputs(", ", out);
    wh_segments_put_real(out, (double)mount->height);
    fputs("}", out);
}

static void put_machine(const wh_segments_writer_t *writer) {
    const wh_machine_t *machine = writer->of->run.machine;
    FILE *out = writer->out;
    fprintf(out, "static const wh_machine_t %s_machine = {\n", writer->prefix);
    put_robot(out, &machine->robot);
    wh_segments_put_limits(out, &machine->chuck_limits);
    fprintf(out, ", %zu, %zu,\n    {", machine->axis_count, machine->gripper_count);
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        fputs(g > 0 ? ",\n     " : "", out);
        put_mount(out, &machine->mounts[g]);
    }
    fputs("},\n    ", out);
    put_pointer(writer, machine->carrier != NULL, 0);
    fputs(", ", out);
    wh_segments_put_reference(writer, "doors", machine->door_count);
    fputs("};\n\n", out);
}

/* ---------------------------------------------------------------------------------------------- the cell */

static void put_station(const wh_segments_writer_t *writer, size_t i) {
    const wh_station_t *station = &writer->of->run.cell.stations[i];
    fputs("    {", writer->out);
    wh_segments_put_pose(writer->out, &station->base_from_station);
    fprintf(writer->out, ", %" PRId32 ", ", station->slots);
    wh_segments_put_real(writer->out, (double)station->pitch);
    fprintf(writer->out, ", %" PRId32 "}", station->chuck);
}

static void put_wafer(const wh_segments_writer_t *writer, size_t i) {
    fputs("    ", writer->out);
    wh_segments_put_pose(writer->out, &writer->of->run.wafers[i]);
}

void wh_segments_put_cell(const wh_segments_writer_t *writer) {
    const wh_played_t *run = &writer->of->run;
    put_robots(writer, run->machine);
    wh_segments_put_array(writer, "wh_door_t", "doors", run->machine->door_count, put_door);
    put_machine(writer);
    wh_segments_put_array(writer, "wh_station_t", "stations", run->cell.count, put_station);
    wh_segments_put_array(writer, "wh_pose_t", "wafers", run->wafer_count, put_wafer);
}
