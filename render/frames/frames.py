"""The frames of a film: their keys, and the rendering of those that are missing."""

from __future__ import annotations

import math
import shutil
import time
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import msgspec

from render.blender.child import blender
from render.blender.job import Answer, Job, Picture, times_smaller
from render.film.film import Film
from render.film.inputs import blender_version, read_film, stage_key
from render.film.scene import Scene, State
from render.frames.keys import frame_key, hash_of, scene_key
from render.frames.plates import Plates, plates_of
from render.frames.store import FrameIndex, FrameStore, Timing
from render.presets import Preset
from shared.cluster.address import address
from shared.stage import jsonfile
from shared.stage.console import duration, progress, say, warn
from shared.stage.errors import UserError
from shared.stage.paths import Out, out_root
from shared.stage.stages import Stage

# Renders the pictures a film still lacks. A picture that is there already is not rendered again.

FEWEST_SAMPLES = 500_000
"""In one picture, for its time to say something about another size."""
ATTEMPTS = 3
RESERVE = 200e6
"""Bytes left free on the disk beside the frames."""


def run(name: str, preset: Preset, show: str = "") -> None:
    """Make every frame of the film in the store, and frames.json."""
    started = time.perf_counter()
    out = Out(name)
    store = FrameStore(out.frames(preset.name), (preset.width, preset.height))
    stage = Stage(out, f"frames-{preset.name}", stage_key(out, preset, show), [store.index])
    if stage.is_fresh():
        say("frames", f"{out.name}: {preset}: nothing to do")
        return
    film = read_film(out, show, preset.aspect)
    pictures = Pictures(film, preset)
    frames = range(film.clock.frames)
    say("frames", f"{out.name}: {film.clock.said()}")
    with store.locked():
        tally = Tally()
        try:
            for _ in range(ATTEMPTS):
                render(pictures, store, frames, f"{film.clock.total} frames in the film", tally)
                if all(store.find(pictures.key(frame)) for frame in frames):
                    break  # nothing was damaged while the others were rendered
        finally:
            tally.write(store, preset, time.perf_counter() - started)
        made = [picture_of(pictures, store, frame) for frame in frames]
        index = FrameIndex(
            mechanism=out.name,
            preset=preset.name,
            width=preset.width,
            height=preset.height,
            fps=film.shot.fps,
            frames=[path.name for path in made] * film.clock.showings,
        )
        jsonfile.write(store.index, index)
        store.prune(set(made), spare=len(set(made)))
        store.prune_plates(pictures.plates.plates)
    stage.outputs.extend(sorted(set(made)))
    stage.record()


def picture_of(pictures: Pictures, store: FrameStore, frame: int) -> Path:
    """Return the file of a rendered frame; raises UserError if something removed or changed it meanwhile."""
    path = store.find(pictures.key(frame))
    if path is None:
        raise UserError(
            f"{pictures.film.motion.mechanism}: the picture of frame {frame} went from {store.folder} while the others "
            "were rendered; run the same command again"
        )
    return path


@dataclass
class Tally:
    """Frames that a run made, and the seconds that Blender took."""

    device: str = ""
    rendered: int = 0
    cycles: float = 0.0

    def write(self, store: FrameStore, preset: Preset, wall: float) -> None:
        """Keep it in timing.json, unless this was but the rest of a longer run: Blender's start would dominate it.

        What a cluster made says nothing of this machine.
        """
        longer = store.read_timing()
        if not self.rendered or address() or (longer is not None and self.rendered < longer.rendered / 4):
            return
        timing = Timing(
            preset=preset.name,
            device=self.device,
            work=preset.work,
            rendered=self.rendered,
            wall=round(wall, 3),
            cycles=round(self.cycles, 3),
            overhead=round(wall / max(self.cycles, 1e-9), 4),
        )
        try:
            jsonfile.write(store.timing, timing)
        except UserError as error:  # the next forecast is all that it costs
            warn("frames", str(error))


