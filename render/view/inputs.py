"""Reads what the page shows from out/<name>/: the motion and its skeleton, and what else is there."""

from __future__ import annotations

from typing import Any

from render.view.loads import clearance_of
from render.view.payload import payload
from shared.contract import read_motion
from shared.contract.clearance import read_clearance
from shared.contract.shot import Shot, read_shot
from shared.contract.skeleton import read_skeleton
from shared.stage.errors import UserError
from shared.stage.paths import Out


def read_payload(out: Out) -> dict[str, Any]:
    """The whole payload of a mechanism. Raises UserError for files that do not fit together."""
    motion, skeleton = read_motion(out.motion, out.name), read_skeleton(out.skeleton)
    if skeleton.moving is None:
        raise UserError(
            f"{out.name}: {out.skeleton} is of an earlier version; run make solve-{out.name.replace('_', '-')} again"
        )
    if skeleton.provenance.inputs != motion.provenance.inputs:
        raise UserError(
            f"{out.name}: {out.skeleton} is not of the motion in {out.motion}; "
            f"run make solve-{out.name.replace('_', '-')} again"
        )
    shot = read_shot(out.shot) if out.shot.is_file() else Shot()
    found = payload(motion, skeleton.moving, shot)
    if out.clearance.is_file():
        found["clearance"] = clearance_of(read_clearance(out.clearance))
    return found
