"""Many designs at once: the same numbers as one sweep each, refusals, masks."""

from __future__ import annotations

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, constant_rate, harmonic
from mbsd.numbers.names import number_named, with_values


def four_bar(crank: float = 0.1, coupler: float = 0.38, rocker: float = 0.3, x: float = 0.4, y: float = 0.02):
    m = Mechanism("four-bar")
    a, b, c = m.bar("crank", crank), m.bar("coupler", coupler), m.bar("rocker", rocker)
    m.revolute("A", m.ground.at(0, 0), a.start)
    m.revolute("B", a.end, b.start)
    m.revolute("C", b.end, c.end)
    m.revolute("D", c.start, m.ground.at(x, y))
    m.drive_angle("motor", a, constant_rate(6.0))
    m.trace("P", b.at(0.2, 0.1))
    m.trace("Q", c.end)
    m.start_near(crank=0, coupler=45, rocker=90)
    return m


def test_each_design_is_its_own_sweep() -> None:
    random = np.random.default_rng(4)
    designs = np.column_stack([random.uniform(low, high, 30) for low, high in
                               ((0.08, 0.12), (0.35, 0.42), (0.28, 0.34), (0.38, 0.44), (-0.02, 0.04))])  # fmt: skip
    result = four_bar().batch(
        lengths={"crank": designs[:, 0], "coupler": designs[:, 1], "rocker": designs[:, 2]},
        places={"D": designs[:, 3:]},
        angles=("rocker",),
        steps=90,
    )
    assert result.closes.all()
    for k, design in enumerate(designs):
        swept = four_bar(*design).sweep(steps=90)
        for name in ("P", "Q"):
            path = np.column_stack([swept.point(name).x, swept.point(name).y])
            np.testing.assert_allclose(result.points[name][k], path, atol=1e-12)
        np.testing.assert_allclose(result.angles["rocker"][k], swept.body("rocker").theta, atol=1e-12)


def test_a_place_that_is_given_does_not_move_with_a_length() -> None:
    lengths, ends, points = [0.38, 0.39], [(0.37, 0.01), (0.385, 0.0)], [(0.3, 0.0), (0.29, 0.01)]
    m = four_bar()
    result = m.batch(lengths={"coupler": lengths, "rocker": [0.3, 0.31]}, places={"C": ends, "Q": points}, steps=60)
    for k in range(2):
        numbers = {"coupler.length": lengths[k], "rocker.length": (0.3, 0.31)[k]}
        numbers |= {
            f"{name}.{axis}": at[k][c] for name, at in (("C", ends), ("Q", points)) for c, axis in enumerate("xy")
        }
        other = with_values(m, [number_named(m, name) for name in numbers], list(numbers.values()))
        swept = other.sweep(steps=60).point("Q")
        np.testing.assert_allclose(result.points["Q"][k], np.column_stack([swept.x, swept.y]), atol=1e-12)


def test_sliders_slots_and_traced_points_are_parameters_too() -> None:
    def slider_crank(rod: float = 0.3, height: float = 0.02, at: float = 0.1) -> Mechanism:
        m = Mechanism("slider-crank")
        a, b, s = m.bar("crank", 0.1), m.bar("rod", rod), m.body("slider")
        m.revolute("A", m.ground.at(0, 0), a.start)
        m.revolute("B", a.end, b.start)
        m.revolute("C", b.end, s.at(0.01, 0.0))
        m.prismatic("rail", m.ground.at(0, height), s.origin)
        m.drive_angle("motor", a, constant_rate(6.0))
        m.trace("P", b.at(at, 0.05))
        m.start_near(crank=0, rod=0)
        return m

    rods, heights, at = np.array([0.25, 0.3, 0.35]), np.array([0.0, 0.03, -0.02]), np.array([0.0, 0.1, 0.2])
    result = slider_crank().batch(
        lengths={"rod": rods},
        places={"rail": np.column_stack([np.zeros(3), heights]), "P": np.column_stack([at, np.full(3, 0.05)])},
        steps=60,
    )
    for k in range(3):
        point = slider_crank(rods[k], heights[k], at[k]).sweep(steps=60).point("P")
        np.testing.assert_allclose(result.points["P"][k], np.column_stack([point.x, point.y]), atol=1e-12)


