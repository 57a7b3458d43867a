-- The words of scripts: what each takes and gives, and what it does. lua/mcs/init.lua makes words of these
-- alone, and refuses what one has no parameter for; lua/mcs/definitions.lua writes them for editors.
--
-- takes    { name, type, what it is } of each parameter in order; a type ends in ? if it may be left out
-- gives    { type, name } of each result in order
-- does     in words
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
  continue = { takes = {}, does = "Goes on with a GET, PUT or SWAP that is held in a phase." },
  stop = { takes = {}, does = "Gives up what is held in a phase." },
  home = { takes = {}, does = "Out of the station if the arm stands in one, then home." },
  recover = { takes = {}, does = "Straight out of the station that the arm stands in." },
  stop_in = { takes = { { "seconds", "number", "s" } },
              does = "A STOP comes after so much simulated time." },
  rotate = { takes = { STATION, { "degrees", "number", "degrees" } },
             does = "Turns a prealigner's chuck by so much." },
  centring = { takes = {}, gives = { { "waferhand.centring?", "centring" } },
               does = "What the beams of the last PUT that centred said of its wafer; nil before one." },
  teach = { takes = { STATION, { "options", "waferhand.teach_options?", "how" } },
            gives = { { "waferhand.taught", "taught" } },
            does = "Finds out where a station truly is, by the beam at its door and the wafer in its slot 1." },
  edge_scan = { takes = { STATION }, gives = { { "waferhand.edge_scan", "scan" } },
                does = "Turns a prealigner's chuck once round while its edge sensor looks at the wafer." },
  align = { takes = { STATION, options("align_options") }, gives = { { "waferhand.alignment", "found" } },
            does = "Turns a prealigner's wafer until its notch points there; the next GET makes good how it lies." },
  valve = { takes = { GRIPPER, { "level", "0|1", "0 opens it (vacuum on), 1 closes it" } },
            does = "Switches a gripper's valve." },
  move = { takes = { { "positions", "waferhand.positions", "of the axes that move" } },
           does = "Moves the named axes to these positions." },
  line = { takes = { { "by", "waferhand.way", "how far, and how fast" } },
           does = "Moves the end-effector straight by so much in base, its heading kept." },
  wait = { takes = { { "seconds", "number", "s" } }, does = "Stands still." },
  fault = { takes = { { "description", "waferhand.fault", "what happens" } },
            gives = { { "integer", "number" } }, does = "Lets a fault begin with the next slice." },
  clear_fault = { takes = { { "number", "integer", "a fault's number" } },
                  does = "Ends a fault with the next slice." },
  offset = { takes = { WAFER, STATION, SLOT },
             gives = { { "number", "dx" }, { "number", "dy" }, { "number", "dz" }, { "number", "tilt" } },
             does = "Where the wafer is in that slot's frame: mm, and the tilt in degrees." },
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

-- What words take and give, but for what a layout's reader knows.
words.classes = {
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
    { "dy", "number", "" }, { "notch", "number?", "where its notch, or its primary flat, pointed" },
    { "turn", "number", "how far it was turned" },
    { "correction", "number", "how far beside the taught place the wafer now lies" },
    { "correction_angle", "number", "in which direction" }, { "after_dx", "number", "the same by the axes" },
    { "after_dy", "number", "" }, { "after_notch", "number?", "where the notch points now" },
    { "sd_centre", "number", "standard deviation" }, { "sd_notch", "number?", "standard deviation" },
    { "mark", "\"notch\"|\"primary flat\"|\"secondary flat\"|\"none\"", "by what the turn was told" },
    { "radius", "number", "the wafer's own" }, { "seconds", "number", "how long it took" } },
  { "centring", "What beams at a station's door said of a wafer on its blade: mm and degrees.",
    { "station", "string", "whose beams" }, { "gripper", "string", "the blade" },
    { "sure", "boolean", "if the PUT went by it" }, { "error", "integer", "0, or why it did not" },
    { "dx", "number?", "how far the centre was off, in the slot's frame" }, { "dy", "number?", "" },
    { "sd_dx", "number?", "its standard deviation" }, { "sd_dy", "number?", "" },
    { "sd", "number?", "in the worst direction" }, { "radius", "number?", "of the wafer" },
    { "used", "integer", "how many crossings it rests on" },
    { "missed", "integer", "latches that never came" },
    { "crossings", "waferhand.crossing[]", "what crossed the beams" },
    { "candidates", "waferhand.candidate[]", "the likelier first" } },
  { "crossing", "A beam that was broken or got free.",
    { "beam", "integer", "which of the station's, from 1" }, { "edge", "\"in\"|\"out\"", "broken, or free" },
    { "use", "\"rim\"|\"notch\"|\"other\"|\"none\"", "what it was taken for" },
    { "x", "number", "on the blade" }, { "y", "number", "" }, { "time", "number", "s" } },
  { "candidate", "Where a wafer's centre may be on its blade.",
    { "dx", "number", "in the slot's frame" }, { "dy", "number", "" }, { "radius", "number", "" },
    { "sd", "number", "in the worst direction" }, { "used", "integer", "crossings that it rests on" } },
  { "teach_options", "How a station is taught.", { "by", "\"beam\"?", "what tells it" } },
  { "taught", "Where a station was found: mm and degrees.",
    { "at", "number[]", "as a layout has it" }, { "rpy", "number[]", "likewise" },
    { "sd", "number[]", "standard deviations of x, y and z" },
    { "beam", "number[]", "by how much the beam is elsewhere, in base" },
    { "text", "string", "of a layout" } },
  { "relation", "How a frame lies as seen from another: mm and degrees.",
    { "distance", "number", "of the origins" }, { "dx", "number", "" }, { "dy", "number", "" },
    { "dz", "number", "" }, { "angle", "number", "between the z axes" },
    { "turn", "number", "the whole turn, 0 to 180" },
    { "heading", "number", "of the second's x about the first's z, -180 to 180" } },
  { "hit", "Two parts that met.",
    { "kind", "\"hit\"|\"undecided\"", "" }, { "parts", "string[]", "both names" },
    { "at", "number[]", "mm, in base" }, { "time", "number", "s" } },
  { "pose", "A body in base.",
    { "r", "number[]", "mm: its origin" }, { "R", "number[][]?", "row by row; its columns are the body's axes" } },
  { "error", "What a command that fails throws; pcall catches it.",
    { "number", "integer", "its number" }, { "name", "string", "its name, as in wh.errors" },
    { "line", "integer", "of the script" }, { "text", "string", "what happened" },
    { "message", "string", "all of it, with its place" } },
}

return words
