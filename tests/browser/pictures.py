"""Makes the pictures of pages that the manuals show, in lib/report/pictures: `pictures.py [NAME...]`. `make playground` goes before."""
import pathlib
import shutil
import socket
import sys
import time

import browser
import documents

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "end_to_end/page"))
import page as pages  # noqa: E402  its folder was just named

ROOT = documents.ROOT
FOLDER = ROOT / "lib/report/pictures"
SIZE = (1200, 800)
FRAME = "document.querySelector('iframe:not([hidden])').contentWindow"


def shoot(page, name):
    time.sleep(1)  # a picture in software GL
    shutil.copy(page.shoot(name), FOLDER / f"{name}.png")
    print(FOLDER / f"{name}.png")


def report(page, script, t):
    page.open(documents.example(script)[1])
    page.seek(t)


def transfer(page):
    """A report, measured in."""
    report(page, "01_transfer", 2.4)
    page.js("""const W = Waferhand; ['names', 'trail'].forEach((name) => W.stage.choose(name, true));
        const [from, to] = document.querySelectorAll('#measure select'), choose = (select, text) => {
            select.value = Array.from(select.options).find((each) => each.textContent === text).value;
            select.dispatchEvent(new Event('change')); };
        choose(from, 'PA'); choose(to, 'Wafer 1'); W.measure.toggle(); document.activeElement.blur(); scrollTo(0, 0)""")
    shoot(page, "transfer")


def scrape(page):
    """A hit, in dark colours."""
    report(page, "04_scrape", 4.506)
    page.js("Waferhand.theme.choose('dark')")
    shoot(page, "scrape")


def host(page):
    """A host drives a cell, and the page follows."""
    served = pages.Served("serve", "lua/layouts/paper.lua", "--dialect", "lua/dialects/prompt.lua", "--tcp", "127.0.0.1:0", "--page", "0")
    try:
        served.said("prompt, at ")
        place = next(line.rsplit(" at ", 1)[1].strip() for line in served.lines if "prompt, at " in line)
        page.visit(f"http://{served.place}/")
        with socket.create_connection(("127.0.0.1", int(place.rsplit(":", 1)[1])), 20) as line:
            answers = line.makefile("r")
            for command in ("GET A 1", "PUT B 9", "OFFSET Wafer 1"):
                line.sendall(f"{command}\r\n".encode())
                answers.readline()
            line.sendall(b"GET B 1\r\n")
            end = page.js("return Waferhand.clock.end")
            page.wait(f"return Waferhand.clock.end > {end} + 1.2")
            line.sendall(b"HOLD\r\n")
            page.wait("return document.getElementById('liveline').textContent.includes('held')")
            page.js("Waferhand.stage.choose('names', true); scrollTo(0, 150)")
            shoot(page, "host")
    finally:
        served.kill()


def playground(page, name, texts, t):
    """The playground with other texts, at a moment."""
    page.driver.get("about:blank")
    page.driver.get((ROOT / "build/playground.html").as_uri())
    page.wait("return performance.getEntriesByName('ready').length > 0")
    page.js("Playground.bar.choose('light')")
    for path, change in texts:
        page.js("""const [path, before, after] = arguments; Playground.files.show(path);
            Playground.editor.mirror.setValue(Playground.files.text(path).replace(before, after))""", path, *change)
        time.sleep(0.2)
    page.js("Playground.files.show(Playground.files.script)")
    time.sleep(2)  # the page takes one document after the other
    page.wait(f"return !Playground.runner.busy && !!{FRAME}.Waferhand && !!{FRAME}.Waferhand.shown && {FRAME}.Waferhand.stage.view"
              f" && {FRAME}.Waferhand.shown.run.hash === document.getElementById('hash').textContent", 60)
    page.js(f"const W = {FRAME}.Waferhand; W.clock.seek({t}); W.stage.choose('names', true); W.clock.flush()")
    shoot(page, name)


LAYOUT, SCRIPT = "lua/layouts/paper.lua", "lua/examples/01_transfer.lua"
OFF = (LAYOUT, ('station = "A", slot = 1 }', 'station = "A", slot = 1, dx = 60 }'))


def missed(page):
    """A pick that fails, paused on."""
    playground(page, "missed", [OFF], 1.842)


def mended(page):
    """The same cell, edited until it works: the GET goes where the wafer lies, as far as the layout now allows."""
    playground(page, "mended", [OFF, (LAYOUT, ("  slice = 0.001,", "  slice = 0.001,\n  corrections = { x = 60 },")), (SCRIPT, ('get("A", 1)   put("B", 2)', 'get("A", 1, { dx = 60 })   put("B", 2)'))], 1.9)


def night(page):
    """A tool at night: an hour in a few seconds."""
    served = pages.Served("run", "lua/examples/36_tool_flow.lua", "--page", "0", "--rate", "1000")
    try:
        page.visit(f"http://{served.place}/")
        page.js("Waferhand.theme.choose('dark')")
        page.wait("return Waferhand.clock.end > 600", 120)
        page.js("scrollTo(0, 130)")
        shoot(page, "night")
    finally:
        served.kill()


ALL = {each.__name__: each for each in (transfer, scrape, host, missed, mended, night)}


def main():
    browser.FOLDER.mkdir(parents=True, exist_ok=True)
    page = browser.Browser(size=SIZE)
    try:
        for name in sys.argv[1:] or ALL:
            ALL[name](page)
    finally:
        page.close()


if __name__ == "__main__":
    main()
