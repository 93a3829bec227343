"""Events in the compiled loop that release joints which stick or which others repeat: as in single simulations."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import pytest

from mbsd import Mechanism
from mbsd.measures import samples
from tools.models.releases import broken_cranks, dry_chain, held_up, motor_and_cranks, twin_hinges
from tools.models.repeated_joints import cranks, dry

STEPS, DURATION = 40, 1.2


Build = Callable[[], Mechanism]
CASES: dict[str, tuple[Build, str, str, Sequence[str]]] = {
    "dry chain": (dry_chain, "a", "arm", ("A.fx", "hinge.fy", "axle.fy")),
    "held up": (held_up, "coupler", "coupler", ("A.fy", "A.torque", "B.fx", "clock.effort")),
    "twin hinges": (twin_hinges, "arm", "arm", ("hinge.fy", "twin.fx")),
    "cranks": (lambda: broken_cranks(cranks()), "coupler", "coupler", ("A0.fx", "A1.fy", "B1.fx", "B2.fy")),
    "stops": (lambda: broken_cranks(cranks(stops=True)), "coupler", "coupler", ("A0.fx", "A1.fy", "B2.fy")),
    "friction": (lambda: broken_cranks(dry(False)), "coupler", "coupler", ("A0.fx", "A2.fx", "B0.fy")),
    "sticks": (lambda: broken_cranks(dry(True)), "coupler", "coupler", ("A0.fx", "A2.fx", "B0.fy")),
    "motor": (motor_and_cranks, "crank2", "crank1", ("A0.fx", "B1.fx", "motor.effort")),
}


@pytest.mark.parametrize("case", CASES)
def test_joints_let_go_as_in_single_simulations(case: str) -> None:
    build, varied, body, reactions = CASES[case]
    times, masses = np.linspace(0.0, DURATION, STEPS + 1), [0.5, 0.9, 1.4]
    names = [f"{body}.{part}" for part in ("x", "theta", "omega")]
    measure = {name: samples(name, times.tolist()) for name in (*names, *reactions)}
    many = build().simulate_many(times=times, vary={varied: {"mass": masses}}, measure=measure)
    assert many.alone == [None] * len(masses), many.way
    met = 0
    for k, mass in enumerate(masses):
        m = build()
        m.change(varied, mass=mass)
        sol = m.simulate(times=times)
        met += sum(event.what == "event" for event in sol.events)
        columns = dict(zip([c.rpartition(" [")[0] for c in sol.columns()], sol.columns().values(), strict=True))
        for name in (*names, *reactions):
            allowed = 1e-8 if name in names else 1e-6 * max(1.0, float(np.abs(columns[name]).max()))
            np.testing.assert_allclose(many[name][k], columns[name], rtol=0.0, atol=allowed, err_msg=name)
    assert met >= len(masses)


def test_a_row_in_which_nothing_breaks_is_that_of_the_whole_machine() -> None:
    whole, broken = cranks(), broken_cranks(cranks())
    times, own = np.linspace(0.0, 0.1, 5), samples("A1.fy", [0.05, 0.1])
    vary = {"coupler": {"mass": [0.5, 2.0]}}
    ways = [m.simulate_many(times=times, vary=vary, measure={"own": own}) for m in (whole, broken)]
    assert ways[1].alone == [None, None]
    np.testing.assert_allclose(ways[0]["own"], ways[1]["own"], rtol=1e-8)


def test_rows_begin_with_all_joints_and_any_number_of_threads_gives_the_same() -> None:
    masses = [0.5, 1.4, 0.5, 0.9, 0.5]
    given = [
        dry_chain().simulate_many(
            DURATION, vary={"a": {"mass": masses}}, measure={"x": samples("arm.x", [0.6, 1.2])}, steps=6, threads=n
        )["x"]
        for n in (1, 2)
    ]
    np.testing.assert_array_equal(given[0], given[1])
    np.testing.assert_array_equal(given[0][0], given[0][2])
    np.testing.assert_array_equal(given[0][0], given[0][4])
