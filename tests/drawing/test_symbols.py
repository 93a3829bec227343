"""Symbols of machines, cylinders and surfaces: what touches in the mechanism touches in its drawing."""

from __future__ import annotations

import math

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.path import Path

from mbsd import GasCycle, Mechanism, Solution, constant_rate, curve, two_stroke
from mbsd.cams import Lift, flat_cam, roller_cam
from mbsd.drawing.look import INKS, apart
from mbsd.drawing.pose import tracks_of
from mbsd.drawing.strokes import strokes_of
from mbsd.drawing.symbols.surfaces import MOST, curve_way, surface_way
from tools.models.engines import BORE, ROD, THROW, petrol, slider_crank

LIFT = Lift.of((math.pi / 2, 0.02, "cycloidal"), (math.pi / 2, 0.02), (math.pi, 0.0, "3-4-5"))


def outlines(ax: Axes, number: int, order: float) -> list[np.ndarray]:
    """Filled outlines of the body of this number, drawn at this height."""
    from matplotlib.colors import to_hex

    edge = colours(ax)[number]
    return [
        np.asarray(patch.get_path().vertices)
        for patch in ax.patches
        if to_hex(patch.get_edgecolor()) == edge and patch.get_zorder() == order
    ]


def colours(ax: Axes) -> list[str]:
    """Return the colours of the bodies, whose names are written in the model's order."""
    from matplotlib.colors import to_hex

    shades = set(apart({f"{ink} {k}": ink for ink in INKS.values() for k in range(5)}).values())
    return list(dict.fromkeys(ink for text in ax.texts if (ink := to_hex(text.get_color())) in shades))


def lines(ax: Axes) -> list[np.ndarray]:
    return [np.asarray(line.get_xydata()) for line in ax.lines]


def geneva(slots: int, start: float) -> Mechanism:
    m = Mechanism("geneva")
    crank, wheel = m.body("crank"), m.body("wheel")
    m.revolute("O", m.ground.at(0.2, 0.1), crank.origin)
    m.revolute("W", m.ground.at(0.2, 0.2), wheel.origin)
    m.geneva("index", crank.origin, wheel.at(0, 0, 0.3), slots, 0.1 * math.sin(math.pi / slots))
    m.drive_angle("motor", crank, constant_rate(1.0, start))
    return m


@pytest.mark.parametrize("slots", [3, 4, 6, 8])
def test_the_locking_disc_of_a_geneva_turns_in_the_arcs_of_its_wheel(slots: int) -> None:
    sol = geneva(slots, 0.1).sweep(2 * math.pi, steps=48)
    for step in range(0, 48, 3):
        ax = sol.draw(step=step).ax
        [lock], [wheel] = outlines(ax, 0, 1.9), outlines(ax, 1, 1.8)
        centre = lock.mean(axis=0)
        assert not Path(wheel).contains_points(centre + 0.98 * (lock - centre)).any(), f"step {step}"


@pytest.mark.parametrize("slots", [3, 4, 6, 8])
def test_the_pin_of_a_geneva_stands_in_a_slot_or_outside(slots: int) -> None:
    sol = geneva(slots, 0.1).sweep(2 * math.pi, steps=48)
    inside = 0
    for step in range(0, 48, 3):
        [wheel] = outlines(sol.draw(step=step).ax, 1, 1.8)
        angle = sol.body("crank").theta[step]
        pin = np.array([0.2, 0.1]) + 0.1 * math.sin(math.pi / slots) * np.array([math.cos(angle), math.sin(angle)])
        assert not Path(wheel).contains_point(pin)
        inside += np.hypot(*(pin - [0.2, 0.2])) < 0.1 * math.cos(math.pi / slots)
    assert inside, "it is in a slot for part of the turn"


