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

# Root in a container has no sandbox to give; nothing is looked up, whatever the page asks for. The driver talks to it through a
# pipe: by way of a port it would ask for the address of localhost.
FLAGS = ["--headless=new", "--remote-debugging-pipe", "--no-sandbox", "--disable-dev-shm-usage", "--host-resolver-rules=MAP * ~NOTFOUND",
         "--force-device-scale-factor=1", "--hide-scrollbars"]
WEBGL = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
NO_WEBGL = ["--disable-gpu", "--disable-webgl", "--disable-3d-apis"]

SIZE = (1440, 900)


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
        self.drain()
        self.requests, self.errors = [], []
        self.driver.get(path.as_uri())
        self.wait("return performance.getEntriesByName('complete').length > 0")
        self.wait("return !(Waferhand.plots && Waferhand.plots.panels.some((panel) => !panel.graph))")
        self.settle()

    def opened(self, path):
        """Shows a page: its own processor time, s, and when it took input, ms after navigation. Performance is to be enabled."""
        # What the page before it still draws, in software here, is none of its time.
        self.driver.get("about:blank")
        self.settle()
        time.sleep(1)
        self.open(path)
        metrics = {each["name"]: each["value"] for each in self.cdp("Performance.getMetrics")["metrics"]}
        return metrics["TaskDuration"], self.js("return performance.getEntriesByName('interactive')[0].startTime")

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
        text = key if len(key) == 1 else None
        down = dict(type="keyDown", key=key, code=code or key, modifiers=8 if shift else 0)
        named = {"ArrowLeft": 37, "ArrowRight": 39, "Home": 36, "End": 35, "Tab": 9, "Escape": 27, " ": 32}
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
