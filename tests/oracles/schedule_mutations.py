#!/usr/bin/env python3
"""Good schedules of random tools, made by a small generator that shares no code with the program, are accepted; each with one thing changed is
found by the rule that it breaks.

    schedule_mutations.py PROGRAM FOLDER FIRST COUNT     prints the seeds that are judged otherwise; exit 1 if there are any"""
import json
import pathlib
import random
import subprocess
import sys

COLUMNS = ("robot", "action", "wafer", "station", "slot", "begin_s", "end_s", "arm", "wafer2", "to", "value")
BUSY, ARMS, ABSENT, NOT_ABOARD, PROCESS, WINDOW, LEFT = 1, 2, 3, 4, 8, 9, 17


class Maker:
    """One or two robots, modules of each, and a buffer between them; all times in ms, each action as soon as it can be or some time later."""

    def __init__(self, seed):
        self.draw = random.Random(f"schedule {seed}")
        self.rows, self.wafers = [], [f"W{number}" for number in range(1, self.draw.randint(3, 8) + 1)]
        self.robots = {name: {"arms": self.draw.choice((1, 2)), "pick": self.time(1, 4), "place": self.time(1, 4), "move": self.time(0, 3)}
                       for name in ("R1", "R2")[:self.draw.randint(1, 2)]}
        self.process, self.by, self.slots = {}, {}, {"IN": len(self.wafers), "OUT": len(self.wafers)}
        names = list(self.robots)
        self.way = ["IN"]
        for number, robot in enumerate(names):
            for module in range(self.draw.randint(1, 3)):
                self.add(f"M{number}{module}", [robot], self.time(3, 40), 1)
            if robot != names[-1]:
                self.add("BUF", names, 0, self.draw.randint(1, 2))
        self.way.append("OUT")
        self.by["IN"], self.by["OUT"] = [names[0]], [names[-1]]

    def time(self, least, most):
        return self.draw.randint(1000 * least, 1000 * most)

    def add(self, station, robots, process, slots):
        self.way.append(station)
        self.by[station], self.process[station], self.slots[station] = robots, process, slots

    def make(self):
        empty = {(station, slot): 0 for station in self.way for slot in range(1, self.slots[station] + 1)}
        where = {wafer: ("IN", slot, 0) for slot, wafer in enumerate(self.wafers, 1)}   # station, slot, done
        for wafer, (station, slot, _) in where.items():
            self.rows.append(self.row("start", wafer=wafer, station=station, slot=slot))
            del empty[station, slot]
        robots = {name: ["IN" if name == "R1" else self.way[-1], 0] for name in self.robots}
        while choices := list(self.choices(where, empty)):
            robot, wafer, (station, slot, done), (to, into) = self.draw.choice(choices)
            at, free = robots[robot]
            times = self.robots[robot]
            pick = max(done, free + (times["move"] if at != station else 0)) + self.draw.choice((0, 0, self.time(0, 5)))
            place = max(pick + times["pick"] + times["move"], empty.pop((to, into))) + self.draw.choice((0, 0, self.time(0, 5)))
            end = place + times["place"]
            self.rows.append(self.row("pick", robot, wafer, station, slot, pick, pick + times["pick"]))
            self.rows.append(self.row("place", robot, wafer, to, into, place, end))
            if self.process.get(to):
                self.rows.append(self.row("process", "", wafer, to, into, end, end + self.process[to]))
            empty[station, slot] = pick + times["pick"]
            where[wafer] = (to, into, end + self.process.get(to, 0))
            robots[robot] = [to, end]
        return self.rows

    def choices(self, where, empty):
        for wafer, (station, slot, done) in where.items():
            if station == "OUT":
                continue
            to = self.way[self.way.index(station) + 1]
            robot = next(name for name in self.by[to] if name in self.by[station])
            free = [place for place in empty if place[0] == to]
            if free:
                yield robot, wafer, (station, slot, done), self.draw.choice(free)

    @staticmethod
    def row(action, robot="", wafer="", station="", slot=1, begin=0, end=0):
        return {"robot": robot, "action": action, "wafer": wafer, "station": station, "slot": slot, "begin_s": begin, "end_s": end}

    def layout(self):
        """The tool as the program reads it."""
        robots = ", ".join(f"{name} = {{ kind = \"timed\", arms = {of['arms']}, pick = {of['pick'] / 1000}, place = {of['place'] / 1000}, "
                           f"move = {of['move'] / 1000}, at = \"{'IN' if name == 'R1' else self.way[-1]}\" }}" for name, of in self.robots.items())
        stations = ", ".join(f"{name} = {{ slots = {self.slots[name]}, process = {self.process.get(name, 0) / 1000}, "
                             f"by = {{ {', '.join(map(repr, self.by[name]))} }} }}" for name in self.way)
        route = ", ".join(map(repr, self.way[1:]))
        return f"return {{ robots = {{ {robots} }}, stations = {{ {stations} }}, routes = {{ A = {{ {route} }} }} }}\n"