@pytest.mark.parametrize("on_ground", [False, True], ids=["rack_moves", "pinion_moves"])
def test_teeth_of_a_rack_stand_in_the_gaps_of_its_pinion(on_ground: bool) -> None:
    m = Mechanism("steering")
    pinion, other = m.body("pinion"), m.body("other", 1.0)
    if on_ground:
        m.prismatic("rail", m.ground.at(0, 0.1), other.origin)
        m.revolute("axle", other.origin, pinion.origin)
        m.rack_and_pinion("teeth", m.ground.at(0, 0), pinion.origin, 0.1)
    else:
        m.revolute("axle", m.ground.at(0, 0.1), pinion.origin)
        m.prismatic("guide", m.ground.at(0, -0.03), other.at(0, -0.03))
        m.rack_and_pinion("teeth", other.origin, pinion.origin, 0.1)
    ax = m.draw().ax
    gear = max(outlines(ax, 0, 1.8), key=len)
    from matplotlib.colors import to_hex

    from mbsd.drawing.look import QUIET

    edge = QUIET if on_ground else colours(ax)[1]
    [rack] = [
        np.asarray(p.get_path().vertices)
        for p in ax.patches
        if to_hex(p.get_edgecolor()) == edge and p.get_zorder() == 1.8 and len(p.get_path().vertices) > 50
    ]
    near = gear[(np.abs(gear[:, 0]) < 0.012) & (gear[:, 1] < 0.05)]
    assert len(near) > 4
    top = np.interp(near[:, 0], rack[:-3, 0], rack[:-3, 1])
    assert (near[:, 1] - top > -5e-4).all(), "they do not cut into each other"
    assert np.abs(near[:, 1] - top).min() < 1e-3, "they touch"


def test_a_disc_stands_on_its_line() -> None:
    m = Mechanism("slope")
    disc = m.body("disc", 2.0, inertia=0.04)
    m.rolling_disc("road", m.ground.at(0.3, 0.1, -0.3), disc.origin, 0.2)
    m.start_near(disc=(0.3, 0.3, 0))
    ax = m.draw().ax
    rim = max(outlines(ax, 0, 1.8), key=lambda points: np.ptp(points[:, 0]))
    normal = np.array([math.sin(0.3), math.cos(0.3)])
    height = (rim - [0.3, 0.1]) @ normal
    assert height.min() == pytest.approx(0.0, abs=1e-3)
    assert height.max() == pytest.approx(0.4, abs=1e-3)


def test_a_curve_is_drawn_through_its_points() -> None:
    points = [(0, 1), (0.3, 0.4), (0.8, 0.1), (1.5, 0.3), (2, 0.2), (2.5, 0.6)]
    m = Mechanism("bead")
    bead = m.body("bead", 1.0, inertia=0.01)
    m.point_on_curve("wire", m.ground.at(0.1, 0.2), bead.origin, points)
    m.start_near(bead=(0.4, 0.6, 0))
    wire = max(lines(m.draw().ax), key=len)
    for x, y in points:
        assert np.hypot(wire[:, 0] - x - 0.1, wire[:, 1] - y - 0.2).min() < 0.02


@pytest.mark.parametrize("start", [0.0, 1.0, 2.0, 4.5])
def test_roller_and_face_touch_the_cam(start: float) -> None:
    for flat in (False, True):
        m = Mechanism("cam")
        cam, follower = m.body("cam"), m.body("follower", 0.2)
        m.revolute("shaft", m.ground.at(0, 0), cam.origin)
        m.prismatic("guide", m.ground.at(0, 0.1, math.pi / 2), follower.at(0, 0.05, math.pi / 2))
        if flat:
            m.cam_flat("contact", cam.origin, follower.origin, flat_cam(LIFT, 0.06))
        else:
            m.cam_roller("contact", cam.origin, follower.origin, roller_cam(LIFT, 0.04, 0.01))
        m.drive_angle("motor", cam, constant_rate(1.0, start))
        m.start_near(follower=(0, 0.06, 0))
        ax = m.draw().ax
        disc = max(outlines(ax, 0, 1.8), key=len)
        place = float(m.sweep(steps=1, duration=1e-3).body("follower").y[0])
        gap = place - disc[:, 1].max() if flat else np.hypot(disc[:, 0], disc[:, 1] - place).min() - 0.01
        assert abs(gap) < 2e-4


TURN = 2 * math.pi
RATE = 200.0


def loads(cycle: GasCycle, degrees: float) -> list[np.ndarray]:
    """Lines of the cylinder with the crank so far past the firing, by rising order and length: (k, 2) each."""
    sol = slider_crank(cycle).sweep(2 * TURN / RATE, steps=144)
    [drawn] = strokes_of(sol, [round(degrees / 5)])
    return [stroke.points for stroke in drawn.strokes if stroke.ink == "load" and not stroke.closed]


