#!/usr/bin/env python3
# host.py DIALECT ADDRESS [SECONDS]: a tool's host that uses only sockets and ptys. It plays the paper's transfer run in the
# frames of one of lua/dialects, sends a frame again if it is not acknowledged within SECONDS (`dollar`), and ends with 0 if
# each command went well.
# host.py alarms DIALECT ADDRESS NAME=CODE...: makes a command answer with each of these alarms, and ends with 0 if each was the
# answer.
# host.py ends DIALECT ADDRESS COMMAND...: sends commands of that dialect one after another, and prints how each has ended: ok,
# or its code.
# host.py flood ADDRESS END FRAME BYTES ANSWER: sends BYTES bytes, one in eight of them wrong, and prints the last answer, which
# must be ANSWER.
# host.py lines ADDRESS END LINE...: sends lines and prints each answer. `!LINE` is sent without waiting for an answer, `?`
# waits for one, `~S` waits S seconds, `@FILE PATTERN` waits until a line of the file has the pattern; `##` at a line's end is
# its sum.
# host.py hours ADDRESS OTHER HOURS PROCESS: carries a wafer to and fro for HOURS simulated hours by lines of the prompt, while
# clients come and go at OTHER. It prints how many commands that took, and the process's kB after a third of the time and at its
# end.
# host.py python TEXT ARGUMENT...: a client of the test's own.
# host.py session: one process for all of the above (tools/hosts.sh). It reads requests on standard input, each as its number of
# words and the words, and answers with the output and the exit status; a NUL follows each of these texts.
import contextlib
import io
import os
import random
import re
import select
import socket
import sys
import threading
import time
import traceback


class Line:
    """A connection, read frame by frame."""

    opened = []

    def __init__(self, address, end):
        self.end, self.rest = end, b""
        Line.opened.append(self)
        if "/" in address:
            self.fd = os.open(address, os.O_RDWR | os.O_NOCTTY)
            self.socket = None
        else:
            host, port = address.rsplit(":", 1)
            self.socket = socket.create_connection((host, int(port)))
            self.fd = self.socket.fileno()

    def close(self):
        if self.socket:
            self.socket.close()
        else:
            os.close(self.fd)

    def send(self, frame):
        while frame:
            frame = frame[os.write(self.fd, frame):]

    def take(self, seconds=60.0):
        """The next frame; None: none has come in time."""
        limit = time.monotonic() + seconds
        while self.end not in self.rest:
            wait = limit - time.monotonic()
            if wait <= 0 or not wait_for(self.fd, wait):
                return None
            some = os.read(self.fd, 4096)
            if not some:
                sys.exit("host.py: the controller hung up")
            self.rest += some
        frame, self.rest = self.rest.split(self.end, 1)
        return frame


def wait_for(fd, seconds):
    return bool(select.select([fd], [], [], seconds)[0])


TRANSFER = [("get", "A", 1), ("put", "B", 2), ("get", "B", 1), ("put", "B", 10)]


def fail(frame):
    sys.exit("host.py: %r" % frame)


def play_prompt(address):
    line = Line(address, b"\n")
    for word, station, slot in TRANSFER:
        line.send(b"%s %s %d\n" % (word.encode(), station.encode(), slot))
        answer = line.take()
        if not answer.startswith(b"OK"):
            fail(answer)


def play_words(address):
    words = {"get": b"PICK", "put": b"PLACE"}
    line = Line(address, b"\r")
    for word, station, slot in TRANSFER:
        line.send(b"%s %s SLOT %d\r" % (words[word], station.encode(), slot))
        answer = line.take()
        if answer != b"_RDY":
            fail(answer)


def play_verbs(address):
    verbs = {"get": b"GETW", "put": b"PUTW"}
    line = Line(address, b"\r")
    for word, station, slot in TRANSFER:
        line.send(b"oROB1.%s(%s,%d)\r" % (verbs[word], station.encode(), slot))
        if line.take() != b"aROB1.%s:" % verbs[word]:
            fail(b"no acknowledgement")
        while True:
            answer = line.take()
            if answer.startswith(b"eROB1." + verbs[word]):
                break
        if b"(0000," not in answer:
            fail(answer)


