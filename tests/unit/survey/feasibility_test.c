/* Errors of a cell that show before anything moves: the room around a blade compared with figures
 * worked out by hand, and the findings for cells that do not work. */
#include "survey/feasibility.h"

#include "math/trig.h"
#include "support/layout.h"

#define GRIPPERS "grippers = { { name = 'EE' } }, "

static wh_feasibility_t check;

static int free_check(void **state) {
    (void)state;
    wh_feasibility_free(&check);
    return 0;
}

static void look_at(const char *fields) {
    wh_feasibility_free(&check);
    wh_feasibility(&check, read_sound(fields));
    assert_true(check.has_parts);
}

/* The first finding of a kind with this text; fails if there is none. */
static const wh_finding_t *expect_finding(wh_finding_kind_t kind, const char *text) {
    for (size_t i = 0; i < check.count; ++i) {
        if (check.findings[i].kind == kind && strstr(check.findings[i].text, text)) {
            return &check.findings[i];
        }
    }
    for (size_t i = 0; i < check.count; ++i) {
        print_error("%s: %s\n", wh_finding_name(check.findings[i].kind), check.findings[i].text);
    }
    fail_msg("nobody says \"%s\"", text);
    return NULL;
}

static size_t count_findings(wh_finding_kind_t kind) {
    size_t count = 0;
    for (size_t i = 0; i < check.count; ++i) {
        count += check.findings[i].kind == kind ? 1 : 0;
    }
    return count;
}

/* The number of findings, and how many of them are no warnings. */
static void expect_findings(size_t count, size_t wrong) {
    assert_int_equal(check.count, count);
    assert_int_equal(check.wrong, wrong);
}

/* --------------------------------------------------------------------------------------------------- room */

/* Numbers of a station of level slots: thickness and length along z, and the way in. */
typedef struct {
    double pitch, stroke, offset, retract, blade, ledge;
} slots_t;

static slots_t draw_slots(void) {
    return (slots_t){.pitch = wh_test_uniform(12, 20),
                     .stroke = wh_test_uniform(5, 7),
                     .offset = wh_test_uniform(1, 4),
                     .retract = wh_test_uniform(310, 360),
                     .blade = wh_test_uniform(1, 3),
                     .ledge = wh_test_uniform(0.5, 2)};
}

static void look_at_slots(const slots_t *s, int count, const char *more) {
    char fields[800];
    (void)snprintf(fields, sizeof fields,
                   GRIPPERS
                   "stations = { A = { at = { 700, 0, 900 }, slots = %d, pitch = %.17g, stroke = %.17g, "
                   "offset = %.17g, retract = %.17g } }, "
                   "shapes = { blade = { thickness = %.17g }, ledge = { thickness = %.17g } }, %s",
                   count, s->pitch, s->stroke, s->offset, s->retract, s->blade, s->ledge, more);
    look_at(fields);
}

/* The wafer is 0.775 thick. With checks at slices it is taken up to a step of 0.02 mm nearer than
 * eps_projz. */
static void room_between_level_slots(void **state) {
    (void)state;
    for (int i = 0; i < 20; ++i) {
        const slots_t s = draw_slots();
        const double deep = s.stroke - s.offset;
        look_at_slots(&s, 3, "");
        const wh_entry_t *entry = &check.entries[0];
        assert_true(entry->has_above && entry->has_below && entry->has_beside && entry->has_before &&
                    entry->has_lifted);
        assert_near(entry->above, deep, 1e-6);
        assert_near(entry->below, s.pitch - deep - 0.775 - s.blade, 1e-6);
        assert_near(entry->beside, 140 - 75, 1e-6);
        assert_near(entry->before, s.retract - 300, 1e-6);
        assert_near(entry->lifted, s.pitch - s.ledge - s.offset - (0.998 * 0.5 - 0.02) - 0.775, 1e-6);
        assert_int_equal(entry->wafers, 0);
        expect_findings(0, 0);
        look_at_slots(&s, 2, "check = 'swept'");
        assert_near(check.entries[0].lifted, s.pitch - s.ledge - s.offset - 0.998 * 0.5 - 0.775, 1e-6);
        look_at_slots(&s, 2, "seat = true");
        assert_near(check.entries[0].lifted, s.pitch - s.ledge - s.offset - 0.775, 1e-6);
    }
}

