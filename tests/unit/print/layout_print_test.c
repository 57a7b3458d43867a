/* A layout and its errors, word for word: the table, and the JSON except for most of its parts. */
#include "print/layout_print.h"

#include <locale.h>

#include "support/layout.h"

/* With a place to fill in: the pose of A, and the turn of the second blade. */
static const char cell[] =
    "grippers = { { name = 'EE' }, { name = 'UP', on = 'robot', at = { 0, 0, 40 }, rpy = { 0, 0, %d }, valve "
    "= 'v' }, "
    "{ name = 'PA', on = 'P' } }, "
    "stations = { A = { at = { 700, 0, 900 }, rpy = { %g, 0, %d }, slots = 3, pitch = 12, retract = 310, "
    "counts = true, "
    "beams = { { y = 60, delay_on = 0.002, delay_off = 0.001, jitter = 0.0005 }, { y = -110, low = -20, high "
    "= 50, dx = 1, dy = 2, late = 0.0001, stuck = 'dark' } } }, "
    "F = { kind = 'foup', at = { 0, 900, 900 }, rpy = { 0, 0, 90 }, slots = 2, retract = 290, taught = false "
    "}, "
    "P = { kind = 'prealigner', at = { -600, 0, 950 }, rpy = { 0, 0, 180 }, sensor = { samples = 900, noise "
    "= 0.01, offset = 0.05 } } }, "
    "wafers = { { name = 'W1', station = 'A', slot = 2 }, { station = 'A', slot = 1 } }, "
    "vacuum = { build = 0.125, vent = 0.0625 }, pads = { friction = 0.5, force = 5, mass = 0.125 }, "
    "clearance = { blade_wafer_above = 5 }, "
    "obstacles = { { name = 'pole', at = { 850, 0, 300 }, box = { 4, 20, 200 } }, "
    "{ name = 'pin', on = 'EE', at = { -100, 0, 5 }, cylinder = { radius = 2, height = 10 } }, "
    "{ name = 'cap', on = 'lift', at = { 1, 2, 3 }, capsule = { radius = 3, height = 10 } } }, "
    "faults = { { kind = 'leak', gripper = 'EE', after = 1, value = 0.25 }, "
    "{ kind = 'slow_vacuum', gripper = 'PA', after = 0.5, lasting = 2, value = 0.5 }, "
    "{ kind = 'wafer_shifted', wafer = 'W1', after = 0.25, dx = 1 }, { kind = 'command_lost', after = 3, "
    "lasting = 0.25 } }";

static wh_feasibility_t check;
static char *text;

static int tear_down(void **state) {
    (void)state;
    wh_feasibility_free(&check);
    free(text);
    text = NULL;
    return 0;
}

static void look_at(const char *fields) {
    wh_feasibility_free(&check);
    wh_feasibility(&check, read_sound(fields));
}

static void look_at_cell(int turned, double roll, int yaw) {
    char fields[3000];
    (void)snprintf(fields, sizeof fields, cell, turned, roll, yaw);
    look_at(fields);
}

static void print_table(bool colour) {
    const wh_style_t style = {colour, true, 0};
    size_t size = 0;
    free(text);
    FILE *out = open_memstream(&text, &size);
    assert_int_equal(wh_layout_print_table(&check, out, &style), 0);
    assert_int_equal(fclose(out), 0);
}

static void print_json(void) {
    size_t size = 0;
    free(text);
    FILE *out = open_memstream(&text, &size);
    assert_int_equal(wh_layout_print_json(&check, out), 0);
    assert_int_equal(fclose(out), 0);
}

static void assert_says(const char *wanted) {
    if (!strstr(text, wanted)) {
        print_error("not found: %s\nin:\n%s", wanted, text);
        fail();
    }
}

