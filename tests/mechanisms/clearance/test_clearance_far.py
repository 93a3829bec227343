"""Bodies that are settled at once are those whose pieces stay apart one by one."""

from __future__ import annotations

import numpy as np
import pytest

from mechanisms.stages.clearance import path
from mechanisms.stages.clearance import stage as clearance_stage
from mechanisms.stages.clearance.path import paths
from mechanisms.stages.clearance.search import Sweep
from shared.contract import Motion
from tests.mechanisms.clearance.clearance_pieces import box, parts_of
from tests.mechanisms.clearance.test_clearance_between import motion_of

REACH = 5.0


def snake(count: int) -> Motion:
    """Bodies side by side (70 mm) that swing to and fro and turn, each at its own rate."""
    t = np.linspace(0.0, 1.0, 41)
    bodies = {}
    for k in range(count):
        w, a = 3.0 + k, 0.04
        s, c = a * np.sin(w * t), a * np.cos(w * t)
        turn = np.stack([w * t, w + 0 * t, 0 * t])
        bodies[f"b{k}"] = (0.07 * k + s, c, turn[0], w * c, -w * s, turn[1], -w * w * s, -w * w * c, turn[2])
    return motion_of(t, **bodies)


def test_bodies_that_are_far_have_pieces_that_are_apart() -> None:
    motion = snake(6)
    pieces = [box(f"b{k}", f"p{k}", 12.0, 5.0, 0.0, (20.0, 8.0, 4.0)) for k in range(6)]
    where = paths(motion)
    far_pairs = path.far_bodies(pieces, where, REACH)
    assert 0 < len(far_pairs) < 15
    for a in pieces:
        for b in pieces:
            if frozenset((a.body, b.body)) in far_pairs:
                assert Sweep(a, b, where[a.body], where[b.body]).is_apart(REACH)


def test_the_check_is_the_same_with_and_without(monkeypatch: pytest.MonkeyPatch) -> None:
    motion = snake(5)
    pieces = [box(f"b{k}", f"p{k}", 0.0, 0.0, 6.0 * k, (20.0, 8.0, 4.0)) for k in range(5)]
    clearance = clearance_stage.check(parts_of(pieces), motion, pieces, "0" * 64)
    monkeypatch.setattr(path, "far_bodies", lambda *_: set())
    assert clearance_stage.check(parts_of(pieces), motion, pieces, "0" * 64) == clearance
    assert clearance.apart > 0
