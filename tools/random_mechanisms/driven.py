"""Points and discs on open curves that cross their straight continuations, or pass close by."""

from __future__ import annotations

import math
import warnings
from contextlib import suppress

import numpy as np

from mbsd import Mechanism, ModelError, constant_rate, harmonic
from mbsd.cams import RISES, Lift, flat_cam, oscillating_flat_cam, oscillating_roller_cam, roller_cam
from mbsd.results.solution import Solution
from tools.models.assur_models import MODELS
from tools.random_mechanisms.described import seen_from
from tools.random_mechanisms.laws import swinging, turning
from tools.random_mechanisms.linkages import linkage
from tools.random_mechanisms.machines import _at_start, driven_crank, solid
from tools.random_mechanisms.subject import Subject, family

# Driven mechanisms without a closed form of this tool: cams, curves, parallelograms, linkages, every group's model.


STEEPEST_FALL = -0.8
"""rad per rad of the cam: a flat face on an arm leaves the cam at -1, where there is none."""


def _lift(rng: np.random.Generator, height: float) -> Lift:
    if rng.random() < 0.2:
        angles = np.linspace(0, 2 * math.pi, 25)[:-1]
        return Lift.table(angles, height * (0.5 - 0.5 * np.cos(angles) + 0.1 * np.sin(angles) ** 2))
    widths = rng.dirichlet([3, 1, 3, 2]) * 2 * math.pi
    widths = np.maximum(widths, 0.25)
    widths *= 2 * math.pi / widths.sum()
    up, down = (str(name) for name in rng.choice(list(RISES), 2))
    first, top, fall = (float(w) for w in widths[:3])
    return Lift.of((first, height, up), (top, height), (fall, 0.0, down), (2 * math.pi - first - top - fall, 0.0))


@family("cam", 1.5)
def cam(rng: np.random.Generator) -> Subject:
    """Rollers and flat faces, on slides and on arms, by all lift laws."""
    m, drive = Mechanism("cam"), turning(rng, float(rng.uniform(-3, 3)))
    disc = solid(m, "cam", rng)
    m.revolute("shaft", m.ground.origin, disc.origin)
    m.drive_angle("motor", disc, drive.law)
    m.start_near(cam=(0, 0, math.degrees(_at_start(drive))))
    kind = str(rng.choice(["roller", "flat", "oscillating roller", "oscillating flat"]))
    base = float(rng.uniform(0.03, 0.3))
    follower = solid(m, "follower", rng, 0.3 * base)
    if kind in ("roller", "flat"):
        lift = _lift(rng, base * float(rng.uniform(0.1, 0.5)))
        offset = base * float(rng.uniform(-0.3, 0.3))
        profile = roller_cam(lift, base, 0.3 * base, offset) if kind == "roller" else flat_cam(lift, base)
        x = offset if kind == "roller" else 0.0
        m.prismatic("guide", m.ground.at(x, 0, math.pi / 2), follower.at(0, 0, math.pi / 2))
        m.start_near(follower=(x, 1.35 * base, 0))
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # an undercut cam moves as well
            if kind == "roller":
                m.cam_roller("contact", disc.origin, follower.origin, profile)
            else:
                m.cam_flat("contact", disc.origin, follower.origin, profile)
    else:
        lift = _lift(rng, float(rng.uniform(0.05, 0.4)))
        pivot = 2.5 * base
        m.revolute("pivot", m.ground.at(pivot, 0), follower.origin)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            if kind == "oscillating roller":
                profile = oscillating_roller_cam(lift, base, 0.3 * base, arm=2.2 * base, pivot_distance=pivot)
                m.cam_roller("contact", disc.origin, follower.at(2.2 * base, 0), profile)
            else:
                while lift.pieces()[1][..., 1].min() < STEEPEST_FALL:
                    lift = _lift(rng, float(rng.uniform(0.05, 0.4)))
                profile = oscillating_flat_cam(lift, base, pivot_distance=pivot)
                m.cam_flat("contact", disc.origin, follower.at(1.0 * base, 0), profile)
        m.start_near(follower=(pivot, 0, 150))
    return Subject(m, drive.duration, True, drive.turn, traits=frozenset({"jumps"}))


