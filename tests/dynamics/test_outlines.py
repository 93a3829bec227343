"""Outlines that collide: equal to the other contacts, momentum and energy of random collisions, bad input."""

from __future__ import annotations

import math
import pickle
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, ModelError, SimulationError, arc_through, circle, measures, spline_through
from tools.random_mechanisms.outlines import collision

G = 9.81
FLOOR = [(-3.0, 0.0), (-3.0, -0.1), (3.0, -0.1), (3.0, 0.0)]


def same_motion(first: Mechanism, second: Mechanism, body: str, time: float, within: float) -> None:
    """Compare the motions of a body, and the events, of two mechanisms."""
    sol, second_sol = (m.simulate(time, steps=100) for m in (first, second))
    for name in ("x", "y", "theta", "vx", "vy", "omega"):
        a, b = getattr(sol.body(body), name), getattr(second_sol.body(body), name)
        assert np.abs(a - b).max() < within * max(1.0, np.abs(b).max()), name
    hits = [[(e.time, e.impulse) for e in each.events if e.what == "impact"] for each in (sol, second_sol)]
    whole = min(len(hits[0]), 8)  # the last rebounds that count depend on the size
    assert whole > 0
    assert np.allclose(hits[0][:whole], hits[1][:whole], atol=1e-9)


def ball(with_outline: bool, turned: float) -> Mechanism:
    """Return a ball that bounces and rolls on a ground that is turned."""
    m = Mechanism("ball", gravity=(G * math.sin(turned), -G * math.cos(turned)))
    body = m.body("ball", mass=0.2, inertia=1e-4)
    if with_outline:
        m.outline(body, circle(0.05))
        m.outline("ground", FLOOR)
        m.outline_contact("floor", "ground", body, restitution=0.6, friction=0.3)
    else:
        m.rigid_contact("floor", m.ground.at(0, 0), body.origin, radius=0.05, restitution=0.6, friction=0.3)
    m.start_near(ball=(0, 0.4, 0))
    m.start_moving(ball=(0.5, 0, 5))
    return m


@pytest.mark.parametrize("turned", [0.0, 0.2])
def test_a_ball_on_a_floor_is_that_of_a_rigid_contact(turned: float) -> None:
    same_motion(ball(True, turned), ball(False, turned), "ball", 0.9, 1e-9)


def discs(with_outline: bool, inside: bool) -> Mechanism:
    """Return a disc that meets another one, or the bore of a ring."""
    m = Mechanism("discs", gravity=(0, -G))
    disc = m.body("disc", mass=0.3, inertia=2e-4)
    big = 0.4 if inside else 0.1
    if with_outline:
        m.outline(disc, circle(0.05))
        m.outline(m.ground, circle(big), hole=inside)
        m.outline_contact("touch", m.ground, disc, restitution=0.5, friction=0.2)
    else:
        m.rigid_discs("touch", m.ground.origin, disc.origin, big, 0.05, inside, restitution=0.5, friction=0.2)
    m.start_near(disc=(0.04, 0.1 if inside else 0.4, 0))
    return m


@pytest.mark.parametrize("inside", [False, True])
def test_discs_are_those_of_rigid_discs(inside: bool) -> None:
    same_motion(discs(True, inside), discs(False, inside), "disc", 0.6, 1e-9)


def box(with_outline: bool) -> Mechanism:
    """Return a box that falls on a corner."""
    m = Mechanism("box", gravity=(0, -G))
    body = m.body("box", mass=0.2, inertia=1e-3)
    corners = [(-0.1, -0.06), (0.1, -0.06), (0.1, 0.06), (-0.1, 0.06)]
    if with_outline:
        m.outline(body, corners)
        m.outline(m.ground, FLOOR)
        m.outline_contact("floor", "ground", body, restitution=0.5, friction=0.3)
    else:
        for k, corner in enumerate(corners):
            m.rigid_contact(f"foot{k}", m.ground.origin, body.at(*corner), restitution=0.5, friction=0.3)
    m.start_near(box=(0, 0.4, 20))
    m.start_moving(box=(0.3, 0, 5))
    return m


