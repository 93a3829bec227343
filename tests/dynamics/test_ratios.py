"""Ratios between the coordinates of two joints: exact in sweeps and simulations, on one carrier or on none."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, ModelError, constant_rate
from mbsd.measures import final
from mbsd.model.body import Marker
from mbsd.model.mechanism import hidden_bodies
from tools.random_mechanisms.similar import renamed

G = 9.81


def _pose(sol: Any, marker: Marker) -> tuple[Any, Any, Any]:
    if marker.body.name == "ground":
        return marker.x, marker.y, marker.angle
    b = sol.body(marker.body.name)
    c, s = np.cos(b.theta), np.sin(b.theta)
    return b.x + c * marker.x - s * marker.y, b.y + s * marker.x + c * marker.y, b.theta + marker.angle


def _coordinate(sol: Any, slides: bool, i: Marker, j: Marker) -> Any:
    (x1, y1, a1), (x2, y2, a2) = _pose(sol, i), _pose(sol, j)
    return np.cos(a1) * (x2 - x1) + np.sin(a1) * (y2 - y1) if slides else a2 - a1


@settings(max_examples=25, deadline=None)
@given(
    seed=st.integers(0, 10**6),
    ratio=st.floats(0.2, 4.0) | st.floats(-4.0, -0.2),
    slides=st.tuples(st.booleans(), st.booleans()),
    turned=st.tuples(st.booleans(), st.booleans()),
    shared=st.booleans(),
    offset=st.none() | st.floats(-0.4, 0.4),
)
def test_a_ratio_holds_between_any_two_joints(
    seed: int, ratio: float, slides: Any, turned: Any, shared: bool, offset: float | None
) -> None:
    rng = np.random.default_rng(seed)
    m = Mechanism("any")
    a, b, c, d = (m.body(name, 1.0, rng.normal(size=2) * 0.1, 0.1) for name in "ABCD")
    m.revolute("cc", m.ground.at(0, 0), c.at(0.1, 0.2))
    m.revolute("dd", m.ground.at(1, 0), d.at(0.1, 0.2))
    ends = [
        [x.at(*(rng.normal(size=2) * 0.3), rng.normal() * 0.5) for x in pair]
        for pair in ((c, a), (c if shared else d, b))
    ]
    ends = [pair[::-1] if back else pair for pair, back in zip(ends, turned, strict=True)]
    joints = [
        (m.prismatic if slide else m.revolute)(name, *pair)
        for name, slide, pair in zip("ab", slides, ends, strict=True)
    ]
    m.ratio("r", joints[0], joints[1], ratio, offset=offset)
    m.drive_angle("m1", c, constant_rate(0.7, 0.1))
    m.drive_angle("m2", d, constant_rate(0.4, 0.1))
    if slides[0]:
        m.drive_coordinate("m3", *ends[0], constant_rate(0.3, 0.1))
    else:
        m.drive_relative_angle("m3", ends[0][0].body, ends[0][1].body, constant_rate(1.3, 0.1))
    assert m.mobility().dof == m.mobility().nominal == 3
    sol = m.sweep(0.5, steps=20)
    left = _coordinate(sol, slides[1], *ends[1]) - ratio * _coordinate(sol, slides[0], *ends[0])
    assert np.ptp(left) < 1e-12
    if offset is not None:
        assert abs(left[0] - offset) < 1e-12


def _weights(apart: float, ratio: float = -1.5) -> Mechanism:
    m = Mechanism("weights", gravity=(0, -G))
    a, b = m.body("A", 1.0, (0.1, 0), 0.02), m.body("B", 2.0, (0.05, 0), 0.03)
    first = m.revolute("a", m.ground.at(0, 0), a.origin)
    second = m.revolute("b", m.ground.at(apart, 0), b.origin)
    m.ratio("r", first, second, ratio)
    m.start_near(A=20, B=0)
    return m


@pytest.mark.parametrize("formulation", ["independent", "reference"])
@pytest.mark.parametrize("apart", [0.0, 0.3])
def test_the_motion_is_that_of_the_one_coordinate_left(apart: float, formulation: str) -> None:
    sol = _weights(apart).simulate(1.0, tolerance=1e-11, formulation=formulation)
    turned = sol.body("A").theta
    inertia = 0.02 + 0.01 + 1.5**2 * (0.03 + 2 * 0.05**2)
    height = 0.1 * np.sin(turned) + 2 * 0.05 * np.sin(-1.5 * (turned - turned[0]))
    assert np.allclose(sol.body("A").omega ** 2, 2 * G * (height[0] - height) / inertia, atol=1e-9)
    assert np.ptp(sol.energy.total) < 1e-10


def test_torques_go_by_the_ratio() -> None:
    m = Mechanism("clock")
    hour, minute = m.bar("hour", 0.1), m.bar("minute", 0.15)
    pins = m.revolute("h", m.ground.origin, hour.start), m.revolute("m", m.ground.origin, minute.start)
    m.ratio("works", *pins, 12, offset=0.0)
    m.torque("load", minute, -0.5)
    m.drive_angle("motor", hour, constant_rate(0.3, 0.2))
    sol = m.sweep(1.0, steps=4)
    assert np.allclose(sol.driver("motor").torque, 6.0)
    assert np.allclose(sol.body("minute").theta, 12 * sol.body("hour").theta)


def test_saved_pickled_changed_and_many(tmp_path: Path) -> None:
    m = _weights(0.0)
    m.save(tmp_path / "m.json")
    wanted = m.simulate(0.5).body("A").theta
    for same in (Mechanism.load(tmp_path / "m.json"), pickle.loads(pickle.dumps(m))):
        assert (same.simulate(0.5).body("A").theta == wanted).all()
    m.change("r", ratio=-0.7)
    changed = m.simulate(0.5).body("A").theta
    assert (changed == _weights(0.0, -0.7).simulate(0.5).body("A").theta).all()
    many = _weights(0.0).simulate_many(0.5, vary={"r": {"ratio": [-1.5, -0.7]}}, measure={"end": final("A.theta")})
    assert np.allclose(many["end"], [wanted[-1], changed[-1]], rtol=0.0, atol=1e-9)


def test_derivatives_by_the_ratio_are_those_of_differences() -> None:
    for apart in (0.0, 0.3):
        derived = _weights(apart).sensitivities(["A.theta"], to=["r.ratio"], duration=0.4, steps=10, tolerance=1e-10)
        h = 1e-5
        above, below = (
            _weights(apart, -1.5 + d).simulate(0.4, steps=10, tolerance=1e-12).body("A").theta for d in (h, -h)
        )
        assert np.allclose(derived.of("A.theta", "r.ratio"), (above - below) / (2 * h), rtol=1e-5, atol=1e-7)


def _geared(first: str, ratio: float) -> Mechanism:
    m = Mechanism("geared")
    a, b = m.body("A"), m.body("B")
    pins = m.revolute("a", m.ground.at(0, 0), a.origin), m.revolute("b", m.ground.at(0.3, 0), b.origin)
    if first == "gear":
        m.gear_pair("g", a.origin, b.origin, 0.1, 0.2)
    m.ratio("r", *pins, ratio)
    if first == "ratio":
        m.gear_pair("g", a.origin, b.origin, 0.1, 0.2)
    m.drive_angle("motor", a, constant_rate(1.0))
    return m


@pytest.mark.parametrize("first", ["gear", "ratio"])
def test_a_ratio_that_contradicts_a_gear_is_refused(first: str) -> None:
    assert np.allclose(_geared(first, -0.5).sweep(1.0, steps=4).body("B").omega, -0.5)
    with pytest.raises(ModelError, match=r"\b3 times.*already makes it -0\.5 times|-0\.5 times.*makes it 3"):
        _geared(first, 3.0).sweep(1.0)


def test_a_refused_ratio_leaves_nothing_behind() -> None:
    m = _geared("gear", -0.5)
    before = m.bodies.keys() | m.joints.keys()
    with pytest.raises(ModelError, match="already makes it"):
        m.ratio("other", "a", "b", 2.0)
    assert m.bodies.keys() | m.joints.keys() == before


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("a", "a", 2), "itself"),
        (("a", "nobody", 2), "no joint 'nobody'"),
        (("a", "b", 0), "the ratio 0"),
        (("a", "b", float("nan")), "must be finite"),
        (("a", "rod", 1), "is a distance"),
    ],
)
def test_bad_ratios_are_refused(arguments: Any, words: str) -> None:
    m = Mechanism("bad")
    a, b = m.body("A"), m.body("B")
    m.revolute("a", m.ground.at(0, 0), a.origin)
    m.revolute("b", m.ground.at(0.3, 0), b.origin)
    m.distance("rod", m.ground.at(1, 1), b.at(1, 0), 1.0)
    with pytest.raises(ModelError, match=words):
        m.ratio("r", *arguments)


def test_bodies_that_a_ratio_adds_are_not_drawn(tmp_path: Path) -> None:
    m = _weights(0.0)
    m.draw().save(tmp_path / "with.svg")
    words = (tmp_path / "with.svg").read_text()
    assert "idler" not in words


def test_only_bodies_that_a_ratio_adds_are_hidden() -> None:
    """A body without mass whose name begins as theirs is seen, and they stay hidden under other names."""
    m = Mechanism("clock")
    hour, minute, own = m.bar("hour", 0.06), m.bar("minute", 0.09), m.bar("works arm", 0.02)
    hours = m.revolute("hours", m.ground.at(0, 0), hour.start)
    minutes = m.revolute("minutes", m.ground.at(0, 0), minute.start)
    m.revolute("beside", m.ground.at(0.2, 0), own.start)
    m.ratio("works", hours, minutes, 12)
    assert hidden_bodies(m) == {"works idler"}
    other = renamed(m)
    assert other is not None
    assert len(hidden_bodies(other)) == 1
