"""What flow_model is known to give: published sequences and makespans, tables of steady cycles, closed forms over random tools."""
import itertools
import random
from fractions import Fraction

import flow_model

S = 1_000_000
ROUTES = {
    "serial": "LLA>PM11:60>PM12:70>BM11:0>PM21:40>PM22:50>PM23:50>PM24:60>BM12:0>PM13:50>PM14:48>LLB",
    "parallel": "LLA>PM11|PM12:139>BM11:0>PM21|PM22:131>PM23|PM24:130>BM12:0>PM13|PM14:120>LLB",
    "reentrant": "LLA>PM11|PM12|PM13:200>BM11:0>PM21:60>PM22:50>PM23|PM24:130>PM22:50>BM12:0>PM14:110>LLB",
}
OPTIMA = {"serial": 769, "parallel": 833, "reentrant": 1095}
BEST_OF_RULES = {"serial": 771, "parallel": 835, "reentrant": 1114}
PLACES = {
    "parallel": "LLA PM11 PM12 BM11 PM21 PM22 PM23 PM24 BM12 PM13 PM14 LLB".split(),
    "reentrant": "LLA PM11 PM12 PM13 BM11 PM21 PM22 PM23 PM24 BM12 PM14 LLB".split(),
}
SEQUENCES = {
    "serial": "1 0,2 0,1 0,3 0,0 4,0 5,2 0,1 0,3 0,0 4,0 6,0 5,0 7,2 0,1 0,3 0,0 4,0 6,0 5,0 8,0 7,2 0,1 0,9 0,3 0,0 4,0 6,0 5,0 8,0 7,2 0,"
              "10 0,9 0,3 0,0 4,0 6,0 5,0 8,0 7,0 6,11 0,10 0,9 0,0 8,0 7,11 0,10 0,9 0,0 8,11 0,10 0,9 0,11 0,10 0,11 0",
    "parallel": "1 2 0 0,1 3 0 0,2 4 0 0,0 0 4 5,1 2 0 0,3 4 0 0,0 0 4 6,1 3 0 0,0 0 5 7,0 0 6 8,2 4 0 0,0 0 4 5,1 2 0 0,3 4 0 0,0 0 4 6,"
                "0 0 7 9,9 10 0 0,0 0 8 9,9 11 0 0,0 0 5 7,2 4 0 0,0 0 6 8,0 0 4 5,10 12 0 0,11 12 0 0,0 0 7 9,9 10 0 0,0 0 8 9,9 11 0 0,"
                "0 0 5 7,0 0 7 9,10 12 0 0,11 12 0 0,9 10 0 0,10 12 0 0",
    "reentrant": "1 2 0 0,1 3 0 0,1 4 0 0,2 5 0 0,0 0 5 6,3 5 0 0,0 0 5 100,1 2 0 0,1 3 0 0,4 5 0 0,0 0 6 7,0 0 100 6,0 0 5 100,0 0 7 8,"
                 "0 0 6 7,0 0 100 6,0 0 7 9,0 0 6 7,2 5 0 0,0 0 5 6,3 5 0 0,0 0 7 100,0 0 8 7,0 0 100 8,0 0 6 100,0 0 5 6,0 0 7 10,"
                 "10 11 0 0,0 0 100 7,0 0 9 100,0 0 7 9,0 0 100 7,0 0 7 10,0 0 6 7,11 12 0 0,0 0 8 100,10 11 0 0,0 0 7 8,0 0 100 7,"
                 "0 0 7 10,0 0 9 7,11 12 0 0,10 11 0 0,0 0 7 10,0 0 8 7,11 12 0 0,0 0 7 10,10 11 0 0,11 12 0 0,10 11 0 0,11 12 0 0",
}
STEADY = """single,60,1,3,2,,,78
single,60;70,1;1,3,2,,,88
single,100;90;100,2;1;2,3,2,,,108
single,200;60;130,3;1;2,5,2,,,86
clean,60;70,1;1,3,2,30;30,0;0,106
clean,100;100,2;2,3,2,40;40,1;0,118
clean,120;90;150,3;2;3,3,2,60;30;60,1;0;1,84
dual,60,1,8,2,,,68
dual,60;70,1;1,8,2,,,78
dual,82;92;100,1;1;1,4,1,,,104"""


