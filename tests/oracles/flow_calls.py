"""Carriers of flow_model's load ports that have a "port": FLOW_CHOICES.md 34 to 37."""


class Call:
    """Lots that come in one carrier."""

    def __init__(self, station, lots):
        self.station, self.lots = station, lots
        self.phase, self.until = "awaited", None


class Calls:
    def __init__(self, model, lots):
        self.model, self.list, self.changes = model, [], {}     # changes: of a full carrier at a port for ends, until when
        self.come = set()       # names of lots that are there
        for lot in lots:
            station = model.stations[lot["wafers"][0][1]]
            slots = {slot for _, _, slot in lot["wafers"]}
            mine = [call for call in self.list if call.station is station and call.lots[0].get("arrives", 0) == lot.get("arrives", 0)
                    and not any(slots & {slot for _, _, slot in other["wafers"]} for other in call.lots)]
            if mine:
                mine[0].lots.append(lot)
            else:
                self.list.append(Call(station, [lot]))
        for station in model.stations.values():
            station.for_ends = bool(station.port) and not self.at(station)

    def at(self, station):
        return [call for call in self.list if call.station is station]

    def current(self, station):
        return next((call for call in self.at(station) if call.phase in ("coming", "there", "going")), None)

    def shut(self, station):
        if not station.port:
            return False
        if not self.at(station):
            return station.name in self.changes
        call = self.current(station)
        return call is None or call.phase != "there"

    def awaited(self, station):
        """A wafer that has come is to pass or to end there."""
        model = self.model
        lots = [wafer.lot for wafer in model.wafers if wafer.entered is not None and any(
            place.station is station for places, *_ in wafer.steps[1:] for place in places)]
        return any(not model.is_over(lot) for lot in lots)

    def pass_on(self, call, phase, seconds=None):
        call.phase, call.until = phase, None if seconds is None else self.model.now + seconds
        if call.until is not None:
            self.model.instants.add(call.until)
        return True

    def go(self):
        """What can end or begin now; True if anything did."""
        return any([*map(self.change, self.model.stations.values()), *map(self.advance, self.list), *map(self.arrive, self.list)])

    def advance(self, call):
        model, station, port = self.model, call.station, call.station.port
        if call.phase == "awaited" and call.lots[0].get("arrives", 0) <= model.now and self.current(station) is None:
            there = not port.get("absent") and call.lots[0].get("arrives", 0) == 0 and call is self.at(station)[0]
            return self.pass_on(call, "there") if there else self.pass_on(call, "coming", port["comes"])
        if call.phase == "coming" and call.until <= model.now:
            return self.pass_on(call, "there")
        idle = not any(robot.doing and robot.going is None and robot.at == station.name for robot in model.robots)
        if call.phase == "there" and all(lot["name"] in self.come and model.is_over(lot) for lot in call.lots) and not self.awaited(station) and idle:
            return self.pass_on(call, "going", port["goes"])
        if call.phase == "going" and call.until <= model.now:
            self.empty(station)
            return self.pass_on(call, "gone")
        return False

    def arrive(self, call):
        came = False
        for lot in call.lots if call.phase == "there" else []:
            if lot["name"] not in self.come and lot.get("arrives", 0) <= self.model.now and self.model.may_come(lot):
                self.come.add(lot["name"])
                self.model.come(lot)
                came = True
        return came

    def empty(self, station):
        for place in station.places:
            if place.wafer:
                place.wafer.place = place.wafer = None
                place.empty_since = self.model.now

    def change(self, station):
        if not station.port or self.at(station):
            return False
        if station.name in self.changes:
            if self.changes[station.name] > self.model.now:
                return False
            del self.changes[station.name]
            self.empty(station)
            return True
        if all(place.wafer and place.wafer.ended for place in station.places) and station.busy_until <= self.model.now:
            self.changes[station.name] = self.model.now + station.port["goes"] + station.port["comes"]
            self.model.instants.add(self.changes[station.name])
            return True
        return False
