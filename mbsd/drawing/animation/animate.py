"""``sol.animate(path)``: checks a request, draws it picture by picture and encodes it."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

from mbsd.base.arguments import finite_number, users_progress
from mbsd.base.errors import ModelError
from mbsd.base.names import no_such, shown
from mbsd.drawing.animation.clip import HOLD, clip_of
from mbsd.drawing.animation.encoders import ffmpeg, held, write_gif, write_mp4
from mbsd.drawing.animation.page import Page
from mbsd.drawing.animation.scene import scene_of
from mbsd.drawing.animation.words import EVERYTHING, QUANTITIES
from mbsd.drawing.look import literal
from mbsd.pictures import Animation
from mbsd.results.solution import Solution

SUFFIXES = (".mp4", ".gif")
SIZE = {".mp4": (1280, 720), ".gif": (800, 450)}
SMALLEST, LARGEST = 120, 4096
LONG_ENOUGH = 6.0
"""Seconds that an MP4 of a motion that repeats lasts at least, by whole rounds."""


@literal
def animate(
    sol: Solution,
    path: str | os.PathLike[str],
    show: str | Sequence[str],
    rate: float | None = None,
    fps: float = 30.0,
    size: tuple[int, int] | None = None,
    names: bool | str = True,
    progress: Callable[[int, int], object] | None = None,
    inks: Mapping[str, str] | None = None,
) -> Animation:
    """Write the animation of :meth:`mbsd.results.solution.Solution.animate`.

    ``inks``: ``#rrggbb`` of bodies instead of those by role.
    """
    name = f"{sol.mechanism.name}: animate"
    target, suffix = _target(name, path)
    groups = _groups(name, show)
    wide, high = _size(name, SIZE[suffix] if size is None else size, suffix)
    if rate is not None and not finite_number(f"{name}: rate", rate) > 0:
        raise ModelError(f"{name}: rate is {rate:g}; it must be positive: 1 is real time, 0.1 ten times slower")
    fps = finite_number(f"{name}: fps", fps)
    if not 1.0 <= fps <= 120.0:
        raise ModelError(f"{name}: fps is {fps:g}; a film has 1 .. 120 pictures a second")
    if not isinstance(names, bool) and not (isinstance(names, str) and names == "all"):
        raise ModelError(f"{name}: names is {shown(names)}; it must be True (three that matter), False or 'all'")
    progress = users_progress(f"{name}: progress", progress, "the pictures drawn, and of all", 2)
    try:
        import matplotlib.figure  # noqa: F401
    except ImportError as error:
        raise ModelError("an animation needs matplotlib: install mbsd[animate]") from error
    if suffix == ".mp4":
        ffmpeg()  # reported now, not after the last picture
    else:
        fps = 100.0 / max(2, round(100.0 / fps))  # its times are hundredths of a second; most viewers slow down below 2
    clip = clip_of(sol, rate, fps)
    page = Page(sol, scene_of(sol, clip, inks), groups, (wide, high), names)
    count = len(clip.times)

    def pictures() -> Iterator[np.ndarray]:
        for k in range(count):
            yield page.picture(k)
            if progress is not None:
                progress(k + 1, count)

    if suffix == ".gif":
        write_gif(target, pictures(), count, fps, 0.0 if clip.repeats else HOLD)
    else:
        rounds = max(1, round(LONG_ENOUGH * fps / count)) if clip.repeats else 1
        still = 0 if clip.repeats else round(HOLD * fps)
        write_mp4(target, held(pictures(), still), (wide, high), fps, rounds)
    return Animation(target, count, clip.seconds, clip.rate)


def _target(name: str, path: object) -> tuple[Path, str]:
    if not isinstance(path, str | os.PathLike):
        raise ModelError(f"{name}: path is {shown(path)}; it must be a text or a path")
    target = Path(os.fspath(path))
    suffix = target.suffix.lower()
    if suffix not in SUFFIXES:
        raise ModelError(f"{name}: {target} ends with {suffix or 'nothing'}; an animation is an .mp4 or a .gif")
    return target, suffix


def _groups(name: str, show: object) -> tuple[tuple[str, ...], ...]:
    """Return the words of each panel."""
    if isinstance(show, str) and show == "all":
        return EVERYTHING
    words: list[str] = [show] if isinstance(show, str) else []
    for word in show if isinstance(show, list | tuple) else [show]:
        if not isinstance(word, str) or word not in QUANTITIES:
            raise ModelError(f"{name}: show: {no_such('quantity', word, [*QUANTITIES, 'all'])}")
        words.append(word)
    return (tuple(dict.fromkeys(words)),)


def _size(name: str, size: object, suffix: str) -> tuple[int, int]:
    even = "even " if suffix == ".mp4" else ""
    if isinstance(size, tuple | list) and len(size) == 2:
        wide, high = size
        whole = all(isinstance(side, int) and not isinstance(side, bool) for side in size)
        if whole and all(SMALLEST <= side <= LARGEST and not (even and side % 2) for side in size):
            return wide, high
    raise ModelError(
        f"{name}: size is {shown(size)}; it must be two {even}whole numbers of pixels, {SMALLEST} .. {LARGEST}: "
        "size=(1280, 720)"
    )
