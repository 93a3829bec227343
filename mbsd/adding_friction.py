"""The method of a Mechanism that adds friction to a joint."""

from __future__ import annotations

from mbsd.adding_forces import AddingForces
from mbsd.errors import ModelError
from mbsd.force import Force
from mbsd.forces.friction import FRICTION
from mbsd.joint import Joint

PINS, SLIDES = ("revolute",), ("prismatic", "pin_in_slot")
"""Kinds of joints that can have friction."""


class AddingFriction(AddingForces):
    """Friction acts on the reaction that the joint really has, in ``sweep`` and ``simulate``."""

    def friction(
        self,
        name: str,
        joint: Joint | str,
        coefficient: float,
        static: float | None = None,
        radius: float = 0.0,
        guide: float = 0.0,
        viscous: float = 0.0,
        preload: float = 0.0,
        stribeck_speed: float = 0.01,
        smoothing: float = 0.001,
    ) -> Force:
        """Friction in a revolute, prismatic or pin_in_slot joint, by its reaction; the law: mbsd/forces/friction.py.

        ``coefficient`` is the kinetic one, ``static`` (not below it) rules near rest within ``stribeck_speed`` (m/s of
        sliding). ``radius`` (m) of the pin of a revolute joint. ``guide`` (m) is the length of a prismatic joint's
        guide, at whose ends its couple bears; 0 leaves the couple out. ``viscous`` in N m s/rad, or N s/m of a slide.
        ``preload`` (N) is a normal force beside the reaction. Below ``smoothing`` (m/s) friction fades to zero.
        """
        if isinstance(joint, str):
            if joint not in self.joints:
                known = ", ".join(self.joints) or "none"
                raise ModelError(f"{self.name}: force '{name}': there is no joint '{joint}'; there is: {known}")
            joint = self.joints[joint]
        if not isinstance(joint, Joint) or self.joints.get(joint.name) is not joint:
            raise ModelError(f"{self.name}: force '{name}' needs a joint of this mechanism, got {joint!r}")
        if joint.kind.name not in PINS + SLIDES:
            raise ModelError(
                f"{self.name}: force '{name}': friction is known in {', '.join(PINS + SLIDES)} joints, and "
                f"'{joint.name}' is a {joint.kind.name}; use a damper or a user_force"
            )
        params = self._positive(
            name,
            coefficient=coefficient,
            radius=radius,
            guide=guide,
            viscous=viscous,
            preload=preload,
            stribeck_speed=stribeck_speed,
            smoothing=smoothing,
        )
        params["static"] = None if static is None else self._number(f"force '{name}': static", static)
        if static is not None and static < coefficient:
            raise ModelError(
                f"{self.name}: force '{name}': static is {static:g}; it cannot be below the coefficient {coefficient:g}"
            )
        for what in ("stribeck_speed", "smoothing"):
            if params[what] == 0.0:
                raise ModelError(f"{self.name}: force '{name}': {what} is 0 m/s; it must be positive")
        pin = joint.kind.name in PINS
        if pin and radius == 0.0 and (coefficient > 0.0 or params["static"]):
            raise ModelError(
                f"{self.name}: force '{name}': dry friction of the pin '{joint.name}' needs its radius (m); "
                "give radius=..., or coefficient 0 and viscous"
            )
        for what, useless in (("radius", not pin), ("guide", joint.kind.name != "prismatic")):
            if useless and params[what] > 0.0:
                raise ModelError(f"{self.name}: force '{name}': a {joint.kind.name} joint has no {what}; leave it out")
        return self._add_force(FRICTION, name, joint.i, joint.j, {"joint": joint.name} | params)
