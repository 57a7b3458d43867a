"""A cell that a test's host software commands."""

from __future__ import annotations

import pathlib
import re
import shutil
import socket
import tempfile
import time
import warnings
from dataclasses import dataclass
from typing import Optional, Sequence, Union

from .control import Control, Events, Value, Where, typed, values_of
from .program import NotStarted, Started, find_dialect, in_python, find_program, start
from .transcript import Entry, read_transcript


class Untried(AssertionError):
    """Faults or alarms never came, so the test has not tried them; the text is the program's own sentence."""


@dataclass(frozen=True)
class Port:
    """A dialect's controller; `mechanism` names a robot or a station, `ports` says how many ports it names.

    `unit` is its address on a line of several units; with `ports=0` that is the line of the one before it.
    """

    dialect: str
    mechanism: Optional[str] = None
    ports: int = 1
    unit: Optional[str] = None


class Line:
    """A host's connection, text line by text line, for tests without a driver of their own."""

    def __init__(self, address: tuple[str, int], end: str, seconds: float) -> None:
        self._socket = socket.create_connection(address, timeout=seconds)
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._end, self._rest, self._seconds = end.encode("latin-1"), b"", seconds

    def __enter__(self) -> "Line":
        return self

    def __exit__(self, *problem: object) -> None:
        self.close()

    def close(self) -> None:
        self._socket.close()

    def send(self, text: str) -> None:
        self._socket.sendall(text.encode("latin-1") + self._end)

    def hear(self, seconds: Optional[float] = None) -> str:
        """The next frame, whole within `seconds`. Raises TimeoutError, or ConnectionError if the controller has hung up."""
        given = self._seconds if seconds is None else seconds
        limit = time.monotonic() + given
        try:
            while self._end not in self._rest:
                self._socket.settimeout(max(limit - time.monotonic(), 0.001))
                some = self._socket.recv(4096)
                if not some:
                    raise ConnectionError("the controller has hung up")
                self._rest += some
                if self._end not in self._rest and time.monotonic() > limit:
                    raise socket.timeout
        except socket.timeout:
            raise TimeoutError(f"no whole frame within {given} s") from None
        finally:
            self._socket.settimeout(self._seconds)
        frame, self._rest = self._rest.split(self._end, 1)
        return frame.decode("latin-1")

    def say(self, text: str) -> str:
        self.send(text)
        return self.hear()


