#!/usr/bin/env python3
"""Random tools and flows of growing difficulty, and how values stand in Lua.

    make(seed, level) -> (tool, flow), as flow_model takes them
    flow_tools.py LEVEL FIRST COUNT      looks at results of the model for such tools"""
import random
import sys

import flow_check
import flow_model

MS = 1000
LEVELS = ("one robot, one lot, single places", "parallel places, slots, times by station and pair, two arms", "cleans, windows, partial, takt",
          "several robots and shared buffers", "re-entrant and mixed routes, lots that arrive, priorities, back", "doors and locks with pumps",
          "stations that are down", "lists drawn at random, safe = false", "all together",
          "all together in whole seconds: much happens at one instant", "the same tools with a second lock beside each, and not safe",
          "the tools of level 10 with parallel steps that share stations", "and lots that come into slots of lots that are not over",
          "processes and cleans by recipe", "and carriers that take time to come and to go")
RULES = ("backward", "first_come", "longest_wait", "swap")


class Maker:
    """Draws a tool. `has(n)`: the level has what level n brings."""

    def __init__(self, seed, level):
        self.draw, self.level = random.Random(f"{min(level, 10)} {seed}"), level
        self.tool, self.lots, self.routes = {"robots": [], "serves": {}, "stations": []}, [], {}

    def has(self, level, chance=1.0):
        return self.level >= level and self.draw.random() < chance

    def time(self, least, most):
        """Seconds, sometimes whole, sometimes to the millisecond."""
        return self.draw.randint(least, most) * 1000 * MS if self.level > 9 or self.draw.random() < 0.5 else self.draw.randint(least * 1000, most * 1000) * MS

    # -------------------------------------------------------------------------------------------------------- the tool
    def make(self):
        groups = self.draw.randint(2, 3) if self.has(4) else 1
        self.chambers = [[f"P{group}{index}" for index in range(1, self.draw.randint(2, 4 if self.level > 1 else 3) + 1)]
                         for group in range(1, groups + 1)]
        self.wafers = self.draw.randint(3, 12)
        self.links = [self.link(group) for group in range(1, groups)]
        self.lone = groups == 1 or self.draw.random() < 0.5     # one load port, or one in and one out
        self.station("LP1", slots=25, load_port=True)
        if not self.lone or groups == 1:
            self.station("LP2", slots=25, load_port=True)
        for group, names in enumerate(self.chambers):
            for name in names:
                self.chamber(name)
            self.robot(group)
        self.locks()
        self.make_routes()
        self.make_lots()
        flow = {"lots": self.lots, "routes": self.routes, "rule": self.rule(), "until": self.time(50, 400) if self.has(9, 0.1) else None,
                "down": self.downs(), "takt": self.time(5, 40) if self.has(3, 0.2) else 0, "safe": True}
        if self.has(9, 0.3) and (flow["rule"] != "swap" or self.level > 11):
            self.heat()
        if 8 <= self.level < 12 and self.draw.random() < (1.0 if self.level == 8 else 0.4):
            self.lists(flow)
        if self.level > 13:
            self.recipes()
        if self.level > 14:
            self.carriers()
        if self.level == 11 and isinstance(flow["rule"], str):
            self.pair_locks()
            flow["safe"], flow["until"] = False, 3000 * 1000 * MS
        return self.tool, flow

    def pair_locks(self):
        """A second lock beside each one, for the same steps."""
        for lock in [station for station in self.tool["stations"] if station.get("pump")]:
            second = {**lock, "name": lock["name"] + "x", "state": self.draw.choice(("vacuum", "atmosphere"))}
            self.tool["stations"].append(second)
            for names in [*self.tool["serves"].values(), *(step["stations"] for route in self.routes.values() for step in route["steps"])]:
                if lock["name"] in names:
                    names.append(second["name"])
        for robot in self.tool["robots"]:   # times that name stations know no second lock
            for field in ("pick", "place", "move", "swap"):
                if isinstance(robot.get(field), dict):
                    robot[field] = next(iter(robot[field].values()))

    def by_recipe(self, value):
        """The number, or a table with it and others."""
        if value is None or self.draw.random() < 0.3:
            return value
        table = {"default": value}
        for recipe in self.draw.sample(("oxide", "nitride"), self.draw.randint(1, 2)):
            table[recipe] = max(1, value + self.draw.choice((-1, 1, 2))) if value < MS else self.time(5, 90)
        return table

    def recipes(self):
        for station in self.tool["stations"]:
            if station["process"] is not None:
                station["process"] = self.by_recipe(station["process"])
                for field in ("after", "idle"):
                    if station.get("clean") and station["clean"].get(field):
                        station["clean"][field] = self.by_recipe(station["clean"][field])
        tables = {station["name"]: [value for value in (station["process"], *(station.get("clean") or {}).values()) if isinstance(value, dict)]
                  for station in self.tool["stations"]}
        known = sorted({recipe for found in tables.values() for table in found for recipe in table} - {"default"})
        for route in self.routes.values():
            for step in route["steps"]:
                if known and not step.get("process") and self.draw.random() < 0.2 and any(tables[name] for name in step["stations"]):
                    step["recipe"] = self.draw.choice(known)
        for lot in self.lots:
            names = [name for step in self.routes[lot["route"]]["steps"] for name in step["stations"]]
            if known and any(tables[name] for name in names):
                one = self.draw.choice(known)
                lot["recipes"] = {slot: one if self.draw.random() < 0.7 else self.draw.choice(known) for _, _, slot in lot["wafers"]}

    def carriers(self):
        for station in self.tool["stations"]:
            if station.get("load_port"):
                station["port"] = {"comes": self.time(3, 30), "goes": self.time(3, 20)}
                if station["name"] == "LP1" and self.draw.random() < 0.4:
                    station["port"]["absent"] = True
                if station["name"] == "LP2":
                    station["slots"] = self.draw.choice((2, 4, 25))

    def station(self, name, **fields):
        self.tool["stations"].append({"name": name, "slots": 1, "process": None, **fields})

    def link(self, group):
        """Names of the buffers between two robots: one for both ways, or one in and one out."""
        names = [f"B{group}"] if self.draw.random() < 0.3 else [f"B{group}I", f"B{group}O"]
        for name in names:
            self.station(name, slots=self.draw.choice((1, 1, 2, 3)) if len(names) > 1 else self.draw.choice((2, 3)))
        return names

    def chamber(self, name):
        fields = {"process": self.time(5, 90)}
        if self.has(2, 0.15):
            fields["slots"] = self.draw.randint(2, 3)
        if self.has(3, 0.3):
            fields["clean"] = {"after": self.draw.randint(1, 3), "seconds": self.time(5, 40), "empty": self.draw.random() < 0.85}
        if self.has(3, 0.1):
            fields["clean"] = {**fields.get("clean", {"after": None, "seconds": self.time(5, 40), "empty": True}), "idle": self.time(20, 120)}
        if self.has(3, 0.3):
            fields["window"] = self.time(0, 20)
        self.station(name, **fields)

    def robot(self, group):
        serves = list(self.chambers[group])
        serves += self.links[group - 1] if group else ["LP1"] + ([] if self.lone and len(self.chambers) > 1 else ["LP2"])
        serves += self.links[group] if group < len(self.links) else []
        name = f"R{group + 1}"
        move = self.time(1, 5)
        if self.has(2, 0.4):
            move = {(a, b): self.time(1, 6) for a in serves for b in serves if a != b}
        pick, place = ({each: self.time(1, 6) for each in serves} if self.has(2, 0.3) else self.time(1, 6) for _ in range(2))
        swap = self.time(2, 9) if isinstance(move, dict) or self.draw.random() < 0.4 else None
        if swap is not None and self.has(2, 0.3):
            swap = {each: self.time(2, 9) for each in serves}
        self.tool["robots"].append({"name": name, "arms": 2 if self.has(2, 0.4) else 1, "at": self.draw.choice(serves),
                                    "pick": pick, "place": place, "move": move, "swap": swap})
        self.tool["serves"][name] = serves

    def locks(self):
        """The first link is a lock of each buffer; chambers have doors."""
        if not self.has(6):
            return
        for station in self.tool["stations"]:
            name, served = station["name"], [robot for robot, names in self.tool["serves"].items() if station["name"] in names]
            if self.links and name in self.links[0]:
                station["pump"] = {way: self.time(3, 25) for way in ("down", "up")}
                if self.draw.random() < 0.5:
                    station["pump"] |= {"empty_down": self.time(2, 10), "empty_up": self.time(2, 10)}
                station["state"] = self.draw.choice(("vacuum", "atmosphere"))
                station["sides"] = {robot: "atmosphere" if robot == "R1" else "vacuum" for robot in served}
                if len(self.links[0]) == 1 and self.has(9, 0.4):
                    station["ways"] = {1: "in", 2: "out"}
            if not station.get("load_port") and self.draw.random() < 0.4:
                station["doors"] = {robot: {"open": self.time(0, 2), "close": self.time(0, 2)} for robot in served}

    # ------------------------------------------------------------------------------------------------------------ flow
    def make_routes(self):
        for name in "ABC"[:self.draw.randint(1, 3) if self.has(5) else 1]:
            steps, depth = [], self.draw.randint(0, len(self.links))
            for group in range(depth + 1):
                steps += self.visit(group, group == depth) + ([[self.links[group][0]]] if group < depth else [])
            for group in range(depth - 1, -1, -1):
                steps += [[self.links[group][-1]]] + (self.visit(group, False) if self.draw.random() < 0.4 else [])
            steps.append(["LP1" if self.lone and len(self.chambers) > 1 else "LP2"])
            steps = [step for index, step in enumerate(steps) if index == 0 or not set(step) & set(steps[index - 1])]
            if self.level > 11:
                steps = [step[:] for step in steps]
                self.overlap(steps)
            route = {"steps": [{"stations": step} for step in steps]}
            self.decorate(route)
            self.routes[name] = route

    def visit(self, group, must):
        """Steps in one robot's chambers: some of them, parallel or not, sometimes twice."""
        names = self.draw.sample(self.chambers[group], len(self.chambers[group]))
        steps = []
        while names:
            count = self.draw.randint(1, min(3, len(names))) if self.has(2, 0.5) else 1
            steps.append(names[:count])
            names = names[count:]
        steps = steps[:self.draw.randint(1 if must else 0, len(steps))]
        if self.has(5, 0.3) and len(steps) > 1:
            steps.append(self.draw.choice(steps[:-1]))
        return steps

    def overlap(self, steps):
        """Steps in one robot's chambers share stations with the one before."""
        for before, step, after in zip(steps, steps[1:], steps[2:]):
            shared = [name for name in before if name not in step + after and name.startswith("P") and name[1] == step[0][1:2]]
            if shared and step[0].startswith("P") and self.draw.random() < 0.7:
                step.append(self.draw.choice(shared))
                self.draw.shuffle(step)

    def decorate(self, route):
        slots = {station["name"]: station["slots"] for station in self.tool["stations"]}
        for number, step in enumerate(route["steps"], 1):
            chambers = all(name.startswith("P") for name in step["stations"])
            if chambers and self.has(2, 0.3):
                step["process"] = self.time(5, 90)
            if chambers and self.has(3, 0.2) and sum(slots[name] for name in step["stations"]) > 1:
                route.setdefault("partial", {})[number] = 1

    def heat(self):
        """Out of one step a second arm alone takes."""
        hot = [name for group, names in enumerate(self.chambers) if self.tool["robots"][group]["arms"] == 2 for name in names]
        steps = [step for route in self.routes.values() for step in route["steps"] if set(step["stations"]) <= set(hot)]
        for step in self.draw.sample(steps, min(1, len(steps))):
            step["hot"] = True

    def make_lots(self):
        at, number, slot = 0, 0, 1
        count = self.draw.randint(1, 3) if self.has(5) else 1
        for lot in range(1, count + 1):
            size = max(1, self.wafers // count)
            names = [f"W{number + index}" for index in range(1, size + 1)]
            given = {"name": f"L{lot}", "wafers": [(name, "LP1", slot + index) for index, name in enumerate(names)],
                     "route": self.draw.choice(sorted(self.routes)), "arrives": at, "priority": self.draw.randint(0, 2) if self.has(5) else 0}
            if self.has(5, 0.5) or self.routes[given["route"]]["steps"][-1]["stations"] == ["LP1"]:
                given["back"] = "LP1"
            self.lots.append(given)
            number, slot = number + size, 1 if self.has(13, 0.7) else slot + size
            at += self.draw.choice((0, self.time(10, 200)))
        if self.has(9, 0.2) and len(self.lots) > 1:
            self.lots[-1]["dummy"] = True

    def downs(self):
        """Down for a time; for ever only where the steps before and behind have other stations."""
        if not self.has(7):
            return []
        names = [name for names in self.chambers for name in names]
        found, at = [], 0
        for _ in range(self.draw.randint(1, 2)):
            at += self.time(5, 200)
            name, ever = self.draw.choice(names), self.has(9, 0.3)
            steps = [[set(step["stations"]) for step in route["steps"]] for route in self.routes.values()]
            ever = ever and not any(name in here and before & after for route in steps for before, here, after in zip(route, route[1:], route[2:]))
            found.append({"station": name, "at": at, "seconds": None if ever else self.time(10, 200)})
        return found

    def rule(self):
        two = any(robot["arms"] == 2 for robot in self.tool["robots"])
        return self.draw.choice(RULES if two else RULES[:3])

    # ----------------------------------------------------------------------------------------------------------- lists
    def lists(self, flow):
        """The order in which a shipped rule goes, sometimes with neighbours swapped, wafers named, and wafers kept on an arm."""
        result = flow_model.run(self.tool, {**flow, "rule": self.draw.choice(RULES[:3])})
        arms = {robot["name"]: robot["arms"] for robot in self.tool["robots"]}
        order = {name: [] for name in arms}
        rows = sorted((row[4], row[0], name, row[2], row[6]) for name, found in result["wafers"].items() for row in found if row[6])
        for _, robot, wafer, start, to in rows:
            named = (wafer,) if self.draw.random() < 0.3 else ()
            if arms[robot] == 2 and self.draw.random() < 0.2:
                order[robot] += [(start, "keep", *named), ("keep", to, *named)]
            else:
                order[robot].append((start, to, *named))
        for actions in order.values():
            for _ in range(self.draw.choice((0, 0, 1, 2))):
                index = self.draw.randrange(len(actions)) if actions else 0
                actions[index:index + 2] = reversed(actions[index:index + 2])
        flow["rule"] = {"order": order}
        if self.draw.random() < 0.3:
            flow["safe"], flow["rule"] = False, self.draw.choice(RULES[:3])


def make(seed, level):
    return Maker(seed, level).make()


# ---------------------------------------------------------------------------------------------------------------- Lua
def lua(value):
    """A value as Lua. Tuples and lists are sequences; keys that are no names stand in brackets."""
    if value is None or isinstance(value, bool):
        return {None: "nil", True: "true", False: "false"}[value]
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, (list, tuple)):
        return "{ " + ", ".join(lua(each) for each in value) + " }" if value else "{}"
    parts = [f"{key if isinstance(key, str) else f'[{key}]'} = {lua(each)}" for key, each in value.items() if each is not None]
    return "{ " + ", ".join(parts) + " }" if parts else "{}"


