"""The subtitles of a showreel: those of its films, each later by where its film begins."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from render.film.story.frame import Caption
from render.film.story.subtitles import captions_of, srt
from render.showreel.clip import Clip
from shared.stage.errors import UserError
from shared.stage.files import write_bytes


def write_subtitles(films: Sequence[Path], chapters: Sequence[Sequence[Clip]], fps: int, target: Path) -> bool:
    """Write the captions of ``films``, each the last clip of its chapter, as a SubRip file; False, and no file, where
    none of them has any.
    """
    captions: list[Caption] = []
    frames = 0
    for film, clips in zip(films, chapters, strict=True):
        frames += sum(clip.frames for clip in clips)
        end, long = frames / fps, clips[-1].frames / fps
        captions += [
            Caption(end - long + caption.start, min(end - long + caption.end, end), caption.text)
            for caption in captions_beside(film)
            if caption.start < long
        ]
    if not captions:
        target.unlink(missing_ok=True)
        return False
    write_bytes(target, srt(captions).encode())
    return True


def captions_beside(film: Path) -> list[Caption]:
    """The captions of the subtitle file beside a film; none where there is no such file.

    Raises UserError for a file that is not SubRip.
    """
    path = film.with_suffix(".srt")
    if not path.is_file():
        return []
    try:
        return captions_of(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise UserError(f"{path} is not a subtitle file ({error}); remove it and make the film again") from error
