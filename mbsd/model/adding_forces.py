"""The methods of a Model that add forces. Forces in N, torques in N m, counter-clockwise positive."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from mbsd.base.arguments import several_numbers
from mbsd.base.errors import ModelError
from mbsd.base.shown import shown
from mbsd.model.body import Body, Marker
from mbsd.model.force import Force
from mbsd.model.forces.actuator import ACTUATOR
from mbsd.model.forces.bushing import BUSHING
from mbsd.model.forces.curve_of_angle import CURVE_OF_ANGLE
from mbsd.model.forces.curve_of_length import CURVE_OF_LENGTH
from mbsd.model.forces.force import FORCE
from mbsd.model.forces.gas import GAS
from mbsd.model.forces.gravitation import GRAVITATION
from mbsd.model.forces.kind import ForceKind
from mbsd.model.forces.spring import SPRING
from mbsd.model.forces.spring_law import SPRING_LAW
from mbsd.model.forces.torque import TORQUE
from mbsd.model.forces.torsion_spring import TORSION_SPRING
from mbsd.model.forces.torsion_spring_law import TORSION_SPRING_LAW
from mbsd.model.laws import Motion
from mbsd.model.laws.curve import Curve
from mbsd.model.laws.function import Function
from mbsd.model.mechanism import Model

Amount = float | Motion | Callable[[float], float]
"""A constant, or a law of time."""


class AddingForces(Model):
    """Forces take two markers, torques two bodies, loads from outside one; all return the Force."""

    def spring(
        self, name: str, i: Marker, j: Marker, stiffness: Amount, damping: Amount = 0.0, free_length: Amount = 0.0
    ) -> Force:
        """Spring (N/m) and damper (N s/m) between the points of two markers; ``free_length`` in m.

        Each is a constant or a law of time.
        """
        params, laws = self._spring_amounts(name, stiffness=stiffness, damping=damping, free_length=free_length)
        return self._add_force(SPRING, name, i, j, params, laws)

    def torsion_spring(
        self, name: str, first: Body, second: Body, stiffness: Amount, damping: Amount = 0.0, free_angle: Amount = 0.0
    ) -> Force:
        """Torsion spring (N m/rad) and damper (N m s/rad); no torque where second - first is ``free_angle`` (rad).

        Each is a constant or a law of time.
        """
        params, laws = self._spring_amounts(name, stiffness=stiffness, damping=damping, free_angle=free_angle)
        return self._add_force(TORSION_SPRING, name, *self._origins(name, first, second), params, laws)

    def spring_law(self, name: str, i: Marker, j: Marker, law: Callable[[float, float], float]) -> Force:
        """Spring between the points of two markers by any function ``law(length, rate)`` (m, m/s) that gives N.

        Positive pushes the points apart: ``lambda length, rate: -k * (length - free) - c * rate`` is a linear spring
        and damper. Python or compiled with numba.njit. What it gives counts as work, not as potential energy.
        """
        return self._add_force(SPRING_LAW, name, i, j, self._law(name, law, "the length and its rate"))

    def torsion_spring_law(self, name: str, first: Body, second: Body, law: Callable[[float, float], float]) -> Force:
        """Torsion spring by any function ``law(angle, rate)`` (rad, rad/s) that gives the torque on ``second`` (N m).

        The angle is that of second against first: ``lambda angle, rate: -k * angle - c * rate`` is a linear one.
        """
        params = self._law(name, law, "the angle and its rate")
        return self._add_force(TORSION_SPRING_LAW, name, *self._origins(name, first, second), params)

    def bushing(
        self,
        name: str,
        i: Marker,
        j: Marker,
        stiffness: Sequence[float],
        damping: Sequence[float] = (0.0, 0.0, 0.0),
        free_angle: float = 0.0,
    ) -> Force:
        """Springs and dampers along x and y of marker i and in turning (N/m, N/m, N m/rad), damping alike."""
        params: dict[str, Any] = {"free_angle": self._number(f"force '{name}': free_angle", free_angle)}
        for what, values in (("stiffness", stiffness), ("damping", damping)):
            values = several_numbers(f"{self.name}: force '{name}': {what}", values, 3, "give (x, y, turning)")
            params[what] = tuple(self._positive(name, **{f"{what}[{k}]": v for k, v in enumerate(values)}).values())
        return self._add_force(BUSHING, name, i, j, params)

    def torque(self, name: str, body: Body, torque: Amount, against: Body | None = None) -> Force:
        """Torque (N m) on a body, a constant or a law of time; ``against`` (ground by default) takes the opposite."""
        params, laws = self._amount(name, "torque", torque)
        return self._add_force(
            TORQUE, name, *self._origins(name, self.ground if against is None else against, body), params, laws
        )

    def force(
        self,
        name: str,
        at: Marker,
        force: Amount,
        direction: Sequence[float] | float = (1.0, 0.0),
        frame: Body | None = None,
    ) -> Force:
        """Force (N) at a marker, a constant or a law of time.

        ``direction``: a vector, or an angle (rad), in the axes of body ``frame``: ground by default, so that it is
        fixed in the world; the body itself makes it turn with the body.
        """
        if isinstance(direction, int | float | np.number):
            angle = self._number(f"force '{name}': direction", direction)
        else:
            what = f"{self.name}: force '{name}': direction"
            x, y = several_numbers(what, direction, 2, "give an angle (rad) or a vector (x, y)")
            if x == 0.0 and y == 0.0:
                raise ModelError(f"{self.name}: force '{name}' has no direction; give a vector that is not zero")
            angle = math.atan2(y, x)
        params, laws = self._amount(name, "force", force)
        params["direction"] = angle
        base = self.ground if frame is None else frame
        self._own_body(base, f"force '{name}'")
        return self._add_force(FORCE, name, base.at(0.0, 0.0, angle), at, params, laws, same_body=True)

    def actuator(self, name: str, i: Marker, j: Marker, force: Amount, along_axis: bool = False) -> Force:
        """Force (N) between two points, a constant or a law of time: apart, or on j along the x axis of marker i."""
        params, laws = self._amount(name, "force", force)
        return self._add_force(ACTUATOR, name, i, j, {**params, "along_axis": bool(along_axis)}, laws)

    def curve_of_length(
        self, name: str, i: Marker, j: Marker, of_length: Curve | None = None, of_rate: Curve | None = None
    ) -> Force:
        """Force (N, apart positive) by curves of the distance (m) of two points and of its rate (m/s)."""
        return self._add_force(
            CURVE_OF_LENGTH, name, i, j, {}, self._curves(name, of_length=of_length, of_rate=of_rate)
        )

    def curve_of_angle(
        self, name: str, first: Body, second: Body, of_angle: Curve | None = None, of_rate: Curve | None = None
    ) -> Force:
        """Torque (N m) on ``second`` by characteristic curves of its angle against ``first`` (rad) and of the rate."""
        laws = self._curves(name, of_angle=of_angle, of_rate=of_rate)
        return self._add_force(CURVE_OF_ANGLE, name, *self._origins(name, first, second), {}, laws)

    def motor(self, name: str, first: Body, second: Body, torque_speed: Curve) -> Force:
        """A motor on body ``first`` that turns ``second``: its torque (N m) over their relative speed (rad/s)."""
        return self.curve_of_angle(name, first, second, of_rate=torque_speed)

    def gravitation(self, name: str, i: Marker, j: Marker, factor: float, exponent: float = -2.0) -> Force:
        """Force factor * distance^exponent (N, apart positive) between two points; masses attract: -G m1 m2 and -2."""
        params = {
            "factor": self._number(f"force '{name}': factor", factor),
            "exponent": self._number(f"force '{name}': exponent", exponent),
        }
        return self._add_force(GRAVITATION, name, i, j, params)

    def gas(
        self,
        name: str,
        cylinder: Marker,
        piston: Marker,
        area: float,
        pressure: float,
        at: float,
        clearance: float = 0.0,
        exponent: float = 1.3,
        outside: float = 101325.0,
    ) -> Force:
        """Gas between a cylinder's head and a piston, along the x axis of marker ``cylinder``.

        ``pressure`` (Pa, absolute) where the piston lies ``at`` (m) along that axis; ``clearance`` (m) is the length
        of the dead space before 0; ``outside`` is the pressure on the piston's other side.
        """
        params = self._positive(
            name, area=area, pressure=pressure, clearance=clearance, exponent=exponent, outside=outside
        )
        params["at"] = self._number(f"force '{name}': at", at)
        if params["at"] + params["clearance"] <= 0:
            raise ModelError(
                f"{self.name}: force '{name}': at + clearance is {at + clearance:g} m; it must be positive"
            )
        return self._add_force(GAS, name, cylinder, piston, params)

    # -- checks -------------------------------------------------------------------------------------------------

    def _add_force(
        self,
        kind: ForceKind,
        name: str,
        i: Marker,
        j: Marker,
        params: Mapping[str, Any],
        laws: Mapping[str, Motion | Curve] | None = None,
        same_body: bool = False,
    ) -> Force:
        self._new_name(name, "force", *self._connections)
        for marker in (i, j):
            if not isinstance(marker, Marker):
                raise ModelError(
                    f"{self.name}: force '{name}' needs two markers, got {shown(marker)}; "
                    "write body.at(x, y), bar.start or bar.end"
                )
            self._own_body(marker.body, f"force '{name}'")
        if i.body is j.body and not same_body:
            raise ModelError(f"{self.name}: force '{name}' connects '{i.body.name}' with itself; give two bodies")
        force = self.forces[name] = Force(kind, name, i, j, dict(params), dict(laws or {}))
        return force

    def _origins(self, name: str, first: Body, second: Body) -> tuple[Marker, Marker]:
        for body in (first, second):
            self._own_body(body, f"force '{name}'")
        return first.origin, second.origin

    def _positive(self, name: str, **values: float) -> dict[str, Any]:
        """Numbers that may not be negative."""
        out = {}
        for what, value in values.items():
            out[what] = self._number(f"force '{name}': {what}", value)
            if out[what] < 0:
                raise ModelError(f"{self.name}: force '{name}': {what} is {value:g}; it cannot be negative")
        return out

    def _above_zero(self, name: str, what: str, value: float) -> float:
        value = self._number(f"force '{name}': {what}", value)
        if value <= 0:
            raise ModelError(f"{self.name}: force '{name}': {what} is {value:g}; it must be positive")
        return value

    def _law(self, name: str, law: Any, of: str) -> dict[str, Any]:
        if not callable(law):
            raise ModelError(f"{self.name}: force '{name}' needs a function of {of}, got {shown(law)}")
        return {"law": law}

    def _amount(self, name: str, what: str, value: Amount) -> tuple[dict[str, Any], dict[str, Motion]]:
        if isinstance(value, Motion):
            return {}, {what: value}
        if callable(value):
            return {}, {what: Function(value)}
        return {what: self._number(f"force '{name}': {what}", value)}, {}

    def _spring_amounts(self, name: str, **values: Amount) -> tuple[dict[str, Any], dict[str, Motion]]:
        """Numbers that may not be negative, but for a free angle, and laws of time."""
        params, laws = {}, {}
        for what, value in values.items():
            own, law = self._amount(name, what, value)
            params |= own if what == "free_angle" else self._positive(name, **own)
            laws |= law
        free = list(values)[-1]
        if "stiffness" in laws and free in laws:
            raise ModelError(
                f"{self.name}: force '{name}': stiffness and {free} are both laws of time; give one of them as a "
                "number, or write m.user_force(...)"
            )
        return params, laws

    def _curves(self, name: str, **curves: Curve | None) -> dict[str, Curve]:
        out = {}
        for what, one in curves.items():
            if one is None:
                continue
            if not isinstance(one, Curve):
                raise ModelError(f"{self.name}: force '{name}': {what} is {shown(one)}; it must be a curve(x, y)")
            out[what] = one
        if not out:
            raise ModelError(f"{self.name}: force '{name}' has no curve; give {' or '.join(curves)}")
        return out
