"""Overhead camshafts: one on each bank, belt-driven at half speed, two valves over each cylinder.

The valves of a cylinder are in line. The cams open flat tappets by a lift without jumps of acceleration (modified
trapezoid up and down again). Of a crank angle phi counted from the top dead centre that fires, and a ramp beyond the
angles of the cycle of the gas,

    intake   opens at 2 pi - ramp,              closes at 4 pi + intake_closes + ramp
    exhaust  opens at exhaust_opens - ramp,     closes at 2 pi + ramp

A flat tappet asks for a base circle with base + s + s'' > 0 (s'' by the cam's angle), see :mod:`mbsd.cams`.
Source: Norton, Cam Design and Manufacturing Handbook, ch. 7; Heywood, ch. 6 (valve timing).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from mbsd.base.arguments import finite_number, not_negative_number, positive_number
from mbsd.base.errors import ModelError
from mbsd.machines.engines.layout import Layout
from mbsd.mechanism import Mechanism
from mbsd.model.body import Body
from mbsd.model.cams.followers import flat_cam
from mbsd.model.cams.lift import Lift
from mbsd.model.cylinders.cycle import GasCycle
from mbsd.model.cylinders.engine_cycles import FourStroke

UPRIGHT = 0.5 * math.pi
LIFT, APART, ABOVE = 0.08, 0.47, 1.55
"""Lift of a valve, distance of the two valves of a cylinder, and height of the camshaft over the wrist pin at the top
dead centre, in bores.
"""
PULLEY = 0.42
"""Radius of the pulley on the crankshaft, in bores."""
BEYOND, NEXT = 1.0, 0.36
"""Distance from the last cylinder to the first belt, and from a belt to the next, in bores."""
ROUND = 1.15
"""The base circle, in the least that a flat tappet asks for."""
LEAST = 0.2
"""Radius of the base circle at least, in bores."""
SAME = 1e-9


@dataclass(frozen=True)
class ValveTrain:
    """Overhead valves of an engine of four strokes. Lengths in m, angles in DEGREES of the crank.

    ``lift`` (0.08 bores by default); ``ramp``: so much earlier valves begin to open, and so much later they are closed,
    than the cycle of the gas says, because they need time to open; ``base_radius`` of the cams, ``height`` of the
    camshafts over the crankshaft, ``apart``: between both valves of a cylinder along the shaft. ``mass`` of a valve
    with its tappet (kg), 0 by default where the engine's masses are given. ``stiffness`` (N/m) and ``preload`` (N) of
    the springs that close the valves.
    """

    lift: float | None = None
    ramp: float = 35.0
    base_radius: float | None = None
    height: float | None = None
    apart: float | None = None
    mass: float | None = None
    stiffness: float = 25e3
    preload: float = 200.0

    def __post_init__(self) -> None:
        for what in ("lift", "base_radius", "height", "apart"):
            if getattr(self, what) is not None:
                positive_number(f"engine: {what} of the valves", getattr(self, what), "m")
        if not 0.0 <= finite_number("engine: ramp of the valves", self.ramp) <= 60.0:
            raise ModelError(f"engine: ramp of the valves is {self.ramp:g} degrees of the crank; it must be 0 to 60")
        positive_number("engine: stiffness of the valve springs", self.stiffness, "N/m")
        not_negative_number("engine: preload of the valve springs", self.preload, "N")
        if self.mass is not None:
            not_negative_number("engine: mass of a valve", self.mass, "kg")

    def timing(self, gas: GasCycle | None) -> dict[str, tuple[float, float]]:
        """Return crank angles (rad, from the firing top dead centre) at which valves begin to open and close.

        A valve is closed at the latter.
        """
        opens, closes = (gas.exhaust_opens, gas.intake_closes) if isinstance(gas, FourStroke) else (math.pi, -math.pi)
        ramp = math.radians(self.ramp)
        return {
            "intake": (2 * math.pi - ramp, 4 * math.pi + closes + ramp),
            "exhaust": (opens - ramp, 2 * math.pi + ramp),
        }


def valve_train(
    m: Mechanism,
    frame: Body,
    plan: Layout,
    train: ValveTrain,
    fires: Mapping[int, float],
    bore: float,
    top: float,
    z: np.ndarray,
    gas: GasCycle | None,
    massless: bool,
) -> None:
    """Add camshafts, belts, valves and their springs to an engine whose ``crank`` turns in ``frame``.

    ``fires``: crank angle (rad) at which each cylinder, by its number, fires; ``top``: from the crankshaft's axis to
    the wrist pin at the top dead centre (m); ``z``: (N,) places of the cylinders (m); ``massless``: whether bodies
    without a mass of their own have none, rather than that of their parts. Raises ModelError for engines of more than
    two banks and of two strokes, and for cams that no flat tappet can follow.
    """
    banks = sorted({round(cylinder.bank, 9) for cylinder in plan.cylinders})
    if len(banks) > 2:
        raise ModelError(
            f"engine '{m.name}': it has {len(banks)} banks, and camshafts with a belt each are for one or two; leave "
            "valves out"
        )
    if gas is not None and gas.turns != 2:
        raise ModelError(f"engine '{m.name}': a cycle of one turn has ports or pumped air; leave valves out")
    lift = LIFT * bore if train.lift is None else train.lift
    height = top + ABOVE * bore if train.height is None else train.height
    apart = APART * bore if train.apart is None else train.apart
    laws = {kind: _law(begin, end, lift) for kind, (begin, end) in train.timing(gas).items()}
    base = _base(m.name, laws, bore, train.base_radius)
    least = top + 0.5 * bore + base + lift
    if height <= least:
        raise ModelError(
            f"engine '{m.name}': the camshaft is {1000 * height:.4g} mm over the crankshaft, where its cams would "
            f"reach into the cylinders; make height more than {1000 * least:.4g} mm"
        )
    crank, mass = m.bodies["crank"], 0.0 if massless and train.mass is None else train.mass
    for row, bank in enumerate(banks):
        name = "camshaft" if len(banks) == 1 else f"camshaft_{row + 1}"
        axis = UPRIGHT + bank
        ray = np.array([math.cos(axis), math.sin(axis)])
        shaft = m.body(name, mass=0.0 if massless else None)
        m.revolute(f"{name}_main", frame.at(*(height * ray)), shaft.origin)
        m.start_near(**{name: 0.0})
        end = float(z.max()) + (BEYOND + NEXT * row) * bore
        radius = PULLEY * bore
        belt = "belt" if len(banks) == 1 else f"belt_{row + 1}"
        m.belt(belt, crank.at(0.0, 0.0, z=end), shaft.at(0.0, 0.0, z=end), radius_i=radius, radius_j=2 * radius)
        for number, cylinder in enumerate(plan.cylinders, start=1):
            if abs(cylinder.bank - bank) > SAME:
                continue
            for kind, side in (("intake", -0.5), ("exhaust", 0.5)):
                place = float(z[number - 1]) + side * apart
                begin = fires[number] + train.timing(gas)[kind][0]
                _valve(m, frame, shaft, f"{kind}_{number}", (axis, place), begin, laws[kind], base, height, mass)
                _spring(m, frame, f"{kind}_{number}", (axis, place), train, height - base, top + SEAT * bore, bore)


SEAT, LENGTH = 0.78, 0.13
"""Height of the springs over the wrist pin at the top dead centre, and their depth below the tappet's face (bores)."""


