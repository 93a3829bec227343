"""Kinds of films: the loop of every day, or a story."""

from __future__ import annotations

from render.presets import Preset
from shared.stage.errors import UserError, did_you_mean

KINDS = ("loop", "explain", "compare")
SHORTEST, LONGEST = 4.0, 60.0
"""Seconds of LOOP."""


def run(name: str, preset: Preset, show: str = "", story: str = "loop", loop: float = 0.0, sound: str = "") -> None:
    """Make the film of a kind. Raises UserError for one that is none, and for a LOOP that nobody would watch."""
    if story not in KINDS:
        raise UserError(f"there is no STORY={story}; there is: {', '.join(KINDS)}{did_you_mean(story, KINDS)}")
    if loop and story == "compare":
        raise UserError("STORY=compare has no LOOP; leave one of them out")
    if loop and not SHORTEST <= loop <= LONGEST:
        raise UserError(f"LOOP={loop:g} is no length of a loop; give {SHORTEST:g} to {LONGEST:g} s")
    if story == "loop" and not loop:
        from render.frames import film

        film.run(name, preset, show, sound)
        return
    if story == "compare":
        from render.frames.story import comparison

        comparison.run(name, preset, sound)
        return
    from render.frames.story import stage

    stage.run(name, preset, show, loop, sound)