# ------------------------------------------------------------------------------------------------ two linked clusters
def linked(case, rule, wafers=5):
    """The tool of two linked clusters and a flow of it."""
    steps = [step.partition(":") for step in ROUTES[case].split(">")[1:]]
    route = [{"stations": names.split("|"), "process": int(seconds or 0) * S} for names, _, seconds in steps]
    first, second = "LLA LLB PM11 PM12 PM13 PM14 BM11 BM12".split(), "PM21 PM22 PM23 PM24 BM11 BM12".split()
    times = {"pick": S, "place": S, "move": S, "swap": None}
    tool = {"robots": [{"name": "R1", "arms": 1, "at": "LLA", **times}, {"name": "R2", "arms": 2, "at": "BM11", **times}],
            "serves": {"R1": first, "R2": second},
            "stations": [{"name": name, "slots": wafers if name in ("LLA", "LLB") else 1} for name in sorted({*first, *second})]}
    lot = {"name": "L", "wafers": [(f"W{slot}", "LLA", slot) for slot in range(1, wafers + 1)], "route": "A"}
    return tool, {"lots": [lot], "routes": {"A": {"steps": route}}, "rule": rule}


def sequence(case):
    """The published sequence as lists."""
    order = {"R1": [], "R2": []}
    stations = [step.partition(":")[0] for step in ROUTES[case].split(">")]
    for move in SEQUENCES[case].split(","):
        numbers = [int(number) for number in move.split()]
        if case == "serial":
            robot, number = ("R1", numbers[0]) if numbers[0] else ("R2", numbers[1])
            order[robot].append((stations[number - 1], stations[number]))
        else:
            robot, pair = ("R1", numbers[:2]) if numbers[0] else ("R2", numbers[2:])
            order[robot].append(tuple("keep" if number == 100 else PLACES[case][number - 1] for number in pair))
    return {"order": order}


def makespan(tool, flow):
    result = flow_model.run(tool, flow)
    return result["makespan"] / S if result["state"] == "done" else result["state"]


def check_linked(say):
    for case, optimum in OPTIMA.items():
        rule = sequence(case)
        say(f"{case} as published", makespan(*linked(case, rule)), optimum)
        worse, same = 0, 0
        for robot, actions in rule["order"].items():
            for index in range(len(actions) - 1):
                swapped = [*actions[:index], actions[index + 1], actions[index], *actions[index + 2:]]
                if swapped != actions:
                    other = makespan(*linked(case, {"order": {**rule["order"], robot: swapped}}))
                    worse, same = worse + (other != optimum), same + (other == optimum)
        say(f"{case} with two neighbours swapped: another makespan or none in {worse} of {worse + same} cases", worse > 2 * same, True)
        by_rule = {name: makespan(*linked(case, name)) for name in ("backward", "swap", "first_come", "longest_wait")}
        print(f"     {case}: {by_rule}")
        say(f"{case} by the best rule", min(value for value in by_rule.values() if not isinstance(value, str)), BEST_OF_RULES[case])


# ------------------------------------------------------------------------------------------------------ steady cycles
def series(steps, robot, wafers, partial=None):
    """One robot, load locks LA and LB, steps of (count, process, clean after each wafer). Times in seconds."""
    names = [[f"P{number}{chr(97 + index)}" for index in range(count)] for number, (count, _, _) in enumerate(steps, 1)]
    stations = [{"name": "LA", "slots": wafers}, {"name": "LB", "slots": wafers}]
    for group, (_, process, clean) in zip(names, steps):
        after = {"after": 1, "seconds": clean * S, "empty": True} if clean else None
        stations += [{"name": name, "slots": 1, "process": process * S, "clean": after} for name in group]
    given = {key: None if value is None else {pair: int(each * S) for pair, each in value.items()} if isinstance(value, dict) else int(value * S)
             for key, value in robot.items() if key != "arms"}
    tool = {"robots": [{"name": "R", "arms": robot["arms"], "at": "LA", **given}],
            "serves": {"R": [station["name"] for station in stations]}, "stations": stations}
    lot = {"name": "L", "wafers": [(f"W{slot}", "LA", slot) for slot in range(1, wafers + 1)], "route": "A"}
    route = {"steps": [*({"stations": group} for group in names), {"stations": ["LB"]}], "partial": partial or {}}
    return tool, {"lots": [lot], "routes": {"A": route}, "rule": "swap" if robot["arms"] == 2 else "backward"}


def cycle(tool, flow):
    result = flow_model.run(tool, flow)
    if result["state"] != "done" or result["cycle"] is None:
        return f"{result['state']} {result.get('why')} {result.get('cause')}"
    return Fraction(result["cycle"][0], result["cycle"][1] * S)


def check_steady(say, wafers=36):
    for row in STEADY.split("\n"):
        kind, p, m, w_or_s, v, c, z, expected = row.split(",")
        p, m = [int(each) for each in p.split(";")], [int(each) for each in m.split(";")]
        c = [int(each) for each in c.split(";")] if c else [0] * len(p)
        kept = {number: int(each) for number, each in enumerate(z.split(";"), 1) if int(each)} if z else {}
        given, v = int(w_or_s), int(v)
        w = (given - v) / 2 if kind == "dual" else given
        robot = {"arms": 2 if kind == "dual" else 1, "pick": w, "place": w, "move": v, "swap": given if kind == "dual" else None}
        say(row, cycle(*series(list(zip(m, p, c)), robot, wafers, kept)), int(expected))


