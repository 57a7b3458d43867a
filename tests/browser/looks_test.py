"""How it looks: contrast, narrow windows, light and dark, paper; the screenshots in build/browser are for people."""
import base64
import re
import unittest

import browser
import documents

# The lowest contrast of text that is easily read (WCAG 2, level AA).
CONTRAST = 4.5

# Every piece of visible text: what it says, its colour, and what is painted behind it, from the front to the back.
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
    # What shows the picture of the cell, or prints it.
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
        self.page.open(path)
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
        for dark in (False, True):
            for name, t in (("01_transfer", 2.4), ("04_scrape", 4.506), ("05_leak", 2.6)):
                self.open(name, t, dark=dark)
                self.assertEqual(self.page.js("return document.documentElement.dataset.theme"), "dark" if dark else "light")
                self.page.shoot(f"{name}_{'dark' if dark else 'light'}")
                self.check_contrast()
                self.check_canvas_colours()
                if name == "01_transfer":
                    self.whole()
                    self.page.shoot(f"whole_{'dark' if dark else 'light'}")

    def test_switch_outdoes_the_system(self):
        self.open("01_transfer", 0, dark=True)
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


if __name__ == "__main__":
    unittest.main()
