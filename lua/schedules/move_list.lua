-- A list of moves as tools' software writes them: the station as ModuleName, times in milliseconds. The list
-- does not tell the robot: this tool has one.
local by_robot = { PickMove = true, PlaceMove = true, SwapMove = true }

return {
  columns = {
    robot = function(row)
      return by_robot[row.MoveType] and "R" or nil
    end,
    action = "MoveType",
    wafer = "MatID",
    station = "ModuleName",
    slot = "SlotID",
    begin_s = { "StartTime", scale = 1e-3 },
    end_s = { "EndTime", scale = 1e-3 },
  },
  actions = { PickMove = "pick", PlaceMove = "place", ProcessMove = "process" },
  skip = function(row)
    return row.State == "Cancelled"
  end,
}