static const char whole_table[] =
    "cell.lua\n"
    "2 wafers of 300 mm, 0.775 mm thick, notch at 0°\n"
    "tolerance paper: 0.5 mm, 50 mm, 0.99; checked once a slice, every 1 ms\n"
    "wafers stay as they were taken; collisions are not checked, 37 parts\n"
    "corrections of a command are at most x 5, y 5, z 2.5 mm, turn 5°\n"
    "\n"
    "Robot\n"
    "axis   from    to  home  speed  acceleration   jerk  in\n"
    "theta  -540   540     0    300          1000  10000  deg, s\n"
    "R       300   900   300   1000          5000  50000  mm, s\n"
    "Z       600  1300   900    400          2000  20000  mm, s\n"
    "yaw    -270   270     0    360          1500  15000  deg, s\n"
    "\n"
    "Grippers\n"
    "gripper  on     valve     at mm     turned deg\n"
    "EE       robot  EE.valve\n"
    "UP       robot  v         0, 0, 40           5\n"
    "PA       P      PA.valve\n"
    "\n"
    "Stations\n"
    "station  kind                        x    y    z  heading deg  tilt deg  slots  pitch  stroke  offset  "
    "retract  wafers  counts\n"
    "A        slots, beams              700    0  900           10       1.5      3     12       6       3   "
    "   310       2  yes\n"
    "F        foup, not taught            0  900  900           90       0.0      2     10       6       3   "
    "   290       0  yes\n"
    "P        prealigner, edge sensor  -600    0  950          180       0.0      1     10       6       3   "
    "   300       0  no\n"
    "\n"
    "Room\n"
    "blade entered at  to the wafer above  to the one below  to ledges or chuck  `retract` before  above a "
    "lifted wafer\n"
    "A                              0.000             3.264              64.949            10.000            "
    "     7.247\n"
    "F                              0.000             3.225              65.000             0.000            "
    "     5.246\n"
    "P                              0.000                                10.000             0.000\n"
    "\n"
    "Holding\n"
    "of all grippers\n"
    "vacuum           builds in 125 ms, vents in 62.5 ms, is at 0.1 without a wafer\n"
    "thresholds       sensor on at 0.7, off below 0.6; lets go below 0.3\n"
    "pads             friction 0.5, 5 N of vacuum, a wafer of 0.125 kg\n"
    "\n"
    "Faults on purpose\n"
    "fault          of   from s  until s        value\n"
    "leak           EE   1       it is cleared  0.25\n"
    "slow_vacuum    PA   0.5     2.5            0.5 s\n"
    "wafer_shifted  W1   0.25    it is cleared\n"
    "command_lost   all  3       3.25\n"
    "\n"
    "Shapes, mm\n"
    "shape   size\n"
    "blade   3 thick, 150 wide, fingers of 25, 100 before its origin, 80 behind\n"
    "ledges  0.5 thick, 150 long, from 140 to 152 beside the middle\n"
    "arm     two links of 344.5, wrist 250 behind the end-effector, elbow left\n"
    "FOUP    walls of 5, 8 from the wafer; floor 25 below, roof 20 above the slots\n"
    "chuck   radius 40, 20 high; a body of radius 60 below it\n"
    "\n"
    "Obstacles, mm\n"
    "obstacle  on    shape                                     x  y    z\n"
    "pole      base  box, 4 by 20 by 200                     850  0  300\n"
    "pin       EE    cylinder, 4 wide, 10 high              -100  0    5\n"
    "cap       lift  capsule, 6 wide, 10 high and its caps     1  2    3\n"
    "\n"
    "Clearances\n"
    "clearance          at least mm\n"
    "blade_wafer_above            5\n"
    "\n"
    "✗ A: entering 3 mm below a slot, pin on EE touches the wafer in it; pitch 12 mm\n"
    "✗ F: entering 3 mm below a slot, pin on EE touches the wafer in it; pitch 10 mm\n"
    "✗ F: `retract` of 290 mm is too little: in front of the station a wafer on the blade overlaps its "
    "wafers\n"
    "! F: `retract` of 290 mm leaves a wafer on the blade 18 mm deep in the FOUP, whose walls it may hit as "
    "the arm turns\n"
    "✗ P: entering 3 mm below a slot, pin on EE touches the wafer in it; pitch 10 mm\n"
    "! P: `retract` of 300 mm (default) leaves 0 mm between a wafer on the blade and the station's wafers\n"
    "! A: beams[2] is stuck (`stuck = \"dark\"`) and tells of no wafer\n"
    "! P: `sensor.samples` of 900 are 1.047 mm apart on a wafer's rim: ALIGN is sure of a notch with 0.31 mm "
    "or less, 3041 samples, and without one of the centre alone\n";

static void the_whole_table(void **state) {
    (void)state;
    look_at_cell(5, 1.5, 10);
    print_table(false);
    assert_string_equal(text, whole_table);
}