def telegram(sequence, text):
    body = b",1,%02d,%s," % (sequence, text)
    return b"$" + body + b"%02X" % (sum(body) % 256) + b"\r"


def is_whole(frame):
    return len(frame) > 4 and frame[-2:] == b"%02X" % (sum(frame[1:-2]) % 256)


class Dollar:
    """Sends again until it is acknowledged, waits for the completion, and acknowledges that."""

    def __init__(self, address, patience=0.5):
        self.line, self.sequence, self.waiting, self.patience = Line(address, b"\r"), 0, [], patience
        self.completed = 0

    def take(self, seconds=60.0):
        frame = self.waiting.pop(0) if self.waiting else self.line.take(seconds)
        return frame if frame is None or is_whole(frame) else b""

    def ask(self, text):
        self.sequence = self.sequence % 99 + 1
        given_up = time.monotonic() + 60
        while time.monotonic() < given_up:
            self.line.send(telegram(self.sequence, text))
            limit = time.monotonic() + self.patience
            kept = []
            while time.monotonic() < limit:
                frame = self.take(max(0.0, limit - time.monotonic()))
                if frame and frame.startswith(b"$,1,%02d," % self.sequence):
                    self.waiting = kept + self.waiting
                    return frame
                if frame:
                    kept.append(frame)
            self.waiting = kept + self.waiting
        sys.exit("host.py: no acknowledgement of %r" % text)

    def act(self, text):
        answer = self.ask(text)
        while answer.split(b",")[4] == b"0023":  # our ACKN was lost
            self.acknowledge()
            time.sleep(0.05)
            answer = self.ask(text)
        if answer.split(b",")[4] != b"0000":
            return answer
        return self.complete(self.sequence)

    def acknowledge(self):
        self.line.send(telegram(self.completed, b"ACKN"))

    def complete(self, sequence):
        """The completion; if it is lost, the status tells that it has ended."""
        while True:
            frame = self.take(2 * self.patience)
            if frame and frame.startswith(b"!,1,%02d," % sequence):
                self.completed = sequence
                self.acknowledge()
                return frame
            if frame is None:
                status = self.ask(b"RSTS").split(b",")
                if status[5] == b"0":
                    self.completed = sequence
                    self.acknowledge()
                    return b"!,1,%02d,0,%s," % (sequence, status[6])


def play_dollar(address, patience="0.5"):
    names = {"get": b"MTRS,G", "put": b"MTRS,P"}
    host = Dollar(address, float(patience))
    for word, station, slot in TRANSFER:
        answer = host.act(b"%s,%s,%d" % (names[word], station.encode(), slot))
        if answer.split(b",")[4] != b"0000":
            fail(answer)


