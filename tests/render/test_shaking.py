"""What inertia does to the frame, in data.json, the report, the plots and the page."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mbsd import Mechanism, harmonic
from mechanisms.stages.solve.motion_file import to_motion
from render.magnitudes import shaking
from render.plots import plots_of
from render.plots.pages.forces import frame
from render.plots.quantities import known_names, quantity
from render.plots.style import house_style
from render.report import report
from render.view.payload import couple_of, frame_of
from shared.contract import Motion, read_motion, write_motion
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


def test_orders_are_in_the_file_the_report_and_the_page_as_the_solution_has_them(tmp_path: Path) -> None:
    m = two_cylinders()
    m.bodies["piston_1"].mass = 0.7
    motion, sol = motion_of(m), m.sweep(steps=360)
    vibration, exact = motion.vibration, sol.orders(sol.shaking().force)
    assert vibration is not None
    assert (vibration.crank, vibration.turns) == ("crank", 1)
    force_orders, k = vibration.harmonics["shaking force"], vibration.order.index(1.0)
    row = exact.index(1)
    assert force_orders.amplitude[1][k] == pytest.approx(exact.amplitude[row, 1])
    assert force_orders.phase[1][k] == pytest.approx(exact.phase[row, 1])
    assert force_orders.forward[k] + force_orders.backward[k] == pytest.approx(exact.largest[row])
    torque = sol.orders(sol.driver("motor").effort)
    assert vibration.harmonics["motor"].amplitude[0][1] == pytest.approx(torque.amplitude[torque.index(2)])
    main = sol.orders(sol.joint("main").reaction)
    assert vibration.harmonics["main"].amplitude[0][1] == pytest.approx(main.amplitude[main.index(2), 0])
    centre = sol.centre_of_mass()
    assert vibration.y == pytest.approx(centre.y)
    text = report(motion, None, None)
    assert "## Orders" in text
    assert "goes 0 m along x" in text
    page = frame_of(motion)
    assert page is not None
    assert page["crank"] == "crank"
    assert all(bars["size"].any() for bars in page["harmonics"].values())  # what is rounding is no bar
    assert page["harmonics"]["motor"]["size"][1] == pytest.approx(torque.largest[torque.index(2)], rel=1e-6)
    assert "frame" in plots_of(motion)
    with house_style():
        assert len(frame(motion).axes) == 3
    write_motion(tmp_path / "data.json", motion)
    assert read_motion(tmp_path / "data.json").vibration == vibration


def test_a_motion_without_a_crank_or_without_mass_has_no_orders() -> None:
    m = Mechanism("pendulum")
    arm = m.bar("arm", 1.0, mass=1.0)
    m.revolute("A", m.ground.origin, arm.start)
    m.drive_angle("motor", arm, harmonic(0.3, 1.0))
    assert motion_of(m).vibration is None
    m = two_cylinders()
    for name in ("piston_1", "piston_2"):
        m.bodies[name].mass = 0.0
    assert motion_of(m).vibration is None