def test_a_box_on_a_floor_is_that_of_four_points() -> None:
    same_motion(box(True), box(False), "box", 0.65, 1e-9)


def test_a_box_slides_off_a_table_about_its_edge() -> None:
    """Friction at its foot tips it where its centre of mass is mu h before the edge, of height h over the table."""
    m = Mechanism("edge", gravity=(0, -G))
    body = m.body("box", mass=0.2, inertia=1e-3)
    m.outline(body, [(-0.1, -0.06), (0.1, -0.06), (0.1, 0.06), (-0.1, 0.06)])
    m.outline(m.ground, [(-3, 0), (-3, -0.1), (0, -0.1), (0, 0)], name="table")
    m.outline_contact("table", "table", body, friction=0.2)
    m.start_near(box=(-0.4, 0.06, 0))
    m.start_moving(box=(2, 0, 0))
    sol = m.simulate(0.4, steps=200)
    over = 0.4 - 2 * sol.t + 0.5 * 0.2 * G * sol.t**2
    tips = (2 - math.sqrt(4 - 4 * 0.5 * 0.2 * G * (0.4 - 0.2 * 0.06))) / (0.2 * G)
    still = sol.t < tips - 1e-9
    assert np.abs(sol.body("box").x + over)[still].max() < 1e-12
    assert np.abs(sol.body("box").theta)[still].max() < 1e-12
    opened = [event.time for event in sol.events if event.what == "opens"]
    front = (2 - math.sqrt(4 - 4 * 0.5 * 0.2 * G * 0.3)) / (0.2 * G)
    assert opened[:2] == pytest.approx([front, tips], abs=1e-10)
    assert sol.body("box").theta[-1] < -0.1


@pytest.mark.parametrize("seed", range(11))
def test_collisions_keep_momentum_and_lose_only_energy(seed: int) -> None:
    books = collision(seed)
    assert books.momentum < 1e-11
    assert books.spin < 1e-9
    assert books.gained < 1e-8
    assert books.depth < 2e-5


@pytest.mark.parametrize("thin", [1e-3, 1e-5])
def test_nothing_goes_through_a_thin_plate(thin: float) -> None:
    m = Mechanism("plate", gravity=None)
    dart = m.body("dart", mass=0.01, inertia=1e-8)
    m.outline(dart, [(-0.004, -0.0005), (0.004, 0.0), (-0.004, 0.0005)])
    m.outline(m.ground, [(1, -1), (1 + thin, -1), (1 + thin, 1), (1, 1)])
    m.outline_contact("hit", "ground", dart, restitution=0.5)
    m.start_near(dart=(0, 0.003, 0))
    m.start_moving(dart=(300, 0, 0))
    sol = m.simulate(0.05, steps=3)
    [hit] = [event for event in sol.events if event.what == "impact"]
    assert hit.time == pytest.approx((1 - 0.004) / 300, abs=1e-12)
    assert sol.body("dart").vx[-1] == pytest.approx(-150, abs=1e-6)


def test_a_pawl_holds_one_way_and_clicks_the_other() -> None:
    """A weight turns the wheel under the pawl, a tooth a click; the other way the pawl's face holds it."""
    n, tip, root = 12, 0.04, 0.033
    path = [(r * math.cos(a), r * math.sin(a)) for a in (2 * math.pi * k / n for k in range(n)) for r in (tip, root)]

    def turned(torque: float) -> float:
        m = Mechanism("ratchet", gravity=(0, -G))
        wheel, pawl = m.body("wheel", mass=0.3, inertia=2e-4), m.body("pawl", 0.05, (0.02, 0), 1e-5)
        m.revolute("axle", m.ground.at(0, 0), wheel.origin)
        m.revolute("pin", m.ground.at(-0.045, 0.045), pawl.origin)
        m.outline(wheel, path)
        m.outline(pawl, [(0, 0.004), (0, -0.004), (0.036, -0.006), (0.041, -0.001), (0.035, 0.004)])
        m.outline_contact("click", wheel, pawl)
        m.torque("hand", wheel, torque)
        m.torsion_spring("drag", m.ground, wheel, 0.0, damping=0.01)
        m.start_near(wheel=8, pawl=10)
        return float(m.simulate(0.5, steps=50).body("wheel").theta[-1])

    assert 0 < turned(0.05) < 2 * math.pi / n * 2
    assert turned(-0.05) < -0.8