def test_the_barrel_has_the_size_of_the_bore_and_its_head_is_where_the_clearance_ends() -> None:
    barrel, crown, *_ = loads(petrol(), 0.0)
    assert np.ptp(barrel[:, 0]) == pytest.approx(BORE)
    assert barrel[:, 1].max() == pytest.approx(THROW + ROD + 0.02 + 2 * THROW / 9)
    assert crown[:, 1] == pytest.approx([THROW + ROD + 0.02] * 2)


@pytest.mark.parametrize(
    ("degrees", "lifted"), [(0, (False, False)), (90, (False, False)), (270, (False, True)), (400, (True, False))]
)
def test_valves_are_lifted_while_they_are_open(degrees: float, lifted: tuple[bool, bool]) -> None:
    barrel, _, *valves = loads(petrol(exhaust_opens=math.radians(130.0)), degrees)
    head = barrel[:, 1].max()
    # the intake is drawn to the right of the axis that points down, which is on the left of the page
    assert len(valves) == 2
    assert {bool(head - valve[0, 1] > 1e-3) for valve in valves} == set(lifted)
    assert [bool(head - valve[0, 1] > 1e-3) for valve in valves] == list(lifted)


def test_a_port_lies_where_the_piston_opens_it() -> None:
    cycle = two_stroke(8.0, ports_open=math.radians(110.0), ports_close=math.radians(-110.0))
    _, _, closed = loads(cycle, 90.0)
    _, crown, _ = loads(cycle, 110.0)
    _, _, opened = loads(cycle, 180.0)
    assert closed[0, 1] == pytest.approx(crown[0, 1], abs=1e-9)
    assert np.ptp(opened[:, 0]) > 1.5 * np.ptp(closed[:, 0])


@pytest.mark.parametrize("hydraulic", [False, True])
def test_a_strut_has_a_barrel_on_its_first_point_and_a_piston_within(hydraulic: bool) -> None:
    m = Mechanism("strut", gravity=None)
    body = m.body("body", 1.0, inertia=1.0)
    m.prismatic("rail", m.ground.origin, body.origin)
    if hydraulic:
        m.hydraulic_cylinder("strut", m.ground.origin, body.origin, 0.08, 0.05, 0.2, 0.3, 2e7, rated_flow=1e-3)
    else:
        m.gas_strut("strut", m.ground.origin, body.origin, 400.0, 1.3, 0.5, 0.2)
    m.start_near(body=(0.45, 0, 0))
    [drawn] = strokes_of(m.simulate(0.01, steps=2), [0])
    lines = [stroke.points for stroke in drawn.strokes if stroke.ink == "load" and not stroke.closed]
    _, barrel, rod, piston = lines
    assert barrel[:, 0].max() == pytest.approx(0.3)
    assert rod[:, 0].max() == pytest.approx(0.45)
    assert barrel[:, 0].min() < piston[0, 0] < barrel[:, 0].max()


RADIUS, SPEED, END = 0.1, 2.0, 1.0


def tyre_beyond_its_road(points: int = 5) -> Solution:
    """A wheel is driven along x for 1 s, 2 m, over a road that is described on its first half metre alone."""
    m = Mechanism("beyond", gravity=(0.0, -9.81))
    wheel, cart = m.body("wheel", 1.0, inertia=0.01), m.body("cart", 1.0, inertia=0.01)
    x = np.linspace(0.0, 0.5, points)
    m.angle_lock("level", m.ground.origin, cart.origin)
    m.revolute("hub", cart.origin, wheel.origin)
    m.drive_coordinate("engine", m.ground.origin, cart.origin, constant_rate(SPEED))
    m.tyre("tyre", m.ground.origin, wheel.origin, RADIUS, 1e4, 100.0, profile=curve(x, 0.1 * x))
    m.start_near(cart=(0.0, RADIUS, 0.0), wheel=(0.0, RADIUS, 0.0))
    m.start_moving(cart=(SPEED, 0.1 * SPEED, 0.0), wheel=(SPEED, 0.1 * SPEED, 0.0))
    return m.simulate(END, steps=60)


