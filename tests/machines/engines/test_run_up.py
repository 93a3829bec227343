"""A run-up through resonance: the closed form against integration and published peaks, engines against it."""

from __future__ import annotations

import io
import math
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.special import fresnel

from mbsd import ModelError, study
from mbsd.machines.engines.block import Block, mount_response, mounts_of_frequency
from mbsd.machines.engines.engine import engine
from mbsd.machines.engines.run_up import run_up
from tools.documents.pages import between, replaced
from tools.documents.run_up import BEGIN, DAMPING_RATIO, END, GRID, RATES, build, measure, picture, table

PLACES = ((-0.30, -0.10), (0.30, -0.10), (0.0, 0.20))
SIZE = {"bore": 0.08, "stroke": 0.08, "rod": 0.14, "piston_mass": 0.5, "rod_mass": 0.6}


@settings(max_examples=25, deadline=None)
@given(
    damping_ratio=st.floats(0.0, 0.7),
    acceleration=st.floats(5.0, 1000.0),
    order=st.sampled_from([0.5, 1, 2, 4]),
    excitation=st.sampled_from(["inertia", "constant"]),
)
def test_the_closed_form_is_the_integral(
    damping_ratio: float, acceleration: float, order: float, excitation: str
) -> None:
    w, b = 2 * math.pi * 8.0, order * acceleration
    response = run_up(8.0, damping_ratio, acceleration, order, excitation)

    def rates(t: float, x: np.ndarray) -> list[float]:
        theta = 0.5 * b * t**2
        inertia = (b * t) ** 2 * math.cos(theta) + b * math.sin(theta)
        force = w**2 * math.cos(theta) if excitation == "constant" else inertia
        return [x[1], force - 2 * damping_ratio * w * x[1] - w**2 * x[0]]

    rows = slice(None, None, max(1, len(response.t) // 200))
    span = (0.0, response.t[-1])
    exact = solve_ivp(rates, span, [0.0, 0.0], t_eval=response.t[rows], method="DOP853", rtol=1e-10, atol=1e-11)
    assert response.displacement[rows] == pytest.approx(exact.y[0], abs=2e-6)


def test_the_published_peak_without_damping() -> None:
    """3.676 q^(1/2) static deflections at 1 + 0.861 q^(-1/2) of resonance: diffraction at an edge, I = 1.370 I_0."""
    u = np.linspace(1.0, 1.5, 5001)
    sine, cosine = fresnel(u)
    intensity = 0.5 * ((0.5 + cosine) ** 2 + (0.5 + sine) ** 2)
    assert intensity.max() == pytest.approx(1.370, abs=5e-4)
    q = 10_000.0
    w = 2 * math.pi
    response = run_up(1.0, 0.0, w**2 / (2 * math.pi * q), excitation="constant")
    assert response.peak / math.sqrt(q) == pytest.approx(math.pi * math.sqrt(intensity.max()), rel=4e-3)
    shift = u[intensity.argmax()] / math.sqrt(2)
    assert (response.peak_speed / w - 1) * math.sqrt(q) == pytest.approx(shift, rel=0.02)


@pytest.mark.parametrize("excitation", ["inertia", "constant"])
def test_slow_run_ups_reach_the_steady_peak_and_fast_ones_pass_below_it(excitation: str) -> None:
    runs = [run_up(8.0, 0.05, rate, excitation=excitation) for rate in (0.3, 3.0, 30.0, 300.0)]
    reached, speeds = [run.reached for run in runs], [run.peak_speed for run in runs]
    assert reached[0] == pytest.approx(1.0, abs=5e-3)
    assert reached == sorted(reached, reverse=True)
    assert runs[0].peak_speed == pytest.approx(runs[0].steady_speed, rel=0.01)
    assert speeds == sorted(speeds)


def test_the_run_up_of_an_engine_is_the_sum_of_its_orders() -> None:
    """The whole motion of a block that moves by half a millimetre, of both orders of a single's inertia."""
    block = Block(150.0, 4.0, mounts_of_frequency(150.0, 8.0, PLACES, 0.1))
    m = engine("I1", **SIZE, block=block, acceleration=10.0)
    m.gravity = None
    sol = m.simulate(10.0, steps=4000)
    assert sol.body("crank").omega[-1] == pytest.approx(100.0, rel=1e-3)
    total = sum(body.mass or 0.0 for name, body in m.bodies.items() if name != "ground")
    frequency, damping_ratio = 8.0 * math.sqrt(150.0 / total), 0.1 * math.sqrt(150.0 / total)
    expected = np.zeros(len(sol.t))
    far_above = mount_response(m, [1e4], orders=(1, 2, 3, 4)).displacement[0, :, 1]  # where a block moves by -U / M
    for order, amplitude in zip((1, 2, 3, 4), far_above, strict=True):
        part = run_up(frequency, damping_ratio, 10.0, order, until=100.0)
        expected -= amplitude.real * np.interp(sol.t, part.t, part.displacement)
    y = sol.body("block").y
    assert y == pytest.approx(expected, abs=0.01 * float(np.abs(y).max()))


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"frequency": 0.0}, "frequency is 0 Hz; it must be positive"),
        ({"damping_ratio": -0.1}, "damping_ratio is -0.1; it cannot be negative"),
        ({"damping_ratio": 0.8}, "damping_ratio is 0.8; from 0.707 on there is no resonance"),
        ({"acceleration": 0.0}, "acceleration is 0 rad/s"),
        ({"acceleration": 1e-7}, "give a higher acceleration"),
        ({"order": -1}, "order is -1; it must be positive"),
        ({"until": -1.0}, "until is -1 rad/s; it must be positive"),
        ({"excitation": "gas"}, "excitation is 'gas'; it is 'inertia' or 'constant'"),
    ],
)
def test_bad_run_ups_are_refused(changed: dict, words: str) -> None:
    with pytest.raises(ModelError, match=words):
        run_up(**({"frequency": 8.0, "damping_ratio": 0.1, "acceleration": 10.0} | changed))


