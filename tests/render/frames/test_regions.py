"""Regions of a picture that change: their light, their rectangles, their joints with the plate. No Blender."""

from __future__ import annotations

import struct

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import ndimage

from render.blender.regions import regions
from render.blender.regions.passes import Small, read_light, read_passes, read_small
from render.blender.regions.regions import Change, change_of, cost, fault_of, joined, rectangles, seen
from render.blender.scene.stencil import strips

TIMES = 4
"""So many times smaller is the small picture."""
SEEDS = st.integers(0, 2**32 - 1)


def exr(parts: dict[str, dict[str, np.ndarray]], compression: int = 0) -> bytes:
    """Return an OpenEXR file as Blender writes it: parts with half or float channels (h, w), rows in turn."""
    kinds = {"f2": 1, "f4": 2}
    several = len(parts) > 1
    content = struct.pack("<II", 20000630, 2 | (0x1000 if several else 0))

    def field(name: str, kind: str, value: bytes) -> bytes:
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value

    for channels in parts.values():
        height, width = next(iter(channels.values())).shape
        listing = b"".join(
            name.encode() + b"\0" + struct.pack("<iiii", kinds[array.dtype.str[1:]], 0, 1, 1)
            for name, array in sorted(channels.items())
        )
        content += field("channels", "chlist", listing + b"\0")
        content += field("compression", "compression", bytes([compression]))
        content += field("dataWindow", "box2i", struct.pack("<4i", 0, 0, width - 1, height - 1)) + b"\0"
    content += b"\0" if several else b""
    chunks = []
    for number, channels in enumerate(parts.values()):
        for y in range(next(iter(channels.values())).shape[0]):
            row = b"".join(array[y].tobytes() for _, array in sorted(channels.items()))
            chunks.append((struct.pack("<i", number) if several else b"") + struct.pack("<ii", y, len(row)) + row)
    return content + bytes(8 * len(chunks)) + b"".join(chunks)


def passes(size: tuple[int, int], seed: int, several: bool) -> dict[str, dict[str, np.ndarray]]:
    rng = np.random.default_rng(seed)
    names = {"Combined": "ABGR", "Denoising Depth": "Z", "Denoising Normal": "XYZ"}
    parts = {
        name: {f"ViewLayer.{name}.{letter}": rng.random(size, np.float32) for letter in letters}
        for name, letters in names.items()
    }
    parts["Combined"] = {name: array.astype("f2") for name, array in parts["Combined"].items()}
    return parts if several else {"all": {name: array for part in parts.values() for name, array in part.items()}}


@given(size=st.tuples(st.integers(1, 9), st.integers(1, 9)), seed=SEEDS, several=st.booleans())
def test_passes_are_read_as_they_were_written(size: tuple[int, int], seed: int, several: bool) -> None:
    parts = passes(size, seed, several)
    arrays = read_passes(exr(parts))
    written = {name.partition(".")[2]: array for part in parts.values() for name, array in part.items()}
    assert arrays.keys() == written.keys()
    assert all(np.array_equal(arrays[name], written[name]) for name in written)
    light = read_light(exr(parts))
    assert np.array_equal(light[..., 2], written["Combined.B"].astype(np.float32))


@given(data=st.data(), several=st.booleans())
def test_a_file_of_passes_that_is_cut_is_refused(data: st.DataObject, several: bool) -> None:
    content = exr(passes((3, 4), 0, several))
    cut = data.draw(st.integers(0, len(content) - 1))
    with pytest.raises(ValueError):  # its words differ from place to place
        read_passes(content[:cut])


def test_a_compressed_file_of_passes_is_refused() -> None:
    with pytest.raises(ValueError, match="compressed"):
        read_passes(exr(passes((3, 4), 0, True), compression=3))


