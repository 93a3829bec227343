"""Captions as a subtitle file (SubRip), and chapters as ffmpeg reads them."""

from __future__ import annotations

from collections.abc import Sequence

from render.film.story.frame import Caption


def srt(captions: Sequence[Caption]) -> str:
    """A SubRip file: number, times, words, an empty line."""
    return "".join(
        f"{number}\n{_clock(caption.start)} --> {_clock(caption.end)}\n{caption.text}\n\n"
        for number, caption in enumerate(captions, 1)
    )


def _clock(seconds: float) -> str:
    """``00:01:02,345``."""
    whole = round(1000 * seconds)
    return f"{whole // 3600000:02d}:{whole // 60000 % 60:02d}:{whole // 1000 % 60:02d},{whole % 1000:03d}"


def chapters(rows: Sequence[tuple[float, float, str]], title: str = "") -> str:
    """FFMETADATA1 of chapters (start and end in s, title)."""
    lines = [";FFMETADATA1", *([f"title={_escaped(title)}"] if title else [])]
    for start, end, name in rows:
        lines += ["[CHAPTER]", "TIMEBASE=1/1000", f"START={round(1000 * start)}", f"END={round(1000 * end)}"]
        lines.append(f"title={_escaped(name)}")
    return "\n".join(lines) + "\n"


def _escaped(words: str) -> str:
    return "".join(f"\\{letter}" if letter in "=;#\\\n" else letter for letter in words)