def test_designs_that_do_not_close_are_marked() -> None:
    result = four_bar().batch(lengths={"coupler": [0.38, 0.1, 2.0]})
    assert result.closes.tolist() == [True, False, False]
    assert np.isnan(result.points["P"][1:]).all()
    assert np.isfinite(result.points["P"][0]).all()


@pytest.mark.parametrize("steps", [1, 2, 3, 12])
def test_few_outputs_give_the_same_motion(steps: int) -> None:
    rockers = {"rocker": np.linspace(0.28, 0.32, 5)}
    few = four_bar().batch(lengths=rockers, angles=["rocker"], steps=steps)
    many = four_bar().batch(lengths=rockers, angles=["rocker"], steps=360)
    assert few.closes.all()
    np.testing.assert_allclose(few.angles["rocker"], many.angles["rocker"][:, :: 360 // steps], atol=1e-12)


def test_designs_near_a_change_point_are_those_of_their_sweeps() -> None:
    """A crank of 0.1 m with ground 0.3 and coupler 0.25 m just turns, or just does not, with a rocker of 0.15 m."""
    more = np.array([-1e-2, -1e-6, -1e-9, 0.0, 1e-12, 1e-9, 1e-6, 1e-3, 1e-2])
    lengths = {"coupler": np.full(len(more), 0.25), "rocker": 0.15 + more}
    pivots = {"D": np.tile([0.3, 0.0], (len(more), 1))}
    for steps in (1, 12, 360):
        batch = four_bar().batch(lengths=lengths, places=pivots, angles=["rocker"], steps=steps)
        assert batch.closes.tolist() == (more >= 0).tolist()
        assert not batch.doubted.any()
        for k in np.flatnonzero(batch.closes):
            m = four_bar(coupler=0.25, rocker=0.15 + more[k], x=0.3, y=0.0)
            sol = m.sweep(times=batch.t)
            np.testing.assert_allclose(batch.angles["rocker"][k], sol.body("rocker").theta, atol=1e-9)
            np.testing.assert_allclose(batch.points["P"][k][:, 0], sol.point("P").x, atol=1e-9)
            np.testing.assert_allclose(batch.points["Q"][k][:, 1], sol.point("Q").y, atol=1e-9)


@pytest.mark.parametrize("steps", [359, 360])
def test_a_slider_crank_of_equal_lengths_among_others_goes_through(steps: int) -> None:
    def slider_crank(rod: float) -> Mechanism:
        m = Mechanism("slider-crank")
        crank, coupler, slider = m.bar("crank", 0.1), m.bar("rod", rod), m.body("slider")
        m.revolute("O", m.ground.at(0, 0), crank.start)
        m.revolute("A", crank.end, coupler.start)
        m.revolute("B", coupler.end, slider.origin)
        m.prismatic("guide", m.ground.at(0, 0), slider.origin)
        m.drive_angle("motor", crank, constant_rate(6.0, 0.5))
        m.trace("S", slider.origin)
        m.start_near(crank=30, rod=-30, slider=0)
        return m

    rods = [0.25, 0.1, 0.1 + 1e-13, 0.099]
    batch = slider_crank(0.3).batch(lengths={"rod": rods}, angles=["rod"], steps=steps)
    assert batch.closes.tolist() == [True, True, True, False]
    assert not batch.doubted.any()
    np.testing.assert_allclose(batch.points["S"][1][:, 0], 0.2 * np.cos(0.5 + 6.0 * batch.t), atol=1e-9)
    np.testing.assert_allclose(batch.angles["rod"][1], -(0.5 + 6.0 * batch.t), atol=1e-9)


def test_threads_change_nothing() -> None:
    coupler = np.linspace(0.35, 0.42, 200)
    serial, threaded = (four_bar().batch(lengths={"coupler": coupler}, threads=n, steps=40) for n in (1, 2))
    assert serial.points["P"].tobytes() == threaded.points["P"].tobytes()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({}, "nothing changes"),
        ({"lengths": {"ground": [1.0]}}, "is no bar"),
        ({"lengths": {"beam": [1.0]}}, "there is no body 'beam'"),
        ({"lengths": {"crank": [0.1, -0.1]}}, "must be positive"),
        ({"lengths": {"crank": [0.1, float("nan")]}}, "finite"),
        ({"places": {"D": [0.1, 0.2]}}, "give \\(designs, 2\\)"),
        ({"places": {"E": [[0.1, 0.2]]}}, "no joint or traced point 'E'"),
        ({"lengths": {"crank": [0.1]}, "places": {"D": [[0.4, 0.0]] * 2}}, "equally long"),
    ],
)
def test_wrong_designs_are_refused(options: dict, words: str) -> None:
    with pytest.raises(ModelError, match=words):
        four_bar().batch(**options)


