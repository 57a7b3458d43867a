#include "segments.h"

#include <ctype.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "../math/hash.h"
#include "../text/array.h"
#include "segments_internal.h"

/* ------------------------------------------------------------------------------------------------- names */

static bool is_word(char c) {
    return isascii((unsigned char)c) && isalnum((unsigned char)c);
}

static bool is_letter(char c) {
    return is_word(c) && !isdigit((unsigned char)c);
}

/* The file's name up to its first dot, as a C identifier. */
static void name_prefix(wh_segments_writer_t *writer, const char *path) {
    const char *slash = strrchr(path, '/');
    const char *from = slash ? slash + 1 : path;
    char *prefix = writer->prefix;
    size_t length = is_letter(from[0]) ? 0 : (size_t)snprintf(prefix, WH_SEGMENTS_PREFIX, "run_");
    for (; *from != '\0' && *from != '.' && length + 1 < WH_SEGMENTS_PREFIX; ++from) {
        if (is_word(*from) || prefix[length - 1] != '_') {
            prefix[length++] = (char)(is_word(*from) ? *from : '_');
        }
    }
    while (prefix[length - 1] == '_') {
        --length;
    }
    prefix[length] = '\0';
}

static void name_constants(wh_segments_writer_t *writer) {
    for (size_t i = 0; i == 0 || writer->prefix[i - 1] != '\0'; ++i) {
        writer->upper[i] = (char)toupper((unsigned char)writer->prefix[i]);
    }
}

