"""Eight hours of a tool, many times as fast as the clock, and a page that looks on: at their end, memory of program and page, and the
page's work for a picture, are below a bound. tests/verify/live_hours starts it."""
import os
import pathlib
import re
import sys
import time

import browser

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "end_to_end/page"))
import page as pages  # noqa: E402  its folder was just named

HOURS = float(os.environ.get("LIVE_HOURS", "8"))
RATE = float(os.environ.get("LIVE_RATE", "200"))

# The page's own work by its processor's clock, ms: for a picture of the present, of which most screens show 60 a second, and for all
# that follows when lists and curves have grown, at most four times a second.
FRAME_MS, GROWTH_MS = 8, 40
# The program's memory and the page's heap, MB.
PROGRAM_MB, HEAP_MB = 100, 60

# Another command, until the next list of them comes.
GROWTH = """W.shown.commands.push(Object.assign({}, W.shown.commands[0])); W.clock.grow(W.clock.end, true); W.clock.flush();
    document.body.getBoundingClientRect()"""


def resident(process):
    """Memory of a process, MB."""
    status = pathlib.Path(f"/proc/{process.pid}/status").read_text(encoding="utf-8")
    return int(re.search(r"VmRSS:\s*(\d+)", status)[1]) / 1024


def work(page, step, count):
    """Processor time of the page for one of so many steps, ms."""
    before = page.busy()
    page.js(f"const W = Waferhand; for (let i = 0; i < {count}; ++i) {{ {step}; W.clock.flush(); }}")
    return 1000 * (page.busy() - before) / count


def look(page, served):
    """What it takes now."""
    page.cdp("HeapProfiler.collectGarbage")
    heap = {each["name"]: each["value"] for each in page.cdp("Performance.getMetrics")["metrics"]}["JSHeapUsedSize"]
    return {"hours": page.js("return Waferhand.clock.end") / 3600, "program": resident(served.process), "heap": heap / 2**20,
            "elements": page.js("return document.querySelectorAll('*').length"),
            "frame": work(page, "W.clock.grow(W.clock.end, false)", 50), "growth": work(page, GROWTH, 20)}


def main():
    browser.FOLDER.mkdir(parents=True, exist_ok=True)
    page = browser.Browser()
    served = pages.Served("run", "tests/bench/hour.lua", "--set", f"seconds={HOURS * 3600:.0f}", "--budget", "1e12", "--page", "0",
                          "--rate", str(RATE))
    try:
        page.cdp("Performance.enable", timeDomain="threadTicks")
        page.visit(f"http://{served.place}/")
        # Software GL takes half a second for a picture, a graphics card a millisecond: it is left out.
        page.js("Waferhand.stage.view.gl.render = () => {}")
        found = {"hours": 0}
        while found["hours"] < 0.97 * HOURS:
            time.sleep(min(10, 0.02 * HOURS * 3600 / RATE))
            found = look(page, served)
            print("{hours:5.2f} h: program {program:.0f} MB, page {heap:.0f} MB, {elements} elements; work {frame:.2f} ms a picture, "
                  "{growth:.1f} ms for what has grown".format(**found), flush=True)
        assert page.faults() == [], page.faults()
        for name, most in (("program", PROGRAM_MB), ("heap", HEAP_MB), ("frame", FRAME_MS), ("growth", GROWTH_MS)):
            assert found[name] < most, f"{name}: {found[name]:.1f} (at most {most})"
    finally:
        served.kill()
        page.close()


if __name__ == "__main__":
    main()
