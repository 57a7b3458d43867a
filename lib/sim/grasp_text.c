#include "grasp_text.h"

#include <string.h>

#include "../math/trig.h"
#include "names_internal.h"

/* A text while it is written. */
typedef struct {
    wh_words_t words;
    const wh_event_names_t *names;
} table_words_t;

static table_words_t begin(const wh_event_names_t *names, char *buffer, size_t size) {
    static const wh_event_names_t none = {NULL, NULL, 0, NULL, NULL};
    table_words_t said;
    said.words = wh_words_begin(buffer, size);
    said.names = names ? names : &none;
    return said;
}

static void put_text(table_words_t *said, const char *text) {
    wh_words_put(&said->words, text);
}

static void put_name(table_words_t *said, wh_name_kind_t kind, int32_t index) {
    wh_names_put(said->names, &said->words, kind, index);
}

static void put_whole(table_words_t *said, uint64_t value) {
    wh_words_integer(&said->words, (int64_t)value);
}

static void put_real(table_words_t *said, wh_real_t value, int decimals) {
    wh_words_fixed(&said->words, value, decimals);
}

static const char *degree_of(const table_words_t *said) {
    return said->names->degree ? said->names->degree : " deg";
}

static const char *missing(const wh_grasp_t *table) {
    if (!table) {
        return "null";
    }
    return table->mark == WH_GRASP_MARK ? NULL : "not initialised";
}

static void put_valve(table_words_t *said, int32_t valve) {
    if (valve == WH_VALVE_OPEN) {
        put_text(said, "open");
    } else if (valve == WH_VALVE_CLOSED) {
        put_text(said, "closed");
    } else {
        put_text(said, "valve ");
        wh_words_integer(&said->words, valve);
    }
}

/* ----------------------------------------------------------------------------------------------- a table */

static void put_pose(table_words_t *said, const wh_pose_t *pose) {
    const wh_mat3_t *R = &pose->R;
    const wh_real_t aside = wh_real_sqrt(R->m[0][2] * R->m[0][2] + R->m[1][2] * R->m[1][2]);
    put_text(said, ": at ");
    put_real(said, pose->r.x, 3);
    put_text(said, ", ");
    put_real(said, pose->r.y, 3);
    put_text(said, ", ");
    put_real(said, pose->r.z, 3);
    put_text(said, " mm, turned ");
    put_real(said, wh_deg_from_rad(wh_atan2(R->m[1][0], R->m[0][0])), 3);
    put_text(said, degree_of(said));
    put_text(said, ", tilted ");
    put_real(said, wh_deg_from_rad(wh_atan2(aside, R->m[2][2])), 3);
    put_text(said, degree_of(said));
}

static void put_encounter(table_words_t *said, const char *verb, const wh_encounter_t *encounter) {
    if (encounter->wafer == WH_NONE) {
        return;
    }
    put_text(said, verb);
    put_name(said, WH_NAME_WAFER, encounter->wafer);
    put_text(said, " (slice ");
    put_whole(said, encounter->slice);
    put_text(said, ": |dr_proj_z| ");
    put_real(said, wh_real_abs(encounter->measured.dr_proj_z), 3);
    put_text(said, " mm, |dr_proj_xy| ");
    put_real(said, encounter->measured.dr_proj_xy_norm, 3);
    put_text(said, " mm, n1_proj_n2 ");
    put_real(said, encounter->measured.n1_proj_n2, 6);
    put_text(said, ")");
}

static void say_wafer(table_words_t *said, const wh_grasp_t *table, size_t index) {
    const wh_wafer_t *wafer = &table->storage.wafers[index];
    put_name(said, WH_NAME_WAFER, (int32_t)index);
    put_pose(said, &wafer->base_from_wafer);
    put_text(said, wafer->holder == WH_NONE ? ": free" : ": held by ");
    if (wafer->holder != WH_NONE) {
        put_name(said, WH_NAME_GRIPPER, wafer->holder);
    }
    put_text(said, "\n");
}

