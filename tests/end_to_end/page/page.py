"""A program with --page, and a client that reads its page as a browser does, or as an attacker might."""
import http.client
import json
import os
import pathlib
import re
import signal
import socket
import subprocess
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parents[3]
PROGRAM = ROOT / "build/waferhand"


class Served:
    """A process with a page; `place` is its address and port."""

    def __init__(self, *arguments, **more):
        self.process = subprocess.Popen([PROGRAM, *map(str, arguments)], cwd=ROOT, text=True, stdout=subprocess.PIPE,
                                        stderr=subprocess.PIPE, stdin=more.get("stdin", subprocess.DEVNULL))
        self.lines = []
        self.place = None
        self.ready = threading.Event()
        self.reader = threading.Thread(target=self.read, daemon=True)
        self.reader.start()
        if not self.ready.wait(20) or not self.place:
            self.process.kill()
            raise AssertionError("no page: " + "".join(self.lines))

    def read(self):
        for line in self.process.stderr:
            self.lines.append(line)
            found = re.search(r"page at http://([^/]+)/", line)
            if found:
                self.place = found[1]
                self.ready.set()
        self.ready.set()

    def said(self, text, seconds=60):
        """Waits until standard error has this text."""
        end = time.monotonic() + seconds
        while not any(text in line for line in self.lines):
            if time.monotonic() > end:
                raise AssertionError(f"never said: {text}: {self.lines}")
            time.sleep(0.01)

    def end(self, number=signal.SIGINT):
        """(exit status, standard output), as an operator ends it."""
        self.process.send_signal(number)
        out = self.process.stdout.read()
        status = self.process.wait(20)
        self.reader.join(5)
        self.process.stdout.close()
        self.process.stderr.close()
        return status, out

    def kill(self):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        self.reader.join(5)
        self.process.stdout.close()
        self.process.stderr.close()

    def port(self):
        return int(self.place.rsplit(":", 1)[1])

    def ask(self, path="/", method="GET", body=None, **headers):
        """(status, headers, body); a header is given with _ for -."""
        connection = http.client.HTTPConnection("127.0.0.1", self.port(), timeout=20)
        told = {name.replace("_", "-"): value for name, value in headers.items()}
        connection.putrequest(method, path, skip_host="Host" in told)
        if body is not None:
            told["Content-Length"] = str(len(body))
        for name, value in told.items():
            if value is not None:
                connection.putheader(name, value)
        connection.endheaders(body)
        answer = connection.getresponse()
        text = answer.read()
        connection.close()
        return answer.status, answer.headers, text.decode()

    def document(self):
        """{ next, state, document }, once there is a cell."""
        for _ in range(500):
            status, _, text = self.ask("/document")
            if status == 200:
                return json.loads(text)
            time.sleep(0.02)
        raise AssertionError("no document: " + text)

    def until(self, condition, seconds=60):
        """The first document for which this is true."""
        end = time.monotonic() + seconds
        while True:
            got = self.document()
            if condition(got):
                return got
            if time.monotonic() > end:
                raise AssertionError(f"never so: {got['state']} at {got['document']['duration_s']} s")
            time.sleep(0.02)


class Stream:
    """A reader of the feed; `told` are (number, kind, object)."""

    def __init__(self, served, document, reads=True):
        """After what a document of the server says; {}: from nowhere. Without `reads` nobody reads it until wake(), and the buffers
        between are as small as they can be: some 40 kB fill them."""
        self.socket = socket.socket()
        self.socket.settimeout(20)
        if not reads:
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1)
            self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_MAXSEG, 88)
        self.socket.connect(("127.0.0.1", served.port()))
        self.served = served
        request = f"GET /stream?from={document.get('next', 0)}&id={document.get('id', '')} HTTP/1.1\r\nHost: {served.place}\r\n\r\n"
        self.socket.sendall(request.encode())
        self.told = []
        self.raw = b""
        self.rest = b""
        self.thread = threading.Thread(target=self.read, daemon=True)
        if reads:
            self.thread.start()

    def at_server(self):
        """(whether the server keeps the connection, the bytes that it has written and that the other end has no room for)"""
        ends = [f":{port:04X}" for port in (self.served.port(), self.socket.getsockname()[1])]
        for line in pathlib.Path("/proc/net/tcp").read_text().splitlines()[1:]:
            _, here, there, state, queues = line.split()[:5]
            if here.endswith(ends[0]) and there.endswith(ends[1]):
                return state == "01", int(queues.split(":")[0], 16)
        return False, 0

    def wake(self):
        self.thread.start()

    def read(self):
        head = True
        while True:
            try:
                got = self.socket.recv(65536)
            except OSError:
                return
            if not got:
                return
            self.raw += got
            if head and b"\r\n\r\n" in self.raw:
                self.raw = self.raw.split(b"\r\n\r\n", 1)[1]
                head = False
            if not head:
                self.unchunk()

    def unchunk(self):
        while b"\r\n" in self.raw:
            size, after = self.raw.split(b"\r\n", 1)
            count = int(size, 16)
            if len(after) < count + 2:
                return
            self.rest += after[:count]
            self.raw = after[count + 2:]
        while b"\n\n" in self.rest:
            message, self.rest = self.rest.split(b"\n\n", 1)
            fields = dict(line.split(": ", 1) for line in message.decode().split("\n") if ": " in line and line[0] != ":")
            if "event" in fields:
                self.told.append((int(fields["id"]), fields["event"], json.loads(fields["data"])))

    def wait(self, condition, seconds=60):
        end = time.monotonic() + seconds
        while not condition(self.told):
            if time.monotonic() > end:
                raise AssertionError(f"not told: {[kind for _, kind, _ in self.told][-20:]}")
            time.sleep(0.01)

    def close(self):
        self.socket.close()


def resident(process):
    """Bytes of memory."""
    return int(pathlib.Path(f"/proc/{process.pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def processor(process):
    """Seconds of processor time of each thread of a process, the first one's first."""
    folder = pathlib.Path(f"/proc/{process.pid}/task")
    times = {}
    for task in folder.iterdir():
        fields = (task / "stat").read_text().rsplit(")", 1)[1].split()
        times[int(task.name)] = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    return [times[process.pid]] + [each for task, each in sorted(times.items()) if task != process.pid]
