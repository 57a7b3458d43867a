"""The control port of `waferhand serve`: JSON lines."""

from __future__ import annotations

import json
import re
import socket
from dataclasses import dataclass, field
from typing import Any, Iterator, Optional, Union

Value = Union[str, float, int, None]

PAIR = re.compile(r'((?:"(?:[^"\\]|\\.)*"|[^\s=;"])+)=("(?:[^"\\]|\\.)*"|[^\s;]*)')


class CellError(Exception):
    """The cell has refused a line: number and name of the error, and its text."""

    def __init__(self, number: int, name: str, text: str) -> None:
        super().__init__(text)
        self.number, self.name, self.text = number, name, text


@dataclass(frozen=True)
class Event:
    """Something that befell the cell: see lua/dialects/serving.md for the kinds."""

    kind: str
    seconds: float
    wafer: Optional[str] = None
    gripper: Optional[str] = None
    value: Optional[int] = None
    port: Optional[str] = None
    door: Optional[str] = None
    state: dict[str, Value] = field(default_factory=dict, hash=False)  # of "mode", "port" and "grip": all else that is told, by name


FIELDS = ("seconds", "wafer", "gripper", "value", "port", "door")


@dataclass(frozen=True)
class Where:
    """Where a wafer is: in a station's slot, on a gripper, or neither."""

    station: Optional[str]
    slot: Optional[int]
    gripper: Optional[str]
    answer: str


def plain(text: str) -> str:
    """A name or a value without its quotes."""
    return re.sub(r"\\(.)", r"\1", text[1:-1]) if text.startswith('"') else text


def typed(name: str) -> str:
    """A name as the prompt takes it."""
    if re.fullmatch(r"[A-Za-z0-9_./-]+", name):
        return name
    return '"' + name.replace("\\", "\\\\").replace('"', '\\"') + '"'


def value_of(text: str) -> Value:
    if text.startswith('"'):
        return plain(text)
    if text == "none":
        return None
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text


def values_of(answer: str) -> dict[str, Value]:
    """The pairs name=value of an answer."""
    return {plain(name): value_of(value) for name, value in PAIR.findall(answer)}


class Control:
    """A connection to the port."""

    def __init__(self, address: tuple[str, int], seconds: float) -> None:
        self._socket = socket.create_connection(address, timeout=seconds)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._file = self._socket.makefile("rb")
        self._last = 0
        self.is_closed = False

    def close(self) -> None:
        """Also while another thread reads: it sees the end."""
        self.is_closed = True
        try:
            self._socket.shutdown(socket.SHUT_RDWR)
        except OSError:
            pass  # the program has gone
        self._file.close()
        self._socket.close()

    def wait(self, seconds: Optional[float]) -> None:
        self._socket.settimeout(seconds)

    def read(self) -> dict[str, Any]:
        line = self._file.readline()
        if not line:
            raise ConnectionError("the program has ended")
        told: dict[str, Any] = json.loads(line.decode("utf-8"))
        return told

    def request(self, **fields: Any) -> str:
        """Sends a request and returns its answer. Raises CellError if it was refused."""
        self._last += 1
        self._socket.sendall(json.dumps({"id": self._last, **fields}).encode() + b"\n")
        while True:
            told = self.read()
            if "event" not in told:
                break
        if not told["ok"]:
            raise CellError(told["number"], told["name"], told["text"])
        return str(told["answer"])


class Events:
    """Events of the kinds that were asked for, one after another. A context; leaving it ends the iteration, in any thread."""

    def __init__(self, address: tuple[str, int], kinds: tuple[str, ...], seconds: float) -> None:
        self._control = Control(address, seconds)
        try:
            self._control.request(subscribe=list(kinds))
        except BaseException:
            self._control.close()
            raise

    def __enter__(self) -> "Events":
        return self

    def __exit__(self, *problem: object) -> None:
        self._control.close()

    def __iter__(self) -> Iterator[Event]:
        return self

    def __next__(self) -> Event:
        try:
            told = self._control.read()
        except (OSError, ValueError):
            if self._control.is_closed:
                raise StopIteration from None
            raise
        kind = str(told.pop("event"))
        known = {name: told.pop(name) for name in FIELDS if name in told}
        return Event(kind, **known, state=told)