# ---------------------------------------------------------------------------------------------------------- mutations
def of(rows, *actions):
    return [row for row in rows if row["action"] in actions]


def earlier(draw, rows):
    """An action of a robot begins before the one before it has ended."""
    by_robot = {}
    for row in sorted(of(rows, "pick", "place"), key=lambda row: row["begin_s"]):
        by_robot.setdefault(row["robot"], []).append(row)
    before, row = draw.choice([pair for actions in by_robot.values() for pair in zip(actions, actions[1:])])
    row["begin_s"] = draw.randint(before["begin_s"], before["end_s"] - 1)
    return {BUSY}


def swapped(draw, rows):
    """Two picks of one robot take each the other one's wafer."""
    picks = of(rows, "pick")
    pairs = [(a, b) for a in picks for b in picks if a["wafer"] < b["wafer"] and a["robot"] == b["robot"]]
    a, b = draw.choice(pairs)
    a["wafer"], b["wafer"] = b["wafer"], a["wafer"]
    return {ABSENT}


def no_pick(draw, rows):
    rows.remove(draw.choice(of(rows, "pick")))
    return {NOT_ABOARD}


def no_place(draw, rows):
    rows.remove(draw.choice(of(rows, "place")))
    return {ABSENT, ARMS, LEFT}


def twice(draw, rows):
    rows.append(dict(draw.choice(of(rows, "pick"))))
    return {BUSY}


def short(draw, rows):
    row = draw.choice(of(rows, "process"))
    row["end_s"] = draw.randint(row["begin_s"], row["end_s"] - 1)
    return {PROCESS}


def cut_short(draw, rows):
    """The wafer is taken while it is processed: the process's row goes on."""
    row = draw.choice(of(rows, "process"))
    pick = min((each for each in of(rows, "pick") if each["wafer"] == row["wafer"] and each["begin_s"] >= row["end_s"]), key=lambda each: each["begin_s"])
    row["end_s"] = pick["begin_s"] + draw.randint(1, 5000)
    return {PROCESS}


MUTATIONS = (earlier, swapped, no_pick, no_place, twice, short, cut_short)


# --------------------------------------------------------------------------------------------------------------- main
def write(path, draw, rows):
    """In any order, with tabs or commas, comments, CRLF or LF, with a byte order mark or without."""
    separator, end = draw.choice(",\t"), draw.choice(("\n", "\r\n"))
    lines = [separator.join(COLUMNS[:7])]
    for row in draw.sample(rows, len(rows)):
        cells = {**row, "begin_s": f"{row['begin_s'] / 1000:.3f}", "end_s": f"{row['end_s'] / 1000:.3f}"}
        lines += ["# a comment"] * (draw.random() < 0.05) + [separator.join(str(cells[name]) for name in COLUMNS[:7])]
    path.write_bytes((draw.choice(("", "\ufeff")) + end.join([*lines, ""])).encode())


def judge(program, folder, draw, rows):
    write(folder / "schedule.csv", draw, rows)
    ran = subprocess.run([program, "schedule", folder / "schedule.csv", "--layout", folder / "tool.lua", "--json"], capture_output=True, text=True,
                         timeout=60, check=False)
    if not ran.stdout.startswith("{"):
        return ran.returncode, {ran.stderr}
    return ran.returncode, {finding["rule"] for finding in json.loads(ran.stdout)["findings"]}


def look(program, folder, seed):
    maker = Maker(seed)
    rows, draw = maker.make(), random.Random(f"mutation {seed}")
    (folder / "tool.lua").write_text(maker.layout(), encoding="utf-8")
    status, rules = judge(program, folder, draw, rows)
    if status != 0 or rules - {LEFT}:
        return f"a good one ends with {status}: {rules}"
    for mutation in MUTATIONS:
        changed = [dict(row) for row in rows]
        try:
            wanted = mutation(draw, changed)
        except (IndexError, ValueError):
            continue    # nothing to change
        status, rules = judge(program, folder, draw, changed)
        if not rules & wanted or (status == 0 and rules - {LEFT}):
            return f"{mutation.__name__}: expected one of {wanted}, found {rules}, exit status {status}"
    return None


def main(arguments):
    program, folder = arguments[0], pathlib.Path(arguments[1])
    first, count = map(int, arguments[2:])
    folder.mkdir(parents=True, exist_ok=True)
    found = [(seed, look(program, folder, seed)) for seed in range(first, first + count)]
    for seed, difference in found:
        if difference:
            print(f"seed {seed}: {difference}")
    return 1 if any(difference for _, difference in found) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
