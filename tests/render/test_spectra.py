"""Spectra and pages over the angle of the crank: amplitudes that are known, what is asked for, what is refused."""

from __future__ import annotations

from pathlib import Path

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.figure import Figure
from matplotlib.text import Text

from mbsd import Mechanism, constant_rate
from mechanisms.stages.solve.motion_file import to_motion
from render import plots
from render.magnitudes import crank_of
from render.plots import compare, figures, spectra_asked
from render.plots.measures import horizon, marks
from render.plots.pages.comparison import spectra_figure
from render.plots.pages.spectra import Spectrum, spectrum, stems
from shared.contract import Motion, write_motion
from shared.contract.quantity import written
from shared.contract.skeleton import write_skeleton
from shared.stage import paths
from shared.stage.errors import UserError
from shared.stage.paths import Out
from tools.models.motions import bouncing_ball, four_bar_motion, plain_skeleton

MOTION = four_bar_motion(steps=72)


def page(plot: str, motion: Motion) -> Figure:
    return figures.figure(plot, motion, plain_skeleton(motion))


def shown(drawn: Figure) -> set[str]:
    drawn.canvas.draw()
    return {text.get_text() for text in drawn.findobj(Text) if isinstance(text, Text)}


def wheel(duration: float, rows: int = 400, drag: float = 0.0, torque: float = 0.0) -> Motion:
    """A wheel that is given 20 rad/s clockwise and drags, with a weight on its rim."""
    m = Mechanism("wheel", gravity=None)
    disc = m.body("disc", mass=2.0, com=(0.05, 0.0), inertia=0.02)
    m.revolute("axle", m.ground.at(0.1, 0.2), disc.origin)
    m.torsion_spring("bearing", m.ground, disc, stiffness=0.0, damping=drag)
    m.torque("brake", disc, torque)
    m.start_moving(disc=-20.0)
    return to_motion(m.simulate(duration, rows), None, "", {}, {"disc": "mechanism"})


# -- amplitudes ------------------------------------------------------------------------------------------------------


@given(st.lists(st.floats(-1e3, 1e3), min_size=9, max_size=9), st.floats(1e-3, 1e3))
@settings(max_examples=30, deadline=None)
def test_amplitudes_of_a_period_are_exact(parts: list[float], period: float) -> None:
    angle = np.linspace(0, 2 * np.pi, 73)
    mean, cosines, sines = parts[0], np.array(parts[1:5]), np.array(parts[5:])
    orders = np.arange(1, 5)
    values = mean + np.cos(np.outer(angle, orders)) @ cosines + np.sin(np.outer(angle, orders)) @ sines
    motion = msgspec.structs.replace(MOTION, time=list(np.linspace(0, period, 73)), period=period)
    computed = spectrum(motion, values)
    assert (computed.harmonic, computed.order_of, computed.base) == (True, "crank", pytest.approx(1 / period))
    np.testing.assert_allclose(computed.amplitudes[0], abs(mean), atol=1e-9)
    np.testing.assert_allclose(computed.amplitudes[1:5], np.hypot(cosines, sines), atol=1e-9)
    np.testing.assert_allclose(computed.amplitudes[5:], 0.0, atol=1e-9)


def test_orders_are_those_of_the_crank_also_over_several_turns() -> None:
    """Two turns are a period: order 1/2 is there, as of a four-stroke engine."""
    motion = four_bar_motion(steps=72, turns=2)
    angle = np.linspace(0, 4 * np.pi, 145)
    motion = msgspec.structs.replace(motion, period=2.0, time=list(np.linspace(0, 2, 145)))
    computed = spectrum(motion, 3 * np.cos(angle / 2) + np.cos(angle))
    np.testing.assert_allclose(computed.at[:3], [0, 0.5, 1])
    np.testing.assert_allclose(computed.amplitudes[:4], [0, 3, 1, 0], atol=1e-12)