/* The JSON up to the wafers, from there to the parts, some of the parts, and the rest after them. */
static const char begin[] =
    "{\n"
    "  \"format\": 1,\n"
    "  \"ok\": false,\n"
    "  \"layout\": \"cell.lua\",\n"
    "  \"wafer_diameter\": 300.0,\n"
    "  \"wafer_thickness\": 0.77500000000000002,\n"
    "  \"notch_deg\": 0.0,\n"
    "  \"notch_depth\": 1.0,\n"
    "  \"tolerance\": {\"name\": \"paper\", \"projz\": 0.5, \"projxy\": 50.0, \"planar\": "
    "0.98999999999999999, \"defaults\": []},\n"
    "  \"check\": \"sampled\",\n"
    "  \"slice_s\": 0.001,\n"
    "  \"seat\": false,\n"
    "  \"settle\": false,\n"
    "  \"collision\": false,\n"
    "  \"axes\": [\n"
    "    {\"name\": \"theta\", \"min\": -540.0, \"max\": 540.0, \"home\": 0.0, \"speed\": 300.0, "
    "\"acceleration\": 1000.0000000000001, \"jerk\": 10000.0},\n"
    "    {\"name\": \"r\", \"min\": 300.0, \"max\": 900.0, \"home\": 300.0, \"speed\": 1000.0, "
    "\"acceleration\": 5000.0, \"jerk\": 50000.0},\n"
    "    {\"name\": \"z\", \"min\": 600.0, \"max\": 1300.0, \"home\": 900.0, \"speed\": 400.0, "
    "\"acceleration\": 2000.0, \"jerk\": 20000.0},\n"
    "    {\"name\": \"yaw\", \"min\": -270.0, \"max\": 270.0, \"home\": 0.0, \"speed\": 360.0, "
    "\"acceleration\": 1500.0000000000002, \"jerk\": 15000.0}\n"
    "  ],\n"
    "  \"grippers\": [\n"
    "    {\"name\": \"EE\", \"on\": \"robot\", \"valve\": \"EE.valve\"},\n"
    "    {\"name\": \"UP\", \"on\": \"robot\", \"valve\": \"v\", \"at\": [0.0, 0.0, 40.0], \"rotation\": "
    "[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]},\n"
    "    {\"name\": \"PA\", \"on\": \"P\", \"valve\": \"PA.valve\"}\n"
    "  ],\n"
    "  \"stations\": [\n"
    "    {\"name\": \"A\", \"kind\": \"slots\", \"at\": [700.0, 0.0, 900.0], \"rotation\": [[1.0, 0.0, 0.0], "
    "[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], \"slots\": 3, \"pitch\": 12.0, \"stroke\": 6.0, \"offset\": 3.0, "
    "\"retract\": 310.0, \"pickup_speed\": 20.0, \"taught\": true, \"by_axes\": false, \"effector\": \"EE\", "
    "\"counts\": true, "
    "\"wafers\": 2, \"room\": {\"above\": 0.0, \"below\": 5.2249999999999091, \"beside\": 65.0, \"before\": "
    "10.0, \"lifted\": 7.2459999999998672}, \"sensor\": null, \"beams\": [{\"x\": -155.0, \"y\": 60.0, "
    "\"low\": -30.0, \"high\": 54.0, \"delay_on\": 0.002, \"delay_off\": 0.001, \"jitter\": "
    "0.00050000000000000001, \"dx\": 0.0, \"dy\": 0.0, \"late\": 0.0, \"stuck\": \"no\"}, {\"x\": -155.0, "
    "\"y\": -110.0, \"low\": -20.0, \"high\": 50.0, \"delay_on\": 0.0, \"delay_off\": 0.0, \"jitter\": 0.0, "
    "\"dx\": 1.0, \"dy\": 2.0, \"late\": 0.0001, \"stuck\": \"dark\"}], \"centre\": false},\n"
    "    {\"name\": \"F\", \"kind\": \"foup\", \"at\": [0.0, 900.0, 900.0], \"rotation\": [[0.0, -1.0, 0.0], "
    "[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]], \"slots\": 2, \"pitch\": 10.0, \"stroke\": 6.0, \"offset\": 3.0, "
    "\"retract\": 290.0, \"pickup_speed\": 20.0, \"taught\": false, \"by_axes\": false, \"effector\": "
    "\"EE\", \"counts\": true, "
    "\"wafers\": 0, \"room\": {\"above\": 0.0, \"below\": 3.2249999999999091, \"beside\": 65.0, \"before\": "
    "0.0, \"lifted\": 5.2459999999998672}, \"sensor\": null, \"beams\": [], \"centre\": false},\n"
    "    {\"name\": \"P\", \"kind\": \"prealigner\", \"at\": [-600.0, 0.0, 950.0], \"rotation\": [[-1.0, "
    "-0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]], \"slots\": 1, \"pitch\": 10.0, \"stroke\": 6.0, "
    "\"offset\": 3.0, \"retract\": 300.0, \"pickup_speed\": 20.0, \"taught\": true, \"by_axes\": false, "
    "\"effector\": \"EE\", "
    "\"counts\": false, \"wafers\": 0, \"room\": {\"above\": 0.0, \"below\": null, \"beside\": 10.0, "
    "\"before\": 0.0, \"lifted\": null}, \"sensor\": {\"samples\": 900, \"pixel\": 0.0070000000000000001, "
    "\"length\": 28.0, \"at\": 0.0, \"encoder\": 0, \"noise\": 0.01, \"tilt\": 0.0, \"offset\": "
    "0.050000000000000003, \"zero\": 0.0, \"gain\": 0.0, \"latency\": 0.0, \"hidden\": 0}, \"beams\": [], "
    "\"centre\": false}\n"
    "  ],\n";

