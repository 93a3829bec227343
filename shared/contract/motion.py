"""data.json: the motion of one mechanism, as structs. The package reads and writes them.

A body's x, y, theta place the frame its author drew it in, not its centre of mass.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from typing import Annotated, Literal

import msgspec

from shared.contract.base import UNITS, NonNegative, Positive, Provenance, Series, Strict
from shared.contract.loads import Action, Acts, ContactMotion, EffortUnit, ForceMotion, Look, Pair, Shape, ValueUnit

# Vibration of the frame in data.json: inertia forces, centre of mass, harmonics of the crank.


class Harmonics(Strict, kw_only=True):
    """Harmonics of a quantity that repeats with the crank, one for each order of :class:`Vibration`.

    Along an axis it is mean + sum of amplitude cos(order phi + phase), phi the crank's angle.
    """

    unit: str
    mean: list[float]
    """Along each axis: one of a number, two (x, y) of a vector."""
    amplitude: list[Series]
    phase: list[Series]
    """rad."""
    forward: Series
    """Size of the part that turns with the crank, order times as fast; half of the amplitude of a number."""
    backward: Series
    """Size of the part that turns against it."""


class Vibration(Strict, kw_only=True):
    """Vibration of a motion that repeats with a crank."""

    about: tuple[float, float]
    """Place of ground about which the moment is (m): the axis of the crank."""
    fx: Series
    """Force of the inertia of all bodies on the frame (N)."""
    fy: Series
    moment: Series
    """N m."""
    x: Series
    """Centre of mass of all bodies (m)."""
    y: Series
    crank: str
    turns: int
    """Turns of the crank in a cycle."""
    order: Series
    harmonics: dict[str, Harmonics]
    """Spectra by quantity: shaking force, moment and couple, efforts of drivers, reactions of joints with ground."""


_FIRST = {
    "axes": "x right, y up, angles counter-clockwise and never wrapped",
    "body_frame": "x, y, theta and their rates place the frame the author drew the body in",
    "com": "centre of mass in the body frame; inertia is about it",
    "reaction": "fx, fy, torque: what the joint does to its second body, at the second marker, world axes",
    "effort": "generalised force of the driver along its value; power = effort * rate of value",
    "z": "height of the body's layer above the base; the motion is planar",
}
_SECOND = _FIRST | {
    "force": "fx, fy, torque of an action: what the force does to that body, at (x, y), world axes",
    "contact": "normal pushes the gap open; fx, fy, torque act on its second body, at the second marker",
    "events": "rows right before and right after an event share its time: poses agree there, rates may differ",
}
_THIRD = _SECOND | {
    "acts": "where a joint or contact acts with fx, fy and the torque of acts; null: at (x, y) with its own torque"
}
CONVENTIONS_OF = {1: _FIRST, 2: _SECOND, 3: _THIRD}
"""Conventions by version of the file."""


Colour = Annotated[str, msgspec.Meta(pattern="^#[0-9a-f]{6}$")]
"""sRGB."""


class BodyMotion(Strict, kw_only=True):
    """One body over time: its frame (m, rad), rates and accelerations; constants of the body."""

    x: Series
    y: Series
    theta: Series
    vx: Series
    vy: Series
    omega: Series
    ax: Series
    ay: Series
    alpha: Series
    z: float | None
    """Height of its layer (m); null where there are no parts yet, and of bodies without solids."""
    mass: NonNegative
    mass_from: Literal["mechanism", "parts", "estimate"] = "parts"
    """Source of mass, com and inertia."""
    com: tuple[float, float]
    inertia: NonNegative
    colour: Colour = "#66717b"
    """Its ink on light paper in plots, skeleton, animation, page and legends: that of the material of its main piece,
    or of its role where there are no parts. Bodies alike have shades that differ."""
    colour_on_dark: Colour = "#b5bec7"
    """The same on dark paper."""


class JointMotion(Strict, kw_only=True):
    """One joint over time: the place of its second marker, and the reaction on the second body."""

    kind: str
    bodies: tuple[str, str]
    x: Series
    y: Series
    fx: Series
    fy: Series
    torque: Series
    pair: Pair | None = None
    """Null of other joints."""
    look: Look = ""
    acts: Acts | None = None
    """Null where it acts at (x, y)."""
    shape: Shape | None = None
    released: float | None = None
    """Time (s) of the event that released it; null if it holds to the end."""

    def rows_held(self, time: Sequence[float]) -> int:
        """Return how many rows at these times it holds: of two at its release the first."""
        if self.released is None:
            return len(time)
        at = bisect_right(time, self.released)
        return at - 1 if at > 1 and time[at - 2] == time[at - 1] == self.released else at


class DriverMotion(Strict, kw_only=True):
    """One driver over time: its value (m or rad), effort (N or N m) and power (W)."""

    kind: str
    bodies: tuple[str, str] | None = None
    """First and second; null in files of version 1."""
    shape: Shape | None = None
    """Its two markers."""
    unit: ValueUnit = "rad"
    """Unit of its value."""
    effort_unit: EffortUnit = "N m"
    look: Look = ""
    actions: list[Action] = []
    """Actions on its first and on its second body, each where it acts; none in files of versions 1 and 2."""
    value: Series
    effort: Series
    power: Series


class PointMotion(Strict, kw_only=True):
    """One traced point over time."""

    body: str
    x: Series
    y: Series
    vx: Series
    vy: Series
    ax: Series
    ay: Series


class Energy(Strict, kw_only=True):
    """Energy of the whole mechanism (J)."""

    kinetic: Series
    potential: Series
    """Potential energy of weight, counted from the origin, and of all forces that hold some."""
    work: Series | None = None
    """Work of forces and drivers since the start, weight left out; null of a sweep."""
    audit: Series | None = None
    """Kinetic and potential energy less the work of what holds none: in a simulation constant but for the
    integrator's error and what impacts take; null of a sweep."""


