"""Inertias of all coordinates, and those that stand in for them where bodies have none."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed

RANK = 1e-12
"""Part of the largest singular value, in roots of masses, below which a motion has no kinetic energy."""


def inertia_of(packed: Packed) -> np.ndarray:
    """Return (3 nb,) the diagonal of M: kg, kg, kg m^2 of each body, ground included."""
    inertia = packed.system.mass.repeat(3)
    inertia[2::3] = packed.system.inertia
    return inertia


def weight_of(packed: Packed) -> np.ndarray:
    """Return (3 nb,) M g (N) of each body, ground included."""
    gravity = [*packed.system.gravity, 0.0]
    return (inertia_of(packed).reshape(-1, 3) * gravity).ravel()


def usual_inertia(packed: Packed) -> np.ndarray:
    """Return M (3 nb,), with the largest mass and the size of connected bodies where M is zero."""
    inertia, mass = inertia_of(packed), packed.system.mass
    heaviest = float(mass.max()) or 1.0
    if inertia[3:].all():
        inertia[:3] = heaviest, heaviest, heaviest * packed.size**2
        return inertia
    largest = np.zeros(len(mass))
    group = connected(packed.system.row_body, len(mass))
    np.maximum.at(largest, group, mass)
    largest = largest[group]
    largest[largest == 0.0] = heaviest
    usual = largest.repeat(3)
    usual[2::3] *= packed.size**2
    return np.where(inertia > 0.0, inertia, usual)


def connected(pairs: np.ndarray, bodies: int) -> np.ndarray:
    """Return (nb,) the least number among the bodies that ``pairs`` (k, 2) connect without ground, body 0."""
    group = np.arange(bodies)
    pairs = pairs[(pairs > 0).all(axis=1)]
    while True:
        before = group.copy()
        least = group[pairs].min(axis=1)
        np.minimum.at(group, pairs[:, 0], least)
        np.minimum.at(group, pairs[:, 1], least)
        group = group[group]
        if (group == before).all():
            return group


def coupled(packed: Packed) -> np.ndarray:
    """Return (nb,) the least number among bodies that joints, drivers and forces connect without ground."""
    number = {name: b for b, name in enumerate(packed.body_names)}
    pairs = packed.system.row_body.tolist()
    for force in packed.forces:
        values = [part for value in force.params.values() for part in (value if isinstance(value, list) else [value])]
        named = [number[part] for part in values if isinstance(part, str) and part in number]
        members = [body for body in (number[force.i.body.name], number[force.j.body.name], *named) if body > 0]
        pairs += pairwise(members)
    return connected(np.array(pairs, np.int64).reshape(-1, 2), len(packed.body_names))


def least_energy(v: np.ndarray, rows: np.ndarray, inertia: np.ndarray, size: np.ndarray) -> np.ndarray:
    """Return velocities (..., n) of least kinetic energy with the rates of ``rows`` that v (..., n) has.

    ``rows`` (..., m, n) are independent of each other, ``inertia`` (n,) may be zero; ``size`` (n,) of a unit step of
    each coordinate. Of velocities with equal energy those are taken that are nearest to v.
    """
    free = np.linalg.svd(rows * size)[2][..., rows.shape[-2] :, :] * size
    root = np.sqrt(inertia)
    across = np.swapaxes(free * root, -1, -2)
    back = np.linalg.pinv(across, rcond=RANK) @ (root * v)[..., None]
    return v - (np.swapaxes(free, -1, -2) @ back)[..., 0]
