/* The lists of fields agree with the reader of layouts. Each field of each table is tried in its
 * place, with a value of no type, and left out; the reader must name it, and expect the type in the
 * list. `waferhand definitions` prints these lists. Each scalar is also read into its struct and refused
 * beyond its range; those that a simulator goes by are hashed, sent and restored. */
#include "support/layout.h"

#include <math.h>

#include "layout/layout_fields.h"
#include "wire/messages.h"

/* A cell with every table in it, so that each field has a place. */
static const char base[] =
    "local cell = { wafer = { notch = {} }, tolerance = {}, near = {}, placing = {}, vacuum = {}, chuck = {},"
    " pads = { friction = 0.5, force = 10 }, corrections = {}, clearance = {},"
    " robot = { theta = {}, r = {}, z = {}, yaw = {}, loaded = {} },"
    " grippers = { { name = 'EE', probe = {}, loaded = {} }, { name = 'PA', on = 'P', stage = {} }, { name = "
    "'PP', on = 'P', pins = "
    "{} }, { name = 'E2', grip = {} }, { name = 'FC', on = 'F', flipper = {} } },"
    " doors = { D = { at = { 0, -900, 0 }, open = { 0, 0, 9 }, box = { 1, 1, 1 } },"
    "   D2 = { at = { 0, -900, 0 }, open = { 0, 0, 9 }, cylinder = { radius = 1, height = 1 } },"
    "   D3 = { at = { 0, -900, 0 }, open = { 0, 0, 9 }, capsule = { radius = 1, height = 1 } } },"
    " stations = { A = { process = 1, window = 1, clean = { after = 1, seconds = 1 }, side = 'vacuum',"
    "   pump = { down = 1, up = 1, doors = {} }, at = { 700, 0, 900 }, slots = 2, block = {}, via = { { r = "
    "400 } }, beams = { { y = "
    "60 }, { y = 9 } } }, B = { at = { "
    "0, 700, 900 "
    "} },"
    "   F = { kind = 'flipper', at = { 0, -700, 950 } },"
    "   LP = { kind = 'load_port', at = { 0, 700, 900 }, slots = 2, port = { e84 = {}, mapper = {} } },"
    "   P = { kind = 'prealigner', at = { -600, 0, 950 }, sensor = { believed = {}, hidden = { { from = 1, "
    "width = 2 } } } "
    "} },"
    " wafers = { { name = 'W1', station = 'A', slot = 1, rim = { notch = {}, "
    "   chips = { { at = 90, width = 1, depth = 0.5 } } } }, { name = 'W2', station = 'B', slot = 1 } },"
    " carriers = { A = {} }, mapping = {}, shapes = { blade = {}, arm = {}, ledge = {}, foup = {}, chuck = "
    "{} },"
    " obstacles = { { at = { 0, 0, -500 }, box = { 1, 1, 1 } },"
    "   { at = { 0, 0, -600 }, cylinder = { radius = 1, height = 1 } },"
    "   { at = { 0, 0, -700 }, capsule = { radius = 1, height = 1 } } },"
    " faults = { { kind = 'no_vacuum' }, { kind = 'slow_vacuum', value = 1 }, { kind = 'leak', value = 0.1 },"
    "   { kind = 'plunger_slow', gripper = 'E2', value = 1 },"
    "   { kind = 'command_lost' }, { kind = 'wafer_missing', wafer = 'W1' },"
    "   { kind = 'wafer_doubled', wafer = 'W1', onto = 'W2' }, { kind = 'wafer_crossed', wafer = 'W1' },"
    "   { kind = 'wafer_shifted', wafer = 'W1' }, { kind = 'wafer_tilted', wafer = 'W1', rpy = { 1, 0, 0 } },"
    "   { kind = 'door_stuck', door = 'D' }, { kind = 'door_slow', door = 'D', value = 1 },"
    "   { kind = 'beam_dark', station = 'A' }, { kind = 'beam_late', station = 'A', value = 0 },"
    "   { kind = 'probe_open' }, { kind = 'edge_sensor_late', station = 'P', value = 0 } },"
    " study = { placement = {}, teaching = {}, timing = {}, rim = {}, wafers = { W1 = {} }, rims = { W1 = {} "
    "}, beam = {}, beams = { A = {} },"
    "   stations = { A = {} }, grippers = { EE = {} } } }\n";