@family("point on a curve")
def on_a_curve(rng: np.random.Generator) -> Subject:
    """A pin on a closed or open curve, pulled round by a slotted crank or pushed along by a slide."""
    m, radius = Mechanism("curve"), float(rng.uniform(0.1, 1.0))
    angles = np.linspace(0, 2 * math.pi, 13)[:-1]
    if rng.random() < 0.6:
        points = [
            (float(r * math.cos(a)), float(r * math.sin(a)))
            for a, r in zip(angles, radius * rng.uniform(0.85, 1.15, 12), strict=True)
        ]
        drive = turning(rng, float(rng.uniform(-3, 3)))
        crank, pin = driven_crank(m, rng, radius, drive), solid(m, "pin", rng)
        m.prismatic("slot", crank.origin, pin.origin)
        m.point_on_curve("curve", m.ground.origin, pin.origin, points, closed=True)
        start = _at_start(drive)
        m.start_near(pin=(radius * math.cos(start), radius * math.sin(start), math.degrees(start)))
        return Subject(m, drive.duration, True, drive.turn)
    x = np.linspace(-3, 3, 13) * radius
    points = [(float(a), float(b)) for a, b in zip(x, 0.2 * radius * rng.normal(size=13), strict=True)]
    drive = swinging(rng, 0.0, 2.2 * radius)
    cart, wheel = solid(m, "cart", rng), solid(m, "wheel", rng)
    m.prismatic("rail", m.ground.at(0.0, 2 * radius), cart.origin)
    m.drive_coordinate("push", m.ground.origin, cart.origin, drive.law)
    m.prismatic("drop", cart.at(0, 0, math.pi / 2), wheel.at(0, 0, math.pi / 2))
    m.point_on_curve("curve", m.ground.origin, wheel.origin, points)
    at = _at_start(drive)
    m.start_near(cart=(at, 2 * radius, 0), wheel=(at, 0, 0))
    return Subject(m, drive.duration, True, drive.turn)


@family("rolling on terrain")
def on_terrain(rng: np.random.Generator) -> Subject:
    """A disc pushed over a smooth terrain."""
    m, size = Mechanism("terrain"), float(rng.uniform(0.3, 2.0))
    x = np.linspace(-3, 3, 11) * size
    points = [(float(a), float(b)) for a, b in zip(x, 0.12 * size * rng.normal(size=11), strict=True)]
    drive = swinging(rng, 0.0, 2.0 * size)
    disc = solid(m, "disc", rng)
    while "road" not in m.joints:
        with suppress(ModelError):  # where the disc touches twice
            m.rolling_on_curve("road", m.ground.origin, disc.origin, points, radius=0.05 * size)
        points = [(a, 0.8 * b) for a, b in points]
    m.drive_coordinate("push", m.ground.origin, disc.origin, drive.law)
    m.start_near(disc=(_at_start(drive), 0.05 * size, 0))
    return Subject(m, drive.duration, True, drive.turn)


