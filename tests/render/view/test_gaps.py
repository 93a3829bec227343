"""The place of a gap is between the two pieces, where they are nearest."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from render.view.loads import middle


def box(size: tuple[float, float, float], at: tuple[float, float, float]) -> np.ndarray:
    from trimesh import creation

    return np.asarray(creation.box(size).apply_translation(at).triangles, float)


@settings(max_examples=20, deadline=None)
@given(gap=st.floats(1e-4, 5e-3), scale=st.sampled_from([0.1, 1.0, 30.0]), shift=st.floats(-0.02, 0.02))
def test_between_two_boxes(gap: float, scale: float, shift: float) -> None:
    plate = box((0.2 * scale, 0.1 * scale, 0.01 * scale), (0, 0, 0))
    bar = box((0.02 * scale, 0.02 * scale, 0.05 * scale), (0.05 * scale, shift * scale, (0.03 + gap) * scale))
    x, y, z = middle(plate, bar) / scale
    assert abs(z - (0.005 + gap / 2)) < 0.25 * gap + 2e-4
    assert abs(x - 0.05) <= 0.0108
    assert abs(y - shift) <= 0.0108
