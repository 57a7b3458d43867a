"""Stations with their places, robots and wafers of flow_model."""


class Refused(Exception):
    """An answer that can never begin, or a description that makes no sense."""


def by_recipe(value, recipe):
    """A number, or that of the recipe, or else of "default"."""
    return value.get(recipe, value["default"]) if isinstance(value, dict) else value


class Place:
    def __init__(self, station, slot):
        self.station, self.slot = station, slot
        self.wafer = None       # what lies here, until the end of the pick
        self.coming = None      # what is under way to here
        self.filling = False    # its placing has begun
        self.leaves = None      # end of the pick that has begun
        self.closing = 0        # how long its door shuts behind that pick
        self.empty_since = 0
        self.count = 0          # wafers since the last clean
        self.recipe = None      # of the wafer that lies here, or lay here last
        self.clean_end = None
        self.idle_from = 0      # without a wafer since then; None: and cleaned


class Station:
    def __init__(self, given):
        self.name = given["name"]
        self.process, self.window = given.get("process"), given.get("window")
        self.clean, self.pump, self.port = given.get("clean"), given.get("pump"), given.get("port")
        self.state = given.get("state", "atmosphere")
        self.sides, self.doors, self.ways = given.get("sides") or {}, given.get("doors") or {}, given.get("ways") or {}
        self.places = [Place(self, slot) for slot in range(1, given.get("slots", 1) + 1)]
        self.for_ends = False   # a port at which no lot begins: its carrier is changed when it is full
        self.busy_until = 0     # end of the pick, place or swap, its door shut
        self.turning = None     # (state, end)
        self.down = []          # (begin, end), end None for ever

    def door(self, robot):
        doors = self.doors.get(robot.name) or {}
        return doors.get("open", 0), doors.get("close", 0)

    def down_at(self, time):
        return bool(self.down) and any(begin <= time and (end is None or time < end) for begin, end in self.down)

    def failed_at(self, time):
        return bool(self.down) and any(begin <= time for begin, end in self.down if end is None)

    def up_from(self, time, known=None):
        """The first time from `time` on at which it is not down; None if there is none. `known`: what begins later is not known yet."""
        while self.down:
            ends = [end for begin, end in self.down if begin <= (time if known is None else min(time, known)) and (end is None or time < end)]
            if not ends:
                return time
            if None in ends:
                return None
            time = max(ends)
        return time


class Robot:
    def __init__(self, given, serves):
        self.given, self.name, self.serves = given, given["name"], set(serves)
        self.at = given["at"]
        self.arms = [None] * given.get("arms", 1)
        self.doing = None       # (end, what it does at the end)
        self.going = None       # the station to which it moves
        self.told = None        # why it waits, a class of IDLE_CLASSES
        self.brings = None      # (station, wafer): it is told to bring this one, which it keeps, into an empty place there
        self.waits = None       # the wafer in front of which it stands by its list, and which has no place to go to yet
        self.intervals = []     # (class, begin, end)
        self.behind = None      # backward: the step that was served last
        self.next = 0           # lists: the next action

    def seconds(self, what, station):
        value = self.given.get(what)
        if what == "swap" and (value is None or isinstance(value, dict) and station not in value):
            return self.seconds("pick", station) + self.seconds("place", station) + self.move(None, None)
        return value[station] if isinstance(value, dict) else value

    def move(self, start, end):
        value = self.given["move"]
        if start == end and start is not None:
            return 0
        if not isinstance(value, dict):
            return value
        if start is None:
            raise Refused(f"{self.name}: swap has no default, since move is a table")
        return value[(start, end)]

    def held(self):
        return [wafer for wafer in self.arms if wafer]

    def free_arm(self, hot=False):
        free = [number for number, wafer in enumerate(self.arms) if wafer is None and (not hot or number == 1)]
        return free[0] if free else None


class Wafer:
    def __init__(self, name, lot, order, place):
        self.name, self.lot, self.order, self.home = name, lot, order, place
        self.route = lot["route"]
        self.recipe = (lot.get("recipes") or {}).get(place.slot)
        self.steps = None       # of each step its places, process, hot and recipe
        self.step = 0           # the step in whose place it lies or lay last
        self.place = None       # where it lies, until the end of the pick
        self.toward = None      # the step to which a transfer has begun
        self.destination = None
        self.robot = None       # who has it aboard
        self.kept = None        # since when it is kept on an arm
        self.entered = self.done = None     # done is known as soon as its placing has begun
        self.begun = None       # when its transfer began
        self.ended = self.lost = False
        self.stranded = False   # aboard before a station that has failed, and no place behind is free
        self.rows = []

    def lies(self):
        return self.place is not None and self.toward is None and self.place.leaves is None
