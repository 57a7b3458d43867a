#include "segments.h"

#include <ctype.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "../math/hash.h"
#include "../text/array.h"
#include "../text/digits.h"

/* Room for a prefix: a file's name. */
#define PREFIX_SIZE 256

/* The state of writing. */
typedef struct {
    FILE *out;
    const wh_record_t *record;
    const wh_layout_t *layout; /* with a trial's errors */
    const wh_mcs_kept_t *kept;
    char prefix[PREFIX_SIZE], upper[PREFIX_SIZE];
    char **lines; /* of the script; none if it cannot be read again */
    size_t line_count, line_capacity;
} writer_t;

static bool is_word(char c) {
    return isascii((unsigned char)c) && isalnum((unsigned char)c);
}

static bool is_letter(char c) {
    return is_word(c) && !isdigit((unsigned char)c);
}

/* The file's name up to its first dot, as a C identifier. */
static void name_prefix(writer_t *writer, const char *path) {
    const char *slash = strrchr(path, '/');
    const char *from = slash ? slash + 1 : path;
    char *prefix = writer->prefix;
    size_t length = is_letter(from[0]) ? 0 : (size_t)snprintf(prefix, PREFIX_SIZE, "run_");
    for (; *from != '\0' && *from != '.' && length + 1 < PREFIX_SIZE; ++from) {
        if (is_word(*from) || prefix[length - 1] != '_') {
            prefix[length++] = is_word(*from) ? *from : '_';
        }
    }
    while (prefix[length - 1] == '_') {
        --length;
    }
    prefix[length] = '\0';
}

static void name_constants(writer_t *writer) {
    for (size_t i = 0; i == 0 || writer->prefix[i - 1] != '\0'; ++i) {
        writer->upper[i] = (char)toupper((unsigned char)writer->prefix[i]);
    }
}

static void read_lines(writer_t *writer) {
    FILE *in = fopen(writer->record->script, "r");
    char *line = NULL;
    size_t size = 0;
    while (in && getline(&line, &size, in) >= 0) {
        writer->lines =
            wh_array_grow(writer->lines, writer->line_count, &writer->line_capacity, sizeof *writer->lines);
        writer->lines[writer->line_count++] = line;
        line = NULL;
        size = 0;
    }
    free(line);
    if (in) {
        (void)fclose(in);
    }
}

static void free_lines(writer_t *writer) {
    for (size_t i = 0; i < writer->line_count; ++i) {
        free(writer->lines[i]);
    }
    free(writer->lines);
}

/* ------------------------------------------------------------------------------------------------ numbers */

/* With a point or an exponent: a whole number would be of another type. */
static void write_real(FILE *out, wh_real_t value) {
    char text[WH_DIGITS];
    wh_digits(value, text);
    fprintf(out, "%s%s", text, strpbrk(text, ".en") ? "" : ".0");
}

static void write_numbers(FILE *out, const wh_real_t values[], size_t count) {
    for (size_t i = 0; i < count; ++i) {
        fputs(i > 0 ? ", " : "{", out);
        write_real(out, values[i]);
    }
    fputs("}", out);
}

static void write_vector(FILE *out, const wh_vec3_t *v) {
    write_numbers(out, (const wh_real_t[]){v->x, v->y, v->z}, 3);
}

static void write_tolerance(FILE *out, const wh_tolerance_t *t) {
    write_numbers(out, (const wh_real_t[]){t->projz, t->projxy, t->planar}, 3);
}

static void write_pose(FILE *out, const wh_pose_t *pose) {
    for (size_t row = 0; row < 3; ++row) {
        fputs(row > 0 ? ", " : "{{{", out);
        write_numbers(out, pose->R.m[row], 3);
    }
    fputs("}}, ", out);
    write_vector(out, &pose->r);
    fputs("}", out);
}

/* An array with each item on lines of its own. C99 has no empty arrays: without items the first one is
 * written anyway. */
static void write_array(const writer_t *writer, const char *type, const char *name, size_t count,
                        void (*write)(const writer_t *writer, size_t i)) {
    fprintf(writer->out, "static const %s %s_%s[] = {\n", type, writer->prefix, name);
    for (size_t i = 0; i < count || i == 0; ++i) {
        write(writer, i);
        fputs(i + 1 < count ? ",\n" : "};\n\n", writer->out);
    }
}

/* ------------------------------------------------------------------------------------------------ machine */

static void write_limits(FILE *out, const wh_limits_t *limits) {
    write_numbers(out, (const wh_real_t[]){limits->speed, limits->acceleration, limits->jerk}, 3);
}