/* The fault tables follow one another in the list as the base's faults do. */
static const char first_fault[] = "fault.gripper";

/* A cell has at most 16 faults: those behind them are tried in a list of their own. */
static bool is_later_fault;

/* Room for the path of a field. */
#define PATH_BYTES 300

static size_t tried, tried_scalars, tried_shared;

/* False if the base, changed by this statement, is refused. */
static bool is_read(const char *statement) {
    lua_State *L = wh_sandbox_state(sandbox);
    char text[4096];
    lua_settop(L, 0);
    const int length = snprintf(text, sizeof text, "%s%s return cell", base, statement);
    assert_in_range(length, 1, (int)sizeof text - 1);
    wh_sandbox_renew(sandbox);
    lua_pushcfunction(L, read_here);
    if (!wh_sandbox_evaluate_text(L, "cell.lua", text, (size_t)length, &result)) {
        fail_msg("%s: %s", statement, result.message);
    }
    return wh_sandbox_call(L, 1, 1, &result);
}

/* The layout that is_read has read. */
static wh_layout_t *layout_read(void) {
    return lua_touserdata(wh_sandbox_state(sandbox), -1);
}

/* The expected type of the field at a path, from the refusal of this statement; in `result`. */
static const char *find_expected(const char *statement, const char *path) {
    char begin[300];
    (void)snprintf(begin, sizeof begin, "cell.lua: %s: ", path);
    if (is_read(statement)) {
        fail_msg("accepted: %s", statement);
    }
    if (strncmp(result.message, begin, strlen(begin)) != 0) {
        fail_msg("\"%s\" does not begin with \"%s\"", result.message, begin);
    }
    const char *expected = strstr(result.message, "(expected ");
    assert_non_null(expected);
    return expected + strlen("(expected ");
}

static const wh_layout_class_t *find_class(const char *name, size_t length) {
    const wh_layout_class_t *class = wh_layout_classes;
    while (class->name && (strlen(class->name) != length || strncmp(class->name, name, length) != 0)) {
        ++class;
    }
    return class;
}

/* Each "word" of the type is in the text, and both have the same number unless there may be more. */
static void expect_choices(const char *type, const char *expected, bool may_be_more) {
    size_t given = 0, known = 0;
    for (const char *at = type; (at = strchr(at, '"')) != NULL;) {
        const char *end = strchr(at + 1, '"');
        char word[60];
        (void)snprintf(word, sizeof word, "%.*s", (int)(end - at) + 1, at);
        if (!strstr(expected, word)) {
            fail_msg("%s is not in \"%s\"", word, expected);
        }
        ++given;
        at = end + 1;
    }
    for (const char *at = expected; (at = strchr(at, '"')) != NULL; ++at) {
        ++known;
    }
    assert_true(may_be_more || known == 2 * given);
}

static void expect_type(const wh_reader_field_t *field, const char *expected) {
    char type[200];
    wh_field_type(field, type, sizeof type);
    static const char *const plain[][2] = {{"number", "a number from "},
                                           {"number|table<string, number>", "a number from "},
                                           {"integer|table<string, integer>", "a whole number from "},
                                           {"integer", "a whole number from "},
                                           {"table<string, string>", "a table"},
                                           {"boolean", "true or false"},
                                           {"string", "text of 1 to "},
                                           {"number[]", "a list of t"},
                                           {"integer|integer[]", "a whole number from "}};
    const char *wanted = NULL;
    if (type[0] == '"') {
        const bool is_kind_of_fault = strstr(expected, "command_lost") != NULL;
        expect_choices(type, expected, is_kind_of_fault);
        wanted = strstr(type, "waferhand.") ? "{" : "\"";
    } else if (strstr(type, "waferhand.")) {
        wanted = "a table";
    }
    for (size_t i = 0; i < sizeof plain / sizeof plain[0]; ++i) {
        wanted = strcmp(type, plain[i][0]) == 0 ? plain[i][1] : wanted;
    }
    if (!wanted || !strstr(expected, wanted)) {
        fail_msg("%s: the list says %s, the reader expects %s", field->name, type, expected);
    }
}

