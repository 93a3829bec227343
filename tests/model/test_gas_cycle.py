"""Gas over the cycle of an engine, in solved mechanisms: the published charge, work, energy, jumps, both ways round."""

from __future__ import annotations

import json
import math
import pickle
from pathlib import Path

import numpy as np
import pytest

from mbsd import (
    GasCycle,
    GasView,
    Mechanism,
    ModelError,
    ModelWarning,
    constant_rate,
    four_stroke,
    harmonic,
    pressure_table,
    two_stroke,
)
from mbsd.arrays.chambers import chambers
from tools.models.engines import BORE, ROD, THROW, UP, petrol, radial, scotch_yoke, slider_crank

CASE = json.loads((Path(__file__).parents[1] / "published/reference/engine_wiebe.json").read_text())
GIVEN = CASE["given"]
AREA = math.pi / 4 * BORE**2
DISPLACED = 2 * THROW * AREA
LARGEST = DISPLACED / (1 - 1 / GIVEN["compression_ratio"])
"""Volume at the bottom dead centre (m^3)."""
P1 = 1e5
TURN = 2 * math.pi
EXPONENTS = {"compression_exponent": GIVEN["exponent"], "expansion_exponent": GIVEN["exponent"]}


def published(start: float) -> GasCycle:
    """The cycle of the published case, with intake and exhaust at its first pressure."""
    return four_stroke(
        GIVEN["compression_ratio"], heat=GIVEN["heat"] * P1 * LARGEST, start=math.radians(start),
        duration=math.radians(GIVEN["duration"]), a=GIVEN["a"], n=GIVEN["n"], intake=P1, exhaust=P1, **EXPONENTS,
    )  # fmt: skip


def gas_of(sol) -> GasView:
    view = sol.force("gas")
    assert isinstance(view, GasView)
    return view


@pytest.mark.parametrize("sense", [1.0, -1.0], ids=["counter-clockwise", "clockwise"])
@pytest.mark.parametrize("engine", CASE["expected"], ids=lambda engine: f"{engine['start']} degrees")
def test_the_published_charge_in_a_machine(engine: dict, sense: float) -> None:
    rate = 200.0
    m = scotch_yoke(published(engine["start"]), rate, start=UP - sense * math.pi, sense=sense)
    peak = math.radians(engine["at"])
    at = np.unique([*(math.radians(float(angle)) for angle in engine["pressure"] if angle != "180"), peak])
    view = gas_of(m.sweep(times=(at + math.pi) / rate))
    assert view.crank_angle == pytest.approx(at, abs=1e-12)
    wanted = {math.radians(float(angle)): value for angle, value in engine["pressure"].items()} | {peak: engine["peak"]}
    assert view.pressure / P1 == pytest.approx([wanted[angle] for angle in at], rel=3e-9)
    near = np.radians(engine["at"] + np.linspace(-0.02, 0.02, 41))
    around = gas_of(m.sweep(times=(near + math.pi) / rate)).pressure
    assert abs(int(around.argmax()) - 20) <= 1
    view = gas_of(m.sweep(steps=720))
    assert view.indicated_work is not None
    assert view.mean_effective_pressure is not None
    assert view.indicated_work / (P1 * LARGEST) == pytest.approx([engine["work"]], rel=1e-8)
    assert view.mean_effective_pressure / P1 == pytest.approx([engine["mean_pressure"]], rel=1e-8)


def test_a_sweep_takes_two_turns_of_a_four_stroke_engine_and_its_driver_does_the_work() -> None:
    sol = slider_crank().sweep(steps=720)
    assert np.ptp(sol.body("crank").theta) == pytest.approx(2 * TURN)
    view, both = gas_of(sol), slider_crank().sweep(steps=720, event_rows=True)
    assert view.indicated_work is not None
    power, t = both.driver("motor").power, both.t
    assert -np.trapezoid(power, t) == pytest.approx(view.indicated_work[0], rel=2e-3)
    assert gas_of(both).indicated_work == pytest.approx(view.indicated_work, rel=1e-9)
    assert sol.period == pytest.approx(2 * TURN / 200.0)
    one_turn = slider_crank(two_stroke(8.0, heat_density=1e6)).sweep()
    assert np.ptp(one_turn.body("crank").theta) == pytest.approx(TURN)