/* In front of a single slot the gripper holds nothing, as that would be the wafer itself: a
 * finger's inner corner is nearest. */
static void room_at_a_single_slot(void **state) {
    (void)state;
    const slots_t s = {.pitch = 10, .stroke = 6, .offset = 2, .retract = 300, .blade = 3, .ledge = 0.5};
    look_at_slots(&s, 1, "");
    const wh_entry_t *entry = &check.entries[0];
    assert_true(entry->has_above && !entry->has_below && !entry->has_lifted && entry->has_before);
    assert_near(entry->above, 4, 1e-6);
    assert_near(entry->before, sqrt(200.0 * 200 + 50 * 50) - 150, 1e-6);
    expect_findings(0, 0);
}

/* Turned and moved it has the same room; a chuck has a radius of 40. */
static void room_at_a_prealigner(void **state) {
    (void)state;
    look_at(
        "grippers = { { name = 'EE' }, { name = 'PA', on = 'P' } }, stations = { P = { kind = 'prealigner', "
        "at = { -600, 100, 950 }, rpy = { 0, 0, 170 }, stroke = 6, offset = 3 } }");
    assert_near(check.entries[0].above, 3, 1e-6);
    assert_near(check.entries[0].beside, 50 - 40, 1e-6);
    assert_false(check.entries[0].has_below);
    expect_findings(0, 0);
    look_at(
        "grippers = { { name = 'EE' }, { name = 'PA', on = 'P' } }, stations = { P = { kind = 'prealigner', "
        "at = { -600, 100, 950 }, rpy = { 0, 0, 170 } } }, shapes = { chuck = { radius = 55 } }");
    assert_int_equal(
        expect_finding(WH_FINDING_LEDGES, "P: the blade touches the chuck as it rises through the slot")
            ->station,
        0);
}

static void room_that_is_less_than_asked_for(void **state) {
    (void)state;
    static const char cell[] = GRIPPERS "stations = { A = { at = { 700, 0, 900 }, slots = 3, retract = 310 } "
                                        "}, shapes = { ledge = { inner = 90 } }, ";
    char fields[600];
    (void)snprintf(fields, sizeof fields, "%s%s", cell,
                   "clearance = { blade_wafer_above = 3.01, blade_wafer_below = 3.226, blade_other = 15.1 }");
    look_at(fields);
    expect_findings(3, 3);
    expect_finding(
        WH_FINDING_GAP,
        "A: the blade has 3 mm to the wafer above, `clearance.blade_wafer_above` asks for at least 3.01 mm");
    expect_finding(WH_FINDING_GAP, "A: the blade has 3.225 mm to the wafer below, "
                                   "`clearance.blade_wafer_below` asks for at least 3.226 mm");
    expect_finding(WH_FINDING_GAP,
                   "A: the blade has 15 mm to the ledges, `clearance.blade_other` asks for at least 15.1 mm");
    (void)snprintf(fields, sizeof fields, "%s%s", cell,
                   "clearance = { blade_wafer_above = 2.99, blade_wafer_below = 3.224, blade_other = 14.9 }");
    look_at(fields);
    expect_findings(0, 0);
}

static void a_blade_that_does_not_fit(void **state) {
    (void)state;
    slots_t s = {.pitch = 10, .stroke = 6, .offset = 3, .retract = 310, .blade = 6.3, .ledge = 0.5};
    look_at_slots(&s, 2, "");
    expect_finding(
        WH_FINDING_ENTRY,
        "A: entering 3 mm below a slot, the blade touches the wafer below; pitch 10 mm, blade 6.3 mm");
    assert_int_equal(check.entries[0].below, 0);
    expect_findings(1, 1);
    /* The height of a wafer and its ledges counts: lifted by 5.6 it touches those above. */
    s = (slots_t){.pitch = 10, .stroke = 9, .offset = 8.4, .retract = 310, .blade = 3, .ledge = 0.5};
    look_at_slots(&s, 2, "");
    expect_finding(WH_FINDING_ENTRY,
                   "A: a GET lifts its wafer against the ledges or the wafer above: `offset` 8.4 mm, "
                   "pitch 10 mm, ledges 0.5 mm, wafer 0.775 mm, tilt 0 deg");
    assert_int_equal(check.entries[0].lifted, 0);
    /* Tilted by a degree, the finger's outer edge, 75 mm aside, comes 1.3 mm nearer to the parts there. */
    look_at(GRIPPERS "stations = { A = { at = { 700, 0, 900 }, rpy = { 1, 0, 0 }, slots = 2, stroke = 1.2, "
                     "offset = 0.2 } }");
    expect_finding(WH_FINDING_ENTRY, "the wafer in it; it is tilted by 1 deg, upright it would have 1 mm");
}

