"""Cams with a roller or a flat face.

Cam and roller: the roller's centre (marker j) stays on the cam's pitch curve (frame: marker i).

    Phi = n . (p_j - c(u))        constraint `curve`, 1 row, c the pitch curve

The follower may translate (a guide) or oscillate (a pin); the cam's profile must be made for it. Contact is kept from
both sides, as in a grooved cam. The reaction on body j is the contact force, along the common normal.

Cam and flat face: a face (the x axis of marker j) touches the cam's outline (frame: marker i).

    Phi = (p_j - p_i) . n - h(phi)        constraint `support`, 1 row, n the face's normal, h the cam's support function

The y axis of marker j points away from the cam. The follower may translate or oscillate; the cam's profile must be made
for it. Contact is kept from both sides. The reaction on body j is the contact force along n, and its torque.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from mbsd.base.errors import ModelError, ModelWarning
from mbsd.base.names import shown
from mbsd.base.warning import warn
from mbsd.model.body import Marker
from mbsd.model.cams.followers import cam_from
from mbsd.model.cams.profile import CamProfile
from mbsd.model.entries import join
from mbsd.model.joint import Joint, JointKind, register_joint
from mbsd.model.mechanism import Model

ROLLER_LIFT = {"segments": [[math.pi, 0.5, "cycloidal"], [math.pi, 0.0, "3-4-5"]], "start": 0.0}

CAM_ROLLER = register_joint(
    JointKind(
        "cam_roller",
        ("curve",),
        look="roller",
        example=lambda m, i, j: m.cam_roller(
            "example",
            i,
            j,
            {"follower": "roller", "lift": ROLLER_LIFT, "base_radius": 1.5, "roller_radius": 0.3, "offset": 0.1},
        ),
        numbers=lambda params: [cam_from(params["profile"]).numbers],
    )
)


@CAM_ROLLER.adds
def cam_roller(m: Model, name: str, cam: Marker, roller: Marker, profile: CamProfile | Mapping[str, Any]) -> Joint:
    """The centre of a roller follower (marker ``roller``) on a cam with its frame at marker ``cam``.

    ``profile``: from mbsd.cams.roller_cam or oscillating_roller_cam. Warns (ModelWarning) of an undercut.
    """
    return join(m, CAM_ROLLER, name, cam, roller, None, **_given(m, name, profile, flat=False))


FLAT_LIFT = {"segments": [[math.pi, 0.2, "cycloidal"], [math.pi, 0.0, "3-4-5"]], "start": 0.0}

CAM_FLAT = register_joint(
    JointKind(
        "cam_flat",
        ("support",),
        example=lambda m, i, j: m.cam_flat(
            "example", i, j, {"follower": "flat", "lift": FLAT_LIFT, "base_radius": 1.5}
        ),
        numbers=lambda params: [cam_from(params["profile"]).numbers],
        touching="place",
    )
)


@CAM_FLAT.adds
def cam_flat(m: Model, name: str, cam: Marker, face: Marker, profile: CamProfile | Mapping[str, Any]) -> Joint:
    """Add a flat face on a cam with frame at marker ``cam``.

    The face is the x axis of marker ``face``, whose y axis points away from the cam.

    ``profile``: from mbsd.cams.flat_cam or oscillating_flat_cam. Warns (ModelWarning) of an undercut.
    """
    return join(m, CAM_FLAT, name, cam, face, None, **_given(m, name, profile, flat=True))


def _given(m: Model, name: str, profile: CamProfile | Mapping[str, Any], flat: bool) -> dict[str, Any]:
    """Plain data of a cam for this kind of follower; warns of an undercut. Raises ModelError."""
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
    return {"profile": profile.data}