def test_work_does_not_depend_on_the_start_or_on_the_rows() -> None:
    works = [
        gas_of(slider_crank(start=start, fires_at=UP).sweep(2 * TURN / 200.0, steps=steps)).indicated_work
        for start, steps in ((UP, 720), (UP + 0.3, 400), (UP - 5.0, 531))
    ]
    assert np.concatenate(works) == pytest.approx(works[0][0], rel=1e-7)  # pyright: ignore[reportOptionalSubscript]


def test_both_rows_stand_where_the_exhaust_opens() -> None:
    sol = slider_crank(petrol(exhaust_opens=math.radians(131.3))).sweep(steps=360, event_rows=True)
    view = gas_of(sol)
    [row] = [k for k in np.flatnonzero(np.diff(sol.t) == 0.0) if abs(view.pressure[k + 1] - 1.1e5) < 1.0]
    assert view.crank_angle is not None
    assert math.degrees(view.crank_angle[row]) == pytest.approx(131.3, abs=1e-5)
    assert view.pressure[row] > 3e5
    assert {event.name for event in sol.events} == {"gas"}


@pytest.mark.parametrize("more", [{}, {"passage": math.radians(20.0)}], ids=["at once", "with a passage"])
def test_a_free_engine_keeps_its_balance_of_energy(more: dict) -> None:
    m = slider_crank(petrol(exhaust_opens=math.radians(130.0), **more), rate=None, start=0.4, fires_at=UP)
    m.start_moving(crank=150.0)
    sol = m.simulate(0.2, steps=400, event_rows=True)
    view = gas_of(sol)
    assert sol.audit is not None
    assert sol.work is not None
    assert view.indicated_work is not None
    assert len(view.indicated_work) >= 2
    assert np.abs(sol.audit - sol.audit[0]).max() < 1e-6 * np.ptp(sol.energy.kinetic)
    assert sol.stats.steps < 70 * np.ptp(sol.body("crank").theta) / TURN
    exact = m.simulate(0.2, steps=400, tolerance=1e-12)
    assert exact.body("crank").omega[-1] == pytest.approx(sol.body("crank").omega[-1], rel=1e-6)
    twins = np.flatnonzero(np.diff(sol.t) == 0.0)
    assert (len(twins) == 0) == bool(more)
    assert view.pressure[twins] - view.pressure[twins + 1] == pytest.approx(_falls(view, twins), rel=1e-3)


def _falls(view: GasView, rows: np.ndarray) -> np.ndarray:
    """By how much the pressure falls at these rows: to the exhaust's at 130 degrees, to the intake's at 360."""
    assert view.crank_angle is not None
    opens = np.abs(view.crank_angle[rows] % (2 * TURN) - math.radians(130.0)) < 1e-3
    return np.where(opens, 511256.8 - 1.1e5, 1.5e4)


def test_an_engine_in_a_block_on_mounts_keeps_its_balance_of_energy() -> None:
    m = slider_crank(petrol(exhaust_opens=math.radians(130.0)), rate=None, start=0.4, mounted=True, fires_at=UP)
    m.start_moving(crank=150.0)
    sol = m.simulate(0.2, steps=400)
    view = gas_of(sol)
    assert np.ptp(sol.body("block").theta) > 1e-3
    assert sol.audit is not None
    assert np.abs(sol.audit - sol.audit[0]).max() < 1e-6 * np.ptp(sol.energy.kinetic)
    assert view.crank_angle == pytest.approx(sol.body("crank").theta - sol.body("block").theta - UP, abs=1e-12)
    assert view.volume.max() / view.volume.min() == pytest.approx(10.0, rel=1e-2)