static void a_way_in_that_is_too_short(void **state) {
    (void)state;
    const slots_t s = {.pitch = 10, .stroke = 6, .offset = 3, .retract = 290, .blade = 3, .ledge = 0.5};
    look_at_slots(&s, 2, "");
    assert_int_equal(expect_finding(WH_FINDING_RETRACT,
                                    "A: `retract` of 290 mm is too little: in front of the station a "
                                    "wafer on the blade overlaps its wafers")
                         ->station,
                     0);
    expect_findings(1, 1);
    look_at(GRIPPERS "stations = { A = { at = { 700, 0, 900 }, slots = 1, retract = 200 } }");
    expect_finding(WH_FINDING_RETRACT, "in front of the station the blade overlaps its wafers");
    /* 300 by default: rim at rim. */
    look_at(GRIPPERS "stations = { A = { at = { 700, 0, 900 }, slots = 2 } }");
    assert_true(expect_finding(WH_FINDING_RETRACT, "A: `retract` of 300 mm (default) leaves 0 mm between a "
                                                   "wafer on the blade and the station's wafers")
                    ->is_warning);
    expect_findings(1, 0);
}

/* The walls begin 158 mm before a slot's middle. A held wafer's rim is 150 mm nearer to it than the
 * blade is. */
static void a_way_in_that_begins_in_a_foup(void **state) {
    (void)state;
    static const char cell[] =
        GRIPPERS "stations = { F = { kind = 'foup', at = { 800, 0, 900 }, slots = 2, retract = %d } }";
    char fields[200];
    (void)snprintf(fields, sizeof fields, cell, 301);
    look_at(fields);
    assert_true(expect_finding(WH_FINDING_RETRACT,
                               "F: `retract` of 301 mm leaves a wafer on the blade 7 mm deep in "
                               "the FOUP, whose walls it may hit as the arm turns")
                    ->is_warning);
    expect_findings(1, 0);
    assert_int_equal(strncmp(check.findings[0].text, "F: ", 3), 0);
    (void)snprintf(fields, sizeof fields, cell, 308);
    look_at(fields);
    expect_findings(0, 0);
}

/* ------------------------------------------------------------------------------------ stations and blades */

static void stations_whose_wafers_touch(void **state) {
    (void)state;
    /* B's slots are turned over A's, 0.5 mm higher: each of the three wafers touches one. */
    look_at(GRIPPERS "stations = { A = { at = { 700, 0, 900 }, slots = 3, retract = 310 }, "
                     "B = { at = { 700, 0, 900.5 }, rpy = { 0, 0, 20 }, slots = 3, retract = 310 } }");
    const wh_finding_t *finding = expect_finding(
        WH_FINDING_SPACE, "A and B overlap: a wafer in A slot 1 touches B ledge 1 right; so do 8 more pairs");
    assert_int_equal(finding->station, 0);
    assert_int_equal(finding->other, 1);
    assert_int_equal(finding->slot, 1);
    assert_int_equal(count_findings(WH_FINDING_SPACE), 1);
    /* In the same places, on ledges that only touch; and with B's wafers in A's ledges. */
    look_at(GRIPPERS "stations = { A = { at = { 700, 0, 900 }, slots = 3, retract = 310 }, "
                     "B = { at = { 700, 0, 900 }, rpy = { 0, 0, 20 }, slots = 3, retract = 310 } }");
    expect_finding(WH_FINDING_SPACE,
                   "A and B overlap: a wafer in A slot 1 touches one in B slot 1; so do 2 more pairs");
    look_at(GRIPPERS "stations = { A = { at = { 700, 0, 900 }, slots = 3, retract = 310 }, "
                     "B = { at = { 700, 0, 899.5 }, rpy = { 0, 0, 20 }, slots = 3, retract = 310 } }");
    expect_finding(WH_FINDING_SPACE, "a wafer in A slot 1 touches one in B slot 1; so do 8 more pairs");
    assert_int_equal(count_findings(WH_FINDING_SPACE), 1);
    /* In a station that no gripper serves, wafers do not count, but the ledges do. */
    look_at(GRIPPERS
            "stations = { A = { at = { 700, 0, 900 }, slots = 3, retract = 310 }, "
            "B = { at = { 700, 0, 900.5 }, rpy = { 0, 0, 20 }, slots = 3, retract = 310, taught = false } }");
    expect_finding(WH_FINDING_SPACE, "a wafer in A slot 1 touches B ledge 1");
    assert_int_equal(count_findings(WH_FINDING_SPACE), 1);
}

