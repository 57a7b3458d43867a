"""Compiles mutants and links them with the rest of the library; the tests are built already."""

import filecmp
import functools
import glob
import hashlib
import os
import re
import subprocess

LIBRARY = "libwaferhand.so"


def rooms():
    """The firmware rooms, in the order of the data."""
    with open("lib/build/rooms.mk", encoding="utf-8") as file:
        names = re.search(r"^LIBRARY_ROOMS := (.*)$", file.read(), re.M).group(1).split()
    for name in names:
        if not glob.glob(f"lib/{name}/*.c"):
            raise SystemExit(f"mutation: there is no source in lib/{name}")
    return names


def run(command, **options):
    return subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                          check=False, **options).returncode == 0


class Builder:
    def __init__(self, folder, compiler, flags):
        self.compiler = compiler
        self.flags = [*flags.split(), "-O2", "-g0", "-fPIC", "-w", "-c"]
        self.link_command = [compiler, "-shared"]
        version = subprocess.run([compiler, "--version"], capture_output=True, check=True, text=True).stdout
        self.identity = version.split("\n")[0] + flags
        self.originals = os.path.join(folder, "originals")
        self.files = sorted(path for room in rooms() for path in glob.glob(f"lib/{room}/*.*"))
        self.sources = [path for path in self.files if path.endswith(".c")]
        os.makedirs(self.originals, exist_ok=True)
        for source in self.sources:
            if not self.compile(source, self.object_of(source, self.originals), []):
                raise SystemExit(f"mutation: {source} does not compile")
        if not self.link(self.originals, {}):
            raise SystemExit("mutation: the library does not link")

    @staticmethod
    def object_of(source, folder):
        return os.path.join(folder, re.sub(r"[/.]", "_", source) + ".o")

    def compile(self, source, target, options):
        try:
            return run([self.compiler, *options, *self.flags, "-o", target, source], timeout=60)
        except subprocess.TimeoutExpired:
            return False

    @staticmethod
    @functools.lru_cache(maxsize=None)
    def symbols(path, kind):
        """Of an object: `defined` or `undefined`."""
        out = subprocess.run(["nm", "-g", "--format=just-symbols", f"--{kind}-only", path], capture_output=True,
                             check=True, text=True)
        return set(out.stdout.split())

    def reached_from(self, test_object):
        """The sources whose code a test can run: those that it needs, and those that these need."""
        objects = {source: self.object_of(source, self.originals) for source in self.sources}
        defined = {source: self.symbols(path, "defined") for source, path in objects.items()}
        wanted, reached = set(self.symbols(test_object, "undefined")), set()
        while True:
            more = {source for source in objects if source not in reached and defined[source] & wanted}
            if not more:
                return reached
            reached |= more
            for source in more:
                wanted |= self.symbols(objects[source], "undefined")

    def link(self, folder, replaced):
        objects = [replaced.get(source) or self.object_of(source, self.originals) for source in self.sources]
        return run([*self.link_command, "-o", os.path.join(folder, LIBRARY), *objects])

    def is_original(self, path, target):
        return filecmp.cmp(self.object_of(path, self.originals), target, shallow=False)

    def lay_out(self, folder, replaced):
        """A copy of the library's tree, by links, without the file to be replaced: includes are relative."""
        for path in self.files:
            name = os.path.join(folder, path)
            os.makedirs(os.path.dirname(name), exist_ok=True)
            if path != replaced:
                os.symlink(os.path.abspath(path), name)

    def build(self, source, text, folder):
        """The hash of what the mutated file compiles to, or None; then its objects are in the folder."""
        name = os.path.join(folder, source.path)
        self.lay_out(folder, source.path)
        with open(name, "w", encoding="utf-8") as file:
            file.write(text)
        target = os.path.join(folder, "mutant.o")
        # A header by itself, with its functions made visible.
        alone = ["-x", "c", "-Dstatic=", "-Dinline="] if source.is_header else []
        if not self.compile(name, target, alone):
            return None
        with open(target, "rb") as file:
            return hashlib.sha256(file.read()).hexdigest()[:16]

    def finish(self, source, folder):
        """Links what build() has compiled; of a header everything that includes it is compiled first. False: it
        does not compile or link there, or all is the same, as no file uses the function."""
        replaced = {source.path: os.path.join(folder, "mutant.o")}
        if source.is_header:
            replaced = {path: self.object_of(path, folder) for path in self.sources}
            if not all(self.compile(os.path.join(folder, path), target, []) for path, target in replaced.items()):
                return False
            if all(self.is_original(path, target) for path, target in replaced.items()):
                return False
        return self.link(folder, replaced)