static const char middle[] =
    "  \"wafers\": [\n"
    "    {\"name\": \"W1\", \"station\": \"A\", \"slot\": 2},\n"
    "    {\"name\": \"Wafer 2\", \"station\": \"A\", \"slot\": 1}\n"
    "  ],\n"
    "  \"vacuum\": {\"build\": 0.125, \"vent\": 0.0625, \"idle\": 0.10000000000000001, \"sensor_on\": "
    "0.69999999999999996, \"sensor_off\": 0.59999999999999998, \"release\": 0.29999999999999999},\n"
    "  \"pads\": {\"friction\": 0.5, \"force\": 5.0, \"mass\": 0.125, \"gravity\": 9.8100000000000005},\n"
    "  \"faults\": [\n"
    "    {\"kind\": \"leak\", \"gripper\": \"EE\", \"wafer\": null, \"from_s\": 1.0, \"until_s\": null, "
    "\"value\": 0.25},\n"
    "    {\"kind\": \"slow_vacuum\", \"gripper\": \"PA\", \"wafer\": null, \"from_s\": 0.5, \"until_s\": "
    "2.5, \"value\": 0.5},\n"
    "    {\"kind\": \"wafer_shifted\", \"gripper\": null, \"wafer\": \"W1\", \"from_s\": 0.25, \"until_s\": "
    "null, \"value\": 0.0},\n"
    "    {\"kind\": \"command_lost\", \"gripper\": null, \"wafer\": null, \"from_s\": 3.0, \"until_s\": "
    "3.25, \"value\": 0.0}\n"
    "  ],\n"
    "  \"corrections\": {\"x\": 5.0, \"y\": 5.0, \"z\": 2.5, \"turn_deg\": 5.0},\n"
    "  \"shapes\": {\"blade\": {\"thickness\": 3.0, \"half_width\": 75.0, \"finger\": 25.0, \"length\": "
    "100.0, \"palm\": 80.0}, \"ledge\": {\"inner\": 140.0, \"outer\": 152.0, \"thickness\": 0.5, \"length\": "
    "150.0}, \"arm\": {\"reach\": 250.0, \"link\": 344.5, \"right_handed\": false}, \"foup\": {\"room\": "
    "8.0, \"wall\": 5.0, \"floor\": 25.0, \"roof\": 20.0}, \"chuck\": {\"radius\": 40.0, \"height\": 20.0, "
    "\"body\": 60.0}},\n";

