#include "replay_field.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../loop/field_map.h"
#include "../loop/field_run.h"
#include "../print/segments.h"
#include "../text/array.h"
#include "../text/digits.h"
#include "../text/json.h"
#include "../text/style.h"
#include "apart.h"
#include "app.h"
#include "sim_board_told.h"

#define USUAL_GAP_S 0.1
#define USUAL_REST 1e-6

/* The exit statuses are those of `replay`. */
enum { SAME = 0, DIFFERS = 1, INCOMPLETE = 3 };

const wh_option_t wh_replay_field_options[] = {
    {"field", 0, "FILE.csv",
     "Play this field log, a table of times, axes, valves and sensors, against the layout that is named",
     WH_OPTION_TEXT, .variable = offsetof(wh_replay_field_arguments_t, field)},
    {"columns", 0, "MAP.lua", "With --field: how its columns are read (default: those of `waferhand csv`)",
     WH_OPTION_TEXT, .variable = offsetof(wh_replay_field_arguments_t, columns)},
    {"gap", 0, "S", "With --field: rows farther apart leave a hole (default 0.1)", WH_OPTION_REAL,
     .variable = offsetof(wh_replay_field_arguments_t, gap_s), 1e-6, 1e6},
    {"within", 0, "S", "With --field: a sensor may differ from the cell's for so long (default: not at all)",
     WH_OPTION_REAL, .variable = offsetof(wh_replay_field_arguments_t, within_s), 1e-6, 1e6},
    {"moves", 0, "FILE.csv", "With --field: write its moves, for `waferhand estimate limits`", WH_OPTION_TEXT,
     .variable = offsetof(wh_replay_field_arguments_t, moves)},
    {"rest", 0, "N",
     "With --moves: an axis rests while it goes less than N mm or degrees from row to row (default 1e-6: its "
     "numbers stand)",
     WH_OPTION_REAL, .variable = offsetof(wh_replay_field_arguments_t, rest), 1e-9, 1e3},
    {"segments", 0, "FILE.h",
     "With --field: write what it did as C that a firmware test compiles and plays again, to the same hash",
     WH_OPTION_TEXT, .variable = offsetof(wh_replay_field_arguments_t, segments)},
    {0}};

void wh_replay_field_check(const void *filled, struct argp_state *state) {
    const wh_replay_field_arguments_t *given = filled;
    const struct {
        const char *name;
        bool is_given;
    } options[] = {{"columns", given->columns != NULL},
                   {"gap", given->gap_s > 0},
                   {"within", given->within_s > 0},
                   {"moves", given->moves != NULL},
                   {"segments", given->segments != NULL},
                   {"record", given->record.slices || given->record.all},
                   {"set", given->layout.parameters.count > 0},
                   {"memory", given->layout.memory_mib > 0}};
    for (size_t i = 0; !given->field && i < sizeof options / sizeof options[0]; ++i) {
        if (options[i].is_given) {
            argp_error(state, "--%s: goes with a field log (expected --field as well)", options[i].name);
        }
    }
    if (given->rest > 0 && !given->moves) {
        argp_error(state, "--rest: %g (goes with --moves)", given->rest);
    }
}

/* An event in words, and where in the log it was. */
typedef struct {
    double time_s;
    size_t line;
    bool is_complaint;
    char *text;
} heard_t;

typedef struct {
    const wh_replay_field_arguments_t *arguments;
    bool json;
    wh_field_log_t field;
    wh_plant_t plant;
    wh_field_run_t run;
    wh_field_moves_t moves;
    wh_segments_t segments;
    heard_t *heard;
    size_t heard_count, heard_capacity;
} replay_t;

static void hear(void *user, int64_t utime, const char *text, bool is_complaint) {
    replay_t *replay = user;
    (void)utime;
    replay->heard =
        wh_array_grow(replay->heard, replay->heard_count, &replay->heard_capacity, sizeof *replay->heard);
    char *kept = wh_array_new(strlen(text) + 1, 1);
    memcpy(kept, text, strlen(text) + 1);
    replay->heard[replay->heard_count++] =
        (heard_t){wh_field_time(&replay->run), replay->field.line, is_complaint, kept};
}

/* ------------------------------------------------------------------------------------------------ verdict */

/* Writes that a text of the map is in no row: it may be a wrong one. Nothing if there is none. */
static void write_never_on(const replay_t *replay, char *text, size_t size) {
    size_t gripper;
    bool is_sensor;
    const wh_field_source_t *source = wh_field_find_never_on(&replay->field, &gripper, &is_sensor);
    text[0] = '\0';
    if (source) {
        (void)snprintf(
            text, size,
            "the %s of %s: no row of %s says %s (expected the map's `off` as well, or another `on`)",
            is_sensor ? "sensor" : "valve", replay->field.layout->grippers[gripper].name,
            replay->field.names[source->column], source->on);
    }
}

