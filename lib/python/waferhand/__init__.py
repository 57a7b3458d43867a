"""Simulated wafer robot cells for the tests of a tool's host software.

    with Cell("lua/layouts/paper.lua", dialect="words") as cell:
        host = my_driver(*cell.port)        # the tool's own software, unchanged
        cell.alarm("WAFER_MISSING")         # the next command that can fail so does
        ...
        assert cell.where("Wafer 1").station == "A"

The package starts `waferhand serve` and talks to its control port. It knows nothing of wafers, and needs the standard
library alone.
"""

from .cell import Cell, Line, Port, Untried
from .control import CellError, Event, Events, Where
from .program import NotStarted
from .transcript import Entry

__all__ = ["Cell", "CellError", "Entry", "Event", "Events", "Line", "NotStarted", "Port", "Untried", "Where"]
