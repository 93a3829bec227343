"""Regions of a picture: where a frame differs from the plate, the rectangles that cover them, and their joints.

A plate P shows what stands, in many samples. A frame F is known from a small picture f of few samples, beside the same
small picture p of the plate. Both have the same seed: they are equal wherever no path of light meets what moves. So
their difference has little noise, as long as no denoiser has treated each in its own way.

    s = smooth((f - p) / p)     the light that what moves takes or gives, where itself is not seen
    F = P (1 + s)               on the ground and the wall: soft shadows, light that bounces
    region                      what moves, and where p (1 + s) is not f: sharp shadows, reflections

Regions are rendered as any picture; the rest is the plate's, without its noise.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import ndimage as typed

from render.blender.regions.passes import Small

ndimage: Any = typed
"""Its types leave out what its functions take and return here."""
Array = np.ndarray
GREY = 0.18
DARKEST = -6.0
"""Stops below a middle grey that are black in a picture."""
STOPS = 10.5
"""From there to white."""
LEAST = 1e-3
"""Light that is added to what divides: in the dark, ratios are noise."""
DARKENED = -0.95
"""Light that what moves may take, at most, in parts of what there was."""
SMOOTH = 2.0
"""Pixels of the small picture over which the light of what moves is smooth (the deviation of a Gaussian)."""
DIFFERENT, NEAR = 4.0, 3
"""Parts of 255 by which a frame may differ from the plate in its light, and the pixels of the small picture, square,
over which means are taken."""
MIRRORS = 0.1
"""Part of the light that a surface mirrors above which it is rendered wherever its light changes: metal."""
CLOSED = 2
"""Half the width of gaps in a region that are rendered as well: the denoiser needs its neighbours."""
SPECK = 24
"""Pixels of a change of light, and of a hole in a region, at least: smaller ones are noise."""
MARGIN, BLEND = 2, 1
"""Pixels of the small picture around what differs, and how many of these region and plate take to become each other."""
NEARER, ALBEDO, TURNED = 1e-4, 0.01, 0.01
"""Changes of depth (in parts of it), of albedo and of the normal that say that something else is seen."""


@dataclass(frozen=True)
class Change:
    """How a frame differs from the plate, in pixels of the small picture."""

    region: Array
    """(h, w) True where the frame is rendered."""
    light: Array
    """(h, w, 3): the light that is more or less than the plate's elsewhere, in parts of it."""


def change_of(frame: Small, plate: Small) -> Change:
    """Return where a frame has to be rendered, and how its light differs from that of the plate elsewhere."""
    body = ndimage.binary_dilation(_sees_another(frame, plate))
    weight = (~body).astype(np.float32)[..., None]
    more = weight * (frame.noisy - plate.noisy) / (plate.light + LEAST)
    light = _mean(more, weight, _smooth)
    mirrors = plate.mirrored.max(axis=-1, keepdims=True) > MIRRORS
    expected = plate.light * (1 + np.where(mirrors, 0.0, light))
    there = plate.light * (1 + _mean(more, weight, _near))
    off = np.abs(seen(expected) - seen(there)).max(axis=-1)
    region = _closed(body | _without_specks(_closed(off > DIFFERENT)))
    return Change(~_without_specks(~ndimage.binary_dilation(region, iterations=MARGIN)), light)


def seen(light: Array) -> Array:
    """Return about what a picture shows of linear light, in 0..255: equal ratios of light are equal steps."""
    stops = np.log2(np.maximum(light, 0.0) / GREY + 2.0**DARKEST)
    return 255 * np.clip((stops - DARKEST) / STOPS, 0, 1)


def _sees_another(frame: Small, plate: Small) -> Array:
    """Return (h, w) True where the first thing that is seen is another one, or has moved."""
    depth = np.abs(frame.depth - plate.depth) > NEARER * np.abs(plate.depth)
    albedo = np.abs(frame.albedo - plate.albedo).max(axis=-1) > ALBEDO
    return depth | albedo | (np.abs(frame.normal - plate.normal).max(axis=-1) > TURNED)


