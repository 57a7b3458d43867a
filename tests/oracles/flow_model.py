#!/usr/bin/env python3
"""A slow, plain model of flows of wafers through a tool of timed robots, written from the rules alone. It looks at every robot,
place and lock again at every instant. FLOW_CHOICES.md lists where the rules leave a choice, and which one was taken.

    result = run(tool, flow)

All times are whole microseconds. A tool is
    {"robots":   [{"name", "arms": 1, "at": station, "pick", "place", "move", "swap": None}],
     "serves":   {robot: [station, ...]},
     "stations": [{"name", "slots": 1, "process": None, "window": None,
                   "clean": None | {"after": k or None, "seconds", "empty": True, "idle": None},
                   "pump": None | {"down", "up", "empty_down", "empty_up"}, "state": "vacuum" | "atmosphere",
                   "sides": {robot: "vacuum" | "atmosphere"}, "ways": {slot: "in" | "out"},
                   "doors": None | {robot: {"open", "close"}}, "load_port": False,
                   "port": None | {"comes", "goes", "absent": False}}]}
process, after and idle are a number or {recipe: number} with "default". pick and place are a number or {station: number}, move a number or {(from, to): number}, swap None, a number or {station: number}.
A flow is
    {"lots":   [{"name", "wafers": [(name, station, slot), ...], "route", "arrives": 0, "priority": 0, "back": None, "dummy": False,
                 "recipes": {slot: recipe}}],
     "routes": {name: {"steps": [{"stations": [...], "process": None, "hot": False, "recipe": None}], "partial": {step: places kept empty}}},
     "rule":   "backward" | "swap" | "first_come" | "longest_wait" | {"order": {robot: [action, ...]}} | function(view, robot),
     "until": None, "down": [{"station", "at", "seconds": None for ever}], "takt": 0, "safe": True}
An action is (from, to), (from, to, wafer), (from, "keep"), ("keep", to), ("keep", to, wafer) or ("pump", station, state). A result is
    {"state": "done" | "STUCK" | "until" | "refused", "cause", "now", "circle": [names], "makespan", "cycle": None | (time, k), "why",
     "wafers": {name: [row, ...]}, "stays": [(wafer, station, over)], "robots": {name: {class: time}}, "pumps": [(station, to, begin, end)],
     "cleans": [(station, slot, begin, end)], "lost": [wafers in failed stations]}
and a row is (robot, arm, from station, from slot, pick begin, pick end, to station, to slot, place begin, place end, process begin,
process end)."""
import sys

import flow_calls
import flow_figures
import flow_locks
import flow_orders
from flow_parts import Refused, Robot, Station, Wafer, by_recipe
from flow_rules import SHIPPED


