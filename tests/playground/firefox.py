"""The playground in headless Firefox, from disk, driven by Marionette, Firefox's own protocol: messages of JSON behind their length."""
import json
import pathlib
import socket
import subprocess
import tempfile
import time

PAGE = pathlib.Path(__file__).resolve().parents[2] / "build/playground.html"
FRAME = "document.querySelector('iframe:not([hidden])')"


class Firefox:
    def __init__(self, profile):
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = probe.getsockname()[1]
        (pathlib.Path(profile) / "user.js").write_text(f'user_pref("marionette.port", {self.port});\n', encoding="utf-8")
        self.process = subprocess.Popen(["firefox-esr", "--headless", "--marionette", "--no-remote", "--profile", profile],
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.socket, self.rest, self.number = self.connect(), b"", 0
        self.read()
        self.ask("WebDriver:NewSession")

    def connect(self):
        for _ in range(600):
            try:
                return socket.create_connection(("127.0.0.1", self.port), 120)
            except OSError:
                time.sleep(0.1)
        raise AssertionError("Firefox does not listen")

    def read(self):
        while b":" not in self.rest:
            self.rest += self.socket.recv(65536)
        size, self.rest = self.rest.split(b":", 1)
        while len(self.rest) < int(size):
            self.rest += self.socket.recv(65536)
        message, self.rest = self.rest[:int(size)], self.rest[int(size):]
        return json.loads(message)

    def ask(self, command, **arguments):
        self.number += 1
        text = json.dumps([0, self.number, command, arguments]).encode()
        self.socket.sendall(str(len(text)).encode() + b":" + text)
        _, _, error, answer = self.read()
        assert error is None, error
        return answer

    def js(self, script):
        return self.ask("WebDriver:ExecuteScript", script=script, args=[], sandbox=None)["value"]

    def wait(self, condition, seconds=120):
        end = time.monotonic() + seconds
        while not self.js("return " + condition):
            assert time.monotonic() < end, "still not so: " + condition
            time.sleep(0.1)

    def close(self):
        self.socket.close()
        self.process.terminate()
        self.process.wait(30)


def main():
    with tempfile.TemporaryDirectory() as profile:
        firefox = Firefox(profile)
        try:
            firefox.ask("WebDriver:Navigate", url=PAGE.as_uri())
            firefox.wait("!!window.Playground && !!Playground.result && !!Playground.result.answer")
            assert firefox.js("return document.getElementById('hash').textContent") == "e4e148111c08e2e0"
            firefox.wait(f"!!{FRAME}.contentWindow.Waferhand && !!{FRAME}.contentWindow.Waferhand.shown")
            firefox.js("Playground.files.show('lua/layouts/paper.lua');"
                       "Playground.editor.mirror.setValue(Playground.files.text('lua/layouts/paper.lua').replace('13.794', '13.5'))")
            firefox.wait("document.getElementById('hash').textContent !== 'e4e148111c08e2e0' && !Playground.runner.busy")
            firefox.wait(f"{FRAME}.contentWindow.Waferhand.shown.run.hash === document.getElementById('hash').textContent")
            print("Firefox: the page works from disk, and shows the next document")
        finally:
            firefox.close()


if __name__ == "__main__":
    main()