def _mean(more: Array, weight: Array, blurred: Callable[[Array], Array]) -> Array:
    """Return the mean light that is more than the plate's around each pixel, of pixels that have a weight."""
    return np.maximum(blurred(more) / np.maximum(blurred(weight), 1e-3), DARKENED)


def _smooth(values: Array) -> Array:
    return ndimage.gaussian_filter(values, (SMOOTH, SMOOTH, 0))


def _near(values: Array) -> Array:
    return ndimage.uniform_filter(values, (NEAR, NEAR, 1))


def _closed(mask: Array) -> Array:
    """Return a mask with its gaps closed; what it has at the edge of the picture goes on beyond."""
    wider = np.pad(mask, CLOSED, mode="edge")
    return ndimage.binary_closing(wider, iterations=CLOSED)[CLOSED:-CLOSED, CLOSED:-CLOSED]


def _without_specks(mask: Array) -> Array:
    labels, count = ndimage.label(mask)
    sizes = np.bincount(labels.ravel(), minlength=count + 1)
    sizes[0] = 0
    return (sizes > SPECK)[labels]


# Rectangles that cover a region: few, since each is a render of its own, and small, since each pixel costs.

Rect = tuple[int, int, int, int]
"""Top, bottom, left, right in pixels of the small picture, the second and fourth exclusive."""
RENDERED, BLOCKED = 1.1, 0.35
"""Cost of a pixel of a rectangle in parts of the mean one of the whole picture: that of denoising and of the stencil,
and what a pixel of the region costs beside it. What moves is metal, and dearer than the ground.
"""
TILE = 4
"""Pixels between the places where a rectangle may be divided."""
DEPTH, TRIED = 2, 3
"""Divisions of divisions, which give four rectangles at most, and how many of each are followed."""


def rectangles(region: Array, each: float) -> list[Rect]:
    """Return rectangles that cover a region (h, w), padded by what the denoiser looks at.

    ``each`` is the cost of a rectangle beside its pixels, in pixels of the small picture that are rendered.
    """
    whole = _tight(region, (0, region.shape[0], 0, region.shape[1]))
    if whole is None:
        return []
    _, rects = _divided(region, whole, each, DEPTH)
    return [_padded(rect, region) for rect in rects]


def cost(rects: list[Rect], region: Array, each: float) -> float:
    """Return the cost of rendering ``rects`` and of starting the small picture, as a share of the whole picture's."""
    area = sum((bottom - top) * (right - left) for top, bottom, left, right in rects)
    return float(RENDERED * region.sum() + BLOCKED * area + each * (len(rects) + 1)) / region.size


def _divided(region: Array, rect: Rect, each: float, depth: int) -> tuple[float, list[Rect]]:
    """Return cost and rectangles of the cheapest cover that was found of the part of a region in ``rect``."""
    best = (_price(rect, region, each), [rect])
    if not depth:
        return best
    top, bottom, left, right = rect
    ways = [((top, y, left, right), (y, bottom, left, right)) for y in range(top + TILE, bottom - TILE + 1, TILE)]
    ways += [((top, bottom, left, x), (top, bottom, x, right)) for x in range(left + TILE, right - TILE + 1, TILE)]
    pairs = []
    for way in ways:
        halves = [half for half in (_tight(region, part) for part in way) if half is not None]
        pairs.append((sum(_price(half, region, each) for half in halves), halves))
    pairs.sort(key=lambda pair: pair[0])
    for _, halves in pairs[:TRIED]:
        parts = [_divided(region, half, each, depth - 1) for half in halves]
        total = sum(price for price, _ in parts)
        if total < best[0]:
            best = (total, [rect for _, rects in parts for rect in rects])
    return best


def _price(rect: Rect, region: Array, each: float) -> float:
    top, bottom, left, right = _padded(rect, region)
    return BLOCKED * (bottom - top) * (right - left) + each


