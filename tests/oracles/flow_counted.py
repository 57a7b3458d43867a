#!/usr/bin/env python3
"""Flows in random cells with axes, played whole and in counted time: all that --json tells is the same to the last bit (commands, events,
near misses, places, figures, hash), and so are the history, the schedule and the exit status. Tools have one robot or two, of which one may
be times alone, arms, locks, doors, cleans, windows, grips, faults, failures, carriers' lots that come late, rules, lists and functions.

    flow_counted.py PROGRAM FOLDER FIRST COUNT     prints the seeds that differ, and how much was left out; exit 1 if any do"""
import json
import math
import pathlib
import random
import subprocess
import sys

from flow_tools import lua

AIR = -1500   # x of the robot in air
DOOR = {"box": [10, 10, 10], "open": [0, 0, -20]}
RULES = ("backward", "swap", "first_come", "longest_wait")
# The first choice that is ready, by turns the oldest and the youngest.
OWN = """function(tool)
    local best
    for _, choice in ipairs(tool.choices) do
      if choice.safe and (not best or (choice.ready and not best.ready) or (choice.ready == best.ready and choice.order %s best.order)) then
        best = choice
      end
    end
    return { best }
  end"""


class Cell:
    """A layout, and a flow in it."""

    def __init__(self, seed):
        self.draw = random.Random(f"counted flow {seed}")
        self.wafers, self.doors, self.stations = self.draw.randint(1, 4), {}, {}
        self.has_locks, self.is_timed = self.some(0.6), self.some(0.25)
        self.arms = self.draw.choice((1, 2))
        self.inner = [f"PM{number}" for number in range(1, self.draw.randint(1, 4) + 1)]
        for number, name in enumerate(self.inner):
            self.stations[name] = self.module(name, (-75, -25, 25, 75)[number])
        if self.has_locks:
            self.locks = ["L", "M"][:self.draw.randint(1, 2)]
            for name, y in zip(self.locks, (-250, 250)):
                self.stations[name] = self.lock(name, y)
        self.stations["FROM"], self.stations["TO"] = self.stack(-1), self.stack(1)

    def some(self, share):
        return self.draw.random() < share

    def time(self, least, most):
        return self.draw.randint(10 * least, 10 * most) / 10 if self.some(0.7) else round(self.draw.uniform(least, most), 6)

    def door(self, name, share):
        if not self.some(share):
            return None
        self.doors[name] = {"at": [2000, 100 * len(self.doors), 0], **DOOR, "seconds": self.time(1, 2)}
        return name

    def served(self, robot):
        """With one robot there is nothing to say."""
        return {"by": {robot: {}}} if self.has_locks else {}

    def clean(self):
        if not self.some(0.4):
            return None
        clean = {"seconds": self.time(1, 20), **({"after": self.draw.randint(1, 3)} if self.some(0.7) else {"idle": self.time(5, 60)})}
        if "after" in clean and self.some(0.3):
            clean["empty"] = False
        return clean

    def module(self, name, degrees):
        turn = math.radians(degrees)
        return {"at": [740 * math.cos(turn), 740 * math.sin(turn), 900], "rpy": [0, 0, degrees], "retract": 340, "slots": self.draw.choice((1, 1, 1, 2)),
                "process": self.time(0, 40), "window": self.time(20, 60) if self.some(0.3) else None, "clean": self.clean(),
                "door": self.door(name + "_door", 0.4), **self.served("VAC")}

    def lock(self, name, y):
        aside = math.degrees(math.atan2(y, 730))
        air = {"side": "atmosphere", "door": self.door(name + "_air", 0.6)}
        air |= {} if self.is_timed else {"rpy": [0, 0, 0], "rail": y}
        pump = {"down": self.time(1, 12), "up": self.time(1, 12)}
        pump |= {"empty_down": self.time(1, 6)} if self.some(0.4) else {}
        return {"at": [-730, y, 900], "retract": 400, "slots": self.draw.choice((1, 1, 2)), "pump": pump,
                "state": self.draw.choice(("atmosphere", "vacuum")),
                "by": {"ATM": air, "VAC": {"rpy": [0, 0, 180 - aside], "side": "vacuum", "door": self.door(name + "_vacuum", 0.6)}}}

    def stack(self, side):
        if self.has_locks:
            by = {"ATM": {} if self.is_timed else {"rail": 250 * side}}
            return {"slots": 8, "at": [AIR - 700, 250 * side, 900], "rpy": [0, 0, 180], "retract": 340, "by": by}
        turn = math.radians(180 + 40 * side)
        return {"slots": 8, "at": [740 * math.cos(turn), 740 * math.sin(turn), 900], "rpy": [0, 0, 180 + 40 * side], "retract": 340}

    # ---------------------------------------------------------------------------------------------------------- layout
    def robots(self):
        robots = {"VAC": {"kind": "TRZ", "loaded": {"acceleration": 1900}, **({"arms": [{"heading": 0}, {"heading": 180, "height": 10}]} if self.arms == 2 else {})}}
        if not self.has_locks:
            return robots
        timed = {"kind": "timed", "pick": self.time(1, 5), "place": self.time(1, 5), "move": self.time(0, 3), "arms": self.draw.choice((1, 2)), "at": "FROM"}
        axes = {"kind": "TRZY", "at": [AIR, 0, 0], "heading": 90, "rail": {"min": -400, "max": 400}}
        return {"ATM": timed if self.is_timed else axes, **robots}

    def grippers(self):
        grip = {"grip": self.draw.choice(("edge", "passive"))} if self.some(0.2) else {}
        grippers = [{"name": "V1", "on": "VAC", **({"arm": 1} if self.arms == 2 else {}), **grip}]
        grippers += [{"name": "V2", "on": "VAC", "arm": 2, **grip}] if self.arms == 2 else []
        return grippers + ([{"name": "AIR", "on": "ATM"}] if self.has_locks and not self.is_timed else [])

    def fault(self, grippers):
        """One that goes by a gripper, a door, a station or a wafer; most of them last for a while."""
        at, station = self.draw.choice(grippers), self.draw.choice(self.inner)
        gripper = at["name"]
        kinds = [{"kind": "leak", "gripper": gripper, "value": self.draw.uniform(0, 1)}, {"kind": "no_vacuum", "gripper": gripper},
                 {"kind": "slow_vacuum", "gripper": gripper, "value": self.draw.uniform(0.01, 0.3)}] if "grip" not in at else []
        kinds += [{"kind": "plunger_stuck", "gripper": gripper}] if at.get("grip") == "edge" else []
        kinds += [{"kind": "sensor_on", "gripper": gripper}, {"kind": "sensor_off", "gripper": gripper}, {"kind": "valve_stuck", "gripper": gripper}] \
            if at.get("grip") != "passive" else []
        kinds += [{"kind": "axis_stopped", "gripper": gripper}, {"kind": "command_lost"},
                 {"kind": "station_stuck", "station": station}, {"kind": "station_slow", "station": station, "value": 3},
                 {"kind": "wafer_shifted", "wafer": "W1", "dx": self.draw.uniform(-1, 1), "dy": self.draw.uniform(-60, 60) * self.draw.choice((0.02, 1))},
                 {"kind": "wafer_missing", "wafer": f"W{self.wafers}"}]
        kinds += [{"kind": "door_stuck", "door": name} for name in self.doors] + [{"kind": "door_slow", "door": name, "value": 10} for name in self.doors]
        return {**self.draw.choice(kinds), "after": self.time(0, 200), "lasting": self.time(0, 20) + 0.001}

    def layout(self):
        grippers = self.grippers()
        wafers = [{"name": f"W{slot}", "station": "FROM", "slot": slot, "dx": self.draw.uniform(-0.5, 0.5) if self.some(0.5) else 0}
                  for slot in range(1, self.wafers + 1)]
        layout = {"robots": self.robots(), "grippers": grippers, "doors": self.doors or None, "stations": self.stations, "wafers": wafers,
                  "seat": True if self.some(0.4) else None, "settle": True if self.some(0.3) else None,
                  "check": "swept" if self.some(0.2) else None, "vacuum": "delayed" if self.some(0.4) else None,
                  "slice": self.draw.choice((None, None, None, 0.002, 0.0007)), "pads": {"friction": 0.4, "force": 20} if self.some(0.3) else None,
                  "faults": [self.fault(grippers) for _ in range(self.draw.randint(1, 3))] if self.some(0.5) else None}
        return f"return {lua(layout)}\n"

    # ------------------------------------------------------------------------------------------------------------ flow
    def step(self, names):
        names = list(names)
        return names[0] if len(names) == 1 and self.some(0.7) else names

    def route(self):
        inner, steps = self.draw.sample(self.inner, len(self.inner)), []
        while inner:
            steps.append(self.step(inner.pop() for _ in range(self.draw.randint(1, len(inner)))))
        if len(steps) > 1 and self.some(0.15):
            steps.append(steps[0])
        text = [lua(step) if isinstance(step, str) or self.some(0.7) else f"{{ {', '.join(map(lua, step))}, process = {self.time(1, 30)} }}" for step in steps]
        if self.has_locks:
            text = [lua(self.step(self.locks)), *text, lua(self.step(self.draw.sample(self.locks, len(self.locks))))]
        return ", ".join([*text, *([] if self.ends_home else ['"TO"'])])

    def lots(self):
        back = ', back = "FROM"' if self.ends_home else ""
        first = self.draw.randint(1, self.wafers)
        arrives = self.time(10, 200) if self.some(0.4) else 0
        lots = [f'{{ name = "A", wafers = {{ "FROM", 1, {first} }}{back} }}']
        if first < self.wafers:
            lots.append(f'{{ name = "B", wafers = {{ "FROM", {first + 1}, {self.wafers} }}{back}, arrives = {arrives}, priority = 1 }}')
        return ", ".join(lots)

    def downs(self):
        names = [*self.inner, *self.robots()]
        downs = [f"{{ {lua(self.draw.choice(names))}, at = {self.time(0, 150)}, seconds = {self.time(1, 60)} }}" for _ in range(self.draw.randint(1, 2))]
        return f"down = {{ {', '.join(downs)} }},"

    def script(self):
        self.ends_home = self.some(0.3)
        rule = OWN % self.draw.choice("<>") if self.some(0.2) else lua(self.draw.choice(RULES))
        more = [self.downs()] if self.some(0.3) else []
        more += [f"takt = {self.time(5, 90)},"] if self.some(0.2) else []
        more += [f"until_s = {self.time(50, 300)},"] if self.some(0.2) else []
        more += ['late = "tell",'] if self.some(0.7) else []
        more += ['on_error = function(tool, problem) if problem.robot then robot(problem.robot):recover() end return problem.number and "retry" end,'] \
            if self.some(0.4) and not self.is_timed else []
        before = [f"wait({self.time(0, 9)})"] if self.some(0.2) else []
        before += [f'stop_in({self.time(1, 100)}, "VAC")'] if self.some(0.15) and self.has_locks else []
        return "\n".join(['cell "cell.lua"', *before, f"local told = flow {{ lots = {{ {self.lots()} }},", f"  routes = {{ R = {{ {self.route()} }} }},",
                          f"  rule = {rule},", *more, "}", 'print("end", told["end"], told.makespan_s)', ""])