class Seconds(float):
    """Microseconds as the seconds that stand in Lua."""

    def __repr__(self):
        text = f"{int(self) // 1_000_000}.{int(self) % 1_000_000:06d}".rstrip("0")
        return text.rstrip(".")


def seconds(value):
    if isinstance(value, dict):
        pairs = {}
        for key, each in value.items():
            if isinstance(key, tuple):
                pairs.setdefault(key[0], {})[key[1]] = Seconds(each)
            else:
                pairs[key] = seconds(each)
        return pairs
    return None if value is None else Seconds(value)


def script_step(step):
    if len(step["stations"]) == 1 and not any(map(step.get, ("process", "hot", "recipe"))):
        return lua(step["stations"][0])
    fields = {"process": seconds(step.get("process")), "hot": step.get("hot") or None, "recipe": step.get("recipe")}
    named = [f"{key} = {lua(value)}" for key, value in fields.items() if value is not None]
    return "{ " + ", ".join([*map(lua, step["stations"]), *named]) + " }"


# --------------------------------------------------------------------------------------------------------------- main
def main(arguments):
    level, first, count = map(int, arguments)
    states, bad = {}, 0
    for seed in range(first, first + count):
        tool, flow = make(seed, level)
        result = flow_model.run(tool, flow)
        states[result["state"]] = states.get(result["state"], 0) + 1
        for violation in flow_check.look(tool, flow, result):
            bad += 1
            print(f"level {level}, seed {seed}: {violation}")
        if result["state"] != "done" and isinstance(flow["rule"], str) and flow["safe"]:
            print(f"level {level}, seed {seed}, {flow['rule']}: {result['state']} {result['cause'] or result['circle']}")
    print(f"level {level} ({LEVELS[level - 1]}): {states}, {bad} violations")
    return bool(bad)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
