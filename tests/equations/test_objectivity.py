"""Forces between bodies do not know where the whole stands, how it is turned, or how it moves as one rigid body."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd.arrays.laws import compiled_laws
from mbsd.arrays.loads import loads_along, pack_loads
from mbsd.model.force import ForceKind
from mbsd.results.forces import potential_of
from mbsd.testing import force_kinds
from mbsd.testing.forces import example, motion

PAIRS = [kind for kind in force_kinds() if not kind.outside]


def carried(q: np.ndarray, v: np.ndarray, angle: float, shift: np.ndarray, spin: np.ndarray) -> tuple[np.ndarray, ...]:
    """q, v (T, 3 nb) turned and shifted as a whole, and with the velocity ``spin`` (vx, vy, omega) of all space."""
    c, s = math.cos(angle), math.sin(angle)
    place, rate = q.reshape(len(q), -1, 3).copy(), v.reshape(len(v), -1, 3).copy()
    for array in (place, rate):
        array[..., :2] = array[..., :2] @ np.array([[c, s], [-s, c]])
    place[..., 2] += angle
    place[..., :2] += shift
    rate[..., 0] += spin[0] - spin[2] * place[..., 1]
    rate[..., 1] += spin[1] + spin[2] * place[..., 0]
    rate[..., 2] += spin[2]
    place[:, 0] = rate[:, 0] = 0.0  # ground rests, and no marker is on it
    return place.reshape(q.shape), rate.reshape(v.shape)


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("kind", PAIRS, ids=lambda kind: kind.name)
def test_a_rigid_motion_of_the_whole_changes_nothing(kind: ForceKind, seed: int) -> None:
    m, packed = example(kind, seed)
    [force] = m.forces.values()
    random = np.random.default_rng(seed + 7)
    t, q, v = motion(packed, seed)
    angle, shift, spin = float(random.normal()), random.normal(size=2), random.normal(size=3)
    moved, moving = carried(q, v, angle, shift, spin)
    loads, laws = pack_loads(packed), compiled_laws(packed, 0.0, 1.0)
    here = loads_along(packed, loads, laws, t, q, v).reshape(len(t), -1, 3)
    there = loads_along(packed, loads, laws, t, moved, moving).reshape(len(t), -1, 3)
    c, s = math.cos(angle), math.sin(angle)
    here[..., :2] = here[..., :2] @ np.array([[c, s], [-s, c]])
    np.testing.assert_allclose(there, here, atol=1e-9 * np.abs(here).max())
    energy = potential_of(packed, force, q)
    np.testing.assert_allclose(potential_of(packed, force, moved), energy, atol=1e-10 * np.abs(energy).max())