class Cell:
    """A context: `waferhand serve LAYOUT` runs within it.

    `dialect` is a file, the name of a shipped dialect, a Port, or a list of these. `rate` says how fast simulated time
    passes; 0, the default, is as fast as possible. `parameters` are the layout's, by name. `options` go to the program.
    `strict`: faults and alarms that never came raise Untried at the end; else they are a warning.
    `keep` is a file, NAME.jsonl, in which the transcript stays for `waferhand converse`.
    """

    def __init__(
        self,
        layout: str,
        dialect: Union[str, Port, Sequence[Union[str, Port]]] = "prompt",
        *,
        rate: float = 0,
        parameters: Optional[dict[str, object]] = None,
        options: Sequence[str] = (),
        program: Optional[str] = None,
        cwd: Optional[str] = None,
        keep: Optional[str] = None,
        timeout: float = 60,
        strict: bool = False,
    ) -> None:
        listed = [dialect] if isinstance(dialect, (str, Port)) else list(dialect)
        self._dialects = [item if isinstance(item, Port) else Port(item) for item in listed]
        self._layout, self._rate, self._options = layout, rate, list(options)
        self._parameters = dict(parameters or {})
        self._program, self._cwd, self._timeout, self._strict = program, cwd, timeout, strict
        if keep is not None and not keep.endswith(".jsonl"):
            raise ValueError(f"keep: {keep} (expected a file NAME.jsonl)")
        self._keep = keep
        self._folder: Optional[pathlib.Path] = None
        self._started: Optional[Started] = None
        self._control: Optional[Control] = None
        self._entries: list[Entry] = []
        self._said = ""
        self.ports: dict[str, tuple[str, int]] = {}

    # ---------------------------------------------------------------------------------------------- begin and end

    def _talk(self) -> pathlib.Path:
        return pathlib.Path(self._cwd or ".", self._keep) if self._keep else pathlib.Path(self._folder or "", "talk.jsonl")

    def _command(self, folder: pathlib.Path) -> list[str]:
        program = find_program(self._program)
        command = [program, "serve", self._layout, "--control", "127.0.0.1:0", "--ready", str(folder / "ready.json")]
        command += ["--transcript", self._keep or str(folder / "talk.jsonl")]
        command += ["--rate", str(self._rate)] if self._rate != 0 else ["--lockstep"]
        for name, value in self._parameters.items():
            command += ["--set", f"{name}={value}"]
        for port in self._dialects:
            command += ["--dialect", find_dialect(port.dialect, program)]
            command += ["--mechanism", port.mechanism] if port.mechanism else []
            command += ["--unit", port.unit] if port.unit is not None else []
            command += ["--tcp", "127.0.0.1:0"] * port.ports
        return command + self._options

    def __enter__(self) -> "Cell":
        self._folder = pathlib.Path(tempfile.mkdtemp(prefix="waferhand."))
        try:
            command = self._command(self._folder)
            try:
                self._started = start(command, self._folder / "ready.json", self._folder / "said", self._cwd, self._timeout)
            except NotStarted as problem:
                raise NotStarted(in_python(str(problem))) from None
            told = self._started.told
            self.ports = {port["name"]: (port["address"], port["number"]) for port in told["ports"]}
            self._control_at = (told["control"]["address"], told["control"]["number"])
            self._control = Control(self._control_at, self._timeout)
        except BaseException:
            self.close()
            raise
        return self

    def __exit__(self, *problem: object) -> None:
        self.close()
        untried = self.untried
        if untried and problem[0] is None and self._strict:
            raise Untried(untried)
        if untried and problem[0] is None:
            warnings.warn(untried, stacklevel=2)

    def close(self) -> None:
        """Ends the program. What was said can be read afterwards, too."""
        if self._control:
            self._control.close()
            self._control = None
        if self._started:
            self._started.end(self._timeout)
            self._said = self._started.said()
            self._started = None
        if self._folder:
            talk = self._talk()
            self._entries = read_transcript(talk) if talk.exists() else []
            shutil.rmtree(self._folder, ignore_errors=True)
            self._folder = None

    # ------------------------------------------------------------------------------------------------------ hosts

    @property
    def port(self) -> tuple[str, int]:
        """The address of the first port: ("127.0.0.1", 40001)."""
        return next(iter(self.ports.values()))

    def connect(self, port: Optional[str] = None, end: str = "\n") -> Line:
        """A host's connection to the port of that name, or to the first one."""
        if port is not None and port not in self.ports:
            raise KeyError(f"no port {port} (expected one of {', '.join(self.ports)})")
        return Line(self.ports[port] if port is not None else self.port, end, self._timeout)

    # ----------------------------------------------------------------------------------------------------- tester

    def _running(self) -> Control:
        if not self._control:
            raise RuntimeError("the cell does not run (expected `with Cell(...) as cell:`)")
        return self._control

    def ask(self, line: str) -> str:
        """The answer to a line of the prompt that moves nothing. Raises CellError."""
        return self._running().request(line=line)

    def alarm(self, error: Union[int, str]) -> int:
        """The next command that can end with this error, a number or a name, does so. Returns the fault's number."""
        return self._number_of(self.ask(f"ALARM {error}"))

    def fault(self, description: str) -> int:
        """Begins a fault, as the prompt's FAULT has it: "no_vacuum gripper=EE". Returns its number."""
        return self._number_of(self.ask(f"FAULT {description}"))

    @staticmethod
    def _number_of(answer: str) -> int:
        found = re.search(r"\bfault=(\d+)", answer)
        if not found:
            raise RuntimeError(f"{answer}: no number of a fault")
        return int(found[1])

    def clear(self, number: int) -> None:
        """Ends a fault."""
        self.ask(f"CLEAR {number}")

    def status(self) -> dict[str, Value]:
        """What STATUS tells, by name."""
        return values_of(self.ask("STATUS"))

    def where(self, wafer: str) -> Where:
        """Where a wafer is."""
        answer = self.ask(f"WHERE {typed(wafer)}")
        told = values_of(answer)
        station, slot, gripper = told.get("station"), told.get("slot"), told.get("holder")
        return Where(
            str(station) if station is not None else None,
            int(slot) if isinstance(slot, (int, float)) else None,
            str(gripper) if gripper is not None else None,
            answer,
        )

    def set_rate(self, rate: float) -> None:
        """Simulated time passes so much faster than the clock from now on; 0: as fast as possible."""
        self._running().request(rate=rate)

    def tell(self, text: str) -> None:
        """Tells the controllers something that only hands can do, as their dialect's `tester` has it: "estop on"."""
        self._running().request(tell=text)

    def events(self, *kinds: str) -> Events:
        """Events of these kinds, on a connection of their own."""
        self._running()
        return Events(self._control_at, kinds, self._timeout)

    # ----------------------------------------------------------------------------------------------- what was said

    @property
    def transcript(self) -> list[Entry]:
        """All that was said so far at all ports."""
        return read_transcript(self._talk()) if self._folder else self._entries

    @property
    def said(self) -> str:
        """All that the program has printed so far."""
        return self._started.said() if self._started else self._said

    @property
    def untried(self) -> Optional[str]:
        """The program's sentence about faults and alarms that never came, once the cell is closed."""
        found = re.search(r"^serve: (never came, .*)$", self.said, re.M)
        return found[1] if found else None

    @property
    def hash(self) -> Optional[str]:
        """The hash of the run, once the cell is closed."""
        found = re.search(r", hash ([0-9a-f]{16})$", self.said, re.M)
        return found[1] if found else None