class Model:
    def __init__(self, tool, flow):
        self.flow, self.now = flow, 0
        self.stations = {given["name"]: Station(given) for given in tool["stations"]}
        self.robots = sorted((Robot(given, tool["serves"][given["name"]]) for given in tool["robots"]), key=lambda robot: robot.name)
        self.rule = flow.get("rule") or "backward"
        self.safe = flow.get("safe", True) and self.rule in SHIPPED
        self.takt, self.last_start = flow.get("takt") or 0, None
        self.instants = set()   # times at which something changes by itself
        self.stays, self.pumps, self.cleans = [], [], []
        self.routes, self.wafers = [], []
        self.common = {(a, b): [robot for robot in self.robots if {a, b} <= robot.serves] for a in self.stations for b in self.stations}
        self.relaxed = False
        self.seen = set()       # states since anything was under way or to come
        self.by_hand = flow_orders.pumped_by_hand(self.rule)
        for down in flow.get("down") or []:
            end = None if down["seconds"] is None else down["at"] + down["seconds"]
            self.stations[down["station"]].down.append((down["at"], end))
            fails = min((other["at"] for other in flow["down"] if other["station"] == down["station"] and other["seconds"] is None), default=None)
            self.instants |= {down["at"]} | ({end} if end is not None and (fails is None or end < fails) else set())
        self.read_lots()

    def read_lots(self):
        lots = sorted(enumerate(self.flow["lots"]), key=lambda pair: (pair[1].get("arrives", 0), -pair[1].get("priority", 0), pair[0]))
        ordered = [lot for _, lot in lots]
        for lot in ordered:
            for name, station, slot in lot["wafers"]:
                self.wafers.append(Wafer(name, lot, len(self.wafers), self.stations[station].places[slot - 1]))
            self.instants.add(lot.get("arrives", 0))
        self.ahead = [lot for lot in ordered if not self.stations[lot["wafers"][0][1]].port]   # they come one after another
        self.calls = flow_calls.Calls(self, [lot for lot in ordered if lot not in self.ahead])
        for lot in self.flow["lots"]:
            if lot["route"] not in self.routes:
                self.routes.append(lot["route"])
        for wafer in self.wafers:
            wafer.steps = [([wafer.home], 0, False, None), *map(self.read_step, self.flow["routes"][wafer.route]["steps"])]
            back = wafer.lot.get("back")
            if back and {place.station.name for place in wafer.steps[-1][0]} == {back}:
                wafer.steps.pop()
            if back:
                wafer.steps.append(([self.stations[back].places[wafer.home.slot - 1]], 0, False, None))

    def read_step(self, step):
        places = [place for name in step["stations"] for place in self.stations[name].places]
        return places, step.get("process"), step.get("hot", False), step.get("recipe")

    # ----------------------------------------------------------------------------------------------------------- steps
    def following(self, wafer, number, here=None):
        """The step after this one, without those whose stations have all failed, and without one behind them in whose place it lies
        already (`here`). None behind the last."""
        here, out = [wafer.place] if here is None else here, False
        for after in range(number + 1, len(wafer.steps)):
            places = wafer.steps[after][0]
            failed = all(place.station.failed_at(self.now) for place in places)
            if not failed and not (out and any(place in here for place in places)):
                return after
            out = out or failed
        return None

    def count(self, wafer, number, by=None, without=None, refilled=False):
        """How many wafers of its route count in a step, and how many may: rule 12. Others' wafers and what is down take places away.
        With `by`, picks that have begun and end by then have ended."""

        def gone(place):
            return by is not None and place.leaves is not None and place.leaves <= by
        mine = [each for each in self.wafers if each.route == wafer.route and not each.ended and (
            each.toward == number or each.place and each.step == number and not gone(each.place))]
        taken = down = 0
        for place in wafer.steps[number][0]:
            inside = [each for each in (place.wafer, place.coming) if each and not (each is place.wafer and (gone(place) or each is without and not refilled))]
            taken += bool(inside) and not any(each in mine for each in inside)
            down += not inside and place.station.down_at(self.now)
        kept = max(down, self.partial(wafer, number))   # what is down is kept empty
        return len([each for each in mine if each is not without]), len(wafer.steps[number][0]) - taken - kept

    def partial(self, wafer, number):
        return (self.flow["routes"][wafer.route].get("partial") or {}).get(number, 0)

    # ----------------------------------------------------------------------------------------------------------- times
    def pressure_from(self, station, robot):
        """When its pressure is right for the robot; None if nobody knows."""
        side = station.sides.get(robot.name)
        if not station.pump or side is None:
            return self.now
        if station.turning:
            return station.turning[1] if station.turning[0] == side else None
        return self.now if station.state == side else None

    def clean_due(self, place):
        """The wafer that leaves now leaves it to be cleaned."""
        clean = place.station.clean
        return bool(clean and clean.get("empty", True) and clean.get("after") and place.count + 1 >= by_recipe(clean["after"], place.recipe))

    def placing_from(self, robot, place, arrival):
        """When placing can begin, as far as anybody knows; None if nobody does."""
        station = place.station
        pressure, clean = self.pressure_from(station, robot), place.clean_end or 0
        if pressure is None:
            return None
        if place.leaves is not None and self.clean_due(place):
            begin = station.up_from(place.leaves + place.closing, self.now)
            clean = begin + station.clean["seconds"] if begin is not None else 0
        begin = station.up_from(max(arrival, pressure, clean, place.leaves or 0, station.busy_until), self.now)
        return None if begin is None else begin + station.door(robot)[0]

    def picking_from(self, robot, wafer, arrival):
        """When its pick (its door, if any) can begin, the destination apart; None if nobody knows."""
        place = wafer.place
        pressure = self.pressure_from(place.station, robot)
        if pressure is None or wafer.done is None:
            return None
        takt = self.last_start + self.takt if wafer.step == 0 and self.last_start is not None else 0
        return place.station.up_from(max(arrival, wafer.done, pressure, place.station.busy_until, takt), self.now)

    def arrival(self, robot, station):
        return self.now + robot.move(robot.at, station.name)

    # ---------------------------------------------------------------------------------------------------- destinations
    def may_enter(self, robot, place, wafer):
        """It serves the place, its slot is for this way, nobody else is under way to it, and it is neither down nor a shut port."""
        open_now = not place.station.down_at(self.now) and not self.calls.shut(place.station)
        return self.enters(robot, place) and place.coming in (None, wafer) and open_now

    def enters(self, robot, place):
        way = place.station.ways.get(place.slot)
        right = not way or way == ("in" if place.station.sides.get(robot.name) == "atmosphere" else "out")
        return place.station.name in robot.serves and right

    def destinations(self, robot, wafer, number, start, begin, refilled=False):
        """Places of step `number` that are or will be empty (rule 4) if the robot begins to take the wafer from `start` at `begin`,
        best first (rule 7). `start` None: it is aboard. `begin` None: nobody knows when."""
        found = []
        for index, place in enumerate(wafer.steps[number][0]):
            if not self.may_enter(robot, place, wafer):
                continue
            arrival = begin
            if begin is not None:
                arrival += robot.move(start.station.name if start else robot.at, place.station.name)
                arrival += start.station.door(robot)[0] + robot.seconds("pick", start.station.name) if start else 0
            ready = None if arrival is None else arrival + place.station.door(robot)[0]
            if place.wafer is None or place.leaves is not None and (ready is None or place.leaves <= ready):
                placing = self.placing_from(robot, place, self.now if arrival is None else arrival)
                if begin is None and start:     # nobody knows when: the nearest, all that runs over
                    placing = placing and robot.move(start.station.name, place.station.name) + place.station.door(robot)[0]
                since = place.empty_since if place.leaves is None else place.leaves
                found.append(((placing is None, placing or 0, since, index), place, ready))
        found.sort(key=lambda each: each[0])
        return [place for _, place, ready in found if self.has_room(wafer, number, ready, refilled)]

    def has_room(self, wafer, number, ready, refilled):
        """`refilled`: an exchange takes it out, so that its place is filled again."""
        if not self.partial(wafer, number):
            return True
        count, may = self.count(wafer, number, by=ready if ready is not None else 1 << 62, without=wafer, refilled=refilled)
        return count < may

    def carries(self, robot, wafer):
        """The robot serves the wafer's place and a place of the step behind."""
        after = self.following(wafer, wafer.step)
        return wafer.place is not None and after is not None and wafer.place.station.name in robot.serves and any(
            place.station.name in robot.serves for place in wafer.steps[after][0])

    # ---------------------------------------------------------------------------------------------------- what is begun
    def go(self, robot, station):
        """Begins to move, unless it is there; True if it does."""
        seconds = robot.move(robot.at, station.name)
        if robot.at == station.name:
            return False

        def arrive():
            robot.at, robot.going = station.name, None
        robot.intervals.append(("moving loaded" if robot.held() else "moving empty", self.now, self.now + seconds))
        robot.doing, robot.going = (self.now + seconds, arrive), station.name
        return True

    def access(self, robot, station, kind, seconds):
        """The station is taken by an opening door, the pick, place or swap, and a shutting door. Returns begin, end and shut."""
        opening, closing = station.door(robot)
        begin, end = self.now + opening, self.now + opening + seconds
        if opening:
            robot.intervals.append(("door", self.now, begin))
            self.instants.add(begin)
        robot.intervals.append((kind, begin, end))
        station.busy_until = end + closing
        return begin, end, end + closing

    def free(self, robot, station):
        """Pick, place or swap may begin there now, the place itself apart."""
        return robot.at == station.name and station.busy_until <= self.now and not station.down_at(self.now) and not self.calls.shut(station) and (
            self.pressure_from(station, robot) == self.now and not station.turning)

    def start_row(self, robot, wafer, arm, place, begin, end):
        wafer.rows.append([robot.name, arm + 1, place.station.name, place.slot, begin, end] + [None] * 6)
        ready = wafer.rows[-2][11] if len(wafer.rows) > 1 else wafer.done
        window = place.station.window
        if window is not None and wafer.step > 0 and begin - ready > window:
            self.stays.append((wafer.name, place.station.name, begin - ready - window))
        if wafer.step == 0:
            self.last_start = self.now

    def pick(self, robot, wafer, destination):
        """Destination None: it is kept, or the rule swap decides when it is aboard."""
        place, number = wafer.place, self.following(wafer, wafer.step)
        arm = robot.free_arm(wafer.steps[wafer.step][2])
        if arm is None:
            raise Refused(f"{robot.name}: no arm is free for {wafer.name}")
        begin, end, shut = self.access(robot, place.station, "picking", robot.seconds("pick", place.station.name))
        self.start_row(robot, wafer, arm, place, begin, end)
        place.leaves, place.closing = end, shut - end
        wafer.begun, self.relaxed = self.now, False
        if destination:
            wafer.toward, wafer.destination, destination.coming = number, destination, wafer

        def picked():
            due = self.clean_due(place)
            place.wafer = place.leaves = None
            place.count, place.empty_since, place.idle_from = place.count + 1, end, end
            if due:
                self.start_clean(place, shut)
            wafer.place, wafer.robot, robot.arms[arm] = None, robot, wafer
            wafer.kept = None if destination else end
        robot.doing = (end, picked)

    def start_clean(self, place, time):
        begin = place.station.up_from(time)
        if begin is None:
            return
        place.clean_end, place.count, place.idle_from = begin + place.station.clean["seconds"], 0, None
        self.cleans.append((place.station.name, place.slot, begin, place.clean_end))

    def put(self, robot, wafer, place, begin, end, shut):
        """What its placing will have done: known as soon as it has begun."""
        number = wafer.toward
        process, recipe = wafer.steps[number][1], wafer.steps[number][3] or wafer.recipe
        process = by_recipe(place.station.process, recipe) or 0 if process is None else process
        ready = place.station.up_from(shut)
        wafer.rows[-1][6:] = [place.station.name, place.slot, begin, end, ready, None if ready is None else ready + process]
        wafer.done = None if ready is None else ready + process
        clean = place.station.clean
        if clean and not clean.get("empty", True) and clean.get("after") and place.count + 1 >= by_recipe(clean["after"], recipe) and wafer.done is not None:
            self.cleans.append((place.station.name, place.slot, wafer.done, wafer.done + clean["seconds"]))
            wafer.done, place.count = wafer.done + clean["seconds"], -1

        def placed():
            robot.arms[robot.arms.index(wafer)] = None
            wafer.place, place.wafer, place.coming, place.recipe = place, wafer, None, recipe
            wafer.robot = wafer.toward = wafer.destination = wafer.kept = None
            wafer.step, wafer.entered, place.filling = number, end, False
            wafer.ended = self.following(wafer, number) is None
        return placed

    def place(self, robot, wafer, place):
        begin, end, shut = self.access(robot, place.station, "placing", robot.seconds("place", place.station.name))
        if wafer.toward is None:
            wafer.toward = self.following(wafer, wafer.step)
        wafer.destination, place.coming, place.filling = place, wafer, True
        robot.doing = (end, self.put(robot, wafer, place, begin, end, shut))

    def swap(self, robot, wafer, place, heading):
        """Places the wafer and takes what lies there, which goes on to `heading`."""
        other, arm = place.wafer, robot.free_arm(place.wafer.steps[place.wafer.step][2])
        begin, end, shut = self.access(robot, place.station, "swapping", robot.seconds("swap", place.station.name))
        self.relaxed = False
        self.start_row(robot, other, arm, place, begin, end)
        other.begun, other.toward, other.destination, heading.coming = self.now, self.following(other, other.step), heading, other
        wafer.destination, place.coming, place.filling = place, wafer, True
        place.count += 1
        placed = self.put(robot, wafer, place, begin, end, shut)

        def swapped():
            other.place, other.robot, other.kept = None, robot, end
            placed()
            robot.arms[arm] = other
        robot.doing = (end, swapped)

    def turn(self, station, state):
        empty = not any(place.wafer for place in station.places)
        down = state == "vacuum"
        seconds = station.pump["down" if down else "up"]
        if empty and station.pump.get("empty_down" if down else "empty_up") is not None:
            seconds = station.pump["empty_down" if down else "empty_up"]
        station.turning = (state, self.now + seconds)
        self.pumps.append((station.name, state, self.now, self.now + seconds))

    # ------------------------------------------------------------------------------------------------------ an instant
    def end_all(self):
        for station in self.stations.values():
            if station.turning and station.turning[1] <= self.now:
                station.state, station.turning = station.turning[0], None
            for place in station.places:
                if place.clean_end is not None and place.clean_end <= self.now:
                    place.clean_end = None
        for robot in self.robots:
            if robot.doing and robot.doing[0] <= self.now:
                finish, robot.doing = robot.doing[1], None
                finish()
        self.end_routes()
        while self.calls.go():
            self.end_routes()
        while self.ahead and self.ahead[0].get("arrives", 0) <= self.now and self.may_come(self.ahead[0]):
            self.come(self.ahead.pop(0))
            self.end_routes()

    def end_routes(self):
        """Wafers in stations that have failed, and those with no step left."""
        for wafer in self.wafers:
            if wafer.lies() and not wafer.ended and wafer.place.station.failed_at(self.now):
                wafer.ended = wafer.lost = True
            wafer.ended = wafer.ended or wafer.lies() and self.following(wafer, wafer.step) is None

    def is_over(self, lot):
        return all(wafer.ended for wafer in self.wafers if wafer.lot is lot)

    def may_come(self, lot):
        """A carrier stays until its lot is over: nobody else comes into its wafers' last places, or is to come back there."""
        mine = [wafer for wafer in self.wafers if wafer.lot is lot]
        others = [wafer for wafer in self.wafers if wafer.entered is not None and wafer.lot.get("back") and not self.is_over(wafer.lot)]
        taken = {wafer.steps[-1][0][0] for wafer in others}
        ends = {wafer.steps[-1][0][0] for wafer in mine if lot.get("back")}
        homes = {wafer.home for wafer in mine}
        lying = [place.wafer for place in homes if place.wafer]
        return not taken & (homes | ends) and not any(place.coming for place in homes) and all(self.is_over(wafer.lot) for wafer in lying)

    def come(self, lot):
        for wafer in (each for each in self.wafers if each.lot is lot):
            if wafer.home.wafer:
                wafer.home.wafer.place = None
            wafer.place, wafer.home.wafer, wafer.entered, wafer.done = wafer.home, wafer, self.now, self.now
            wafer.home.recipe = wafer.recipe

    def begin_all(self):
        """Cleans after idle time, and pumps; processes and cleans that are due were begun with what ended."""
        for station in self.stations.values():
            idle = (station.clean or {}).get("idle")
            for place in station.places:
                if idle is not None and self.idle_due(place) is not None and self.idle_due(place) <= self.now:
                    self.start_clean(place, self.now)
            self.turn_if_wanted(station)

    def idle_due(self, place):
        """When a clean after idle time is due, None if none is: once for each stretch without a wafer."""
        if place.wafer or place.filling or place.idle_from is None or place.clean_end or not (place.station.clean or {}).get("idle"):
            return None
        return place.station.up_from(place.idle_from + by_recipe(place.station.clean["idle"], place.recipe))

    def ask_all(self):
        begun = True
        while begun:
            begun = False
            for robot in self.robots:
                if robot.doing is None and flow_orders.ask(self, robot):
                    begun = True
        for station in self.stations.values():
            if any(robot.brings and robot.brings[0] is station for robot in self.robots):
                self.turn_if_wanted(station)

    def turn_if_wanted(self, station):
        if station.pump and not station.turning and station.busy_until <= self.now and station.name not in self.by_hand:
            side = flow_locks.wanted_side(self, station)
            if side and side != station.state and not station.down_at(self.now):
                self.turn(station, side)

    def ask_relaxed(self):
        """Nobody can go on: shipped rules do without the conditions that only make a robot wait for more wafers to come."""
        before, self.relaxed = self.relaxed, self.rule in SHIPPED
        begun = self.relaxed and any(flow_orders.ask(self, robot) for robot in self.robots)
        self.relaxed = self.relaxed and before  # a transfer that has begun ends it
        return begun

    def nothing_follows(self):
        """No robot has begun more than an empty way, and nothing ends or comes by itself."""
        for robot in self.robots:
            if robot.doing and (robot.going is None or any(wafer.destination for wafer in robot.held())):
                return False
        ends = [time for time in self.instants if time > self.now]
        ends += [wafer.done for wafer in self.wafers if wafer.place and not wafer.ended and wafer.done is not None]
        for station in self.stations.values():
            ends += [place.clean_end for place in station.places if place.clean_end is not None]
            ends += [due for due in map(self.idle_due, station.places) if due is not None]
        if self.last_start is not None:
            ends.append(self.last_start + self.takt)
        return all(time <= self.now for time in ends)

    def goes_round(self):
        """True if nothing follows and the state is an earlier one's: it will come again for ever. Rules of one's own may change their mind."""
        if callable(self.rule) or not self.nothing_follows():
            self.seen.clear()
            self.relaxed = False
            return False
        robots = tuple((robot.going or robot.at, robot.doing and robot.doing[0] - self.now, repr(robot.behind), robot.next) for robot in self.robots)
        stations = tuple((station.state, station.turning and (station.turning[0], station.turning[1] - self.now),
                          max(0, station.busy_until - self.now)) for station in self.stations.values())
        state = (self.relaxed, robots, stations)
        again = state in self.seen
        self.seen.add(state)
        return again

    def relax(self):
        """From now on shipped rules wait for no fuller step, until a transfer begins. False if they do so already."""
        if self.relaxed or self.rule not in SHIPPED:
            return False
        self.relaxed = True
        return True

    def in_time(self, robot, wafer):
        """From when on places of its next step that are being emptied will be empty by the time the wafer comes there (rule 4)."""
        for place in wafer.steps[self.following(wafer, wafer.step)][0]:
            if place.leaves is not None and place.station.name in robot.serves:
                way = robot.move(wafer.place.station.name, place.station.name) + place.station.door(robot)[0]
                yield place.leaves - way - robot.seconds("pick", wafer.place.station.name) - wafer.place.station.door(robot)[0]

    def next_instant(self):
        times = {time for time in self.instants if time > self.now}
        times |= {robot.doing[0] for robot in self.robots if robot.doing}
        times |= {wafer.done for wafer in self.wafers if wafer.place and not wafer.ended and wafer.done is not None}
        for station in self.stations.values():
            times |= {station.busy_until} | ({station.turning[1]} if station.turning else set())
            times |= {place.clean_end for place in station.places if place.clean_end is not None}
        if self.last_start is not None and any(wafer.step == 0 and wafer.lies() for wafer in self.wafers):
            times.add(self.last_start + self.takt)
        times |= {time for robot in self.robots if robot.doing is None and robot.waits for time in self.in_time(robot, robot.waits)}
        times = {time for time in times if time > self.now}
        if times:   # a clean for want of wafers brings nobody further
            idle = (self.idle_due(place) for station in self.stations.values() for place in station.places)
            times |= {time for time in idle if time is not None and time > self.now}
        return min(times, default=None)

    def run(self):
        until = self.flow.get("until")
        while True:
            while True:
                self.end_all()
                self.begin_all()
                self.ask_all()
                if not any(robot.doing and robot.doing[0] <= self.now for robot in self.robots):
                    break
            if all(wafer.ended for wafer in self.wafers):
                return "done"
            if self.goes_round() and not self.relax():
                return "STUCK"
            after = self.next_instant()
            if after is None and self.ask_relaxed():
                continue    # others may follow at once (rule 2)
            if after is None:
                return "STUCK"
            if until is not None and after > until:
                return "until"
            for robot in self.robots:
                if robot.doing is None:
                    robot.intervals.append((robot.told or "waiting for wafer", self.now, after))
            self.now = after


def run(tool, flow):
    model, cause = None, None
    try:
        model = Model(tool, flow)
        state = model.run()
    except Refused as refused:
        state, cause = "refused", str(refused)
    if model is None:
        return {"state": state, "cause": cause}
    counted = [wafer for wafer in model.wafers if wafer.ended and not wafer.lost and not wafer.lot.get("dummy")]
    ends = sorted(wafer.rows[-1][9] for wafer in counted if wafer.rows)
    placings = [row[9] for wafer in model.wafers for row in wafer.rows if row[9] is not None and row[9] <= model.now]
    makespan = max(placings, default=0)
    cycle, why = flow_figures.steady_cycle(ends)
    return {"state": state, "cause": cause, "now": model.now, "circle": flow_figures.circle(model) if state == "STUCK" else [], "makespan": makespan,
            "cycle": cycle, "why": why, "wafers": {wafer.name: [tuple(row) for row in wafer.rows] for wafer in model.wafers},
            "lost": [wafer.name for wafer in model.wafers if wafer.lost], "stays": model.stays, "robots": flow_figures.split(model, makespan),
            "pumps": model.pumps, "cleans": model.cleans}


if __name__ == "__main__":
    import flow_tables
    sys.exit(flow_tables.main(sys.argv[1:]))
