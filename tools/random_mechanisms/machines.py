"""Machines whose motion has a closed form: guides, yokes, gears, belts, racks, engines with gas."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from mbsd import GasCycle, Mechanism, constant_rate, harmonic, pressure_table, two_stroke
from mbsd.arrays.chambers import chambers
from mbsd.model.body import Body
from mbsd.results.fluids import GasView
from mbsd.results.solution import Solution
from tools.random_mechanisms.laws import Drive, swinging, turning
from tools.random_mechanisms.subject import Subject, family

# Driven machines whose motion has a closed form: guides, yokes, gears, belts, racks, discs, Geneva wheels.


Exact = Callable[[np.ndarray], dict[str, np.ndarray]]
"""From the driven values to angles of bodies (rad), or places ("slider.x"), each but for a constant."""


def exactly(driver: str, exact: Exact, slack: float = 1e-8) -> Callable[[Solution], list[str]]:
    """The judge for values known but for a constant."""

    def judge(sol: Solution) -> list[str]:
        out = []
        for name, values in exact(sol.driver(driver).value).items():
            body, _, what = name.partition(".")
            seen = getattr(sol.body(body), what or "theta")
            gap = np.abs((seen - seen[0]) - (values - values[0])) / max(1.0, float(np.abs(values - values[0]).max()))
            k = int(np.argmax(np.where(np.isfinite(gap), gap, np.inf)))
            if not gap[k] < slack:
                out.append(f"closed form: '{name}' is off by {gap[k]:.3g} at t = {sol.t[k]:.6g} s")
        return out

    return judge


def solid(m: Mechanism, name: str, rng: np.random.Generator, size: float = 0.1) -> Body:
    """A body with random mass, its centre off its frame."""
    mass = float(rng.uniform(0.2, 3.0))
    com = tuple(float(x) for x in rng.normal(scale=0.3 * size, size=2))
    return m.body(name, mass, com, mass * size**2 * float(rng.uniform(0.1, 1.0)))


def driven_crank(m: Mechanism, rng: np.random.Generator, length: float, drive: Drive) -> Body:
    """About the origin."""
    crank = m.bar("crank", length, float(rng.uniform(0.2, 2.0)))
    m.revolute("O", m.ground.origin, crank.start)
    m.drive_angle("motor", crank, drive.law)
    m.start_near(crank=math.degrees(_at_start(drive)))
    return crank


def _at_start(drive: Drive) -> float:
    return float(drive.law.over(0.0, drive.duration)(np.zeros(1))[0, 0])


@family("inverted slider-crank, quick return")
def inverted(rng: np.random.Generator) -> Subject:
    """Return a guide that a pin or block on the crank turns.

    It swings or goes round, sometimes near where that changes.
    """
    m, drive = Mechanism("inverted"), turning(rng, float(rng.uniform(-1.2, 1.2)))
    radius = float(rng.uniform(0.05, 0.5))
    near = rng.random() < 0.3
    ratio = 1.0 + float(rng.choice([-1, 1]) * (10 ** rng.uniform(-6, -1) if near else rng.uniform(0.1, 0.7)))
    pivot = radius * ratio
    crank, guide = driven_crank(m, rng, radius, drive), solid(m, "guide", rng)
    m.revolute("P", m.ground.at(-pivot, 0.0), guide.origin)
    start = _at_start(drive)
    pin = radius * complex(math.cos(start), math.sin(start))
    angle = math.atan2(pin.imag, pin.real + pivot)
    if rng.random() < 0.5:
        m.pin_in_slot("slot", guide.origin, crank.end)
    else:
        block = solid(m, "block", rng)
        m.revolute("B", crank.end, block.origin)
        m.prismatic("slide", guide.origin, block.origin)
        m.start_near(block=(pin.real, pin.imag, math.degrees(angle)))
    m.start_near(guide=(-pivot, 0.0, math.degrees(angle)))

    def exact(phi: np.ndarray) -> dict[str, np.ndarray]:
        if pivot > radius:
            return {"guide": np.arctan2(radius * np.sin(phi), radius * np.cos(phi) + pivot)}
        share = pivot / radius
        return {"guide": phi + np.angle(1.0 + share * np.exp(-1j * phi))}

    away = abs(ratio - 1.0)
    return Subject(m, drive.duration, True, drive.turn, exactly("motor", exact, 1e-8 + 1e-13 / away), True, away)


@family("yoke")
def yoke(rng: np.random.Generator) -> Subject:
    """A Scotch yoke, its slot not always square to its rail."""
    m, drive = Mechanism("yoke"), turning(rng, float(rng.uniform(-3, 3)))
    radius, slope = float(rng.uniform(0.02, 0.5)), float(rng.uniform(0.7, 2.4))
    crank, body = driven_crank(m, rng, radius, drive), solid(m, "yoke", rng)
    m.prismatic("rail", m.ground.at(0.3, 0.0), body.origin)
    m.pin_in_slot("slot", body.at(0.05, 0.02, slope), crank.end)
    m.start_near(yoke=(0.0, 0.0, 0.0))

    def exact(phi: np.ndarray) -> dict[str, np.ndarray]:
        return {"yoke.x": radius * (np.cos(phi) - np.sin(phi) / math.tan(slope)), "yoke": 0 * phi}

    return Subject(m, drive.duration, True, drive.turn, exactly("motor", exact), True)


@family("gears and belts")
def gears(rng: np.random.Generator) -> Subject:
    """Return a train of one to four wheels on ground.

    They are external, internal or belts, now and then with a rack.
    """
    m, drive = Mechanism("gears"), turning(rng, float(rng.uniform(-3, 3)))
    first = solid(m, "wheel0", rng)
    m.revolute("shaft0", m.ground.origin, first.origin)
    m.drive_angle("motor", first, drive.law)
    m.start_near(wheel0=(0.0, 0.0, math.degrees(_at_start(drive))))
    ratios, centre, radius, last = {"wheel0": 1.0}, complex(0), float(rng.uniform(0.05, 0.5)), first
    for k in range(1, int(rng.integers(2, 5))):
        wheel, other = solid(m, f"wheel{k}", rng), float(rng.uniform(0.05, 0.5))
        kind = str(rng.choice(["external", "internal", "open", "crossed"]))
        if kind == "internal":
            radius = max(radius, other * 1.2)
        distance = {"external": radius + other, "internal": radius - other}.get(kind, 1.5 * (radius + other))
        centre += distance * np.exp(1j * rng.uniform(-3, 3))
        at = m.ground.at(float(centre.real), float(centre.imag))
        m.revolute(f"shaft{k}", at, wheel.origin)
        if kind in ("external", "internal"):
            m.gear_pair(f"mesh{k}", last.origin, wheel.origin, radius, other, internal=kind == "internal")
        else:
            m.belt(f"belt{k}", last.origin, wheel.origin, radius, other, crossed=kind == "crossed")
        sign = -1.0 if kind in ("external", "crossed") else 1.0
        ratios[wheel.name] = ratios[last.name] * sign * radius / other
        m.start_near(**{wheel.name: (float(centre.real), float(centre.imag), float(rng.uniform(-180, 180)))})
        last, radius = wheel, other
    slides = {}
    if rng.random() < 0.5:
        rack = solid(m, "rack", rng)
        slope = float(rng.uniform(-3, 3))
        away = centre - 1j * radius * np.exp(1j * slope)
        m.prismatic("rail", m.ground.at(float(away.real), float(away.imag), slope), rack.origin)
        m.rack_and_pinion("mesh rack", rack.origin, last.origin, radius)
        m.start_near(rack=(float(away.real), float(away.imag), math.degrees(slope)))
        slides["rack.x"] = radius * ratios[last.name] * math.cos(slope)

    def exact(phi: np.ndarray) -> dict[str, np.ndarray]:
        return {name: ratio * phi for name, ratio in (ratios | slides).items()}

    return Subject(m, drive.duration, True, drive.turn, exactly("motor", exact), True)


@family("planetary gears")
def planetary(rng: np.random.Generator) -> Subject:
    """Sun, planets on a carrier, a ring that stands or turns; driven at sun, carrier or both."""
    m, drive = Mechanism("planetary"), turning(rng, float(rng.uniform(-3, 3)))
    sun_radius, planet_radius = (float(x) for x in rng.uniform(0.05, 0.3, 2))
    ring_radius = sun_radius + 2 * planet_radius
    sun, carrier = solid(m, "sun", rng), solid(m, "carrier", rng)
    m.revolute("shaft", m.ground.origin, sun.origin)
    m.revolute("bearing", m.ground.origin, carrier.origin)
    at_sun = rng.random() < 0.5
    fixed = rng.random() < 0.6
    ring = m.ground if fixed else solid(m, "ring", rng)
    if not fixed:
        m.revolute("rim", m.ground.origin, ring.origin)
    arm = sun_radius + planet_radius
    for k in range(int(rng.integers(1, 3))):
        planet = solid(m, f"planet{k}", rng)
        angle = 2 * math.pi * k / 2
        m.revolute(f"pin{k}", carrier.at(arm * math.cos(angle), arm * math.sin(angle)), planet.origin)
        m.gear_pair(f"inner{k}", sun.origin, planet.origin, sun_radius, planet_radius)
        m.gear_pair(f"outer{k}", ring.origin, planet.origin, ring_radius, planet_radius, internal=True)
    m.drive_angle("motor", sun if at_sun else carrier, drive.law)
    share = float(rng.uniform(-1, 1))
    start = _at_start(drive)
    if not fixed:
        m.drive_relative_angle("second", carrier, ring, harmonic(share, 10.0 / drive.duration))
    m.start_near(sun=(0, 0, math.degrees(start) if at_sun else 0), carrier=(0, 0, 0 if at_sun else math.degrees(start)))
    ratio = 1.0 + ring_radius / sun_radius  # sun against carrier, ring at rest

    def judge(sol: Solution) -> list[str]:
        theta = {name: sol.body(name).theta - sol.body(name).theta[0] for name in m.bodies if name != "ground"}
        rim = theta.get("ring", np.zeros(len(sol.t)))
        gap = sun_radius * (theta["sun"] - theta["carrier"]) + ring_radius * (rim - theta["carrier"])
        turn = theta["planet0"] - theta["carrier"] + (theta["sun"] - theta["carrier"]) * sun_radius / planet_radius
        worst = max(np.abs(gap).max() / ring_radius, np.abs(turn).max() * planet_radius / ring_radius)
        limit = 1e-8 * max(1.0, float(np.abs(sol.driver("motor").value).max()))
        return [] if worst < limit else [f"Willis: the angles do not belong together by {worst:.3g} rad ({ratio:.3g})"]

    return Subject(m, drive.duration, True, drive.turn, judge, True)


@family("rolling disc")
def rolling(rng: np.random.Generator) -> Subject:
    """A disc on a sloped line, driven along it or turned."""
    m, slope = Mechanism("rolling"), float(rng.uniform(-3, 3))
    radius, disc = float(rng.uniform(0.05, 0.5)), solid(m, "disc", rng)
    line = m.ground.at(float(rng.normal()), float(rng.normal()), slope)
    m.rolling_disc("road", line, disc.origin, radius)
    by_angle = rng.random() < 0.5
    drive = turning(rng, 0.3) if by_angle else swinging(rng, 0.2, float(rng.uniform(0.1, 3.0)))
    if by_angle:
        m.drive_angle("motor", disc, drive.law)
    else:
        m.drive_coordinate("motor", line, disc.origin, drive.law)
    along, up = np.exp(1j * slope), 1j * radius * np.exp(1j * slope)
    centre = complex(line.x, line.y) + up + along * (0.0 if by_angle else _at_start(drive))
    m.start_near(disc=(centre.real, centre.imag, math.degrees(_at_start(drive)) if by_angle else 20.0))

    def exact(value: np.ndarray) -> dict[str, np.ndarray]:
        s, angle = (-radius * value, value) if by_angle else (value, -value / radius)
        return {"disc": angle, "disc.x": s * along.real, "disc.y": s * along.imag}

    return Subject(m, drive.duration, True, drive.turn, exactly("motor", exact), True)


@family("Geneva wheel", 1.5)
def geneva(rng: np.random.Generator) -> Subject:
    """Three to eight slots, half a turn to three turns of the crank."""
    m, slots = Mechanism("geneva"), int(rng.integers(3, 9))
    distance = float(rng.uniform(0.05, 0.5))
    radius = distance * math.sin(math.pi / slots)
    drive = turning(rng, float(rng.uniform(-2.5, 2.5)))
    crank, wheel = driven_crank(m, rng, radius, drive), solid(m, "wheel", rng)
    m.revolute("W", m.ground.at(distance, 0.0), wheel.origin)
    m.geneva("geneva", crank.origin, wheel.origin, slots, radius)

    def exact(phi: np.ndarray) -> dict[str, np.ndarray]:
        """Slots point at the pin while it is within pi/2 - pi/n of the line of centres; counted over turns."""
        turns = np.round(phi / (2 * math.pi))
        alpha = phi - 2 * math.pi * turns
        reach = math.pi / 2 - math.pi / slots
        inside = np.clip(alpha, -reach, reach)
        beta = np.arctan2(radius * np.sin(inside), distance - radius * np.cos(inside))
        return {"wheel": -beta - 2 * math.pi / slots * turns}

    first = exact(np.array([_at_start(drive)]))["wheel"][0] + math.pi
    m.start_near(wheel=(distance, 0.0, math.degrees(first)))
    judge = exactly("motor", exact, 1e-7)
    return Subject(m, drive.duration, True, drive.turn, judge, True, traits=frozenset({"jumps"}))


# Engines of one cylinder with gas that burns: driven or free, offset, either way round, upright or lying.


SLACK = 1e-8
"""Fraction of a stroke."""


@family("engines with gas that burns")
def engines(rng: np.random.Generator) -> Subject:
    """Return a slider-crank whose gas repeats after each turn.

    It does not matter in which turn its world stands.
    """
    m, driven = Mechanism("engine", gravity=(float(rng.normal()), -9.81)), bool(rng.random() < 0.5)
    throw = float(rng.uniform(0.02, 0.06))
    rod, offset = float(rng.uniform(2.5, 4.5)) * throw, float(rng.choice([0.0, rng.uniform(-0.3, 0.3)])) * throw
    lies, ahead = float(rng.uniform(-math.pi, math.pi)), float(rng.uniform(-math.pi, math.pi))
    along, across = np.array([math.cos(lies), math.sin(lies)]), np.array([-math.sin(lies), math.cos(lies)])
    pin = throw * np.array([math.cos(ahead), math.sin(ahead)])
    wrist = (pin @ along + math.sqrt(rod**2 - (offset - pin @ across) ** 2)) * along + offset * across
    lean = math.atan2(*(wrist - pin)[::-1])
    crank, link = m.bar("crank", throw, 1.0, (0.0, 0.0), float(rng.uniform(0.02, 0.2))), m.bar("rod", rod, 0.3)
    piston = m.body("piston", float(rng.uniform(0.2, 0.6)))
    m.revolute("main", m.ground.origin, crank.start)
    m.revolute("big_end", crank.end, link.start)
    m.revolute("wrist", link.end, piston.origin)
    beside, head = offset * across, 1.5 * (rod + throw) * along
    m.prismatic("liner", m.ground.at(float(beside[0]), float(beside[1]), lies), piston.origin)
    m.start_near(crank=math.degrees(ahead), rod=math.degrees(lean), piston=(*map(float, wrist), math.degrees(lies)))
    clockwise = bool(rng.random() < 0.5)
    speed = float(rng.uniform(60.0, 200.0)) * (-1.0 if clockwise else 1.0)
    m.gas_cycle(
        "gas", m.ground.at(float(head[0]), float(head[1]), lies + math.pi), piston.at(0.3 * throw, 0.0), crank,
        _cycle(rng), bore=1.9 * throw, clockwise=clockwise, outside=float(rng.choice([0.0, 101325.0])),
    )  # fmt: skip
    if driven:
        m.drive_angle("motor", crank, constant_rate(speed, ahead))
    else:
        m.start_moving(crank=speed)
    turn = 2 * math.pi / abs(speed)
    return Subject(m, turn * (1.0 if driven else 1.5), driven, None if driven else turn, _judge)


def _cycle(rng: np.random.Generator) -> GasCycle:
    if rng.random() < 0.3:
        angles = np.radians(np.arange(-180.0, 180.0, 15.0))
        return pressure_table(angles, 1e5 * (1.0 + 20.0 * np.exp(-((angles - 0.2) ** 2) / 0.3)), 1, compression=9.0)
    return two_stroke(
        float(rng.uniform(6.0, 12.0)), heat_density=float(rng.choice([0.0, rng.uniform(2e5, 1e6)])),
        start=float(rng.uniform(-0.4, 0.2)), duration=float(rng.uniform(0.6, 1.2)), n=float(rng.uniform(1.5, 4.0)),
        ports_open=float(rng.uniform(1.7, 2.2)), passage=float(rng.choice([0.0, 0.3])),
    )  # fmt: skip


def _judge(sol: Solution) -> list[str]:
    """Volumes by the angle of the crank, as numbers of the slider-crank have them."""
    out = []
    for placed in chambers(sol.packed):
        view, cycle = sol.force(placed.name), placed.chamber.cycle
        assert isinstance(view, GasView)
        assert view.crank_angle is not None
        if cycle is None or cycle.height is None:
            continue
        gap = np.abs(view.volume / placed.chamber.area - cycle.height(view.crank_angle))
        if not gap.max() < SLACK * cycle.displaced / placed.chamber.area:
            out.append(f"volume: '{placed.name}' is off by {gap.max():.3g} m at t = {sol.t[int(gap.argmax())]:.6g} s")
    return out
