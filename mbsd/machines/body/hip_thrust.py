"""The barbell hip thrust: the back on a bench, the feet on the floor, a barbell on the hips.

The hip's angle drives one repetition. Two more guides fix what a lifter holds still: the foot is flat on the floor, and
the back does not slip on the edge of the pad. So the motion is that of a four-bar of ground, shank, thigh and trunk.

Its forces are not those of a four-bar of pins, in which the hip alone would move everything and the knee would give
nothing. Two conditions say where the supports push, and then the moments of hip, knee and ankle follow from the
equations of motion, one each:

    the floor pushes at a given place under the foot (the centre of pressure)
    the pad pushes across the back, its friction a given part of that: F = N (n + grip s), s towards the head

The floor's own friction is a result. x points from the bench to the feet, y up; the origin is on the floor under the
ankle.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

from mbsd.base.arguments import finite_number, number_pair
from mbsd.base.errors import ModelError
from mbsd.machines.body.chain import Tempo, add_barbell, add_lifter, ends_given, not_below, repetition
from mbsd.machines.body.figure import Figure
from mbsd.mechanism import Mechanism
from mbsd.model.laws.formulas import polynomial

CONTACT = 0.74
"""Assumed: the lower tips of the shoulder blades from the hip, of the way from hip to shoulder."""
CHEST = 0.06
"""Assumed: half the depth of the chest, of the height."""
MOST_FLEXION = 120.0
ELBOWS_BACK = -1
"""Side of the elbows of arms that hold the bar; see :meth:`mbsd.machines.body.figure.Figure.arms`."""


@dataclass(frozen=True)
class Posture:
    """Angles of the bodies (rad)."""

    shank: float
    thigh: float
    trunk: float


@dataclass(frozen=True)
class Bench:
    """Where the back is on the bench: places of the edge of the pad (m)."""

    edge: complex
    """x + i y."""
    contact: complex
    """In the trunk's frame: along it from the hip, and behind it."""

    def posture(self, figure: Figure, flexion: float) -> Posture:
        """Return the bodies at a flexion of the hip (rad), the knee up.

        Raises ModelError where they do not reach.
        """
        shank, ankle = figure.length("shank"), 1j * figure.length("ankle")
        knee = self.to_knee(figure, flexion)
        way = ankle - self.edge
        distance = abs(way)
        if not abs(abs(knee) - shank) < distance < abs(knee) + shank:
            raise ModelError(
                f"hip thrust: at a flexion of {math.degrees(flexion):.4g} degrees the ankle is {distance:.3g} m from "
                f"the edge of the pad. Trunk, thigh and shank reach from {abs(abs(knee) - shank):.3g} to "
                f"{abs(knee) + shank:.3g} m; change distance, bench or flexion"
            )
        cosine = (distance**2 + abs(knee) ** 2 - shank**2) / (2 * distance * abs(knee))
        thigh = cmath.phase(way) + math.acos(cosine) - cmath.phase(knee)
        return Posture(cmath.phase(way - knee * cmath.exp(1j * thigh)), thigh, thigh + math.pi - flexion)

    def to_knee(self, figure: Figure, flexion: float) -> complex:
        """Return the way from the edge to the knee, in the frame of the thigh."""
        return figure.length("thigh") + self.contact * cmath.exp(-1j * flexion)


def hip_thrust(
    figure: Figure | None = None,
    load: float = 65.0,
    *,
    flexion: tuple[float, float] = (90.0, 0.0),
    bench: float = 0.40,
    distance: float | None = None,
    contact: tuple[float, float] | None = None,
    bar: tuple[float, float] = (0.10, 0.14),
    pressure: float = 0.03,
    grip: float = 0.15,
    tempo: Tempo | None = None,
    name: str = "hip_thrust",
) -> Mechanism:
    """Return a figure that thrusts a barbell of ``load`` (kg) up.

    :func:`mbsd.machines.body.lift.lifted` solves it. ``flexion``: of the hip at the bottom and at the top (DEGREES).
    ``bench``: height of the pad's edge (m); ``distance``: from it to the ankle along the floor (m), by default such
    that the shank is upright at the top. ``contact``: of the back with the edge, along the trunk from the hip and
    behind its axis (m). ``bar``: of the barbell's middle, along the trunk from the hip and in front of its axis (m).
    ``pressure``: where the floor pushes, in front of the ankle (m). ``grip``: friction of the pad, of its normal force,
    positive towards the head; the default gives the knee about what was measured (docs/hip_thrust.md). Raises
    ModelError, with the remedy, for what the figure cannot reach and for a floor that pushes beside the foot.
    """
    figure = Figure() if figure is None else figure
    tempo = Tempo() if tempo is None else tempo
    bottom, top = ends_given(name, "flexion", flexion, -30.0, MOST_FLEXION)
    pressure = finite_number(f"{name}: pressure", pressure)
    if not figure.heel <= pressure <= figure.toe:
        raise ModelError(
            f"{name}: the floor pushes {pressure:g} m in front of the ankle, but the foot reaches from "
            f"{figure.heel:.3g} to {figure.toe:.3g} m; give a place under it"
        )
    on_bench = placed_on_bench(figure, bench, distance, contact, top, name)
    start = on_bench.posture(figure, bottom)
    on_bench.posture(figure, top)
    m = Mechanism(name)
    along, before = number_pair(f"{name}: bar (m)", bar)
    hand = (along, -before)
    lifter = add_lifter(m, figure, figure.arms((figure.length("trunk"), 0.0), hand, ELBOWS_BACK))
    add_barbell(m, load, lifter.trunk, *hand)
    m.revolute("floor", m.ground.at(pressure, 0.0), lifter.foot.at(pressure, -figure.length("ankle")))
    slope = math.atan(finite_number(f"{name}: grip", grip))
    back = lifter.trunk.at(on_bench.contact.real, on_bench.contact.imag, slope)
    edge = m.ground.at(on_bench.edge.real, on_bench.edge.imag)
    m.pin_in_slot("pad", back, edge)
    m.drive_relative_angle("repetition", lifter.thigh, lifter.trunk, repetition(math.pi - bottom, math.pi - top, tempo))
    m.drive_angle("flat_foot", lifter.foot, polynomial(0.0))
    m.drive_coordinate("no_slip", back, edge, polynomial(0.0))
    degrees = {body: math.degrees(angle) for body, angle in vars(start).items()}
    m.start_near(foot=0.0, **degrees)
    return m


def placed_on_bench(
    figure: Figure,
    bench: float,
    distance: float | None,
    contact: tuple[float, float] | None,
    top: float,
    name: str = "hip_thrust",
) -> Bench:
    """Return the edge of the pad, and the place of the back on it.

    See :func:`hip_thrust`. Raises ModelError.
    """
    height = not_below(name, "bench", bench, 0.0, "m")
    along, behind = (
        (CONTACT * figure.length("trunk"), CHEST * figure.height)
        if contact is None
        else number_pair(f"{name}: contact (m)", contact)
    )
    place = complex(along, behind)
    if distance is not None:
        return Bench(complex(-finite_number(f"{name}: distance", distance), height), place)
    knee = abs(Bench(0j, place).to_knee(figure, top))
    rise = figure.length("ankle") + figure.length("shank") - height
    if abs(rise) >= knee:
        raise ModelError(
            f"{name}: with an upright shank the knee is {rise:.3g} m over the edge of the pad, but only {knee:.3g} m "
            "from it; give distance= (m), or a lower bench"
        )
    return Bench(complex(-math.sqrt(knee**2 - rise**2), height), place)
