"""Documents that lack something, or are none: the part is left out with a word why, and nothing throws."""
import re
import unittest

import browser
import documents
from documents import PAGE, pack


def setUpModule():
    global page, document
    document, _ = documents.example("04_scrape")
    page = browser.plain()
    for each in (browser.common(), browser.plain()):
        each.resize(640, 480)  # many pages, which nobody looks at


def tearDownModule():
    for each in (browser.common(), browser.plain()):
        each.resize(*browser.SIZE)


def drawn(part):
    """If the scripts that draw with WebGL know a document's part by its name: only then it is left out there, too."""
    return any(re.search(rf"\b{part}\b", path.read_text()) for path in PAGE.glob("*.js") if "THREE." in path.read_text())


def pruned(keep_run):
    """As from a log of moves: neither commands nor figures."""
    made = documents.without(document, "run", "commands")
    for key in [key for key in made["run"] if key not in keep_run]:
        del made["run"][key]
    return made


class Missing(unittest.TestCase):
    def show(self, changed, name, part):
        """In the browser with WebGL if what was changed is drawn by it."""
        global page
        page = browser.shared(drawn(part))
        page.open(documents.page_of(changed, "missing_" + name))
        page.js("""if (Waferhand.shown) { [0, 1, 4.506, 5].forEach((t) => { Waferhand.clock.seek(t);
            Waferhand.clock.flush(); }); }""")
        page.settle()
        self.assertEqual(page.faults(), [], name)
        self.assertEqual(page.outside(), [], name)
        return page.js("return Array.from(document.querySelectorAll('.why'), (each) => each.textContent).join('\\n')")

    def test_one_track_at_a_time(self):
        words = {"clearances": "collisions were not checked", "vacuum": "The vacuum is not shown", "proximity": "came near",
                 "axes": "no positions of axes", "wafers": "who held what"}
        for kind in document["tracks"]:
            why = self.show(documents.without(document, "tracks", kind), "track_" + kind, kind)
            self.assertIn(words.get(kind, ""), why, kind)

    def test_one_part_at_a_time(self):
        words = {"scene": "holds no scene", "reproduce": "no command that reproduces", "run": "holds no commands"}
        for part in document:
            why = self.show(documents.without(document, part), "part_" + part, part)
            self.assertIn(words.get(part, ""), why, part)

    def test_log_without_commands(self):
        why = self.show(pruned(["wafers", "events", "hash"]), "log", "run")
        self.assertIn("a log of moves alone", why)
        self.assertIn("not hold what the time went into", why)
        self.assertIn("no verdict", page.text("#head"))

    def test_begins_later(self):
        """As a log whose first part is gone: times below its begin are not shown."""
        later = documents.without(document, "thinning")
        later["begin_s"] = 2
        self.show(later, "begin", "begin_s")
        page.key("Home")
        self.assertEqual(page.now(), 2)
        page.key("ArrowLeft")
        self.assertEqual(page.now(), 2)
        self.assertEqual(page.js("return Waferhand.clock.window[0]"), 2)
        self.assertEqual(page.js("return Number(document.getElementById('scrubber').min)"), 2000)

    def test_nothing_at_all(self):
        self.assertIn("holds no scene", self.show({}, "all", "scene"))

    def test_no_document(self):
        path = documents.page_of(document, "missing_json")
        text = path.read_text()
        begin = text.index('id="document">') + len('id="document">')
        page = browser.plain()
        for spoilt in (pack('{"format": 2,'), pack("{}")[:8], "<nothing>"):
            path.write_text(text[:begin] + spoilt + text[text.index("</script>", begin):])
            page.open(path)
            self.assertIn("cannot be read", page.text("#head"))
            self.assertEqual(page.faults(), [])

    def test_old_browser(self):
        """One that cannot unpack the document says so."""
        page = browser.plain()
        old = page.cdp("Page.addScriptToEvaluateOnNewDocument", source="delete window.DecompressionStream")
        page.open(documents.page_of(document, "missing_stream"))
        page.cdp("Page.removeScriptToEvaluateOnNewDocument", identifier=old["identifier"])
        self.assertIn("a browser of 2023 or later", page.text("#head"))

    def test_spoilt_scene(self):
        spoilt = documents.without(document, "scene", "accessors")
        self.assertIn("the scene cannot be read", self.show(spoilt, "scene_spoilt", "scene"))

    def test_text_is_text(self):
        """What looks like markup in a name or a message is shown, not run."""
        changed = documents.without(document, "thinning")
        changed["title"] = "<img src=x onerror=alert(1)></script><script>alert(2)</script>"
        changed["run"]["commands"][0]["text"] = "</script><b>bold</b>"
        changed["names"]["wafers"][0] = "<b>W</b>"
        self.show(changed, "markup", "names")
        self.assertIn("<img src=x", page.text("#head h1"))
        self.assertEqual(page.js("return document.querySelectorAll('#commands b, #measure b, h1 img').length"), 0)


if __name__ == "__main__":
    unittest.main()
