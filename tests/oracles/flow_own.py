"""Rules of one's own in `waferhand run`, over random tools: the shipped first_come and longest_wait written in Lua give the same visits,
and answers at random lose no wafer, leave no two in one place, and break no interlock.

    flow_own.py PROGRAM FOLDER LEVEL FIRST COUNT     prints the seeds that differ or break something; exit 1 if there are any"""
import json
import pathlib
import subprocess
import sys

import flow_check
import flow_compare
import flow_tools

SHIPPED = """
local function first(tool)
  local best
  local function before(a, b)
    if not b or a.ready ~= b.ready then return not b or a.ready end
    if not a.ready then
      if a.begins ~= b.begins then return a.begins < b.begins end
    elseif RULE == "first_come" then
      return a.order < b.order
    elseif a.done ~= b.done then
      return a.done < b.done
    end
    if a.priority ~= b.priority then return a.priority > b.priority end
    if a.step ~= b.step then return a.step > b.step end
    if a.entered ~= b.entered then return a.entered < b.entered end
    return a.order < b.order
  end
  for _, choice in ipairs(tool.choices) do
    if choice.begins and before(choice, best) then best = choice end
  end
  return best and { best }
end
"""

# Shuffles what could be done; keeps wafers on arms; with garbage it asks for what can never be.
AT_RANDOM = """
local state = SEED
local function draw(count)
  state = (state * 1103515245 + 12345) % 2147483648
  return state // 65536 % count + 1
end
local names = { NAMES }
local function at_random(tool)
  local answers = {}
  local me = tool.robots[tool.robot]
  for _, name in ipairs(me.holds) do
    local next = tool.wafers[name].next
    answers[#answers + 1] = { "keep", next[draw(#next)], name }
  end
  if #me.holds < me.arms then
    local choices = tool.choices
    for index, choice in ipairs(choices) do
      if draw(4) > 1 or (#answers == 0 and index == #choices) then
        local kept = me.arms == 2 and draw(5) == 1
        table.insert(answers, draw(#answers + 1), kept and { choice.from, "keep", choice.wafer } or choice)
      end
    end
  end
  if GARBAGE and draw(40) == 1 then
    local bad = { { names[draw(#names)], names[draw(#names)] }, { "keep", names[draw(#names)] }, { names[draw(#names)], "keep", "L0.1" },
                  { "nowhere", "keep" }, 7, { names[1] }, { names[1], names[1], "W" } }
    answers[#answers + 1] = bad[draw(#bad)]
  end
  return answers
end
"""


def play(program, folder, tool, flow, rule=None, before=""):
    """The flow of the program's JSON, with a function in place of its rule."""
    names = {}
    text = flow_compare.script_text(flow, names)
    if rule:
        text = text.replace(f"rule = {flow_tools.lua(flow['rule'])},", f"rule = {rule},")
        assert f"rule = {rule}," in text
    (folder / "flow.lua").write_text(before + text, encoding="utf-8")
    (folder / "tool.lua").write_text(flow_compare.layout_text(tool), encoding="utf-8")
    ran = subprocess.run([program, "run", folder / "flow.lua", "--json"], capture_output=True, text=True, timeout=60, check=False)
    if not ran.stdout.startswith("{"):
        raise AssertionError(ran.stdout + ran.stderr)
    return json.loads(ran.stdout)["flow"], names


def look_at_shipped(program, folder, tool, flow):
    flow = {**flow, "safe": False}
    ours, _ = play(program, folder, tool, flow)
    own, _ = play(program, folder, tool, flow, "first", f'local RULE = "{flow["rule"]}"' + SHIPPED)
    if (ours["end"], ours["visits"], ours["doings"]) == (own["end"], own["visits"], own["doings"]):
        return None
    pairs = zip(ours["visits"] + [None], own["visits"] + [None])
    return ours["end"], own["end"], own["why"], next((pair for pair in pairs if pair[0] != pair[1]), None)


def as_result(told, names):
    """As flow_check takes it."""
    back, rows = {ours: name for name, ours in names.items()}, {name: [] for name in names}
    begun = (visit for visit in told["visits"] if visit["picked_s"] is not None)
    for visit in sorted(begun, key=lambda visit: visit["pick_s"]):
        times = [flow_compare.whole(visit[key]) for key in ("pick_s", "picked_s", "place_s", "placed_s", "process_s", "done_s")]
        rows[back[visit["wafer"]]].append((visit["robot"], visit["arm"], visit["from"], visit["from_slot"], *times[:2], visit["to"], visit["to_slot"],
                                           *times[2:5], times[3] if times[5] is None else times[5]))
    doings = [(each["station"], each["slot"], each["what"], flow_compare.whole(each["begin_s"]), flow_compare.whole(each["end_s"]))
              for each in told["doings"]]
    return {"state": told["end"], "wafers": rows, "stays": [], "robots": {}, "makespan": flow_compare.whole(told["makespan_s"]),
            "cleans": [(station, slot, begin, end) for station, slot, what, begin, end in doings if what == "clean"],
            "pumps": [(station, "vacuum" if what == "pump" else "atmosphere", begin, end) for station, _, what, begin, end in doings
                      if what in ("pump", "vent")]}


def look_at_random(program, folder, tool, flow, seed):
    names = ", ".join(f'"{station["name"]}"' for station in tool["stations"])
    before = AT_RANDOM.replace("SEED", str(seed)).replace("NAMES", names).replace("GARBAGE", "true" if seed % 3 == 0 else "false")
    flow = {**flow, "rule": "backward", "until": None}
    told, names = play(program, folder, tool, flow, "at_random", before)
    found = list(flow_check.look(tool, flow, as_result(told, names)))
    if told["end"] not in ("done", "stuck", "broken") or (told["end"] == "broken" and seed % 3):
        found.append(f"it ends {told['end']}: {told['why']}")
    if told["end"] != "done" and not told["why"]:
        found.append(f"it ends {told['end']}, and nobody knows why")
    return found and found[0]


def look(program, folder, level, seed):
    tool, flow = flow_tools.make(seed, level)
    if any(down["seconds"] is None for down in flow.get("down") or []):
        return None
    found = look_at_random(program, folder, tool, flow, seed)
    if not found and flow["rule"] in ("first_come", "longest_wait"):
        found = look_at_shipped(program, folder, tool, flow)
    return found


def main(arguments):
    program, folder = arguments[0], pathlib.Path(arguments[1])
    level, first, count = map(int, arguments[2:])
    folder.mkdir(parents=True, exist_ok=True)
    found = [(seed, look(program, folder, level, seed)) for seed in range(first, first + count)]
    for seed, difference in found:
        if difference:
            print(f"level {level}, seed {seed}: {difference}")
    return 1 if any(difference for _, difference in found) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
