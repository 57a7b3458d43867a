"""Random tools of one robot and one lot against the textbook's closed forms, worked out here anew: the cycle that is played is theirs, and
the program tells the same forms beside it, or why none holds.

    flow_textbook.py PROGRAM FOLDER FIRST COUNT     prints the seeds that differ; exit 1 if there are any"""
import itertools
import json
import pathlib
import random
import subprocess
import sys
from fractions import Fraction

KINDS = ("single", "clean", "differing", "dual", "dual_differing")
WAFERS = (100, 1000)    # if it takes longer to become steady, the second


def alike(draw, kind):
    """Times that are the same everywhere: the number, process, clean and kept places of each step, w, v and s."""
    w, v = draw.randint(1, 9), draw.randint(1, 9)
    steps = [[draw.randint(1, 3), draw.randint(5, 200), 0, 0] for _ in range(draw.randint(2, 4))]
    for step in steps if kind == "clean" else ():
        step[2] = draw.choice((0, draw.randint(10, 60)))
        step[3] = draw.randint(0, step[0] - 1) if draw.random() < 0.5 else 0
    return steps, w, v, 2 * w + v


def form_alike(kind, steps, w, v, s):
    n = len(steps)
    if kind == "dual":
        return max((n + 1) * (s + v), *(Fraction(p + s, m) for m, p, _, _ in steps))
    forms = [2 * (n + 1) * (w + v), *(Fraction(p + c + 2 * w, m) for m, p, c, _ in steps), *(Fraction(p + 4 * w + 3 * v, m - z) for m, p, _, z in steps)]
    for size in range(1, n + 1):
        for chosen in itertools.combinations(range(n), size):
            if all(b - a > 1 for a, b in zip(chosen, chosen[1:])):
                busy = (n + 1 - 2 * size) * (2 * v + 2 * w) + sum(2 * w + v + steps[i][2] for i in chosen)
                forms.append(Fraction(busy, 1 + sum(steps[i][3] for i in chosen)))
    return max(forms)


def differing(draw):
    """Picks, places, swaps by station and moves by pair: dictionaries by index, 0 to n + 1."""
    n = draw.randint(1, 5)
    g, q, s = ([draw.randint(1, 6) for _ in range(n + 2)] for _ in range(3))
    v = {(a, b): draw.randint(1, 9) for a in range(n + 2) for b in range(n + 2) if a != b}
    return n, g, q, [each + 8 for each in s], v, [0, *(draw.randint(5, 120) for _ in range(n)), 0]


def form_differing(kind, n, g, q, s, v, p):
    if kind == "dual_differing":
        return max(sum(s[1:n + 1]) + sum(v[i, i + 1] for i in range(n + 1)) + v[n + 1, 0] + g[0] + q[n + 1], *(p[i] + s[i] for i in range(1, n + 1)))
    busy = sum(g[i] + v[i, i + 1] + q[i + 1] for i in range(n + 1)) + sum(v[i + 1, i - 1] for i in range(1, n + 1)) + (v[1, n] if n > 1 else 0)
    return max(busy, *(p[i] + g[i] + v[i, i + 1] + q[i + 1] + v[i + 1, i - 1] + g[i - 1] + v[i - 1, i] + q[i] for i in range(1, n + 1)))


def names_of(n):
    return ["LA", *(f"P{i}" for i in range(1, n + 1)), "LB"]


def by_name(names, values):
    return "{ default = 1, " + ", ".join(f"{name} = {value}" for name, value in zip(names, values)) + " }"


def texts_alike(wafers, kind, steps, w, v):
    """The layout and the script."""
    stations, route, kept = [f"LA = {{ slots = {wafers} }}", f"LB = {{ slots = {wafers} }}"], [], []
    for number, (m, p, c, z) in enumerate(steps, 1):
        group = [f"P{number}{chr(97 + index)}" for index in range(m)]
        clean = f", clean = {{ after = 1, seconds = {c} }}" if c else ""
        stations += [f"{name} = {{ process = {p}{clean} }}" for name in group]
        route.append("{ " + ", ".join(f'"{name}"' for name in group) + " }")
        kept += [f"[{number}] = {z}"] if z else []
    robot = f"arms = {2 if kind == 'dual' else 1}, at = \"LA\", pick = {w}, place = {w}, move = {v}"
    return robot, stations, ", ".join([*route, '"LB"', f"partial = {{ {', '.join(kept)} }}"])


def texts_differing(wafers, kind, n, g, q, s, v, p):
    names = names_of(n)
    moves = ", ".join(f'["{names[a]}>{names[b]}"] = {value}' for (a, b), value in v.items())
    robot = (f"arms = {2 if kind == 'dual_differing' else 1}, at = \"LA\", pick = {by_name(names, g)}, place = {by_name(names, q)}, "
             f"swap = {by_name(names, s)}, move = {{ default = 1, {moves} }}")
    stations = [f"{names[i]} = {{ process = {p[i]} }}" if 0 < i <= n else f"{names[i]} = {{ slots = {wafers} }}" for i in range(n + 2)]
    return robot, stations, ", ".join(f'"{name}"' for name in names[1:])


def play(program, folder, wafers, kind, texts):
    """What the program tells of the flow; None, and why, if it fails."""
    robot, stations, route = texts
    (folder / "tool.lua").write_text(f"return {{ robots = {{ R = {{ kind = \"timed\", {robot} }} }}, stations = {{ {', '.join(stations)} }} }}\n", encoding="utf-8")
    rule = "swap" if "dual" in kind else "backward"
    (folder / "flow.lua").write_text(f'cell "tool.lua"\nflow {{ lots = {{ {{ wafers = {{ "LA", 1, {wafers} }} }} }}, routes = {{ A = {{ {route} }} }}, rule = "{rule}" }}\n',
                                     encoding="utf-8")
    ran = subprocess.run([program, "run", folder / "flow.lua", "--json"], capture_output=True, text=True, timeout=60, check=False)
    return (json.loads(ran.stdout)["flow"], None) if ran.returncode == 0 else (None, f"ended with {ran.returncode}: {ran.stderr}")


def look(program, folder, seed):
    """None if all is as it should be, else what is not."""
    draw, kind = random.Random(seed), KINDS[seed % len(KINDS)]
    drawn = differing(draw) if "differing" in kind else alike(draw, kind)
    expected = form_differing(kind, *drawn) if "differing" in kind else form_alike(kind, *drawn)
    for wafers in WAFERS:
        texts = texts_differing(wafers, kind, *drawn) if "differing" in kind else texts_alike(wafers, kind, *drawn[:3])
        told, failure = play(program, folder, wafers, kind, texts)
        if failure or told["cycle_s"] is not None:
            break
    if failure:
        return f"{kind}: {failure}"
    if told["cycle_s"] is None or abs(told["cycle_s"] - expected) > 1e-9:
        return f"{kind}: played {told['cycle_s']} ({told['no_cycle']}), the form gives {float(expected)}"
    if told["textbook"]["cycle_s"] is None or abs(told["textbook"]["cycle_s"] - expected) > 1e-9:
        return f"{kind}: told {told['textbook']}, the form gives {float(expected)}"
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