def test_an_acceleration_starts_from_the_given_speed() -> None:
    m = engine("I1", **SIZE, speed=50.0, acceleration=-10.0)
    assert m.simulate(2.0, steps=10).body("crank").omega[-1] == pytest.approx(30.0)
    with pytest.raises(ModelError, match="engine 'I1': acceleration is nan"):
        engine("I1", **SIZE, acceleration=math.nan)


PAGE = (Path(__file__).resolve().parents[3] / "docs/engines.md").read_text()


@pytest.fixture(scope="module")
def runs() -> pd.DataFrame:
    """Return the runs of the inline four on soft mounts that the page shows."""
    grid = {"layout": ["I4"], "frequency": [8.0], "damping_ratio": [DAMPING_RATIO], "rate": list(RATES)}
    return study(build, grid, measure, folder=None, processes=1, progress=False)


def test_runs_agree_with_one_mode_in_closed_form(runs: pd.DataFrame) -> None:
    assert list(runs["reason"].isna()) == [True, True]
    assert list(runs["order of displacement"]) == [2.0, 2.0]
    assert list(runs["displacement"]) == pytest.approx(list(runs["expected displacement"]), rel=0.02)
    assert list(runs["speed of displacement"]) == pytest.approx(list(runs["speed of expected displacement"]), rel=0.02)
    slow, fast = runs["displacement"] / runs["steady displacement"]
    assert fast < 0.7 < 0.95 < slow


def test_the_page_shows_what_the_study_finds(runs: pd.DataFrame) -> None:
    shown = between(PAGE, BEGIN, END).strip().splitlines()
    head, line, row = table(runs).splitlines()
    assert shown[:2] == [head, line]
    assert row in shown, "docs/engines.md shows something else: make study-run-up"
    names = [tuple(text.split(" | ")[:2]) for text in shown[2:]]
    assert names == [(f"| {layout}", f"{hertz:g} Hz") for layout in GRID["layout"] for hertz in GRID["frequency"]]


def test_text_between_markers_is_replaced_and_a_missing_marker_is_an_error() -> None:
    assert replaced(f"before {BEGIN}\nold\n{END} after", BEGIN, END, "new") == f"before {BEGIN}\nnew\n{END} after"
    with pytest.raises(ValueError, match="the page has no"):
        replaced(f"{END} {BEGIN}", BEGIN, END, "new")


def test_the_picture_is_small(runs: pd.DataFrame) -> None:
    others = [runs.assign(layout=layout, frequency=hertz) for layout in GRID["layout"] for hertz in GRID["frequency"]]
    many = pd.concat([frame.assign(damping_ratio=zeta) for frame in others for zeta in GRID["damping_ratio"]])
    assert np.prod([len(values) for values in GRID.values()]) == 120
    file = io.BytesIO()
    picture(many).savefig(file, format="svg")
    assert len(file.getvalue()) < 300_000