# The words of each command in each dialect, and the code that a host gets at its end.
COMMANDS = {
    "prompt": {"get": "GET A 1", "put": "PUT A 1", "align": "ALIGN P", "continue": "CONTINUE", "home": "HOME", "recover": "RECOVER",
               "alarm": "ALARM %s", "valve": "VALVE EE 1", "holder": 'HOLDER "Wafer 1"', "restore": "RESTORE X", "undo": "UNDO",
               "open": "OPEN DOOR", "close": "CLOSE DOOR", "flip": "FLIP FLIPPER", "teach": "TEACH A", "get_flipper": "GET FLIPPER 1",
               "put_flipper": "PUT FLIPPER 1", "pump": "PUMP LL vacuum", "wait_for": "WAIT_FOR LL 60",
               "carrier": "CARRIER LP", "take_away": "TAKE_AWAY LP"},
    "words": {"get": "PICK A SLOT 1", "put": "PLACE A SLOT 1", "align": "ALIGN P", "continue": "GO", "home": "HOME",
              "recover": "RETRACT", "alarm": "ALARM %s", "valve": "VAC EE OFF", "holder": "RQ WAFERS Wafer 1",
              "restore": "RESTORE X", "undo": "UNDO", "open": "OPEN DOOR", "close": "CLOSE DOOR", "flip": "FLIP CLAMP",
              "teach": "TEACH A", "get_flipper": "PICK FLIPPER", "put_flipper": "PLACE FLIPPER",
              "pump": "PUMP LL VACUUM", "wait_for": "AWAIT LL 60",
              "carrier": "CARRIER LP", "take_away": "REMOVE LP"},
    "dollar": {"get": "MTRS,G,A,1", "put": "MTRS,P,A,1", "align": "MALN,P", "continue": "MTRN", "home": "INIT", "recover": "MRTR",
               "alarm": "CALM,%s", "valve": "CVAC,EE,0", "holder": "RLOC,Wafer 1", "restore": "CRES,X", "undo": "CUND",
               "open": "MDOP,DOOR", "close": "MDCL,DOOR", "flip": "MFLP,CLAMP", "teach": "MTCH,A",
               "get_flipper": "MTRS,G,FLIPPER,1", "put_flipper": "MTRS,P,FLIPPER,1",
               "pump": "MPMP,LL,V", "wait_for": "MAWT,LL,60",
               "carrier": "MCAR,LP", "take_away": "MTKA,LP"},
    "verbs": {"get": "GETW(A,1)", "put": "PUTW(A,1)", "align": "ALGN(P)", "continue": "CONT()", "home": "ORGN()", "recover": "RETR()",
              "alarm": "ALRM(%s)", "valve": "VALV(EE,off)", "holder": "GLOC(Wafer 1)", "restore": "REST(X)", "undo": "UNDO()",
              "open": "OPEN(DOOR)", "close": "CLOS(DOOR)", "flip": "FLIP(CLAMP)", "teach": "TECH(A)",
              "get_flipper": "GETW(FLIPPER,1)", "put_flipper": "PUTW(FLIPPER,1)",
              "pump": "PUMP(LL,vacuum)", "wait_for": "AWAT(LL,60)",
              "carrier": "CARR(LP)", "take_away": "TAKE(LP)"},
}

# The command to which an alarm comes, if it is not GET.
COMES_TO = {
    "NO_WAFER_ON_GRIPPER": "put", "WAFER_LOST": "put", "WAFER_LOST_ON_WAY": "put", "WAFER_ALREADY_THERE": "put",
    "WRONG_FACE": "put", "UNGRIP_TIMEOUT": "put",
    "NOT_IN_PHASE": "continue", "BAD_VALVE": "valve", "NO_SUCH_WAFER": "holder", "NO_SUCH_SAVE": "restore", "NOT_RESTORED": "restore",
    "NOTHING_TO_UNDO": "undo", "NOT_A_PREALIGNER": "align", "TOO_FEW_SAMPLES": "align", "NO_NOTCH": "align", "TWO_NOTCHES": "align",
    "OFF_SENSOR": "align", "TOO_ECCENTRIC": "align", "CENTRE_NOT_SURE": "align", "NOTCH_NOT_SURE": "align", "BAD_SCAN": "align",
    "DOOR_BLOCKED": "close", "DOOR_TIMEOUT": "open", "NOT_TOUCHED": "teach", "FLIP_TIMEOUT": "flip", "FLIP_NOT_CLAMPED": "flip",
    "STATION_TIMEOUT": "wait_for", "WRONG_PRESSURE": "pump", "BOTH_OPEN": "open", "DOOR_OPEN": "pump",
    "PORT_ENTERED": "take_away", "NO_CARRIER": "take_away", "CARRIER_THERE": "carrier", "HANDSHAKE_TIMEOUT": "take_away",
}


def end_of_prompt(line, text):
    line.send(text.encode() + b"\n")
    answer = line.take().decode().split(" ")
    return "" if answer[0] == "OK" else answer[1]


def end_of_words(line, text):
    line.send(text.encode() + b"\r")
    while True:
        frame = line.take().decode()
        if frame in ("_RDY", "") or frame.startswith("_ERR"):
            return frame[5:]


