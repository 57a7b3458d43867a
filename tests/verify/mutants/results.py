"""What earlier runs found, so that an interrupted one goes on where it was."""

import json
import os
import threading


class Results:
    """A line for each finding, appended at once."""

    def __init__(self, path):
        self.known = {}
        self.lock = threading.Lock()
        if os.path.exists(path):
            with open(path, encoding="utf-8") as file:
                for line in file:
                    if line.endswith("\n"):
                        entry = json.loads(line)
                        self.known.setdefault(entry.pop("key"), {}).update(entry)
        self.file = open(path, "a", encoding="utf-8")

    def get(self, key):
        return self.known.get(key, {})

    def put(self, key, entry):
        with self.lock:
            self.known.setdefault(key, {}).update(entry)
            self.file.write(json.dumps({"key": key, **entry}) + "\n")
            self.file.flush()