/* Writes why the log is not as the cell has it. */
static int judge(const replay_t *replay, char *reason, size_t size) {
    const wh_field_run_t *run = &replay->run;
    const wh_plant_found_t *found = &replay->plant.found;
    const size_t sensor = wh_field_first_sensor(run);
    const bool has_sensor = sensor < replay->field.layout->machine.gripper_count;
    size_t gripper;
    bool is_sensor;
    reason[0] = '\0';
    if (found->refused > 0) {
        (void)snprintf(reason, size, "the layout's machine cannot be where the log's is: line %zu: %s",
                       run->refused_line, run->refused);
    } else if (has_sensor) {
        (void)snprintf(reason, size, "the sensor of %s differs first, from line %zu on",
                       replay->field.layout->grippers[sensor].name, run->sensors[sensor].line);
    } else if (found->complaints > 0) {
        (void)snprintf(reason, size, "the cell complained %" PRIu64 " time%s", found->complaints,
                       WH_PLURAL(found->complaints));
    } else if (found->jumps > 0) {
        (void)snprintf(reason, size, "an axis was faster than the layout's: line %zu: %s", run->jumped_line,
                       run->jumped);
    } else if (run->holes > 0 || run->between > 0) {
        (void)snprintf(reason, size, "it has %" PRIu64 " hole%s, and %" PRIu64 " row%s between two slices",
                       run->holes, WH_PLURAL(run->holes), run->between, WH_PLURAL(run->between));
        return INCOMPLETE;
    } else if (replay->field.has_sensors == 0) {
        (void)snprintf(reason, size, "the log has no sensor that could be compared");
        return INCOMPLETE;
    } else if (wh_field_find_never_on(&replay->field, &gripper, &is_sensor)) {
        write_never_on(replay, reason, size);
        return INCOMPLETE;
    }
    return reason[0] == '\0' ? SAME : DIFFERS;
}

/* ------------------------------------------------------------------------------------------------- people */

static void print_sensor(const replay_t *replay, size_t gripper) {
    const wh_field_sensor_t *sensor = &replay->run.sensors[gripper];
    const char *name = replay->field.layout->grippers[gripper].name;
    if ((replay->field.has_sensors >> gripper & 1U) == 0) {
        printf("sensor of %s: not in the log, and not compared\n", name);
    } else if (sensor->is_there) {
        printf("sensor of %s: DIFFERS at %.6f s, line %zu: %s in the log, %s in the cell; in %" PRIu64
               " of %" PRIu64 " rows in all\n",
               name, sensor->time_s, sensor->line, sensor->logged ? "on" : "off",
               sensor->logged ? "off" : "on", sensor->rows, replay->run.rows);
    } else {
        printf("sensor of %s: as in the log%s; %" PRIu64 " of %" PRIu64 " rows differ\n", name,
               sensor->rows > 0 ? " within --within" : "", sensor->rows, replay->run.rows);
    }
}

static void print_unlooked(const replay_t *replay) {
    const wh_field_run_t *run = &replay->run;
    if (run->holes > 0) {
        printf("%" PRIu64 " hole%s: rows more than %g s apart, the longest of %.6f s before line %zu\n",
               run->holes, WH_PLURAL(run->holes), run->options.gap_s, run->longest_s, run->longest_line);
    }
    if (run->between > 0) {
        printf("%" PRIu64
               " row%s between two slices: their axes were not played (expected a shorter slice)\n",
               run->between, WH_PLURAL(run->between));
    }
    char never_on[400];
    write_never_on(replay, never_on, sizeof never_on);
    if (never_on[0] != '\0') {
        puts(never_on);
    }
    if (!replay->field.layout->collision) {
        puts("collisions were not looked for: the layout has no collision = true");
    }
    if (replay->field.ignored > 0) {
        printf("%zu column%s not read\n", replay->field.ignored,
               replay->field.ignored == 1 ? " was" : "s were");
    }
}

static void print_axes(const replay_t *replay) {
    const wh_field_run_t *run = &replay->run;
    const wh_plant_found_t *found = &replay->plant.found;
    if (found->refused > 0) {
        printf("%" PRIu64 " slice%s refused, the first at line %zu: %s\n", found->refused,
               WH_PLURAL(found->refused), run->refused_line, run->refused);
    }
    if (found->jumps > 0) {
        printf("%" PRIu64 " jump%s, the first at line %zu: %s\n", found->jumps, WH_PLURAL(found->jumps),
               run->jumped_line, run->jumped);
    }
}