def test_cylinders_on_one_crank_fire_in_turn() -> None:
    m = slider_crank(fires_at=UP)
    crank, bank = m.bodies["crank"], math.radians(30.0)
    rod, piston = m.bar("rod_2", ROD, 0.4), m.body("piston_2", 0.5)
    m.revolute("big_end_2", crank.end, rod.start)
    m.revolute("wrist_2", rod.end, piston.origin)
    m.prismatic("liner_2", m.ground.at(0, 0, bank), piston.origin)
    m.start_near(crank=90, rod_2=-10, piston_2=(0.14, 0.08, 30.0))
    head = m.ground.at(0.3 * math.cos(bank), 0.3 * math.sin(bank), bank + math.pi)
    m.gas_cycle("gas_2", head, piston.origin, crank, petrol(), BORE, fires_at=bank + TURN)
    sol = m.sweep(steps=720)
    first, second = gas_of(sol), sol.force("gas_2")
    assert isinstance(second, GasView)
    assert second.indicated_work == pytest.approx(first.indicated_work, rel=1e-6)
    assert first.crank_angle is not None
    peaks = [int(view.pressure.argmax()) for view in (first, second)]
    turned = np.degrees(first.crank_angle[peaks])
    assert turned[1] - turned[0] == pytest.approx(300.0, abs=1.5)  # the second bank leads by 60 degrees, a turn later


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_rods_on_a_master_rod_are_known_by_their_joints(sense: float) -> None:
    m = radial(sense=sense)
    sol = m.sweep(2 * TURN / 200.0, steps=360)
    strokes = []
    for gas in chambers(sol.packed):
        view, cycle = sol.force(gas.name), gas.chamber.cycle
        assert isinstance(view, GasView)
        assert cycle is not None
        assert cycle.height is not None
        assert view.volume / AREA == pytest.approx(cycle.height(view.crank_angle), abs=1e-9 * THROW)
        strokes.append(cycle.displaced / AREA)
        fine = np.linspace(-1e-3, 1e-3, 5)
        assert cycle.height(fine).argmin() == 2
    assert strokes[0] == pytest.approx(2 * THROW, rel=1e-12)
    assert all(1.0 < stroke / strokes[0] < 1.05 for stroke in strokes[1:])  # hung pistons go further
    assert strokes[1] == pytest.approx(strokes[4], rel=1e-9)


def test_a_crank_that_turns_back_goes_through_the_same_pressures() -> None:
    there = gas_of(slider_crank(start=UP - 3.0, fires_at=UP).sweep(6.0 / 200.0, steps=60))
    back = gas_of(slider_crank(rate=-200.0, start=UP + 3.0, fires_at=UP).sweep(6.0 / 200.0, steps=60))
    assert back.pressure[::-1] == pytest.approx(there.pressure, rel=1e-9)


def test_numbers_serve_as_well_as_joints() -> None:
    own = slider_crank().sweep(steps=90)
    told = slider_crank(stroke=2 * THROW, rod=ROD, fires_at=UP, top=0.01).sweep(steps=90)
    assert gas_of(told).pressure == pytest.approx(gas_of(own).pressure, rel=1e-9)


@pytest.mark.parametrize("sense", [1.0, -1.0])
@pytest.mark.parametrize("offset", [0.0, 0.02])
def test_a_stroke_without_an_angle_is_at_its_top_where_the_piston_is_nearest_to_its_head(
    sense: float, offset: float
) -> None:
    """A steam engine with a chamber on both sides of its piston; the second head lies towards the crank."""
    m = Mechanism("steam", gravity=None)
    crank, rod, piston = m.bar("crank", THROW, 2.0), m.bar("rod", ROD, 0.4), m.body("piston", 0.5)
    m.revolute("main", m.ground.origin, crank.start)
    m.revolute("big_end", crank.end, rod.start)
    m.revolute("wrist", rod.end, piston.origin)
    m.prismatic("liner", m.ground.at(0, offset), piston.origin)
    m.drive_angle("shaft", crank, constant_rate(20.0 * sense, 0.4))
    m.start_near(crank=math.degrees(0.4), rod=0, piston=(ROD + THROW, offset, 0))
    angles = np.linspace(-math.pi, math.pi, 73)[:-1]
    cycle = pressure_table(angles, np.where(angles < 0.0, 1e5, 6e5), 1)
    heads = {"outer": m.ground.at(0.3, offset, math.pi), "inner": m.ground.at(0.05, offset, 0.0)}
    for name, head in heads.items():
        m.gas_cycle(name, head, piston.origin, crank, cycle, BORE, clockwise=sense < 0, stroke=2 * THROW, rod=ROD)
    sol = m.sweep(TURN / 20.0, steps=7200)
    for name, side in (("outer", -1.0), ("inner", 1.0)):
        view = sol.force(name)
        assert isinstance(view, GasView)
        assert view.crank_angle is not None
        nearest = int((side * sol.body("piston").x).argmin())
        assert abs(math.remainder(view.crank_angle[nearest], TURN)) < 2e-3


