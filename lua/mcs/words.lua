-- The words of scripts: what each takes and gives, and what it does. lua/mcs/init.lua makes words of these
-- alone, and refuses what one has no parameter for; lua/mcs/definitions.lua writes them for editors.
--
-- takes    { name, type, what it is } of each parameter in order; a type ends in ? if it may be left out
-- gives    { type, name } of each result in order
-- does     in words
-- any      true: takes any number of the last
--
-- Types are as the Lua language server writes them.

local STATION = { "station", "string", "a station's name" }
local SLOT = { "slot", "integer", "from 1, at the bottom" }
local WAFER = { "wafer", "string", "a wafer's name" }
local GRIPPER = { "gripper", "string", "a gripper's name" }

local function frame(name)
  return { name, "string", "a wafer, a gripper, a station, a slot such as \"B/10\", or \"base\"" }
end

local function options(class)
  return { "options", "waferhand." .. class .. "?", "for this one command" }
end

local function at_slot(class, does, ...)
  return { takes = { STATION, SLOT, options(class) }, gives = { ... }, does = does }
end

local words = {}

words.scripts = {
  cell = { takes = { { "path", "string", "a layout's file, relative to the script's folder" } },
           does = "Sets up the cell: comes before all else." },
  study = { takes = { { "errors", "waferhand.study", "what is drawn" } },
            does = "Before cell: what a study draws, in place of the layout's." },
  get = at_slot("get_options", "Takes the wafer there, or fails with WAFER_MISSING and the reason."),
  put = at_slot("put_options", "Sets the wafer down there.", { "waferhand.centring?", "centring" }),
  swap = at_slot("swap_options",
    "Takes the wafer there with the empty gripper, then puts down what the other one holds."),
  ready = at_slot("command_options", "Goes in front of the slot, to where GET or PUT enters."),
  map = { takes = { STATION, options("command_options") },
          gives = { { "integer[]", "codes" } },
          does = "Sweeps over the slots: 0 empty, 1 single, 2 double, 4 crossed, slot 1 first." },
  continue = { takes = {}, gives = { { "waferhand.centring?", "centring" } },
               does = "Goes on with a GET, PUT or SWAP that is held in a phase." },
  stop = { takes = {}, does = "Gives up what is held in a phase." },
  home = { takes = {}, does = "Out of the station if the arm stands in one, then home." },
  recover = { takes = {}, does = "Straight out of the station that the arm stands in." },
  stop_in = { takes = { { "seconds", "number", "s" }, { "mechanism", "string?", "whose command ends; none: all" } },
              does = "A STOP comes after so much simulated time." },
  rotate = { takes = { STATION, { "degrees", "number", "degrees" } },
             does = "Turns a prealigner's chuck by so much." },
  centring = { takes = {}, gives = { { "waferhand.centring?", "centring" } },
               does = "What the beams of the last PUT that centred said of its wafer; nil before one." },
  teach = { takes = { STATION, { "options", "waferhand.teach_options?", "how" } },
            gives = { { "waferhand.taught", "taught" } },
            does = "Finds out where a station truly is, by the beam at its door and the wafer in its slot 1, or by its block." },
  edge_scan = { takes = { STATION }, gives = { { "waferhand.edge_scan", "scan" } },
                does = "Turns a prealigner's chuck once round while its edge sensor looks at the wafer." },
  align = { takes = { STATION, options("align_options") }, gives = { { "waferhand.alignment", "found" } },
            does = "Turns a prealigner's wafer until its notch points there; the next GET makes good how it lies." },
  calibrate = { takes = { STATION, options("calibrate_options") }, gives = { { "waferhand.calibration", "found" } },
                does = "Finds out what a prealigner's edge sensor is off by, and takes it off from then on." },
  open = { takes = { { "door", "string", "a door's name" } },
           does = "Opens a door, and waits until it is." },
  close = { takes = { { "door", "string", "a door's name" } },
            does = "Shuts a door, unless an arm stands in its station, and waits until it is shut." },
  lift = { takes = { STATION, { "where", "\"up\"|\"down\"", "where the pins go" } },
           does = "Pins lift what lies on a prealigner's chuck, or set it down there again." },
  valve = { takes = { GRIPPER, { "level", "0|1", "0 opens it (vacuum on), 1 closes it" } },
            does = "Switches a gripper's valve." },
  move = { takes = { { "positions", "waferhand.positions", "of the axes that move" } },
           does = "Moves the named axes to these positions." },
  line = { takes = { { "by", "waferhand.way", "how far, and how fast" } },
           does = "Moves the end-effector straight by so much in base, its heading kept." },
  flip = { takes = { { "what", "string", "a gripper's name, or a flipper's" } },
           does = "Turns the blade over about its x, by half a turn, or back; of a flipper the wafer in its clamp." },
  wait = { takes = { { "seconds", "number", "s" } }, does = "Stands still." },
  fault = { takes = { { "description", "waferhand.fault", "what happens" } },
            gives = { { "integer", "number" } },
            does = "Lets a fault begin with the next slice, or an error wait for a command." },
  clear_fault = { takes = { { "number", "integer", "a fault's number" } },
                  does = "Ends a fault with the next slice." },
  offset = { takes = { WAFER, STATION, SLOT },
             gives = { { "number", "dx" }, { "number", "dy" }, { "number", "dz" }, { "number", "tilt" } },
             does = "Where the wafer is in that slot's frame: mm, and the tilt in degrees." },
  face = { takes = { WAFER }, gives = { { "\"up\"|\"down\"", "face" } },
           does = "How the wafer lies, or is held." },
  holder = { takes = { WAFER }, gives = { { "string?", "gripper" } },
             does = "The gripper that holds the wafer, or nil." },
  proximity = { takes = { WAFER, GRIPPER }, gives = { { "waferhand.measurement", "measured" } },
                does = "The check of the wafer against the gripper as they stand now." },
  measure = { takes = { frame("first"), frame("second") }, gives = { { "waferhand.relation", "relation" } },
              does = "How the second frame lies as seen from the first." },
  distance = { takes = { frame("first"), frame("second") }, gives = { { "number", "distance" } },
               does = "The distance of two frames' origins, mm." },
  angle = { takes = { frame("first"), frame("second") }, gives = { { "number", "angle" } },
            does = "The angle between two frames' z axes, degrees." },
  hits = { takes = {}, gives = { { "waferhand.hit[]", "hits" } }, does = "What hit what so far." },
  clearance = { takes = { { "kind", "waferhand.clearance_kind", "which gap" } },
                gives = { { "number?", "gap" }, { "number?", "limit" }, { "number?", "time" },
                          { "string[]?", "parts" } },
                does = "The smallest gap of a kind so far and its limit (mm), when it was (s), and both parts." },
  robot = { takes = { { "name", "string", "a robot's name" } }, gives = { { "waferhand.bound_words", "words" } },
            does = "The words that move a robot, bound to this one of several: VAC:get(\"LL\", 1)." },
  task = { takes = { { "body", "function", "what it does" } }, gives = { { "waferhand.task", "task" } },
           does = "Begins what goes on beside the rest, in simulated time." },
  join = { takes = { { "first", "waferhand.task?", "a task" }, { "...", "waferhand.task", "more of them" } },
           gives = { { "any", "results" } }, any = true,
           does = "Waits until these are over; returns what they returned, or raises the first's error." },
  signal = { takes = { { "name", "string", "its name" }, { "n", "integer?", "how many; 1 without it" } },
             does = "Adds signals, for those who await them." },
  await = { takes = { { "name", "string", "its name" }, { "timeout", "number?", "s" } },
            gives = { { "boolean", "came" } }, does = "Takes a signal, and waits for it if there is none." },
  expect = { takes = { { "condition", "boolean?", "what should be true" },
                       { "text", "any?", "what is said of it" } },
             gives = { { "boolean?", "condition" } },
             does = "States what should be so: if it is not, the run goes on, but fails." },
  expect_offset = { takes = { WAFER, STATION, SLOT, { "dx", "number", "mm" }, { "dy", "number", "mm" },
                              { "tolerance", "number?", "mm; 1e-9 without it" } },
                    gives = { { "boolean", "met" } },
                    does = "Expects that the wafer lies there with this offset." },
  cycle = { takes = { { "name", "string?", "its name" } },
            does = "Marks where a cycle begins, for wafers per hour." },
}