static void join(char path[PATH_BYTES], const char *before, const char *name) {
    assert_in_range(strlen(before) + strlen(name), 1, PATH_BYTES - 2);
    (void)snprintf(path, PATH_BYTES, "%.150s%s%.140s", before, before[0] ? "." : "", name);
}

/* The obstacle of a shape's field, the station with a sensor, the chuck with a stage, and the pins;
 * other fields have their own. */
static const char *mend_path(const char *path, const char *field) {
    static const char *const mended[][3] = {{"stations.A", "sensor", "stations.P"},
                                            {"grippers[1]", "stage", "grippers[2]"},
                                            {"grippers[1]", "pins", "grippers[3]"},
                                            {"grippers[1]", "grip", "grippers[4]"},
                                            {"stations.A", "port", "stations.LP"},
                                            {"obstacles[1]", "cylinder", "obstacles[2]"},
                                            {"obstacles[1]", "capsule", "obstacles[3]"},
                                            {"obstacles[1]", "mesh", "obstacles[4]"},
                                            {"obstacles[1]", "unit", "obstacles[4]"},
                                            {"grippers[1]", "flipper", "grippers[5]"},
                                            {"doors.D", "cylinder", "doors.D2"},
                                            {"doors.D", "capsule", "doors.D3"},
                                            {"doors.D", "mesh", "doors.D4"},
                                            {"doors.D", "unit", "doors.D4"}};
    for (size_t i = 0; i < sizeof mended / sizeof mended[0]; ++i) {
        if (strcmp(path, mended[i][0]) == 0 && strcmp(field, mended[i][1]) == 0) {
            return mended[i][2];
        }
    }
    return path;
}

/* Needs of a field of wafers and obstacles: an edge grip takes no wafers with flats. */
static const char *prepare_body(const char *path) {
    if (is_later_fault && strncmp(path, "faults[", strlen("faults[")) == 0) {
        return "cell.faults = { { kind = 'station_stuck', station = 'A' }, { kind = 'station_slow', station "
               "= 'A', value = 2 }, { kind = 'e84_stuck', station = 'LP', step = 'tp1' }, { kind = "
               "'e84_late', "
               "station = 'LP', step = 'tp5', value = 2 }, { kind = 'power_lost' }, { kind = "
               "'emergency_stop' }, { kind = 'servo_error' } } ";
    }
    if (strncmp(path, "wafers[1].rim.flats", strlen("wafers[1].rim.flats")) == 0) {
        return "cell.grippers[4].grip, cell.faults = nil cell.wafers[1].rim.flats = { { at = 0, length = 50 "
               "} } ";
    }
    if (strncmp(path, "doors.D4", strlen("doors.D4")) == 0) {
        return "cell.doors.D4 = { at = { 0, 0, 0 }, open = { 0, 0, 9 }, mesh = 'none.stl', unit = 'mm' } ";
    }
    const bool is_mesh = strncmp(path, "obstacles[4]", strlen("obstacles[4]")) == 0;
    return is_mesh ? "cell.obstacles[4] = { at = { 0, 0, 0 }, mesh = 'none.stl', unit = 'mm' } " : "";
}

/* A robot with links from a file; null: the field asks for none. */
static const char *prepare_urdf(const char *path) {
    static const char *const of_urdf[] = {"robot.urdf", "robot.joints", "robot.tool", "robot.packages"};
    static const char folding[] =
        "cell.stations.A.block, cell.stations.A.beams, cell.shapes.arm = nil cell.robot = { kind = 'TRZ', r "
        "= { min = 260, home = "
        "300 }, "
        "z = { min = 500, max = 1200 }, urdf = 'lua/layouts/folding.urdf', tool = 'effector', packages = {}, "
        "joints = { lift = { axis = 'z', factor = 1, offset = 0 }, turn = 'theta', q3 = 'fold' } } ";
    static const char two_arms[] =
        "cell.stations.A.block, cell.stations.A.beams, cell.stations.A.via, cell.shapes.arm = nil cell.robot "
        "= { kind = 'TRZ', r "
        "= { min = 260, home = 300 }, z = { min = 500, max = 1200 }, arms = { {}, { heading = 180, height = "
        "10 } }, urdf = 'lua/layouts/two_arms.urdf', tool = 'effector', tool2 = 'effector 2', "
        "joints = { lift = 'z', turn = 'theta', fold = 'fold', fold2 = 'fold2' } } "
        "cell.grippers[#cell.grippers + 1] = { name = 'Other', arm = 2 } ";
    if (strcmp(path, "robot.tool2") == 0) {
        return two_arms;
    }
    for (size_t i = 0; i < sizeof of_urdf / sizeof of_urdf[0]; ++i) {
        if (strncmp(path, of_urdf[i], strlen(of_urdf[i])) == 0) {
            return folding;
        }
    }
    return NULL;
}