static const char *const parts[] = {
    "{\"name\": \"F load port\", \"kind\": \"wall\", \"shape\": \"box\", \"half\": [185.5, 173.0, 435.0], "
    "\"at\": [0.0, 927.5, 435.0], \"rotation\": [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]}",
    "{\"name\": \"P body\", \"kind\": \"wall\", \"shape\": \"cylinder\", \"half\": [60.0, 0.0, 99.5], "
    "\"at\": [-600.0, 0.0, 829.5], \"rotation\": [[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]]}",
    "{\"name\": \"lift\", \"kind\": \"arm\", \"shape\": \"cylinder\", \"half\": [90.0, 0.0, 212.5], \"at\": "
    "[0.0, 0.0, 522.5], \"rotation\": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]}",
    "{\"name\": \"forearm\", \"kind\": \"arm\", \"shape\": \"box\", \"half\": [207.25, 35.0, 22.5], \"at\": "
    "[37.5, 171.79584540960238, 812.5], \"rotation\": [[0.072568940493468792, 0.99736339860436796, 0.0], "
    "[-0.99736339860436796, 0.072568940493468792, 0.0], [0.0, 0.0, 1.0]]}",
    "{\"name\": \"UP finger left\", \"kind\": \"blade\", \"shape\": \"box\", \"half\": [77.5, 12.5, 1.5], "
    "\"at\": [322.5, 62.5, 938.5], \"rotation\": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]}",
    "{\"name\": \"UP post\", \"kind\": \"blade\", \"shape\": \"cylinder\", \"half\": [40.0, 0.0, 20.0], "
    "\"at\": [50.0, 0.0, 917.0], \"rotation\": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]}",
    "{\"name\": \"PA chuck\", \"kind\": \"chuck\", \"shape\": \"cylinder\", \"half\": [40.0, 0.0, 10.0], "
    "\"at\": [-600.0, 0.0, 940.0], \"rotation\": [[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]]}",
    "{\"name\": \"pin\", \"kind\": \"blade\", \"shape\": \"cylinder\", \"half\": [2.0, 0.0, 5.0], \"at\": "
    "[200.0, 0.0, 905.0], \"rotation\": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]}",
    "{\"name\": \"cap\", \"kind\": \"arm\", \"shape\": \"capsule\", \"half\": [3.0, 0.0, 5.0], \"at\": [1.0, "
    "2.0, 903.0], \"rotation\": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]}"};

static const char end[] =
    "  ],\n"
    "  \"clearance\": {\"blade_wafer_above\": 5.0, \"blade_wafer_below\": 0.0, \"blade_other\": 0.0, "
    "\"wafer_wafer\": 0.0, \"wafer_ledge\": 0.0, \"wafer_other\": 0.0, \"arm_other\": 0.0, \"arm_itself\": "
    "0.0},\n"
    "  \"findings\": [\n"
    "    {\"kind\": \"entry\", \"text\": \"A: entering 3 mm below a slot, pin on EE touches the wafer in it; "
    "pitch 12 mm\", \"station\": \"A\", \"slot\": null},\n"
    "    {\"kind\": \"entry\", \"text\": \"F: entering 3 mm below a slot, pin on EE touches the wafer in it; "
    "pitch 10 mm\", \"station\": \"F\", \"slot\": null},\n"
    "    {\"kind\": \"retract\", \"text\": \"F: `retract` of 290 mm is too little: in front of the station a "
    "wafer on the blade overlaps its wafers\", \"station\": \"F\", \"slot\": null},\n"
    "    {\"kind\": \"entry\", \"text\": \"P: entering 3 mm below a slot, pin on EE touches the wafer in it; "
    "pitch 10 mm\", \"station\": \"P\", \"slot\": null}\n"
    "  ],\n"
    "  \"warnings\": [\n"
    "    {\"kind\": \"retract\", \"text\": \"F: `retract` of 290 mm leaves a wafer on the blade 18 mm deep "
    "in the FOUP, whose walls it may hit as the arm turns\", \"station\": \"F\", \"slot\": null},\n"
    "    {\"kind\": \"retract\", \"text\": \"P: `retract` of 300 mm (default) leaves 0 mm between a wafer on "
    "the blade and the station's wafers\", \"station\": \"P\", \"slot\": null},\n"
    "    {\"kind\": \"sight\", \"text\": \"A: beams[2] is stuck (`stuck = \\\"dark\\\"`) and tells of no "
    "wafer\", \"station\": \"A\", \"slot\": null},\n"
    "    {\"kind\": \"sight\", \"text\": \"P: `sensor.samples` of 900 are 1.047 mm apart on a wafer's rim: "
    "ALIGN is sure of a notch with 0.31 mm or less, 3041 samples, and without one of the centre alone\", "
    "\"station\": \"P\", \"slot\": null}\n"
    "  ]\n"
    "}\n";