static void write_robot(FILE *out, const wh_robot_t *robot) {
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        fputs(axis > 0 ? ", " : "    {{", out);
        write_numbers(out, (const wh_real_t[]){robot->travel[axis].min, robot->travel[axis].max}, 2);
    }
    for (size_t axis = 0; axis < WH_ROBOT_AXES; ++axis) {
        fputs(axis > 0 ? ", " : "},\n     {", out);
        write_limits(out, &robot->limits[axis]);
    }
    fputs("},\n     ", out);
    write_numbers(out, robot->home, WH_ROBOT_AXES);
    fputs("},\n    ", out);
}

/* Writes the rest of a mount. */
static void write_slides(FILE *out, const wh_mount_t *mount) {
    static const char *const kinds[] = {"WH_MOUNT_CHUCK", "WH_MOUNT_STAGE", "WH_MOUNT_PINS",
                                        "WH_MOUNT_FLIPPER"};
    fprintf(out, ", %s, ", kinds[mount->kind]);
    write_numbers(out, (const wh_real_t[]){mount->travel.min, mount->travel.max}, 2);
    fputs(", ", out);
    write_limits(out, &mount->limits);
    fputs(", ", out);
    write_real(out, mount->height);
    fputs("}", out);
}

static void write_machine(const writer_t *writer) {
    const wh_machine_t *machine = &writer->layout->machine;
    FILE *out = writer->out;
    fprintf(out, "static const wh_machine_t %s_machine = {\n", writer->prefix);
    write_robot(out, &machine->robot);
    write_limits(out, &machine->chuck_limits);
    fprintf(out, ",\n    %zu,\n    %zu,\n    {", machine->axis_count, machine->gripper_count);
    for (size_t g = 0; g < machine->gripper_count; ++g) {
        fprintf(out, "%s{%" PRId32 ", ", g > 0 ? ",\n     " : "", machine->mounts[g].axis);
        write_pose(out, &machine->mounts[g].base_from_station);
        fprintf(out, ", %s, %d, %d, ", machine->mounts[g].is_shifted ? "true" : "false",
                machine->mounts[g].robot, machine->mounts[g].arm);
        write_pose(out, &machine->mounts[g].effector_from_gripper);
        write_slides(out, &machine->mounts[g]);
    }
    fputs("},\n    NULL,\n    NULL,\n    0};\n\n", out);
}

/* ----------------------------------------------------------------------------------------------- segments */

/* Writes a line of the script without the blanks around it, and in a form that cannot end a comment. */
static void write_in_comment(FILE *out, const char *text) {
    size_t length = strlen(text);
    while (length > 0 && isspace((unsigned char)text[length - 1])) {
        --length;
    }
    const size_t blanks = strspn(text, " \t");
    for (size_t i = blanks; i < length; ++i) {
        const bool ends = i > blanks && strchr("*/", text[i]) && strchr("*/", text[i - 1]);
        fputs(ends ? " " : "", out);
        fputc(iscntrl((unsigned char)text[i]) || text[i] == '\\' ? ' ' : text[i], out);
    }
}

/* Writes the origin of the following segments: the script's line, and the command as an operator types it. */
static void write_command(const writer_t *writer, int32_t index) {
    const wh_record_t *record = writer->record;
    if (!wh_is_index(index, record->command_count)) {
        return;
    }
    const wh_command_record_t *command = &record->commands[index];
    fprintf(writer->out, "    /* line %d: ", command->line);
    if (command->line > 0 && (size_t)command->line <= writer->line_count) {
        write_in_comment(writer->out, writer->lines[command->line - 1]);
        fputs(" : ", writer->out);
    }
    write_in_comment(writer->out, command->text ? command->text : "");
    fputs(" */\n", writer->out);
}

static void write_segment(const writer_t *writer, size_t index) {
    static const char *const kinds[] = {
        [WH_SEGMENT_AXES] = "AXES",   [WH_SEGMENT_LINE] = "LINE",     [WH_SEGMENT_VALVES] = "VALVES",
        [WH_SEGMENT_DWELL] = "DWELL", [WH_SEGMENT_SENSOR] = "SENSOR", [WH_SEGMENT_WAY] = "WAY",
    };
    static const wh_kept_segment_t none = {.segment.kind = WH_SEGMENT_DWELL, .command = WH_NONE};
    const wh_kept_segment_t *kept = writer->kept->segment_count > 0 ? &writer->kept->segments[index] : &none;
    const wh_segment_t *segment = &kept->segment;
    const wh_real_t values[] = {segment->speed, segment->acceleration, segment->seconds};
    FILE *out = writer->out;
    if (index == 0 || kept->command != kept[-1].command) {
        write_command(writer, kept->command);
    }
    fprintf(out, "    {{WH_SEGMENT_%s, ", kinds[segment->kind]);
    write_numbers(out, segment->target, WH_AXES);
    fputs(", ", out);
    write_vector(out, &segment->travel);
    for (size_t i = 0; i < 3; ++i) {
        fputs(", ", out);
        write_real(out, values[i]);
    }
    for (size_t g = 0; g < WH_GRIPPERS; ++g) {
        fprintf(out, "%s%" PRId32, g > 0 ? ", " : ", {", segment->valves[g]);
    }
    fprintf(out, "}, %" PRId32 ", ", segment->gripper);
    write_real(out, segment->reach);
    fputs(", NULL, 0, ", out); /* a run by via points is refused */
    write_real(out, segment->reach2);
    fprintf(out, "}, %" PRId64 "}", kept->ended ? 0 : kept->slices);
}

