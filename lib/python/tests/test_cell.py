"""The package against the program: what a test bench does with a cell."""

import dataclasses
import socket
import threading
import time

import pytest

from waferhand import Cell, CellError, Event, Line, NotStarted, Port, Untried, Where

PAPER = "lua/layouts/paper.lua"


@pytest.mark.cell(PAPER, dialect="words")
def test_a_pick_without_a_wafer(cell):
    cell.alarm("WAFER_MISSING")
    with cell.connect(end="\r") as host:
        assert host.say("PICK A SLOT 1") == "_ERR 0401"
        assert cell.where("Wafer 1").station == "A"
        assert host.say("HOME") == "_RDY"
        assert host.say("PICK A SLOT 1") == "_RDY"
        where = cell.where("Wafer 1")
        assert (where.station, where.slot, where.gripper) == (None, None, "EE")


def test_it_starts_within_a_second():
    begin = time.monotonic()
    with Cell(PAPER) as cell:
        assert cell.status()["phase"] == "idle"
        assert time.monotonic() - begin < 1


@pytest.mark.cell(PAPER)
def test_errors_and_faults(cell):
    with pytest.raises(CellError) as refused:
        cell.where("Wafer 9")
    assert (refused.value.number, refused.value.name) == (46, "NO_SUCH_WAFER")
    with pytest.raises(CellError):
        cell.alarm("NO_SUCH_ERROR")
    with pytest.raises(CellError):
        cell.ask('GET A 1"\\')
    number = cell.fault("no_vacuum gripper=EE")
    with cell.connect() as host:
        assert "VACUUM_TIMEOUT" in host.say("GET A 1")
        cell.clear(number)
        assert host.say("RECOVER").startswith("OK")
        assert host.say("GET A 1").startswith("OK")


@pytest.mark.cell(PAPER, rate=10)
def test_events_and_rate(cell):
    with cell.events("picked", "sensor", "position") as events, cell.connect() as host:
        host.send("GET A 1")
        heard = [next(events) for _ in range(3)]
        assert host.hear().startswith("OK")
    assert [event.kind for event in heard] == ["picked", "sensor", "position"]
    assert dataclasses.replace(heard[0], seconds=0) == Event("picked", 0, wafer="Wafer 1", gripper="EE")
    assert heard[1].value == 1 and heard[2].port == "cell"
    cell.set_rate(0)
    with pytest.raises(CellError):
        cell.set_rate(-1)


def test_what_was_said_stays():
    with Cell(PAPER, "prompt") as cell:
        with cell.connect() as host:
            for line in ("GET A 1", "PUT B 2", "GET B 1", "PUT B 10"):
                assert host.say(line).startswith("OK")
    assert cell.hash == "e4e148111c08e2e0"
    said = [entry.bytes for entry in cell.transcript if entry.kind == "said" and entry.port == "cell"]
    assert said == [b"GET A 1\n", b"PUT B 2\n", b"GET B 1\n", b"PUT B 10\n"]
    with pytest.raises(RuntimeError):
        cell.status()


def test_ports_of_several_mechanisms():
    ports = [Port("prompt", "robot"), Port("words", "P"), Port("words", "Q")]
    with Cell("lua/layouts/two_aligners.lua", ports) as cell:
        assert list(cell.ports) == ["robot", "P", "Q"]
        with cell.connect("P", end="\r") as host:
            assert host.say("PICK A SLOT 1").startswith("_ERR")


def test_parameters_and_what_cannot_start():
    with pytest.raises(NotStarted, match="no_such_layout.lua"):
        Cell("no_such_layout.lua").__enter__()
    with pytest.raises(NotStarted, match="no dialect nonsense"):
        Cell(PAPER, "nonsense").__enter__()
    with pytest.raises(NotStarted, match="nobody"):
        Cell(PAPER, parameters={"nobody": 1}).__enter__()
    with pytest.raises(ValueError, match="keep"):
        Cell(PAPER, keep="talk.txt")


@pytest.mark.cell(PAPER)
def test_where_a_name_needs_quotes(cell):
    assert isinstance(cell.where('Wafer 1'), Where)
    with pytest.raises(CellError) as refused:
        cell.where('a "b\\')
    assert 'no such wafer; "a "b\\" (expected' in refused.value.text


