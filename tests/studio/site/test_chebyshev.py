"""Interpolation on Chebyshev points: exact for polynomials, and as exact as theory says for smooth functions."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.site.designs import table

coefficients = st.lists(st.floats(-3.0, 3.0), min_size=1, max_size=5)
parts = st.floats(0.0, 1.0)


@given(coefficients, st.floats(-2.0, 2.0), st.floats(0.1, 5.0), parts)
def test_a_polynomial_of_its_degree_is_met_exactly(terms: list[float], low: float, width: float, part: float) -> None:
    points = table.nodes(low, low + width, 5)
    x = low + part * width
    assert table.weights(x, points).sum() == pytest.approx(1.0)
    exact, size = np.polyval(terms, x), np.abs(np.polyval(np.abs(terms), 7.0)) + 1.0
    assert table.weights(x, points) @ np.polyval(terms, points) == pytest.approx(exact, abs=1e-9 * size)


@given(parts, parts)
def test_designs_of_two_numbers_stand_in_the_order_of_their_weights(first: float, second: float) -> None:
    axes = [table.nodes(1.0, 2.0, 4), table.nodes(-3.0, 1.0, 5)]
    place = 1.0 + first, -3.0 + 4.0 * second
    values = np.array([x**3 * y**4 - 2.0 * x * y for x, y in table.grid(axes)])
    shown = table.tensor_weights(place, axes) @ values
    assert shown == pytest.approx(place[0] ** 3 * place[1] ** 4 - 2.0 * place[0] * place[1], abs=1e-8)


def test_the_error_of_a_smooth_function_falls_geometrically() -> None:
    """f(x) = 1 / (1 + x^2) on -1 .. 1: the poles +-i give a factor of 1 + sqrt(2) a node (Trefethen, 2013, ch. 8)."""
    places = np.linspace(-1.0, 1.0, 201)

    def error(count: int) -> float:
        points = table.nodes(-1.0, 1.0, count)
        shown = [table.weights(x, points) @ (1.0 / (1.0 + points**2)) for x in places]
        return float(np.abs(shown - 1.0 / (1.0 + places**2)).max())

    assert error(21) / error(9) == pytest.approx((1.0 + np.sqrt(2.0)) ** -12, rel=0.5)