@family("parallelogram, redundant")
def parallelogram(rng: np.random.Generator) -> Subject:
    """Return three parallel cranks under one coupler.

    The third repeats the others, and carries it past the change points.
    """
    m, drive = Mechanism("parallelogram"), turning(rng, float(rng.uniform(0.3, 2.6)))
    radius, width = (float(x) for x in rng.uniform(0.1, 0.6, 2))
    third = complex(0.4 * width, float(rng.choice([0.0, 1.0]) * rng.uniform(0.1, 0.4)))
    crank, coupler = driven_crank(m, rng, radius, drive), solid(m, "coupler", rng, width)
    start = _at_start(drive)
    m.revolute("A", crank.end, coupler.origin)
    for k, at in enumerate((complex(width), third)):
        bar = m.bar(f"bar{k}", radius, float(rng.uniform(0.2, 2.0)))
        m.revolute(f"foot{k}", m.ground.at(at.real, at.imag), bar.start)
        m.revolute(f"head{k}", coupler.at(at.real, at.imag), bar.end)
        m.start_near(**{bar.name: math.degrees(start)})
    m.start_near(coupler=(radius * math.cos(start), radius * math.sin(start), 0))

    def judge(sol: Solution) -> list[str]:
        worst = float(np.abs(sol.body("coupler").theta).max())
        return [] if worst < 1e-6 else [f"the coupler of a parallelogram turns by {worst:.3g} rad"]

    flat = third.imag == 0.0
    traits = frozenset({"bifurcates"} if flat else set())
    return Subject(m, drive.duration, True, drive.turn, judge, None if flat else True, 0.0 if flat else 1.0, traits)


@family("linkage, cranks swing", 2.0)
def swinging_linkage(rng: np.random.Generator) -> Subject:
    """Loops of bars, sliders, slots and rods on each other; all cranks swing a little."""
    made = linkage(int(rng.integers(10**9)), int(rng.integers(1, 4)), damping=True)
    turn = 1.0
    for k, (host, crank) in enumerate(made.cranks):
        lies = made.frames[crank.name][2] - made.frames[host.name][2]
        swing, rate, phase = rng.uniform(0.02, 0.3), float(rng.integers(3, 9)), rng.uniform(-1, 1)
        made.m.drive_relative_angle(
            f"motor{k}", host, crank, harmonic(swing, rate, phase, lies - swing * math.sin(phase))
        )
        turn = 2 * math.pi / rate
    return Subject(made.m, turn, True, turn)


@family("linkage, cranks turn", 2.0)
def turning_linkage(rng: np.random.Generator) -> Subject:
    """The same, with cranks that turn: most come to a toggle somewhere."""
    made = linkage(int(rng.integers(10**9)), int(rng.integers(1, 4)), damping=True)
    for k, (host, crank) in enumerate(made.cranks):
        lies = made.frames[crank.name][2] - made.frames[host.name][2]
        made.m.drive_relative_angle(f"motor{k}", host, crank, constant_rate(float(rng.choice([-1, 1, 2])), lies))
    return Subject(made.m, float(rng.choice([0.25, 0.5, 1.0])) * 2 * math.pi, True, 2 * math.pi)


@family("model of each group", 1.5)
def every_group(rng: np.random.Generator) -> Subject:
    """The models that the tests of the closed forms use, their numbers a little off."""
    m = MODELS[str(rng.choice(list(MODELS)))]()
    frames = {name: tuple(float(x) for x in rng.normal(scale=[0.003, 0.003, 0.03])) for name in list(m.bodies)[1:]}
    words = seen_from(m, frames)  # pyright: ignore[reportArgumentType]
    for name, joint in words.joints.items():  # half of the markers keep their old numbers: another mechanism
        if rng.random() < 0.5:
            old = m.joints[name]
            i, j = (words.bodies[marker.body.name].at(marker.x, marker.y, marker.angle) for marker in (old.i, old.j))
            words.joints[name] = type(joint)(joint.kind, name, i, j, joint.params)
    period = 2 * math.pi / 6.0
    if set(m.bodies) >= {"base", "arm"}:
        period = math.pi
    return Subject(words, period, True, period)


KEPT = 1e-6
"""Part of the largest kinetic energy by which the energy may change."""


