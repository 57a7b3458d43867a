"""A page in headless Chromium, read from disk, with what it logs and asks for kept."""
import atexit
import base64
import functools
import json
import time

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common import utils

from documents import FOLDER

# Root in a container has no sandbox. No name is looked up, whatever the page asks for. The driver talks to the browser through
# a pipe; a port would make it look up the address of localhost.
FLAGS = ["--headless=new", "--remote-debugging-pipe", "--no-sandbox", "--disable-dev-shm-usage", "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
         "--force-device-scale-factor=1", "--hide-scrollbars",
         # Software GL is used for WebGL only: for text and plots it would take more time than for the cell.
         "--disable-gpu-rasterization", "--disable-accelerated-2d-canvas"]
WEBGL = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--webgl-antialiasing-mode=none"]
NO_WEBGL = ["--disable-gpu", "--disable-webgl", "--disable-3d-apis"]

SIZE = (1440, 900)

# Resets a page to its state after opening, as far as its own functions can, and returns the state it then has.
RESET = """
const W = window.Waferhand;
if (!W || !W.shown || !W.stage || !W.stage.view || !W.plots || !W.measure) { return null; }
W.clock.pause();
W.clock.setSpeed(1);
['names', 'frames', 'trail', 'shadows'].forEach((name) => W.stage.choose(name, name === 'shadows'));
if (!W.stage.parts.hidden) { W.stage.list(); }
if (W.section.on) { W.stage.section(); }
W.parts.set([]);
W.stage.shown = '';
W.stage.rider = 0;
W.stage.show('whole');
W.measure.arm(false);
W.clock.setWindow(...W.cycle.opened);
W.clock.seek(arguments[0] === null ? W.clock.now : arguments[0]);
document.activeElement.blur();
history.replaceState(null, '', location.pathname);
W.clock.flush();
scrollTo(0, 0);
const rig = W.stage.view.rig, rounded = (values) => values.map((value) => value.toFixed(6));
const controls = document.querySelectorAll('select, input');
return JSON.stringify([location.href, W.clock.now, W.clock.window, W.clock.speed, document.documentElement.dataset.theme, W.stage.options,
    rig ? rounded([...rig.camera.position.toArray(), ...rig.controls.target.toArray()]) : 0, Array.from(W.parts.hidden), W.section.text(),
    W.measure.armed, document.activeElement.tagName, document.getElementById('help').open,
    Array.from(document.querySelectorAll('[aria-pressed]'), (each) => each.getAttribute('aria-pressed')),
    Array.from(controls, (each) => each.type === 'checkbox' || each.type === 'radio' ? each.checked : each.value),
    Array.from(document.querySelectorAll('details'), (each) => each.open), document.getElementById('copy')?.textContent,
    /native/.test(HTMLAnchorElement.prototype.click), W.faults.length]);
"""


class Driver(Service):
    """chromedriver by its address: a bare machine may know no name, not even localhost."""

    @property
    def service_url(self):
        return f"http://127.0.0.1:{self.port}"

    def is_connectable(self):
        return utils.is_connectable(self.port, "127.0.0.1")