def test_without_a_denoiser_the_picture_itself_is_noisy() -> None:
    parts = passes((3, 4), 1, False)
    for name, letters in (("Denoising Albedo", "RGB"), ("Denoising Specular Albedo", "RGB")):
        parts["all"].update({f"ViewLayer.{name}.{letter}": np.ones((3, 4), np.float32) for letter in letters})
    small = read_small(exr(parts))
    assert np.array_equal(small.noisy, small.light)
    noisy = {f"ViewLayer.Noisy Image.{letter}": np.full((3, 4), 7, np.float32) for letter in "RGB"}
    assert (read_small(exr({"all": parts["all"] | noisy})).noisy == 7).all()


# What differs.

SIZE = (45, 80)


def plate(mirrored: float = 0.0) -> Small:
    """A grey wall that is lit from the left."""
    light = np.broadcast_to(np.linspace(0.2, 0.5, SIZE[1], dtype=np.float32)[None, :, None], (*SIZE, 3))
    plain = np.ones((*SIZE, 3), np.float32)
    return Small(light, light, plain[..., 0], plain / 2, plain / np.sqrt(3), plain * mirrored)


def lit(small: Small, part: np.ndarray) -> Small:
    """The same in a part (h, w) of its light."""
    light = small.light * part[..., None]
    return Small(light, light, small.depth, small.albedo, small.normal, small.mirrored)


def test_equal_pictures_have_no_region() -> None:
    change = change_of(plate(), plate())
    assert not change.region.any()
    assert not change.light.any()


def test_what_moved_is_rendered_with_what_is_around_it() -> None:
    there = np.zeros(SIZE, bool)
    there[20:25, 30:50] = True
    still = plate()
    frame = Small(
        still.light, still.noisy, np.where(there, 0.9, still.depth), still.albedo, still.normal, still.mirrored
    )
    change = change_of(frame, still)
    assert change.region[ndimage.binary_dilation(there, iterations=regions.MARGIN)].all()
    assert change.region.mean() < 0.2


def test_a_mark_of_a_pixel_is_seen() -> None:
    still = plate()
    albedo = still.albedo.copy()
    albedo[20, 30] = 0.9
    frame = Small(still.light, still.noisy, still.depth, albedo, still.normal, still.mirrored)
    region = change_of(frame, still).region
    assert region[20, 27:34].all()
    assert region[17:24, 30].all()


def test_soft_shadows_are_taken_from_the_light_and_sharp_ones_are_rendered() -> None:
    y, x = np.mgrid[: SIZE[0], : SIZE[1]]
    soft = 1 - 0.3 * np.exp(-((y - 22) ** 2 + (x - 40) ** 2) / 2 / 10**2)
    change = change_of(lit(plate(), soft), plate())
    assert not change.region.any()
    assert change.light == pytest.approx(np.repeat((soft - 1)[..., None], 3, axis=2), abs=0.02)
    sharp = np.where((x > 30) & (x < 50), 0.5, 1.0)
    region = change_of(lit(plate(), sharp), plate()).region
    assert region[:, [30, 31, 49, 50]].all()
    assert not region[:, :20].any()


def test_metal_is_rendered_wherever_its_light_changes() -> None:
    dimmer = np.full(SIZE, 0.8)
    assert not change_of(lit(plate(), dimmer), plate()).region.any()
    metal = plate(mirrored=0.5)
    assert change_of(lit(metal, dimmer), metal).region.all()


# Rectangles.


def blots(seed: int, size: tuple[int, int] = SIZE) -> np.ndarray:
    """A region of some rectangles and lines."""
    rng = np.random.default_rng(seed)
    region = np.zeros(size, bool)
    for _ in range(rng.integers(0, 6)):
        y, x = rng.integers(0, size[0]), rng.integers(0, size[1])
        region[y : y + rng.integers(1, 20), x : x + rng.integers(1, 30)] = True
    return region