/* A station that is given by axes: of a robot that has all but `r`, or of the base's. */
static const char *prepare_axes(const char *path) {
    return strcmp(path, "stations.A.axes.r") == 0
               ? "cell.stations.A.at = nil cell.stations.A.axes = { theta = 0, r = 700, z = 900, yaw = 0 } "
               : "cell.stations.A.at = nil cell.robot = { kind = 'SCARA', links = { 450, 450 }, rail = {}, "
                 "tilt = {} } cell.stations.A.axes = { theta = 0, forearm = 90, z = 900, yaw = 0, rail = 0, "
                 "tilt_x = 0, tilt_y = 0 } ";
}

/* A field of a robot with two arms or two wrists, or null if it is none. */
static const char *prepare_two(const char *path) {
    static const char *const of_two[][2] = {
        {"arm", "cell.robot = { kind = 'TRZ', arms = { {}, {} } }"},
        {"wrist", "cell.robot = { kind = 'SCARA', links = { 450, 450 }, wrists = { {}, {} } }"}};
    static char two[300];
    for (size_t i = 0; i < sizeof of_two / sizeof of_two[0]; ++i) {
        char of_robot[40], of_gripper[40];
        (void)snprintf(of_robot, sizeof of_robot, "robot.%ss", of_two[i][0]);
        (void)snprintf(of_gripper, sizeof of_gripper, "grippers[1].%s", of_two[i][0]);
        if (strncmp(path, of_robot, strlen(of_robot)) == 0 || strcmp(path, of_gripper) == 0) {
            (void)snprintf(
                two, sizeof two,
                "cell.stations.A.block, cell.stations.A.beams, cell.collision, cell.look_ahead = nil %s "
                "cell.grippers[#cell.grippers + 1] = { name = 'Other', %s = 2 } ",
                of_two[i][1], of_two[i][0]);
            return two;
        }
    }
    return NULL;
}

static bool begins_with(const char *path, const char *begin) {
    return strncmp(path, begin, strlen(begin)) == 0;
}

/* Needs of a field that the base's robot does not meet. */
static const char *prepare(const char *path) {
    static const char scara[] = "cell.stations.A.beams = nil cell.stations.A.block = nil cell.robot = { kind "
                                "= 'SCARA', links = { 450, 450 }, theta = {}, z = {},"
                                " forearm = {}, yaw = {}, rail = {}, tilt = {}, flip = {} } ";
    static const char *const others[] = {"robot.forearm",   "robot.rail",      "robot.tilt",
                                         "robot.flip",      "robot.links",     "robot.elbow",
                                         "stations.A.rail", "stations.A.elbow"};
    const char *const of_file = prepare_urdf(path);
    if (of_file) {
        return of_file;
    }
    if (begins_with(path, "stations.A.axes")) {
        return prepare_axes(path);
    }
    if (strcmp(path, "stations.A.via[1].forearm") == 0) {
        return "cell.stations.A.beams, cell.stations.A.block, cell.stations.A.via[1].r = nil "
               "cell.robot = { kind = 'SCARA', links = { 450, 450 } } ";
    }
    if (strcmp(path, "stations.A.via[1].rail") == 0) {
        return "cell.stations.A.beams = nil cell.stations.A.block = nil cell.robot = { rail = {} } ";
    }
    const char *const of_two = prepare_two(path);
    if (of_two) {
        return of_two;
    }
    bool is_other = false;
    for (size_t i = 0; i < sizeof others / sizeof others[0]; ++i) {
        is_other = is_other || begins_with(path, others[i]);
    }
    if (is_other) {
        return scara;
    }
    return prepare_body(path);
}