def end_of_verbs(line, text):
    verb = text[:4]
    line.send(b"oROB1." + text.encode() + b"\r")
    while True:
        frame = line.take().decode()
        if frame.startswith(("nROB1.%s:" % verb, "eROB1.%s(" % verb)):
            code = frame[11:15]
            return "" if code == "0000" else code


def end_of_dollar(host, text):
    code = host.ask(text.encode()).split(b",")[4]
    if code == b"0000":
        code = host.complete(host.sequence).split(b",")[4]
    return "" if code == b"0000" else code.decode()


ENDS = {"prompt": end_of_prompt, "words": end_of_words, "verbs": end_of_verbs, "dollar": end_of_dollar}


def line_of(name, address):
    return Dollar(address) if name == "dollar" else Line(address, b"\n" if name == "prompt" else b"\r")


def show_ends(name, address, commands):
    line = line_of(name, address)
    for command in commands:
        print(ENDS[name](line, command) or "ok")


def show_alarms(name, address, alarms):
    """Each once, and the cell is as before."""
    line = line_of(name, address)

    def do(command, wanted="", *values):
        got = ENDS[name](line, COMMANDS[name][command] % values)
        if got != wanted:
            sys.exit("host.py: %s: %r, wanted %r" % (COMMANDS[name][command] % values, got, wanted))

    for alarm in alarms:
        error, code = alarm.split("=")
        command = COMES_TO.get(error, "get")
        holds = error in ("NO_WAFER_ON_GRIPPER", "WAFER_LOST", "WAFER_LOST_ON_WAY", "UNGRIP_TIMEOUT")
        if holds:
            do("get")
        if error == "FLIP_TIMEOUT":
            do("get")
            do("put_flipper")
        do("alarm", "", code)
        do(command, code)
        if error in ("STOPPED", "WAFER_LOST_ON_WAY"):
            do("recover")
        if error == "NOT_HOMED":
            do("home")
        if error == "FLIP_TIMEOUT":  # again, back to where it was
            do("flip")
            do("flip")
            do("get_flipper")
            do("put")
        if holds and error not in ("WAFER_LOST", "UNGRIP_TIMEOUT"):
            do("put")
    do("get")
    do("put")
    print("%d alarms" % len(alarms))