/* In the middle between the other station's slots no wafer touches, but the blade, from 3 to 6 mm
 * below, does. */
static void stations_whose_wafers_stand_between_one_anothers(void **state) {
    (void)state;
    look_at(GRIPPERS "stations = { A = { at = { 700, 0, 900 }, slots = 3, retract = 310 }, "
                     "B = { at = { 700, 0, 905 }, rpy = { 0, 0, 20 }, slots = 3, retract = 310 } }");
    const wh_finding_t *finding = expect_finding(
        WH_FINDING_SPACE, "A and B overlap: entering A slot 2, the blade touches a wafer in B slot 1");
    assert_int_equal(finding->station, 0);
    assert_int_equal(finding->other, 1);
    assert_int_equal(count_findings(WH_FINDING_SPACE), 1);
}

/* Two arms of one heading: their hands clear each other, but their links are at one height. */
static void two_arms_on_one_side(void **state) {
    (void)state;
    look_at("robot = { kind = 'TRZ', arms = { {}, { heading = 0, height = 60 } } }, "
            "grippers = { { name = 'LOW' }, { name = 'UP', arm = 2 } }, "
            "stations = { A = { at = { 700, 0, 900 }, slots = 3, retract = 310 } }");
    (void)expect_finding(
        WH_FINDING_CONTACT,
        "forearm and forearm 2 touch before anything moves: `height` lifts a hand, the links of "
        "both arms are at one height, unless a `urdf` has them");
}

static void what_touches_before_anything_moves(void **state) {
    (void)state;
    look_at(GRIPPERS "stations = { A = { at = { 700, 0, 900 }, slots = 3, retract = 310 } }, "
                     "wafers = { { name = 'W', station = 'A', slot = 2 } }, "
                     "obstacles = { { name = 'pole', at = { 850, 0, 900 }, box = { 4, 20, 200 } } }");
    const wh_finding_t *finding =
        expect_finding(WH_FINDING_CONTACT, "W and pole touch before anything moves");
    const wh_layout_t *layout = check.layout;
    assert_string_equal(wh_layout_part_name(layout, finding->parts[0]), "W");
    assert_string_equal(wh_layout_part_name(layout, finding->parts[1]), "pole");
    assert_int_equal(finding->station, WH_NONE);
    assert_int_equal(check.entries[0].wafers, 1);
    /* The wafers of all slots would touch; one that does is known already. */
    assert_int_equal(count_findings(WH_FINDING_SPACE), 0);
    look_at(GRIPPERS "stations = { A = { at = { 700, 0, 900 }, slots = 3, retract = 310 } }, "
                     "obstacles = { { name = 'pole', at = { 850, 0, 900 }, box = { 4, 20, 200 } } }");
    assert_int_equal(count_findings(WH_FINDING_CONTACT), 0);
    finding = expect_finding(WH_FINDING_SPACE, "a wafer in A slot 1 touches pole; so do 2 more pairs");
    assert_int_equal(finding->slot, 1);
    assert_int_equal(finding->other, WH_NONE);
}

/* The blade at home, at 900 mm, goes through a wafer that would lie a little lower. */
static void what_a_wafer_would_touch_of_the_robot_at_home(void **state) {
    (void)state;
    look_at("grippers = { { name = 'a gripper whose name is as long as may be.....' } }, "
            "stations = { A = { at = { 420, 0, 899 }, slots = 1 } }");
    const wh_finding_t *finding =
        expect_finding(WH_FINDING_SPACE, "a wafer in A slot 1 touches a gripper whose name is as long as may "
                                         "be..... finger left, with the robot at home");
    assert_int_equal(finding->station, 0);
    assert_int_equal(finding->other, WH_NONE);
}

