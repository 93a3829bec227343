"""Runs with rigid contacts: points, discs, terrain, with and without friction; wedges and stacks."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial

import numpy as np

from mbsd import Mechanism, constant_rate, harmonic, polynomial
from tools.models import contact_models, rough_contacts, stops
from tools.models.contact_models import G
from tools.numbers.events.record import Case

ZENO = "many bounces: each divides the speed, and so multiplies errors of its time"
KINKS = "friction has kinks where sliding begins and ends"
CHAOS = "impacts with friction multiply small differences"


def cases() -> Iterator[Case]:
    """Yield all of them."""
    yield from _on_lines()
    yield from _with_friction()
    yield from _several_at_once()
    yield from _on_discs()
    yield from _on_terrain()


def _on_lines() -> Iterator[Case]:
    for restitution, height in ((0.0, 1.0), (0.5, 1.0), (0.5, 0.3), (1.0, 0.7)):
        build = partial(contact_models.ball, restitution, height)
        yield Case(f"ball {restitution:g} from {height:g}", build, 2.03, kink=ZENO, quick=restitution == 0.5)
    yield Case("ball on a band", stops.ball, 2.03, kink=ZENO)
    yield Case("ball that starts on the floor and is thrown up", lambda: thrown_up(3.0), 1.51, quick=True)
    yield Case("ball that starts on the floor and stays", lambda: thrown_up(0.0), 0.53)
    yield Case("ball that starts into the floor", lambda: thrown_up(-1.5), 0.53)
    yield Case("box on a corner", stops.box, 0.91, kink=ZENO)
    yield Case("plank", stops.plank, 0.93, kink=ZENO)
    yield Case("box that falls flat", lambda: dropped_box(0.5, 0.3), 1.03, even=True, kink=ZENO)
    yield Case("box that falls flat and stays", lambda: dropped_box(0.0, 0.0), 0.73, even=True)
    for share in (1.001, 1.1, 2.5):
        yield Case(f"load on a table shaken by {share:g} g", partial(shaken_table, share), 0.37, kink=ZENO)


def _with_friction() -> Iterator[Case]:
    for friction, restitution in ((0.2, 0.6), (0.5, 0.0), (0.1, 1.0)):
        build = partial(rough_contacts.ball, friction, restitution)
        yield Case(f"ball with spin {friction:g} {restitution:g}", build, 0.83, kink=CHAOS, quick=restitution == 0.6)
    for friction, speed in ((0.25, 3.0), (0.4, 5.0)):
        yield Case(f"disc that slides and rolls {friction:g}", partial(sliding_disc, friction, speed), 1.03, quick=True)
    for friction in (0.15, 0.25):
        yield Case(f"disc on a slope {friction:g}", partial(contact_models.disc, friction, math.atan(0.6)), 1.03)
    yield Case("box thrown up a slope, stays", rough_contacts.incline, 0.71, kink=KINKS)
    yield Case("box thrown up a slope, static", lambda: rough_contacts.incline(0.3, 0.7), 0.71, kink=KINKS)
    yield Case("box thrown up a slope, comes back", lambda: rough_contacts.incline(0.3, slope=40.0), 0.71, kink=KINKS)
    yield Case("tumbling box", rough_contacts.tumbling, 0.77, kink=CHAOS)
    yield Case("tumbling box, plastic", lambda: rough_contacts.tumbling(0.6, 0.0), 0.77, kink=CHAOS)
    for static in (0.6, 0.4):
        yield Case(f"block on a belt {static:g}", partial(belt, static), 4.03, kink=KINKS, quick=static == 0.6)
    yield Case("block on a belt to and fro", rough_contacts.belt, 1.53, kink=KINKS)
    yield Case("block that a crank pushes", rough_contacts.crank, 0.63, kink=KINKS)
    yield Case("oscillator with dry friction", lambda: dry_oscillator(0.1), 2.03, kink=KINKS)
    yield Case("oscillator with dry friction, static", lambda: dry_oscillator(0.15, 0.2), 2.03, kink=KINKS)
    yield Case("rod that slides", rough_contacts.rod, 0.33, kink=KINKS)
    yield Case("flywheel on a rolling disc", rough_contacts.freewheel, 0.93, kink=KINKS)
    yield Case("shoved block", shoved, 1.93, kink=KINKS)


def _several_at_once() -> Iterator[Case]:
    for points in (2, 3):
        build = partial(contact_models.box, 0.3, 0.5, points)
        yield Case(f"box on {points} feet", build, 0.53, even=True)
    for height, static in ((0.0, (0.5, 0.5)), (0.03, (0.5, 0.7)), (-0.05, (0.7, 0.5))):
        build = partial(pulled_box, height, static)
        yield Case(f"box pulled at {height:g}, {static[0]:g} {static[1]:g}", build, 7.03, kink=KINKS)
    yield Case("box that tips", tipped_box, 0.53)
    for friction in (0.0, 0.3):
        yield Case(f"ball in a wedge {friction:g}", partial(wedge, 0.0, friction), 0.83, kink=KINKS, quick=True)
    yield Case("ball that bounces in a wedge", lambda: wedge(0.4, 0.1), 0.83, kink=CHAOS)
    for restitution, friction in ((0.0, 0.4), (0.3, 0.4)):
        build = partial(stack, restitution, friction)
        yield Case(f"stack {restitution:g}", build, 0.67, even=True, kink=ZENO)
    yield Case("discs on each other in a bin", bin_of_discs, 0.19, kink=CHAOS)
    yield Case("two balls that land at one instant", two_balls, 1.43, kink=ZENO, even=True, quick=True)


def _on_discs() -> Iterator[Case]:
    yield Case("cradle of 3, elastic", lambda: cradle(3, 1.0), 1.03, even=True, quick=True)
    yield Case("cradle of 5, elastic", lambda: cradle(5, 1.0), 1.03, even=True)
    yield Case("cradle of 5, 0.9", lambda: cradle(5, 0.9), 1.03, even=True)
    yield Case("cradle on strings", lambda: hanging_cradle(0.95), 1.23, even=True, kink=CHAOS)
    yield Case("discs that roll into each other", rough_contacts.discs, 0.63, kink=CHAOS)
    yield Case("disc in a rolling ring", rough_contacts.ring, 0.37, kink=CHAOS)
    for friction in (0.0, 0.5):
        yield Case(f"disc that leaves a round hill {friction:g}", partial(on_a_disc, friction), 1.13, kink=KINKS)
    yield Case("ball in a ring", lambda: in_a_ring(0.8, 0.0), 0.93, kink=CHAOS)
    yield Case("ball that rolls in a ring", lambda: in_a_ring(0.0, 0.6), 0.93, kink=KINKS)
    yield Case("break of three discs", break_of_discs, 0.73, kink=CHAOS)


def _on_terrain() -> Iterator[Case]:
    yield Case("wheel on hills", rough_contacts.hills, 0.93, kink=CHAOS, quick=True)
    yield Case("bead that leaves a hill", lambda: bead_on_hill(0.0), 1.31)
    yield Case("disc that leaves a hill", lambda: bead_on_hill(0.2), 1.31)
    yield Case("ball on terrain", lambda: on_terrain(0.7, 0.0), 1.03, kink=CHAOS)
    yield Case("ball on rough terrain", lambda: on_terrain(0.3, 0.5), 1.03, kink=CHAOS)
    yield Case("ball in a closed terrain", closed_terrain, 0.83, kink=CHAOS)
    yield Case("box on terrain", box_on_terrain, 0.73, kink=CHAOS)


def thrown_up(speed: float) -> Mechanism:
    """A ball whose contact is closed at the start."""
    m = contact_models.ball(0.5, 0.0)
    m.start_moving(ball=(0.3, speed, 2.0))
    return m


def dropped_box(restitution: float, friction: float) -> Mechanism:
    """A box that falls flat on two feet."""
    m = contact_models.box(restitution, friction)
    m.start_near(box=(0, 1.25, 0))
    return m


def shaken_table(share: float) -> Mechanism:
    """A load on a table that is shaken by so many times gravity."""
    m, w, gravity = Mechanism("shaker"), 40.0, 9.80665
    reach = share * gravity / w**2
    table, load = m.body("table", 1.0, inertia=1.0), m.body("load", 1.0, inertia=1.0)
    m.prismatic("rail", m.ground.at(0, 0, math.pi / 2), table.at(0, 0, math.pi / 2))
    m.drive_coordinate("motor", m.ground.at(0, 0, math.pi / 2), table.origin, harmonic(reach, w))
    m.rigid_contact("touch", table.origin, load.origin, restitution=0.2)
    m.start_moving(load=(0.0, reach * w, 0.0))
    return m


def sliding_disc(friction: float, speed: float) -> Mechanism:
    """A disc that slides until it rolls."""
    m = contact_models.disc(friction)
    m.start_moving(wheel=(speed, 0.0, 0.0))
    return m


def belt(static: float) -> Mechanism:
    """A block that a spring holds on a belt: it sticks and slips."""
    m = Mechanism("belt", gravity=(0.0, -10.0))
    base, block = m.body("belt", 1.0, inertia=1.0), m.body("block", 1.0, inertia=1.0)
    m.prismatic("rail", m.ground.origin, base.origin)
    m.drive_coordinate("motor", m.ground.origin, base.origin, constant_rate(0.1))
    m.rigid_contact("touch", base.origin, block.origin, friction=0.4, static_friction=static)
    m.spring("spring", m.ground.at(-3, 0), block.origin, 50.0, free_length=3.0)
    m.start_moving(block=(0.1, 0, 0))
    return m


def dry_oscillator(friction: float, static: float | None = None) -> Mechanism:
    """A block on a table and a spring, which dry friction stops."""
    m = Mechanism("oscillator", gravity=(0.0, -10.0))
    block = m.body("block", 1.0, inertia=1.0)
    m.rigid_contact("table", m.ground.origin, block.origin, friction=friction, static_friction=static)
    m.spring("spring", m.ground.at(-5, 0), block.origin, 100.0, free_length=5.0)
    m.start_near(block=(0.095, 0, 0))
    return m


def shoved() -> Mechanism:
    """A block that a growing and falling force shoves again and again."""
    m = Mechanism("shoved", gravity=(0.0, -G))
    block = m.body("block", 2.0, inertia=1.0)
    m.rigid_contact("floor", m.ground.origin, block.origin, friction=0.4)
    m.force("shove", block.origin, harmonic(7.0, 2 * math.pi, -math.pi / 2, 7.0))
    return m


def pulled_box(height: float, static: tuple[float, float]) -> Mechanism:
    """A box on two feet under a growing pull."""
    m = Mechanism("box", gravity=(0, -10))
    box = m.body("box", 1.0, inertia=0.02)
    for name, x, mu in (("rear", -0.1, static[0]), ("front", 0.1, static[1])):
        m.rigid_contact(name, m.ground.at(0, 0), box.at(x, -0.05), friction=0.3, static_friction=mu)
    m.force("pull", box.at(0, height), polynomial(0.0, 1.0))
    m.start_near(box=(0, 0.05, 0))
    return m


def tipped_box() -> Mechanism:
    """A box that is pushed high, and tips."""
    m = contact_models.box(0.0, 2.0)
    m.force("push", m.bodies["box"].at(0, 0.25), polynomial(0.0, 100.0))
    return m


def wedge(restitution: float, friction: float) -> Mechanism:
    """A ball that drops into a wedge of two planes of unequal slope, and rests on both."""
    m = Mechanism("wedge", gravity=(0, -G))
    ball = m.body("ball", 0.5, inertia=2e-4)
    for name, slope in (("left", -50.0), ("right", 35.0)):
        m.rigid_contact(name, m.ground.at(0, 0, math.radians(slope)), ball.origin, 0.05, restitution, friction)
    m.start_near(ball=(0.03, 0.3, 0))
    m.start_moving(ball=(0.1, 0.0, 5.0))
    return m


def stack(restitution: float, friction: float) -> Mechanism:
    """Two boxes that fall flat, the upper one upon the lower."""
    m = Mechanism("stack", gravity=(0, -G))
    lower, upper = m.body("lower", 2.0, inertia=0.05), m.body("upper", 1.0, inertia=0.01)
    for name, x in (("left", -0.2), ("right", 0.2)):
        m.rigid_contact(f"{name} foot", m.ground.origin, lower.at(x, -0.1), 0.0, restitution, friction)
        m.rigid_contact(f"{name} upper", lower.at(0, 0.1), upper.at(0.5 * x, -0.05), 0.0, restitution, friction)
    m.start_near(lower=(0, 0.2, 0), upper=(0.0, 0.45, 0))
    return m


def bin_of_discs() -> Mechanism:
    """Three discs that fall on each other in a bin."""
    m = Mechanism("bin", gravity=(0, -G))
    for k, (x, y, radius) in enumerate(((-0.06, 0.1, 0.05), (0.07, 0.12, 0.06), (0.0, 0.28, 0.05))):
        disc = m.body(f"disc{k}", 100.0 * radius**2, inertia=50.0 * radius**4)
        m.rigid_contact(f"floor{k}", m.ground.origin, disc.origin, radius, 0.0, 0.3)
        m.rigid_contact(f"left{k}", m.ground.at(-0.13, 0, -math.pi / 2), disc.origin, radius, 0.0, 0.2)
        m.rigid_contact(f"right{k}", m.ground.at(0.15, 0, math.pi / 2), disc.origin, radius, 0.0, 0.2)
        m.start_near(**{f"disc{k}": (x, y, 0.0)})
    radii, discs = (0.05, 0.06, 0.05), [m.bodies[f"disc{k}"] for k in range(3)]
    for i, j in ((0, 1), (0, 2), (1, 2)):
        m.rigid_discs(f"pair{i}{j}", discs[i].origin, discs[j].origin, radii[i], radii[j], friction=0.2)
    return m


def two_balls() -> Mechanism:
    """Two balls without a common body that land at one instant, and differ in what they lose."""
    m = Mechanism("two balls", gravity=(0, -G))
    for name, x, restitution in (("a", -0.5, 0.5), ("b", 0.5, 0.7)):
        ball = m.body(name, 1.0, inertia=0.01)
        m.rigid_contact(f"floor {name}", m.ground.origin, ball.origin, 0.1, restitution)
        m.start_near(**{name: (x, 0.9, 0.0)})
    return m


def cradle(count: int, restitution: float) -> Mechanism:
    """Balls on a rail that touch; the first comes with the speed that the last one goes with."""
    m = Mechanism("cradle", gravity=None)
    balls = [m.body(f"ball{k}", 0.5, inertia=0.01) for k in range(count)]
    for k, body in enumerate(balls):
        m.prismatic(f"rail{k}", m.ground.origin, body.origin)
        m.start_near(**{f"ball{k}": (0.1 * k if k else -0.4, 0.0, 0.0)})
    for k in range(count - 1):
        m.rigid_discs(f"touch{k}", balls[k].origin, balls[k + 1].origin, 0.05, 0.05, restitution=restitution)
    m.coordinate_stop("wall", m.ground.origin, balls[-1].origin, 0.1 * count, upper=True, restitution=restitution)
    m.start_moving(ball0=(1.0, 0.0, 0.0))
    return m


def hanging_cradle(restitution: float) -> Mechanism:
    """Three balls on rods that hang a little apart, the first drawn aside."""
    m = Mechanism("hanging cradle", gravity=(0, -G))
    balls = []
    for k in range(3):
        ball = m.body(f"ball{k}", 0.4, inertia=1e-3)
        m.revolute(f"pin{k}", m.ground.at(0.1005 * k, 0), ball.at(0, 0.6))
        m.start_near(**{f"ball{k}": -40.0 if k == 0 else 0.0})
        balls.append(ball)
    for k in range(2):
        m.rigid_discs(f"touch{k}", balls[k].origin, balls[k + 1].origin, 0.05, 0.05, restitution=restitution)
    return m


def on_a_disc(friction: float) -> Mechanism:
    """A disc that rolls or slides off a fixed one."""
    m = Mechanism("hill", gravity=(0, -G))
    disc = m.body("disc", 0.5, inertia=0.5 * 0.5 * 0.1**2)
    m.rigid_discs("touch", m.ground.origin, disc.origin, 0.5, 0.1, friction=friction)
    m.start_near(disc=(0.0, 0.6, 0.0))
    m.start_moving(disc=(0.4, 0.0, 0.0))
    return m


def in_a_ring(restitution: float, friction: float) -> Mechanism:
    """A ball in a fixed ring."""
    m = Mechanism("ring", gravity=(0, -G))
    ball = m.body("ball", 0.3, inertia=2e-4)
    m.rigid_discs("ring", m.ground.origin, ball.origin, 0.5, 0.05, True, restitution, friction)
    m.start_near(ball=(-0.35, 0.0, 0.0))
    m.start_moving(ball=(0.0, 0.0, 8.0))
    return m


def break_of_discs() -> Mechanism:
    """A rough disc that meets two others off their middle on a smooth table."""
    m = Mechanism("break", gravity=None)
    places = ((-0.4, 0.013), (0.0, 0.06), (0.02, -0.05))
    discs = [m.body(f"disc{k}", 0.2, inertia=2e-4) for k in range(3)]
    for k, (x, y) in enumerate(places):
        m.start_near(**{f"disc{k}": (x, y, 0.0)})
    for i, j in ((0, 1), (0, 2), (1, 2)):
        m.rigid_discs(f"pair{i}{j}", discs[i].origin, discs[j].origin, 0.05, 0.05, restitution=0.9, friction=0.15)
    m.start_moving(disc0=(1.5, 0.0, 6.0))
    return m


def bead_on_hill(radius: float) -> Mechanism:
    """A bead, or a disc, that slides down a round hill and leaves it."""
    path, angles = 2.0 - radius, np.linspace(math.radians(170), math.radians(10), 80)
    m = Mechanism("hill", gravity=(0, -G))
    bead = m.body("bead", 0.4, inertia=1e-3)
    hill = [(path * math.cos(a), path * math.sin(a)) for a in angles]
    m.rigid_terrain("ground", m.ground.origin, bead.origin, hill, radius=radius)
    m.start_near(bead=(0.0, 2.0, 0.0))
    m.start_moving(bead=(0.5, 0.0, 0.0))
    return m


def _hills() -> list[tuple[float, float]]:
    return [(x, 0.3 * math.sin(x) - 0.05 * x) for x in np.linspace(-4.0, 6.0, 60).tolist()]


def on_terrain(restitution: float, friction: float) -> Mechanism:
    """A ball that falls upon a slope."""
    m = Mechanism("slope", gravity=(0, -G))
    ball = m.body("ball", 0.4, inertia=1e-3)
    m.rigid_terrain("ground", m.ground.origin, ball.origin, _hills(), 0.1, False, restitution, friction)
    m.start_near(ball=(1.0, 1.2, 0.0))
    return m


def closed_terrain() -> Mechanism:
    """A ball within an oval."""
    turn = np.linspace(0, 2 * math.pi, 24, endpoint=False)
    m = Mechanism("oval", gravity=(0, -G))
    ball = m.body("ball", 0.4, inertia=1e-3)
    points = np.column_stack([0.8 * np.cos(turn), 0.5 * np.sin(turn)]).tolist()
    m.rigid_terrain("oval", m.ground.origin, ball.origin, points, 0.08, True, 0.6, 0.2)
    m.start_near(ball=(0.3, 0.1, 0.0))
    m.start_moving(ball=(-0.5, 0.3, 3.0))
    return m


def box_on_terrain() -> Mechanism:
    """A box on two feet that settles on rough terrain."""
    m = Mechanism("box", gravity=(0, -G))
    box = m.body("box", 2.0, inertia=0.05)
    for name, x in (("left", -0.2), ("right", 0.2)):
        m.rigid_terrain(name, m.ground.origin, box.at(x, -0.1), _hills(), restitution=0.0, friction=0.7)
    m.start_near(box=(-1.5, 0.2, 10.0))
    return m
