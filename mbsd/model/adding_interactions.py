"""The methods of a Model that add contact, tyre, air, a turning frame, friction, functions of the user.

Forces in N, torques in N m, counter-clockwise positive.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from mbsd.base.arguments import number_pair
from mbsd.base.codes import FRICTION_JOINTS
from mbsd.base.errors import ModelError
from mbsd.base.names import no_such
from mbsd.base.shown import shown
from mbsd.model.adding_forces import AddingForces, Amount
from mbsd.model.body import Body, Marker
from mbsd.model.force import Force
from mbsd.model.forces.contact import CONTACT
from mbsd.model.forces.drag import DRAG
from mbsd.model.forces.friction import FRICTION
from mbsd.model.forces.rotating_frame import ROTATING_FRAME
from mbsd.model.forces.tyre import TYRE
from mbsd.model.forces.user_force import USER_FORCE
from mbsd.model.joint import Joint
from mbsd.model.laws.curve import Curve
from mbsd.model.laws.function import checked_pulses


class AddingInteractions(AddingForces):
    """All return the Force."""

    def contact(
        self,
        name: str,
        surface: Marker,
        body: Marker,
        stiffness: float,
        exponent: float = 1.5,
        damping: float = 0.0,
        friction: float = 0.0,
        radius: float = 0.0,
        profile: Curve | None = None,
        slip_speed: float = 1e-3,
    ) -> Force:
        """Contact of a disc of ``radius`` (m; 0: a point) about a marker with a surface, never pulling.

        The surface is the x axis of marker ``surface`` with matter below it (turn the marker for a wall), or a
        ``profile`` y(x) in its axes. Normal force stiffness * depth^exponent * (1 + damping * rate of depth); the
        friction coefficient is reached at some ``slip_speed`` (m/s).
        """
        params = self._positive(
            name, stiffness=stiffness, exponent=exponent, damping=damping, friction=friction, radius=radius
        )
        if params["exponent"] < 1.0:
            raise ModelError(f"{self.name}: force '{name}': exponent is {exponent:g}; it must be 1 or more")
        params["slip_speed"] = self._above_zero(name, "slip_speed", slip_speed)
        laws = {} if profile is None else self._curves(name, profile=profile)
        return self._add_force(CONTACT, name, surface, body, params, laws)

    def tyre(
        self,
        name: str,
        road: Marker,
        hub: Marker,
        radius: float,
        stiffness: float,
        damping: float = 0.0,
        grip: float = 1.0,
        slope: float = 10.0,
        shape: float = 1.65,
        curvature: float = 0.97,
        standstill: float = 0.1,
        profile: Curve | None = None,
    ) -> Force:
        """Wheel of ``radius`` (m) about marker ``hub`` on a road: the x axis of a marker, or a profile y(x) there.

        ``stiffness`` (N/m) and ``damping`` (N s/m) carry; ``grip`` D, ``slope`` B, ``shape`` C and ``curvature`` E of
        the magic formula pull by longitudinal slip, which is kept finite below ``standstill`` (m/s).
        """
        params = self._positive(name, stiffness=stiffness, damping=damping, grip=grip, slope=slope, shape=shape)
        params["radius"] = self._above_zero(name, "radius", radius)
        params["standstill"] = self._above_zero(name, "standstill", standstill)
        params["curvature"] = self._number(f"force '{name}': curvature", curvature)
        laws = {} if profile is None else self._curves(name, profile=profile)
        return self._add_force(TYRE, name, road, hub, params, laws)

    def drag(
        self,
        name: str,
        at: Marker,
        coefficient: float,
        turning: float = 0.0,
        wind: Sequence[float] = (0.0, 0.0),
        gust: Amount = 1.0,
    ) -> Force:
        """Quadratic drag at a marker: coefficient (N s^2/m^2) times the square of its speed against the air.

        ``turning`` (N m s^2) brakes the body's turning likewise; ``body.at(*body.com)`` is its centre of mass. The air
        moves with ``wind`` (m/s, world axes) times ``gust``, a constant or a law of time.
        """
        params, laws = self._amount(name, "gust", gust)
        params |= self._positive(name, coefficient=coefficient, turning=turning)
        params["wind"] = number_pair(f"{self.name}: force '{name}': wind", wind)
        return self._add_force(DRAG, name, self.ground.origin, at, params, laws, same_body=True)

    def rotating_frame(self, name: str, rate: Amount, centre: Sequence[float] = (0.0, 0.0)) -> Force:
        """Ground turns about ``centre`` (m) at ``rate`` (rad/s, a constant or a law of time); all bodies feel it."""
        params, laws = self._amount(name, "rate", rate)
        params["centre"] = number_pair(f"{self.name}: force '{name}': centre", centre)
        middle = self.ground.at(*params["centre"])
        return self._add_force(ROTATING_FRAME, name, middle, self.ground.origin, params, laws, same_body=True)

    def friction(
        self,
        name: str,
        joint: Joint | str,
        coefficient: float,
        static: float | None = None,
        stribeck: float = 0.01,
        viscous: float = 0.0,
        radius: float = 0.0,
        length: float = 0.0,
        preload: float = 0.0,
        slip_speed: float | None = None,
        sticks: bool = False,
    ) -> Force:
        """Friction of a revolute, prismatic or pin-in-slot joint from its actual reaction.

        ``coefficient`` while sliding and ``static`` (the same by default) near rest, between them the speed
        ``stribeck`` (m/s); ``viscous`` N s/m or N m s; ``radius`` of a pin (m); ``length`` over which a slider is
        guided (m), 0 where tilting presses nothing; ``preload`` (N) is added to the normal force; ``slip_speed``
        (m/s, 1 mm/s if not given) is where it comes near its full size, below it the joint creeps. With ``sticks`` it
        does not: a simulation finds when the joint sticks and slides, and holds it meanwhile.
        """
        what = f"{self.name}: force '{name}'"
        key = joint.name if isinstance(joint, Joint) else joint
        known = self.joints.get(key) if isinstance(key, str) else None
        if known is None or (known is not joint and isinstance(joint, Joint)):
            raise ModelError(f"{what}: {no_such('joint', key, self.joints)}")
        if known.kind.name not in FRICTION_JOINTS:
            raise ModelError(
                f"{what}: '{known.name}' is a {known.kind.name}; friction needs one of {', '.join(FRICTION_JOINTS)}"
            )
        params = self._positive(
            name, coefficient=coefficient, viscous=viscous, radius=radius, length=length, preload=preload
        )
        params["static"] = params["coefficient"] if static is None else self._positive(name, static=static)["static"]
        params["stribeck"] = self._above_zero(name, "stribeck", stribeck)
        params["sticks"] = bool(sticks)
        if not sticks:
            params["slip_speed"] = self._above_zero(name, "slip_speed", 1e-3 if slip_speed is None else slip_speed)
        elif slip_speed is not None:
            raise ModelError(f"{what}: a joint that sticks does not creep; give slip_speed or sticks=True, not both")
        if (params["radius"] > 0) != (known.kind.name == "revolute"):
            raise ModelError(f"{what}: a revolute joint needs the radius of its pin (m), and no other has one")
        if params["length"] > 0 and known.kind.name != "prismatic":
            raise ModelError(f"{what}: a length of guide (m) is of prismatic joints alone")
        params["joint"] = known.name
        return self._add_force(FRICTION, name, known.i, known.j, params)

    def user_force(
        self,
        name: str,
        function: Callable[..., Any],
        *bodies: Body,
        breaks: Sequence[float] = (),
        shortest: float | None = None,
    ) -> Force:
        """Forces on bodies by a function of the user, ``function(t, q, v)``, Python or compiled with numba.njit.

        q and v hold x, y, theta and their rates of the bodies' frames, three numbers a body in the order given; the
        function returns fx, fy (N, at the frame's origin) and torque (N m) of each body in that order.

        A simulation looks at it at 2583 times before, with the bodies as they start, so that steps end where it jumps
        or is short. ``breaks`` (s): where else it jumps. ``shortest`` (s): how long the shortest thing in it lasts, if
        that depends on the motion or is less than 1/2000 of the duration; no step is longer.
        """
        what = f"force '{name}'"
        if not callable(function):
            raise ModelError(f"{self.name}: {what} needs a function of t, q and v, got {shown(function)}")
        for body in bodies:
            self._own_body(body, what)
        if not bodies or len(set(map(id, bodies))) < len(bodies):
            raise ModelError(f"{self.name}: {what} needs the bodies it acts on, each once")
        at, least = checked_pulses(f"{self.name}: {what}", breaks, shortest)
        params: dict[str, Any] = {"function": function, "bodies": [body.name for body in bodies]}
        params |= ({"breaks": at} if at else {}) | ({"shortest": least} if least else {})
        return self._add_force(USER_FORCE, name, self.ground.origin, bodies[0].origin, params, same_body=True)
