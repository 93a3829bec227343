"""Squat and deadlift: lifts on both feet, the bar over the middle of the foot all the way.

Shank and thigh follow one repetition between two leans. In the squat the trunk follows from the bar, which goes up and
down a vertical line over the foot; in the deadlift the trunk rises as well, from where straight arms hold the bar near
the floor, and the arms follow. The feet stand still and all moments follow from the equations of motion; where the
floor pushes is a result. The origin is on the floor under the ankle, x points forward, y up. Leans are angles from the
vertical (DEGREES): a shank or trunk of 20 leans forward by 20, a thigh of 90 is level.
"""

from __future__ import annotations

import cmath
import math

from mbsd.base.arguments import finite_number, number_pair
from mbsd.base.errors import ModelError
from mbsd.machines.body.chain import (
    PLATE,
    Lifter,
    Tempo,
    add_barbell,
    add_body,
    add_lifter,
    ends_given,
    not_below,
    repetition,
)
from mbsd.machines.body.figure import Figure, combined
from mbsd.mechanism import Mechanism
from mbsd.model.body import Body
from mbsd.model.laws.formulas import polynomial

SLOWER = Tempo(up=1.5)
"""Default tempo: the bar goes twice as far as in a hip thrust."""
ELBOWS_DOWN = 1
"""Side of the elbows of arms that hold a bar on the back; see :meth:`mbsd.machines.body.figure.Figure.arms`."""


def squat(
    figure: Figure | None = None,
    load: float = 65.0,
    *,
    shank: tuple[float, float] = (30.0, 6.0),
    thigh: tuple[float, float] = (90.0, 0.0),
    bar: tuple[float, float] | None = None,
    line: float | None = None,
    tempo: Tempo | None = None,
    name: str = "squat",
) -> Mechanism:
    """Return a figure that squats with a barbell of ``load`` (kg).

    Solve it with mbsd.machines.body.lift.lifted. ``shank``, ``thigh``: leans at the bottom and at the top (DEGREES).
    ``bar``: of the barbell's middle, along the trunk from the hip and behind its axis (m), by default on the shoulders.
    ``line``: of the bar in front of the ankle (m), by default over the middle of the foot. Raises ModelError, with the
    remedy, where the trunk does not reach it.
    """
    figure = Figure() if figure is None else figure
    tempo = SLOWER if tempo is None else tempo
    shanks, thighs = ends_given(name, "shank", shank, -30.0, 60.0), ends_given(name, "thigh", thigh, 0.0, 130.0)
    trunk = figure.length("trunk")
    along, behind = bar_on_shoulders(figure) if bar is None else number_pair(f"{name}: bar (m)", bar)
    line = figure.mid_foot if line is None else finite_number(f"{name}: line", line)
    m = Mechanism(name)
    lifter = add_lifter(m, figure, figure.arms((trunk, 0.0), (along, behind), ELBOWS_DOWN))
    barbell = add_barbell(m, load, lifter.trunk, along, behind)
    _stand(m, lifter, shanks, thighs, tempo)
    m.drive_coordinate("bar_line", m.ground.origin, barbell.origin, polynomial(line))
    leans = []
    for place in (0, 1):
        hip = hip_at(figure, shanks[place], thighs[place])
        leans.append(_lean(complex(along, behind), line - hip.real, name))
    m.start_near(trunk=90.0 - math.degrees(leans[0]))
    return m


