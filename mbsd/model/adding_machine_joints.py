"""The methods of a Mechanism that add joints of machines: gears, rolling, curves, cams, Geneva, user-defined ones."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mbsd.base.arguments import number_pair
from mbsd.base.errors import ModelError, ModelWarning
from mbsd.base.shown import shown
from mbsd.base.warn import warn
from mbsd.model.adding_joints import AddingJoints
from mbsd.model.body import Marker
from mbsd.model.joint import Joint
from mbsd.model.joints.angle_lock import ANGLE_LOCK
from mbsd.model.joints.belt import BELT
from mbsd.model.joints.cam_flat import CAM_FLAT
from mbsd.model.joints.cam_roller import CAM_ROLLER
from mbsd.model.joints.constraint import CONSTRAINT
from mbsd.model.joints.gear_pair import GEAR_PAIR
from mbsd.model.joints.geneva import GENEVA
from mbsd.model.joints.point_on_curve import POINT_ON_CURVE
from mbsd.model.joints.rack_and_pinion import RACK_AND_PINION
from mbsd.model.joints.rolling_disc import ROLLING_DISC
from mbsd.model.joints.rolling_on_curve import ROLLING_ON_CURVE
from mbsd.model.teeth import FEWEST, with_radii

if TYPE_CHECKING:
    from mbsd.model.cams import CamProfile


MOST_SLOTS = 1000


class AddingMachineJoints(AddingJoints):
    """Joints that are functions of the relative pose of two markers; all return the Joint."""

    # -- rolling ------------------------------------------------------------------------------------------------

    def gear_pair(
        self,
        name: str,
        i: Marker,
        j: Marker,
        radius_i: float | None = None,
        radius_j: float | None = None,
        internal: bool = False,
        phase: Sequence[float] | None = None,
        teeth: Sequence[int] | None = None,
        module: float | None = None,
    ) -> Joint:
        """Two gears with centres at i and j, by pitch radii (m), or by ``teeth`` (z_i, z_j) and ``module`` (m).

        ``internal``: i is the ring around j. They mesh as they stand at the start; ``phase`` gives angles of both
        bodies (rad) that belong together. Gears by teeth must stand module (z_i + z_j) / 2 apart at the start, of a
        ring and its pinion the difference (AssemblyError).
        """
        wheels = self._wheels(name, {"radius_i": radius_i, "radius_j": radius_j}, teeth, module=module)
        sized = with_radii(wheels)
        if internal and sized["radius_i"] <= sized["radius_j"]:
            first, second = (
                [f"{count} teeth" for count in wheels["teeth"]]
                if "teeth" in wheels
                else [f"{key} = {wheels[key]:g} m" for key in wheels]
            )
            raise ModelError(
                f"{self.name}: gear_pair '{name}' is internal, so {first} is the ring's and must be "
                f"above {second}; give the ring first"
            )
        return self._join(
            GEAR_PAIR, name, i, j, None, **wheels, internal=bool(internal), phase=self._phase(name, phase)
        )

    def belt(
        self,
        name: str,
        i: Marker,
        j: Marker,
        radius_i: float | None = None,
        radius_j: float | None = None,
        crossed: bool = False,
        phase: Sequence[float] | None = None,
        teeth: Sequence[int] | None = None,
        pitch: float | None = None,
    ) -> Joint:
        """A belt or chain over pulleys with centres at i and j, open or crossed; ``phase`` as in gear_pair.

        By pitch radii (m), or by ``teeth`` (z_i, z_j) and the belt's ``pitch`` (m from tooth to tooth).
        """
        wheels = self._wheels(name, {"radius_i": radius_i, "radius_j": radius_j}, teeth, pitch=pitch)
        return self._join(BELT, name, i, j, None, **wheels, crossed=bool(crossed), phase=self._phase(name, phase))

    def rack_and_pinion(
        self,
        name: str,
        rack: Marker,
        pinion: Marker,
        radius: float | None = None,
        phase: Sequence[float] | None = None,
        teeth: int | None = None,
        module: float | None = None,
    ) -> Joint:
        """A pinion about marker ``pinion`` on the x axis of marker ``rack``, by its pitch radius (m), or by teeth.

        By ``teeth`` and ``module`` (m) its centre must stand module z / 2 above that axis at the start (AssemblyError).
        """
        wheels = self._wheels(name, {"radius": radius}, teeth, module=module)
        return self._join(RACK_AND_PINION, name, rack, pinion, None, **wheels, phase=self._phase(name, phase))

    def rolling_disc(
        self, name: str, line: Marker, disc: Marker, radius: float, phase: Sequence[float] | None = None
    ) -> Joint:
        """A disc of the given radius (m) about marker ``disc`` rolls on the y side of marker ``line``'s x axis."""
        radii = self._radii(name, radius=radius)
        return self._join(ROLLING_DISC, name, line, disc, None, **radii, phase=self._phase(name, phase))

    def rolling_on_curve(
        self,
        name: str,
        curve: Marker,
        disc: Marker,
        points: Sequence[Sequence[float]],
        radius: float,
        closed: bool = False,
    ) -> Joint:
        """A disc of the given radius (m) about marker ``disc`` rolls on the left of a curve through ``points`` (k, 2).

        The points are in the axes of marker ``curve`` (m); beyond its ends an open curve goes on straight.
        """
        from mbsd.model.plane_curves import checked_points, refuse_tight

        what = f"{self.name}: joint '{name}'"
        radii, plain = self._radii(name, radius=radius), checked_points(what, points, closed)
        refuse_tight(what, plain, closed, radii["radius"])
        return self._join(ROLLING_ON_CURVE, name, curve, disc, None, points=plain, closed=bool(closed), **radii)

    # -- curves and functions -----------------------------------------------------------------------------------

    def point_on_curve(
        self,
        name: str,
        curve: Marker,
        point: Marker,
        points: Sequence[Sequence[float]],
        closed: bool = False,
        distance: float = 0.0,
    ) -> Joint:
        """Marker ``point`` moves on a curve through ``points`` (k, 2) in the axes of marker ``curve`` (m).

        ``distance`` (m) is how far it stays to the left of the curve; beyond its ends an open curve goes on straight.
        """
        from mbsd.model.plane_curves import checked_points

        what = f"{self.name}: joint '{name}'"
        plain = checked_points(what, points, closed)
        distance = self._number(f"joint '{name}': distance", distance)
        return self._join(
            POINT_ON_CURVE, name, curve, point, None, points=plain, closed=bool(closed), distance=distance
        )

    def cam_roller(self, name: str, cam: Marker, roller: Marker, profile: CamProfile | Mapping[str, Any]) -> Joint:
        """The centre of a roller follower (marker ``roller``) on a cam with its frame at marker ``cam``.

        ``profile``: from mbsd.cams.roller_cam or oscillating_roller_cam. Warns (ModelWarning) of an undercut.
        """
        return self._join(CAM_ROLLER, name, cam, roller, None, profile=self._cam(name, profile, flat=False))

    def cam_flat(self, name: str, cam: Marker, face: Marker, profile: CamProfile | Mapping[str, Any]) -> Joint:
        """A flat face (x axis of marker ``face``, its y axis away from the cam) on a cam with frame at marker ``cam``.

        ``profile``: from mbsd.cams.flat_cam or oscillating_flat_cam. Warns (ModelWarning) of an undercut.
        """
        return self._join(CAM_FLAT, name, cam, face, None, profile=self._cam(name, profile, flat=True))

    def _cam(self, name: str, profile: CamProfile | Mapping[str, Any], flat: bool) -> dict[str, Any]:
        from mbsd.model.cams import CamProfile, cam_from

        if not isinstance(profile, CamProfile):
            if not isinstance(profile, Mapping):
                raise ModelError(f"{self.name}: joint '{name}' needs a profile from mbsd.cams, got {shown(profile)}")
            try:
                profile = cam_from(profile)
            except ModelError as error:
                raise ModelError(f"{self.name}: joint '{name}': {error}") from error
        if profile.flat != flat:
            raise ModelError(
                f"{self.name}: joint '{name}' is {'cam_flat' if flat else 'cam_roller'}, but its profile is for the "
                f"follower '{profile.follower}'; use {'cam_roller' if flat else 'cam_flat'}"
            )
        if profile.undercut:
            warn(f"{self.name}: joint '{name}': {profile.problems[0]}", ModelWarning)
        return profile.data

    def geneva(self, name: str, crank: Marker, wheel: Marker, slots: int, radius: float) -> Joint:
        """A Geneva: the pin at ``radius`` (m) on the x axis of marker ``crank`` indexes a wheel with ``slots`` slots.

        The x axis of marker ``wheel`` is a slot. The radius must be the distance of the centres times sin(pi / slots).
        """
        if not 3 <= slots <= MOST_SLOTS:
            raise ModelError(
                f"{self.name}: joint '{name}' has slots = {shown(slots)}; it must be a whole number, 3 .. {MOST_SLOTS}"
            )
        return self._join(GENEVA, name, crank, wheel, None, slots=int(slots), **self._radii(name, radius=radius))

    def angle_lock(self, name: str, i: Marker, j: Marker) -> Joint:
        """Marker j keeps the direction of marker i and is free to move."""
        return self._join(ANGLE_LOCK, name, i, j)

    def constraint(
        self, name: str, i: Marker, j: Marker, function: Callable[[float, float, float], float], unit: str = "m"
    ) -> Joint:
        """``function(x, y, a)`` of the pose of marker j in the axes of marker i (m, rad) is zero.

        Python or numba.njit; its derivatives are found. ``unit`` is that of its value, "m" or "rad".
        """
        if not callable(function):
            raise ModelError(
                f"{self.name}: joint '{name}' needs a function of x, y and the angle, got {shown(function)}"
            )
        if unit not in ("m", "rad"):
            raise ModelError(f"{self.name}: joint '{name}' has the unit {shown(unit)}; it must be 'm' or 'rad'")
        return self._join(CONSTRAINT, name, i, j, None, function=function, unit=unit)

    def _wheels(
        self, name: str, radii: Mapping[str, float | None], teeth: Sequence[int] | int | None, **size: float | None
    ) -> dict[str, Any]:
        """What gives the wheels: their radii, or their teeth with the one ``size`` (module or pitch)."""
        what, [(unit, value)] = f"{self.name}: joint '{name}'", size.items()
        given = {key: radius for key, radius in radii.items() if radius is not None}
        by_radii, by_teeth = " and ".join(f"{key}=" for key in radii), f"teeth= and {unit}="
        if given and (teeth is not None or value is not None):
            raise ModelError(f"{what} has {', '.join(given)} and {by_teeth}; give {by_radii} (m), or {by_teeth} (m)")
        if len(given) == len(radii):
            return self._radii(name, **given)
        if teeth is None or value is None:
            raise ModelError(f"{what} needs {by_radii} (m), or {by_teeth} (m)")
        single = len(radii) == 1
        counts = teeth if isinstance(teeth, Sequence | np.ndarray) and not single else [teeth]
        wanted = "a whole number" if single else "two whole numbers (z_i, z_j)"
        if isinstance(counts, str) or len(counts) != len(radii):
            raise ModelError(f"{what} has teeth {shown(teeth)}; give {wanted} from {FEWEST} on")
        whole: list[int] = []
        for count in counts:
            if isinstance(count, bool) or not isinstance(count, int | np.integer) or count < FEWEST:
                raise ModelError(f"{what} has {shown(count)} teeth; give {wanted} from {FEWEST} on")
            whole.append(int(count))
        return {"teeth": whole[0] if single else tuple(whole), **self._radii(name, **{unit: value})}

    def _radii(self, name: str, **radii: float) -> dict[str, float]:
        out = {key: self._number(f"joint '{name}': {key}", value) for key, value in radii.items()}
        for key, value in out.items():
            self._length(f"joint '{name}' has {key}", value)
        return out

    def _phase(self, name: str, phase: Sequence[float] | None) -> tuple[float, float] | None:
        return None if phase is None else number_pair(f"{self.name}: joint '{name}': phase (rad)", phase)
