"""Plates in Blender: what stands is rendered once, and each frame only where it differs.

A plate is kept as a file beside the frames. So is the judgement of the frame that tries it: whether regions pay, and
whether a frame that was put together is the one that was rendered whole. Both are named by what they depend on.
"""

from __future__ import annotations

import io
import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
import numpy as np

from render.blender.job import Plate, times_smaller
from render.blender.picture_file import name_of
from render.blender.regions.passes import Small, read_light, read_small
from render.blender.regions.regions import Change, Rect, change_of, cost, fault_of, joined, rectangles
from render.blender.scene import stencil
from render.blender.scene.built_scene import BuiltScene
from shared.stage.errors import UserError
from shared.stage.files import refusal, write_bytes

# pyright: reportAttributeAccessIssue=false
# bpy fills itself in when it is imported, its stubs are empty.

Array = np.ndarray
RICHER = 4
"""Samples of a plate, in those of a frame."""
FEWER, FEWEST = 4, 4
"""Samples of a frame in those of its small picture, which has at least so many."""
RAYS = ("visible_camera", "visible_diffuse", "visible_glossy", "visible_transmission", "visible_shadow")
"""All kinds that a studio without mist has."""
NUDGE = 0.25
"""Pixels by which borders are moved: Blender cuts off what is left of a pixel, and keeps them in 32 bits."""
LAUNCH = 30_000.0
"""Samples that take as long as the start of a render."""
WORTH = 0.8
"""Cost of a frame's regions, in parts of the whole frame, above which the film is rendered in whole frames."""
WHOLE = 1.0
"""The same for one frame among others: it is rendered whole and joined with the plate as others are."""


class Judgement(msgspec.Struct, forbid_unknown_fields=True):
    """Verdict on a plate by the frame that tries it; regions are rendered if nothing speaks against it."""

    cost: float
    """Cost of the regions, in parts of the whole frame."""
    fault: str = ""
    """How the frame that was put together differs from the whole one."""

    @property
    def stands(self) -> bool:
        """True if frames are put together."""
        return self.cost <= WORTH and not self.fault


@dataclass(frozen=True)
class Kept:
    """A plate: the light (H, W, 3) of the whole picture, and the small one that frames are compared with."""

    light: Array
    small: Small


class Painted(NamedTuple):
    """A frame that was put together: its light (H, W, 3), linear, and the seconds inside Blender's renderer."""

    light: Array
    seconds: float