def test_outlines_that_yield_are_a_contact_by_penalty() -> None:
    """A ball that falls on a floor by penalty is that of a contact by penalty."""
    motions = []
    for outlined in (True, False):
        m = Mechanism("soft", gravity=(0, -G))
        body = m.body("ball", mass=0.2, inertia=1e-4)
        if outlined:
            m.outline(body, circle(0.05))
            m.outline(m.ground, FLOOR)
            m.yielding_outline_contact("floor", "ground", body, 1e5, friction=0.2, damping=0.1)
        else:
            m.contact("floor", m.ground.origin, body.origin, 1e5, friction=0.2, damping=0.1, radius=0.05)
        m.start_near(ball=(0, 0.3, 0))
        m.start_moving(ball=(0.2, 0, 3))
        motions.append(m.simulate(0.6, steps=60, tolerance=1e-9).body("ball"))
    for name in ("x", "y", "theta"):
        assert np.abs(getattr(motions[0], name) - getattr(motions[1], name)).max() < 1e-7


def test_outlines_are_saved_pickled_changed_and_simulated_together(tmp_path: Path) -> None:
    m = box(True)
    m.save(tmp_path / "box.json")
    again = Mechanism.load(tmp_path / "box.json")
    assert again.outlines["box"].corners == m.outlines["box"].corners
    wanted = m.simulate(0.4, steps=20).body("box").y
    for copy in (again, pickle.loads(pickle.dumps(m))):
        assert np.array_equal(copy.simulate(0.4, steps=20).body("box").y, wanted)
    for name in list(m.contacts):
        m.change(name, restitution=0.1)
    changed = m.simulate(0.4, steps=20).body("box").y[-1]
    assert abs(changed - wanted[-1]) > 1e-3
    row = next(event.name for event in box(True).simulate(0.4, steps=20).events)
    vary = {row: {"restitution": [0.5, 0.2]}}
    many = box(True).simulate_many(0.4, vary=vary, measure={"y": measures.final("box.y")}, steps=20)
    assert many.good.all()
    assert many["y"][0] == pytest.approx(wanted[-1], abs=1e-12)


DXF = """0
SECTION
2
HEADER
9
$INSUNITS
70
4
0
ENDSEC
0
SECTION
2
ENTITIES
0
LINE
10
0
20
0
11
40
21
0
0
ARC
10
40
20
10
40
10
50
270
51
90
0
LINE
10
0
20
{end}
11
40
21
20
0
LINE
10
0
20
0
11
0
21
20
0
ENDSEC
0
EOF
"""


def test_a_drawing_is_an_outline(tmp_path: Path) -> None:
    file = tmp_path / "slug.dxf"
    file.write_text(DXF.format(end=20))
    m = Mechanism("slug")
    made = m.outline(m.body("slug"), file)
    assert made.area == pytest.approx(0.04 * 0.02 + math.pi * 0.01**2 / 2, rel=1e-12)
    file.write_text(DXF.format(end=18))
    with pytest.raises(ModelError, match=r"the curve is open .* join"):
        m.outline("slug", file)


def test_a_spline_of_a_drawing_is_that_of_its_control_points(tmp_path: Path) -> None:
    """Control points on a line at equal distances, and a bend between: a cubic through the ends, closed by a line."""
    knots = [0, 0, 0, 0, 1, 1, 1, 1]
    control = [(0, 0), (0, 40), (60, 40), (60, 0)]
    groups = [(0, "SPLINE"), (71, 3), *((40, knot) for knot in knots)]
    groups += [(code, value) for point in control for code, value in zip((10, 20), point, strict=True)]
    groups += [(0, "LINE"), (10, 0), (20, 0), (11, 60), (21, 0)]
    file = tmp_path / "bow.dxf"
    whole = [(0, "SECTION"), (2, "ENTITIES"), *groups, (0, "ENDSEC"), (0, "EOF")]
    file.write_text("".join(f"{code}\n{value}\n" for code, value in whole))
    bow = Mechanism("bow").outline("ground", file)
    assert bow.area == pytest.approx(1.44e-3, rel=1e-5)  # of a Bezier curve: 3/20 of the sum of cross products


