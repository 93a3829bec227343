"""Reads what the page shows from out/<name>/: the motion and its skeleton, and what else is there."""

from __future__ import annotations

from typing import Any

from render.film.film import Film
from render.freshness import current_clearance
from render.view.loads import clearance_of
from render.view.payload import payload
from render.view.solid import with_parts
from shared.contract import read_motion, read_parts
from shared.contract.shot import Shot, read_shot
from shared.contract.skeleton import read_skeleton
from shared.contract.spanning import with_rods
from shared.stage.errors import UserError
from shared.stage.face import to_run
from shared.stage.paths import Out


def read_payload(out: Out) -> dict[str, Any]:
    """The whole payload of a mechanism. Raises UserError for files that do not fit together."""
    motion, skeleton = read_motion(out.motion, out.name), read_skeleton(out.skeleton)
    if skeleton.moving is None:
        raise UserError(f"{out.name}: {out.skeleton} is of an earlier version; run {to_run('solve', out.name)} again")
    if skeleton.provenance.inputs != motion.provenance.inputs:
        raise UserError(
            f"{out.name}: {out.skeleton} is not of the motion in {out.motion}; run {to_run('solve', out.name)} again"
        )
    shot = read_shot(out.shot) if out.shot.is_file() else Shot()
    parts = read_parts(out.parts, out.name) if out.parts.is_file() else None
    motion = with_rods(motion, parts) if parts else motion
    page = payload(motion, skeleton.moving, shot)
    film = Film(motion, parts, shot, out.parts_folder) if parts else None
    if film is not None:
        page = with_parts(page, film)
    clearance = current_clearance(out, parts, "view")
    if clearance is not None:
        page["clearance"] = clearance_of(clearance, film)
    return page
