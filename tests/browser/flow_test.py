"""The page of a flow: its figures against the program's, the lanes, a wafer's history, and how it looks."""
import copy
import json
import subprocess
import unittest

import browser
import documents
from documents import FOLDER, PROGRAM, ROOT

# All bars of the lanes: lane, whose it is, kind, from, to, wafer.
LANES = """return Waferhand.flow.model.lanes().map((lane) => [lane.name, lane.of, lane.bars.map((bar) =>
    [bar.kind, bar.from, bar.to, bar.wafer || null, bar.level === undefined ? null : bar.level])])"""

# By class of the program's shares the kinds of bars that are it. A blade that picks is in the place and in the robot's lane.
STATIONS = {"process": ["process"], "blocked": ["waits"], "handled": ["handled"], "clean": ["clean"], "pump": ["pump", "vent"], "down": ["down"]}
ROBOTS = {"pick": ["pick"], "place": ["place"], "swap": ["swap"], "loaded_way": ["carry"], "empty_way": ["way"]}

LOCKS, RULE, COATER = "33_lots_and_locks", "31_own_rule", "34_two_layers"

NAMES = """cell "%s/lua/layouts/timed.lua"
flow { lots = { { name = "<img src=x onerror=alert(1)>", wafers = { "LP1", 1, 2 }, back = "LP1" } }, routes = { ["<b>R</b>"] = { "ETCH" } } }
"""


def many():
    """A thousand wafers through two locks' tool."""
    layout, script, page = FOLDER / "many_cell.lua", FOLDER / "many.lua", FOLDER / "many.html"
    layout.write_text("""return { robots = { R = { kind = "timed", arms = 2, pick = 3, place = 3, move = 2, at = "A" } }, stations = {
        A = { slots = 1000 }, B = { slots = 1000 }, P1 = { process = 60, window = 30 }, P2 = { process = 50, window = 9 }, P3 = { process = 55 } } }""")
    script.write_text('cell "many_cell.lua"\nflow { lots = { { wafers = { "A", 1, 1000 } } }, routes = { X = { "P1", "P2", "P3", "B" } }, rule = "swap", late = "tell" }\n')
    subprocess.run([PROGRAM, "run", script, "-o", page], check=True, stdout=subprocess.DEVNULL)
    return page