def flood(address, end, frame, count, wanted):
    """So many bytes of frames of which one in eight is wrong, while all that comes is read; then one good frame."""
    end = end.encode().decode("unicode_escape").encode()
    draw, line, sent = random.Random(20), Line(address, end), threading.Event()
    heard = threading.Thread(target=drain, args=(line, sent, re.compile(end + wanted.encode() + end + rb"\Z")))
    heard.start()
    good = with_sum(frame).encode() + end
    while count > 0:
        some = bytearray(good * 50)
        for _ in range(len(some) // 8):
            some[draw.randrange(len(some))] = draw.randrange(256)
        line.send(bytes(some))
        count -= len(some)
    line.send(end + b"".join([good] * 3))
    sent.set()
    heard.join()
    print(line.rest[line.rest.rfind(end, 0, -len(end)) + len(end):].rstrip(end).decode())


def drain(line, sent, wanted):
    """Until the last answer is the wanted one, a pattern, and nothing else comes; in vain for at most 20 s."""
    quiet = 0
    while quiet < 100:
        if not wait_for(line.fd, 0.2):
            quiet += 1
            if sent.is_set() and wanted.search(line.rest[-2000:]):
                return
            continue
        quiet = 0
        some = os.read(line.fd, 65536)
        if not some:
            sys.exit("host.py: the controller hung up")
        line.rest = (line.rest + some)[-200000:]


def with_sum(text):
    if not text.endswith("##"):
        return text
    return text[:-2] + "%02X" % (sum(text[text.find("$") + 1:-2].encode()) % 256)


def until_said(path, pattern):
    limit = time.monotonic() + 60
    while True:
        with open(path, encoding="utf-8") as file:
            if re.search(pattern, file.read(), re.M):
                return
        if time.monotonic() > limit:
            sys.exit("host.py: %s does not say %s" % (path, pattern))
        time.sleep(0.01)


def exchange(address, end, texts):
    end = end.encode().decode("unicode_escape").encode()
    line = Line(address, end)
    for text in texts:
        text = with_sum(text)
        if text.startswith("~"):
            time.sleep(float(text[1:]))
        elif text.startswith("@"):
            until_said(*text[1:].split(" ", 1))
        elif text == "?":
            print((line.take() or b"nothing").decode())
        elif text.startswith("!"):
            line.send(text[1:].encode() + end)
        else:
            line.send(text.encode() + end)
            print((line.take() or b"nothing").decode())


def resident(process):
    with open("/proc/%s/status" % process) as status:
        return next(int(line.split()[1]) for line in status if line.startswith("VmRSS:"))


def visit(address):
    """Another client asks, and goes without a word."""
    line = Line(address, b"\n")
    line.send(b"STATUS\nFLY\nSTAT")
    for expected in (b"OK phase=", b"ERROR 47 "):
        answer = line.take()
        if answer is None or not answer.startswith(expected):
            fail(answer)
    line.close()
    Line.opened.remove(line)


def command(line, text, expected=b"OK "):
    """The simulated seconds that it took."""
    line.send(text + b"\n")
    answer = line.take()
    if answer is None or not answer.startswith(expected):
        fail(answer)
    seconds = answer.rpartition(b" seconds=")[2]
    return float(seconds) if seconds != answer else 0.0


def hours(address, other, wanted, process):
    """At first more commands than are remembered: what a process has by then is what it needs."""
    line, simulated, count, first = Line(address, b"\n"), 0.0, 1100, None
    for _ in range(count):
        simulated += command(line, b"WAIT 0.001")
    while simulated < 3600 * float(wanted):
        for text in (b"GET A 1", b"PUT B 2", b"STATUS", b"GET B 2", b"PUT A 1", b"WAIT 5"):
            if text == b"WAIT 5":
                visit(other)
            simulated += command(line, text)
            count += 1
        command(line, b"GET B 2", b"ERROR 42 ")
        if first is None and simulated >= 1200 * float(wanted):
            first = resident(process)
    print("%d commands, %.1f hours, %d kB, %d kB" % (count, simulated / 3600, first, resident(process)))


def run(words):
    mode, rest = words[0], words[1:]
    if mode == "flood":
        flood(*rest[:3], int(rest[3]), rest[4])
    elif mode == "alarms":
        show_alarms(rest[0], rest[1], rest[2:])
    elif mode == "ends":
        show_ends(rest[0], rest[1], rest[2:])
    elif mode == "hours":
        hours(*rest)
    elif mode == "lines":
        exchange(rest[0], rest[1], rest[2:])
    elif mode == "python":
        sys.argv = ["test", *rest[1:]]
        exec(compile(rest[0], "test", "exec"), {"__name__": "test"})
    else:
        {"prompt": play_prompt, "words": play_words, "dollar": play_dollar, "verbs": play_verbs}[mode](*rest)


def one_request(words):
    """What it prints, and its exit status; its connections are closed, as a process's are."""
    said, status = io.StringIO(), 0
    with contextlib.redirect_stdout(said):
        try:
            run(words)
        except SystemExit as end:
            print(end.code)
            status = 1
        except Exception:  # what a process of its own would end with
            print(traceback.format_exc())
            status = 1
    for line in Line.opened:
        line.close()
    Line.opened.clear()
    return said.getvalue(), status


def session():
    reader = open(0, "rb", buffering=0)
    rest = b""

    def texts():
        nonlocal rest
        while True:
            while b"\0" not in rest:
                some = reader.read(65536)
                if not some:
                    return
                rest += some
            text, rest = rest.split(b"\0", 1)
            yield text.decode()

    words = texts()
    for count in words:
        said, status = one_request([next(words) for _ in range(int(count))])
        os.write(1, b"%s\0%d\0" % (said.encode(), status))


if sys.argv[1] == "session":
    session()
else:
    run(sys.argv[1:])