/* Without it, another entry that names it may be missed. An obstacle needs one of its shapes, a SCARA its
 * links, a URDF its tools, a load lock its side, and a station `at` or the axes that its arm has. */
static bool is_needed_in_turn(const char *path, const char *name) {
    return begins_with(path, "obstacles") || begins_with(path, "doors") || strcmp(name, "links") == 0 ||
           begins_with(path, "stations.A.axes.") ||
           (begins_with(path, "stations.") && (strcmp(name, "at") == 0 || strcmp(name, "side") == 0)) ||
           begins_with(path, "robot.tool");
}

/* ------------------------------------------------------------------------------------------------ scalars */

/* Where a layout has the struct of a class; null: it is not looked at, or the layout has none. */
static void *struct_of(const wh_layout_class_t *class, wh_layout_t *layout) {
    const struct {
        const char *class;
        const void *at;
    } places[] = {{"layout", layout},
                  {"wafer_size", layout},
                  {"tolerance", &layout->grasp.tolerance},
                  {"near", &layout->grasp},
                  {"placing", &layout->cell},
                  {"corrections", &layout->corrections},
                  {"mapping", &layout->mapping},
                  {"vacuum", &layout->physics.vacuum},
                  {"pads", &layout->physics.pads},
                  {"edge_grip", &layout->grips[3].edge},
                  {"station", layout->stations},
                  {"sensor", &layout->scanners[0].sensor},
                  {"believed", &layout->believed[0]},
                  {"arc", &layout->scanners[0].sensor.hidden[0]},
                  {"beam", &layout->beams[0]},
                  {"probe", &layout->probe},
                  {"rim", layout->rims ? layout->rims[0] : NULL},
                  {"rim_notch", layout->rims ? &layout->rims[0]->notch : NULL},
                  {"blade", &layout->shapes.blade},
                  {"arm", &layout->shapes.arm},
                  {"ledge", &layout->shapes.ledge},
                  {"foup", &layout->shapes.shell},
                  {"spindle", &layout->shapes.chuck}};
    for (size_t i = 0; i < sizeof places / sizeof places[0]; ++i) {
        if (strcmp(places[i].class, class->name) == 0) {
            return (char *)(uintptr_t)places[i].at;
        }
    }
    fail_msg("%s has scalars, and this test does not know where", class->name);
    return NULL;
}

/* True if both processes go by the member: it is hashed, by the rows or by the part of the simulator that it
 * is of, and a cell's message has it. */
static bool is_shared(const char *class, const wh_reader_field_t *row) {
    static const char *const simulated[] = {"edge_grip", "sensor", "arc", "rim", "rim_notch"};
    bool is = row->hashed > 0 && row->hashed != WH_HASHED_ARM;
    for (size_t i = 0; i < sizeof simulated / sizeof simulated[0]; ++i) {
        is = is || strcmp(class, simulated[i]) == 0;
    }
    return is;
}

/* A value of the row as Lua has it. */
static void put_value(const wh_reader_field_t *row, double value, char *text, size_t size) {
    if (row->kind == WH_SCALAR_SWITCH) {
        (void)snprintf(text, size, "%s", value > 0 ? "true" : "false");
    } else if (row->kind == WH_SCALAR_WORD) {
        (void)snprintf(text, size, "'%s'", row->words[(size_t)value]);
    } else {
        (void)snprintf(text, size,
                       row->kind == WH_SCALAR_NUMBER || row->kind == WH_SCALAR_DEGREES ? "%.17g" : "%.0f",
                       value);
    }
}

/* The other value of a switch, the next word, or a number: as a first try one a little above this one,
 * then one below it, then one far above. */
static double change(const wh_reader_field_t *row, double value, int attempt) {
    if (row->kind == WH_SCALAR_SWITCH) {
        return 1 - value;
    }
    if (row->kind == WH_SCALAR_WORD) {
        return row->words[(size_t)value + 1] ? value + 1 : 0;
    }
    const bool is_whole = row->kind == WH_SCALAR_WHOLE || row->kind == WH_SCALAR_SEED;
    const double near = fabs(value) > 0 ? value / 512 : (row->most < 1 ? row->most : 1) / 64;
    return attempt == 2 ? floor((value + row->most) / 2)
                        : value + (attempt == 1 ? -1 : 1) * (is_whole ? 1 : near);
}