-- The module wh, see lib/script/wh_module.h.
local POSE = { "waferhand.pose", "base_from_body" }
local TOLERANCE = { "tolerance", "\"paper\"|\"strict\"|waferhand.tolerance?", "\"paper\" without it" }

-- Besides `expect`, in files of checks alone.
words.checks = {
  events = { takes = { { "wanted", "waferhand.wanted_events?", "which; all of them without it" } },
             gives = { { "waferhand.recorded_event[]", "events" } },
             does = "In a file of checks: the recorded events that have all of these, in order." },
  at = { takes = { { "seconds", "number", "s, from the run's begin" } },
         gives = { { "table<string, number|string>", "slice" } },
         does = "In a file of checks: the last slice that has ended by then, by the names of csv's columns." },
}

words.module = {
  proximity = { takes = { { "wafer", POSE[1], POSE[2] }, { "gripper", POSE[1], POSE[2] }, TOLERANCE },
                gives = { { "waferhand.measurement", "measured" } },
                does = "The check of one pose against another." },
  rim_gap = { takes = { { "wafer", POSE[1], POSE[2] }, { "gripper", POSE[1], POSE[2] },
                        { "radius", "number", "mm" } },
              gives = { { "number", "gap" } },
              does = "How far the wafer's rim is at most from the contact plane, mm." },
  tolerance = { takes = { TOLERANCE }, gives = { { "waferhand.tolerance", "limits" } },
                does = "Its three limits." },
  cell = { takes = { { "description", "table", "grippers, wafers, tolerance, check, ..." } },
           gives = { { "table", "cell" } }, does = "A grasp table of its own." },
}

