"""The fixture `cell`: the cell that the mark of a test describes.

    @pytest.mark.cell("lua/layouts/paper.lua", dialect="words")
    def test_a_pick(cell): ...
"""

from __future__ import annotations

from typing import Iterator

import pytest

from .cell import Cell


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "cell(layout, dialect, ...): the cell that the fixture `cell` runs")


@pytest.fixture
def cell(request: pytest.FixtureRequest) -> Iterator[Cell]:
    mark = request.node.get_closest_marker("cell")
    if mark is None:
        raise pytest.UsageError('the fixture `cell` needs a mark (expected @pytest.mark.cell("layout.lua"))')
    with Cell(*mark.args, **mark.kwargs) as running:
        yield running
