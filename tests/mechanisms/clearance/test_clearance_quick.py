"""What makes the proof of clearance quick gives what the plain way gives."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from mechanisms.stages.automatic.layout.sizes import of_pin
from mechanisms.stages.clearance import pieces as distinct_file
from mechanisms.stages.clearance.pieces import distinct
from mechanisms.stages.clearance.turn import _bounds, _box_gap
from mechanisms.stages.parts_files import TOLERANCE, read_triangles, stl_bytes
from shared.shapes.pin import pin
from shared.shapes.standards import Fit

few = st.sampled_from([-1.5, -0.0, 0.0, 1e-300, 0.1, 0.1 + 2**-56, 7.0])


@given(hnp.arrays(np.float64, st.tuples(st.integers(1, 40), st.integers(1, 4)), elements=few))
def test_distinct_rows_are_those_of_a_sort(rows: np.ndarray) -> None:
    first, which = distinct(rows)
    assert np.array_equal(rows[first][which], rows)
    assert len(first) == len(np.unique(rows, axis=0))


def test_rows_of_one_hash_are_told_apart(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(distinct_file, "_FACTORS", np.zeros(4, dtype=np.uint64))
    rows = np.array([[1.0, 2.0], [3.0, 4.0], [1.0, 2.0], [4.0, 3.0]])
    first, which = distinct(rows)
    assert len(first) == 3
    assert np.array_equal(rows[first][which], rows)


@given(st.integers(0, 1000), st.integers(1, 300), st.integers(1, 90), st.floats(0.0, 3.0))
def test_bounds_of_boxes_in_groups_are_those_of_all_pairs(seed: int, n: int, m: int, enough: float) -> None:
    rng = np.random.default_rng(seed)
    low = [rng.uniform(0, 10, (count, 2)).round(1) for count in (n, m)]
    a, b = (np.stack([corner, corner + rng.exponential(0.3, corner.shape)], axis=2).reshape(-1, 4) for corner in low)
    gaps = _box_gap(a, b)
    found_a, found_b = _bounds(a, b, enough)
    assert np.array_equal(found_a, np.minimum(gaps.min(axis=1), enough))
    assert np.array_equal(found_b, np.minimum(gaps.min(axis=0), enough))


def test_meshes_of_large_parts_are_as_fine_in_proportion_and_leave_the_clearance() -> None:
    assert of_pin(8.0, None).tolerance is None
    assert of_pin(0.5, None).tolerance is None
    assert of_pin(16.0, None).tolerance == pytest.approx(2 * TOLERANCE)
    for diameter in (12.0, 60.0, 250.0):
        sizes = of_pin(diameter, None)
        assert TOLERANCE < (sizes.tolerance or 0.0) < 0.3 * sizes.pivot.fit.running * sizes.scale / 2
    assert of_pin(80.0, Fit(running=0.1)).tolerance is None
    solid = pin(120.0, 300.0).val()
    fine, coarse = (read_triangles(stl_bytes(solid, tolerance)) for tolerance in (None, of_pin(120.0, None).tolerance))
    assert len(coarse) < 0.7 * len(fine)