class Couple(Strict, kw_only=True):
    """Moment of inertia forces on the frame, from bodies at different heights along the normal (N m)."""

    about: float
    """Place along that normal (m), halfway between the outermost bodies."""
    reach: NonNegative
    """Distance between these (m)."""
    mx: Series
    """Couple about the x axis."""
    my: Series
    """Couple about the y axis."""


class EventMark(Strict, kw_only=True):
    """Event at one moment: an impact, a contact that opens, an event of the user, a force's jump."""

    time: float
    name: str
    what: str
    """event, end, impact, closes, opens, sticks, slides; jumps, of a force or driver whose law does."""
    energy: float
    """Kinetic energy after less before (J), of all that happens at this time; given with the first event."""
    impulse: float = 0.0
    """Normal impulse of an impact (N s; N m s of stops of angles)."""


class Diagnostics(Strict, kw_only=True):
    """Measures of numerical accuracy."""

    position_residual: NonNegative
    """Largest constraint residual (m or rad) over the motion."""
    velocity_residual: NonNegative
    acceleration_residual: NonNegative
    power_residual: NonNegative
    """Largest |d(T+V)/dt - power of the drivers| (W)."""
    dof: int
    redundant: list[str]
    """Joints whose rows repeat what others already hold: one removable set."""
    singularity_margin: Series
    """Smallest over largest singular value of the scaled Jacobian, 0 at a singular pose; per time."""


class Motion(Strict, kw_only=True):
    """Motion of one mechanism: data.json.

    Version 2 did not say where things act, in which units and how they look; version 1 had no forces and contacts, and
    less of the rest.
    """

    schema: Literal["mbsd.motion"] = "mbsd.motion"
    schema_version: Literal[1, 2, 3] = 3
    mechanism: str
    units: dict[str, str] = msgspec.field(default_factory=lambda: dict(UNITS))
    conventions: dict[str, str] = msgspec.field(default_factory=lambda: dict(CONVENTIONS_OF[3]))
    provenance: Provenance
    gravity: tuple[float, float]
    analysis: Literal["sweep", "simulation"] = "sweep"
    """Kind of the motion: moved by drivers or by forces."""
    period: Positive | None
    """Every pose repeats after this time (s), and ``time`` spans it exactly, both ends included; else null."""
    time: Series
    """Rises; rows right before and right after an event share its time: poses agree there, rates may differ."""
    bodies: dict[str, BodyMotion]
    joints: dict[str, JointMotion]
    drivers: dict[str, DriverMotion]
    points: dict[str, PointMotion]
    forces: dict[str, ForceMotion] = {}
    contacts: dict[str, ContactMotion] = {}
    energy: Energy
    couple: Couple | None = None
    """Null where the model gives no body a place along the normal of the plane."""
    vibration: Vibration | None = None
    """Null where nothing has mass, or nothing turns round on ground by whose angle the motion repeats."""
    events: list[EventMark] = []
    """In the order of their times."""
    start_changes: list[str] = []
    """Changes of the given start that made it consistent, a sentence each."""
    notes: list[str] = []
    """Times left out because efforts do not exist there, a sentence each."""
    diagnostics: Diagnostics


# Fields that data.json of versions 1 and 2 lacks: they follow from the kinds of that time.


PAIRS: dict[str, Pair] = {"revolute": "pin", "prismatic": "guide", "pin_in_slot": "slot"}
DRIVING = ("torque", "force", "actuator")


def completed(motion: Motion) -> Motion:
    """Return the motion with pairs and units.

    Nothing is known of looks, or of loads that act beside a marker.
    """
    if motion.schema_version >= 3:
        return motion
    replace = msgspec.structs.replace
    return replace(
        motion,
        joints={name: replace(joint, pair=PAIRS.get(joint.kind)) for name, joint in motion.joints.items()},
        drivers={
            name: replace(driver, **dict(zip(("unit", "effort_unit"), _units("angle" in driver.kind), strict=True)))
            for name, driver in motion.drivers.items()
        },
        forces={
            name: replace(
                force,
                unit=None if force.measures is None else _units(force.measures == "angle")[0],
                effort_unit=_units(force.measures == "angle")[1],
                drives=force.kind in DRIVING,
            )
            for name, force in motion.forces.items()
        },
    )


def _units(of_angle: bool) -> tuple[ValueUnit, EffortUnit]:
    return ("rad", "N m") if of_angle else ("m", "N")