@given(seed=SEEDS, each=st.floats(0.0, 500.0))
def test_four_rectangles_at_most_cover_a_region_and_cost_no_more_than_one(seed: int, each: float) -> None:
    region = blots(seed)
    rects = rectangles(region, each)
    assert len(rects) <= 4
    covered = np.zeros_like(region)
    for top, bottom, left, right in rects:
        assert 0 <= top < bottom <= SIZE[0]
        assert 0 <= left < right <= SIZE[1]
        covered[top:bottom, left:right] = True
    assert covered[region].all()
    assert bool(rects) == bool(region.any())
    if rects:
        rows, columns = np.nonzero(region)
        top, left = max(rows.min() - regions.MARGIN, 0), max(columns.min() - regions.MARGIN, 0)
        bottom, right = rows.max() + 1 + regions.MARGIN, columns.max() + 1 + regions.MARGIN
        around = top, min(bottom, SIZE[0]), left, min(right, SIZE[1])
        assert cost(rects, region, each) <= cost([around], region, each) + 1e-9


@given(seed=SEEDS)
def test_strips_of_the_stencil_cover_all_but_its_holes(seed: int) -> None:
    holes = blots(seed)
    corners, faces = strips(holes)
    covered = np.zeros(SIZE, int)
    for face in faces:
        (top, left), (bottom, right) = corners[face].min(axis=0).astype(int), corners[face].max(axis=0).astype(int)
        covered[top:bottom, left:right] += 1
    assert np.array_equal(covered, (~holes).astype(int))


# Joints.


def crops(picture: np.ndarray, rects: list[tuple[int, int, int, int]]) -> list[np.ndarray]:
    return [picture[TIMES * t : TIMES * b, TIMES * left : TIMES * right] for t, b, left, right in rects]


def cases(seed: int) -> tuple[np.ndarray, Change, list[tuple[int, int, int, int]]]:
    """A plate, and a change of some light with some regions."""
    rng = np.random.default_rng(seed)
    region = ndimage.binary_dilation(blots(seed), iterations=regions.MARGIN)
    light = ndimage.gaussian_filter(rng.normal(0, 0.5, (*SIZE, 3)), (4, 4, 0)).astype(np.float32)
    picture = rng.uniform(0.2, 0.5, (TIMES * SIZE[0], TIMES * SIZE[1], 3)).astype(np.float32)
    return picture, Change(region, light), rectangles(region, 20.0)


@settings(max_examples=25)
@given(seed=SEEDS)
def test_regions_join_the_plate_without_a_seam(seed: int) -> None:
    still, change, rects = cases(seed)
    alone = joined(still, change, [], [])
    assert np.allclose(joined(still, change, rects, crops(alone, rects)), alone, rtol=1e-5)
    brighter = joined(still, change, rects, crops(alone + 1, rects)) - alone
    assert brighter.min() > -1e-5
    assert brighter.max() < 1 + 1e-5
    full = np.kron(change.region, np.ones((TIMES, TIMES), bool))
    assert np.abs(brighter[~full]).max(initial=0.0) < 1e-6
    inner = ndimage.binary_erosion(change.region, iterations=regions.MARGIN + 1, border_value=1)
    inside = brighter[np.kron(inner, np.ones((TIMES, TIMES), bool))]
    assert np.abs(inside - 1).max(initial=0.0) < 1e-5
    steps = max(np.abs(np.diff(brighter, axis=axis)).max(initial=0.0) for axis in (0, 1))
    assert steps <= 1.01 * 2 / (2 * regions.BLEND * TIMES + 1)


def test_noise_is_no_fault_and_a_shadow_too_many_is_one() -> None:
    rng = np.random.default_rng(0)
    still, region = np.full((180, 320, 3), 0.3), np.zeros(SIZE, bool)
    region[10:20, 10:20] = True
    assert fault_of(still * rng.uniform(0.9, 1.1, still.shape), still, region) is None
    darker = still.copy()
    darker[:, 200:] *= 0.5
    assert "of 255" in (fault_of(darker, still, region) or "")
    darker = still.copy()
    darker[45:75, 45:75] *= 0.1  # in the region, that is what was rendered
    assert fault_of(darker, still, region) is None


def test_what_is_seen_grows_with_the_light() -> None:
    values = seen(np.geomspace(1e-4, 10, 50))
    assert (np.diff(values) >= 0).all()
    assert values[0] >= 0
    assert values[-1] <= 255