/* An axis whose moves are looked at because --moves is wanted. */
static void print_axis_moves(const replay_t *replay, size_t axis) {
    char name[WH_NAME_SIZE * 2];
    size_t alike = 0;
    const size_t all = wh_field_moves_count(&replay->moves, axis, &alike);
    wh_field_axis_name(replay->field.layout, axis, name, sizeof name);
    if (wh_field_moves_look_simulated(&replay->moves, axis)) {
        printf(
            "%s: %zu of its %zu moves take the times of the layout's limits, to 1 ms: they look simulated\n",
            name, alike, all);
    } else if (replay->arguments->moves && wh_field_moves_never_rests(&replay->moves, axis)) {
        printf("%s: no move came to rest (--rest says how much its numbers tremble)\n", name);
    }
}

static void print_moves(const replay_t *replay) {
    for (size_t axis = 0; axis < replay->field.layout->machine.axis_count; ++axis) {
        print_axis_moves(replay, axis);
    }
    if (replay->arguments->moves) {
        printf("%zu moves from rest to rest; %zu left out, which turned back or had a hole\n",
               replay->moves.count, replay->moves.odd);
    }
}

static int print_table(const replay_t *replay, int status, const char *reason) {
    static const char *const verdicts[] = {[SAME] = "as the cell has it",
                                           [DIFFERS] = "not as the cell has it",
                                           [2] = "",
                                           [INCOMPLETE] = "incomplete, not shown to be as the cell has it"};
    const wh_field_run_t *run = &replay->run;
    printf("%s against %s: %" PRIu64 " rows, %.6f s to %.6f s, %" PRId64 " slices, hash %016" PRIx64 "\n",
           replay->field.path, replay->field.layout->path, run->rows, run->first_s, run->last_s,
           wh_plant_slice(&replay->plant), wh_protocol_server_hash(&replay->plant.simulation->server));
    for (size_t i = 0; i < replay->heard_count; ++i) {
        const heard_t *heard = &replay->heard[i];
        printf("%12.6f s  line %-7zu %s%s\n", heard->time_s, heard->line, heard->is_complaint ? "! " : "",
               heard->text);
    }
    for (size_t g = 0; g < replay->field.layout->machine.gripper_count; ++g) {
        print_sensor(replay, g);
    }
    print_axes(replay);
    print_unlooked(replay);
    print_moves(replay);
    printf("%s%s%s\n", verdicts[status], reason[0] ? ": " : "", reason);
    return 0;
}

/* ----------------------------------------------------------------------------------------------- programs */

static json_t *whole(uint64_t value) {
    return json_integer((json_int_t)value);
}

static json_t *event_to_json(const void *subject, size_t i) {
    const heard_t *heard = &((const replay_t *)subject)->heard[i];
    return wh_json_add(json_object(), "time_s line complaint text", wh_json_real(heard->time_s),
                       whole(heard->line), json_boolean(heard->is_complaint), wh_json_text(heard->text),
                       NULL);
}

static json_t *sensor_to_json(const void *subject, size_t gripper) {
    const replay_t *replay = subject;
    const wh_field_sensor_t *sensor = &replay->run.sensors[gripper];
    const bool is_compared = (replay->field.has_sensors >> gripper & 1U) != 0;
    return wh_json_add(json_object(), "gripper compared differs rows time_s line logged",
                       wh_json_text(replay->field.layout->grippers[gripper].name), json_boolean(is_compared),
                       is_compared ? json_boolean(sensor->is_there) : json_null(),
                       is_compared ? whole(sensor->rows) : json_null(),
                       sensor->is_there ? wh_json_real(sensor->time_s) : json_null(),
                       sensor->is_there ? whole(sensor->line) : json_null(),
                       sensor->is_there ? json_boolean(sensor->logged) : json_null(), NULL);
}

static json_t *simulated_to_json(const replay_t *replay) {
    char name[WH_NAME_SIZE * 2];
    json_t *list = json_array();
    for (size_t axis = 0; axis < replay->field.layout->machine.axis_count; ++axis) {
        if (wh_field_moves_look_simulated(&replay->moves, axis)) {
            wh_field_axis_name(replay->field.layout, axis, name, sizeof name);
            wh_json_append(list, wh_json_text(name));
        }
    }
    return list;
}