def _law(begin: float, end: float, lift: float) -> Lift:
    """Return the lift over the cam's angle, from where the valve begins to open."""
    half = (end - begin) / 4.0
    return Lift.of((half, lift, "modified_trapezoid"), (half, 0.0, "modified_trapezoid"), (2 * math.pi - 2 * half, 0.0))


def _base(name: str, laws: Mapping[str, Lift], bore: float, given: float | None) -> float:
    """Return the radius of the base circle (m)."""
    angles = np.linspace(0.0, 2 * math.pi, 1441)
    need = max(float(-(law(angles)[:, 0] + law(angles)[:, 2]).min()) for law in laws.values())
    if given is None:
        return max(ROUND * need, LEAST * bore)
    if given <= need:
        raise ModelError(
            f"engine '{name}': cams with a base_radius of {1000 * given:.4g} mm would be undercut: a flat tappet "
            f"needs more than {1000 * need:.4g} mm here. Make it larger, the lift less or the ramp longer"
        )
    return given


def _valve(
    m: Mechanism,
    frame: Body,
    shaft: Body,
    name: str,
    where: tuple[float, float],
    begin: float,
    law: Lift,
    base: float,
    height: float,
    mass: float | None,
) -> None:
    """Add a valve, its frame on the tappet's face with x away from the crankshaft, and its cam.

    ``begin``: crank angle (rad) at which it begins to open. The cam's frame is turned so that its angle is 0 there.
    """
    axis, z = where
    valve = m.body(name, mass=mass, z=z)
    m.prismatic(f"guide_{name}", frame.at(0.0, 0.0, axis, z=z), valve.origin)
    turned = axis + math.pi - UPRIGHT - 0.5 * begin
    cam = shaft.at(0.0, 0.0, turned, z=z)
    m.cam_flat(f"cam_{name}", cam, valve.at(0.0, 0.0, UPRIGHT, z=z), flat_cam(law, base))
    lifted = float(law(np.array([-0.5 * begin]))[0, 0])
    away = height - base - lifted
    m.start_near(**{name: (away * math.cos(axis), away * math.sin(axis), math.degrees(axis))})


def _spring(
    m: Mechanism,
    frame: Body,
    name: str,
    where: tuple[float, float],
    train: ValveTrain,
    face: float,
    seat: float,
    bore: float,
) -> None:
    """Add the spring that closes a valve; ``face`` and ``seat``: from the crankshaft's axis (m)."""
    axis, z = where
    closed = face - LENGTH * bore - seat
    if closed <= 0:
        raise ModelError(
            f"engine '{m.name}': between the heads and the tappets there is no room for springs; make height of the "
            f"valves larger by more than {-1000 * closed:.4g} mm"
        )
    stand = frame.at(seat * math.cos(axis), seat * math.sin(axis), z=z)
    m.spring(
        f"spring_{name}", stand, m.bodies[name].at(-LENGTH * bore, 0.0), train.stiffness,
        free_length=closed + train.preload / train.stiffness,
    )  # fmt: skip