def test_a_wheel_that_slows_down_is_looked_at_over_its_last_turn() -> None:
    motion = wheel(2.0, drag=0.01)
    crank = crank_of(motion)
    assert crank is not None
    assert crank.turns == int((motion.bodies["disc"].theta[0] - motion.bodies["disc"].theta[-1]) / (2 * np.pi))
    computed = spectrum(motion, 2 * np.cos(3 * crank.angle) + np.sin(crank.angle))
    np.testing.assert_allclose(computed.amplitudes[:5], [0, 1, 0, 2, 0], atol=1e-4)
    assert computed.base == pytest.approx(1 / (2.0 - np.interp(crank.angle[-1] - 2 * np.pi, crank.angle, motion.time)))


def test_reversing_cranks_count_from_there_and_rockers_are_no_cranks() -> None:
    turned = wheel(8.0, rows=2000, torque=6.0)  # brakes, and then turns it the other way
    crank = crank_of(turned)
    assert crank is not None
    assert 0 < crank.first < 2000
    assert (np.diff(crank.angle[crank.first :]) > 0).all()
    assert crank_of(wheel(0.3)) is None
    assert crank_of(bouncing_ball()) is None


@pytest.mark.parametrize("frequency", [4.0, 12.5])
def test_without_a_period_amplitudes_stand_over_frequencies(frequency: float) -> None:
    ball = bouncing_ball()
    time = np.linspace(0, 2.0, 401)
    motion = msgspec.structs.replace(ball, time=list(time), joints={}, events=[])
    computed = spectrum(motion, 7.0 + 3 * np.sin(2 * np.pi * frequency * time))
    assert not computed.harmonic
    assert computed.amplitudes[0] == pytest.approx(7.0, abs=0.05)
    peak = 1 + int(computed.amplitudes[1:].argmax())
    assert computed.at[peak] == pytest.approx(frequency, abs=1e-9)
    assert computed.amplitudes[peak] == pytest.approx(3.0, rel=1e-3)


def test_rows_that_share_a_time_are_a_jump() -> None:
    """A square wave, of which the amplitudes are 4/pi, 0, 4/3pi; its rows are not equally far apart."""
    half = np.sort(np.concatenate([np.linspace(0, 0.5, 40), [0.01, 0.02, 0.33]]))
    time = np.concatenate([half, 0.5 + half])
    values = np.repeat([1.0, -1.0], len(half))
    motion = msgspec.structs.replace(bouncing_ball(), time=list(time), joints={}, period=1.0)
    computed = spectrum(motion, values)
    np.testing.assert_allclose(computed.amplitudes[1:4], [4 / np.pi, 0, 4 / (3 * np.pi)], atol=2e-3)


# -- pages -----------------------------------------------------------------------------------------------------------


def test_stems_of_an_order_stand_with_their_middle_on_it() -> None:
    """One that is alone at its order stands on it; two stand beside each other, as far left as right."""
    drawn = Spectrum(np.arange(4.0), np.array([[0, 0], [3, 0], [2, 1], [0, 1.0]]), True, 1.0, "a turn", "crank")
    axes = Figure().subplots()
    stems(axes, drawn, drawn.amplitudes, ["black", "red"], ["x", "y"])
    bars = [segment[0, 0] for lines in axes.collections for segment in lines.get_segments()]
    assert len(bars) == 4
    assert bars[0] == 1.0
    assert bars[3] == 3.0
    assert (bars[1] + bars[2]) / 2 == pytest.approx(2.0)
    assert 0.1 < bars[2] - bars[1] < 0.3


def test_a_page_tells_what_it_shows() -> None:
    drawn = page("spectrum-shaking-force", MOTION)
    assert "Four-bar: spectrum of the shaking force" in shown(drawn)
    assert [axes.get_ylabel() for axes in drawn.axes] == ["force / mN", "amplitude / mN"]
    assert drawn.axes[1].get_xlabel() == "order of the crank; order 1 is 1 Hz"
    assert all(shown(page(f"spectrum-{what}", MOTION)) for what in ("A", "motor", "P", "rocker", "shaking-moment"))
    assert "frequency / Hz" in page("spectrum-ball", bouncing_ball()).axes[1].get_xlabel()


