"""What inertia does to the frame, in data.json, the report, the plots and the page."""

from __future__ import annotations

import numpy as np
import pytest

from mbsd import Mechanism
from mechanisms.stages.solve.motion_file import to_motion
from render.plots.quantities import known_names, quantity
from render.report import report
from render.shaking import shaking
from render.view.payload import couple_of
from shared.contract import Motion
from tests.results.test_couples import two_cylinders


def motion_of(m: Mechanism) -> Motion:
    sources = dict.fromkeys(m.bodies, "mechanism")
    return to_motion(m.sweep(steps=360), None, "0" * 64, {}, sources)  # pyright: ignore[reportArgumentType]


def test_couples_are_shown_everywhere_as_the_solution_has_them() -> None:
    m = two_cylinders()
    motion, exact = motion_of(m), m.sweep(steps=360).shaking()
    assert motion.couple is not None
    assert (motion.couple.about, motion.couple.reach) == (0.0, pytest.approx(0.1))
    assert motion.couple.mx == pytest.approx(exact.mx, abs=1e-12)
    largest = float(np.abs(exact.mx).max())
    assert quantity(motion, "shaking couple").components["x"] == pytest.approx(exact.mx, abs=1e-9 * largest)
    assert "| couple | 5 N m | 0 N m |" in report(motion, None, None)
    on_the_page = couple_of(motion)
    assert on_the_page is not None
    assert not on_the_page["my"].any()
    assert shaking(motion).fy == pytest.approx(exact.fy, abs=1e-6 * np.abs(exact.fy).max())


def test_without_places_nothing_is_said_of_couples() -> None:
    motion = motion_of(two_cylinders((0.0, 0.0)))
    assert motion.couple is None
    assert "shaking couple" not in known_names(motion)
    assert "Shaking" not in report(motion, None, None)
    assert couple_of(motion) is None
