"""How it looks: contrast, narrow windows, light and dark, paper; the screenshots in build/browser are for people."""
import base64
import json
import re
import unittest

import browser
import documents

# The lowest contrast of text that is easily read (WCAG 2, level AA).
CONTRAST = 4.5

# Every piece of visible text with its colour, and all that is painted behind it, from front to back.
TEXTS = """
const seen = (element) => { const box = element.getBoundingClientRect(), style = getComputedStyle(element);
    return box.width > 0 && box.height > 0 && style.visibility !== 'hidden' && !element.closest('[aria-hidden=true].aside'); };
const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT), found = [];
while (walker.nextNode()) {
    const element = walker.currentNode.parentElement, text = walker.currentNode.data.trim();
    if (!text || ['SCRIPT', 'STYLE', 'NOSCRIPT', 'OPTION'].includes(element.tagName) || !seen(element)) { continue; }
    const behind = [];
    for (let each = element; each; each = each.parentElement) { behind.push(getComputedStyle(each).backgroundColor); }
    found.push([text, getComputedStyle(element).color, behind]);
}
return found;
"""


def channels(colour):
    numbers = [float(x) for x in re.findall(r"[\d.]+", colour)]
    return numbers[:3], numbers[3] if len(numbers) > 3 else 1.0


def luminance(rgb):
    linear = [x / 255 / 12.92 if x <= 0.04045 * 255 else ((x / 255 + 0.055) / 1.055) ** 2.4 for x in rgb]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(a, b):
    light, dark = sorted((luminance(a), luminance(b)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


def painted(behind):
    """The colour that is seen behind a text."""
    result = (255, 255, 255)
    for colour in reversed(behind):
        rgb, alpha = channels(colour)
        result = [alpha * x + (1 - alpha) * y for x, y in zip(rgb, result)]
    return result


class Looks(unittest.TestCase):
    # Controls that show the picture of the cell or print it.
    drawn = ["test_light_and_dark", "test_narrow", "test_controls_do_not_overlap", "test_print", "test_printed_page",
             "test_views"]

    def setUp(self):
        self.page = browser.shared(self._testMethodName in self.drawn)

    def tearDown(self):
        self.assertEqual(self.page.faults(), [])
        self.page.cdp("Emulation.setEmulatedMedia", media="", features=[])
        self.page.resize(1440, 900)

    def open(self, name, t, size=(1440, 900), dark=False):
        _, path = documents.example(name)
        self.page.resize(*size)
        self.page.cdp("Emulation.setEmulatedMedia",
                      features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        self.page.fresh(path)
        self.page.seek(t)
        self.page.settle()

    def whole(self):
        """The window as high as the page."""
        height = self.page.js("return document.documentElement.scrollHeight")
        width = self.page.js("return innerWidth")
        self.page.resize(width, height)
        self.page.settle()

    def check_contrast(self):
        texts = self.page.js(TEXTS)
        self.assertGreater(len(texts), 100)
        poor = [(text, colour, behind[:3]) for text, colour, behind in texts
                if contrast(channels(colour)[0], painted(behind)) < CONTRAST]
        self.assertEqual(poor, [])
        lowest = min(contrast(channels(colour)[0], painted(behind)) for _, colour, behind in texts)
        print(f"{len(texts)} texts, the poorest contrast {lowest:.2f}")

    def check_canvas_colours(self):
        """What is drawn on canvases: text on bars and axes, curves and marks on what is behind them (3 to 1 for those)."""
        colours = self.page.js("""const names = ['panel', 'stage', 'ink', 'dim', 'on-series', 'bad', 'warn', 'accent', 's0', 's1',
            's2', 's3', 's4', 's5']; const probe = document.createElement('i'); document.body.append(probe);
            const made = {}; names.forEach((name) => { probe.style.color = `var(--${name})`;
            made[name] = getComputedStyle(probe).color; }); probe.remove(); return made""")
        rgb = {name: channels(colour)[0] for name, colour in colours.items()}
        for series in ("s0", "s1", "s2", "s3", "s4", "s5", "bad"):
            self.assertGreaterEqual(contrast(rgb["on-series"], rgb[series]), CONTRAST, series)
            self.assertGreaterEqual(contrast(rgb[series], rgb["panel"]), CONTRAST, series)
        for name in ("ink", "dim", "bad", "warn", "accent"):
            self.assertGreaterEqual(contrast(rgb[name], rgb["panel"]), CONTRAST, name)
            self.assertGreaterEqual(contrast(rgb[name], rgb["stage"]), CONTRAST, name)

    def test_light_and_dark(self):
        for name, t in (("01_transfer", 2.4), ("04_scrape", 4.506), ("05_leak", 2.6)):
            for dark in (False, True):
                self.open(name, t, dark=dark)
                self.assertEqual(self.page.js("return document.documentElement.dataset.theme"), "dark" if dark else "light")
                self.page.shoot(f"{name}_{'dark' if dark else 'light'}")
                self.check_contrast()
                self.check_canvas_colours()
                if name == "01_transfer":
                    self.whole()
                    self.page.shoot(f"whole_{'dark' if dark else 'light'}")

    def test_switch_outdoes_the_system(self):
        self.page.kept = None
        self.open("01_transfer", 0, dark=True)
        self.assertEqual(self.page.js("return document.documentElement.dataset.theme"), "dark")
        self.page.kept = None
        self.page.js("document.getElementById('theme').click()")
        self.assertEqual(self.page.js("return document.documentElement.dataset.theme"), "light")
        self.assertEqual(self.page.js("return getComputedStyle(document.body).backgroundColor"), "rgb(244, 246, 248)")

    def test_narrow(self):
        self.open("04_scrape", 4.506, size=(360, 740))
        self.assertLessEqual(self.page.js("return document.documentElement.scrollWidth"), 360)
        self.page.shoot("narrow")
        self.check_contrast()
        self.whole()
        self.page.shoot("narrow_whole")
        self.assertEqual(self.page.js("""return Array.from(document.querySelectorAll('button, select, figcaption, h2, dd'))
            .filter((each) => { const box = each.getBoundingClientRect(); return box.width > 0 && !each.closest('.scroll')
            && (box.left < 0 || box.right > 361); }).map((each) => each.outerHTML)"""), [])
        self.assertEqual(self.page.js("""const parts = [];
            Array.from(document.querySelectorAll('td'), (cell) => cell.firstChild).filter((each) => each && each.nodeType === 3)
                .forEach((text) => Array.from(text.data.matchAll(/[a-z]+/gi), (word) => { const range = document.createRange();
                    range.setStart(text, word.index); range.setEnd(text, word.index + word[0].length);
                    if (range.getClientRects().length > 1) { parts.push(word[0]); } }));
            return parts"""), [], "words in two")

    def test_controls_do_not_overlap(self):
        self.open("02_prealigner", 3, size=(1440, 900))
        for width in (360, 700, 1024, 1440, 1920):
            self.page.resize(width, 900)
            self.page.settle()
            self.check_overlaps(width)

    def check_overlaps(self, width):
        overlaps = self.page.js("""const boxes = Array.from(document.querySelectorAll('#toolbar button, #key, #transport button,'
            + '#transport select, #scrubber, .clock, #head button, h1, .verdict, .tile'), (each) =>
            [each.textContent.slice(0, 20), each.getBoundingClientRect()]), found = [];
            boxes.forEach(([a, x], i) => boxes.slice(i + 1).forEach(([b, y]) => { const high = innerHeight;
                if (x.left < y.right - 1 && y.left < x.right - 1 && x.top < y.bottom - 1 && y.top < x.bottom - 1
                    && x.bottom < high - 80 && y.bottom < high - 80) { found.push([a, b]); } }));
            return found""")
        self.assertEqual(overlaps, [], width)

    def test_everything_has_a_name(self):
        self.open("01_transfer", 0)
        nameless = self.page.js("""return Array.from(document.querySelectorAll('button, select, input, canvas, section, [role]'))
            .filter((each) => !(each.textContent.trim() || each.getAttribute('aria-label') || each.getAttribute('aria-hidden')
            || each.closest('label, [role=img]') || each.id === 'said' || each.querySelector('h2'))).map((each) => each.outerHTML.slice(0, 90))""")
        self.assertEqual(nameless, [])

    def test_focus_is_seen(self):
        self.open("01_transfer", 0)
        for _ in range(4):
            self.page.key("Tab")
        style = self.page.js("""const style = getComputedStyle(document.activeElement); return [document.activeElement.tagName,
            style.outlineStyle, parseFloat(style.outlineWidth)]""")
        self.assertEqual(style[:2], ["BUTTON", "solid"])
        self.assertGreaterEqual(style[2], 2)

    def test_print(self):
        self.open("04_scrape", 4.506, dark=True)
        pdf = base64.b64decode(self.page.cdp("Page.printToPDF", printBackground=True)["data"])
        (documents.FOLDER / "printed.pdf").write_bytes(pdf)
        self.assertTrue(pdf.startswith(b"%PDF"))
        pages = len(re.findall(rb"/Type\s*/Page\b", pdf))
        self.assertTrue(2 <= pages <= 12, pages)
        self.assertEqual(self.page.js("return document.documentElement.dataset.theme"), "dark")
        self.assertEqual(self.page.js("return document.querySelectorAll('#still').length"), 0)
        print(f"printed: {pages} pages, {len(pdf)} bytes")

    def test_printed_page(self):
        """What goes to paper, as a picture: black on white, the still, no buttons."""
        self.open("04_scrape", 4.506, size=(760, 1000), dark=True)
        self.page.cdp("Emulation.setEmulatedMedia", media="print", features=[])
        self.page.js("dispatchEvent(new Event('beforeprint'))")
        self.page.settle()
        self.whole()
        self.page.shoot("printed")
        self.assertEqual(self.page.js("""return ['#transport', '#toolbar', '#theme', '#copy'].map((each) =>
            getComputedStyle(document.querySelector(each)).display)"""), ["none"] * 4)
        self.assertEqual(self.page.js("return getComputedStyle(document.body).backgroundColor"), "rgb(255, 255, 255)")
        self.assertGreater(self.page.js("return document.getElementById('still').naturalWidth"), 300)
        self.check_contrast()
        self.page.js("dispatchEvent(new Event('afterprint'))")

    def test_views(self):
        self.open("04_scrape", 4.506)
        for key, name in (("2", "top"), ("3", "side"), ("4", "gripper")):
            self.page.key(key)
            self.page.key("n") if name == "top" else None
            self.page.key("f") if name == "gripper" else None
            self.page.shoot(f"view_{name}")


# The visible part of the cell: kind and number of all nodes that are shown, and the names among them.
SEEN = """const { view } = Waferhand.stage, seen = (object) => !object || (object.visible && seen(object.parent));
    return Object.values(view.named).filter(seen).map((object) => `${object.userData.node.kind} ${object.userData.node.index}`)"""
TAGS = "return Array.from(document.querySelectorAll('.tag:not([hidden])'), (tag) => [tag.className, tag.textContent])"


class Cell(unittest.TestCase):
    """Names, parts that are hidden, the trail, the section and shadows."""

    def setUp(self):
        text, path = documents.cycles()
        self.document = json.loads(text)
        self.page = browser.shared(True)
        self.page.resize(1440, 900)
        self.page.fresh(path)
        self.path = path

    def tearDown(self):
        self.assertEqual(self.page.faults(), [])
        self.page.resize(1440, 900)

    def pixels(self):
        """Of the picture of the cell as it is."""
        return self.page.js("return Waferhand.stage.view.still()")

    def test_names(self):
        self.page.seek(1.5)
        self.page.key("n")
        tags = dict(reversed(each) for each in self.page.js(TAGS))
        for name, kind in (("rear wall", "tag obstacle"), ("table", "tag obstacle"), ("FOUP1", "tag station"), ("ALIGN", "tag station")):
            self.assertEqual(tags.get(name), kind)
        boxes = self.page.js("""return Array.from(document.querySelectorAll('.tag:not([hidden])'), (tag) => {
            const box = tag.getBoundingClientRect(); return [box.left, box.top, box.right, box.bottom, tag.textContent] })""")
        for i, a in enumerate(boxes):
            for b in boxes[i + 1:]:
                self.assertFalse(a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3], (a[4], b[4]))
        self.page.shoot("names")

    def test_parts_are_hidden_and_shown(self):
        everything = self.page.js(SEEN)
        self.page.key("n")
        self.page.key("h")
        self.assertEqual(self.page.js("return document.activeElement.dataset.name"), "robot")
        self.page.js("document.querySelector('#parts [data-name=wafers]').focus()")
        self.page.key(" ", code="Space")
        self.assertEqual([each for each in everything if each not in self.page.js(SEEN)],
                         [f"wafer {i}" for i in range(25)])
        self.page.js("document.querySelector('#parts [data-name=\"obstacles.2\"]').click()")
        self.page.settle()
        names = [name for _, name in self.page.js(TAGS)]
        self.assertIn("table", names)
        self.assertNotIn("rear wall", names)
        self.assertFalse([name for name in names if name.startswith("W")])
        left, top, width, height = self.page.box("#canvas canvas")
        hits = self.page.js("""const [width, height, left, top] = arguments, kinds = new Set();
            for (let x = 0.05; x < 1; x += 0.1) { for (let y = 0.05; y < 1; y += 0.1) { Waferhand.stage.view.pick({
                clientX: left + x * width, clientY: top + y * height }).forEach((hit) => kinds.add(`${hit.kind} ${hit.i}`)); } }
            return Array.from(kinds)""", width, height, left, top)
        self.assertIn("obstacle 2", hits)
        self.assertFalse([hit for hit in hits if hit.startswith("wafer") or hit == "obstacle 1"])
        self.page.key("l")
        address = self.page.driver.current_url
        self.assertIn("&hide=wafers,obstacles.2", address)
        self.page.driver.get("about:blank")
        self.page.driver.get(address)
        self.page.wait("return performance.getEntriesByName('complete').length > 0")
        self.assertNotIn("wafer 3", self.page.js(SEEN))
        self.assertNotIn("obstacle 1", self.page.js(SEEN))
        self.assertFalse(self.page.js("return document.querySelector('#parts [data-name=wafers]').checked"))
        self.page.js("document.querySelector('#parts button').click()")
        self.assertEqual(self.page.js(SEEN), everything)
        self.page.js("location.hash = 'hide=nothing,stations.99,robot'")
        self.page.settle()
        self.assertEqual(self.page.js("return Array.from(Waferhand.parts.hidden)"), ["robot"])
        self.assertFalse([each for each in self.page.js(SEEN) if each in ("base 0", "link 2", "gripper 0")])
        self.assertIn("gripper 1", self.page.js(SEEN))

    def test_trail(self):
        """It is where the gripper was in the last three seconds, the oldest point the faintest."""
        t = self.document["run"]["steady_cycle"]["begin_s"] + 1.5
        self.page.seek(t)
        self.page.key("r")
        points = self.page.js("return Waferhand.trail.points(Waferhand.shown, 0, arguments[0])", t)
        self.assertTrue(140 < len(points) <= self.page.js("return Waferhand.trail.most"))
        self.assertEqual([points[0]["age"], points[0]["dot"]], [0, False])
        for point in points[::10]:
            pose = self.page.js("return Waferhand.robot.gripper(Waferhand.shown.tracks, 0, arguments[0])", t - 3 * point["age"])
            for found, wanted in zip(point["r"], pose["r"], strict=True):
                self.assertAlmostEqual(found, wanted, delta=1e-6)
        ages = [point["age"] for point in points]
        self.assertEqual(ages, sorted(ages))
        self.assertTrue(0.98 < ages[-1] <= 1)
        self.assertAlmostEqual(len([point for point in points if point["dot"]]), 30, delta=1)
        laid = self.page.js("""const [trail, ...others] = Waferhand.stage.view.trails, [line] = trail.path.children;
            return [others.length, trail.path.visible, line.geometry.drawRange.count,
                Array.from(line.geometry.attributes.position.array.slice(0, 3))]""")
        self.assertEqual(laid[:3], [0, True, len(points)])
        for found, wanted in zip(laid[3], points[0]["r"], strict=True):
            self.assertAlmostEqual(1000 * found, wanted, delta=1e-3)
        self.page.shoot("trail")
        self.page.seek(0)
        self.assertEqual(len(self.page.js("return Waferhand.trail.points(Waferhand.shown, 0, 0)")), 2)

    def test_section(self):
        whole = self.pixels()
        self.page.key("x")
        slider = "document.querySelector('#section input[type=range]')"
        at = self.page.js(f"return Number({slider}.value)")
        self.assertNotEqual(self.pixels(), whole)
        self.page.js(f"{slider}.focus()")
        now = self.page.now()
        self.page.key("ArrowRight")
        self.assertEqual([self.page.js(f"return Number({slider}.value)"), self.page.now()], [at + 1, now])
        self.page.js("document.querySelector('#section input[value=z]').click()")
        self.page.js(f"{slider}.value = 905; {slider}.dispatchEvent(new Event('input'))")
        self.page.settle()
        self.page.shoot("section")
        planes = self.page.js("""const found = new Set(); Waferhand.stage.view.scene.traverse((child) => { if (child.userData.part) {
            child.material.clippingPlanes.forEach((plane) => found.add(JSON.stringify([plane.normal.toArray(), plane.constant]))); } });
            return Array.from(found)""")
        self.assertEqual([json.loads(each) for each in planes], [[[0, 0, -1], 0.905]])
        left, top, width, height = self.page.box("#canvas canvas")
        hits = self.page.js("""const [width, height, left, top] = arguments, made = [];
            for (let x = 0.05; x < 1; x += 0.05) { for (let y = 0.05; y < 1; y += 0.05) { made.push(...Waferhand.stage.view.pick({
                clientX: left + x * width, clientY: top + y * height })); } } return made.map((hit) => hit.at[2])""",
                            width, height, left, top)
        self.assertTrue(len(hits) > 20 and max(hits) <= 905, (len(hits), max(hits)))
        self.page.key("l")
        self.assertIn("&cut=z,905,-1", self.page.driver.current_url)
        self.page.js("location.hash = 'cut=y,-260,1'")
        self.page.settle()
        self.assertEqual(self.page.js("return Waferhand.section.plane()"), {"axis": 1, "at": -260, "keep": 1})
        for wrong in ("cut=w,1,1", "cut=x,,1", "cut=x,1,0", "cut=x", ""):
            self.page.js("location.hash = arguments[0]", wrong)
            self.page.settle()
            self.assertIsNone(self.page.js("return Waferhand.section.plane()"), wrong)
        self.page.js("Waferhand.clock.seek(0); Waferhand.clock.flush()")
        self.page.key("x")
        self.page.key("x")
        self.page.seek(now)
        self.assertEqual(self.pixels(), whole)

    def test_shadows(self):
        with_ = self.pixels()
        self.page.key("s")
        without = self.pixels()
        self.assertNotEqual(with_, without)
        self.assertEqual(self.page.js("return document.querySelector('[data-name=shadows]').getAttribute('aria-pressed')"), "false")
        self.page.key("s")
        self.assertEqual(self.pixels(), with_)

    def test_without_webgl(self):
        """Parts, names and the trail are in drawings, too; there is no section and no shadow."""
        page = browser.shared(False)
        page.resize(1440, 900)
        page.fresh(self.path)
        self.assertEqual(page.js("return Array.from(document.querySelectorAll('#toolbar .group button'), (each) => each.dataset.name)"),
                         ["whole", "top", "side", "gripper", "names", "frames", "trail", "parts", "link", "picture"])
        still = "return Waferhand.stage.view.still()"
        pictures = [page.js(still)]
        for key in "rn":
            page.key(key)
            pictures.append(page.js(still))
        for key in ("x", "s"):
            page.key(key)
            self.assertEqual(page.js(still), pictures[-1])
        page.js("Waferhand.parts.set(['obstacles'])")
        pictures.append(page.js(still))
        self.assertEqual(len(set(pictures)), 4)
        page.shoot("drawing_parts")
        self.assertEqual(page.faults(), [])

    def test_narrow(self):
        self.page.resize(360, 740)
        for key in "hxn":
            self.page.key(key)
        self.page.js("document.querySelector('#parts details').open = true")
        self.page.settle()
        self.page.js("document.getElementById('stage').scrollIntoView()")
        self.page.shoot("narrow_parts")
        self.assertLessEqual(self.page.js("return document.documentElement.scrollWidth"), 360)
        self.assertEqual(self.page.js("""return Array.from(document.querySelectorAll('#toolbar button, .sheet, .sheet label'), (each) =>
            each.getBoundingClientRect()).filter((box) => box.width > 0 && (box.left < 0 || box.right > 361)).length"""), 0)


if __name__ == "__main__":
    unittest.main()
