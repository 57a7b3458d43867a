"""What was said at the ports: `serve --transcript` as JSON lines."""

from __future__ import annotations

import json
import pathlib
from dataclasses import dataclass


@dataclass(frozen=True)
class Entry:
    """A frame, or what befell a connection; the kinds are those of lua/dialects/serving.md."""

    slice: int
    time: float
    kind: str
    port: str
    bytes: bytes = b""


def read_transcript(path: pathlib.Path) -> list[Entry]:
    entries = []
    for line in path.read_text("utf-8").splitlines():
        told = json.loads(line)
        if "slice" in told:
            frame = str(told.get("bytes", "")).encode("latin-1")
            entries.append(Entry(told["slice"], told["time"], told["kind"], told["port"], frame))
    return entries