/* The value comes back in the layout that the other process makes of the message. */
static void expect_restored(const wh_layout_class_t *class, const wh_reader_field_t *row, double value) {
    static wh_link_cell_t room;
    const wh_link_identity_t identity = {.run = 1};
    assert_true(wh_link_cell_from_layout(layout_read(), &identity, &room));
    wh_layout_t *restored = wh_link_layout_from_cell(&room.message);
    assert_non_null(restored);
    const double got = wh_field_get(row, struct_of(class, restored));
    wh_link_layout_free(restored);
    if (!(fabs(got - value) <= 1e-12 * fabs(value))) {
        fail_msg("%s.%s: %.17g is sent, and comes back as %.17g", class->name, row->name, value, got);
    }
    ++tried_shared;
}

/* Another value of the field is read into the struct; and where both processes go by it, hashed and sent. */
static void try_other_value(const wh_layout_class_t *class, const char *path, const char *before,
                            const wh_reader_field_t *row) {
    char statement[900];
    char value[40];
    assert_true(is_read(before));
    const uint64_t hash = wh_layout_hash(layout_read());
    const double usual = wh_field_get(row, struct_of(class, layout_read()));
    double other = usual;
    bool good = false;
    for (int attempt = 0; attempt < 3 && !good; ++attempt) {
        other = change(row, usual, attempt);
        put_value(row, other, value, sizeof value);
        (void)snprintf(statement, sizeof statement, "%scell.%s = %s", before, path, value);
        good = is_read(statement);
    }
    if (!good) {
        fail_msg("%s: %s", statement, result.message);
    }
    const double got = wh_field_get(row, struct_of(class, layout_read()));
    if (!(fabs(got - other) <= 1e-12 * fabs(other))) {
        fail_msg("%s: %s is read as %.17g", path, value, got);
    }
    if (is_shared(class->name, row)) {
        if (wh_layout_hash(layout_read()) == hash) {
            fail_msg("%s: the hash does not change with it", path);
        }
        expect_restored(class, row, other);
    }
    ++tried_scalars;
}

/* Beyond the row's range a number is refused. */
static void try_beyond(const char *path, const char *before, const wh_reader_field_t *row) {
    const double step = row->kind == WH_SCALAR_NUMBER || row->kind == WH_SCALAR_DEGREES ? 1e-6 : 1;
    const double beyond[] = {row->least - step * (1 + fabs(row->least)),
                             row->most + step * (1 + fabs(row->most))};
    for (size_t i = 0; i < 2; ++i) {
        char statement[900];
        (void)snprintf(statement, sizeof statement, step < 1 ? "%scell.%s = %.17g" : "%scell.%s = %.0f",
                       before, path, beyond[i]);
        (void)find_expected(statement, path);
    }
}

static void try_field(const wh_layout_class_t *class, const char *in, const wh_reader_field_t *field) {
    char path[PATH_BYTES];
    char statement[900];
    char missed[PATH_BYTES + 30];
    join(path, mend_path(in, field->name), field->name);
    const char *before = prepare(path);
    (void)snprintf(statement, sizeof statement, "%scell.%s = print", before, path);
    expect_type(field, find_expected(statement, path));
    (void)snprintf(statement, sizeof statement, "%scell.%s = nil", before, path);
    const bool is_shape = !field->required && is_needed_in_turn(path, field->name);
    (void)snprintf(missed, sizeof missed, "cell.lua: %s: nothing ", path);
    const bool is_missed = !is_read(statement) && strncmp(result.message, missed, strlen(missed)) == 0;
    if (!is_shape && is_missed != field->required) {
        fail_msg("%s: the list says required: %d; %s", path, (int)field->required, result.message);
    }
    ++tried;
    if (wh_field_is_number(field) || (field->kind == WH_SCALAR_APART && field->least < field->most &&
                                      strcmp(field->type, "boolean") != 0)) {
        try_beyond(path, before, field);
    }
    if (wh_field_is_member(field)) {
        try_other_value(class, path, before, field);
    }
}