def test_a_balanced_wheel_shakes_nothing() -> None:
    motion = wheel(2.0)
    still = msgspec.structs.replace(motion.bodies["disc"], com=(0.0, 0.0))
    drawn = page("spectrum-shaking-force", msgspec.structs.replace(motion, bodies={"disc": still}))
    assert "nothing but rounding" in shown(drawn)
    assert "nothing but rounding" not in shown(page("spectrum-shaking-force", motion))


def test_a_simulated_crank_gets_a_page_turn_by_turn() -> None:
    motion = wheel(2.0, drag=0.01)
    assert "turns" in plots.plots_of(motion)
    assert "turns" not in plots.plots_of(MOTION)
    assert "turns" not in plots.plots_of(bouncing_ball())
    drawn = page("turns", motion)
    assert [axes.get_ylabel() for axes in drawn.axes] == ["speed / (rad/s)", "bearing force / N"]
    assert drawn.axes[-1].get_xlabel() == "disc angle, clockwise / °"
    strong = [line for line in drawn.axes[0].lines if line.get_linewidth() > 2]
    assert sum(float(np.ptp(np.asarray(line.get_xdata()))) for line in strong) == pytest.approx(360.0)
    ends = [float(np.asarray(line.get_xdata()).max()) for line in drawn.axes[0].lines]
    assert max(ends) <= 360.0 + 1e-9


def test_dead_points_and_events_are_marked() -> None:
    dead = marks(MOTION)
    assert [words for _, words in dead] == ["rocker turns back"] * 2
    omega = np.asarray(MOTION.bodies["rocker"].omega)
    np.testing.assert_allclose(np.interp([at for at, _ in dead], MOTION.time, omega), 0.0, atol=0.02)
    assert "rocker turns back" in shown(page("point-P", MOTION))
    assert [words for _, words in marks(bouncing_ball())] == ["floor: impact"]


def test_the_largest_speed_is_told_with_its_angle() -> None:
    point = MOTION.points["P"]
    fast = np.hypot(point.vx, point.vy)
    [said] = [text for text in shown(page("point-P", MOTION)) if "m/s at" in text]
    assert f"{written(float(fast.max()), 'm/s')} at {360 * MOTION.time[int(fast.argmax())]:.4g}°" in said


def test_a_clockwise_driver_has_its_angle_as_axis_and_tells_how_long_a_turn_takes() -> None:
    m = Mechanism("wheel")
    m.revolute("axle", m.ground.origin, m.body("disc", mass=1.0, inertia=0.1).origin)
    m.drive_angle("motor", m.bodies["disc"], constant_rate(-4 * np.pi))
    motion = to_motion(m.sweep(steps=36), None, "", {}, {"disc": "mechanism"})
    over = horizon(motion)
    assert (over.words, over.note) == ("motor angle, clockwise", "; a turn takes 500 ms")
    np.testing.assert_allclose(over.values, np.linspace(0, 360, 37), atol=1e-9)
    axes = figures.figure("bodies", motion, plain_skeleton(motion)).axes
    assert axes[-1].get_xlim() == pytest.approx((0, 360))
    assert np.diff(axes[-1].get_xticks()) == pytest.approx(45)
    assert axes[0].get_ylim()[0] > -45  # the disc's own angle falls, within its turn


# -- what is asked for -----------------------------------------------------------------------------------------------


@pytest.fixture
def mechanism_py(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, out_root: Path) -> Path:
    """Return a solved four-bar with these SPECTRA; of its other plots the energy alone is drawn."""
    monkeypatch.setattr(paths, "MECHANISMS", tmp_path)
    monkeypatch.setattr(plots, "plots_of", lambda _: ["energy"])
    (tmp_path / "four_bar").mkdir()
    (tmp_path / "four_bar" / "mechanism.py").write_text("VARIANTS = {'longer': {}}\n")
    for name in ("four_bar", "four_bar-longer"):
        write_motion(Out(name).motion, msgspec.structs.replace(MOTION, mechanism=name))
        write_skeleton(Out(name).skeleton, plain_skeleton(MOTION))
    return tmp_path / "four_bar" / "mechanism.py"