class Flow(unittest.TestCase):
    def setUp(self):
        self.page = browser.plain()

    def tearDown(self):
        self.assertEqual(self.page.faults(), [])
        self.assertEqual(self.page.outside(), [])
        self.page.cdp("Emulation.setEmulatedMedia", media="", features=[])
        self.page.resize(1440, 900)

    def open(self, name):
        document, path = documents.example(name)
        self.page.open(path)
        return document["run"]["flow"]

    def tiles(self):
        return self.page.js("""return Array.from(document.querySelectorAll('.tile'), (tile) => [tile.children[1].textContent,
            tile.children[0].textContent])""")

    def test_rate_and_limit_come_first(self):
        flow = self.open(RULE)
        tiles = self.tiles()
        self.assertEqual(tiles[0], ["wafers per hour, steady", f"{flow['per_hour']:.1f}"])
        self.assertEqual(tiles[1], ["limits it: the busiest", flow["busiest"]["of"]])
        self.assertIn(["left of a window, at least", f"{flow['gaps'][0]['gap_s']:.3f}\u00a0s"], tiles)
        self.assertIn("rule is neither backward nor swap", self.page.text(".tiles"))
        flow = self.open(LOCKS)
        self.assertIn(["left of a window, at least", f"\u2212{-flow['gaps'][0]['gap_s']:.3f}\u00a0s"], self.tiles())
        self.assertIn("too few wafers", self.page.text(".tiles"))

    def test_shares_add_up(self):
        flow = self.open(LOCKS)
        rows = self.page.js("""return Array.from(document.querySelectorAll('.share-row'), (row) => [row.children[0].textContent,
            Array.from(row.querySelectorAll('.piece'), (piece) => [piece.title, parseFloat(piece.style.width)])])""")
        self.assertEqual([name for name, _ in rows], [each["name"] for each in flow["stations"] + flow["robots"]])
        for (name, pieces), told in zip(rows, flow["stations"] + flow["robots"]):
            self.assertAlmostEqual(sum(width for _, width in pieces), 100, delta=0.001, msg=name)
            for (title, width), share in zip(pieces, sorted_shares(told, [title for title, _ in pieces])):
                self.assertAlmostEqual(width, 100 * share, delta=0.001, msg=f"{name}: {title}")

    def test_lanes_are_what_the_program_counts(self):
        """The page makes its lanes of visits; their lengths are the shares that the engine sums by itself."""
        for name in (LOCKS, RULE, COATER):
            flow = self.open(name)
            lanes, slots = self.page.js(LANES), {each["name"]: each["slots"] for each in flow["stations"]}
            for lane, _, bars in lanes:
                self.assertEqual(bars, sorted(bars, key=lambda bar: bar[1]))
                self.assertTrue(all(before[2] <= bar[1] + 1e-9 for before, bar in zip(bars, bars[1:])), lane)
            for told, classes in [(each, STATIONS) for each in flow["stations"] if slots[each["name"]] == 1] + [(each, ROBOTS) for each in flow["robots"]]:
                bars = [bar for _, of, found in lanes if of == told["name"] for bar in found]
                for kind, kinds in classes.items():
                    length = sum(end - begin for what, begin, end, _, _ in bars if what in kinds)
                    if kind == "swap":
                        length /= 2     # both arms are in it
                    self.assertAlmostEqual(length, told["shares"][kind] * flow["counted_s"], delta=1e-5, msg=f"{name}: {told['name']}, {kind}")
            full = [bar for _, of, found in lanes if of == "LP1" for bar in found]
            self.assertTrue(full and all(0 < level <= 1 for *_, level in full))

    def click_bar(self, lane, wafer):
        """The pointer on the first process of the wafer in the lane."""
        left, top, width, _ = self.page.box("#gantt canvas")
        x, row = self.page.js("""const lanes = Waferhand.flow.model.lanes(), row = lanes.findIndex((each) => each.name === arguments[0]);
            const bar = lanes[row].bars.find((each) => each.wafer === arguments[1] && each.kind === 'process');
            const [from, to] = Waferhand.clock.window, gutter = Waferhand.axis.gutter() - 9;
            return [gutter + (arguments[2] - gutter - 10) * ((bar.from + bar.to) / 2 - from) / (to - from), row]""", lane, wafer, width)
        self.page.click(left + x, top + 26 * row + 13)
        self.page.settle()

    def test_a_click_opens_the_wafer(self):
        flow = self.open(LOCKS)
        self.click_bar("PM2", "A.18")
        self.assertEqual(self.page.js("return document.getElementById('which').value"), "A.18")
        visit = next(each for each in flow["visits"] if each["wafer"] == "A.18" and each["to"] == "PM2")
        self.assertTrue(visit["process_s"] < self.page.now() < visit["done_s"])
        text = self.page.text("#wafer table")
        for seen in ("PM2 1: process", "PM2 1: waits", "is picked out of LP1 18", "LP1 18: is at its end"):
            self.assertIn(seen, text)
        self.assertIn("PM2: A.18 process", self.page.text(".readout"))
        self.page.js("document.getElementById('which').value = ''; document.getElementById('which').dispatchEvent(new Event('change'))")
        self.assertNotIn("process", self.page.text("#wafer"))

    def test_keys_go_from_bar_to_bar(self):
        self.open(COATER)
        self.page.js("document.querySelector('#gantt canvas').focus()")
        said = []
        for key in ("ArrowRight", "ArrowDown", "ArrowRight", "ArrowDown", "ArrowLeft", "ArrowUp", "End", "Home"):
            self.page.key(key)
            said.append(self.page.text("#said"))
        self.assertTrue(said[0].startswith("LP1: 25 of 25 places full"), said)
        self.assertTrue(said[2].startswith("COAT: A.1 process, 8.000 to 48.000"), said)
        self.assertTrue(said[4].startswith("BAKE 1: A.1 "), said)
        self.assertTrue(said[5].startswith("COAT: ") and said[6].startswith("COAT: A.25 ") and said[7].startswith("COAT: A.1 "), said)
        self.page.key("ArrowDown")
        self.page.key("Enter", code="Enter")
        self.assertNotEqual(self.page.js("return document.getElementById('which').value"), "")
        self.page.js("document.activeElement.blur()")
        self.page.key("c", code="KeyC")
        low, high = self.page.js("return Waferhand.clock.window")
        flow = self.page.js("return Waferhand.shown.run.flow")
        self.assertAlmostEqual(high - low, flow["cycle_s"] * flow["period"], places=6)
        self.page.key("0", code="Digit0")
        self.assertEqual(self.page.js("return Waferhand.clock.window"), [0, flow["counted_s"]])

    def test_tables(self):
        flow = self.open(LOCKS)
        for section, count in (("gaps", len(flow["gaps"])), ("waits", len(flow["waits"])), ("path", len(flow["path"])), ("flow-wafers", 50),
                               ("flow-stays", len(flow["visits"]))):
            self.assertEqual(self.page.js("return document.querySelectorAll(`#${arguments[0]} tbody tr`).length", section), count, section)
        self.assertIn("gains = true", self.page.text("#gains"))
        self.assertIn("there are several robots", self.page.text("#cycles"))
        self.assertIn("1 of 50 stays in PM1, PM2, PM3, PM4 is beyond the window.", self.page.text("#gaps"))

    def test_names_are_text(self):
        script, page = FOLDER / "names.lua", FOLDER / "names.html"
        script.write_text(NAMES % ROOT)
        subprocess.run([PROGRAM, "run", script, "-o", page], check=True, stdout=subprocess.DEVNULL)
        self.page.open(page)
        self.page.js("Waferhand.flowWafer.show('<img src=x onerror=alert(1)>.1')")
        self.assertEqual(self.page.js("return document.querySelectorAll('img, #flow b, #tables b').length"), 0)
        self.assertIn("<img src=x onerror=alert(1)>.1", self.page.text("#flow-wafers"))
        self.assertIn("route <b>R</b>", self.page.text("#wafer"))

    def test_a_thousand_wafers(self):
        work, taken = self.page.opened(many(), 3, 4000)
        self.assertLess(work, 3)
        self.assertLess(taken, 4000)
        self.assertIn("998 of 2000 stays in P1, P2 are beyond the window. The 20 nearest are listed.", self.page.text("#gaps"))

    def test_a_day_of_a_tool(self):
        """Some 1,400 wafers: a small page that opens and zooms without a pause; what lies too close is told, and is there in a zoom."""
        page = FOLDER / "day.html"
        subprocess.run([PROGRAM, "run", ROOT / "tests/bench/week.lua", "--set", "seconds=86400", "-o", page], check=True, stdout=subprocess.DEVNULL)
        self.assertLess(page.stat().st_size, 1e6)
        work, _ = self.page.opened(page, 3, 6000)
        self.assertLess(work, 3)
        spent = self.page.js("""return [[0, 86400], [1000, 4600], [43200, 43500], [0, 86400]].map((times) => {
            const begin = performance.now();
            Waferhand.clock.setWindow(...times);
            if (Waferhand.clock.flush) { Waferhand.clock.flush(); }
            return performance.now() - begin;
        })""")
        self.assertLess(max(spent), 500)
        self.page.settle()
        self.assertIn("A bar is as high as its share of the time", self.page.text("#gantt"))
        self.page.js("Waferhand.clock.setWindow(43200, 43500)")
        self.page.settle()
        self.assertFalse(self.page.js("return Array.from(document.querySelectorAll('#gantt .banded')).some((note) => !note.hidden)"))

    def test_parts_that_lack(self):
        document, _ = documents.example(COATER)
        for name in ("gaps", "visits", "lots", "textbook", "busiest", "ways", "windows", "doings"):
            self.page.open(documents.page_of(documents.without(document, "run", "flow", name), f"lacks_{name}", "flow.html.in"))
            self.assertEqual(self.page.faults(), [], name)
            self.assertNotIn("cannot be shown", self.page.js("return Array.from(document.querySelectorAll('.why'), (each) => each.textContent).join()"))

    def test_in_a_page_with_a_scene(self):
        """A document with both: the flow comes first, and a click leads the scene as well."""
        document, _ = documents.example("01_transfer")
        flow = copy.deepcopy(documents.example(COATER)[0]["run"]["flow"])
        document["run"]["flow"] = flow
        self.page.open(documents.page_of(document, "flow_and_scene"))
        self.assertEqual(self.page.js("""return document.getElementById('flow').compareDocumentPosition(document.getElementById('stage'))
            & Node.DOCUMENT_POSITION_FOLLOWING"""), 4)
        self.assertEqual([name for name, _ in self.tiles() if name.startswith("wafers per hour")], ["wafers per hour, steady"])
        self.page.js("document.querySelector('#gantt canvas').focus()")
        for key in ("ArrowRight", "ArrowDown", "ArrowRight"):
            self.page.key(key)
        self.page.key("Enter", code="Enter")
        self.assertGreater(self.page.now(), 0)

    def test_looks(self):
        import looks_test
        looks = looks_test.Looks()
        looks.page = self.page
        _, path = documents.example(LOCKS)
        for dark, size in ((False, (1440, 900)), (True, (1440, 900)), (False, (360, 740))):
            self.page.resize(*size)
            self.page.cdp("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
            self.page.open(path)
            self.page.js("Waferhand.flowWafer.show('A.18')")
            self.page.shoot(f"flow_{size[0]}_{'dark' if dark else 'light'}")
            looks.check_contrast()
            looks.check_canvas_colours()
            self.assertLessEqual(self.page.js("return document.documentElement.scrollWidth"), size[0])
        self.page.js("dispatchEvent(new Event('beforeprint'))")
        self.assertTrue(self.page.js("return Array.from(document.querySelectorAll('#flow details')).every((each) => each.open)"))
        self.page.js("dispatchEvent(new Event('afterprint'))")
        self.assertFalse(self.page.js("return document.querySelector('#flow details').open"))


def sorted_shares(told, titles):
    """The shares of a row in the order of its pieces: by their texts."""
    texts = {"blocked": "done, and waits", "handled": "a blade or the door", "stored": "holds wafers", "loaded_way": "moves loaded",
             "empty_way": "moves empty", "pick": "picks", "place": "places", "swap": "swaps", "waits_wafer": "waits for a wafer",
             "waits_place": "waits for a place", "waits_pump": "waits for a pump"}
    named = {texts.get(name, name): share for name, share in told["shares"].items()}
    return [named[title.rsplit(" ", 1)[0]] for title in titles]


if __name__ == "__main__":
    unittest.main()
