-- Errors on purpose: how each one is raised, and by which commands it can be answered. lua/mcs/alarms.lua raises them;
-- the table of lua/manual/errors.md is made of this file.
--
--   cause   something breaks, so that the command meets the real effect in the cell; what breaks
--   check   the command is refused before anything moves, though nothing is wrong
--   line    likewise, for an error that motion control and the cell never cause, or that comes before a command is
--           read: a host gets it all the same

local AT_SLOT, STATION = "GET PUT SWAP READY", "GET PUT SWAP READY MAP TEACH"
local PLANNED = STATION .. " LINE"
local MOVING = STATION .. " CONTINUE HOME RECOVER ROTATE EDGE_SCAN ALIGN CALIBRATE LIFT VALVE MOVE FLIP LINE OPEN CLOSE"
local SETTING = " SET_STATION STATION"
local QUERIES = "OFFSET HOLDER PROXIMITY MEASURE DISTANCE ANGLE WHERE"

-- By the error's name: how it is raised, and the commands that can give it.
local how = {
  BAD_VALVE = { "check", "VALVE" },
  BAD_LIMITS = { "line", MOVING },
  OUT_OF_REACH = { "check", PLANNED .. " SET_STATION" },
  LIMIT_EXCEEDED = { "check", PLANNED .. " MOVE ROTATE SET_STATION" },
  NOT_LEVEL = { "check", STATION },
  NOT_ALONG_ARM = { "check", STATION .. SETTING },
  NO_SUCH_STATION = { "check", STATION .. " ROTATE EDGE_SCAN ALIGN CALIBRATE LIFT OFFSET" .. SETTING },
  NO_SUCH_SLOT = { "check", AT_SLOT .. " OFFSET" },
  WAFER_MISSING = { "cause", "GET SWAP", "with vacuum: the valve of the gripper is stuck" },
  NO_WAFER_ON_GRIPPER = { "cause", "PUT", "the gripper's sensor stays off" },
  WAFER_ON_GRIPPER = { "cause", "GET SWAP", "the gripper's valve is open and its sensor stays on" },
  NO_SUCH_GRIPPER = { "check", STATION .. " VALVE FLIP PROXIMITY" .. SETTING },
  AMBIGUOUS_ROBOT = { "check", STATION .. " CONTINUE HOME RECOVER MOVE FLIP LINE" .. SETTING },
  NO_SUCH_ROBOT = { "check", STATION .. " CONTINUE HOME RECOVER MOVE FLIP LINE" .. SETTING },
  NO_SUCH_WAFER = { "check", "OFFSET HOLDER PROXIMITY WHERE" },
  NO_SUCH_COMMAND = { "line", MOVING .. " " .. QUERIES },
  BAD_ARGUMENT = { "check", MOVING .. " " .. QUERIES .. SETTING },
  NOT_A_PREALIGNER = { "check", "ROTATE EDGE_SCAN ALIGN CALIBRATE LIFT" },
  WAFER_LOST = { "cause", "PUT", "the gripper's sensor stays on; onto a chuck, the chuck's valve is stuck" },
  DEADLOCK = { "check", STATION },
  FLIP_TIMEOUT = { "cause", "FLIP", "what carries the gripper or the clamp stands still" },
  FLIP_NOT_CLAMPED = { "check", "FLIP" },
  WRONG_FACE = { "check", "PUT SWAP" },
  WRONG_SLOT = { "check", "GET SWAP" },
  STOPPED = { "cause", STATION .. " HOME ROTATE EDGE_SCAN ALIGN MOVE FLIP LINE",
              "a STOP comes 0.1 s after it has begun to move; it waits for another one if that has ended by then" },
  OUT_OF_BUDGET = { "check", MOVING },
  BUSY = { "line", MOVING },
  NOT_TAUGHT = { "check", STATION .. " STATION" },
  WAFER_ALREADY_THERE = { "check", "PUT" },
  VACUUM_TIMEOUT = { "cause", "GET PUT SWAP", "the gripper's sensor stays off; of a PUT onto a chuck, the chuck's" },
  VACUUM_BEFORE_PICK = { "cause", "GET SWAP", "the gripper's sensor stays on" },
  NOT_HOMED = { "cause", STATION .. " MOVE FLIP LINE", "the robot no longer knows where it is, until HOME" },
  WAFER_LOST_ON_WAY = { "cause", "PUT", "the gripper's pump dies as the arm sets out" },
  WAFER_JAMMED = { "check", "GET SWAP" },
  PLUNGER_STUCK = { "cause", "GET PUT SWAP", "with an edge grip: its plunger is stuck" },
  GRIP_TIMEOUT = { "cause", "GET SWAP", "with an edge grip that is open: its plunger creeps" },
  UNGRIP_TIMEOUT = { "cause", "PUT", "with an edge grip: its plunger creeps" },
  SENSORS_DISAGREE = { "cause", "GET SWAP", "with an edge grip: its sensor stays off" },
  COLLISION_AHEAD = { "check", PLANNED .. " MOVE FLIP" },
  SLIP_AHEAD = { "check", PLANNED .. " MOVE FLIP HOME" },
  BAD_SLOT = { "check", "GET PUT SWAP" },
  NOT_MAPPED = { "check", "GET SWAP" },
  CORRECTION_TOO_LARGE = { "check", "GET PUT SWAP ALIGN" },
  IN_PHASE = { "check", STATION .. " HOME RECOVER ROTATE EDGE_SCAN ALIGN CALIBRATE LIFT VALVE MOVE FLIP LINE" },
  PINS_UP = { "check", "GET PUT SWAP READY ROTATE EDGE_SCAN ALIGN TEACH" },
  DOOR_SHUT = { "check", "GET PUT SWAP MAP TEACH" },
  DOOR_BLOCKED = { "check", "CLOSE" },
  DOOR_TIMEOUT = { "cause", "OPEN CLOSE", "the door is stuck" },
  NOT_IN_PHASE = { "check", "CONTINUE" },
  NO_SUCH_SAVE = { "check", "RESTORE" },
  NOTHING_TO_UNDO = { "check", "UNDO" },
  NOT_RESTORED = { "line", "RESTORE UNDO" },
  TOO_FEW_SAMPLES = { "check", "ALIGN TEACH", "of a PUT with `centre`, too" },
  NO_NOTCH = { "check", "ALIGN TEACH" },
  NOT_TOUCHED = { "check", "TEACH" },
  TWO_NOTCHES = { "check", "ALIGN" },
  OFF_SENSOR = { "check", "ALIGN" },
  TOO_ECCENTRIC = { "check", "ALIGN" },
  CENTRE_NOT_SURE = { "check", "ALIGN CALIBRATE TEACH", "of a PUT with `centre`, too" },
  NOTCH_NOT_SURE = { "check", "ALIGN" },
  BAD_SCAN = { "line", "ALIGN" },
  RUN_OVER = { "line", MOVING },
  NO_ANSWER = { "line", MOVING },
}

-- The words that people use for many commands at once.
local groups = { { "all that moves", MOVING }, { "all at stations", STATION }, { "questions", QUERIES } }

return { how = how, groups = groups }