static void read_lines(wh_segments_writer_t *writer) {
    FILE *in = fopen(writer->of->source, "r");
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

static void free_lines(wh_segments_writer_t *writer) {
    for (size_t i = 0; i < writer->line_count; ++i) {
        free(writer->lines[i]);
    }
    free(writer->lines);
}

/* -------------------------------------------------------------------------------------------------- rows */

/* The bytes of a log's line that stand above its rows, at most. */
#define LOG_LINE 100

/* Writes the first `most` bytes of a line of the script without the blanks around it, and in a form that
 * cannot end a comment. */
static void write_some_in_comment(FILE *out, const char *text, size_t most) {
    size_t length = strnlen(text, most);
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

static void write_in_comment(FILE *out, const char *text) {
    write_some_in_comment(out, text, strlen(text));
}

static void write_line(const wh_segments_writer_t *writer, int32_t line) {
    fprintf(writer->out, "line %" PRId32 ": ", line);
    if (line > 0 && (size_t)line <= writer->line_count) {
        write_some_in_comment(writer->out, writer->lines[line - 1], writer->of->record ? SIZE_MAX : LOG_LINE);
    }
}

/* Writes where the following rows come from: the script's line and the command as an operator types it; where
 * several robots take turns, only the command from the second time on. */
static void write_command(const wh_segments_writer_t *writer, int32_t index) {
    const wh_record_t *record = writer->of->record;
    if (!wh_is_index(index, record->command_count)) {
        return;
    }
    const wh_command_record_t *command = &record->commands[index];
    fputs("    /* ", writer->out);
    if (!writer->is_told[index]) {
        write_line(writer, command->line);
        fputs(command->line > 0 && (size_t)command->line <= writer->line_count ? " : " : "", writer->out);
    }
    writer->is_told[index] = true;
    write_in_comment(writer->out, command->text ? command->text : "");
    fputs(" */\n", writer->out);
}

static void write_origin(const wh_segments_writer_t *writer, int32_t origin) {
    if (writer->of->record) {
        write_command(writer, origin);
    } else {
        fputs("    /* ", writer->out);
        write_line(writer, origin);
        fputs(" */\n", writer->out);
    }
}

static void put_row(const wh_segments_writer_t *writer, size_t i) {
    static const char *const kinds[] = {
        [WH_PLAYED_AXES] = "AXES", [WH_PLAYED_LINE] = "LINE",     [WH_PLAYED_WAY] = "WAY",
        [WH_PLAYED_VIA] = "VIA",   [WH_PLAYED_VALVES] = "VALVES", [WH_PLAYED_MORE] = "MORE",
        [WH_PLAYED_SLOW] = "SLOW", [WH_PLAYED_POINT] = "POINT",   [WH_PLAYED_PLACE] = "PLACE",
    };
    const wh_played_row_t *row = &writer->of->rows[i];
    const wh_segments_origin_t *origin = &writer->of->origins[i];
    if (i == 0 || origin->command != origin[-1].command) {
        write_origin(writer, origin->command);
    }
    fprintf(writer->out, "    {%" PRId64 ", %" PRId64 ", WH_PLAYED_%s, %s, %" PRId32 ", 0x%" PRIx32 ", ",
            row->after, row->slices, kinds[row->kind], row->is_cut ? "true" : "false", row->gripper,
            row->bits);
    wh_segments_put_reals(writer->out, row->values, origin->values);
    fputs("}", writer->out);
}

static void put_kept_fault(const wh_segments_writer_t *writer, size_t i) {
    const wh_played_fault_t *fault = &writer->of->run.faults[i];
    fprintf(writer->out, "    {%" PRId64 ", {%" PRId32 ", ", fault->seq, fault->request.index);
    wh_segments_put_fault(writer->out, &fault->request.fault);
    fputs("}}", writer->out);
}

/* --------------------------------------------------------------------------------------------- the whole */

static void put_config(FILE *out, const wh_grasp_config_t *config) {
    fputs("    {", out);
    wh_segments_put_tolerance(out, &config->tolerance);
    fprintf(out, ", %s, %s, ", config->check == WH_CHECK_SWEPT ? "WH_CHECK_SWEPT" : "WH_CHECK_SAMPLED",
            config->seat ? "true" : "false");
    wh_segments_put_real(out, (double)config->near_projz);
    fputs(", ", out);
    wh_segments_put_real(out, (double)config->near_projxy);
    fputs("},\n", out);
}

static void put_vacuum(FILE *out, const wh_vacuum_config_t *v) {
    const wh_real_t values[] = {v->build, v->vent, v->idle, v->on, v->off, v->release};
    for (size_t i = 0; i < sizeof values / sizeof values[0]; ++i) {
        fputs(i > 0 ? ", " : "{", out);
        wh_segments_put_real(out, (double)values[i]);
    }
    fprintf(out, ", %" PRId32 "}", v->debounce);
}

static void put_physics(FILE *out, const wh_physics_t *physics) {
    static const wh_fault_t none = {0};
    const wh_pads_t *pads = &physics->pads;
    fputs("    {", out);
    wh_segments_put_real(out, (double)physics->slice_s);
    fputs(", ", out);
    put_vacuum(out, &physics->vacuum);
    fputs(", ", out);
    wh_segments_put_reals(out, (const wh_real_t[]){pads->friction, pads->force, pads->mass, pads->gravity},
                          4);
    for (size_t i = 0; i < physics->fault_count || i == 0; ++i) {
        fputs(i > 0 ? ",\n      " : ",\n     {", out);
        wh_segments_put_fault(out, physics->fault_count > 0 ? &physics->faults[i] : &none);
    }
    fprintf(out, "}, %zu},\n", physics->fault_count);
}

static void put_cell_member(const wh_segments_writer_t *writer) {
    const wh_cell_t *cell = &writer->of->run.cell;
    FILE *out = writer->out;
    fputs("    {", out);
    wh_segments_put_reference(writer, "stations", cell->count);
    fputs(", ", out);
    wh_segments_put_tolerance(out, &cell->tolerance);
    const wh_real_t before[] = {cell->off_centre, cell->askew};
    for (size_t i = 0; i < sizeof before / sizeof before[0]; ++i) {
        fputs(", ", out);
        wh_segments_put_real(out, (double)before[i]);
    }
    fprintf(out, ", %s, ", cell->settle ? "true" : "false");
    wh_segments_put_real(out, (double)cell->thickness);
    fputs(", ", out);
    wh_segments_put_real(out, (double)cell->drop);
    fputs("},\n", out);
}

static void put_run(const wh_segments_writer_t *writer) {
    const wh_played_t *run = &writer->of->run;
    FILE *out = writer->out;
    fprintf(out, "static const wh_played_t %s_run = {\n    &%s_machine, ", writer->prefix, writer->prefix);
    wh_segments_put_reference(writer, "rows", run->row_count);
    fprintf(out, ", %zu, ", run->motion_count);
    wh_segments_put_reference(writer, "faults", run->fault_count);
    fputs(", ", out);
    wh_segments_put_reference(writer, "orders", run->order_count);
    fputs(", ", out);
    wh_segments_put_reference(writer, "wafers", run->wafer_count);
    fprintf(out, ", %" PRId64 ",\n", run->slice_us);
    put_config(out, &run->config);
    put_physics(out, &run->physics);
    put_cell_member(writer);
    wh_segments_put_parts_member(writer);
    fprintf(out, "    %" PRId64 ", UINT64_C(0x%016" PRIx64 "), UINT64_C(0x%016" PRIx64 ")};\n\n", run->slices,
            run->hash, run->inputs);
}

/* C has no empty arrays: what is not there has room for one. */
static void put_player(const wh_segments_writer_t *writer) {
    const wh_played_t *run = &writer->of->run;
    const bool has_grips = run->parts.set_grips != NULL;
    const bool is_slow = run->parts.begin_slowly != NULL;
    const char *prefix = writer->prefix;
    const char *upper = writer->upper;
    FILE *out = writer->out;
    fprintf(out,
            "enum { %s_WAFERS = %zu, %s_GRIPPERS = %zu, %s_MOTIONS = %zu };\n\n"
            "typedef struct {\n    wh_player_t player;\n    wh_wafer_t wafers[%zu];\n"
            "    wh_gripper_t grippers[%s_GRIPPERS];\n    wh_played_motion_t motions[%zu];\n",
            upper, run->wafer_count, upper, run->machine->gripper_count, upper, run->motion_count,
            run->wafer_count > 0 ? run->wafer_count : 1, upper,
            run->motion_count > 0 ? run->motion_count : 1);
    if (has_grips) {
        fprintf(out, "    wh_wafer_t seen[%zu];\n", run->wafer_count > 0 ? run->wafer_count : 1);
    }
    fprintf(out,
            "%s} %s_player_t;\n\nstatic inline wh_status_t %s_begin(%s_player_t *memory) {\n"
            "    const wh_played_room_t room = {memory->wafers, %s_WAFERS, memory->grippers, %s_GRIPPERS,\n"
            "                                   memory->motions, %s_MOTIONS, %s, %s};\n"
            "    return wh_player_init(&memory->player, &%s_run, &room);\n}\n\n#endif\n",
            is_slow ? "    wh_slow_t slow;\n" : "", prefix, prefix, prefix, upper, upper, upper,
            has_grips ? "memory->seen" : "NULL", is_slow ? "&memory->slow" : "NULL", prefix);
}

/* A target without an operating system has few axes and grippers, unless it is told. */
static void put_counts(const wh_segments_writer_t *writer) {
    const wh_machine_t *machine = writer->of->run.machine;
    fprintf(writer->out,
            "#if WH_AXES < %zu || WH_GRIPPERS < %zu\n"
            "#error \"this run has %zu axes and %zu grippers: build library and program with "
            "-DWH_MOST_AXES=%zu -DWH_MOST_GRIPPERS=%zu or more\"\n#endif\n\n",
            machine->axis_count, machine->gripper_count, machine->axis_count, machine->gripper_count,
            machine->axis_count, machine->gripper_count);
}

/* Several file names give one C name. So the guard depends on the contents: one file may be included twice,
 * but a second, different file is an error. */
static void put_head(const wh_segments_writer_t *writer, uint64_t contents) {
    const char *upper = writer->upper;
    fputs("/* ", writer->out);
    write_in_comment(writer->out, writer->of->source);
    fprintf(
        writer->out,
        " as waferhand " WH_VERSION " played it: see waferhand/sim/played.h.\n"
        " * Each line of the %s. */\n"
        "#ifdef %s_RUN_H\n#if %s_RUN_H != 0x%016" PRIx64 "u\n"
        "#error \"another file has the names %s_run and %s_WAFERS: call one of the two files otherwise\"\n"
        "#endif\n#else\n#define %s_RUN_H 0x%016" PRIx64 "u\n\n#include <waferhand.h>\n\n",
        writer->of->record ? "script stands above its rows, and the command that it gave"
                           : "log stands above its rows",
        upper, upper, contents, writer->prefix, upper, upper, contents);
}

static void put_contents(wh_segments_writer_t *writer) {
    read_lines(writer);
    if (writer->of->record) {
        writer->is_told = wh_array_new(writer->of->record->command_count, sizeof *writer->is_told);
    }
    put_counts(writer);
    wh_segments_put_cell(writer);
    wh_segments_put_parts(writer);
    wh_segments_put_array(writer, "wh_played_row_t", "rows", writer->of->row_count, put_row);
    wh_segments_put_array(writer, "wh_played_fault_t", "faults", writer->of->run.fault_count, put_kept_fault);
    put_run(writer);
    put_player(writer);
    free_lines(writer);
    free(writer->is_told);
}

static uint64_t hash_bytes(const char *bytes, size_t size) {
    uint64_t hash = WH_HASH_START;
    for (size_t i = 0; i < size; ++i) {
        hash = wh_hash_word(hash, (unsigned char)bytes[i]);
    }
    return hash;
}

/* The contents come first, because the head names their hash. */
static void put_all(wh_segments_writer_t *writer, FILE *out) {
    char *contents = NULL;
    size_t size = 0;
    writer->out = wh_memory_need(open_memstream(&contents, &size));
    put_contents(writer);
    (void)fclose(writer->out);
    writer->out = out;
    put_head(writer, hash_bytes(contents, size));
    (void)fwrite(contents, 1, size, out);
    free(contents);
}

bool wh_segments_write(void *segments, FILE *out) {
    wh_segments_writer_t writer = {.of = segments};
    name_prefix(&writer, writer.of->path);
    name_constants(&writer);
    put_all(&writer, out);
    return true;
}
