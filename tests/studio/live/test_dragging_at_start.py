"""Dragging a mechanism that forces move: its numbers decide where things are at the start, and there alone."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import mechanisms
from mechanisms.stages.loading import loading
from shared.stage import paths
from shared.stage.errors import UserError
from studio.live.child.author import Author
from studio.live.child.dragging import dragged

SWING = '''"""Two rods hung up, with a spring."""

from dataclasses import dataclass

from mbsd import Mechanism

DURATION = 0.5


@dataclass(frozen=True)
class Params:
    """m, degrees, N/m."""

    upper: float = 0.3
    lower: float = 0.2
    angle: float = -60.0  # of the upper rod at the start
    turn: float = 0.0  # of the lower one
    stiffness: float = 3e4


def build(p: Params) -> Mechanism:
    """Pins A and B."""
    m = Mechanism("swing")
    upper, lower = m.bar("upper", SIZE * p.upper, mass=1.0), m.bar("lower", SIZE * p.lower, mass=0.5)
    m.revolute("A", m.ground.at(0, 0), upper.start)
    m.revolute("B", upper.end, lower.start)
    m.spring("spring", m.ground.at(0.3 * SIZE, 0), upper.end, stiffness=p.stiffness, free_length=0.2 * SIZE)
    m.trace("tip", lower.end)
    m.start_near(upper=p.angle, lower=p.turn)
    return m
'''


@pytest.fixture(params=[0.1, 1.0, 30.0])
def swing(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> tuple[Author, float]:
    """Return the mechanism at some size, under a name of its own, since modules are loaded once."""
    root, name = tmp_path / "mechanisms", f"swing_{len(request.node.name)}_{10 * request.param:.0f}"
    (root / name).mkdir(parents=True)
    text = SWING.replace("DURATION", f"SIZE = {request.param}\nDURATION", 1).replace('"swing"', f'"{name}"')
    (root / name / "mechanism.py").write_text(text)
    for module in (paths, loading):
        monkeypatch.setattr(module, "MECHANISMS", root)
    monkeypatch.setattr(paths, "ROOT", tmp_path)
    monkeypatch.setattr(mechanisms, "__path__", [*mechanisms.__path__, str(root)])
    return Author(name, lambda files: None), request.param


def tip(values: dict[str, float]) -> np.ndarray:
    """Return the tip of the lower rod at the start, for rods of these numbers."""
    upper, lower = np.radians(values["angle"]), np.radians(values["turn"])
    return values["upper"] * np.array([np.cos(upper), np.sin(upper)]) + values["lower"] * np.array(
        [np.cos(lower), np.sin(lower)]
    )


def test_numbers_put_a_thing_there_at_the_start(swing: tuple) -> None:
    author, size = swing
    to = size * np.array([0.4, -0.2])
    numbers = dragged(author, {}, {"kind": "point", "name": "tip"}, 0.0, list(to))
    assert set(numbers) == {"upper", "lower", "angle", "turn"}, "a stiffness moves nothing at the start"
    np.testing.assert_allclose(size * tip(numbers), to, atol=1e-3 * size)  # numbers have four digits
    joint = dragged(author, {}, {"kind": "joint", "name": "B"}, 0.0, [0.1 * size, -0.3 * size])
    assert set(joint) == {"upper", "angle"}
    assert joint["upper"] == pytest.approx(np.hypot(0.1, 0.3), rel=1e-4)
    assert joint["angle"] == pytest.approx(np.degrees(np.arctan2(-0.3, 0.1)), rel=1e-4)


def test_elsewhere_and_what_no_number_moves_are_refused(swing: tuple) -> None:
    author, _ = swing
    with pytest.raises(UserError, match=r"at the start alone, .*0\.2 s"):
        dragged(author, {}, {"kind": "point", "name": "tip"}, 0.2, [0.1, 0.1])
    with pytest.raises(UserError, match="no number of Params decides where 'A' is at the start"):
        dragged(author, {}, {"kind": "joint", "name": "A"}, 0.0, [0.1, 0.1])