static void say_gripper(table_words_t *said, const wh_grasp_t *table, size_t index) {
    const wh_gripper_t *gripper = &table->storage.grippers[index];
    put_name(said, WH_NAME_GRIPPER, (int32_t)index);
    put_pose(said, &gripper->base_from_gripper);
    put_text(said, ": ");
    put_valve(said, gripper->valve);
    if (gripper->wafer != WH_NONE) {
        put_text(said, ", holds ");
        put_name(said, WH_NAME_WAFER, gripper->wafer);
    }
    put_encounter(said, ", follows ", &gripper->approach);
    put_encounter(said, ", contests ", &gripper->contest);
    put_text(said, "\n");
}

size_t wh_grasp_text(const wh_grasp_t *table, const wh_event_names_t *names, char *buffer, size_t size) {
    table_words_t said = begin(names, buffer, size);
    const char *why = missing(table);
    if (why) {
        put_text(&said, "the table is ");
        put_text(&said, why);
        put_text(&said, "\n");
        return said.words.length;
    }
    put_text(&said, "slice ");
    put_whole(&said, table->slice);
    put_text(&said, "\n");
    for (size_t w = 0; w < table->storage.wafer_count; ++w) {
        say_wafer(&said, table, w);
    }
    for (size_t g = 0; g < table->storage.gripper_count; ++g) {
        say_gripper(&said, table, g);
    }
    return said.words.length;
}

/* ------------------------------------------------------------------------------------------- a difference */

/* The thing that is compared: a wafer or gripper. Where there is a verb, the gripper holds, follows or
 * contests `wafer`. `parts` counts what its line says so far. */
typedef struct {
    table_words_t said;
    wh_name_kind_t kind;
    int32_t index, wafer;
    const char *verb;
    size_t parts;
} difference_t;

/* Begins the line of the thing, or goes on with it. */
static table_words_t *open_part(difference_t *difference) {
    table_words_t *said = &difference->said;
    if (difference->parts > 0) {
        put_text(said, ", ");
    } else {
        put_name(said, difference->kind, difference->index);
        if (difference->verb) {
            put_text(said, difference->verb);
            put_name(said, WH_NAME_WAFER, difference->wafer);
        }
        put_text(said, ": ");
    }
    ++difference->parts;
    return said;
}

static void close_line(difference_t *difference) {
    if (difference->parts > 0) {
        put_text(&difference->said, "\n");
    }
    difference->parts = 0;
}

static bool is_same(wh_real_t a, wh_real_t b) {
    wh_real_bits_t one;
    wh_real_bits_t other;
    memcpy(&one, &a, sizeof one);
    memcpy(&other, &b, sizeof other);
    return one == other;
}

/* Both numbers, with as many decimals as show that they differ. */
static void compare_real(difference_t *difference, const char *name, const char *unit, wh_real_t expected,
                         wh_real_t found) {
    if (is_same(expected, found)) {
        return;
    }
    table_words_t *said = open_part(difference);
    const int decimals = wh_words_apart(expected, found, 3);
    const bool is_opposite = (expected < 0) != (found < 0);
    put_text(said, name);
    put_real(said, found, decimals);
    put_text(said, unit);
    put_text(said, " (expected ");
    put_real(said, expected, decimals);
    put_text(said, unit);
    put_text(said, is_opposite || !wh_words_read_same(expected, found, decimals) ? ")" : ", of other bits)");
}

static void compare_vector(difference_t *difference, const char *const names[3], const wh_vec3_t *expected,
                           const wh_vec3_t *found) {
    compare_real(difference, names[0], " mm", expected->x, found->x);
    compare_real(difference, names[1], " mm", expected->y, found->y);
    compare_real(difference, names[2], " mm", expected->z, found->z);
}

static bool is_same_rotation(const wh_mat3_t *a, const wh_mat3_t *b) {
    bool same = true;
    for (size_t i = 0; i < 9; ++i) {
        same = same && is_same(a->m[i / 3][i % 3], b->m[i / 3][i % 3]);
    }
    return same;
}