# ------------------------------------------------------------------------------------------------------ closed forms
def check_series(say, cases, seed=1):
    """Steps in series, parallel chambers, one or two arms; then stations in parallel."""
    draw = random.Random(seed)
    off = []
    for case in range(cases):
        n, arms = draw.randint(2, 4), draw.randint(1, 2)
        w, v = draw.randint(1, 9), draw.randint(1, 9)
        steps = [(draw.randint(1, 3), draw.randint(5, 200), 0) for _ in range(n)]
        s = 2 * w + v
        found = cycle(*series(steps, {"arms": arms, "pick": w, "place": w, "move": v, "swap": None}, 42))
        if arms == 1:
            expected = max(2 * (n + 1) * (w + v), *(Fraction(p + 4 * w + 3 * v, m) for m, p, _ in steps))
        else:
            expected = max((n + 1) * (s + v), *(Fraction(p + s, m) for m, p, _ in steps))
        if found != expected:
            off.append((case, arms, w, v, steps, str(found), str(expected)))
    say(f"{cases} random tools in series: off", off[:5], [])


def check_moves_that_differ(say, cases, seed=2):
    """Single chambers, moves by pair, picks and places by station."""
    draw = random.Random(seed)
    off = []
    for case in range(cases):
        n = draw.randint(2, 5)
        names = ["LA", *(f"P{number}a" for number in range(1, n + 1)), "LB"]
        g, q = ([draw.randint(1, 6) for _ in names] for _ in range(2))
        v = {(a, b): draw.randint(1, 9) for a in range(n + 2) for b in range(n + 2) if a != b}
        p = [0, *(draw.randint(5, 120) for _ in range(n))]
        robot = {"arms": 1, "pick": dict(zip(names, g)), "place": dict(zip(names, q)), "swap": None,
                 "move": {(names[a], names[b]): value for (a, b), value in v.items()}}
        found = cycle(*series([(1, p[number], 0) for number in range(1, n + 1)], robot, 40))
        busy = sum(g[i] + v[i, i + 1] + q[i + 1] for i in range(n + 1)) + sum(v[i + 1, i - 1] for i in range(1, n + 1)) + v[1, n]
        modules = [p[i] + g[i] + v[i, i + 1] + q[i + 1] + v[i + 1, i - 1] + g[i - 1] + v[i - 1, i] + q[i] for i in range(1, n + 1)]
        if found != max(busy, *modules):
            off.append((case, n, str(found), busy, modules))
    say(f"{cases} random tools with moves that differ: off", off[:5], [])


def check_cleans(say, cases, seed=3):
    """Cleans after each wafer and chambers kept empty: the published form, one arm, backward."""
    draw = random.Random(seed)
    off = []
    for case in range(cases):
        n, w, v = draw.randint(1, 3), draw.randint(1, 5), draw.randint(1, 5)
        m = [draw.randint(1, 3) for _ in range(n)]
        p, c = [draw.randint(20, 150) for _ in range(n)], [draw.choice((0, draw.randint(10, 60))) for _ in range(n)]
        z = [draw.randint(0, count - 1) if draw.random() < 0.5 else 0 for count in m]
        forms = [(n + 1) * (2 * w + 2 * v)]
        forms += [Fraction(p[i] + c[i] + 2 * w, m[i]) for i in range(n)] + [Fraction(p[i] + 4 * w + 3 * v, m[i] - z[i]) for i in range(n)]
        for chosen in (chosen for size in range(1, n + 1) for chosen in itertools.combinations(range(n), size)):
            if all(b - a > 1 for a, b in zip(chosen, chosen[1:])):
                busy = (n + 1 - 2 * len(chosen)) * (2 * v + 2 * w) + sum(2 * w + v + c[i] for i in chosen)
                forms.append(Fraction(busy, 1 + sum(z[i] for i in chosen)))
        kept = {number: each for number, each in enumerate(z, 1) if each}
        found = cycle(*series(list(zip(m, p, c)), {"arms": 1, "pick": w, "place": w, "move": v, "swap": None}, 48, kept))
        if found != max(forms):
            off.append((case, w, v, m, p, c, z, str(found), str(max(forms))))
    say(f"{cases} random tools with cleans and kept chambers: off", off[:5], [])


