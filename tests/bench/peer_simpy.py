"""SimPy's side of the row `flow, against SimPy`: the tool of flow_tool.lua, in which each robot carries out the lists of flow.lua.

peer_simpy.py WAFERS prints the makespan. It keeps the times of each wafer, and the shares of each robot and station: a flow tells the same.
"""

import collections
import sys

import simpy

DOWN, UP, PROCESS, MOVE = 20, 15, 150, 2
MODULES = 6


class Lock:
    """A wafer, a pressure, and an event for whoever waits for either."""

    def __init__(self, env, side):
        self.env, self.side, self.full, self.leaving = env, side, False, False
        self.changed = env.event()
        self.pumps = 0

    def tell(self):
        changed, self.changed = self.changed, self.env.event()
        changed.succeed()

    def until(self, condition):
        while not condition():
            yield self.changed

    def pump(self, side, seconds):
        self.side = None
        yield self.env.timeout(seconds)
        self.side = side
        self.pumps += seconds
        self.tell()


class Tool:
    def __init__(self, count):
        self.env = simpy.Environment()
        self.count = count
        self.into, self.out = Lock(self.env, "atmosphere"), Lock(self.env, "vacuum")
        self.done = [0.0] * MODULES
        self.shares = collections.defaultdict(float)
        self.visits = []

    def spend(self, seconds, *what):
        self.shares[what] += seconds
        return self.env.timeout(seconds)

    def wait(self, robot, events):
        begin = self.env.now
        yield from events
        self.shares[robot, "waits"] += self.env.now - begin

    def carry(self, robot, handle, wafer, station):
        """From the pick to the place in front of the station, and the visit that begins."""
        visit = [wafer, station, robot, self.env.now]
        yield self.spend(handle, robot, "pick")
        visit.append(self.env.now)
        yield self.spend(MOVE, robot, "loaded")
        self.visits.append(visit)
        return visit

    def put(self, robot, handle, visit):
        visit.append(self.env.now)
        yield self.spend(handle, robot, "place")
        visit.append(self.env.now)

    def bring(self, i, at):
        env, into = self.env, self.into
        if at != "LP":
            yield self.spend(MOVE, "ATM", "empty")
        yield from self.wait("ATM", into.until(lambda: not into.full or into.leaving))
        visit = yield from self.carry("ATM", 3, i, "IN")
        yield from self.wait("ATM", into.until(lambda: into.side == "atmosphere"))
        yield from self.put("ATM", 3, visit)
        into.full = True
        env.process(into.pump("vacuum", DOWN))

    def take(self, i, at):
        env, out = self.env, self.out
        if at != "OUT":
            yield self.spend(MOVE, "ATM", "empty")
        yield from self.wait("ATM", out.until(lambda: out.full and out.side == "atmosphere"))
        out.leaving = True
        out.tell()
        visit = yield from self.carry("ATM", 3, i, "LP")
        out.full = out.leaving = False
        yield from self.put("ATM", 3, visit)
        env.process(out.pump("vacuum", DOWN))

    def atmosphere(self):
        at = "LP"
        for i in range(self.count + MODULES):
            if i < self.count:
                yield from self.bring(i, at)
                at = "IN"
            if i >= MODULES:
                yield from self.take(i - MODULES, at)
                at = "LP"

    def unload(self, i, module, at):
        env, out = self.env, self.out
        if at != module:
            yield self.spend(MOVE, "VAC", "empty")
        if self.done[module] > env.now:
            yield self.spend(self.done[module] - env.now, "VAC", "waits")
        yield from self.wait("VAC", out.until(lambda: not out.full or out.leaving))
        self.shares[module, "blocked"] += env.now - self.done[module]
        visit = yield from self.carry("VAC", 4, i, "OUT")
        yield from self.wait("VAC", out.until(lambda: out.side == "vacuum"))
        yield from self.put("VAC", 4, visit)
        out.full = True
        env.process(out.pump("atmosphere", UP))

    def load(self, i, module, at):
        env, into = self.env, self.into
        if at != "IN":
            yield self.spend(MOVE, "VAC", "empty")
        yield from self.wait("VAC", into.until(lambda: into.full and into.side == "vacuum"))
        into.leaving = True
        into.tell()
        visit = yield from self.carry("VAC", 4, i, module)
        # Whoever waits for room was told at the begin of the pick, which ends before anybody places.
        into.full = into.leaving = False
        yield from self.put("VAC", 4, visit)
        self.done[module] = env.now + PROCESS
        self.shares[module, "process"] += PROCESS
        env.process(into.pump("atmosphere", UP))

    def vacuum(self):
        at = "IN"
        for i in range(self.count + MODULES):
            module = i % MODULES
            if i >= MODULES:
                yield from self.unload(i - MODULES, module, at)
                at = "OUT"
            if i < self.count:
                yield from self.load(i, module, at)
                at = module

    def run(self):
        robots = [self.env.process(self.atmosphere()), self.env.process(self.vacuum())]
        self.env.run(until=simpy.AllOf(self.env, robots))
        return self.env.now


if __name__ == "__main__":
    print(f"makespan_s {Tool(int(sys.argv[1])).run():.6f}")