/* ------------------------------------------------------------------------------------------------- faults */

static void write_time(FILE *out, int64_t slice) {
    if (slice == WH_FAULT_FOREVER) {
        fputs(", WH_FAULT_FOREVER", out);
    } else {
        fprintf(out, ", %" PRId64, slice);
    }
}

static void write_fault(FILE *out, const wh_fault_t *fault) {
    fputs("{WH_FAULT_", out);
    for (const char *c = wh_fault_name(fault->kind); *c != '\0'; ++c) {
        fputc(toupper((unsigned char)*c), out);
    }
    fprintf(out, ", %" PRId32 ", %" PRId32 ", ", fault->target, fault->other);
    write_real(out, fault->value);
    fputs(", ", out);
    write_pose(out, &fault->offset);
    write_time(out, fault->from);
    write_time(out, fault->until);
    fputs("}", out);
}

static void write_kept_fault(const writer_t *writer, size_t i) {
    static const wh_played_fault_t none = {0};
    const wh_played_fault_t *fault = writer->kept->fault_count > 0 ? &writer->kept->faults[i] : &none;
    fprintf(writer->out, "    {%" PRId64 ", {%" PRId32 ", ", fault->seq, fault->request.index);
    write_fault(writer->out, &fault->request.fault);
    fputs("}}", writer->out);
}

/* --------------------------------------------------------------------------------------------------- cell */

static void write_station(const writer_t *writer, size_t i) {
    static const wh_station_t none = {.slots = 1, .pitch = 1, .chuck = WH_NONE};
    const wh_cell_t *cell = &writer->layout->cell;
    const wh_station_t *station = cell->count > 0 ? &cell->stations[i] : &none;
    fputs("    {", writer->out);
    write_pose(writer->out, &station->base_from_station);
    fprintf(writer->out, ", %" PRId32 ", ", station->slots);
    write_real(writer->out, station->pitch);
    fprintf(writer->out, ", %" PRId32 "}", station->chuck);
}

static void write_wafer(const writer_t *writer, size_t i) {
    const wh_pose_t none = wh_pose_identity();
    const wh_layout_t *layout = writer->layout;
    fputs("    ", writer->out);
    write_pose(writer->out, layout->wafer_count > 0 ? &layout->start[i].base_from_wafer : &none);
}

/* ---------------------------------------------------------------------------------------------- the whole */

static void write_config(FILE *out, const wh_grasp_config_t *config) {
    fputs("    {", out);
    write_tolerance(out, &config->tolerance);
    fprintf(out, ", %s, %s, ", config->check == WH_CHECK_SWEPT ? "WH_CHECK_SWEPT" : "WH_CHECK_SAMPLED",
            config->seat ? "true" : "false");
    write_real(out, config->near_projz);
    fputs(", ", out);
    write_real(out, config->near_projxy);
    fputs("},\n", out);
}

static void write_vacuum(FILE *out, const wh_vacuum_config_t *v) {
    const wh_real_t values[] = {v->build, v->vent, v->idle, v->on, v->off, v->release};
    for (size_t i = 0; i < sizeof values / sizeof values[0]; ++i) {
        fputs(i > 0 ? ", " : "{", out);
        write_real(out, values[i]);
    }
    fprintf(out, ", %" PRId32 "}", v->debounce);
}

static void write_physics(FILE *out, const wh_physics_t *physics) {
    static const wh_fault_t none = {0};
    const wh_pads_t *pads = &physics->pads;
    fputs("    {", out);
    write_real(out, physics->slice_s);
    fputs(", ", out);
    write_vacuum(out, &physics->vacuum);
    fputs(", ", out);
    write_numbers(out, (const wh_real_t[]){pads->friction, pads->force, pads->mass, pads->gravity}, 4);
    for (size_t i = 0; i < physics->fault_count || i == 0; ++i) {
        fputs(i > 0 ? ",\n      " : ",\n     {", out);
        write_fault(out, physics->fault_count > 0 ? &physics->faults[i] : &none);
    }
    fprintf(out, "}, %zu},\n", physics->fault_count);
}