/* The angle from one rotation to another, rad: also where it is small. */
static wh_real_t angle_between(const wh_mat3_t *a, const wh_mat3_t *b) {
    wh_mat3_t turn;
    wh_mat3_multiply_back_to(a, b, &turn);
    const wh_vec3_t axis =
        wh_vec3(turn.m[2][1] - turn.m[1][2], turn.m[0][2] - turn.m[2][0], turn.m[1][0] - turn.m[0][1]);
    return wh_atan2(wh_vec3_norm(&axis), turn.m[0][0] + turn.m[1][1] + turn.m[2][2] - 1);
}

static void compare_rotation(difference_t *difference, const wh_mat3_t *expected, const wh_mat3_t *found) {
    if (is_same_rotation(expected, found)) {
        return;
    }
    table_words_t *said = open_part(difference);
    const wh_real_t deg = wh_deg_from_rad(angle_between(expected, found));
    if (wh_words_read_same(deg, 0, WH_WORDS_DECIMALS)) {
        put_text(said, "a rotation of other bits than expected");
    } else {
        put_text(said, "turned by ");
        wh_words_short(&said->words, deg, 3, 0);
        put_text(said, degree_of(said));
        put_text(said, " from where it was expected");
    }
}

static void compare_pose(difference_t *difference, const wh_pose_t *expected, const wh_pose_t *found) {
    static const char *const names[] = {"x ", "y ", "z "};
    compare_vector(difference, names, &expected->r, &found->r);
    compare_rotation(difference, &expected->R, &found->R);
}

/* A thing that is expected by its index; `verb` stands before the one that was found. */
static void compare_index(difference_t *difference, const char *verb, wh_name_kind_t kind, int32_t expected,
                          int32_t found) {
    if (expected != found) {
        table_words_t *said = open_part(difference);
        put_text(said, verb);
        put_name(said, kind, found);
        put_text(said, " (expected ");
        put_name(said, kind, expected);
        put_text(said, ")");
    }
}

static void compare_slice(difference_t *difference, uint64_t expected, uint64_t found) {
    if (expected != found) {
        table_words_t *said = open_part(difference);
        put_text(said, "in slice ");
        put_whole(said, found);
        put_text(said, " (expected ");
        put_whole(said, expected);
        put_text(said, ")");
    }
}

static void compare_measured(difference_t *difference, const wh_proximity_t *expected,
                             const wh_proximity_t *found) {
    static const char *const dr[] = {"dr x ", "dr y ", "dr z "};
    static const char *const aside[] = {"dr_proj_xy x ", "dr_proj_xy y ", "dr_proj_xy z "};
    compare_vector(difference, dr, &expected->dr, &found->dr);
    compare_real(difference, "n1_proj_n2 ", "", expected->n1_proj_n2, found->n1_proj_n2);
    compare_real(difference, "dr_proj_z ", " mm", expected->dr_proj_z, found->dr_proj_z);
    compare_vector(difference, aside, &expected->dr_proj_xy, &found->dr_proj_xy);
    compare_real(difference, "|dr_proj_xy| ", " mm", expected->dr_proj_xy_norm, found->dr_proj_xy_norm);
}

/* Only of one and the same wafer: values of another one would say nothing. */
static void compare_encounter(difference_t *difference, const char *verb, const wh_encounter_t *expected,
                              const wh_encounter_t *found) {
    if (expected->wafer != found->wafer || found->wafer == WH_NONE) {
        return;
    }
    difference->verb = verb;
    difference->wafer = found->wafer;
    compare_index(difference, "held by ", WH_NAME_GRIPPER, expected->holder, found->holder);
    compare_slice(difference, expected->slice, found->slice);
    const bool shows_front = found->face == WH_FACE_FRONT;
    if (shows_front != (expected->face == WH_FACE_FRONT)) {
        put_text(open_part(difference),
                 shows_front ? "by its front (expected its back)" : "by its back (expected its front)");
    }
    compare_measured(difference, &expected->measured, &found->measured);
    close_line(difference);
}

