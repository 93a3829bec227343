"""Every law of motion: its rate and acceleration are the derivatives of its value."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mbsd import ModelError, constant_rate, cycloidal, function, harmonic, polynomial, recorded, table
from mbsd.arrays.laws import pack_laws
from mbsd.equations.laws import tabulate_law
from mbsd.model.laws import Motion
from mbsd.model.laws.examples import EXAMPLES
from mbsd.model.laws.law import Formula


def test_every_law_has_an_example() -> None:
    laws = {*Motion.__subclasses__(), *Formula.__subclasses__()} - {Formula}
    own = {law for law in laws if law.__module__.startswith("mbsd.")}
    assert {type(example) for example in EXAMPLES} == own


@pytest.mark.parametrize("law", EXAMPLES, ids=lambda law: type(law).__name__)
def test_rates_are_derivatives(law: Motion) -> None:
    ready = law.over(0.0, 1.4)
    t, h = np.linspace(0.0517, 1.3529, 53), 1e-4  # off the knots
    before, now, after = ready(t - h), ready(t), ready(t + h)
    scale = max(1.0, float(np.abs(now).max()))
    np.testing.assert_allclose((after[:, 0] - before[:, 0]) / (2 * h), now[:, 1], atol=1e-6 * scale)
    np.testing.assert_allclose((after[:, 1] - before[:, 1]) / (2 * h), now[:, 2], atol=1e-5 * scale)


@pytest.mark.parametrize("law", EXAMPLES, ids=lambda law: type(law).__name__)
def test_compiled_laws_are_the_same_laws(law: Motion) -> None:
    t = np.linspace(0.0, 1.4, 301)
    laws, out = pack_laws([law.over(0.0, 1.4).compiled(0.0, 1.4)]), np.zeros((301, 3))
    tabulate_law(laws, 1, t, out)
    expected = law.over(0.0, 1.4)(t)
    np.testing.assert_allclose(out, expected, rtol=1e-9, atol=1e-9 * max(1.0, float(np.abs(expected).max())))


@given(rise=st.floats(-3, 3), duration=st.floats(0.1, 10), begin=st.floats(-1, 1))
def test_cycloidal_dwells_before_and_after(rise: float, duration: float, begin: float) -> None:
    law = cycloidal(rise, duration, begin)
    values = law(np.array([begin - 1, begin, begin + duration, begin + duration + 1]))
    np.testing.assert_allclose(values[:, 0], [0, 0, rise, rise], atol=1e-12)
    np.testing.assert_allclose(values[:, 1:], 0.0, atol=1e-9 * max(1, abs(rise)) / min(1, duration) ** 2)


def test_table_goes_through_its_rows_and_repeats_when_periodic() -> None:
    t = np.linspace(0.0, 2.0, 31)
    law = table(t, np.sin(math.pi * t), periodic=True)
    np.testing.assert_allclose(law(t)[:, 0], np.sin(math.pi * t), atol=1e-13)
    np.testing.assert_allclose(law(t + 4.0), law(t), atol=1e-10)
    assert law.period == 2.0


@pytest.mark.parametrize("noise", [None, 1e-4], ids=["estimated", "given"])
def test_a_record_is_smoothed_so_that_its_acceleration_can_be_used(noise: float | None) -> None:
    t = np.linspace(0.0, 4.0, 401)
    clean = 0.5 * np.sin(2.0 * t)
    law = recorded(t, clean + 1e-4 * np.random.default_rng(1).standard_normal(len(t)), noise)
    inside = np.linspace(0.2, 3.8, 300)
    got = law(inside)
    np.testing.assert_allclose(got[:, 0], 0.5 * np.sin(2.0 * inside), atol=2e-4)
    np.testing.assert_allclose(got[:, 1], np.cos(2.0 * inside), atol=2e-3)
    np.testing.assert_allclose(got[:, 2], -2.0 * np.sin(2.0 * inside), atol=0.02)
    raw = np.gradient(np.gradient(clean + 1e-4 * np.random.default_rng(1).standard_normal(len(t)), t), t)
    assert np.abs(raw[20:-20] + 2.0 * np.sin(2.0 * t[20:-20])).max() > 1.0  # what differences would give


def test_function_without_derivatives_gets_them_from_a_fit() -> None:
    t = np.linspace(0.0, 3.0, 200)
    fitted = function(lambda x: math.sin(2 * x)).over(0.0, 3.0)(t)
    np.testing.assert_allclose(fitted[:, 0], np.sin(2 * t), atol=1e-11)
    np.testing.assert_allclose(fitted[:, 1], 2 * np.cos(2 * t), atol=1e-8)
    np.testing.assert_allclose(fitted[:, 2], -4 * np.sin(2 * t), atol=1e-6)


@pytest.mark.parametrize(
    ("span", "part", "begin", "rise", "size"),
    [
        (0.2352, 5.1e-5, 0.1476, 4.305, 0.2034),
        (0.3485, 7.8e-5, 0.2226, 4.0e-4, 0.1552),
        (24.16, 8.9e-5, 5.897, 0.01049, 0.1261),
        (6.069, 7.8e-5, 2.768, 0.7582, 6.008),
        (0.1521, 8.9e-5, 0.09839, 8.947, 1.94),
    ],
)
def test_a_rise_of_less_than_a_ten_thousandth_of_the_span_is_fitted(
    span: float, part: float, begin: float, rise: float, size: float
) -> None:
    """Where f is steep, the rounding of times bounds f, of which the slope elsewhere says nothing."""
    short, omega = part * span, 1.3 / span

    def law(t: float) -> float:
        u = min(max((t - begin) / short, 0.0), 1.0)
        return size * math.sin(omega * t) + rise * (u - math.sin(2 * math.pi * u) / (2 * math.pi))

    t = np.concatenate([np.linspace(0.0, span, 301), np.linspace(begin, begin + short, 101)])
    u = np.clip((t - begin) / short, 0.0, 1.0)
    fitted = function(law).over(0.0, span)(t)
    np.testing.assert_allclose(fitted[:, 0], [law(time) for time in t], rtol=0, atol=1e-6 * (size + rise))
    slopes = size * omega * np.cos(omega * t) + rise / short * (1 - np.cos(2 * np.pi * u))
    np.testing.assert_allclose(fitted[:, 1], slopes, rtol=0, atol=1e-5 * rise / short)
    bends = rise / short**2 * 2 * np.pi * np.sin(2 * np.pi * u) - size * omega**2 * np.sin(omega * t)
    np.testing.assert_allclose(fitted[:, 2], bends, rtol=0, atol=1e-3 * rise / short**2)


@pytest.mark.parametrize("law", [lambda t: 2 * math.pi * t, lambda t: 0.7, lambda t: 0.0, lambda t: 1e-6 * t * t + 3.0])
def test_straight_lines_and_constants_are_smooth_laws(law) -> None:
    values = function(law).over(0.0, 2.0)(np.array([0.0, 0.4, 2.0]))
    np.testing.assert_allclose(values[:, 0], [law(0.0), law(0.4), law(2.0)], atol=1e-12)
    np.testing.assert_allclose(values[:, 1], (law(1.0 + 1e-3) - law(1.0 - 1e-3)) / 2e-3, atol=1e-5)
    np.testing.assert_allclose(values[:, 2], 0.0, atol=1e-5)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: constant_rate(math.nan), "rate is nan"),
        (lambda: harmonic(1.0, math.inf), "rate is inf"),
        (lambda: polynomial(), "at least one coefficient"),
        (lambda: cycloidal(1.0, -2.0), "duration is -2.0 s"),
        (lambda: table([0, 1, 2], [0, 1, 2]), "6 numbers or more"),
        (lambda: table([0, 1, 1, 2, 3, 4], range(6)), r"times\[2\] does not"),
        (lambda: table(range(6), [0, 1, 2, 3, 4, 5], periodic=True), "is not the first"),
        (lambda: table(range(6), [0, 1, 2, math.nan, 4, 5]), "finite"),
        (lambda: table(range(6), range(6))(np.array([7.0])), "covers 0 .. 5 s"),
        (lambda: recorded([0, 1, 2], [0, 1, 2]), "eight|8 numbers or more"),
        (lambda: recorded(range(9), range(9), noise=-1.0), "noise is -1.0"),
        (lambda: recorded(range(9), [0, 1, 2, math.nan, 4, 5, 6, 7, 8]), "leave out rows"),
        (lambda: recorded(range(9), range(9), noise=0.0)(np.array([9.5])), "covers 0 .. 8 s"),
        (lambda: function(math.sin, math.cos), "both derivatives"),
        (lambda: function(lambda t: math.nan)(np.array([0.0, 1.0])), "gives nan at t = 0 s"),
        (lambda: function(lambda t: abs(t - 0.5)).over(0.0, 1.0), "not smooth"),
    ],
)
def test_bad_laws_are_refused(make, says: str) -> None:
    with pytest.raises(ModelError, match=says):
        make()