def spectra_of(out: Out) -> list[str]:
    return sorted(path.stem for path in out.plots.glob("spectrum-*"))


def test_spectra_are_drawn_where_mechanism_py_or_make_asks(mechanism_py: Path) -> None:
    out = Out("four_bar")
    plots.run("four_bar")
    assert spectra_of(out) == []
    mechanism_py.write_text("VARIANTS = {'longer': {}}\nSPECTRA = ('shaking force', 'motor', 'motor')\n")
    plots.run("four_bar")
    assert spectra_of(out) == ["spectrum-motor", "spectrum-shaking-force"]
    plots.run("four_bar", " P ,A")
    assert spectra_of(out) == ["spectrum-A", "spectrum-P"]
    mechanism_py.write_text("VARIANTS = {'longer': {}}\nSPECTRA = ['only of another variant', 'D']\n")
    plots.run("four_bar-longer")
    assert spectra_of(Out("four_bar-longer")) == ["spectrum-D"]


@pytest.mark.parametrize(
    ("written", "said"),
    [
        ("SPECTRA = ('shaking forc',)", r"SPECTRA asks for 'shaking forc'.*there is: shaking force, .*did you mean"),
        ("SPECTRA = 'motor'", r"four_bar/mechanism\.py:1: SPECTRA is not a list of names"),
        ("SPECTRA = tuple(names)", r"four_bar/mechanism\.py:1: SPECTRA is not a list of names"),
        ("SPECTRA: tuple", r"four_bar/mechanism\.py:1: SPECTRA is not a list of names"),
    ],
)
def test_other_words_are_refused(mechanism_py: Path, written: str, said: str) -> None:
    mechanism_py.write_text(f"{written}\n")
    with pytest.raises(UserError, match=said):
        plots.run("four_bar")


def test_names_asked_of_all_mechanisms_are_left_out_where_missing(mechanism_py: Path) -> None:
    with pytest.raises(UserError, match="SPECTRA asks for 'valve'"):
        plots.run("four_bar", "valve,motor")
    plots.run("four_bar", "valve,motor", every=True)
    assert spectra_of(Out("four_bar")) == ["spectrum-motor"]
    mechanism_py.write_text("SPECTRA = ('shaking forc',)\n")
    with pytest.raises(UserError, match="SPECTRA asks for 'shaking forc'"):
        plots.run("four_bar", every=True)


def test_variants_are_compared_in_the_spectra_that_are_asked_for(mechanism_py: Path) -> None:
    compare.run("four_bar")
    out = Out("four_bar")
    assert not (out.compare / "spectra.png").exists()
    compare.run("four_bar", "motor")
    assert (out.compare / "spectra.png").is_file()
    with pytest.raises(UserError, match="SPECTRA asks for 'valve'"):
        compare.run("four_bar", "motor,valve")
    compare.run("four_bar", "motor,valve", every=True)


def test_a_file_that_does_not_parse_asks_for_nothing(mechanism_py: Path) -> None:
    mechanism_py.write_text("SPECTRA = (\n")
    assert spectra_asked("four_bar") == []


def test_spectra_of_variants_stand_beside_each_other() -> None:
    heavier = msgspec.structs.replace(
        MOTION, bodies={n: msgspec.structs.replace(b, mass=2 * b.mass) for n, b in MOTION.bodies.items()}
    )
    drawn = spectra_figure("four_bar", {"as it is": MOTION, "heavier": heavier}, ["shaking force", "nothing of it"])
    assert drawn is not None
    assert [axes.get_title(loc="left") for axes in drawn.axes] == ["shaking force x / N", "shaking force y / N"]
    heights = [np.asarray(line.get_ydata()) for line in drawn.axes[0].lines]
    np.testing.assert_allclose(heights[1], 2 * heights[0], rtol=1e-9)
    assert spectra_figure("four_bar", {"as it is": MOTION}, []) is None
    assert spectra_figure("ball", {"as it is": bouncing_ball()}, ["ball"]) is None
