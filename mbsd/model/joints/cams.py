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
from typing import TYPE_CHECKING, Any

from mbsd.model.body import Marker
from mbsd.model.entries import cam_given, join
from mbsd.model.joint import Joint, JointKind, cam_numbers, register_joint
from mbsd.model.mechanism import Model

if TYPE_CHECKING:
    from mbsd.model.cams.profile import CamProfile


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
        numbers=lambda params: [cam_numbers(params["profile"])],
    )
)


@CAM_ROLLER.adds
def cam_roller(m: Model, name: str, cam: Marker, roller: Marker, profile: CamProfile | Mapping[str, Any]) -> Joint:
    """The centre of a roller follower (marker ``roller``) on a cam with its frame at marker ``cam``.

    ``profile``: from mbsd.cams.roller_cam or oscillating_roller_cam. Warns (ModelWarning) of an undercut.
    """
    return join(m, CAM_ROLLER, name, cam, roller, None, profile=cam_given(m, name, profile, flat=False))


FLAT_LIFT = {"segments": [[math.pi, 0.2, "cycloidal"], [math.pi, 0.0, "3-4-5"]], "start": 0.0}

CAM_FLAT = register_joint(
    JointKind(
        "cam_flat",
        ("support",),
        example=lambda m, i, j: m.cam_flat(
            "example", i, j, {"follower": "flat", "lift": FLAT_LIFT, "base_radius": 1.5}
        ),
        numbers=lambda params: [cam_numbers(params["profile"])],
        touching="place",
    )
)


@CAM_FLAT.adds
def cam_flat(m: Model, name: str, cam: Marker, face: Marker, profile: CamProfile | Mapping[str, Any]) -> Joint:
    """Add a flat face on a cam with frame at marker ``cam``.

    The face is the x axis of marker ``face``, whose y axis points away from the cam.

    ``profile``: from mbsd.cams.flat_cam or oscillating_flat_cam. Warns (ModelWarning) of an undercut.
    """
    return join(m, CAM_FLAT, name, cam, face, None, profile=cam_given(m, name, profile, flat=True))
