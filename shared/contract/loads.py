"""Loads of a motion in data.json: forces, rigid contacts, and how they look."""

from __future__ import annotations

from typing import Literal

from shared.contract.base import NonNegative, Positive, Series, Strict

State = Literal["open", "closed", "slides", "sticks"]
ValueUnit = Literal["m", "rad"]
EffortUnit = Literal["N", "N m"]
Pair = Literal["pin", "guide", "slot"]
"""How two bodies move on each other: they turn about a point, slide along the first marker's x axis without turning,
or slide there and turn."""
Look = Literal["", "band", "roller", "captive", "coil", "cylinder", "spiral", "cord"]
"""Drawing in pictures of solids beside the parts of the bodies: a belt or chain round both
wheels, a roller pressed on one side, a roller between two walls, a coil spring, a cylinder with its rod, a flat spiral
over a pin, a rope."""


class Shape(Strict, kw_only=True):
    """Data for a picture of a joint, force or contact beyond poses: markers, wheels, curves.

    Fields that do not concern the kind keep their defaults.
    """

    bodies: tuple[str, str]
    """Bodies that carry the first and the second marker."""
    markers: tuple[tuple[float, float, float], tuple[float, float, float]]
    """x, y (m) and angle (rad) of both in the frames of these bodies."""
    radius_first: Positive | None = None
    """Radius of the wheel about the first marker (m): pitch radius of a gear or pulley; of a ring the inner one."""
    radius_second: Positive | None = None
    """The same about the second marker: also of pinions, rolling discs, rollers of cams, tyres, discs that touch."""
    teeth: list[int] = []
    """Teeth of the first and second wheel, or of the pinion alone."""
    ring: bool = False
    """True if the first wheel lies around the second."""
    crossed: bool = False
    """True if the belt is crossed."""
    clockwise: list[bool] = []
    """Turn of a cable about the first and the second marker, followed from one to the other; of its spans alone."""
    slots: int | None = None
    """Slots of a Geneva wheel about the second marker; the pin is ``pin_radius`` from the first along its x axis."""
    pin_radius: Positive | None = None
    length: NonNegative | None = None
    """Length of a rope or rod; of a spring where it is free, unless that is a law of time (m)."""
    outline: list[tuple[float, float]] = []
    """Curve, terrain or cam in the axes of the first marker (m)."""
    outline_closed: bool = False


class Acts(Strict, kw_only=True):
    """Place and torque of a joint or contact that does not act at its second marker."""

    x: Series
    """m"""
    y: Series
    torque: Series
    """Torque on the second body about (x, y) (N m)."""


class Action(Strict, kw_only=True):
    """Force on one body over time: N in the world's axes, N m about the point (x, y) (m)."""

    body: str
    x: Series
    y: Series
    fx: Series
    fy: Series
    torque: Series


class GasMotion(Strict, kw_only=True):
    """Gas behind a force on a piston, over time, with the results of each cycle of its crank."""

    pressure: Series
    """Absolute (Pa)."""
    volume: Series
    """m^3"""
    outside: NonNegative
    """Pressure on the piston's other side (Pa)."""
    crank: str | None = None
    """The body by whose angle the pressure repeats; null of gas without a cycle."""
    crank_angle: Series | None = None
    """Turn, in its own direction, since a top dead centre at which the cylinder fires (rad)."""
    cycle_angle: Positive | None = None
    """After which the pressure repeats (rad)."""
    displaced: Positive | None = None
    """Volume between the dead centres (m^3)."""
    indicated_work: list[float] | None = None
    """Work of each whole cycle (J)."""


class HydraulicMotion(Strict, kw_only=True):
    """Hydraulic cylinder over time; chamber A is that of the whole piston."""

    pressure_a: Series
    """Absolute (Pa)."""
    pressure_b: Series
    flow_a: Series
    """Flow from the valve into the chamber (m^3/s)."""
    flow_b: Series
    valve: Series
    """Its opening, -1 .. 1; above 0 the supply leads into chamber A."""
    supply_flow: Series
    """Taken from the supply (m^3/s)."""
    supply_power: Series
    """Power of supply and tank to the oil (W): lost in valve and leak, in the oil, or for the piston."""
    valve_loss: Series
    """W"""
    leak_loss: Series
    oil_power: Series
    """Power that compresses the oil (W)."""
    piston_power: Series


class ForceMotion(Strict, kw_only=True):
    """One force over time: spring, damper, motor, load, contact by penalty, friction, user's function."""

    kind: str
    actions: list[Action]
    """On every body that feels it; of a pair the first body's and then the second's."""
    several: bool
    """True if it acts on several bodies, none of which is the second (rotating frame, function of the user)."""
    measures: Literal["length", "angle", "coordinate", "gap"] | None
    """Meaning of ``value``: length (m), angle of second against first (rad), coordinate along the first marker's x axis
    (m), gap (m, negative where pressed in); null: there is no one such value."""
    value: Series | None
    rate: Series | None
    """Rate of the value; of a load in one direction the speed of its point that way; of friction that of its joint."""
    effort: Series | None
    """Its size with a sign (N or N m): positive where it makes the value grow, or acts in its direction."""
    normal: Series | None
    """Normal force on the joint of friction, without preload (N)."""
    power: Series
    """Power that it gives to the motion (W); negative if it takes power."""
    potential: Series
    """Potential energy it holds (J); 0 of a force without."""
    unit: ValueUnit | None = None
    """Unit of its value."""
    effort_unit: EffortUnit = "N"
    """Unit of its effort."""
    drives: bool = False
    """True if it may move the mechanism in place of drivers: a given torque or push, a motor."""
    look: Look = ""
    shape: Shape | None
    """Null of a force between no two markers."""
    gas: GasMotion | None = None
    """Null of what is no gas behind a piston."""
    gas_behind: GasMotion | None = None
    """Gas on the other side of a double-acting piston, where its rod is."""
    hydraulics: HydraulicMotion | None = None
    """Null of what is no hydraulic cylinder."""


class ContactMotion(Strict, kw_only=True):
    """One rigid contact, stop, rope or one-way clutch of a simulation over time."""

    kind: str
    bodies: tuple[str, str]
    x: Series
    """Position of its second marker (m)."""
    y: Series
    fx: Series
    """Force on its second body, world axes (N)."""
    fy: Series
    torque: Series
    """Torque on its second body about (x, y) (N m)."""
    gap: Series
    """m, or rad of angles; 0 where it is closed."""
    rate: Series
    normal: Series
    """Effort that pushes the gap open (N, or N m of angles)."""
    friction: Series
    """Force along the sliding way (N)."""
    state: list[State]
    """A contact with friction slides or sticks instead of being closed."""
    unit: ValueUnit = "m"
    """Unit of its gap."""
    effort_unit: EffortUnit = "N"
    """Unit of what pushes the gap open."""
    look: Look = ""
    acts: Acts | None = None
    """Null where it acts at (x, y)."""
    shape: Shape
