"""Each stroke of each mechanism's skeleton is carried to where it is drawn."""

from __future__ import annotations

import pytest

from mbsd.drawing.moving_skeleton import moving
from mechanisms.stages.loading import loading
from mechanisms.stages.solve import solving
from shared.stage.paths import mechanism_names
from tests.drawing.test_carried import check


@pytest.mark.parametrize("name", mechanism_names())
def test_each_stroke_is_carried_to_where_it_is_drawn(name: str) -> None:
    module, p = loading.load(name, "mechanism"), loading.params(name)
    solution = solving.motion_of(name, module, solving.build(name, module, p), p)
    skeleton = moving(solution)
    check(solution, skeleton)
    drivers = [driver.replace("_", " ") for driver in solution.mechanism.drivers]
    written = " ".join(label.text for label, _ in skeleton.names).replace("_", " ")
    assert all(driver in written for driver in drivers)
