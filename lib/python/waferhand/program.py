"""Finds and starts the program."""

from __future__ import annotations

import json
import os
import pathlib
import re
import shutil
import subprocess
import time
from typing import Any, Optional, Sequence

CHECKOUT = pathlib.Path(__file__).resolve().parents[3]


class NotStarted(Exception):
    """The program is not there, or did not begin to serve; the text is its own message."""


def find_program(wanted: Optional[str] = None) -> str:
    """The program: as wanted, as WAFERHAND says, from the path, or of the checkout in which the package lies."""
    built = CHECKOUT / "build" / "waferhand"
    found = wanted or os.environ.get("WAFERHAND") or shutil.which("waferhand")
    if not found and built.exists():
        found = str(built)
    if not found:
        raise NotStarted("no program waferhand (expected it on the path, in WAFERHAND, or as program=)")
    return found


def find_dialect(name: str, program: str) -> str:
    """A dialect's file: a path, or the name of a shipped one, such as "words"."""
    if "/" in name or name.endswith(".lua"):
        return name
    root = pathlib.Path(shutil.which(program) or program).resolve().parents[1]
    places = [CHECKOUT / "lua" / "dialects", root / "lua" / "dialects", root / "share" / "waferhand" / "dialects"]
    for place in places:
        if (place / f"{name}.lua").exists():
            return str(place / f"{name}.lua")
    raise NotStarted(f"no dialect {name} (expected a path, or the name of a file in {' or '.join(map(str, places))})")


def in_python(message: str) -> str:
    """The program's message with what a test writes where the program asks for options of its own."""
    found = re.search(r"\d+ --tcp and --pty \(expected one for each of the (\d+) ports", message)
    return f"{message}\nin Python: Port(dialect, ports={found[1]})" if found else message


def start(command: Sequence[str], ready: pathlib.Path, log: pathlib.Path, cwd: Optional[str], seconds: float) -> "Started":
    """Starts it and waits until its ports listen."""
    with open(log, "wb") as out:
        process = subprocess.Popen(list(command), stdin=subprocess.DEVNULL, stdout=out, stderr=out, cwd=cwd)
    limit = time.monotonic() + seconds
    while not ready.exists():
        if process.poll() is not None:
            raise NotStarted(log.read_text("utf-8", "replace").strip() or f"exit status {process.returncode}")
        if time.monotonic() > limit:
            process.kill()
            process.wait()
            raise NotStarted(f"no port listens after {seconds} s: {log.read_text('utf-8', 'replace').strip()}")
        time.sleep(0.002)
    return Started(process, json.loads(ready.read_text("utf-8")), log)


class Started:
    """A program that serves."""

    def __init__(self, process: "subprocess.Popen[bytes]", told: dict[str, Any], log: pathlib.Path) -> None:
        self.process, self.told, self._log = process, told, log

    def said(self) -> str:
        """All that it has printed."""
        return self._log.read_text("utf-8", "replace")

    def end(self, seconds: float) -> int:
        """Ends it as an operator does, and returns its exit status."""
        if self.process.poll() is None:
            self.process.terminate()
        try:
            return self.process.wait(seconds)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            raise
