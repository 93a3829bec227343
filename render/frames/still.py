"""Stills: one frame, the poster, and the contact sheet."""

from __future__ import annotations

import io
import math
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from render.film.inputs import named, stage_key
from render.letters import font_of, width_of
from render.presets import Preset
from shared.stage.console import say
from shared.stage.errors import UserError
from shared.stage.files import write_bytes
from shared.stage.paths import Out
from shared.stage.stages import Stage

if TYPE_CHECKING:
    from render.film.film import Film


# One frame of the film as a picture: any frame as a still, the shot's best moment as the poster.


def still(name: str, preset: Preset, frame: int, show: str = "") -> None:
    """Make out/<mechanism>/stills/<preset>-<frame>.png. Raises UserError if the film has no such frame."""
    out = Out(name)
    target = named(out.stills / f"{preset.name}-{frame:04d}.png", show)
    stage = Stage(out, f"still-{target.stem}", stage_key(out, preset, frame, show), [target])
    _make(out, preset, frame, target, stage, show)


def poster(name: str, preset: Preset, show: str = "") -> None:
    """Make out/<mechanism>/poster.png: the moment that ``shot.poster`` names, with the samples of a poster."""
    out = Out(name)
    stage = _poster(out, preset, show)
    _make(out, preset.of_poster, None, stage.outputs[0], stage, show)


def is_fresh_poster(name: str, preset: Preset, show: str = "") -> bool:
    """Return True if there is nothing to do. Raises UserError where motion, parts or shot are missing."""
    return _poster(Out(name), preset, show).is_fresh()


def _poster(out: Out, preset: Preset, show: str) -> Stage:
    target = named(out.poster, show, preset.suffix)
    return Stage(out, target.stem, stage_key(out, preset.of_poster, show), [target])


def _make(out: Out, preset: Preset, frame: int | None, target: Path, stage: Stage, show: str) -> None:
    """Make a still through the store of frames, rendered whole; it is kept there for the next time."""
    word = "poster" if frame is None else "still"
    if stage.is_fresh():
        say(word, f"{out.name}: {preset}: nothing to do")
        return
    from render.film.inputs import read_film
    from render.frames import frames
    from render.frames.store import FrameStore

    started = time.perf_counter()
    film = read_film(out, show, preset.aspect)
    clock = film.clock
    if frame is None:
        frame = clock.frame_at(film.shot.poster)
    elif not 0 <= frame < clock.total:
        raise UserError(
            f"{out.name}: there is no frame {frame}; the film has frames 0 to {clock.total - 1} "
            f"(the motion {clock.showings} times, {clock.frames} frames each)"
        )
    frame %= clock.frames
    pictures = frames.Pictures(film, preset, whole=True)
    store = FrameStore(out.frames(preset.name), (preset.width, preset.height))
    tally = frames.Tally()
    with store.locked():
        frames.render(pictures, store, [frame], f"frame {frame}", tally)
        tally.write(store, preset, time.perf_counter() - started)  # it tells what the film will take
        write_bytes(target, frames.picture_of(pictures, store, frame).read_bytes())
    stage.record()
    say(word, f"{out.name}: {target}")


# A contact sheet: twelve frames of the film, from the start of the motion to its end, on one picture.

NUMBER = 12
"""Frames on the sheet."""
WIDTH, HEIGHT = 480, 480
"""Most pixels of a frame on the sheet."""
GAP = 10
HEAD, FOOT = 46, 26
"""Over all frames, with the title, and under each, with its time: nothing is written over a picture."""
PAPER, INK = (250, 250, 251), (32, 37, 43)


def run(name: str, preset: Preset, show: str = "") -> None:
    """Make out/<mechanism>/contact.png; frames that the film has are not rendered again."""
    out = Out(name)
    target = named(out.contact, show, preset.suffix)
    stage = Stage(out, target.stem, stage_key(out, preset, show), [target])
    if stage.is_fresh():
        say("contact", f"{out.name}: {preset}: nothing to do")
        return
    from render.film.inputs import read_film
    from render.frames import frames
    from render.frames.store import FrameStore

    film = read_film(out, show, preset.aspect)
    chosen = frames_of(film)
    pictures, store = frames.Pictures(film, preset), FrameStore(out.frames(preset.name), (preset.width, preset.height))
    with store.locked():
        frames.render(pictures, store, sorted(set(chosen)), "for the contact sheet", frames.Tally())
        frames_shown = [frames.picture_of(pictures, store, frame) for frame in chosen]
        write_bytes(target, sheet(frames_shown, _captions(film, chosen), out.name.replace("_", " ").replace("-", ": ")))
    stage.record()
    say("contact", f"{out.name}: {target}")


def frames_of(film: Film) -> list[int]:
    """Return twelve frames in equal steps: of a motion that repeats over one period, of another until it ends.

    Where a period has several turns of the drivers, each step is a little longer, so that no turn is shown as another.
    """
    import numpy as np  # a poster that is there needs none

    count, number = film.clock.moving, NUMBER
    if film.clock.repeats:
        count = count * (number + 1) / number if film.clock.turns > 1 else count
        return [int(frame) for frame in np.arange(number) * count / number]
    return [int(frame) for frame in np.linspace(0, count, number).round()]


def columns(aspect: float) -> int:
    """Return the number of columns of a sheet of frames with that width over height: the sheet is about as wide as a
    screen.
    """
    return 4 if aspect > 1.2 else 6


def sheet(pictures: list[Path], captions: list[str], title: str) -> bytes:
    """Return a PNG of frames in rows, each with its words under it."""
    from PIL import Image, ImageDraw

    with Image.open(pictures[0]) as first:
        part = min(1.0, WIDTH / first.width, HEIGHT / first.height)
        wide, high = round(part * first.width), round(part * first.height)
        across = columns(first.width / first.height)
    down = math.ceil(len(pictures) / across)
    size = (across * (wide + GAP) + GAP, HEAD + down * (high + FOOT))
    page = Image.new("RGB", size, PAPER)
    draw = ImageDraw.Draw(page)
    font, large = font_of(_fitting(captions, wide)), font_of(20.0, bold=True)
    draw.text((GAP + 4, HEAD // 2), title[:1].upper() + title[1:], fill=INK, font=large, anchor="lm")
    for k, (path, words) in enumerate(zip(pictures, captions, strict=True)):
        left, top = GAP + k % across * (wide + GAP), HEAD + k // across * (high + FOOT)
        with Image.open(path) as picture:
            page.paste(picture.convert("RGB").resize((wide, high), Image.Resampling.LANCZOS), (left, top))
        draw.text((left + 2, top + high + FOOT // 2), words, fill=INK, font=font, anchor="lm")
    return _png(page)


def _fitting(captions: list[str], wide: int) -> float:
    """Return the size of letters with which no time is wider than its frame."""
    return min(14.0, 0.9 * wide / max(width_of(words) for words in captions))


def _captions(film: Film, frames: list[int]) -> list[str]:
    """Return times in as many decimals as tell the frames apart."""
    times = [film.clock.moment(frame).time for frame in frames]
    decimals = max(0, math.ceil(1 - math.log10(max(max(times) - min(times), 1e-9) / len(times))))
    return [f"{time:.{min(decimals, 9)}f} s" for time in times]


def _png(page: Any) -> bytes:
    buffer = io.BytesIO()
    page.save(buffer, format="PNG", optimize=True)
    return buffer.getvalue()