static void write_cell(const writer_t *writer) {
    const wh_cell_t *cell = &writer->layout->cell;
    fprintf(writer->out, "    {%s_stations, %zu, ", writer->prefix, cell->count);
    write_tolerance(writer->out, &cell->tolerance);
    fputs(", ", writer->out);
    write_real(writer->out, cell->off_centre);
    fputs(", ", writer->out);
    write_real(writer->out, cell->askew);
    fprintf(writer->out, ", %s, 0, ", cell->settle ? "true" : "false");
    write_real(writer->out, cell->drop);
    fputs("},\n", writer->out);
}

/* A run without ways does not link the code for ways. */
static const char *taker_of_ways(const wh_mcs_kept_t *kept) {
    for (size_t i = 0; i < kept->segment_count; ++i) {
        if (kept->segments[i].segment.kind == WH_SEGMENT_WAY) {
            return "wh_track_take_ways";
        }
    }
    return "NULL";
}

static void write_run(const writer_t *writer) {
    const wh_layout_t *layout = writer->layout;
    const wh_mcs_kept_t *kept = writer->kept;
    const char *prefix = writer->prefix;
    fprintf(writer->out,
            "enum { %s_WAFERS = %zu, %s_GRIPPERS = %zu };\n\nstatic const wh_played_t %s_run = {\n"
            "    &%s_machine, %s_segments, %zu, %s_faults, %zu, %s_wafers, %s_WAFERS, %" PRId64 ",\n",
            writer->upper, layout->wafer_count, writer->upper, layout->machine.gripper_count, prefix, prefix,
            prefix, kept->segment_count, prefix, kept->fault_count, prefix, writer->upper, layout->slice_us);
    write_config(writer->out, &layout->grasp);
    write_physics(writer->out, &layout->physics);
    write_cell(writer);
    fprintf(writer->out, "    %" PRId64 ", UINT64_C(0x%016" PRIx64 "), %s};\n\n#endif\n",
            writer->record->slices, writer->record->hash, taker_of_ways(kept));
}

/* Several file names give one C name. So the guard depends on the contents: one file may be included twice,
 * but a second, different file is an error. */
static void write_head(const writer_t *writer, uint64_t contents) {
    const char *upper = writer->upper;
    fputs("/* ", writer->out);
    write_in_comment(writer->out, writer->record->script);
    fprintf(
        writer->out,
        " as waferhand " WH_VERSION " played it: see waferhand/sim/played.h.\n"
        " * Each line of the script stands above its segments, and the command that it gave. */\n"
        "#ifdef %s_RUN_H\n#if %s_RUN_H != 0x%016" PRIx64 "u\n"
        "#error \"another file has the names %s_run and %s_WAFERS: call one of the two files otherwise\"\n"
        "#endif\n#else\n#define %s_RUN_H 0x%016" PRIx64 "u\n\n#include <waferhand.h>\n\n",
        upper, upper, contents, writer->prefix, upper, upper, contents);
}

static void write_contents(writer_t *writer) {
    read_lines(writer);
    write_machine(writer);
    write_array(writer, "wh_played_segment_t", "segments", writer->kept->segment_count, write_segment);
    write_array(writer, "wh_played_fault_t", "faults", writer->kept->fault_count, write_kept_fault);
    write_array(writer, "wh_station_t", "stations", writer->layout->cell.count, write_station);
    write_array(writer, "wh_pose_t", "wafers", writer->layout->wafer_count, write_wafer);
    write_run(writer);
    free_lines(writer);
}

static uint64_t hash_bytes(const char *bytes, size_t size) {
    uint64_t hash = WH_HASH_START;
    for (size_t i = 0; i < size; ++i) {
        hash = wh_hash_word(hash, (unsigned char)bytes[i]);
    }
    return hash;
}

/* The contents come first, because the head names their hash. */
static void write_all(writer_t *writer, FILE *out) {
    char *contents = NULL;
    size_t size = 0;
    writer->out = wh_memory_need(open_memstream(&contents, &size));
    write_contents(writer);
    (void)fclose(writer->out);
    writer->out = out;
    write_head(writer, hash_bytes(contents, size));
    (void)fwrite(contents, 1, size, out);
    free(contents);
}

bool wh_segments_write(void *segments, FILE *out) {
    const wh_segments_t *wanted = segments;
    writer_t writer = {.record = wh_mcs_record(wanted->mcs),
                       .layout = wh_mcs_true_layout(wanted->mcs),
                       .kept = wh_mcs_kept(wanted->mcs)};
    if (writer.layout) {
        name_prefix(&writer, wanted->path);
        name_constants(&writer);
        write_all(&writer, out);
    }
    return true;
}