def deadlift(
    figure: Figure | None = None,
    load: float = 65.0,
    *,
    shank: tuple[float, float] = (5.0, 0.0),
    thigh: tuple[float, float] = (62.0, 3.0),
    floor: float = PLATE,
    line: float | None = None,
    tempo: Tempo | None = None,
    name: str = "deadlift",
) -> Mechanism:
    """Return a figure that lifts a barbell of ``load`` (kg); solve it with mbsd.machines.body.lift.lifted.

    ``shank``, ``thigh``: leans at the bottom and at the top (DEGREES). ``floor``: height of the bar at the bottom, the
    radius of its plates (m); at the top the trunk is upright. ``line``: of the bar in front of the ankle (m), by
    default over the middle of the foot. Raises ModelError, with the remedy, where trunk and arms do not reach the bar.
    """
    figure = Figure() if figure is None else figure
    tempo = SLOWER if tempo is None else tempo
    shanks, thighs = ends_given(name, "shank", shank, -30.0, 60.0), ends_given(name, "thigh", thigh, 0.0, 130.0)
    line = figure.mid_foot if line is None else finite_number(f"{name}: line", line)
    low = not_below(name, "floor", floor, 0.0, "m")
    trunk, arm = figure.length("trunk"), figure.arm
    if abs(ahead := line - hip_at(figure, shanks[1], thighs[1]).real) >= arm:
        raise ModelError(
            f"{name}: at the top the bar is {ahead:.3g} m in front of the shoulder, but arms are {arm:.3g} m "
            "long; give line="
        )
    way = complex(line, low) - hip_at(figure, shanks[0], thighs[0])
    if not abs(trunk - arm) < abs(way) < trunk + arm:
        raise ModelError(
            f"{name}: at the bottom the bar is {abs(way):.3g} m from the hip, but trunk and arms reach from "
            f"{abs(trunk - arm):.3g} to {trunk + arm:.3g} m; lean shank or thigh otherwise"
        )
    # The shoulder is on the left of the way from the hip to the bar: above it, the lifter facing right.
    inner = math.acos((trunk**2 + abs(way) ** 2 - arm**2) / (2 * trunk * abs(way)))
    upright = cmath.phase(way) + inner
    m = Mechanism(name)
    lifter = add_lifter(m, figure, None)
    arms = _hanging_arms(m, lifter)
    barbell = add_barbell(m, load, arms, arm, 0.0)
    _stand(m, lifter, shanks, thighs, tempo)
    m.drive_coordinate("bar_line", m.ground.origin, barbell.origin, polynomial(line))
    m.drive_angle("trunk_lean", lifter.trunk, repetition(upright, math.pi / 2, tempo))
    hanging = cmath.phase(way - trunk * cmath.exp(1j * upright))
    m.start_near(trunk=math.degrees(upright), arms=math.degrees(hanging))
    return m


def bar_on_shoulders(figure: Figure) -> tuple[float, float]:
    """Place of a bar on the back: along the trunk from the hip, and behind its axis (m)."""
    return 0.98 * figure.length("trunk"), 0.055 * figure.height


def hip_at(figure: Figure, shank: float, thigh: float) -> complex:
    """Return the hip's place (m) at leans of shank and thigh (rad), as x + i y."""
    knee = 1j * figure.length("ankle") + figure.length("shank") * 1j * cmath.exp(-1j * shank)
    return knee + figure.length("thigh") * 1j * cmath.exp(1j * thigh)


def _stand(
    m: Mechanism, lifter: Lifter, shanks: tuple[float, float], thighs: tuple[float, float], tempo: Tempo
) -> None:
    """Add feet on the floor, and guides of shank and thigh."""
    m.weld("floor", m.ground.at(0.0, lifter.figure.length("ankle")), lifter.foot.origin)
    quarter = math.pi / 2
    m.drive_angle("shank_lean", lifter.shank, repetition(-quarter - shanks[0], -quarter - shanks[1], tempo))
    m.drive_angle("repetition", lifter.thigh, repetition(-quarter + thighs[0], -quarter + thighs[1], tempo))
    m.start_near(foot=0.0, shank=-90.0 - math.degrees(shanks[0]), thigh=-90.0 + math.degrees(thighs[0]))


def _hanging_arms(m: Mechanism, lifter: Lifter) -> Body:
    figure = lifter.figure
    forearms = figure.limb("forearm").placed(figure.length("upper_arm"), 0.0)
    arms = add_body(m, "arms", combined((figure.limb("upper_arm"), forearms)), figure.arm)
    m.revolute("shoulder", lifter.trunk.end, arms.start)
    m.torque("shoulder_extensors", arms, 0.0, against=lifter.trunk)
    return arms


def _lean(bar: complex, ahead: float, name: str) -> float:
    """Return the trunk's lean (rad) that brings the bar ``ahead`` (m) of the hip.

    The bar is at ``bar`` of the trunk's frame.
    """
    if abs(ahead) >= abs(bar):
        raise ModelError(
            f"{name}: the bar's line is {ahead:.3g} m in front of the hip, but the bar is {abs(bar):.3g} m from it; "
            "lean the shank more or the thigh less, or give line="
        )
    # The bar is to the front of the trunk's direction by -phase(bar).
    return math.asin(ahead / abs(bar)) + cmath.phase(bar)