def _padded(rect: Rect, region: Array) -> Rect:
    top, bottom, left, right = rect
    height, width = region.shape
    return max(top - MARGIN, 0), min(bottom + MARGIN, height), max(left - MARGIN, 0), min(right + MARGIN, width)


def _tight(region: Array, rect: Rect) -> Rect | None:
    """Return the smallest rectangle around the part of a region in ``rect``; None if there is none."""
    top, bottom, left, right = rect
    part = region[top:bottom, left:right]
    rows, columns = np.flatnonzero(part.any(axis=1)), np.flatnonzero(part.any(axis=0))
    if not len(rows):
        return None
    return top + int(rows[0]), top + int(rows[-1]) + 1, left + int(columns[0]), left + int(columns[-1]) + 1


# A frame put together.


def joined(plate: Array, change: Change, rects: list[Rect], rendered: list[Array]) -> Array:
    """Return a frame (H, W, 3), linear: ``plate`` in the light of the frame, with what was rendered in its regions.

    ``rendered`` are pictures of the ``rects`` at the size of the plate.
    """
    times = plate.shape[0] // change.region.shape[0]
    picture = plate * (1 + enlarged(change.light, times))
    mixed, total = np.zeros_like(picture), np.zeros((*picture.shape[:2], 1), np.float32)
    for rect, patch in zip(rects, rendered, strict=True):
        top, bottom, left, right = (times * edge for edge in rect)
        weight = np.outer(_ramp(bottom - top, times), _ramp(right - left, times))[..., None]
        mixed[top:bottom, left:right] += weight * patch
        total[top:bottom, left:right] += weight
    share = np.where(total[..., 0] > 0, _share(change.region, times), 0.0)[..., None]
    return picture + (mixed / np.maximum(total, 1e-9) - picture) * share


def _ramp(size: int, times: int) -> Array:
    """Return the weights of a rectangle's rows: they fall towards its edge, where the denoiser had no neighbours."""
    inside = np.minimum(np.arange(size), np.arange(size)[::-1]) + 0.5
    return np.minimum(inside / (2 * MARGIN * times), 1.0).astype(np.float32)


def enlarged(values: Array, times: int) -> Array:
    """Return (k h, k w, n) of (h, w, n), linear between the middles of pixels."""
    return ndimage.zoom(values, (times, times, 1), order=1, mode="nearest", grid_mode=True)


def _share(region: Array, times: int) -> Array:
    """Return (k h, k w) in 0..1: how much of a pixel is the region's.

    It falls to 0 before the edge of the region: the stencil shows there, and the denoiser spreads it.
    """
    inner = ndimage.binary_erosion(region, iterations=MARGIN - BLEND, border_value=1)
    whole = np.kron(inner, np.ones((times, times), np.float32))
    wide = 2 * BLEND * times + 1
    return np.clip(2 * ndimage.uniform_filter(whole, wide, mode="nearest") - 1, 0, 1)


# The proof by a frame that was rendered whole.

BOX = 16
"""Pixels over which the two pictures are compared: noise of a pixel is no difference."""
FAR, OFTEN = 20.0, 3.0
"""Parts of 255 by which a place in a thousand, and the mean of all, may differ."""


def fault_of(joint: Array, whole: Array, region: Array) -> str | None:
    """Return how a frame differs from the same one rendered whole beside its regions; None if only by noise."""
    times = whole.shape[0] // region.shape[0]
    rest = np.kron(~region, np.ones((times, times), bool))
    if not rest.any():
        return None
    off = np.abs(ndimage.uniform_filter(seen(joint) - seen(whole), (BOX, BOX, 0))).max(axis=-1)[rest]
    far, mean = float(np.quantile(off, 0.999)), float(off.mean())
    if far <= FAR and mean <= OFTEN:
        return None
    return f"differs by {mean:.1f} of 255 in the mean and by {far:.1f} at most"
