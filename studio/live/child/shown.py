"""Solutions as the page shows them: the bytes of its payload."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mbsd import Solution
from mbsd.drawing.moving_skeleton import Moving, moving, redrawn
from mechanisms.stages.solve.motion_file import to_motion
from mechanisms.stages.solve.skeleton_file import moving_of
from render.view.document import encode
from render.view.payload import payload
from shared.contract import Motion, Parts
from shared.contract.shot import Shot
from shared.contract.skeleton import Moving as Told
from shared.contract.spanning import with_rods

OF_PARTS = ("bodies", "arrows", "arcs", "trails", "clearance", "solid")
"""Entries of the payload that change once there are parts."""


class Shown:
    """Payloads of one mechanism; ``quick`` ones keep symbol size and extent of the last whole one."""

    def __init__(self) -> None:
        self._last: Moving | None = None
        self._motion: tuple[Motion, Told] | None = None

    def payload(
        self,
        solution: Solution,
        parts: Parts | None,
        sources: Mapping[str, Any],
        shot: Shot | None,
        quick: bool,
        arrows: bool = True,
    ) -> dict[str, Any]:
        """Return the payload without its parts.

        Raises UserError for a shot that names something missing.
        """
        skeleton = redrawn(solution, self._last) if quick and self._last is not None else None
        if skeleton is None:
            skeleton = moving(solution)
            self._last = skeleton
        motion = to_motion(solution, parts, "", {}, sources)
        skeleton_data = moving_of(solution, skeleton)
        self._motion = motion, skeleton_data
        return payload(motion, skeleton_data, shot, arrows or not quick)

    def solid(self, parts: Parts, shot: Shot | None, folder: Path) -> bytes:
        """Return the bytes of the last motion's payload that show its parts. Raises UserError."""
        from render.film.film import Film
        from render.view.solid import with_parts

        assert self._motion is not None
        motion, skeleton_data = self._motion
        motion = with_rods(motion, parts)
        whole = with_parts(payload(motion, skeleton_data, shot), Film(motion, parts, shot or Shot(), folder))
        return encode({key: whole[key] for key in OF_PARTS}, compress=False)