/* The key of a table's only entry of this class. */
static const char *key_of(const char *class) {
    const bool is_wafer = strcmp(class, "placement") == 0 || strcmp(class, "rim_width") == 0;
    return is_wafer                      ? "W1"
           : strcmp(class, "valve") == 0 ? "EE"
           : strcmp(class, "joint") == 0 ? "lift"
           : strcmp(class, "door") == 0  ? "D"
                                         : "A";
}

static void try_class(const char *path, const wh_layout_class_t *class);

/* Goes on into the tables that a field of this type has. */
static void try_tables(const char *path, const char *type) {
    char inner[PATH_BYTES];
    const char *name = strstr(type, "waferhand.");
    if (!name) {
        return;
    }
    name += strlen("waferhand.");
    const wh_layout_class_t *class = find_class(name, strcspn(name, ">[|"));
    if (strstr(type, "table<")) {
        join(inner, path, key_of(class->name));
        try_class(inner, class);
    } else if (strcmp(type, "waferhand.fault[]") == 0) {
        class = find_class(first_fault, strlen(first_fault));
        for (int i = 1; strncmp(class->name, "fault.", 6) == 0; ++i, ++class) {
            is_later_fault = i > WH_FAULTS;
            (void)snprintf(inner, sizeof inner, "%.200s[%d]", path, is_later_fault ? i - WH_FAULTS : i);
            try_class(inner, class);
        }
        is_later_fault = false;
    } else {
        (void)snprintf(inner, sizeof inner, "%.200s%s", path, strstr(type, "[]") ? "[1]" : "");
        try_class(inner, class);
    }
}

/* Fields of several robots, which the base does not have: layout_test.c tries them. */
static bool is_of_several(const wh_reader_field_t *field) {
    return strcmp(field->name, "robots") == 0 || strcmp(field->name, "by") == 0 ||
           strcmp(field->type, "table<string, waferhand.arm>") == 0;
}

static void try_class(const char *path, const wh_layout_class_t *class) {
    char inner[PATH_BYTES];
    char statement[900];
    assert_non_null(class->name);
    for (const wh_reader_field_t *field = class->fields; field->name; ++field) {
        if (is_of_several(field)) {
            continue;
        }
        try_field(class, path, field);
        join(inner, mend_path(path, field->name), field->name);
        try_tables(inner, field->type);
    }
    join(inner, path, "nothing_like_it");
    (void)snprintf(statement, sizeof statement, "%scell.%s = 1", prepare(inner), inner);
    const char *expected = find_expected(statement, inner);
    assert_ptr_equal(strstr(expected, "one of the fields "), expected);
}

static void every_field_of_the_lists_is_read_and_has_its_type(void **state) {
    (void)state;
    size_t listed = 0;
    if (!is_read("")) {
        fail_msg("%s", result.message);
    }
    tried = 0;
    try_class("", &wh_layout_classes[0]);
    for (const wh_layout_class_t *class = wh_layout_classes; class->name; ++class) {
        for (const wh_reader_field_t *field = class->fields; field->name; ++field) {
            ++listed;
        }
    }
    assert_true(tried >= listed); /* an axis, a cylinder, ... stand in several places */
    assert_in_range(tried_scalars, 110, listed);
    assert_in_range(tried_shared, 50, tried_scalars);
}

static void every_kind_of_fault_is_in_one_list(void **state) {
    (void)state;
    for (int kind = 0; kind < WH_FAULT_WAFER_PLACED; ++kind) {
        char word[60];
        size_t found = 0;
        (void)snprintf(word, sizeof word, "\"%s\"", wh_fault_name((wh_fault_kind_t)kind));
        for (const wh_layout_class_t *class = wh_layout_classes; class->name; ++class) {
            if (strncmp(class->name, "fault.", 6) == 0 && strstr(class->fields[0].type, word)) {
                assert_ptr_equal(class->fields, wh_layout_fault_fields[kind]);
                ++found;
            }
        }
        assert_int_equal(found, 1);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_field_of_the_lists_is_read_and_has_its_type),
        cmocka_unit_test(every_kind_of_fault_is_in_one_list),
    };
    return cmocka_run_group_tests(tests, open_sandbox, close_sandbox);
}
