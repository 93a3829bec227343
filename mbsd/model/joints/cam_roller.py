"""Cam and roller: the roller's centre (marker j) stays on the cam's pitch curve (frame: marker i).

    Phi = n . (p_j - c(u))        constraint `curve`, 1 row, c the pitch curve

The follower may translate (a guide) or oscillate (a pin); the cam's profile must be made for it. Contact is kept from
both sides, as in a grooved cam. The reaction on body j is the contact force, along the common normal.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from mbsd.model.adding.joints import cam_given, join
from mbsd.model.body import Marker
from mbsd.model.joint import Joint, JointKind, cam_numbers, register
from mbsd.model.mechanism import Model

if TYPE_CHECKING:
    from mbsd.model.cams.profile import CamProfile

_LIFT = {"segments": [[math.pi, 0.5, "cycloidal"], [math.pi, 0.0, "3-4-5"]], "start": 0.0}

CAM_ROLLER = register(
    JointKind(
        "cam_roller",
        ("curve",),
        look="roller",
        example=lambda m, i, j: m.cam_roller(
            "example",
            i,
            j,
            {"follower": "roller", "lift": _LIFT, "base_radius": 1.5, "roller_radius": 0.3, "offset": 0.1},
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