def test_a_stroke_whose_top_no_joint_tells_asks_for_the_angle() -> None:
    m = Mechanism("loose", gravity=None)
    crank, piston = m.body("crank", 1.0, inertia=1.0), m.body("piston", 1.0, inertia=1.0)
    m.revolute("main", m.ground.origin, crank.origin)
    m.prismatic("liner", m.ground.origin, piston.origin)
    m.gas_cycle("gas", m.ground.origin, piston.origin, crank, petrol(), BORE, stroke=2 * THROW, rod=ROD, top=0.05)
    m.start_near(piston=(0.06, 0, 0))
    with pytest.raises(
        ModelError, match=r"loose: force 'gas': fires_at is missing.* of 'crank' 'piston'.* give fires_at="
    ):
        m.simulate(0.01)
    m.change("gas", fires_at=0.0)
    assert gas_of(m.simulate(1e-3)).volume[0] > 0.0


def test_without_heat_gas_is_a_spring_while_its_valves_are_closed() -> None:
    cycle = four_stroke(9.0, compression_exponent=1.3, expansion_exponent=1.3)
    view = gas_of(slider_crank(cycle, start=UP - 3.1, fires_at=UP).sweep(6.2 / 200.0, steps=62))
    assert view.pressure * view.volume**1.3 == pytest.approx(view.pressure[0] * view.volume[0] ** 1.3, rel=1e-9)
    assert view.volume.max() / view.volume.min() == pytest.approx(9.0, rel=1e-3)


def test_a_table_is_met_at_its_points_and_repeats() -> None:
    angles = np.radians(np.arange(-360.0, 360.0, 5.0))
    pressures = 1e5 * (1.0 + 40.0 * np.exp(-((angles - 0.2) ** 2) / 0.1))
    m = slider_crank(pressure_table(angles, pressures, compression=10.0), start=UP, fires_at=UP)
    sol = m.sweep(4 * TURN / 200.0, steps=288 * 2)
    view = gas_of(sol)
    assert view.crank_angle is not None
    assert view.indicated_work is not None
    rows = np.arange(0, 577, 2)
    wanted = np.interp((view.crank_angle[rows] + TURN) % (2 * TURN) - TURN, angles, pressures)
    assert view.pressure[rows] == pytest.approx(wanted, rel=1e-6)
    assert len(view.indicated_work) == 2
    assert np.ptp(view.indicated_work) < 1e-6 * view.indicated_work[0]


def test_it_is_kept_changed_and_pickled(tmp_path: Path) -> None:
    m = slider_crank()
    before = gas_of(m.sweep(steps=36)).pressure
    m.save(tmp_path / "engine.json")
    for other in (Mechanism.load(tmp_path / "engine.json"), pickle.loads(pickle.dumps(m))):
        assert np.array_equal(gas_of(other.sweep(steps=36)).pressure, before)
    m.change("gas", cycle=petrol(heat_density=1.2e6))
    half = gas_of(m.sweep(steps=36)).pressure
    assert 0.4 * before.max() < half.max() < 0.9 * before.max()
    m.change("rod", length=0.16)  # what the joints tell is found anew
    assert gas_of(m.sweep(steps=36)).volume.max() / DISPLACED == pytest.approx(10 / 9, rel=1e-6)