@family("points on open curves that go on through themselves")
def continued(rng: np.random.Generator) -> Subject:
    """An arc beyond half a circle, a spiral, a loop that crosses itself, a hook; a bead or a rolling disc."""
    kind, count = int(rng.integers(4)), int(rng.integers(25, 60))
    if kind == 0:
        a = np.linspace(-1.0, 1.0, count) * float(rng.uniform(1.6, 3.0))
        points = np.stack([np.sin(a), -np.cos(a)], axis=1)
    elif kind == 1:
        a = np.linspace(0.0, float(rng.uniform(7.0, 12.0)), count)
        points = (1 - float(rng.uniform(0.03, 0.06)) * a)[:, None] * np.stack([np.sin(a), -np.cos(a)], axis=1)
    elif kind == 2:
        a = np.linspace(-1.0, 1.0, count) * float(rng.uniform(1.7, 2.8))
        points = np.stack([0.5 * np.sin(2 * a), np.cos(a)], axis=1)
    else:
        a = np.linspace(0.0, math.pi, count // 2)
        leg = np.stack([np.ones(8), np.linspace(3.0, 0.2, 8)], axis=1)
        points = np.concatenate([leg, np.stack([0.5 + 0.5 * np.cos(a), -0.5 * np.sin(a)], axis=1)])
    points = points[:: int(rng.choice([-1, 1]))]
    return _running(rng, points, (0.0, 0.02, 0.04))


@family("points on curves beside themselves", weight=0.5)
def points_beside_curves(rng: np.random.Generator) -> Subject:
    """A hairpin, a way to and fro, the same with crooked legs; a bead or a small rolling disc."""
    kind, gap = int(rng.integers(3)), float(10 ** rng.uniform(-1.5, -0.5))
    turn, up = np.linspace(0.0, math.pi, 9)[1:-1], np.linspace(0.0, 1.0, int(rng.integers(5, 15)))
    legs, parts = 2 if kind == 0 else int(rng.integers(3, 7)), []
    for leg in range(legs):
        x, down = 2.0 * gap * leg, leg % 2 == 1
        parts.append(np.stack([np.full(len(up), x), up[::-1] if down else up], axis=1))
        if leg < legs - 1:
            over = -gap * np.sin(turn) if down else 1.0 + gap * np.sin(turn)
            parts.append(np.stack([x + gap * (1.0 - np.cos(turn)), over], axis=1))
    points = np.concatenate(parts)
    if kind == 2:
        points += 0.05 * gap * rng.normal(size=points.shape)
    return _running(rng, points, (0.0, 0.05 * gap))


def _running(rng: np.random.Generator, points: np.ndarray, radii: tuple[float, ...]) -> Subject:
    """A bead, or a disc of one of the radii, that begins somewhere on a curve and runs along it."""
    m = Mechanism("continued", gravity=(0.0, float(rng.choice([0.0, -9.81]))))
    at = int(rng.integers(2, len(points) - 2))
    way = points[at + 1] - points[at - 1]
    way /= np.hypot(*way)
    speed = float(rng.uniform(2.0, 8.0) * rng.choice([-1, 1]))
    radius = float(rng.choice(radii))
    x, y = (points[at] + radius * np.array([-way[1], way[0]])).tolist()
    body = m.body("bead", 1.0, inertia=0.01)
    if radius:
        m.rolling_on_curve("track", m.ground.origin, body.origin, points.tolist(), radius)
    else:
        m.point_on_curve("track", m.ground.origin, body.origin, points.tolist())
    m.start_near(bead=(x, y, 0.0))
    m.start_moving(bead=(speed * float(way[0]), speed * float(way[1]), -speed / radius if radius else 0.0))
    return Subject(m, float(rng.uniform(0.5, 2.0)), False, truth=_keeps_energy, traits=frozenset({"jumps"}))


def _keeps_energy(sol: Solution) -> list[str]:
    assert sol.audit is not None
    lost, most = float(np.ptp(sol.audit)), float(sol.energy.kinetic.max())
    return [f"energy changes by {lost:.3g} of {most:.3g} J"] if lost > KEPT * most else []
