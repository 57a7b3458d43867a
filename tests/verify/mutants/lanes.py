"""Places in which mutants of the host rooms are built and tested: a copy of the tree each, with a build that differs in one
object. What the program and its tests are made of is a shared library, so that a mutant takes one compilation and one link."""

import filecmp
import os
import re
import shutil
import subprocess

LIBRARY = "libhost.so"
SANITIZED = {"ASAN_OPTIONS": "detect_leaks=1:abort_on_error=0", "UBSAN_OPTIONS": "print_stacktrace=0"}


def quiet(command, folder, limit, more=None):
    """The exit status, or None after so many seconds."""
    try:
        return subprocess.run(command, cwd=folder, env={**os.environ, **(more or {})}, stdin=subprocess.DEVNULL,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=limit, check=False,
                              start_new_session=True).returncode
    except subprocess.TimeoutExpired:
        return None


class Commands:
    """How make compiles and links, from what it says it would do."""

    def __init__(self, path, build):
        self.build = build
        self.compiling, self.linking = {}, {}
        with open(path, encoding="utf-8") as file:
            for line in file:
                source = re.search(r" -c -o \S+ (lib/\S+\.c)$", line.strip())
                target = re.search(r" -o (\S+) \S+\.o ", line)
                if source:
                    self.compiling.setdefault(source.group(1), line.strip())
                elif target:
                    self.linking[os.path.relpath(target.group(1), build)] = line.strip()

    def compile(self, source, target, options=""):
        """The command that compiles a source into `target`."""
        command = re.sub(r" -MMD -MP -c -o \S+ ", f" {options} -w -c -o {target} ", self.compiling[source])
        return ["sh", "-c", command]

    def link_library(self, target):
        """All that the program consists of but its main(), as a shared library."""
        command = self.linking["waferhand"].replace(f"{self.build}/obj/lib/app/main.o", "")
        command = command.replace(" -Wl,-E ", " -shared ")
        archives = re.findall(rf"{self.build}/\S+\.a", command)
        for archive in archives:
            command = command.replace(archive, f"-Wl,--whole-archive {archive} -Wl,--no-whole-archive")
        return re.sub(r" -o \S+", f" -o {target}", command)

    def link_program(self, name, library):
        """A test or the program itself, against that library."""
        objects = "lib/app/main" if name == "waferhand" else name
        flags = self.linking[name].split(" -o ")[0].lstrip("@")
        return f"{flags} -o {self.build}/{name} {self.build}/obj/{objects}.o {library} -lcmocka -llcm -lm -lpthread"


class Lane:
    """A copy of the tree."""

    def __init__(self, folder, commands, build):
        self.folder, self.commands, self.build = folder, commands, build
        self.library = os.path.join(build, LIBRARY)
        os.makedirs(folder)
        subprocess.run(f"git ls-files -z | tar -c --null -T - | tar -x -C {folder}", shell=True, check=True)
        shutil.copytree(build, os.path.join(folder, build), symlinks=True)
        for name in os.listdir(build):
            os.symlink(os.path.join(folder, build, name), os.path.join(folder, "build", name))

    def environment(self):
        """In which tests find the library."""
        return {**SANITIZED, "LD_LIBRARY_PATH": os.path.join(self.folder, self.build)}

    def finish(self, tests):
        """Links the library, and the program and the tests against it."""
        self.link()
        for name in ["waferhand", *tests]:
            command = self.commands.link_program(name, self.library)
            if quiet(["sh", "-c", command], self.folder, 300) != 0:
                raise SystemExit(f"mutation: {name} does not link: {command}")

    def link(self):
        """False if it does not link."""
        command = self.commands.link_library(self.library)
        return quiet(["sh", "-c", command], self.folder, 300) == 0

    def object_of(self, source):
        """As it stands in the build."""
        return os.path.join(self.build, "obj", source[:-2] + ".o")

    def differs(self, source, text):
        """Does the changed file compile, and to something else? At -O2, where lines do not count."""
        objects = []
        for content in (None, text):
            if content is not None:
                self.write(source, content)
            objects.append(f"build/{len(objects)}.o")
            command = self.commands.compile(source, objects[-1], "-O2 -g0 -fno-sanitize=all")
            if quiet(command, self.folder, 120) != 0:
                self.restore(source)
                return False
        self.restore(source)
        return not filecmp.cmp(*(os.path.join(self.folder, name) for name in objects), shallow=False)

    def write(self, source, text):
        with open(os.path.join(self.folder, source), "w", encoding="utf-8") as file:
            file.write(text)

    def restore(self, source):
        shutil.copy2(source, os.path.join(self.folder, source))

    def change(self, source, text):
        """Builds the library with the changed file. False if it cannot be built."""
        self.write(source, text)
        made = quiet(self.commands.compile(source, self.object_of(source)), self.folder, 300) == 0
        return made and self.link()

    def undo(self, source):
        """As it was before."""
        self.restore(source)
        shutil.copy2(self.object_of(source), os.path.join(self.folder, self.object_of(source)))
        self.link()

    def run(self, test, limit):
        """None after so many seconds, else the exit status."""
        program = os.path.join(self.build, test) if re.match(r"tests/(unit|property|firmware)/", test) else test
        return quiet([os.path.join(self.folder, program)], self.folder, limit, self.environment())
