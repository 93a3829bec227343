"""Short silent film on the wall: from the mechanism's film, else from its moving skeleton."""

from __future__ import annotations

from pathlib import Path

from render.frames.encode import run_ffmpeg
from render.frames.story.stage import film_of as story_of
from render.presets import PRESETS
from shared.stage.files import whole_file
from shared.stage.paths import Out

WIDTH, HEIGHT = 480, 270
SECONDS = 12.0
PATIENCE = 600.0
"""Seconds in which ffmpeg has to make a loop."""


def films_of(out: Out) -> list[Path]:
    """Return the existing loops, the finest preset first."""
    return [path for preset in reversed(list(PRESETS)) if (path := out.film(preset)).is_file()]


def page_films(out: Out) -> list[Path]:
    """Return films for a mechanism's own page, the best first: of each preset the story, the loop."""
    films = (path for preset in reversed(list(PRESETS)) for path in (story_of(out, preset), out.film(preset)))
    return [path for path in films if path.is_file()]


def write_loop(film: Path, target: Path) -> None:
    """Write a film in the size of a tile, without sound, cut after SECONDS.

    The same film gives the same bytes.

    Raises UserError.
    """
    fitted = f"scale={WIDTH}:{HEIGHT}:force_original_aspect_ratio=increase,crop={WIDTH}:{HEIGHT},format=yuv420p"
    options = (
        *("-t", f"{SECONDS:g}", "-an", "-sn", "-vf", fitted, "-r", "30"),
        *("-c:v", "libx264", "-preset", "slow", "-crf", "30", "-threads", "1", "-movflags", "+faststart"),
        *("-map_metadata", "-1", "-map_chapters", "-1", "-fflags", "+bitexact", "-flags:v", "+bitexact", "-f", "mp4"),
    )
    _run(film, target, options)


def write_still(film: Path, target: Path) -> None:
    """Write a picture of a film after a third of a second, as a JPEG twice a tile's size.

    Raises UserError.
    """
    fitted = f"scale={2 * WIDTH}:{2 * HEIGHT}:force_original_aspect_ratio=increase,crop={2 * WIDTH}:{2 * HEIGHT}"
    _run(film, target, ("-ss", "0.3", "-frames:v", "1", "-vf", fitted, "-q:v", "4", "-f", "mjpeg"))


def _run(film: Path, target: Path, options: tuple[str, ...]) -> None:
    with whole_file(target) as part:
        run_ffmpeg(film.name, "-i", str(film), *options, str(part), patience=PATIENCE)