/* Two blades, one 12 mm above the other: with EE in slot 1 a wafer on UP lies 12 mm above, beside
 * the wafer of slot 2. */
static void a_second_blade_in_the_way(void **state) {
    (void)state;
    look_at("grippers = { { name = 'EE' }, { name = 'UP', on = 'robot', at = { 0, 0, 12 } } }, "
            "stations = { A = { at = { 700, 0, 900 }, slots = 2, retract = 310 } }");
    const wh_finding_t *finding = expect_finding(
        WH_FINDING_BLADES, "A: with EE in slot 1, UP or a wafer on it touches the wafer in slot 2");
    assert_int_equal(finding->station, 0);
    assert_int_equal(finding->slot, 1);
    look_at("grippers = { { name = 'EE' }, { name = 'UP', on = 'robot', at = { 0, 0, 40 } } }, "
            "stations = { A = { at = { 700, 0, 900 }, slots = 2, retract = 310 } }");
    expect_findings(0, 0);
    /* 6.6 mm above it the other blade stays below 9.6 as it moves up 3; the wafer on it does not
     * stay below 10. */
    look_at("grippers = { { name = 'EE' }, { name = 'UP', on = 'robot', at = { 0, 0, 6.6 } } }, shapes = { "
            "blade = { thickness = 1 } }, "
            "stations = { A = { at = { 700, 0, 900 }, slots = 2, retract = 310 } }");
    expect_finding(WH_FINDING_BLADES,
                   "A: with EE in slot 1, UP or a wafer on it touches the wafer in slot 2");
    look_at("grippers = { { name = 'EE' }, { name = 'UP', on = 'robot', at = { 0, 0, 6.2 } } }, shapes = { "
            "blade = { thickness = 1 } }, "
            "stations = { A = { at = { 700, 0, 900 }, slots = 2, retract = 310 } }");
    expect_findings(0, 0);
    /* Its own wafer runs into the blade above it. */
    look_at("grippers = { { name = 'EE' }, { name = 'UP', on = 'robot', at = { 0, 0, 3.5 } } }, "
            "stations = { A = { at = { 700, 0, 900 }, slots = 1, retract = 310 } }");
    expect_finding(WH_FINDING_BLADES,
                   "EE and UP are in each other's way: a wafer on EE overlaps UP finger left");
    look_at("grippers = { { name = 'EE' }, { name = 'UP', on = 'robot', at = { 0, 0, 2.5 } } }, "
            "stations = { A = { at = { 700, 0, 900 }, slots = 1, retract = 310 } }");
    expect_finding(WH_FINDING_BLADES,
                   "EE and UP are in each other's way: EE finger left overlaps UP finger left");
}

/* ------------------------------------------------------------------------------------------------- wafers */

static void what_is_tilted_too_far(void **state) {
    (void)state;
    look_at(GRIPPERS "stations = { A = { at = { 700, 0, 900 }, rpy = { 8.2, 0, 0 }, slots = 1 } }");
    expect_finding(WH_FINDING_TILT,
                   "A is tilted by 8.2 deg (limit 8.11 deg): the level blade takes no wafer that lies there");
    look_at(GRIPPERS "stations = { A = { at = { 700, 0, 900 }, rpy = { 8, 0, 0 }, slots = 1 } }");
    assert_int_equal(count_findings(WH_FINDING_TILT), 0);
    /* A station and its wafer together. */
    look_at(GRIPPERS "stations = { A = { at = { 700, 0, 900 }, rpy = { 0, 5, 0 }, slots = 1 } }, "
                     "wafers = { { name = 'W', station = 'A', slot = 1, rpy = { 0, 4, 0 } } }");
    expect_finding(WH_FINDING_TILT,
                   "W is tilted by 9 deg (limit 8.11 deg): the level blade does not take it");
}