def check_eight_seconds(say):
    times = {"arms": 1, "pick": 3 * S, "place": 3 * S, "move": 2 * S, "swap": None}
    tool = {"robots": [{"name": "R1", "at": "X", **times}, {"name": "R2", "at": "B", **times}],
            "serves": {"R1": ["X", "B"], "R2": ["B", "Y"]}, "stations": [{"name": name, "slots": 1} for name in "XBY"]}
    lots = [{"name": "L1", "wafers": [("W1", "B", 1)], "route": "one"}, {"name": "L2", "wafers": [("W2", "X", 1)], "route": "two"}]
    routes = {"one": {"steps": [{"stations": ["Y"]}]}, "two": {"steps": [{"stations": ["B"]}]}}
    for rule in ("backward", "first_come", "longest_wait", {"order": {"R1": [("X", "B")], "R2": [("B", "Y")]}}):
        say(f"X to B while B is emptied, {rule if isinstance(rule, str) else 'lists'}", makespan(
            tool, {"lots": lots, "routes": routes, "rule": rule}), 8)


# ------------------------------------------------------------------------------------------------- worked out by hand
def small(lock=None, module=None, rule="first_come", wafers=1, flow=None, arms=1):
    """LP - R1 - LL - R2 - PM and back, where each pick, place and move takes 1 s and the process 20 s."""
    times = {"pick": S, "place": S, "move": S, "swap": None}
    tool = {"robots": [{"name": "R1", "arms": 1, "at": "LP", **times}, {"name": "R2", "arms": arms, "at": "LL", **times}],
            "serves": {"R1": ["LP", "LL"], "R2": ["LL", "PM"]},
            "stations": [{"name": "LP", "slots": wafers, "load_port": True}, {"name": "LL", "slots": 1, **(lock or {})},
                         {"name": "PM", "slots": 1, "process": 20 * S, **(module or {})}]}
    lot = {"name": "L", "wafers": [(f"W{slot}", "LP", slot) for slot in range(1, wafers + 1)], "route": "A", "back": "LP"}
    route = {"steps": [{"stations": [name]} for name in ("LL", "PM", "LL")]}
    return tool, {"lots": [lot], "routes": {"A": route}, "rule": rule, **(flow or {})}


def check_by_hand(say):
    pump = {"pump": {"down": 10 * S, "up": 8 * S, "empty_down": 4 * S, "empty_up": 3 * S}, "state": "atmosphere",
            "sides": {"R1": "atmosphere", "R2": "vacuum"}}
    doors = {"doors": {"R2": {"open": S // 2, "close": S // 2}}}
    say("one wafer there and back", makespan(*small()), 32)
    say("a lock", makespan(*small(pump)), 50)
    say("a lock that must turn empty first", makespan(*small({**pump, "state": "vacuum"})), 51)
    say("a lock and a door", makespan(*small(pump, doors)), 51.5)
    say("the lock turns three times for a second wafer", makespan(*small(pump, wafers=2)), 100)
    say("a station that is down from 3 s to 30 s", makespan(*small(flow={"down": [{"station": "PM", "at": 3 * S, "seconds": 27 * S}]})), 59)
    say("a station that fails: the route goes on without it", makespan(*small(flow={"down": [{"station": "PM", "at": 0, "seconds": None}]})), 6)
    clean = {"clean": {"after": 1, "seconds": 60 * S, "empty": True}}
    say("a clean between two wafers", makespan(*small(module=clean, wafers=2)), 27 + 60 + 27)
    say("a clean with the wafer inside", makespan(*small(module={"clean": {**clean["clean"], "empty": False}})), 92)
    say("idle for 2 s, cleaned for 9", makespan(*small(module={"clean": {"after": None, "seconds": 9 * S, "empty": True, "idle": 2 * S}})), 38)
    tool, flow = small(wafers=1, rule=lambda view, robot: [("PM", "XX")] if robot == "R2" else [])
    say("an answer that can never begin", flow_model.run(tool, flow)["cause"], "R2: ('PM', 'XX'): there is no station XX")

    def own(view, robot):
        at = view["wafers"]["W1"]["station"], view["wafers"]["W1"]["step"]
        return {("R1", "LP", 0): [("LP", "LL")], ("R2", "LL", 1): [("LL", "PM")], ("R2", "PM", 2): [("PM", "LL", "W1")],
                ("R1", "LL", 3): [("LL", "LP")]}.get((robot, *at), [])
    say("a rule of one's own", makespan(*small(rule=own)), 32)
    result = flow_model.run(*small(module={"window": 2 * S}, rule={"order": {"R1": [("LP", "LL"), ("LL", "LP")], "R2": [("LL", "PM")]}}))
    say("a list that ends too early", (result["state"], result["makespan"]), ("STUCK", 6 * S))


def main(arguments):
    failed = []

    def say(what, found, expected):
        right = found == expected
        print(f"{'ok  ' if right else 'OFF '} {what}: {found if right else f'{found}, expected {expected}'}")
        failed.append(what) if not right else None
    cases = int(arguments[0]) if arguments else 20
    check_eight_seconds(say)
    check_by_hand(say)
    check_linked(say)
    check_steady(say)
    check_series(say, cases)
    check_moves_that_differ(say, cases)
    check_cleans(say, cases)
    return bool(failed)
