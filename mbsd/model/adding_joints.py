"""The methods of a Model that add joints and drivers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from mbsd.base.arguments import finite_number
from mbsd.base.errors import ModelError
from mbsd.base.shown import shown
from mbsd.model.body import Body, Marker
from mbsd.model.drivers.angle import DRIVE_ANGLE
from mbsd.model.drivers.coordinate import DRIVE_COORDINATE
from mbsd.model.drivers.distance import DRIVE_DISTANCE
from mbsd.model.drivers.relative_angle import DRIVE_RELATIVE_ANGLE
from mbsd.model.joint import Joint
from mbsd.model.joints.distance import DISTANCE
from mbsd.model.joints.kind import JointKind
from mbsd.model.joints.pin_in_slot import PIN_IN_SLOT
from mbsd.model.joints.prismatic import PRISMATIC
from mbsd.model.joints.revolute import REVOLUTE
from mbsd.model.joints.weld import WELD
from mbsd.model.laws import Motion
from mbsd.model.laws.function import Function
from mbsd.model.mechanism import SHORTEST, Model

Limits = Sequence[float | None] | None
Law = Motion | Callable[[float], float]


class AddingJoints(Model):
    """Joints take two markers, drivers a motion law besides; all return the Joint."""

    def revolute(self, name: str, i: Marker, j: Marker, limits: Limits = None) -> Joint:
        """A pin: markers i and j share one point. ``limits``: of the angle of j against i (rad), None: free."""
        return self._join(REVOLUTE, name, i, j, None, **self._limits(name, limits))

    def prismatic(self, name: str, i: Marker, j: Marker, limits: Limits = None) -> Joint:
        """A slider: marker j moves along the x axis of marker i and does not turn against it.

        ``limits``: lower and upper place of j along that axis (m), None on a free side.
        """
        return self._join(PRISMATIC, name, i, j, None, **self._limits(name, limits))

    def weld(self, name: str, i: Marker, j: Marker) -> Joint:
        """Marker j is fixed to marker i in place and direction."""
        return self._join(WELD, name, i, j)

    def distance(self, name: str, i: Marker, j: Marker, length: float) -> Joint:
        """A massless rod of the given length (m) between the points of markers i and j."""
        length = self._number(f"joint '{name}': length", length)
        if length < SHORTEST:
            raise ModelError(
                f"{self.name}: distance joint '{name}' has length {length:g} m; it must be positive, {SHORTEST:g} m or "
                "more (use a revolute joint for two points that coincide)"
            )
        return self._join(DISTANCE, name, i, j, length=length)

    def pin_in_slot(self, name: str, slot: Marker, pin: Marker, limits: Limits = None) -> Joint:
        """The point of marker ``pin`` moves along the x axis of marker ``slot``, within ``limits`` (m)."""
        return self._join(PIN_IN_SLOT, name, slot, pin, None, **self._limits(name, limits))

    # -- drivers ------------------------------------------------------------------------------------------------

    def drive_angle(self, name: str, body: Body, law: Law) -> Joint:
        """Impose the absolute angle of a body (rad)."""
        self._own_body(body, f"driver '{name}'")
        return self._join(DRIVE_ANGLE, name, self.ground.origin, body.origin, law=law)

    def drive_relative_angle(self, name: str, first: Body, second: Body, law: Law) -> Joint:
        """Impose the angle of body ``second`` against body ``first`` (rad)."""
        self._own_body(first, f"driver '{name}'")
        self._own_body(second, f"driver '{name}'")
        return self._join(DRIVE_RELATIVE_ANGLE, name, first.origin, second.origin, law=law)

    def drive_coordinate(self, name: str, i: Marker, j: Marker, law: Law) -> Joint:
        """Impose how far marker j lies along the x axis of marker i (m)."""
        return self._join(DRIVE_COORDINATE, name, i, j, law=law)

    def drive_distance(self, name: str, i: Marker, j: Marker, law: Law) -> Joint:
        """Impose the distance of the points of markers i and j (m), as a linear actuator does."""
        return self._join(DRIVE_DISTANCE, name, i, j, law=law)

    def _limits(self, name: str, limits: Limits) -> dict[str, Any]:
        if limits is None:
            return {}
        what = f"{self.name}: joint '{name}': limits"
        ends = limits.tolist() if isinstance(limits, np.ndarray) else limits
        ends = ends if isinstance(ends, list | tuple) else ()
        if len(ends) != 2 or ends[0] is ends[1] is None:
            raise ModelError(f"{what} are {shown(limits)}; give (lower, upper), None on a free side")
        lower, upper = (None if end is None else finite_number(what, end) for end in ends)
        if lower is not None and upper is not None and not lower < upper:
            raise ModelError(f"{what} are {lower:g} .. {upper:g}; the lower must be below the upper")
        return {"limits": (lower, upper)}

    def _join(self, kind: JointKind, name: str, i: Marker, j: Marker, law: Law | None = None, **params: Any) -> Joint:
        what = "driver" if kind.driven else "joint"
        self._new_name(name, what, *self._connections)
        for marker in (i, j):
            if not isinstance(marker, Marker):
                raise ModelError(
                    f"{self.name}: {what} '{name}' needs two markers, got {shown(marker)}; "
                    "write body.at(x, y), bar.start or bar.end"
                )
            self._own_body(marker.body, f"{what} '{name}'")
        if i.body is j.body:
            raise ModelError(
                f"{self.name}: {what} '{name}' connects '{i.body.name}' with itself; give markers of two bodies"
            )
        motion = None
        if kind.driven:
            if not (isinstance(law, Motion) or callable(law)):
                raise ModelError(
                    f"{self.name}: driver '{name}' needs a motion law, got {shown(law)}; "
                    "say constant_rate(...), harmonic(...), or a function of time"
                )
            motion = law if isinstance(law, Motion) else Function(law)
        joint = Joint(kind, name, i, j, params, motion)
        (self.drivers if kind.driven else self.joints)[name] = joint
        return joint