/* All that are named, and some more. */
static void many_wafers_that_are_tilted_too_far(void **state) {
    (void)state;
    for (int count = 19; count <= 23; ++count) {
        char fields[3000];
        int length = snprintf(fields, sizeof fields,
                              GRIPPERS "stations = { A = { at = { 700, 0, 900 }, rpy = { 0, 5, 0 }, slots = "
                                       "25, pitch = 40, retract = 310 } }, wafers = { ");
        for (int i = 1; i <= count; ++i) {
            length += snprintf(fields + length, sizeof fields - (size_t)length,
                               "{ station = 'A', slot = %d, rpy = { 0, 4, 0 } }, ", i);
        }
        (void)snprintf(fields + length, sizeof fields - (size_t)length, "}");
        look_at(fields);
        assert_int_equal(count_findings(WH_FINDING_TILT), count <= 20 ? count : 21);
        if (count > 20) {
            char more[60];
            (void)snprintf(more, sizeof more, "%d more wafers are tilted too far", count - 20);
            expect_finding(WH_FINDING_TILT, more);
        }
    }
}

static void wafers_that_lie_in_no_slot(void **state) {
    (void)state;
    char fields[4000];
    int length = snprintf(
        fields, sizeof fields,
        GRIPPERS "stations = { A = { at = { 700, 0, 900 }, slots = 25, retract = 310 } }, wafers = { ");
    for (int i = 1; i <= 24; ++i) {
        length += snprintf(fields + length, sizeof fields - (size_t)length,
                           "{ station = 'A', slot = %d, dx = %d, dy = 40, dz = 0.1 }, ", i, i == 24 ? 0 : 30);
    }
    (void)snprintf(fields + length, sizeof fields - (size_t)length,
                   "{ station = 'A', slot = 25, rpy = { 0, 9, 0 } } }");
    look_at(fields);
    expect_finding(WH_FINDING_WAFER,
                   "Wafer 1 lies in no slot: it is 50 mm beside and 0.1 mm above the plane of A slot 1");
    expect_finding(WH_FINDING_WAFER, "4 more wafers lie in no slot");
    assert_int_equal(count_findings(WH_FINDING_WAFER), 21);
    assert_int_equal(check.entries[0].wafers, 25);
    look_at(GRIPPERS "stations = { A = { at = { 700, 0, 900 }, slots = 1 } }, wafers = { { station = 'A', "
                     "slot = 1, rpy = { 0, 9, 0 } } }");
    expect_finding(
        WH_FINDING_WAFER,
        "0 mm beside and 0 mm above the plane of A slot 1, tilted against it by 9 deg (limit 8.11 deg)");
}

static void a_release_below_the_support(void **state) {
    (void)state;
    look_at(GRIPPERS "stations = { A = { at = { 700, 0, 900 }, slots = 1, release = -1 } }");
    expect_finding(
        WH_FINDING_RELEASE,
        "A: `release` of -1 mm lets go of a wafer that is eps_projz, 0.5 mm, or more below its slot");
    look_at(GRIPPERS "stations = { A = { at = { 700, 0, 900 }, slots = 1, release = -0.99 } }");
    assert_int_equal(count_findings(WH_FINDING_RELEASE), 0);
    look_at(GRIPPERS "stations = { A = { at = { 700, 0, 900 }, slots = 1, release = -0.51 } }, seat = true");
    assert_int_equal(count_findings(WH_FINDING_RELEASE), 1);
}

static void links_that_do_not_reach(void **state) {
    (void)state;
    /* The wrist is 450 mm from theta's axis in both slots, and 140 mm at the beginning of the way. */
    look_at(GRIPPERS "stations = { A = { at = { 700, 0, 900 }, slots = 2, retract = 310 } }, shapes = { arm "
                     "= { link = 200 } }");
    const wh_finding_t *finding =
        expect_finding(WH_FINDING_LINKS, "A slot 1: two links of 200 mm do not reach the wrist");
    assert_int_equal(finding->slot, 1);
    assert_int_equal(count_findings(WH_FINDING_LINKS), 2);
    look_at(GRIPPERS "stations = { A = { at = { 700, 0, 900 }, slots = 2, retract = 310 } }, shapes = { arm "
                     "= { link = 226 } }");
    assert_int_equal(count_findings(WH_FINDING_LINKS), 0);
}

/* ------------------------------------------------------------------------------------------------- beams */