-- What commands may say for themselves; what is not here is told as the station's field of that name.
words.options = {
  angle = "where the notch shall point, in the station's frame",
  correct = "false: GET does not correct by what ALIGN found",
  dx = "off the taught place, along the slot's x",
  dy = "off the taught place, along the slot's y",
  dz = "above the taught place",
  force = "true: what is believed of blades and slots refuses nothing",
  glass = "how much light goes through the wafer; 0: none",
  gripper = "the blade that does it, in place of the station's effector",
  mark = "by what the turn is told; \"none\": the wafer is only centred",
  mode = "who corrects: the robot, with its next GET; the chuck's stage; or pins, for a second grip",
  robot = "which of several robots does it, by name",
  stop = "where the command halts until continue()",
  turn = "about the slot's z, seen from above",
  turns = "so many turns are taken for each of the two scans, together",
}

-- What words take and give, but for what a layout's reader knows.
words.classes = {
  { "wanted_events", "Which recorded events: times in seconds.",
    { "kind", "string?", "such as \"picked\"" }, { "wafer", "string?", "a wafer's name" },
    { "gripper", "string?", "a gripper's name" }, { "from", "number?", "not before" }, { "to", "number?", "not after" } },
  { "recorded_event", "As run --json has it in its list of events; other fields go by the kind.",
    { "utime", "integer", "us, from the run's begin" }, { "kind", "string", "such as \"picked\"" },
    { "wafer", "string?", "its name" }, { "gripper", "string?", "its name" } },
  { "measurement", "What the check found: lengths in mm.",
    { "dr", "number[]", "the paper's (1)" }, { "n1_proj_n2", "number", "the paper's (2)" },
    { "dr_proj_z", "number", "the paper's (3)" },
    { "dr_proj_xy", "number[]", "the paper's (4)" }, { "dr_proj_xy_norm", "number", "the paper's (5)" },
    { "ready", "boolean", "if all three conditions hold" },
    { "failed", "table<string, true>", "the conditions that do not" },
    { "margin", "table<string, number>", "how far inside each limit" } },
  { "edge_scan", "What an edge sensor saw.",
    { "samples", "integer[]", "dark pixels from the line's inner end, -1: missed" },
    { "first", "integer", "the number of the first sample" },
    { "count", "integer", "how many were asked for" }, { "missed", "integer", "how many never came" },
    { "is_armed", "boolean", "if more were to come when the turn ended" } },
  { "alignment", "What ALIGN found, seen from above in the station's frame: mm and degrees.",
    { "eccentricity", "number", "how far off the axis the wafer was" },
    { "direction", "number", "in which direction" }, { "dx", "number", "the same by the axes" },
    { "dy", "number", "likewise" }, { "notch", "number?", "where its notch, or its primary flat, pointed" },
    { "turn", "number", "how far it was turned" },
    { "correction", "number", "how far beside the taught place the wafer now lies" },
    { "correction_angle", "number", "in which direction" }, { "after_dx", "number", "the same by the axes" },
    { "after_dy", "number", "likewise" }, { "after_notch", "number?", "where the notch points now" },
    { "sd_centre", "number", "standard deviation" }, { "sd_notch", "number?", "standard deviation" },
    { "mark", "\"notch\"|\"primary flat\"|\"secondary flat\"|\"none\"", "by what the turn was told" },
    { "radius", "number", "the wafer's own" }, { "seconds", "number", "how long it took" } },
  { "centring", "What beams at a station's door said of a wafer on its blade: mm and degrees.",
    { "station", "string", "whose beams" }, { "gripper", "string", "the blade" },
    { "sure", "boolean", "if the PUT went by it" }, { "error", "integer", "0, or why it did not" },
    { "dx", "number?", "how far the centre was off, in the slot's frame" }, { "dy", "number?", "likewise" },
    { "sd_dx", "number?", "its standard deviation" }, { "sd_dy", "number?", "likewise" },
    { "sd", "number?", "in the worst direction" }, { "radius", "number?", "of the wafer" },
    { "used", "integer", "how many crossings it rests on" },
    { "missed", "integer", "latches that never came" },
    { "crossings", "waferhand.crossing[]", "what crossed the beams" },
    { "candidates", "waferhand.candidate[]", "the likelier first" } },
  { "crossing", "A beam that was broken or got free.",
    { "beam", "integer", "which of the station's, from 1" }, { "edge", "\"in\"|\"out\"", "broken, or free" },
    { "use", "\"rim\"|\"notch\"|\"other\"|\"none\"", "what it was taken for" },
    { "x", "number", "on the blade" }, { "y", "number", "likewise" }, { "time", "number", "s" } },
  { "candidate", "Where a wafer's centre may be on its blade.",
    { "dx", "number", "in the slot's frame" }, { "dy", "number", "likewise" },
    { "radius", "number", "of the wafer" },
    { "sd", "number", "in the worst direction" }, { "used", "integer", "crossings that it rests on" } },
  { "calibration", "What an edge sensor is off by, and the standard deviations.",
    { "offset", "number", "mm" }, { "zero", "number", "mm" }, { "gain", "number", "a part of the pixels' length" },
    { "latency", "number", "s" }, { "sd_offset", "number", "mm" }, { "sd_zero", "number", "mm" },
    { "sd_gain", "number", "a part of the length" }, { "sd_latency", "number", "s" },
    { "mismatch", "number", "sum of squares of what remains, in deviations: 6 on average" },
    { "text", "string", "of a layout" }, { "seconds", "number", "how long it took" } },
  { "teach_options", "How a station is taught.", { "by", "\"beam\"|\"touch\"|nil", "what tells it" } },
  { "taught", "Where a station was found: mm and degrees.",
    { "at", "number[]", "as a layout has it" }, { "rpy", "number[]", "likewise" },
    { "sd", "number[]", "standard deviations of x, y and z" },
    { "sd_yaw", "number?", "by touch: of the yaw" },
    { "beam", "number[]?", "by beam: by how much that is elsewhere, in base" },
    { "text", "string", "of a layout" } },
  { "task", "What goes on beside the rest; join() waits for it." },
  { "bound_words", "The words that move one of several robots: called with a colon.",
    { "get", "fun(self: table, station: string, slot: integer, options: waferhand.get_options?)", "as get" },
    { "put", "fun(self: table, station: string, slot: integer, options: waferhand.put_options?)", "as put" },
    { "swap", "fun(self: table, station: string, slot: integer, options: waferhand.swap_options?)", "as swap" },
    { "ready", "fun(self: table, station: string, slot: integer, options: waferhand.command_options?)", "as ready" },
    { "map", "fun(self: table, station: string, options: waferhand.command_options?): integer[]", "as map" },
    { "home", "fun(self: table)", "as home" }, { "recover", "fun(self: table)", "as recover" },
    { "move", "fun(self: table, positions: waferhand.positions)", "as move" },
    { "line", "fun(self: table, by: waferhand.way)", "as line" },
    { "continue", "fun(self: table): waferhand.centring?", "as continue" },
    { "stop", "fun(self: table)", "as stop" } },
  { "relation", "How a frame lies as seen from another: mm and degrees.",
    { "distance", "number", "of the origins" }, { "dx", "number", "by the first's axes" },
    { "dy", "number", "likewise" }, { "dz", "number", "likewise" }, { "angle", "number", "between the z axes" },
    { "turn", "number", "the whole turn, 0 to 180" },
    { "heading", "number", "of the second's x about the first's z, -180 to 180" } },
  { "hit", "Two parts that met.",
    { "kind", "\"hit\"|\"undecided\"", "what is known of it" }, { "parts", "string[]", "both names" },
    { "at", "number[]", "mm, in base" }, { "time", "number", "s" } },
  { "pose", "A body in base.",
    { "r", "number[]", "mm: its origin" }, { "R", "number[][]?", "row by row; its columns are the body's axes" } },
  { "error", "What a command that fails throws; pcall catches it.",
    { "number", "integer", "its number" }, { "name", "string", "its name, as in wh.errors" },
    { "line", "integer", "of the script" }, { "text", "string", "what happened" },
    { "message", "string", "all of it, with its place" } },
}

return words
