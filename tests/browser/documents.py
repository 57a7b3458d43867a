"""Documents and pages for the tests: the program's own, and made worse or longer on purpose."""
import copy
import json
import pathlib
import subprocess

from assemble import ROOT, assemble

FOLDER = ROOT / "build/browser"
PROGRAM = ROOT / "build/waferhand"

# As many commands as take an hour.
HOUR = """cell "%s/lua/layouts/paper.lua"
for i = 1, 460 do
  get("A", 1)   put("B", 2)
  get("B", 2)   put("A", 1)
end
"""
POINTS = 60000


def report(script, *options):
    """Runs the program's report of a script. Commands with errors are part of some examples."""
    subprocess.run([PROGRAM, "report", script, *options], cwd=ROOT, check=True, capture_output=True)


def example(name):
    """An example's document, and the page that the program makes of it."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    data, page = FOLDER / f"{name}.json", FOLDER / f"{name}.html"
    report(f"lua/examples/{name}.lua", "--data", data, "-o", page)
    return json.loads(data.read_text()), page


def page_of(document, name):
    """The page of a document that was changed here."""
    page = FOLDER / f"{name}.html"
    assemble(document, page)
    return page


def denser(times, values, width, factor):
    """The same track with `factor` points for one."""
    t, v = [], []
    for i in range(len(times) - 1):
        for k in range(factor):
            share = k / factor
            t.append(times[i] + share * (times[i + 1] - times[i]))
            here, there = values[width * i:width * (i + 1)], values[width * (i + 1):width * (i + 2)]
            v += [a if k == 0 or a is None or b is None else a + share * (b - a) for a, b in zip(here, there)]
    return t + times[-1:], v + values[-width:]


def densify(track, keys):
    """Up to POINTS points in a track; quaternions are not renormalised, which changes no cost."""
    factor = max(POINTS // max(len(track["t"]), 1), 1)
    if len(track["t"]) > 2 and factor > 1:
        times = track["t"]
        for key, width in keys:
            track["t"], track[key] = denser(times, track[key], width, factor)


def hour():
    """An hour at 1 kHz, with as many points a track as thinning gives at most."""
    script, data = FOLDER / "hour.lua", FOLDER / "hour.json"
    script.write_text(HOUR % ROOT)
    report(script, "--data", data)
    document = json.loads(data.read_text())
    tracks = document["tracks"]
    for track in tracks["grippers"] + tracks["links"]:
        densify(track, [("r", 3), ("q", 4)])
    for track in tracks["axes"]:
        densify(track, [("v", 1)])
    for track in tracks["proximity"]:
        wafers, times = track.pop("wafer"), track["t"]
        densify(track, [("dr_proj_z", 1), ("dr_proj_xy", 1), ("n1_proj_n2", 1)])
        track["wafer"] = [wafers[min(i * len(times) // len(track["t"]), len(wafers) - 1)] for i in range(len(track["t"]))]
    return document


def without(document, *path):
    """A copy that lacks one part."""
    made = copy.deepcopy(document)
    inner = made
    for key in path[:-1]:
        inner = inner[key]
    inner.pop(path[-1], None)
    return made