@pytest.mark.parametrize(
    ("build", "words"),
    [
        (lambda: slider_crank(fires_at=0.3).sweep(), r"fires_at is 17.1887 degrees, but .* at 90 or 450 degrees"),
        (lambda: slider_crank(stroke=0.09, rod=0.04).sweep(), "rod is 0.04 m"),
        (lambda: slider_crank(rod=0.14), "rod and offset go with stroke"),
        (lambda: slider_crank(bore=0.0), "bore is 0; it must be positive"),
        (lambda: four_stroke(0.9), "compression is 0.9"),
        (lambda: four_stroke(10, heat=1.0, heat_density=1.0), "not both"),
        (lambda: four_stroke(10, start=-20.0), "must come first. Give radians"),
        (lambda: four_stroke(10, exhaust_opens=-1.0), "start is -15 degrees and exhaust_opens -57"),
        (lambda: two_stroke(10, passage=3.0), "passage is 3 rad"),
        (lambda: pressure_table([0, 1, 2, 9.0], [1, 1, 1, 1], turns=1), "the angles span"),
        (lambda: pressure_table([0, 1, 0.5, 2], [1, 1, 1, 1]), "angles must rise"),
    ],
)
def test_invalid_requests_are_refused(build, words: str) -> None:
    with pytest.raises(ModelError, match=words):
        build()


def test_a_piston_that_meets_its_head_is_refused_by_name_and_time() -> None:
    m = slider_crank(stroke=2 * THROW, rod=ROD, fires_at=UP, top=0.03)
    with pytest.raises(ModelError, match=r"engine: force 'gas': at t = 0 s .* its gas no room"):
        m.sweep()


@pytest.mark.parametrize("inertia", [0.0, 0.1])
def test_a_piston_that_starts_beyond_its_head_is_refused_for_that_and_not_for_its_inertia(inertia: float) -> None:
    m = Mechanism("air", gravity=None)
    piston = m.body("piston", 1.0, inertia=inertia)
    m.prismatic("rail", m.ground.origin, piston.origin)
    m.gas("gas", m.ground.origin, piston.origin, area=1e-3, pressure=2e5, at=0.1, clearance=0.01)
    m.start_near(piston=(-0.02, 0, 0))
    with pytest.raises(ModelError, match=r"air: force 'gas': at t = 0 s the piston lies -0.02 m .* its gas no room"):
        m.simulate(0.1)


def test_a_load_that_is_no_number_at_the_start_is_named() -> None:
    m = Mechanism("stars", gravity=None)
    star = m.body("star", 1.0)
    m.prismatic("rail", m.ground.origin, star.origin)
    m.gravitation("pull", m.ground.origin, star.origin, 1.0)
    with pytest.raises(ModelError, match=r"stars: at t = 0 s the load on body 'star' is no finite number"):
        m.simulate(0.1)


def test_polytropic_gas_has_pressure_and_volume_and_no_room_beyond_its_head() -> None:
    def air(swing: float) -> Mechanism:
        m = Mechanism("air", gravity=None)
        piston = m.body("piston", 1.0)
        m.prismatic("rail", m.ground.origin, piston.origin)
        m.gas("gas", m.ground.at(-0.1, 0), piston.origin, area=1e-3, pressure=2e5, at=0.1, clearance=0.01)
        m.drive_coordinate("drive", m.ground.origin, piston.origin, harmonic(swing, 10.0))
        return m

    sol = air(0.05).sweep()
    view = gas_of(sol)
    assert view.volume == pytest.approx(1e-3 * (0.11 + sol.body("piston").x))
    assert view.pressure == pytest.approx(2e5 * (0.11e-3 / view.volume) ** 1.3)
    assert view.indicated_work is None
    with pytest.raises(
        ModelError, match=r"air: force 'gas': at t = 0.4\d* s the piston lies -0.02 m .* its gas no room"
    ):
        air(0.12).sweep()


def test_numbers_that_do_not_fit_the_machine_are_told() -> None:
    with pytest.warns(ModelWarning, match="force 'gas'.* Correct them"):
        slider_crank(stroke=2 * THROW, rod=0.10, fires_at=UP, top=0.01).sweep()
