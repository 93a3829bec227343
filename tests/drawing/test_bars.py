"""Bars of power beside an animation: their words are clear of each other and of the bars."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from mbsd.drawing.animation.bars import Bars
from mbsd.drawing.animation.brush import Brush
from mbsd.drawing.animation.flow import Balance

DPI = 100.0


class _Plates(Brush):
    """Keeps the boxes of what is painted (pixels)."""

    def __init__(self) -> None:
        self.boxes: list[Bbox] = []

    def plate(self, corners: np.ndarray, *_: Any, **__: Any) -> None:
        self.boxes.append(Bbox([corners.min(axis=0), corners.max(axis=0)]))

    def stroke(self, *_: Any, **__: Any) -> None:
        pass


@pytest.mark.parametrize("height", [132.0, 180.0, 400.0])
@pytest.mark.parametrize("count", [1, 2, 3, 4, 7])
def test_names_of_powers_are_clear_of_each_other_and_of_the_bars(count: int, height: float) -> None:
    energy, power = np.array([1.0, 2.0]), np.array([-1.0, 1.0])
    powers = {f"gas of cylinder {k}": power * (1.0 + k) for k in range(count)}
    figure = Figure(figsize=(4.0, 5.0), dpi=DPI)
    renderer = FigureCanvasAgg(figure).get_renderer()
    bars, plates = Bars(Balance(energy, energy, powers, {}), (10.0, 20.0, 140.0, height), DPI), _Plates()
    bars.paint_still(figure, renderer)
    bars.draw(plates, 1)
    names = [text for text in figure.texts if text.get_text().startswith("gas")]
    assert len(names) >= min(count, 3)
    words = [text.get_window_extent(renderer) for text in figure.texts]
    for k, box in enumerate(words):
        assert not any(box.overlaps(other) for other in words[k + 1 :])
        assert not any(box.overlaps(other) for other in plates.boxes if other.width > 0 and other.height > 0)
