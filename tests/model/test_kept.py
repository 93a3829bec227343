"""Results kept for the next solution depend on all inputs of the first."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from mbsd import AssemblyError, Mechanism, constant_rate
from mbsd.base.running import MOST, Kept
from tools.models import linkages


def four_bar(crank: float = 0.04, start: float = 0.0, side: float = 100.0) -> Mechanism:
    law, near = constant_rate(6.0, start), (math.copysign(45, side), side)
    return linkages.four_bar(0.1, crank, 0.12, 0.08, near, masses=(0.1, 0.2, 0.15), law=law)


def poses(m: Mechanism) -> list[np.ndarray]:
    sol = m.sweep(steps=12)
    return [sol.q, sol.v, sol.a, sol.lam, m.simulate(0.2, steps=5).q]


CHANGED: dict[str, Callable[[], Mechanism]] = {
    "length": lambda: four_bar(crank=0.041),
    "start of the law": lambda: four_bar(start=0.3),
    "other assembly": lambda: four_bar(side=-100.0),
}


@pytest.mark.parametrize("what", CHANGED)
def test_another_mechanism_is_not_taken_for_the_one_before(what: str) -> None:
    import mbsd.kinematics.pose.close
    import mbsd.kinematics.pose.held_values
    import mbsd.kinematics.pose.mobility
    import mbsd.kinematics.prepared

    poses(four_bar())
    after = poses(CHANGED[what]())
    for kept in (mbsd.kinematics.pose.close._NEAREST, mbsd.kinematics.prepared._SAMPLES):
        kept._results.clear()
    mbsd.kinematics.pose.held_values._kept_independent.cache_clear()
    mbsd.kinematics.pose.mobility._kept_motion.cache_clear()
    anew = poses(CHANGED[what]())
    assert all(np.array_equal(reused, fresh) for reused, fresh in zip(after, anew, strict=True))


def test_again_and_after_changes_back_and_forth_the_numbers_are_the_same() -> None:
    m = four_bar()
    first = poses(m)
    m.change("motor", law=constant_rate(7.0, 0.2))
    assert not np.array_equal(poses(m)[0], first[0])
    m.change("motor", law=constant_rate(6.0))
    assert all(np.array_equal(again, before) for again, before in zip(poses(m), first, strict=True))


def test_a_result_that_is_written_into_spoils_no_other() -> None:
    m = four_bar()
    sol = m.sweep(steps=12)
    first = sol.q.copy()
    sol.q[:] = 0.0
    assert np.array_equal(m.sweep(steps=12).q, first)


def test_an_open_loop_is_not_tried_again_and_named_by_its_own_words(monkeypatch: pytest.MonkeyPatch) -> None:
    import mbsd.kinematics.pose.close as pose

    said = []
    for name in ("first", "second"):
        m = four_bar(crank=0.5)
        m.name = name
        with pytest.raises(AssemblyError) as raised:
            m.sweep(steps=12)
        said.append(str(raised.value))
        monkeypatch.setattr(pose, "close_with_phases", lambda *_: pytest.fail("it is closed again"))
    assert said[0].startswith("first: the links do not close")
    assert said[1] == said[0].replace("first", "second")


def test_welds_keep_their_turns() -> None:
    """The turn of a weld is settled with the start, and comes back with it."""
    m = Mechanism("welded")
    a, b = m.bar("a", 1.0, 1.0), m.bar("b", 1.0, 1.0)
    m.revolute("A", m.ground.at(0, 0), a.start)
    m.weld("W", a.end, b.at(0.0, 0.0))
    m.drive_angle("motor", a, constant_rate(1.0, 3 * math.pi))
    m.start_near(a=540, b=180)
    first = m.sweep(steps=4).q
    assert np.array_equal(m.sweep(steps=4).q, first)


def test_the_oldest_go_and_what_raises_is_not_kept() -> None:
    kept: Kept[int] = Kept()
    for k in range(MOST + 5):
        assert kept.get(k, lambda k=k: k) == k
    assert len(kept._results) == MOST
    with pytest.raises(ZeroDivisionError):
        kept.get("bad", lambda: 1 // 0)
    assert kept.get("bad", lambda: 3) == 3
    assert kept.get("bad", lambda: 4) == 3