@settings(max_examples=20, deadline=None)
@given(st.lists(st.floats(0.8, 1.0), min_size=4, max_size=9))
def test_splines_become_arcs_within_the_tolerance(radii: list[float]) -> None:
    from scipy.interpolate import CubicSpline

    turns = 2 * np.pi * np.arange(len(radii)) / len(radii)
    points = np.array(radii)[:, None] * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    made = Mechanism("blob").outline("ground", [spline_through(points)], tolerance=1e-4)
    closed = np.vstack([points, points[:1]])
    u = np.append(0, np.cumsum(np.hypot(*np.diff(closed, axis=0).T)))
    seen = CubicSpline(u, closed, bc_type="periodic")(np.linspace(0, u[-1], 200))
    path = made.path(0.002)
    step = np.diff(path, axis=0)
    for p in seen:
        share = np.clip(((p - path[:-1]) * step).sum(axis=1) / (step**2).sum(axis=1), 0, 1)
        assert np.hypot(*(path[:-1] + share[:, None] * step - p).T).min() < 1.1e-4


SQUARE = [(0, 0), (1, 0), (1, 1), (0, 1)]


@pytest.mark.parametrize(
    ("path", "said"),
    [
        ([(0, 0), (1, 1), (1, 0), (0, 1)], r"crosses itself .* order"),
        ([(0, 0), (1, 0)], "needs three"),
        ([(0, 0)], "circle"),
        ([], "no points"),
        ([(0, 0), (1, 0), (math.nan, 1)], "nan"),
        ([(0, 0), (1, 0), (2, 0)], r"comes back on itself|encloses 0"),
        ([(0, 0), (2, 0), (1, 0), (1, 1)], "comes back on itself"),
        ([arc_through((1, 1), (2, 0))], "needs a point before it"),
        ("nothing.dxf", "cannot be read"),
        (3.0, "needs a path"),
    ],
)
def test_what_is_no_outline_is_refused_with_a_remedy(path: object, said: str) -> None:
    m = Mechanism("bad")
    with pytest.raises(ModelError, match=said):
        m.outline(m.body("part"), path)  # pyright: ignore[reportArgumentType]
    assert not m.outlines


def test_the_wrong_way_round_is_turned() -> None:
    m = Mechanism("turned")
    first, second = m.outline(m.body("a"), SQUARE), m.outline(m.body("b"), SQUARE[::-1])
    assert first.area == second.area == 1.0
    assert not second.is_hole
    assert m.outline("a", SQUARE, hole=True).is_hole


def test_outlines_of_one_body_and_missing_ones_are_refused() -> None:
    m = Mechanism("pairs")
    a, b = m.body("a"), m.body("b")
    m.outline(a, SQUARE)
    m.outline(a, circle(0.1, (3, 0)), name="knob")
    with pytest.raises(ModelError, match=r"both of 'a'.* two bodies"):
        m.outline_contact("c", "a", "knob")
    with pytest.raises(ModelError, match="'b' has no outline"):
        m.outline_contact("c", a, b)
    with pytest.raises(ModelError, match="no body or outline"):
        m.outline_contact("c", a, "knop")


def test_overlapping_at_the_start_is_refused_and_touching_is_not() -> None:
    for apart, inside in ((0.95, True), (1.0, False)):
        m = Mechanism("start", gravity=None)
        a, b = m.body("a", 1.0, inertia=0.1), m.body("b", 1.0, inertia=0.1)
        m.outline(a, SQUARE)
        m.outline(b, SQUARE)
        m.outline_contact("c", a, b)
        m.start_near(a=(0, 0, 0), b=(apart, 0.5, 0))
        if inside:
            with pytest.raises(SimulationError, match=r"starts 0\.05 .* inside; move the start"):
                m.simulate(0.1)
        else:
            assert not [event for event in m.simulate(0.1, steps=5).events if event.what == "impact"]