static int print_json(const replay_t *replay, int status, const char *reason) {
    static const char *const verdicts[] = {
        [SAME] = "same", [DIFFERS] = "differs", [2] = "", [INCOMPLETE] = "incomplete"};
    const wh_field_run_t *run = &replay->run;
    const wh_plant_found_t *found = &replay->plant.found;
    json_t *root = wh_json_add(
        json_object(), "format ok verdict reason file layout rows slices hash", json_integer(1),
        json_boolean(status == SAME), wh_json_text(verdicts[status]), wh_json_text(reason[0] ? reason : NULL),
        wh_json_text(replay->field.path), wh_json_text(replay->field.layout->path), whole(run->rows),
        json_integer(wh_plant_slice(&replay->plant)),
        wh_json_hash(wh_protocol_server_hash(&replay->plant.simulation->server)), NULL);
    (void)wh_json_add(root,
                      "first_s last_s holes longest_s rows_between refused jumps complaints columns_ignored",
                      wh_json_real(run->first_s), wh_json_real(run->last_s), whole(run->holes),
                      wh_json_real(run->longest_s), whole(run->between), whole(found->refused),
                      whole(found->jumps), whole(found->complaints), whole(replay->field.ignored), NULL);
    (void)wh_json_add(root, "collision counts looks_simulated", json_boolean(replay->field.layout->collision),
                      wh_sim_board_counts(&replay->plant.found), simulated_to_json(replay), NULL);
    wh_json_put(root, "sensors",
                wh_json_list(sensor_to_json, replay, replay->field.layout->machine.gripper_count));
    wh_json_put(root, "events", wh_json_list(event_to_json, replay, replay->heard_count));
    return wh_json_print(root, stdout);
}

/* -------------------------------------------------------------------------------------------------- moves */

static bool write_moves(void *user, FILE *out) {
    const replay_t *replay = user;
    fputs("axis,from,to,seconds\n", out);
    for (size_t i = 0; i < replay->moves.count; ++i) {
        const wh_field_move_t *move = &replay->moves.moves[i];
        const char *axis = wh_field_moves_axis(replay->field.layout, move->axis);
        const double numbers[] = {move->from, move->to, round(move->seconds * 1e6) / 1e6};
        char text[3][WH_DIGITS];
        for (size_t k = 0; k < 3; ++k) {
            wh_digits(numbers[k], text[k]);
        }
        if (axis) {
            fprintf(out, "%s,%s,%s,%s\n", axis, text[0], text[1], text[2]);
        }
    }
    return ferror(out) == 0;
}

static bool has_axes_of_moves(const wh_layout_t *layout) {
    for (size_t axis = 0; axis < layout->machine.axis_count; ++axis) {
        if (wh_field_moves_axis(layout, axis)) {
            return true;
        }
    }
    fprintf(stderr,
            "--moves: %s has no axis that `waferhand estimate limits` knows (expected one robot with theta, "
            "r, z or yaw)\n",
            layout->path);
    return false;
}

/* ----------------------------------------------------------------------------------------------- segments */

static void keep_slice(void *user, const wh_command_t *command, size_t line) {
    wh_segments_keep(&((replay_t *)user)->segments, command, line);
}

/* The file is written whatever the verdict: a log that differs makes the better test. */
static bool write_segments(replay_t *replay) {
    const char *path = replay->arguments->segments;
    const uint64_t hash = wh_protocol_server_hash(&replay->plant.simulation->server);
    const char *expected = path ? wh_segments_end(&replay->segments, hash) : NULL;
    if (expected) {
        fprintf(stderr, "--segments: %s: not written (expected %s)\n", path, expected);
    }
    return !expected && wh_file_write("--segments", path, wh_segments_write, &replay->segments, NULL);
}

/* ------------------------------------------------------------------------------------------------ playing */

static int conclude(replay_t *replay) {
    char reason[WH_PLANT_TEXT * 2];
    const int status = judge(replay, reason, sizeof reason);
    wh_plant_tell_over(&replay->plant, status == SAME, reason);
    if (!wh_file_write("--moves", replay->arguments->moves, write_moves, replay, NULL) ||
        !write_segments(replay)) {
        return WH_EXIT_USAGE;
    }
    const int printed =
        replay->json ? print_json(replay, status, reason) : print_table(replay, status, reason);
    return wh_app_is_printed(printed) ? status : WH_EXIT_USAGE;
}