@dataclass
class Pictures:
    """Frames of a film as keys and states, at one preset.

    Where the camera stands for long, its frames share a plate, unless each is to be ``whole``, as stills are.
    """

    film: Film
    preset: Preset
    whole: bool = False
    _states: dict[int, State] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.scene = scene_key(self.shown, self.preset, blender_version())

    @property
    def shown(self) -> Scene:
        """Scene that all frames share."""
        return self.film.scene

    @property
    def count(self) -> int:
        """Different frames."""
        return self.film.clock.frames

    def around(self, frame: int) -> tuple[int, int, int]:
        """Return the frame between those that its shutter sees."""
        return self.film.clock.around(frame)

    def state(self, frame: int) -> State:
        """Return the state a frame shows."""
        if frame not in self._states:
            self._states[frame] = self.film.state(frame)
        return self._states[frame]

    def key(self, frame: int) -> str:
        """Return the name of the picture a frame shows."""
        key = frame_key(self.scene, self._shutter(frame))
        which = self.plates.of_frame.get(frame % self.count)
        return key if which is None else hash_of([key, self.plates.plates[which].trial])[:32]

    @cached_property
    def plates(self) -> Plates:
        """The plates of the film."""
        look = self.shown.studio.look
        if self.whole or look.drawing is not None or not times_smaller(self.preset.width, self.preset.height):
            return Plates()
        return plates_of({frame: self._shutter(frame) for frame in range(self.count)}, self.scene)

    def _shutter(self, frame: int) -> list[State]:
        """Return the states that a frame shows: its own, or with both neighbours' where the shutter blurs them."""
        return [self.state(f) for f in (self.around(frame) if self.preset.motion_blur else (frame,))]

    def job(self, frames: Sequence[int], store: FrameStore) -> Job:
        """Return the work order for these frames; a blurred frame has its neighbours beside it on the timeline."""
        states: list[State] = []

        def placed(frame: int) -> int:
            shutter = self._shutter(frame)
            states.extend(shutter)
            return len(states) - 1 - len(shutter) // 2

        folder, of_frame = str(store.folder.resolve()), self.plates.of_frame
        pictures = [
            Picture(
                state=placed(frame), folder=folder, key=self.key(frame), name=f"frame {frame}",
                plate=of_frame.get(frame, -1),
            )
            for frame in frames
        ]  # fmt: skip
        needed = {picture.plate for picture in pictures}
        plates = [
            msgspec.structs.replace(plate, state=placed(plate.state) if which in needed else 0)
            for which, plate in enumerate(self.plates.plates)
        ]
        return Job(
            scene=self.shown,
            states=states,
            pictures=pictures,
            plates=plates,
            plates_folder=str(store.plates.resolve()),
            width=self.preset.width,
            height=self.preset.height,
            samples=self.preset.samples,
            motion_blur=self.preset.motion_blur,
        )


def render(pictures: Pictures, store: FrameStore, frames: Sequence[int], what: str, tally: Tally) -> None:
    """Render those of ``frames`` that the store lacks, with a forecast before and progress meanwhile.

    Interrupted, it leaves every finished picture, counted in ``tally``. Raises UserError if the disk has
    no room for them.
    """
    preset, name = pictures.preset, pictures.film.motion.mechanism
    by_key = {pictures.key(frame): frame for frame in reversed(frames)}
    missing = sorted(frame for key, frame in by_key.items() if store.find(key) is None)
    say("frames", f"{name}: {preset}: {len(missing)} of {len(by_key)} pictures to render, {what}")
    if not missing:
        return
    _refuse_full_disk(name, preset, store, len(missing))
    known = forecast(preset, store)
    if known is not None:
        each, source = known
        say("frames", f"{name}: forecast {duration(each * len(missing))} at {duration(each)} a frame, {source}")
    each, label = known[0] if known else 0.0, f"{name} {preset.name}"
    with _makers(pictures.job(missing, store), store, each) as answers, progress(label, len(missing)) as bar:
        for answer in answers:
            if answer.device:
                tally.device = answer.device
                say("frames", f"{name}: device: {answer.device}")
                continue
            if answer.note:
                say("frames", f"{name}: {answer.note}")
                continue
            if answer.plates:
                tally.cycles += answer.plates
                say("frames", f"{name}: {duration(answer.plates)} for the plate of what stands")
                continue
            tally.cycles += answer.cycles
            tally.rendered += 1
            if tally.rendered == 1 and known is None and len(missing) > 1:
                whole = duration(answer.cycles * (len(missing) - 1))
                say("frames", f"{name}: forecast {whole} more, from {answer.cycles:.1f} s for the first frame")
            bar.advance()


def _makers(job: Job, store: FrameStore, longest: float) -> AbstractContextManager[Iterator[Answer]]:
    """Return a Blender process here, or the workers of the CLUSTER."""
    if not address():
        return blender(job, longest)
    from render.frames import cluster

    return cluster.workers(job, store)


def forecast(preset: Preset, store: FrameStore) -> tuple[float, str] | None:
    """Return seconds a picture, and where the number is from; None if nothing comparable was rendered here yet.

    The last run of this preset counts, else the run nearest in size, scaled by samples. Below a certain size it is
    not the samples that take the time, so postage stamps do not count.
    """
    own = store.read_timing()
    if own is not None:
        return own.cycles / own.rendered, "as measured before"
    others = [FrameStore(path.parent).read_timing() for path in sorted(out_root().glob("*/frames/*/timing.json"))]
    known = [timing for timing in others if timing is not None and timing.work >= FEWEST_SAMPLES]
    if not known:
        return None
    nearest = min(known, key=lambda timing: abs(math.log(timing.work / preset.work)))
    return nearest.cycles / nearest.rendered * preset.work / nearest.work, f"scaled from {nearest.preset}"


def _refuse_full_disk(name: str, preset: Preset, store: FrameStore, count: int) -> None:
    """Raise UserError for a full disk: a PNG of the studio takes about 1.3 bytes a pixel, three at worst."""
    needed = 3.0 * preset.width * preset.height * count + RESERVE
    free = shutil.disk_usage(store.folder).free
    if free < needed:
        raise UserError(
            f"{name}: {count} pictures of {preset.name} may need {needed / 1e9:.1f} GB, {store.folder} has "
            f"{free / 1e9:.1f} GB free; free some space, take a smaller PRESET or set MBSD_OUT to another disk"
        )
