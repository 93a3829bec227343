"""The methods of a Model that add unilateral contacts, stops and events. They act in ``simulate`` alone."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from mbsd.base.errors import ModelError
from mbsd.base.shown import shown
from mbsd.model.body import Body, Marker
from mbsd.model.contacts.discs import DISCS
from mbsd.model.contacts.kind import ContactKind
from mbsd.model.contacts.line import LINE
from mbsd.model.contacts.one_way import ONE_WAY
from mbsd.model.contacts.rope import ROPE
from mbsd.model.contacts.stops import ANGLE_STOP, COORDINATE_STOP
from mbsd.model.contacts.terrain import TERRAIN
from mbsd.model.event import Event
from mbsd.model.joint import Joint
from mbsd.model.mechanism import Model


class AddingContacts(Model):
    """All take ``restitution`` (0 .. 1, speed after over speed before), and rest below a small speed of rebound."""

    def rigid_contact(
        self,
        name: str,
        line: Marker,
        point: Marker,
        radius: float = 0.0,
        restitution: float = 0.0,
        friction: float = 0.0,
        static_friction: float | None = None,
    ) -> Joint:
        """A point, or a disc of ``radius`` (m) around it, stays on the positive side of the x axis of ``line``.

        ``friction`` is Coulomb's coefficient; ``static_friction``, the same if not given, holds what sticks.
        """
        params = self._amounts(name, radius=radius) | self._frictions(name, friction, static_friction)
        return self._touch(LINE, name, line, point, restitution, params)

    def rigid_discs(
        self,
        name: str,
        i: Marker,
        j: Marker,
        radius_i: float,
        radius_j: float,
        inside: bool = False,
        restitution: float = 0.0,
        friction: float = 0.0,
        static_friction: float | None = None,
    ) -> Joint:
        """Discs of two radii (m) around two markers do not enter each other; ``inside``: j is inside the ring i."""
        params = self._amounts(name, radius_i=radius_i, radius_j=radius_j) | {"inside": bool(inside)}
        params |= self._frictions(name, friction, static_friction)
        reach = radius_i - radius_j if inside else radius_i + radius_j
        if reach <= 0:
            raise ModelError(
                f"{self.name}: contact '{name}': radii {radius_i:g} m and {radius_j:g} m leave no distance of the "
                "centres; " + ("the ring i must be larger than the disc j" if inside else "one must be positive")
            )
        return self._touch(DISCS, name, i, j, restitution, params)

    def rigid_terrain(
        self,
        name: str,
        terrain: Marker,
        point: Marker,
        points: Sequence[Sequence[float]],
        radius: float = 0.0,
        closed: bool = False,
        restitution: float = 0.0,
        friction: float = 0.0,
        static_friction: float | None = None,
    ) -> Joint:
        """A point, or a disc of ``radius`` (m) around it, stays on the left of a smooth curve.

        It goes through ``points`` (k, 2) in the axes of marker ``terrain`` (m), for a ground from left to right; beyond
        its ends an open curve goes on straight.
        """
        from mbsd.model.plane_curves import checked_points, refuse_crossing, refuse_tight

        what = f"{self.name}: contact '{name}'"
        params = self._amounts(name, radius=radius) | self._frictions(name, friction, static_friction)
        plain = checked_points(what, points, closed)
        refuse_crossing(what, plain, closed)
        refuse_tight(what, plain, closed, params["radius"])
        params |= {"points": plain, "closed": bool(closed)}
        return self._touch(TERRAIN, name, terrain, point, restitution, params)

    def rope(self, name: str, i: Marker, j: Marker, length: float, restitution: float = 0.0) -> Joint:
        """The points of two markers stay no more than ``length`` (m) apart."""
        params = self._amounts(name, length=length)
        if params["length"] <= 0:
            raise ModelError(f"{self.name}: rope '{name}' has length {length:g} m; it must be positive")
        return self._touch(ROPE, name, i, j, restitution, params)

    def angle_stop(
        self, name: str, i: Marker, j: Marker, at: float, upper: bool = False, restitution: float = 0.0
    ) -> Joint:
        """The angle of marker j against marker i (rad, counted over turns) does not fall below ``at``.

        ``upper``: it does not rise above.
        """
        return self._touch(ANGLE_STOP, name, i, j, restitution, self._stop(name, at, upper))

    def coordinate_stop(
        self, name: str, i: Marker, j: Marker, at: float, upper: bool = False, restitution: float = 0.0
    ) -> Joint:
        """Marker j does not come below ``at`` (m) along the x axis of marker i; ``upper``: not above."""
        return self._touch(COORDINATE_STOP, name, i, j, restitution, self._stop(name, at, upper))

    def stop(
        self,
        name: str,
        joint: Joint,
        lower: float | None = None,
        upper: float | None = None,
        restitution: float = 0.0,
    ) -> tuple[Joint, ...]:
        """Ends of the way of a revolute (rad) or prismatic joint (m), named ``name lower`` and ``name upper``."""
        if lower is None and upper is None:
            raise ModelError(f"{self.name}: stop '{name}' has no end; give lower=, upper= or both")
        if lower is not None and upper is not None and not lower < upper:
            raise ModelError(f"{self.name}: stop '{name}': lower is {lower:g}, upper {upper:g}; lower must be less")
        if not isinstance(joint, Joint) or joint.kind.name not in ("revolute", "prismatic"):
            raise ModelError(f"{self.name}: stop '{name}' needs a revolute or prismatic joint, got {shown(joint)}")
        add = self.angle_stop if joint.kind.name == "revolute" else self.coordinate_stop
        ends = [("lower", lower, False), ("upper", upper, True)]
        given = [(f"{name} {end}", at, is_upper) for end, at, is_upper in ends if at is not None]
        for one, _, _ in given:
            self._new_name(one, "contact", *self._connections)
        return tuple(add(one, joint.i, joint.j, at, is_upper, restitution) for one, at, is_upper in given)

    def one_way(self, name: str, first: Body, second: Body, clockwise: bool = False) -> Joint:
        """A one-way clutch: ``second`` turns against ``first`` only counter-clockwise, or only clockwise."""
        for body in (first, second):
            self._own_body(body, f"contact '{name}'")
        return self._touch(ONE_WAY, name, first.origin, second.origin, None, {"clockwise": bool(clockwise)})

    def event(
        self,
        name: str,
        value: Callable[[float, Any], float],
        direction: int = 0,
        terminal: bool = False,
        action: Callable[[Any], object] | None = None,
    ) -> Event:
        """Something to watch: ``value(t, moment)`` passes zero, rising (direction 1), falling (-1) or either (0).

        ``moment`` shows the motion now (mbsd/dynamics/events/moment.py). ``terminal`` ends the simulation there;
        ``action`` is called with the moment and may change velocities and let joints go.
        """
        self._new_name(name, "event", self.events)
        for what, function in (("value", value), ("action", action)):
            if not callable(function) and not (what == "action" and function is None):
                raise ModelError(f"{self.name}: event '{name}': {what} is {shown(function)}; it must be a function")
        if direction not in (-1, 0, 1):
            raise ModelError(f"{self.name}: event '{name}': direction is {shown(direction)}; it must be 1, -1 or 0")
        event = self.events[name] = Event(name, value, direction, bool(terminal), action)
        return event

    # -- checks -------------------------------------------------------------------------------------------------

    def _stop(self, name: str, at: float, upper: bool) -> dict[str, Any]:
        at = self._number(f"stop '{name}': at", at)
        return {"at": at, "upper": bool(upper)}

    def _amounts(self, name: str, **values: float) -> dict[str, Any]:
        out = {}
        for what, value in values.items():
            out[what] = self._number(f"contact '{name}': {what}", value)
            if out[what] < 0:
                raise ModelError(f"{self.name}: contact '{name}': {what} is {value:g}; it cannot be negative")
        return out

    def _frictions(self, name: str, friction: float, static_friction: float | None) -> dict[str, Any]:
        static = friction if static_friction is None else static_friction
        out = self._amounts(name, friction=friction, static_friction=static)
        if out["static_friction"] < out["friction"] or (out["friction"] == 0.0 and static > 0.0):
            raise ModelError(
                f"{self.name}: contact '{name}': static_friction is {static:g}, friction {friction:g}; static friction "
                "must not be less, and friction must be positive where there is static friction"
            )
        return out

    def _touch(
        self, kind: ContactKind, name: str, i: Marker, j: Marker, restitution: float | None, params: dict[str, Any]
    ) -> Joint:
        self._new_name(name, "contact", *self._connections)
        for marker in (i, j):
            if not isinstance(marker, Marker):
                raise ModelError(
                    f"{self.name}: contact '{name}' needs two markers, got {shown(marker)}; "
                    "write body.at(x, y), bar.start or bar.end"
                )
            self._own_body(marker.body, f"contact '{name}'")
        if i.body is j.body:
            raise ModelError(f"{self.name}: contact '{name}' is of '{i.body.name}' with itself; give two bodies")
        if restitution is not None:
            params["restitution"] = self._number(f"contact '{name}': restitution", restitution)
            if not 0.0 <= params["restitution"] <= 1.0:
                raise ModelError(f"{self.name}: contact '{name}': restitution is {restitution:g}; it must be 0 .. 1")
        contact = self.contacts[name] = Joint(kind, name, i, j, params)
        return contact
