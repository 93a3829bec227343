"""Captions as a subtitle file (SubRip), written and read again, and chapters as ffmpeg reads them."""

from __future__ import annotations

import re
from collections.abc import Sequence

from render.film.story.frame import Caption

TIMES = re.compile(r"(\d+):(\d\d):(\d\d)[,.](\d{1,3})\s*-->\s*(\d+):(\d\d):(\d\d)[,.](\d{1,3})(?:\s.*)?")


def srt(captions: Sequence[Caption]) -> str:
    """A SubRip file: number, times, words, an empty line."""
    return "".join(
        f"{number}\n{_clock(caption.start)} --> {_clock(caption.end)}\n{caption.text}\n\n"
        for number, caption in enumerate(captions, 1)
    )


def captions_of(text: str) -> list[Caption]:
    """The captions of a SubRip file, also of one that another program has saved. Raises ValueError naming the words
    that stand where times should.
    """
    captions = []
    for block in re.split(r"\n\s*\n", text.lstrip("\ufeff").replace("\r\n", "\n").strip()):
        lines = [line.strip() for line in block.split("\n") if line.strip()]
        if not lines:
            continue
        number = 1 if lines[0].isdecimal() else 0
        times = TIMES.fullmatch(lines[number]) if number < len(lines) else None
        if times is None:
            raise ValueError(f"no times such as 00:00:01,000 --> 00:00:02,000 in '{' '.join(lines)[:60]}'")
        words = "\n".join(lines[number + 1 :])
        if words:
            captions.append(Caption(_seconds(times.groups()[:4]), _seconds(times.groups()[4:]), words))
    return captions


def _clock(seconds: float) -> str:
    """``00:01:02,345``."""
    whole = round(1000 * seconds)
    return f"{whole // 3600000:02d}:{whole // 60000 % 60:02d}:{whole // 1000 % 60:02d},{whole % 1000:03d}"


def _seconds(clock: Sequence[str]) -> float:
    hours, minutes, seconds, thousandths = clock
    whole = 3600 * int(hours) + 60 * int(minutes) + int(seconds)
    return (1000 * whole + int(thousandths.ljust(3, "0"))) / 1000


def chapters(rows: Sequence[tuple[float, float, str]], title: str = "") -> str:
    """FFMETADATA1 of chapters (start and end in s, title)."""
    lines = [";FFMETADATA1", *([f"title={_escaped(title)}"] if title else [])]
    for start, end, name in rows:
        lines += ["[CHAPTER]", "TIMEBASE=1/1000", f"START={round(1000 * start)}", f"END={round(1000 * end)}"]
        lines.append(f"title={_escaped(name)}")
    return "\n".join(lines) + "\n"


def _escaped(words: str) -> str:
    return "".join(f"\\{letter}" if letter in "=;#\\\n" else letter for letter in words)
