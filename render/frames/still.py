"""One frame of the film as a picture: any frame as a still, the shot's best moment as the poster."""

from __future__ import annotations

import time
from pathlib import Path

from render.film.inputs import named, stage_key
from render.presets import Preset
from shared.stage.console import say
from shared.stage.errors import UserError
from shared.stage.files import write_bytes
from shared.stage.paths import Out
from shared.stage.stages import Stage


def still(name: str, preset: Preset, frame: int, show: str = "") -> None:
    """out/<mechanism>/stills/<preset>-<frame>.png; raises UserError if the film has no such frame."""
    out = Out(name)
    target = named(out.stills / f"{preset.name}-{frame:04d}.png", show)
    stage = Stage(out, f"still-{target.stem}", stage_key(out, preset, frame, show), [target])
    _make(out, preset, frame, target, stage, show)


def poster(name: str, preset: Preset, show: str = "") -> None:
    """out/<mechanism>/poster.png: the moment that ``shot.poster`` names, with the samples of a poster."""
    out = Out(name)
    stage = _poster(out, preset, show)
    _make(out, preset.of_poster, None, stage.outputs[0], stage, show)


def is_fresh_poster(name: str, preset: Preset, show: str = "") -> bool:
    """Whether there is nothing to do. Raises UserError where motion, parts or shot are missing."""
    return _poster(Out(name), preset, show).is_fresh()


def _poster(out: Out, preset: Preset, show: str) -> Stage:
    target = named(out.poster, show, preset.suffix)
    return Stage(out, target.stem, stage_key(out, preset.of_poster, show), [target])


def _make(out: Out, preset: Preset, frame: int | None, target: Path, stage: Stage, show: str) -> None:
    """Through a store of frames: a still that the film has shows at once, and the film finds the still."""
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
    pictures = frames.Pictures(film, preset)
    store = FrameStore(out.frames(preset.name), (preset.width, preset.height))
    tally = frames.Tally()
    with store.locked():
        frames.render(pictures, store, [frame], f"frame {frame}", tally)
        tally.write(store, preset, time.perf_counter() - started)  # it tells what the film will take
        write_bytes(target, frames.picture_of(pictures, store, frame).read_bytes())
    stage.done()
    say(word, f"{out.name}: {target}")