def rolls_off(angle: float) -> Solution:
    """A disc that rolls down a curve, level at its end, and on along the straight line beyond; the world turned."""
    c, s = math.cos(angle), math.sin(angle)
    m = Mechanism("off", gravity=(9.81 * s, -9.81 * c))
    wheel = m.body("wheel", 1.0, inertia=0.005)
    x = np.linspace(-0.6, 0.0, 13)
    m.rigid_terrain("hill", m.ground.at(0, 0, angle), wheel.origin, np.stack([x, x**2], axis=1).tolist(), RADIUS, False)
    start = np.array([-0.4, 0.16]) + RADIUS * np.array([0.8, 1.0]) / math.hypot(0.8, 1.0)
    m.start_near(wheel=(c * start[0] - s * start[1], s * start[0] + c * start[1], 0))
    m.start_moving(wheel=(0, 0, 0))
    return m.simulate(1.2, steps=120)


def test_a_road_goes_on_along_its_tangent_as_far_as_the_tyre() -> None:
    sol = tyre_beyond_its_road()
    pose = tracks_of(sol).pose(0)
    path = surface_way(sol.mechanism.forces["tyre"], pose, RADIUS)
    assert path[-1] == pytest.approx([SPEED * END + RADIUS, 0.1 * (SPEED * END + RADIUS)], rel=1e-6)
    assert path[0] == pytest.approx([-RADIUS, -0.1 * RADIUS], rel=1e-6)
    assert np.diff(path[:, 1]) == pytest.approx(0.1 * np.diff(path[:, 0]))


@pytest.mark.parametrize("angle", [0.0, 0.7, math.pi, -2.0])
def test_a_terrain_goes_on_straight_where_the_wheel_rolls_on(angle: float) -> None:
    sol = rolls_off(angle)
    pose, contact = tracks_of(sol).pose(0), sol.mechanism.contacts["hill"]
    path = curve_way(contact, pose, "contact hill")
    c, s = math.cos(angle), math.sin(angle)
    own = path @ np.array([[c, -s], [s, c]])
    wheel = sol.body("wheel")
    farthest = float((c * wheel.x + s * wheel.y).max())
    assert farthest > 0.5  # it has left the described part
    assert own[-1, 0] > farthest + RADIUS
    assert own[-1, 1] == pytest.approx(0.0, abs=1e-3)
    assert own[0] == pytest.approx([-0.6, 0.36])  # it never came to the other end, which stays


def test_one_pose_alone_draws_what_is_described() -> None:
    from mbsd.drawing.pose import start_pose

    m = rolls_off(0.0).mechanism
    path = curve_way(m.contacts["hill"], start_pose(m), "contact hill")
    assert path[[0, -1]] == pytest.approx(np.array([[-0.6, 0.36], [0.0, 0.0]]))


def test_the_road_of_a_tyre_is_hatched_below() -> None:
    from matplotlib.figure import Figure

    sol = tyre_beyond_its_road()
    ax = Figure().subplots()
    sol.draw(ax=ax, names=False)
    drawn = [np.asarray(line.get_xydata(), float) for line in ax.lines if line.get_linewidth() == 0.9]
    strokes = [stroke for stroke in drawn if len(stroke) == 2]
    assert 20 < len(strokes) <= MOST
    roots, ends = np.array([s[0] for s in strokes]), np.array([s[1] for s in strokes])
    assert roots[:, 1] == pytest.approx(0.1 * roots[:, 0], abs=1e-9)
    assert (ends[:, 1] < 0.1 * ends[:, 0]).all()
    assert roots[:, 0].max() > SPEED * END


def test_a_long_road_has_few_strokes() -> None:
    from matplotlib.figure import Figure

    m = Mechanism("long", gravity=(0.0, -9.81))
    wheel = m.body("wheel", 1.0, inertia=0.01)
    m.tyre("tyre", m.ground.origin, wheel.origin, RADIUS, 1e4, profile=curve([-1e4, 1e4], [0.0, 0.0]))
    m.start_near(wheel=(0, RADIUS, 0))
    ax = Figure().subplots()
    m.draw(ax=ax, names=False)
    assert 0 < len(ax.lines) < MOST + 20
    low, high = ax.get_xlim()
    assert high - low < 10 * RADIUS  # the drawing shows the wheel, not 20 km of road
