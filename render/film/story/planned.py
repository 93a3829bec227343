"""Choice of a story's shots and seconds, so that it costs little more than the loop film."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from render.film.film import Film
from render.film.story.frame import Shot
from render.film.story.scenery import Scenery
from render.film.story.shots.assembly import assembly
from render.film.story.shots.close_ups import macro, section
from render.film.story.shots.motion import last, motion, title
from render.film.story.shots.reason import loop, reason
from render.film.story.story import Story, curves_of
from render.film.story.words import words_in
from render.insights import Insight
from render.insights.stops import words_of
from render.presets import Preset
from shared.contract.shot import STORY_SHOTS
from shared.stage.errors import UserError, did_you_mean

BUDGET = 2.2
"""Pictures of a story beside those of the loop film; starting Blender twice takes the rest up to 2.5."""
SHORTEST = 3.2
"""Seconds of the shortest loop film that counts for that: a story of fewer pictures would stand still."""
SCALES = (1.0, 0.85, 0.75, 0.65, 0.55, 0.47, 0.4, 0.32, 0.25, 0.18, 0.12)
"""Parts of the seconds of moves, where the camera does not turn while the machine is shown; the first that fits."""
ARROWED = 2.6
"""Cost of a picture with arrows, which are rendered apart, in pictures without."""
TWOS = ("draft", "preview")
"""Presets that move on twos."""
BLUR = {"draft": 9.0, "preview": 11.0}
SHALLOW = 13.0
"""Lens blur of a macro by preset, and of all others, in pixels of a picture 1280 wide."""


def planned(
    film: Film, forces: Film | None, reasons: Sequence[Insight], preset: Preset, seconds: float = 0.0,
    cut: Film | None = None, shows: Sequence[Insight] = (),
) -> Story:  # fmt: skip
    """Return the story of a film.

    ``forces`` is the same with arrows, None where nothing has any, ``cut`` the same cut open, None of a shot without a
    section; time stops for the first of ``reasons``, unless the shot asks for another, and ``shows`` is all that the
    motion shows. With ``seconds`` it is a loop of
    that length.

    Raises UserError with place and remedy for wishes of the shot that cannot be.
    """
    scenery = replace(scenery_of(film, forces, reasons, preset), cut=cut, shows=shows)
    if seconds:
        return _assemble(scenery, [loop(scenery, seconds)])
    loop_frames = max(min(film.clock.frames, film.clock.moving + 1), SHORTEST * film.shot.fps)
    most = BUDGET * loop_frames * (2 / scenery.step)
    story = _story(scenery)
    if _cost(story) <= most:
        return story
    first, last = 0, len(SCALES) - 1
    stories: dict[int, Story] = {}
    while first <= last:  # the cost falls with the scale
        k = (first + last) // 2
        stories[k] = _story(replace(scenery, turning=False, scale=SCALES[k]))
        first, last = (first, k - 1) if _cost(stories[k]) <= most else (k + 1, last)
    return stories[min(first, len(SCALES) - 1)]


def scenery_of(film: Film, forces: Film | None, reasons: Sequence[Insight], preset: Preset) -> Scenery:
    """Return the scenery that the shots share. Raises UserError for an unknown event or language."""
    wishes, mechanism = film.shot.story, film.motion.mechanism
    base = preset.name.partition("-")[0]
    reasons = _wished_first(mechanism, wishes.event, reasons)
    return Scenery(
        film=film,
        forces=forces,
        wishes=wishes,
        reasons=reasons,
        curves=curves_of(film.motion, wishes.curves, reasons),
        say=words_in(wishes.language, mechanism),
        step=2 if base in TWOS else 1,
        blur=BLUR.get(base, SHALLOW),
    )


def _cost(story: Story) -> float:
    """Return the cost of a story's pictures, in pictures without arrows."""
    return sum(ARROWED if picture.grown else 1.0 for picture in story.pictures)


def _story(scenery: Scenery) -> Story:
    names = scenery.wishes.shots or STORY_SHOTS
    made: list[Shot | None] = []
    for name in reversed(names):  # a title shows the first picture of what follows
        after = next((shot for shot in reversed(made) if shot is not None), None)
        made.append(title(scenery, after) if name == "title" else SHOTS[name](scenery))
    shots = [shot for shot in reversed(made) if shot is not None]
    if not shots:
        raise UserError(
            f"{scenery.film.motion.mechanism}: shot.story.shots = {', '.join(names)} leaves nothing to show: the "
            "machine has no such shots, and a title stands before another shot; add motion or last"
        )
    return _assemble(scenery, shots)


def _assemble(scenery: Scenery, shots: Sequence[Shot]) -> Story:
    mechanism, fps, step = scenery.film.motion.mechanism, scenery.fps, scenery.step
    return Story(mechanism, fps, step, shots, scenery.curves, scenery.at_side)


SHOTS: dict[str, Callable[[Scenery], Shot | None]] = {
    "assembly": assembly,
    "motion": motion,
    "macro": macro,
    "section": section,
    "reason": reason,
    "last": last,
}
"""Shots by the names that a shot.py gives; the title needs what follows it."""


def _wished_first(mechanism: str, event: str | None, reasons: Sequence[Insight]) -> list[Insight]:
    """Return the reasons, that of the shot's ``event`` first.

    Raises UserError if nothing like it ever happens.
    """
    if event is None:
        return list(reasons)
    for reason_ in reasons:
        if event in words_of(reason_):
            return [reason_, *(other for other in reasons if other is not reason_)]
    known = list(dict.fromkeys(words for other in reasons for words in words_of(other)))
    raise UserError(
        f"{mechanism}: shot.story.event names '{event}', which never happens in this motion; its events are: "
        f"{', '.join(known) or 'nothing'}{did_you_mean(event, known)}"
    )