def play(program, folder, *options):
    """The exit status, and all that was told and written but for wall time and for counted time itself."""
    files = folder / "history.csv", folder / "schedule.csv"
    for file in files:
        file.unlink(missing_ok=True)
    words = [program, "run", folder / "flow.lua", "--json", "--budget", "1e12", "--history", files[0], "--schedule", files[1], *options]
    ran = subprocess.run(words, capture_output=True, text=True, timeout=600, check=False)
    data = json.loads(ran.stdout) if ran.stdout.startswith("{") else {"stdout": ran.stdout}
    data.pop("wall_s", None)
    counted = data.pop("counted", None)
    written = [file.read_text(encoding="utf-8") if file.exists() else "" for file in files]
    return counted, {"status": ran.returncode, "stderr": ran.stderr, "history": written[0], "schedule": written[1], **data}


def compare(program, folder, seed, sums):
    """None if all is the same, else what is not."""
    cell = Cell(seed)
    (folder / "cell.lua").write_text(cell.layout(), encoding="utf-8")
    (folder / "flow.lua").write_text(cell.script(), encoding="utf-8")
    (nothing, full), (counted, other) = play(program, folder), play(program, folder, "--counted")
    if "flow" not in full or full["status"] not in (0, 1):
        return f"the program ended with {full['status']}: {full.get('stdout')}{full['stderr']}"
    if nothing is not None or not counted or counted["played"] + counted["left_out"] != full["slices"]:
        return f"{counted} of {full['slices']} slices"
    for name in sorted(full.keys() | other.keys()):
        if full.get(name) != other.get(name):
            return f"{name}: {full.get(name)}\ncounted: {other.get(name)}"
    end = full["flow"]["end"]
    sums[end] = sums.get(end, 0) + 1
    sums["slices"] += full["slices"]
    sums["left_out"] += counted["left_out"]
    return None


def main(arguments):
    program, folder = arguments[0], pathlib.Path(arguments[1])
    first, count = map(int, arguments[2:])
    folder.mkdir(parents=True, exist_ok=True)
    sums = {"slices": 0, "left_out": 0}
    found = [(seed, compare(program, folder, seed, sums)) for seed in range(first, first + count)]
    for seed, difference in found:
        if difference:
            print(f"seed {seed}: {difference}")
    print(", ".join(f"{name} {number}" for name, number in sums.items()))
    few = sums["left_out"] < sums["slices"] / 2
    if few:
        print("less than half of all slices was left out")
    return 1 if few or any(difference for _, difference in found) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
