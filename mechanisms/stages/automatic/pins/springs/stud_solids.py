"""The solids of ball studs and their posts (rmm)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mechanisms.stages.automatic.layout.features import build
from mechanisms.stages.automatic.layout.plan import Foot
from mechanisms.stages.automatic.pins.pin_solids import upper_end
from mechanisms.stages.automatic.pins.springs.stretching import BALL, COLLAR_HEIGHT, EYE, FOOT, POST, SHANK, Stud
from shared.shapes.base import column
from shared.shapes.link import Eye
from shared.shapes.solid import Hold, Solid, placed
from shared.shapes.stud import Collar, ball_stud

if TYPE_CHECKING:
    import cadquery as cq

    from mechanisms.stages.automatic.layout.order.heights import Heights
    from mechanisms.stages.automatic.layout.plan import Plan
    from mechanisms.stages.automatic.pins.pins import Pin

COLLAR = 4.6
"""Radius of the collars on its shank."""


@build.register(Stud)
def stud_solids(stud: Stud, plan: Plan, heights: Heights) -> None:
    """A stud with a ball at the height of each end."""
    if stud.pin is not None:
        stud_on_pin(stud, stud.pin, plan, heights)
    elif stud.body == "ground":
        stud_on_post(stud, plan, heights)
    else:
        stud_in_plate(stud, plan, heights)


def stud_in_plate(stud: Stud, plan: Plan, heights: Heights) -> None:
    """Pressed through the plate, with a collar on each side that a ball is on."""
    fit, lines = plan.layout.sizes.pivot.fit, _lines(stud, heights)
    low, high = heights.bottom(stud.body), heights.top(stud.body)
    plan.eye(stud.body, stud.x, stud.y, Eye(EYE, SHANK + fit.press))
    collars = []
    if lines[-1] > high:
        collars.append(Collar(high + fit.seat, COLLAR_HEIGHT, COLLAR))
    if lines[0] < low:
        collars.append(Collar(low - fit.seat - COLLAR_HEIGHT, COLLAR_HEIGHT, COLLAR))
    start, end = (low + 0.3 if lines[0] > low else lines[0]), (high - 0.3 if lines[-1] < high else lines[-1])
    _add(stud, stud.body, ball_stud(SHANK, start, end, lines, BALL, collars), plan, heights)


def stud_on_post(stud: Stud, plan: Plan, heights: Heights) -> None:
    """On a post on the base."""
    fit, lines = plan.layout.sizes.pivot.fit, _lines(stud, heights)
    top = max(lines[0] - BALL - 1.5, 2.0)
    slim, above = POST - 0.5, top - heights.bottoms[0]
    foot = min(FOOT, slim + 0.5 * top / above) if above > 0 else FOOT  # within POST from the lowest layer up
    post = column(top - fit.seat, SHANK + fit.press, 2 * slim, 2 * foot)
    plan.make("ground", f"post_{stud.name}", placed(post, stud.x, stud.y, fit.seat), "aluminium", 1)
    plan.feet.append(Foot("", stud.x, stud.y, FOOT))
    _add(stud, "ground", ball_stud(SHANK, 0.5, lines[-1], lines, BALL, []), plan, heights)


def stud_on_pin(stud: Stud, pin: Pin, plan: Plan, heights: Heights) -> None:
    """On the upper end of a joint's pin."""
    holder, z = upper_end(pin, plan, heights)
    lines = _lines(stud, heights)
    start = z + plan.layout.sizes.pivot.fit.seat
    shape = ball_stud(SHANK, start, lines[-1], lines, BALL, [Collar(start, COLLAR_HEIGHT, COLLAR)])
    _add(stud, holder, shape, plan, heights, pin.places[holder])


def _lines(stud: Stud, heights: Heights) -> list[float]:
    """Heights of its balls, from below."""
    return sorted({spring.z(heights) for spring, _ in stud.ends})


def _add(
    stud: Stud,
    body: str,
    shape: cq.Workplane,
    plan: Plan,
    heights: Heights,
    at: tuple[float, float] | None = None,
) -> None:
    x, y = at or (stud.x, stud.y)
    holds = tuple(Hold(spring.force, spring.z(heights), spring.radius) for spring, _ in stud.ends)
    plan.add(body, Solid(f"stud_{stud.name}", placed(shape, x, y), "steel", 0, holds))