def test_rods_and_their_lengths() -> None:
    def jack(length: float = 0.38, x: float = 0.4) -> Mechanism:
        m = Mechanism("jack")
        crank, rocker = m.bar("crank", 0.1), m.bar("rocker", 0.3)
        m.revolute("A", m.ground.at(0, 0), crank.start)
        m.revolute("D", m.ground.at(x, 0), rocker.start)
        m.distance("rod", crank.end, rocker.end, length)
        m.drive_angle("motor", crank, constant_rate(6.0))
        arm = m.bar("arm", 0.25)
        m.revolute("E", rocker.at(0.1, 0.02), arm.start)
        m.drive_distance("ram", m.ground.at(0, 0.5), arm.end, harmonic(0.03, 12.0, 0.0, 0.4))
        m.trace("P", arm.end)
        m.start_near(crank=0, rocker=90, arm=120)
        return m

    rods, x = np.array([0.38, 0.4, 0.36]), np.array([0.4, 0.39, 0.41])
    places = np.column_stack([x, np.zeros(3)])
    result = jack().batch(lengths={"rod": rods}, places={"D": places}, angles=["arm"], steps=120)
    assert result.closes.all()
    for k in range(3):
        swept = jack(rods[k], x[k]).sweep(steps=120)
        path = np.column_stack([swept.point("P").x, swept.point("P").y])
        np.testing.assert_allclose(result.points["P"][k], path, atol=1e-12)
        np.testing.assert_allclose(result.angles["arm"][k], swept.body("arm").theta, atol=1e-12)


@pytest.mark.parametrize("slot", [False, True])
def test_driven_and_crossing_slides(slot: bool) -> None:
    def slides(x: float = 0.3, height: float = 0.02) -> Mechanism:
        m = Mechanism("slides")
        push, lever = m.body("push"), m.bar("lever", 0.2)
        m.prismatic("rail", m.ground.at(0.0, -0.3, 0.1), push.at(0, 0.02, 0.2))
        m.drive_coordinate("ram", m.ground.at(0.02, -0.3, -0.1), push.at(0.01, 0.0), harmonic(0.05, 6.0, 0.1, 0.12))
        m.revolute("O", m.ground.at(0, 0), lever.start)
        m.pin_in_slot("fork", lever.start, push.at(0.0, 0.02))
        first = m.body("first")
        m.prismatic("guide", lever.at(0.1, height, 0.2), first.at(0.01, 0.0, 0.1))
        if slot:
            m.pin_in_slot("wall", m.ground.at(x, 0, 0.1), first.at(0.0, 0.02))
        else:
            second = m.body("second")
            m.prismatic("wall", second.at(0.02, 0.01, 0.3), m.ground.at(x, 0, 0.1))
            m.revolute("pin", second.at(0.01, 0.01), first.at(0.0, 0.02))
        m.trace("P", first.at(0.05, 0.0))
        m.start_near(lever=-70)
        return m

    x, height = np.array([0.3, 0.32]), np.array([0.02, -0.01])
    walls, guides = np.column_stack([x, np.zeros(2)]), np.column_stack([np.full(2, 0.1), height])
    moved = {"guide": guides} | ({"wall": walls} if slot else {})
    result = slides().batch(places=moved, angles=["lever"], steps=120)
    assert result.closes.all()
    for k in range(2):
        swept = slides(x[k] if slot else 0.3, height[k]).sweep(steps=120)
        assert "PRP" in swept.route
        assert "driven slide" in swept.route
        path = np.column_stack([swept.point("P").x, swept.point("P").y])
        np.testing.assert_allclose(result.points["P"][k], path, atol=1e-12)
        np.testing.assert_allclose(result.angles["lever"][k], swept.body("lever").theta, atol=1e-12)


def test_a_mechanism_that_does_not_fall_apart_is_refused() -> None:
    m = four_bar()
    m.drivers.clear()
    m.drive_relative_angle("motor", m.bodies["crank"], m.bodies["coupler"], constant_rate(0.5, 1.0))
    m.start_near(crank=0, coupler=57, rocker=90)
    with pytest.raises(ModelError, match="one by one"):
        m.batch(lengths={"crank": [0.1]}, duration=0.5)
