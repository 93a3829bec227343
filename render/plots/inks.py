"""Which colour a curve has: that of the body it belongs to, as in every other picture (data.json)."""

from __future__ import annotations

from collections.abc import Sequence

from render.plots.style import INK, PALETTE, PARTS
from shared.contract import Motion


def ink_of(motion: Motion, bodies: Sequence[str]) -> str:
    """The colour of the last of these bodies that moves: the one that a joint, driver or force acts on."""
    moving = [body for body in bodies if body in motion.bodies]
    return motion.bodies[moving[-1]].colour if moving else INK


def acting_on(motion: Motion, name: str) -> str:
    """The colour of the body that the force ``name`` acts on."""
    return ink_of(motion, [action.body for action in motion.forces[name].actions])


def apart(inks: Sequence[str]) -> list[str]:
    """Return these colours, each once: what comes after another of the same colour gets one that nothing has yet.

    Where there are no more, colours repeat.
    """
    free = [ink for ink in (*PARTS, *PALETTE) if ink not in inks]
    out: list[str] = []
    for ink in inks:
        out.append(free.pop(0) if ink in out and free else ink)
    return out