static void compare_wafer(difference_t *difference, const wh_wafer_t *expected, const wh_wafer_t *found) {
    compare_index(difference, "held by ", WH_NAME_GRIPPER, expected->holder, found->holder);
    compare_pose(difference, &expected->base_from_wafer, &found->base_from_wafer);
    close_line(difference);
}

static void compare_gripper(difference_t *difference, const wh_gripper_t *expected,
                            const wh_gripper_t *found) {
    if (expected->valve != found->valve) {
        table_words_t *said = open_part(difference);
        put_valve(said, found->valve);
        put_text(said, " (expected ");
        put_valve(said, expected->valve);
        put_text(said, ")");
    }
    compare_index(difference, "holds ", WH_NAME_WAFER, expected->wafer, found->wafer);
    compare_index(difference, "follows ", WH_NAME_WAFER, expected->approach.wafer, found->approach.wafer);
    compare_index(difference, "contests ", WH_NAME_WAFER, expected->contest.wafer, found->contest.wafer);
    compare_pose(difference, &expected->base_from_gripper, &found->base_from_gripper);
    close_line(difference);
    if (expected->wafer == found->wafer && found->wafer != WH_NONE) {
        difference->verb = " holds ";
        difference->wafer = found->wafer;
        compare_pose(difference, &expected->gripper_from_wafer, &found->gripper_from_wafer);
        close_line(difference);
    }
    compare_encounter(difference, " follows ", &expected->approach, &found->approach);
    compare_encounter(difference, " contests ", &expected->contest, &found->contest);
    difference->verb = NULL;
}

static void compare_tables(difference_t *difference, const wh_grasp_t *expected, const wh_grasp_t *found) {
    const wh_grasp_storage_t *a = &expected->storage;
    const wh_grasp_storage_t *b = &found->storage;
    for (size_t w = 0; w < b->wafer_count; ++w) {
        difference->kind = WH_NAME_WAFER;
        difference->index = (int32_t)w;
        compare_wafer(difference, &a->wafers[w], &b->wafers[w]);
    }
    for (size_t g = 0; g < b->gripper_count; ++g) {
        difference->kind = WH_NAME_GRIPPER;
        difference->index = (int32_t)g;
        compare_gripper(difference, &a->grippers[g], &b->grippers[g]);
    }
}

/* Writes what keeps two tables from being compared; false if nothing does. */
static bool say_missing(table_words_t *said, const char *whose, const wh_grasp_t *table) {
    const char *why = missing(table);
    if (why) {
        put_text(said, whose);
        put_text(said, why);
        put_text(said, "\n");
    }
    return why != NULL;
}

static void say_count(table_words_t *said, const char *what, uint64_t expected, uint64_t found) {
    if (expected != found) {
        put_text(said, what);
        put_whole(said, found);
        put_text(said, " (expected ");
        put_whole(said, expected);
        put_text(said, ")\n");
    }
}

size_t wh_grasp_difference(const wh_grasp_t *expected, const wh_grasp_t *found, const wh_event_names_t *names,
                           char *buffer, size_t size) {
    difference_t difference = {.kind = WH_NAME_WAFER, .wafer = WH_NONE};
    difference.said = begin(names, buffer, size);
    const bool none_expected = say_missing(&difference.said, "the expected table is ", expected);
    const bool none_found = say_missing(&difference.said, "the table is ", found);
    if (none_expected || none_found) {
        return difference.said.words.length;
    }
    const wh_grasp_storage_t *a = &expected->storage;
    const wh_grasp_storage_t *b = &found->storage;
    say_count(&difference.said, "wafers: ", a->wafer_count, b->wafer_count);
    say_count(&difference.said, "grippers: ", a->gripper_count, b->gripper_count);
    if (a->wafer_count == b->wafer_count && a->gripper_count == b->gripper_count) {
        say_count(&difference.said, "slice ", expected->slice, found->slice);
        compare_tables(&difference, expected, found);
    }
    return difference.said.words.length;
}