@pytest.mark.cell(PAPER)
def test_kinds_of_events_that_are_none(cell):
    with pytest.raises(CellError, match=r"subscribe: pickd \(expected some of picked, .*, mode, port, grip; did you mean picked\?"):
        cell.events("picked", "pickd")
    with pytest.raises(CellError, match="subscribe: wafer "):
        cell.events("wafer")
    with cell.events():
        pass


@pytest.mark.cell(PAPER)
def test_names_of_alarms(cell):
    with pytest.raises(CellError, match=r"ALARM: wafer_mising .*did you mean WAFER_MISSING\?"):
        cell.alarm("wafer_mising")
    cell.clear(cell.alarm("wafer_missing"))


@pytest.mark.cell("lua/layouts/two_aligners.lua", dialect=[Port("prompt", "robot"), Port("prompt", "P"), Port("prompt", "Q")])
def test_the_status_has_the_last_error_of_any_port(cell):
    assert cell.status()["error"] == 0
    with cell.connect("robot") as robot, cell.connect("P") as aligner:
        for host, line, port in ((robot, "GET P 1", "robot"), (aligner, "ALIGN P", "P"), (robot, "GET P 1", "robot")):
            answer = host.say(line)
            told = cell.status()
            assert answer.startswith(f"ERROR {told['error']} ") and told["error"] > 0, (answer, told)
            assert (told["error_port"], told["error_command"]) == (port, line)
        assert "error_port" not in robot.say("STATUS")


@pytest.mark.cell(PAPER)
def test_the_status_has_the_error_of_the_whole_cell(cell):
    with cell.connect() as host:
        cell.alarm("WAFER_MISSING")
        assert host.say("GET A 1").startswith("ERROR")
    told = cell.status()
    assert (told["error_name"], told["error_port"]) == ("WAFER_MISSING", "cell")


def test_a_rate_below_0():
    with pytest.raises(NotStarted, match="--rate: -1 "):
        Cell(PAPER, rate=-1).__enter__()


def test_a_fault_that_never_came():
    with pytest.warns(UserWarning, match="never came, and so were not tried: .*WAFER_MISSING"):
        with Cell(PAPER) as cell:
            cell.alarm("WAFER_MISSING")
    with pytest.raises(Untried, match="never came"):
        with Cell(PAPER, strict=True) as cell:
            cell.fault("no_vacuum gripper=EE")
    with pytest.raises(ZeroDivisionError), Cell(PAPER, strict=True) as cell:
        cell.alarm("WAFER_MISSING")
        raise ZeroDivisionError


def test_a_frame_is_heard_whole_in_time():
    with socket.create_server(("127.0.0.1", 0)) as server:
        line = Line(server.getsockname(), "\n", 20)
        other, _ = server.accept()

        def dribble():
            for _ in range(20):
                other.sendall(b"x")
                time.sleep(0.05)
            other.sendall(b"\nsecond\n")

        thread = threading.Thread(target=dribble)
        thread.start()
        begin = time.monotonic()
        with pytest.raises(TimeoutError):
            line.hear(0.2)
        assert time.monotonic() - begin < 0.8
        assert line.hear() == 20 * "x" and line.hear(0) == "second"
        thread.join()
        line.close()
        other.close()


@pytest.mark.cell(PAPER)
def test_events_end_while_a_thread_reads(cell):
    heard = []
    with cell.events("picked") as events:
        thread = threading.Thread(target=lambda: heard.extend(events), daemon=True)
        thread.start()
        time.sleep(0.1)
    thread.join(10)
    assert not thread.is_alive() and heard == []


def test_ports_in_the_words_of_python():
    with pytest.raises(NotStarted, match=r"in Python: Port\(dialect, ports=2\)"):
        Cell("lua/layouts/rail_arm.lua", "numbered").__enter__()
    with Cell("lua/layouts/rail_arm.lua", Port("numbered", ports=2)) as cell:
        with pytest.raises(KeyError, match="no port motion .expected one of robot.status, robot.motion"):
            cell.connect("motion")