class Plates:
    """The plates of a job."""

    def __init__(self, built: BuiltScene, render: Callable[[Any], float], tell: Callable[[str], None]) -> None:
        """``render`` renders a scene and returns the seconds, ``tell`` says what is done, as a word after Blender."""
        self.built, self.job, self._render, self._tell = built, built.job, render, tell
        self.folder = Path(self.job.plates_folder)
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise UserError(refusal(self.folder, error)) from error
        self.card = stencil.build_stencil(built.scene, built.scene.camera)
        self._kept: dict[str, Kept] = {}
        self._judged: dict[str, Judgement] = {}
        self._small: dict[str, Small] = {}
        self.seconds = 0.0
        """Seconds inside Blender's renderer for plates and trials, since they were asked for last."""
        self.notes: list[str] = []
        """Sentences for the user since they were asked for last."""
        # The table of random numbers grows with the most samples that a process has rendered. With the largest from the
        # start, a picture does not depend on those before it.
        self._rendered(RICHER * self.job.samples, rect=(0, 1, 0, 1))
        self.seconds = 0.0

    def painted(self, plate: Plate, state: int) -> Painted | None:
        """Return the frame of a state, put together; None if frames of this plate are rendered whole."""
        if not self._judgement(plate).stands:
            return None
        before, self.seconds = self.seconds, 0.0
        light, _ = self._joined(plate, state)
        seconds, self.seconds = self.seconds, before
        return Painted(light, seconds)

    # The trial.

    def _judgement(self, plate: Plate) -> Judgement:
        if plate.trial not in self._judged:
            path = self.folder / f"{plate.trial}.json"
            known = _read_judgement(path)
            if known is None:
                known = self._tried(plate)
                write_bytes(path, msgspec.json.encode(known))
            if known.fault:
                self.notes.append(
                    f"a frame put together from its plate {known.fault} beside the same frame rendered whole; "
                    "all frames of this camera are rendered whole"
                )
            self._judged[plate.trial] = known
        return self._judged[plate.trial]

    def _tried(self, plate: Plate) -> Judgement:
        """Judge by one frame, before the plate is rendered whether it pays."""
        self._tell("tries a frame for its plate")
        small = self._small_plate(plate)
        self.built.show(plate.state)
        frame = self._small_picture()
        change = change_of(frame, small)
        price = cost(self._rects(change), change.region, self._each)
        if price > WORTH:
            return Judgement(round(price, 4))
        light, change = self._joined(plate, plate.state)
        self._tell("renders the frame that tries its plate")
        whole = self._rendered(self.job.samples)
        return Judgement(round(price, 4), fault_of(light, whole, change.region) or "")

    # The plate.

    def _plate(self, plate: Plate) -> Kept:
        if plate.key not in self._kept:
            path = next(iter(sorted(self.folder.glob(f"{plate.key}-*.npz"))), None)
            kept = None if path is None else _read_plate(path, plate.key)
            if kept is None:
                kept = self._render_plate(plate)
            stencil.paint_stencil(self.card, kept.light)
            self._kept = {plate.key: kept}  # one at a time: those of large pictures are large
        return self._kept[plate.key]

    def _render_plate(self, plate: Plate) -> Kept:
        small = self._small_plate(plate)
        self.built.show(plate.state)
        self._tell("renders the plate of what stands")
        with self._without_movers(plate):
            light = self._rendered(RICHER * self.job.samples)
        content = _packed(light, small)
        write_bytes(self.folder / name_of(plate.key, content).replace(".png", ".npz"), content)
        return _unpacked(content)

    def _small_plate(self, plate: Plate) -> Small:
        if plate.key not in self._small:
            self.built.show(plate.state)
            with self._without_movers(plate):
                self._small[plate.key] = self._small_picture(clean=True)
        return self._small[plate.key]

    @contextmanager
    def _without_movers(self, plate: Plate) -> Iterator[None]:
        """Let no ray see what moves while the camera stands.

        It stays in the scene: Cycles would sort the lamps anew if it went, and noise of plate and frame would differ.
        """
        built = self.built
        carriers = [built.bodies[name] for name in plate.moving if name in built.bodies]
        things = [thing for carrier in carriers for thing in carrier.children_recursive]
        things += [built.solids[name] for name in plate.moving if name in built.solids]
        things += [built.trails[which] for which in plate.trails]
        things += [built.tubes[which] for which in plate.tubes]
        things += [built.texts[which] for which in plate.labels]
        before = [(thing, rays, getattr(thing, rays)) for thing in things for rays in RAYS]
        for thing, rays, _ in before:
            setattr(thing, rays, False)
        try:
            yield
        finally:
            for thing, rays, seen in before:
                setattr(thing, rays, seen)

    # The frame.

    def _joined(self, plate: Plate, state: int) -> tuple[Array, Change]:
        kept = self._plate(plate)
        self.built.show(state)
        change = change_of(self._small_picture(), kept.small)
        rects = self._rects(change)
        rendered = self._regions(change, rects, state) if rects else []
        return joined(kept.light, change, rects, rendered), change

    def _rects(self, change: Change) -> list[Rect]:
        rects = rectangles(change.region, self._each)
        if cost(rects, change.region, self._each) <= WHOLE:
            return rects
        height, width = change.region.shape
        return [(0, height, 0, width)]

    @property
    def _each(self) -> float:
        """Cost of a render's start in pixels of the small picture."""
        return LAUNCH / self.job.samples / self._times**2

    @property
    def _times(self) -> int:
        return times_smaller(self.job.width, self.job.height)

    def _regions(self, change: Change, rects: list[Rect], state: int) -> list[Array]:
        """Render the rectangles of a frame, with the stencil before what the regions leave out."""
        from scipy import ndimage

        pose, studio = self.job.states[state].camera, self.job.scene.studio
        height, width = change.region.shape
        away = stencil.distance_of(pose, studio)
        wider = math.ceil(width * stencil.blur_of(pose, away, width / height))
        holes = ndimage.binary_dilation(change.region, iterations=wider) if wider else change.region  # a pinhole
        stencil.cut_holes(self.card, holes, pose.lens, away)
        self.card.hide_render = False
        try:
            return [self._rendered(self.job.samples, rect=rect) for rect in rects]
        finally:
            self.card.hide_render = True

    # Renders.

    def _small_picture(self, clean: bool = False) -> Small:
        """Return the small picture of the scene as it stands; a plate's is denoised as well."""
        cycles = self.built.scene.cycles
        cycles.use_denoising = clean
        try:
            samples = max(FEWEST, self.job.samples // FEWER)
            return self._read(read_small, self._content(samples, size=self._times, guides=True))
        finally:
            cycles.use_denoising = True

    def _rendered(self, samples: int, rect: Rect | None = None) -> Array:
        light = self._read(read_light, self._content(samples, rect=rect))
        height, width = self.job.height, self.job.width
        if rect is not None:
            height, width = self._times * (rect[1] - rect[0]), self._times * (rect[3] - rect[2])
        if light.shape[:2] != (height, width):
            raise UserError(f"Blender rendered a region of {light.shape[1]}x{light.shape[0]}, not {width}x{height}")
        return light

    def _read[T](self, read: Callable[[bytes], T], content: bytes) -> T:
        try:
            return read(content)
        except ValueError as error:
            raise UserError(
                f"{self.job.scene.mechanism}: {error}; see that the disk of {self.folder} has room, and run the same "
                "command again"
            ) from error

    def _content(self, samples: int, size: int = 1, rect: Rect | None = None, guides: bool = False) -> bytes:
        """Render the scene as it stands and return its passes as a file.

        The picture is ``size`` times smaller. ``rect`` is in pixels of the small picture.
        """
        import bpy

        scene = self.built.scene
        render, cycles, layer = scene.render, scene.cycles, scene.view_layers[0]
        render.resolution_x, render.resolution_y = self.job.width // size, self.job.height // size
        render.use_border = render.use_crop_to_border = rect is not None
        if rect is not None:
            top, bottom, left, right = (self._times * edge for edge in rect)
            height, width = self.job.height, self.job.width
            render.border_min_x, render.border_max_x = (left + NUDGE) / width, (right + NUDGE) / width
            render.border_min_y, render.border_max_y = 1 - (bottom - NUDGE) / height, 1 - (top - NUDGE) / height
        cycles.samples = samples
        layer.cycles.denoising_store_passes = guides
        path = self.folder / ".passes.exr"
        images = render.image_settings
        before = images.media_type, images.file_format, images.color_depth
        try:
            self.seconds += self._render(scene)
            images.media_type, images.file_format = "MULTI_LAYER_IMAGE", "OPEN_EXR_MULTILAYER"
            images.exr_codec, images.color_depth = "NONE", "16"
            bpy.data.images["Render Result"].save_render(str(path), scene=scene)
            content = path.read_bytes()
        except OSError as error:
            raise UserError(refusal(path, error)) from error
        finally:
            path.unlink(missing_ok=True)
            images.media_type, images.file_format, images.color_depth = before
            render.resolution_x, render.resolution_y = self.job.width, self.job.height
            render.use_border = render.use_crop_to_border = False
            cycles.samples, layer.cycles.denoising_store_passes = self.job.samples, False
        return content


# Files of plates.


def _packed(light: Array, small: Small) -> bytes:
    buffer = io.BytesIO()
    arrays = {name: getattr(small, name) for name in Small.__dataclass_fields__}
    np.savez(buffer, plate=light.astype(np.float16), **arrays)
    return buffer.getvalue()


def _unpacked(content: bytes) -> Kept:
    with np.load(io.BytesIO(content), allow_pickle=False) as arrays:
        small = Small(**{name: arrays[name] for name in Small.__dataclass_fields__})
        return Kept(arrays["plate"].astype(np.float32), small)


def _read_plate(path: Path, key: str) -> Kept | None:
    """Return a plate if its file has the bytes that its name tells; else it is removed."""
    try:
        content = path.read_bytes()
        if path.name == name_of(key, content).replace(".png", ".npz"):
            return _unpacked(content)
        path.unlink(missing_ok=True)
    except OSError as error:
        raise UserError(refusal(path, error, "read")) from error
    return None


def _read_judgement(path: Path) -> Judgement | None:
    try:
        return msgspec.json.decode(path.read_bytes(), type=Judgement)
    except (OSError, msgspec.DecodeError):
        return None
