"""The exploded view as a picture: out/<mechanism>/exploded.png, that of the story's assembly with names and masses."""

from __future__ import annotations

import io
import time

from render.film.inputs import named, stage_key
from render.frames.story.stage import word_sources
from render.presets import Preset
from shared.stage.console import say
from shared.stage.errors import UserError
from shared.stage.files import write_bytes
from shared.stage.paths import Out
from shared.stage.stages import Stage

WORD = "exploded"


def run(name: str, preset: Preset) -> None:
    """Make the picture. Raises UserError for a machine whose parts lie in one layer."""
    out = Out(name)
    target = named(out.folder / f"{WORD}.png", "", preset.suffix)
    stage = Stage(out, target.stem, stage_key(out, preset.of_poster, WORD, word_sources()), [target])
    if stage.is_fresh():
        say(WORD, f"{out.name}: {preset}: nothing to do")
        return
    from PIL import Image

    from render.film.pieces import exploded
    from render.frames import frames
    from render.frames.store import FrameStore
    from render.frames.story.telling import StoryPictures, telling_of
    from shared.contract import read_parts

    if not any(lift.distance for lift in exploded(read_parts(out.parts, out.name), 1.0)):
        raise UserError(f"{out.name}: all its parts lie in one layer, so nothing can be taken apart")
    started, fine = time.perf_counter(), preset.of_poster
    telling = telling_of(out, preset, shots=("assembly",))
    story = telling.story
    heights = [sum(height for _, height in story.picture(frame).lifts) for frame in range(story.total)]
    apart = [frame for frame, height in enumerate(heights) if height == max(heights)]
    frame = apart[len(apart) // 2]
    picture = story.picture(frame)
    pictures = StoryPictures(telling.film, fine, rows=((picture, picture, picture),), what="taken apart")
    store, tally = FrameStore(out.frames(f"{fine.name}-story"), (fine.width, fine.height)), frames.Tally()
    with store.locked():
        frames.render(pictures, store, [0], pictures.what, tally)
        tally.write(store, fine, time.perf_counter() - started)
        content = frames.picture_of(pictures, store, 0).read_bytes()
    with Image.open(io.BytesIO(content)) as rendered:
        page = telling.drawing.frame(rendered.convert("RGB"), story.over(frame))
    buffer = io.BytesIO()
    page.save(buffer, format="PNG", optimize=True)
    write_bytes(target, buffer.getvalue())
    stage.record()
    say(WORD, f"{out.name}: {target}")