/* Three slots of 10 mm, left 3 mm above each: a beam from -30 to 12 mm misses the second. */
static void beams_that_wafers_do_not_break(void **state) {
    (void)state;
    static const char cell[] =
        GRIPPERS "stations = { A = { at = { 700, 0, 900 }, slots = 3, retract = 310, %s } }";
    char fields[500];
    (void)snprintf(fields, sizeof fields, cell, "beams = { { y = 60 }, { y = -110, high = 12 } }");
    look_at(fields);
    const wh_finding_t *finding =
        expect_finding(WH_FINDING_SIGHT, "A slot 2: beams[2] is from -30 to 12 mm above slot 1, and a wafer "
                                         "that is put there passes 13 mm above it: it breaks no light");
    assert_int_equal(finding->slot, 2);
    assert_true(finding->is_warning);
    expect_findings(1, 0);
    (void)snprintf(fields, sizeof fields, cell,
                   "centre = true, beams = { { y = 60, stuck = 'lit' }, { y = -110, low = 4 } }");
    look_at(fields);
    assert_true(
        expect_finding(WH_FINDING_SIGHT, "A: beams[1] is stuck (`stuck = \"lit\"`) and tells of no wafer")
            ->is_warning);
    assert_false(expect_finding(WH_FINDING_SIGHT, "A slot 1: beams[2] is from 4 to 50 mm")->is_warning);
    expect_findings(2, 1);
    (void)snprintf(fields, sizeof fields, cell, "beams = { { y = 60, low = 3, high = 23 } }");
    look_at(fields);
    expect_findings(0, 0);
}

/* A rim of 942.5 mm; a notch of 1 mm. */
static void edge_sensors_that_cannot_know_a_notch(void **state) {
    (void)state;
    static const char cell[] =
        "grippers = { { name = 'EE' }, { name = 'PA', on = 'P' } }, stations = { P = { kind = 'prealigner', "
        "at = { -600, 0, 950 }, rpy = { 0, 0, 180 }, retract = 310, sensor = { samples = %d, length = %g } } "
        "}";
    char fields[400];
    (void)snprintf(fields, sizeof fields, cell, 3040, 2.0);
    look_at(fields);
    expect_findings(2, 0);
    expect_finding(WH_FINDING_SIGHT,
                   "P: `sensor.samples` of 3040 are 0.31 mm apart on a wafer's rim: ALIGN is sure of a notch "
                   "with 0.31 mm or less, 3041 samples, and without one of the centre alone");
    assert_int_equal(expect_finding(WH_FINDING_SIGHT, "P: `sensor.length` of 2 mm ends 1 mm inside of a "
                                                      "wafer's rim, where its notch of 1 mm ends or goes on")
                         ->station,
                     0);
    (void)snprintf(fields, sizeof fields, cell, 3041, 2.1);
    look_at(fields);
    expect_findings(0, 0);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(room_between_level_slots, free_check),
        cmocka_unit_test_teardown(room_at_a_single_slot, free_check),
        cmocka_unit_test_teardown(room_at_a_prealigner, free_check),
        cmocka_unit_test_teardown(room_that_is_less_than_asked_for, free_check),
        cmocka_unit_test_teardown(a_blade_that_does_not_fit, free_check),
        cmocka_unit_test_teardown(a_way_in_that_is_too_short, free_check),
        cmocka_unit_test_teardown(a_way_in_that_begins_in_a_foup, free_check),
        cmocka_unit_test_teardown(two_arms_on_one_side, free_check),
        cmocka_unit_test_teardown(stations_whose_wafers_touch, free_check),
        cmocka_unit_test_teardown(stations_whose_wafers_stand_between_one_anothers, free_check),
        cmocka_unit_test_teardown(what_touches_before_anything_moves, free_check),
        cmocka_unit_test_teardown(what_a_wafer_would_touch_of_the_robot_at_home, free_check),
        cmocka_unit_test_teardown(a_second_blade_in_the_way, free_check),
        cmocka_unit_test_teardown(what_is_tilted_too_far, free_check),
        cmocka_unit_test_teardown(many_wafers_that_are_tilted_too_far, free_check),
        cmocka_unit_test_teardown(wafers_that_lie_in_no_slot, free_check),
        cmocka_unit_test_teardown(a_release_below_the_support, free_check),
        cmocka_unit_test_teardown(links_that_do_not_reach, free_check),
        cmocka_unit_test_teardown(beams_that_wafers_do_not_break, free_check),
        cmocka_unit_test_teardown(edge_sensors_that_cannot_know_a_notch, free_check),
    };
    return cmocka_run_group_tests(tests, open_sandbox, close_sandbox);
}
