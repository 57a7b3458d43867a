"""Documents and pages for the tests: the program's own, and made worse on purpose."""
import base64
import copy
import functools
import html
import json
import pathlib
import re
import subprocess
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDER = ROOT / "build/browser"
PROGRAM = ROOT / "build/waferhand"

# As many commands as take an hour.
HOUR = """cell "%s/lua/layouts/paper.lua"
for i = 1, 460 do
  get("A", 1)   put("B", 2)
  get("B", 2)   put("A", 1)
end
"""

# A front end that does the same over and over: the first cycle comes from home.
CYCLES = """cell "%s/lua/layouts/efem.lua"
for i = 1, 8 do
  cycle()
  get("FOUP1", i)   put("FOUP2", i)
end
cycle()
"""

# The page's template, and what goes into it from elsewhere.
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
    """What stands in the place of @name@."""
    if name == "document":
        return pack(json.dumps(document, separators=(",", ":")))
    if name == "title":
        return html.escape(document.get("title", "Report"))
    path = pathlib.Path(LIBRARIES.get(name, PAGE / name))
    return path.read_text(encoding="utf-8").replace("</script", "<\\/script")


def assemble(document, path):
    """Writes the page that shows the document."""
    template = (PAGE / "report.html.in").read_text(encoding="utf-8")
    page = re.sub(r"@([A-Za-z.]+)@", lambda found: text_of(found[1], document), template)
    pathlib.Path(path).write_text(page, encoding="utf-8")


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


def page_of(document, name):
    """The page of a document that was changed here."""
    page = FOLDER / f"{name}.html"
    assemble(document, page)
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
