"""Adding a joint or driver: its checks, and its entry."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mbsd.base.arguments import finite_number, number_pair
from mbsd.base.errors import ModelError, ModelWarning
from mbsd.base.names import shown
from mbsd.base.warning import warn
from mbsd.model.body import Marker
from mbsd.model.joint import Joint, JointKind
from mbsd.model.laws import Motion
from mbsd.model.laws.function import Function
from mbsd.model.mechanism import (
    Model,
    connections,
    length_given,
    new_name,
    number_given,
    two_bodies,
)
from mbsd.model.teeth import FEWEST

if TYPE_CHECKING:
    from mbsd.model.cams.profile import CamProfile

Limits = Sequence[float | None] | None
Law = Motion | Callable[[float], float]


def limits_given(m: Model, name: str, limits: Limits) -> dict[str, Any]:
    """Params of a joint's limits: none, or (lower, upper) with None on a free side. Raises ModelError."""
    if limits is None:
        return {}
    what = f"{m.name}: joint '{name}': limits"
    ends = limits.tolist() if isinstance(limits, np.ndarray) else limits
    ends = ends if isinstance(ends, list | tuple) else ()
    if len(ends) != 2 or ends[0] is ends[1] is None:
        raise ModelError(f"{what} are {shown(limits)}; give (lower, upper), None on a free side")
    lower, upper = (None if end is None else finite_number(what, end) for end in ends)
    if lower is not None and upper is not None and not lower < upper:
        raise ModelError(f"{what} are {lower:g} .. {upper:g}; the lower must be below the upper")
    return {"limits": (lower, upper)}


def join(m: Model, kind: JointKind, name: str, i: Marker, j: Marker, law: Law | None = None, **params: Any) -> Joint:
    """Enter a joint, or a driver with its law, between two markers of different bodies. Raises ModelError."""
    what = "driver" if kind.driven else "joint"
    new_name(m, name, what, *connections(m))
    two_bodies(m, f"{what} '{name}'", i, j)
    motion = None
    if kind.driven:
        if not (isinstance(law, Motion) or callable(law)):
            raise ModelError(
                f"{m.name}: driver '{name}' needs a motion law, got {shown(law)}; "
                "say constant_rate(...), harmonic(...), or a function of time"
            )
        motion = law if isinstance(law, Motion) else Function(law)
    joint = Joint(kind, name, i, j, params, motion)
    (m.drivers if kind.driven else m.joints)[name] = joint
    return joint


def cam_given(m: Model, name: str, profile: CamProfile | Mapping[str, Any], flat: bool) -> dict[str, Any]:
    """Plain data of a cam for this kind of follower; warns of an undercut. Raises ModelError."""
    from mbsd.model.cams.followers import cam_from
    from mbsd.model.cams.profile import CamProfile

    if not isinstance(profile, CamProfile):
        if not isinstance(profile, Mapping):
            raise ModelError(f"{m.name}: joint '{name}' needs a profile from mbsd.cams, got {shown(profile)}")
        try:
            profile = cam_from(profile)
        except ModelError as error:
            raise ModelError(f"{m.name}: joint '{name}': {error}") from error
    if profile.flat != flat:
        raise ModelError(
            f"{m.name}: joint '{name}' is {'cam_flat' if flat else 'cam_roller'}, but its profile is for the "
            f"follower '{profile.follower}'; use {'cam_roller' if flat else 'cam_flat'}"
        )
    if profile.undercut:
        warn(f"{m.name}: joint '{name}': {profile.problems[0]}", ModelWarning)
    return profile.data


def wheels_given(
    m: Model, name: str, radii: Mapping[str, float | None], teeth: Sequence[int] | int | None, **size: float | None
) -> dict[str, Any]:
    """Return the arguments that give the wheels: radii, or teeth with the one ``size`` (module or pitch)."""
    what, [(unit, value)] = f"{m.name}: joint '{name}'", size.items()
    given = {key: radius for key, radius in radii.items() if radius is not None}
    by_radii, by_teeth = " and ".join(f"{key}=" for key in radii), f"teeth= and {unit}="
    if given and (teeth is not None or value is not None):
        raise ModelError(f"{what} has {', '.join(given)} and {by_teeth}; give {by_radii} (m), or {by_teeth} (m)")
    if len(given) == len(radii):
        return radii_given(m, name, **given)
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
    return {"teeth": whole[0] if single else tuple(whole), **radii_given(m, name, **{unit: value})}


def radii_given(m: Model, name: str, **radii: float) -> dict[str, float]:
    """Lengths above zero (m), by name. Raises ModelError."""
    out = {key: number_given(m, f"joint '{name}': {key}", value) for key, value in radii.items()}
    for key, value in out.items():
        length_given(m, f"joint '{name}' has {key}", value)
    return out


def phase_given(m: Model, name: str, phase: Sequence[float] | None) -> tuple[float, float] | None:
    """Angles of both bodies (rad) that belong together, or None. Raises ModelError."""
    return None if phase is None else number_pair(f"{m.name}: joint '{name}': phase (rad)", phase)