static void the_whole_json_but_most_parts(void **state) {
    (void)state;
    look_at_cell(0, 0, 0);
    print_json();
    assert_int_equal(strncmp(text, begin, strlen(begin)), 0);
    assert_int_equal(strncmp(text + strlen(begin), middle, strlen(middle)), 0);
    assert_string_equal(text + strlen(text) - strlen(end), end);
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; ++i) {
        assert_says(parts[i]);
    }
}

static void what_is_said_of_other_cells(void **state) {
    (void)state;
    look_at("grippers = { { name = 'EE' } }, stations = { A = { at = { 700, 0, 900 }, slots = 1 } }, check = "
            "'swept', seat = true, "
            "settle = true, collision = true, tolerance = { projz = 0.25 }, wafer = { diameter = 200, notch "
            "= { depth = 0 } }, "
            "wafers = { { station = 'A', slot = 1 } }, shapes = { arm = { right_handed = true } }, slice = "
            "0.0005");
    print_table(true);
    assert_says("\n1 wafer of 200 mm, 0.725 mm thick, without a notch\n");
    assert_says("tolerance own: 0.25 mm, 50 mm (default), 0.99 (default); checked along the whole of each "
                "slice of 0.5 ms\n");
    assert_says(
        "wafers are drawn onto the pads, and settle on what they are put down on; collisions are checked, ");
    assert_says("ideal: an open valve holds at once");
    assert_says("elbow right");
    assert_says("\n\033[32m✓\033[0m nothing is wrong with it\n");
    print_json();
    assert_says("\"notch_deg\": null,\n  \"notch_depth\": 0.0,");
    assert_says("\"projz\": 0.25, \"projxy\": 50.0, \"planar\": 0.98999999999999999, \"defaults\": "
                "[\"projxy\", \"planar\"]}");
    assert_says("\"check\": \"swept\",\n  \"slice_s\": 0.00050000000000000001,\n  \"seat\": true,\n  "
                "\"settle\": true,\n  \"collision\": true,");
    assert_says("\"pads\": null,");
    look_at("grippers = { { name = 'EE' } }, stations = { A = { at = { 700, 0, 900 }, slots = 2 }, B = { at "
            "= { 0, 700, 900 }, rpy = { 0, 0, 90 }, slots = 1 } }");
    print_table(true);
    assert_says("\n\033[33m!\033[0m A: `retract` of 300 mm (default) leaves 0 mm");
    assert_says(" nothing else is wrong with it; ways between stations are not judged\n");
    look_at("grippers = { { name = 'EE' } }, stations = { A = { at = { 700, 0, 900 }, rpy = { 9, 0, 0 }, "
            "slots = 1 } }");
    print_table(true);
    assert_says("\n\033[31m✗\033[0m A is tilted by 9 deg");
}

static void several_robots_and_who_serves_what(void **state) {
    (void)state;
    look_at("robots = { ATM = { kind = 'TRZY' }, VAC = { kind = 'SCARA', at = { 1400, 0, 0 }, heading = 180, "
            "links = { 300, 250 } } }, "
            "grippers = { { name = 'EE', on = 'ATM' }, { name = 'VE', on = 'VAC' } }, "
            "stations = { LL = { at = { 700, 0, 900 }, slots = 1, by = { ATM = {}, VAC = { rpy = { 0, 0, 180 "
            "} } } } }");
    print_table(false);
    assert_says("\nServed by\nstation  robot  heading deg  unless told\n");
    assert_says("LL       ATM");
    assert_says("VAC arm  links of 300 and 250, the wrist at the end-effector's origin");
    print_json();
    assert_says("\"by\": [{\"robot\": \"ATM\", \"unless_told\": ");
    assert_says("{\"robot\": \"VAC\", \"name\": \"");
    assert_says("{\"name\": \"VE\", \"on\": \"VAC\", \"valve\": \"VE.valve\"");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(the_whole_table, tear_down),
        cmocka_unit_test_teardown(the_whole_json_but_most_parts, tear_down),
        cmocka_unit_test_teardown(what_is_said_of_other_cells, tear_down),
        cmocka_unit_test_teardown(several_robots_and_who_serves_what, tear_down),
    };
    if (!setlocale(LC_CTYPE, "C.UTF-8") && !setlocale(LC_CTYPE, "C.utf8")) {
        print_error("no UTF-8 locale\n");
        return 1;
    }
    return cmocka_run_group_tests(tests, open_sandbox, close_sandbox);
}
