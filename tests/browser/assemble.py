"""Puts a page together from the template and a document, as the program does: for documents made for a test."""
import base64
import html
import json
import pathlib
import re
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
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