static void say_refusal(const replay_t *replay) {
    if (replay->field.message[0] != '\0') {
        fprintf(stderr, "%s\n", replay->field.message);
    } else if (replay->run.status != WH_OK) {
        fprintf(stderr, "%s:%zu: the cell takes it not: %s\n", replay->field.path, replay->field.line,
                wh_status_text(replay->run.status));
    } else {
        fprintf(stderr, "%s: it has no row (expected one below the line of names)\n", replay->field.path);
    }
}

static int play(replay_t *replay, wh_node_t *node, const wh_layout_t *layout) {
    static wh_sim_process_t simulation;
    const wh_replay_field_arguments_t *arguments = replay->arguments;
    if (wh_sim_process_open(&simulation, node, layout, false) != WH_OK) {
        fprintf(stderr, "%s: %s (expected at most %d wafers)\n", layout->path,
                wh_status_text(WH_STATUS_BAD_CAPACITY), WH_LINK_WAFERS);
        wh_protocol_server_close(&simulation.server);
        return WH_EXIT_USAGE;
    }
    wh_plant_open(&replay->plant, &simulation);
    replay->plant.heard = hear;
    replay->plant.heard_user = replay;
    replay->run = (wh_field_run_t){
        .options = {arguments->gap_s > 0 ? arguments->gap_s : USUAL_GAP_S, arguments->within_s},
        .field = &replay->field,
        .plant = &replay->plant,
        .moves = &replay->moves};
    replay->moves = (wh_field_moves_t){.layout = layout,
                                       .rest = arguments->rest > 0 ? arguments->rest : USUAL_REST,
                                       .gap_s = replay->run.options.gap_s};
    if (arguments->segments) {
        wh_segments_begin(&replay->segments, layout, arguments->field, arguments->segments);
        replay->run.stepped = keep_slice;
        replay->run.stepped_user = replay;
    }
    int status = WH_EXIT_USAGE;
    if (wh_field_play(&replay->run) && replay->run.rows > 0) {
        status = conclude(replay);
    } else {
        say_refusal(replay);
    }
    wh_sim_process_close(&simulation);
    return status;
}

static void forget(replay_t *replay) {
    for (size_t i = 0; i < replay->heard_count; ++i) {
        free(replay->heard[i].text);
    }
    free(replay->heard);
    wh_field_moves_free(&replay->moves);
    wh_segments_free(&replay->segments);
    wh_field_close(&replay->field);
}

/* The simulator's lines for watchers are not for standard error. */
static void hear_nothing(void *user, const char *line) {
    (void)user;
    (void)line;
}

static int play_recorded(replay_t *replay, const wh_layout_t *layout) {
    static wh_recording_t recording;
    wh_node_t node;
    wh_record_arguments_apply(&replay->arguments->record, "replay", true, &recording);
    if (!wh_recording_open_node(&recording, &node, "memq://")) {
        return WH_EXIT_USAGE;
    }
    node.listener = hear_nothing;
    const int status = play(replay, &node, layout);
    wh_node_close(&node);
    return wh_recording_close(&recording) ? status : WH_EXIT_USAGE;
}

static bool is_apart(const wh_replay_field_arguments_t *arguments) {
    const char *option = NULL;
    const char *record = wh_record_arguments_path(&arguments->record, &option);
    const wh_named_file_t named[] = {
        {"the layout", arguments->layout.path, false}, {"--field", arguments->field, false},
        {"--columns", arguments->columns, false},      {"--moves", arguments->moves, true},
        {"--segments", arguments->segments, true},     {option, record, true}};
    return wh_files_are_apart(named, sizeof named / sizeof named[0], true);
}

static bool are_writable(const wh_replay_field_arguments_t *arguments, const wh_layout_t *layout) {
    return (!arguments->moves ||
            (has_axes_of_moves(layout) && wh_file_is_writable("--moves", arguments->moves))) &&
           (!arguments->segments || wh_file_is_writable("--segments", arguments->segments));
}

int wh_replay_field(wh_replay_field_arguments_t *arguments, bool json) {
    static replay_t replay;
    int status = WH_EXIT_USAGE;
    const wh_layout_t *layout = is_apart(arguments) ? wh_layout_arguments_load(&arguments->layout) : NULL;
    replay.arguments = arguments;
    replay.json = json;
    if (layout && are_writable(arguments, layout)) {
        const wh_sandbox_limits_t limits = {.memory_bytes = (size_t)(arguments->layout.memory_mib * 1048576)};
        if (wh_field_open(&replay.field, arguments->field, arguments->columns, layout, &limits)) {
            status = play_recorded(&replay, layout);
        } else {
            fprintf(stderr, "%s\n", replay.field.message);
        }
        forget(&replay);
    }
    wh_layout_arguments_free(&arguments->layout);
    return status;
}
