"""Hostile sites, requests and clients at a page's port."""
import re
import socket
import time
import unittest

import page


def talk(served, data, wait=3.0):
    """What comes back to these bytes, until the end or for a while."""
    with socket.create_connection(("127.0.0.1", served.port()), 20) as line:
        line.settimeout(wait)
        got = b""
        try:
            line.sendall(data)
            while True:
                more = line.recv(65536)
                if not more:
                    break
                got += more
        except OSError:
            pass
        return got


class Safe(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.served = page.Served("run", "lua/examples/12_three_foups.lua", "--page", "127.0.0.1:0")
        cls.served.document()

    @classmethod
    def tearDownClass(cls):
        cls.served.kill()

    def status(self, path="/", **headers):
        return self.served.ask(path, **headers)[0]

    def test_hosts(self):
        port = self.served.port()
        for host in (f"127.0.0.1:{port}", f"localhost:{port}", f"LOCALHOST:{port}", f"[::1]:{port}", f"127.1.2.3:{port}"):
            self.assertEqual(self.status(Host=host), 200, host)
        for host in ("127.0.0.1", "localhost", f"evil.example:{port}", f"127.0.0.1.evil.example:{port}", f"localhost.evil:{port}",
                     f"127.0.0.1:{port + 1}", f"192.168.1.1:{port}", "", ":", f"127.0.0.1:{port}.evil", f"[::1:{port}",
                     f"127.0.0.1:0{port}", f"127.0.0.1:{port}\t", "x" * 5000, f"user@127.0.0.1:{port}", f"2130706433:{port}"):
            for path in ("/", "/document", "/stream?from=0", "/page.js", "/nothing"):
                self.assertIn(self.status(path, Host=host), (400, 403), (host, path))
        self.assertEqual(self.status(Host=None), 400)

    def test_origins(self):
        port = self.served.port()
        self.assertEqual(self.status("/document", Origin=f"http://{self.served.place}"), 200)
        for origin in ("null", "http://evil.example", f"https://{self.served.place}", f"http://127.0.0.1:{port + 1}",
                       f"http://localhost:{port}", f"http://{self.served.place}/", "http://", "file://", ""):
            for path in ("/document", "/", "/stream"):
                self.assertEqual(self.status(path, Origin=origin), 403, (origin, path))
        for site in ("cross-site", "same-site", "garbage"):
            self.assertEqual(self.status("/document", Sec_Fetch_Site=site), 403)
            self.assertEqual(self.status("/", Sec_Fetch_Site=site, Sec_Fetch_Mode="no-cors"), 403)
        self.assertEqual(self.status("/", Sec_Fetch_Site="cross-site", Sec_Fetch_Mode="navigate"), 200)
        self.assertEqual(self.status("/document", Sec_Fetch_Site="cross-site", Sec_Fetch_Mode="navigate"), 403)

    def test_headers(self):
        for path in ("/", "/document", "/page.js", "/page.css", "/foreign.js", "/nothing"):
            _, headers, _ = self.served.ask(path)
            policy = headers["Content-Security-Policy"]
            self.assertTrue(policy.startswith("default-src 'none'; script-src 'self';"))
            self.assertIn("frame-ancestors 'none'", policy)
            self.assertNotIn("script-src 'self' 'unsafe", policy)
            self.assertEqual(headers["X-Content-Type-Options"], "nosniff")
            self.assertEqual(headers["Cross-Origin-Resource-Policy"], "same-origin")
            self.assertIsNone(headers["Access-Control-Allow-Origin"])

    def test_page_has_no_script_of_its_own(self):
        """The policy forbids it, so that a name could never be one."""
        text = self.served.ask("/")[2]
        self.assertEqual(re.findall(r"<script(?! src=\"[a-z]+\.js\"></script>)", text), [])
        self.assertNotIn(" on", re.sub(r">[^<]*<", "><", text))

    def test_paths_and_methods(self):
        for path in ("/nothing", "/../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "/page.js/", "//", "/documents", "/document/x",
                     "/control", "/" + "a" * 3000, "/\\", "/?", "/stream/"):
            expected = 200 if path == "/?" else 404
            self.assertEqual(self.status(path), expected, path)
        for method in ("POST", "PUT", "DELETE", "OPTIONS", "HEAD", "PATCH", "TRACE", "BREW"):
            self.assertIn(self.served.ask("/", method=method, body=b"")[0], (405, 501), method)
        status, _, text = self.served.ask("/control", method="POST", body=b"{}", Content_Type="application/json")
        self.assertEqual((status, text), (403, "nothing can be commanded here (expected --page-control)\n"))

    def test_sizes(self):
        """What is too long is refused, and held nowhere."""
        place = self.served.place
        self.assertIn(b" 431 ", talk(self.served, f"GET / HTTP/1.1\r\nHost: {place}\r\nX: ".encode() + b"x" * 100000)[:20])
        self.assertRegex(talk(self.served, b"GET /" + b"x" * 100000)[:20], rb" 4(14|31) ")
        many = "".join(f"X{i}: y\r\n" for i in range(5000))
        self.assertIn(b" 431 ", talk(self.served, f"GET / HTTP/1.1\r\nHost: {place}\r\n{many}\r\n".encode())[:20])
        status, _, _ = self.served.ask("/control", method="POST", body=b"x" * 1000000, Content_Type="application/json")
        self.assertEqual(status, 403)
        for garbage in (b"\x00" * 100, b"\r\n\r\n\r\n", b"GET\r\n\r\n", b"GET / HTTP/9.9\r\n\r\n", bytes(range(256)) * 10,
                        b"GET / HTTP/1.1\r\nHost : x\r\n\r\n", b"GET / HTTP/1.1\r\nContent-Length: -1\r\n\r\n",
                        b"POST /control HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n"):
            self.assertNotIn(b" 200 ", talk(self.served, garbage, 0.3))
        self.assertEqual(self.status(), 200)

    def test_many_connections(self):
        """A crowd that says nothing: others wait at most until it is sent away."""
        crowd = []
        for _ in range(200):
            line = socket.socket()
            line.setblocking(False)
            line.connect_ex(("127.0.0.1", self.served.port()))
            crowd.append(line)
        begun = time.monotonic()
        self.assertEqual(self.status(), 200)
        waited = time.monotonic() - begun
        for line in crowd:
            line.close()
        self.assertLess(waited, 45)
        self.assertEqual(self.status(), 200)

    def test_slow_clients(self):
        """A head that comes byte by byte is given some seconds in all; so is a page that does not read, once nothing more goes to it."""
        begun = time.monotonic()
        asleep = page.Stream(self.served, self.served.document(), reads=False)
        with socket.create_connection(("127.0.0.1", self.served.port()), 20) as line:
            line.settimeout(0.5)
            ended = False
            line.sendall(b"GET / HTTP/1.1\r\nHost: ")
            while not ended and time.monotonic() - begun < 25:
                try:
                    line.sendall(b"x")
                    ended = line.recv(100) == b""
                except socket.timeout:
                    pass
                except OSError:
                    ended = True
        self.assertTrue(ended)
        self.assertLess(time.monotonic() - begun, 15)
        while asleep.at_server()[0] and time.monotonic() - begun < 60:
            time.sleep(0.1)
        self.assertEqual([asleep.at_server()[0], asleep.at_server()[1] > 0], [False, True])
        asleep.close()

    def test_streams_are_counted(self):
        """As many as there may be; the next is told so."""
        streams = [page.Stream(self.served, {}) for _ in range(40)]
        def is_refused(stream):
            return stream.raw.startswith(b"HTTP/1.1 503") or b"too many pages" in stream.raw

        end = time.monotonic() + 60
        while not all(stream.told or is_refused(stream) for stream in streams) and time.monotonic() < end:
            time.sleep(0.02)
        refused = sum(is_refused(stream) for stream in streams)
        told = sum(len(stream.told) > 0 for stream in streams)
        for stream in streams:
            stream.close()
        self.assertEqual((told, refused), (32, 8))
        told, end = [], time.monotonic() + 60
        while not told and time.monotonic() < end:
            again = page.Stream(self.served, {})
            while not again.told and not is_refused(again) and time.monotonic() < end:
                time.sleep(0.02)
            told = list(again.told)
            again.close()
        self.assertTrue(told)


class Open(unittest.TestCase):
    def test_another_address(self):
        """It is told that others can see it; a name is refused, an address is not."""
        served = page.Served("run", "lua/examples/01_transfer.lua", "--page", "0.0.0.0:0")
        self.addCleanup(served.kill)
        self.assertTrue(any("whoever reaches this machine can see the cell" in line for line in served.lines))
        port = served.port()
        self.assertEqual(served.ask(Host=f"10.1.2.3:{port}")[0], 200)
        self.assertEqual(served.ask(Host=f"robot.example:{port}")[0], 403)


if __name__ == "__main__":
    unittest.main()