class Browser:
    """One browser; `open` shows another page in it."""

    def __init__(self, flags=None, size=SIZE):
        options = webdriver.ChromeOptions()
        for flag in FLAGS + (WEBGL if flags is None else flags):
            options.add_argument(flag)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        self.driver = webdriver.Chrome(service=Driver("/usr/bin/chromedriver"), options=options)
        self.driver.set_script_timeout(120)
        self.requests = []
        self.errors = []
        self.kept = None
        self.resize(*size)

    def close(self):
        self.driver.quit()

    def resize(self, width, height):
        self.cdp("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=False)

    def cdp(self, command, **arguments):
        return self.driver.execute_cdp_cmd(command, arguments)

    def js(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def settle(self):
        """Lets two frames pass."""
        self.driver.execute_async_script(
            "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 30)))")

    def open(self, path):
        """Shows a page, and waits until all of it is there."""
        self.visit(path.as_uri())

    def visit(self, url):
        """Likewise a page that a server gives."""
        self.drain()
        self.requests, self.errors, self.kept = [], [], None
        self.driver.get(url)
        self.wait("return performance.getEntriesByName('complete').length > 0")
        self.wait("return !(Waferhand.plots && Waferhand.plots.panels.some((panel) => !panel.graph))")
        self.settle()

    def fresh(self, path):
        """Shows a page as it is when it was opened: the one that is shown, if it can be put back to that, else it is opened."""
        if self.kept and self.kept[0] == path and self.js(RESET, self.kept[1]) == self.kept[2]:
            self.settle()
            return
        self.open(path)
        now = self.now()
        self.kept = (path, now, self.js(RESET, now))
        self.settle()

    def busy(self):
        """Processor time of the page, s."""
        return {each["name"]: each["value"] for each in self.cdp("Performance.getMetrics")["metrics"]}["TaskDuration"]

    def opened(self, path, work, interactive):
        """Shows a page: its own processor time, s, and when it took input, ms after navigation; once more if that is beyond the limits."""
        self.cdp("Performance.enable", timeDomain="threadTicks")
        for _ in range(2):
            # The previous page may still draw (in software here). Its time is not counted.
            self.driver.get("about:blank")
            self.settle()
            was, now = -1, self.busy()
            for _ in range(20):
                if now - was < 0.01:
                    break
                self.settle()
                was, now = now, self.busy()
            self.open(path)
            found = self.busy(), self.taken()
            if found[0] < work and found[1] < interactive:
                break
        return found

    def taken(self):
        return self.js("return performance.getEntriesByName('interactive')[0].startTime")

    def wait(self, condition, seconds=60):
        """Until a script returns true."""
        end = time.monotonic() + seconds
        while not self.js(condition):
            if time.monotonic() > end:
                raise AssertionError("still not so: " + condition)
            time.sleep(0.02)

    def seek(self, t):
        self.js("Waferhand.clock.seek(arguments[0]); Waferhand.clock.flush()", t)

    def drain(self):
        """Takes over what was logged since."""
        for entry in self.driver.get_log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                self.requests.append(message["params"]["request"]["url"])
        self.errors += [entry["message"] for entry in self.driver.get_log("browser") if entry["level"] == "SEVERE"]

    def outside(self):
        """Requests for anything that is neither on disk nor in the page."""
        self.drain()
        return [url for url in self.requests if not url.startswith(("file:", "data:", "blob:", "about:", "chrome:"))]

    def faults(self):
        """Errors in the console, and those that the page caught."""
        self.drain()
        return self.errors + self.js("return (Waferhand.faults || []).map((error) => error.stack)")

    def shoot(self, name):
        """A picture below build/browser, to be looked at."""
        path = FOLDER / f"{name}.png"
        self.settle()
        path.write_bytes(base64.b64decode(self.cdp("Page.captureScreenshot", format="png")["data"]))
        return path

    def text(self, selector):
        return self.js("return document.querySelector(arguments[0]).textContent", selector)

    def click(self, x, y, count=1):
        for kind in ("mouseMoved", "mousePressed", "mouseReleased"):
            self.cdp("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left" if kind != "mouseMoved" else "none",
                     clickCount=count)

    def drag(self, start, end):
        self.cdp("Input.dispatchMouseEvent", type="mousePressed", x=start[0], y=start[1], button="left", clickCount=1)
        for share in (0.3, 0.7, 1):
            self.cdp("Input.dispatchMouseEvent", type="mouseMoved", x=start[0] + share * (end[0] - start[0]),
                     y=start[1] + share * (end[1] - start[1]), button="left", buttons=1)
        self.cdp("Input.dispatchMouseEvent", type="mouseReleased", x=end[0], y=end[1], button="left", clickCount=1)
        self.settle()

    def box(self, selector):
        """(left, top, width, height) of an element, scrolled into sight."""
        return self.js("""const found = document.querySelector(arguments[0]); found.scrollIntoView({ block: 'center' });
            const box = found.getBoundingClientRect(); return [box.left, box.top, box.width, box.height]""", selector)

    def key(self, key, shift=False, code=None):
        """A key as a keyboard sends it; characters are typed."""
        text = key if len(key) == 1 else {"Enter": "\r"}.get(key)
        down = dict(type="keyDown", key=key, code=code or key, modifiers=8 if shift else 0)
        named = {"ArrowLeft": 37, "ArrowUp": 38, "ArrowRight": 39, "ArrowDown": 40, "Enter": 13, "Home": 36, "End": 35, "Tab": 9, "Escape": 27, " ": 32}
        if key in named:
            down["windowsVirtualKeyCode"] = named[key]
        if text:
            down["text"] = text
        self.cdp("Input.dispatchKeyEvent", **down)
        self.cdp("Input.dispatchKeyEvent", type="keyUp", key=key, code=code or key)
        self.settle()

    def now(self):
        return self.js("return Waferhand.clock.now")


@functools.lru_cache(maxsize=None)
def shared(webgl):
    made = Browser(WEBGL if webgl else NO_WEBGL)
    atexit.register(made.close)
    return made


def common():
    """The browser that tests share: starting one takes longer than most of them. Whoever changes it puts it back."""
    return shared(True)


def plain():
    """Another one without WebGL, for what does not ask how the cell is drawn: in software GL each page costs a second more."""
    return shared(False)
