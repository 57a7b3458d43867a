"""Documents and pages for the tests: the program's own, and made worse on purpose."""
import base64
import copy
import functools
import html
import json
import pathlib
import re
import struct
import subprocess
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDER = ROOT / "build/browser"
PROGRAM = ROOT / "build/waferhand"

# Enough commands to fill an hour.
HOUR = """cell "%s/lua/layouts/paper.lua"
for i = 1, 460 do
  get("A", 1)   put("B", 2)
  get("B", 2)   put("A", 1)
end
"""

# A front end that repeats its cycle; only the first cycle begins at home.
CYCLES = """cell "%s/lua/layouts/efem.lua"
for i = 1, 8 do
  cycle()
  get("FOUP1", i)   put("FOUP2", i)
end
cycle()
"""

# The page's template, and the texts that are put into it.
PAGE = ROOT / "lib/report/page"
LIBRARIES = {
    "dygraph.min.css": "/usr/share/javascript/dygraphs/dygraph.min.css",
    "dygraph.min.js": "/usr/share/javascript/dygraphs/dygraph.min.js",
    "three.min.js": "/usr/share/javascript/three/three.min.js",
    "OrbitControls.js": "/usr/share/javascript/three/examples/js/controls/OrbitControls.js",
}


def pack(text):
    return base64.b64encode(zlib.compress(text.encode(), 9)).decode()


def text_of(name, document):
    """What stands in the place of @name@, in a page without an engine."""
    if name == "document":
        return pack(json.dumps(document, separators=(",", ":")))
    if name == "title":
        return html.escape(document.get("title", "Report"))
    if name in ("policy", "rerun"):
        return ""
    path = pathlib.Path(LIBRARIES.get(name, PAGE / name))
    if name.endswith(".in"):
        return fill(path.read_text(encoding="utf-8"), document)
    return path.read_text(encoding="utf-8").replace("</script", "<\\/script")


def fill(template, document):
    """A template with its names replaced; some stand for templates themselves."""
    return re.sub(r"@([A-Za-z._]+)@", lambda found: text_of(found[1], document), template)


def assemble(document, path, template="report.html.in"):
    """Writes the page that shows the document."""
    text = (PAGE / template).read_text(encoding="utf-8")
    pathlib.Path(path).write_text(fill(text, document), encoding="utf-8")


def report(script, *options):
    """Runs the program's report of a script. Commands with errors are part of some examples."""
    subprocess.run([PROGRAM, "report", script, *options], cwd=ROOT, check=True, capture_output=True)


@functools.lru_cache(maxsize=None)
def made(name):
    FOLDER.mkdir(parents=True, exist_ok=True)
    data, page = FOLDER / f"{name}.json", FOLDER / f"{name}.html"
    report(f"lua/examples/{name}.lua", "--data", data, "-o", page)
    return data.read_text(), page


def example(name):
    """An example's document, the caller's to change, and the page that the program makes of it."""
    text, page = made(name)
    return json.loads(text), page


# Name, robot, `at` of the gripper, stations A and B.
OTHER_ROBOTS = [
    ("scara", 'kind = "SCARA", links = { 350, 300 }, at = { 100, 0, 0 }, heading = 10, rail = {}, flip = { height = 12 }', 250,
     "at = { 850, 100, 900 }, rpy = { 0, 0, 10 }, rail = 100|at = { 100, 750, 900 }, rpy = { 0, 0, 90 }"),
    ("trz", 'kind = "TRZ", rail = {}, at = { 0, -100, 0 }', 0,
     "at = { 400, 600, 900 }, rpy = { 0, 0, 90 }, rail = 400|at = { -400, 600, 900 }, rpy = { 0, 0, 90 }, rail = -400"),
    ("arms", 'kind = "TRZ", arms = { { heading = 30 }, { heading = 180, height = 10 } }', 0,
     "at = { 700, 0, 900 }|at = { 0, 700, 900 }, rpy = { 0, 0, 90 }"),
    ("leaning", "tilt = {}, heading = 20", 0, "at = { 700, 250, 900 }, rpy = { 1.5, -2, 0 }|at = { 0, 700, 900 }, rpy = { 0, 0, 90 }"),
]


def of_robot(name, robot, place, stations):
    """The scene with its motion, and the page, of a run of another robot."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    layout, script, scene, page = (FOLDER / f"{name}{end}" for end in ("_cell.lua", ".lua", ".gltf", ".html"))
    a, b = stations.split("|")
    other = '{ name = "Other", arm = 2 },' if "arms" in robot else ""
    layout.write_text(f"""return {{ robot = {{ {robot} }}, grippers = {{ {other} {{ name = "EE", at = {{ {place}, 0, 0 }} }} }},
        stations = {{ A = {{ {a} }}, B = {{ {b} }} }}, wafers = {{ {{ name = "W", station = "A", slot = 1 }} }} }}""")
    script.write_text(f'cell "{layout.name}"\nget("A", 1) put("B", 1)\n' + ('flip "EE"' if "flip" in robot else ""))
    subprocess.run([PROGRAM, "run", script, "--gltf", scene, "--report", page], check=True, stdout=subprocess.DEVNULL)
    return json.loads(scene.read_text()), page


def numbers(scene, index, buffer):
    accessor = scene["accessors"][index]
    offset = accessor.get("byteOffset", 0) + scene["bufferViews"][accessor["bufferView"]].get("byteOffset", 0)
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
    flat = struct.unpack_from(f"<{width * accessor['count']}f", buffer, offset)
    return [flat[i * width:(i + 1) * width] for i in range(accessor["count"])]


def keyframes(scene, kind):
    """Index, time, place in metres and quaternion of each keyframe of the nodes of one kind."""
    buffer = base64.b64decode(scene["buffers"][0]["uri"].split(",")[1])
    found = {}
    for channel in scene["animations"][0]["channels"]:
        node = scene["nodes"][channel["target"]["node"]]
        if node.get("extras", {}).get("kind") == kind:
            sampler = scene["animations"][0]["samplers"][channel["sampler"]]
            for (t,), value in zip(numbers(scene, sampler["input"], buffer), numbers(scene, sampler["output"], buffer)):
                found.setdefault((node["extras"]["index"], t), {})[channel["target"]["path"]] = value
    return [(index, t, each["translation"], each["rotation"]) for (index, t), each in found.items()
            if len(each) == 2]


def page_of(document, name, template="report.html.in"):
    """The page of a document that was changed here."""
    page = FOLDER / f"{name}.html"
    assemble(document, page, template)
    return page


def hour():
    """The document and the page of an hour at 1 kHz."""
    script, data, page = FOLDER / "hour.lua", FOLDER / "hour.json", FOLDER / "hour.html"
    script.write_text(HOUR % ROOT)
    report(script, "--data", data, "-o", page)
    return json.loads(data.read_text()), page


@functools.lru_cache(maxsize=None)
def cycles():
    """The page of a run of cycles in a cell with walls, and its document's text."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    script, data, page = FOLDER / "cycles.lua", FOLDER / "cycles.json", FOLDER / "cycles.html"
    script.write_text(CYCLES % ROOT)
    report(script, "--data", data, "-o", page)
    return data.read_text(), page


def without(document, *path):
    """A copy that lacks one part."""
    made = copy.deepcopy(document)
    inner = made
    for key in path[:-1]:
        inner = inner[key]
    inner.pop(path[-1], None)
    return made
