"""Pictures and sound as one file: the pictures' packets as they are, the sound as AAC, and the same bytes each time."""

from __future__ import annotations

import subprocess
from pathlib import Path

from render.blender.patience import Patience
from render.frames.encode import ffmpeg
from render.frames.film_file import refuse_other_than
from render.presets import Preset
from shared.stage.console import duration
from shared.stage.errors import UserError
from shared.stage.files import whole_file
from shared.stage.signals import terminable

AAC = ("-c:a", "aac", "-b:a", "192k", "-ar", "48000", "-ac", "2", "-flags:a", "+bitexact")
SETTINGS = (
    *("-map", "0:v:0", "-map", "1:a:0", "-c:v", "copy"),
    *AAC,
    *("-movflags", "+faststart", "-map_metadata", "0", "-map_chapters", "0", "-fflags", "+bitexact"),
)


def mux(pictures: Path, sound: Path, count: int, preset: Preset, fps: int, film: Path) -> None:
    """Write ``film`` whole from the silent film ``pictures`` and a WAV file of the same length.

    Raises UserError if ffmpeg is missing, fails or hangs, or if the film has not each of ``count`` frames.
    """
    limit = Patience(pictures=1).limit("") * max(1.0, preset.width * preset.height / 1e6) * (1 + count / 100)
    with terminable(), whole_file(film) as target:
        command = [ffmpeg(), "-y", "-loglevel", "error", "-i", str(pictures), "-i", str(sound), *SETTINGS, str(target)]
        try:
            done = subprocess.run(
                command, stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace", timeout=limit
            )
        except subprocess.TimeoutExpired:
            raise UserError(
                f"{film.name}: ffmpeg was stopped after {duration(limit)}, pictures and sound not joined; run it again"
            ) from None
        if done.returncode:
            said = (done.stderr.strip().splitlines() or [f"code {done.returncode}"])[-1]
            raise UserError(f"{film.name}: ffmpeg could not join pictures and sound: {said}; SOUND=off films without")
        refuse_other_than(target, film.name, ffmpeg(), count, preset, fps, limit)
