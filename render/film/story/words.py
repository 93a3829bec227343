"""Words of a story, and its subtitles."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

from render.film.story.frame import Caption
from shared.contract.quantity import figures
from shared.stage.errors import UserError, did_you_mean

# Words of a story, in the language that its shot asks for: a table, so that another language is another column.

TABLE: dict[str, dict[str, str]] = {
    "en": {
        "title": "Title",
        "assembly": "Assembly",
        "motion": "Motion",
        "macro": "Close up",
        "section": "Cut open",
        "reason": "Why",
        "last": "The machine",
        "compare": "Side by side",
        "frame": "frame",
        "together": "{count} pieces in {layers} layers; {mass} move.",
        "together_one": "One piece.",
        "lasts": "All of it takes {time}.",
        "joint": "Joint {name}",
        "cut_open": "Cut open: hatched faces are sawn through.",
        "stopped": "time stands still",
        "real": "real time",
        "about": "about real time",
        "slower": "{factor} times slower",
        "faster": "{factor} times faster",
        "usual": "as it is",
        "difference": "Here {curve} differs most: {first} ({a}), {second} ({b}).",
    },
    "de": {
        "title": "Titel",
        "assembly": "Zusammenbau",
        "motion": "Bewegung",
        "macro": "Aus der Nähe",
        "section": "Aufgeschnitten",
        "reason": "Warum",
        "last": "Die Maschine",
        "compare": "Nebeneinander",
        "frame": "Gestell",
        "together": "{count} Teile in {layers} Lagen; {mass} bewegen sich.",
        "together_one": "Ein Teil.",
        "lasts": "Alles zusammen dauert {time}.",
        "joint": "Gelenk {name}",
        "cut_open": "Aufgeschnitten: schraffiert ist, was durchgesägt ist.",
        "stopped": "die Zeit steht",
        "real": "Echtzeit",
        "about": "etwa Echtzeit",
        "slower": "{factor}-mal langsamer",
        "faster": "{factor}-mal schneller",
        "usual": "wie sie ist",
        "difference": "Hier unterscheidet sich {curve} am meisten: {first} ({a}), {second} ({b}).",
    },
}
"""Words by language, then by subject; every language says the same things with the same names in braces."""
SAME, ABOUT = 0.05, 0.2
"""Rates that differ from real time by less are real time, and about real time."""


def words_in(language: str, mechanism: str) -> Callable[..., str]:
    """Return ``say(key, name=...)`` in a language. Raises UserError for one that the table lacks."""
    if language not in TABLE:
        raise UserError(
            f"{mechanism}: shot.story.language is '{language}'; there is: {', '.join(TABLE)}"
            f"{did_you_mean(language, list(TABLE))}"
        )
    table = TABLE[language]

    def say(key: str, **names: str) -> str:
        return table[key].format(**names)

    return say


def rate_words(rate: float, say: Callable[..., str]) -> str:
    """Return how fast time passes, in one figure, in two below twice."""
    if rate <= 1e-6:
        return say("stopped")
    if abs(rate - 1) < SAME:
        return say("real")
    if abs(rate - 1) < ABOUT:
        return say("about")
    factor = 1 / rate if rate < 1 else rate
    return say("slower" if rate < 1 else "faster", factor=figures(factor, 1 if factor >= 2 else 2))


def plain(name: str) -> str:
    """Return a name as it is said: ``coupler_pin`` is coupler pin."""
    return name.replace("_", " ")


# Captions as a subtitle file (SubRip), written and read again, and chapters as ffmpeg reads them.

TIMES = re.compile(r"(\d+):(\d\d):(\d\d)[,.](\d{1,3})\s*-->\s*(\d+):(\d\d):(\d\d)[,.](\d{1,3})(?:\s.*)?")


def srt(captions: Sequence[Caption]) -> str:
    """Return a SubRip file: number, times, words, an empty line."""
    return "".join(
        f"{number}\n{_clock(caption.start)} --> {_clock(caption.end)}\n{caption.text}\n\n"
        for number, caption in enumerate(captions, 1)
    )


def captions_of(text: str) -> list[Caption]:
    """Return the captions of a SubRip file, also of one that another program has saved.

    Raises ValueError naming the words that stand where times should.
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
    """Return a time as ``00:01:02,345``."""
    whole = round(1000 * seconds)
    return f"{whole // 3600000:02d}:{whole // 60000 % 60:02d}:{whole // 1000 % 60:02d},{whole % 1000:03d}"


def _seconds(clock: Sequence[str]) -> float:
    hours, minutes, seconds, thousandths = clock
    whole = 3600 * int(hours) + 60 * int(minutes) + int(seconds)
    return (1000 * whole + int(thousandths.ljust(3, "0"))) / 1000


def chapters(rows: Sequence[tuple[float, float, str]], title: str = "") -> str:
    """Return the FFMETADATA1 of chapters (start and end in s, title)."""
    lines = [";FFMETADATA1", *([f"title={_escaped(title)}"] if title else [])]
    for start, end, name in rows:
        lines += ["[CHAPTER]", "TIMEBASE=1/1000", f"START={round(1000 * start)}", f"END={round(1000 * end)}"]
        lines.append(f"title={_escaped(name)}")
    return "\n".join(lines) + "\n"


def _escaped(words: str) -> str:
    return "".join(f"\\{letter}" if letter in "=;#\\\n" else letter for letter in words)
