"""Documents and pages for the tests: the program's own, and made worse on purpose."""
import copy
import functools
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


def without(document, *path):
    """A copy that lacks one part."""
    made = copy.deepcopy(document)
    inner = made
    for key in path[:-1]:
        inner = inner[key]
    inner.pop(path[-1], None)
    return made
