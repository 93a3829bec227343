"""A row of a batch is its single simulation: every quantity at every output, for all that a mechanism may hold."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, NamedTuple

import numba
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, ModelError, cycloidal, harmonic, polynomial
from mbsd.compiling.jit import COMPILED
from mbsd.dynamics.batch.simulate_many import Simulations
from mbsd.measures import samples
from mbsd.model.force import ForceKind
from mbsd.numbers.names import number_named, with_values
from mbsd.results.solution import Solution
from mbsd.testing.kinds import force_kinds
from tests.dynamics.many_models import air, crowded, door, pendulum, press
from tools.hunt.mixed_rows import quantity_names
from tools.models import guided, releases, rough_contacts, sticking, stops, user_events
from tools.models.engines import UP, petrol, slider_crank
from tools.models.guided import coaster, loose_gears
from tools.random_mechanisms.linkages import linkage

STEPS = 20
STATE = ("x", "y", "theta", "vx", "vy", "omega")
"""Quantities of bodies that are numbers of the state itself."""
BY_ITSELF = "other coordinates became better", "function is one of Python"
"""Why a row may be no row of the loop."""
ROUNDED = 1e-12
"""By how much numbers of the state differ behind events, where numbers that vary are rounded as arrays are."""

Build = Callable[[], Mechanism]
Vary = Mapping[str, Mapping[str, Any]]


class Case(NamedTuple):
    """A mechanism, how long it is simulated (s), and what varies."""

    build: Build
    duration: float
    vary: Vary
    near: float = 0.0
    """By how much numbers of the state may differ, beside their size or 1."""
    forces: float = 1e-8
    """Part of the largest force or acceleration by which forces, efforts, accelerations and work may differ."""
    reactive: bool = True
    """Whether reactions are found of many at once."""
    options: Mapping[str, Any] = {}


def engine() -> Mechanism:
    m = slider_crank(petrol(exhaust_opens=math.radians(130.0)), rate=None, start=0.4, fires_at=UP)
    m.start_moving(crank=150.0)
    return m


def ram() -> Mechanism:
    """A ram that lifts an arm, first one way and then the other."""
    m = Mechanism("ram")
    arm = m.bar("arm", 1.5, mass=40.0)
    m.revolute("pin", m.ground.origin, arm.start)
    m.hydraulic_cylinder(
        "ram", m.ground.at(0.2, -0.6), arm.at(0.7, 0.0), 0.05, 0.03, 0.5, 0.55, 1.6e7, rated_flow=4e-4,
        valve=lambda t: 0.4 * math.sin(4.0 * t), air=0.005,
    )  # fmt: skip
    m.start_near(arm=0)
    return m


def soft(**damping: float) -> Mechanism:
    """A ball on a floor that gives way, beside one that falls on a hard one."""
    m = Mechanism("soft", gravity=(0, -9.81))
    ball, other = m.body("ball", 1.0, inertia=0.01), m.body("other", 1.0, inertia=0.01)
    m.contact("soft", m.ground.origin, ball.origin, radius=0.1, stiffness=1e5, **damping)
    m.rigid_contact("hard", m.ground.origin, other.origin, radius=0.1, restitution=0.6)
    m.start_near(ball=(0, 0.4, 0), other=(1, 0.3, 0))
    return m


def discs(count: int) -> Mechanism:
    """Discs that fall side by side on a floor."""
    m = Mechanism("discs", gravity=(0, -9.81))
    for k in range(count):
        disc = m.body(f"d{k}", 1.0, inertia=0.01)
        m.rigid_contact(f"floor{k}", m.ground.origin, disc.origin, radius=0.1, restitution=0.5)
    m.start_near(**{f"d{k}": (0.3 * k, 0.2 + 0.01 * k, 0.0) for k in range(count)})
    return m


def rough_ball() -> Mechanism:
    m = stops.ball()
    m.change("floor", friction=0.2)
    m.start_moving(ball=(1.0, 0, 30))
    return m


def windy() -> Mechanism:
    """A pendulum under a function of the user."""

    def wind(t: float, q: np.ndarray, v: np.ndarray) -> tuple[float, float, float]:
        return 0.2 * math.sin(3.0 * t), 0.0, -0.1 * v[2]

    m = pendulum()
    m.user_force("wind", numba.njit(wind) if COMPILED else wind, m.bodies["b"])
    return m


def traced() -> Mechanism:
    m = stops.barrier()
    m.trace("P", m.bodies["coupler"].end)
    return m


def pushed(law: Any) -> Mechanism:
    m = stops.barrier()
    m.torque("push", m.bodies["rocker"], law)
    return m


def random_machine(seed: int) -> Mechanism:
    return linkage(seed, 1 + seed % 2, damping=bool(seed % 2)).m


def random_numbers(m: Mechanism, seed: int) -> Vary:
    """Masses, stiffnesses and dampings."""
    rng = np.random.default_rng(seed)
    out: dict[str, dict[str, Any]] = {list(m.bodies)[1]: {"mass": rng.uniform(0.5, 2.0, 4)}}
    for force in m.forces.values():
        for key in ("stiffness", "damping"):
            if isinstance(force.given.get(key), float):
                out[force.name] = {key: force.given[key] * rng.uniform(0.7, 1.3, 4)}
    return out


def example(kind: ForceKind) -> Mechanism | None:
    """Two bodies with a force of a kind between two others; None where it cannot start."""
    m = Mechanism("example")
    a, b = m.bar("a", 1.0, mass=1.0), m.bar("b", 0.8, mass=0.7)
    m.revolute("A", m.ground.at(0, 0), a.start)
    m.revolute("B", a.end, b.start)
    m.spring("first", m.ground.at(0.5, 1.0), b.at(0.5, 0.1), 20.0, 0.1, free_length=1.0)
    assert kind.example is not None
    try:
        kind.example(m, a.at(0.3, 0.1), b.at(0.2, -0.1))
    except ModelError:
        return None
    m.torsion_spring("last", m.ground, a, 3.0, 0.2)
    m.start_near(a=-40, b=-80)
    return m


def of_kind(kind: ForceKind) -> Case | None:
    """Return the case of a kind of forces, of which one number varies; None where it needs another joint."""
    m = example(kind)
    if m is None or kind.of_reactions:
        return None
    vary: dict[str, dict[str, list[float]]] = {
        "a": {"mass": [1.0, 1.3]}, "first": {"stiffness": [25.0, 14.0]}, "last": {"damping": [0.2, 0.1]}
    }  # fmt: skip
    for name, force in m.forces.items():
        numbers = [key for key, value in force.given.items() if isinstance(value, float) and value]
        if name not in vary and numbers:
            vary[name] = {numbers[0]: [force.given[numbers[0]], 1.02 * force.given[numbers[0]]]}
    return Case(lambda: m, 0.1, vary)


SPRING, TIE = ("stiffness", [0.5, 2.0, 4.0]), ("stiffness", [20.0, 60.0, 120.0])
GENEVA = {"spring": {"stiffness": [0.0, 0.01, 0.03], "damping": [2e-4, 0.0, 1e-4]}}
LOADED, LAW = {"load": {"inertia": [0.3, 0.4]}}, {"rocker": {"mass": [2.0, 2.2, 1.8]}}
ANGLE = {"coil": {"stiffness": [0.0, 1.0, 3.0]}}
PLACES = {"D": {"x": [0.4, 0.41, 0.38], "y": [0.02, 0.0, 0.05]}, "coupler": {"length": [0.38, 0.37, 0.39]}, **LAW}
PULLED = {"a": {"mass": [1.0, 1.3, 0.7]}, "joint": {"stiffness": [2.0, 1.0, 4.0]}}
METHODS: dict[str, dict[str, float]] = {
    "rk4": {"step": 2e-3}, "baumgarte": {"step": 2e-3, "alpha": 20.0}, "rattle": {"step": 2e-3},
    "symplectic": {"step": 5e-3}, "generalized_alpha": {"step": 2e-3, "rho": 0.6}, "radau": {"tolerance": 1e-6},
}  # fmt: skip

SMOOTH: dict[str, Case] = {
    "door": Case(door, 2.0, {"closer": {"stiffness": [4.0, 8.0], "damping": [10.0, 3.0]}}),
    "masses": Case(pendulum, 0.8, PULLED),
    "lengths and traces": Case(traced, 0.3, {"coupler": {"length": [0.35, 0.38, 0.4]}}),
    "function of the user": Case(windy, 0.5, {"a": {"mass": [0.5, 1.0, 1.5]}}),
    "joint elsewhere": Case(press, 0.4, {"O": {"x": [0.0, 1e-3, -2e-3], "y": [0.0, 2e-3, 1e-3]}}),
    "end of a bar": Case(press, 0.4, {"crank": {"A.x": [0.05, 0.049, 0.052]}}),
    "side of a joint": Case(press, 0.4, {"A": {"i.x": [0.05, 0.049, 0.052]}}),
    "traced point": Case(press, 0.4, {"P": {"x": [0.1, 0.05, 0.12], "angle": [0.0, 0.3, 1.0]}}),
    "law of a driver": Case(press, 0.4, {"motor": {"amplitude": [0.6, 0.5, 0.4], "rate": [9.0, 8.0, 10.0]}}),
    "gravity": Case(press, 0.4, {"gravity": {"y": [-9.80665, 0.0, 3.0]}}),
    "centre of mass": Case(press, 0.4, {"rod": {"com.x": [0.075, 0.07, 0.08]}}),
    "start": Case(press, 0.4, {"hand": {"start.angle": [0.3, -1.0, 2.0]}}),
    "harmonic": Case(partial(pushed, harmonic(0.5, 9.0, 0.1)), 0.3, {"push": {"amplitude": [0.5, 0.2, 0.7]}}),
    "polynomial": Case(partial(pushed, polynomial(0.1, 0.5)), 0.3, {"push": {"coefficients.1": [0.5, -0.2, 0.0]}}),
    "rise": Case(partial(pushed, cycloidal(0.4, 0.2, 0.05)), 0.3, {"push": {"rise": [0.4, -0.3, 0.1]}}),
    "jumps elsewhere": Case(partial(pushed, cycloidal(0.4, 0.2, 0.05)), 0.3, {"push": {"duration": [0.2, 0.1, 0.05]}}),
    "engine": Case(engine, 0.1, {"crank": {"mass": [1.0, 2.0, 3.0]}}),
    "air": Case(air, 0.3, {"piston": {"mass": [0.5, 1.0, 2.0]}}),
    "pressure": Case(air, 0.3, {"gas": {"pressure": [1e5, 2e5, 3e5]}}),
    "ram": Case(ram, 0.5, {"arm": {"mass": [20.0, 40.0, 60.0]}}),
    "crossing curve": Case(coaster, 2.0, {"tie": dict([TIE])}, reactive=False),
    **{f"random {seed}": Case(partial(random_machine, seed), 0.5, random_numbers(random_machine(seed), seed))
       for seed in range(6)},
    **{f"method {name}": Case(pendulum, 0.5, PULLED, options={"method": name, **options})
       for name, options in METHODS.items()},
    **{f"force {kind.name}": case for kind in force_kinds() if kind.example and (case := of_kind(kind))},
}  # fmt: skip
"""Mechanisms that move without events, in both formulations where they can."""
CROWDED: list[Vary] = [
    {"s": {"stiffness": [20.0, 25.0, 15.0], "damping": [0.5, 0.1, 0.9]}},
    {"t": {"free_length": [0.3, 0.25, 0.35]}},
    {"second": {"amplitude": [0.3, 0.1, -0.2]}},
    {"first": {"phase": [0.0, 1.0, 2.0]}, "second": {"amplitude": [0.3, 0.5, 0.1]}, "k": {"damping": [0.1, 0.2, 0.3]}},
]
EVENTS: dict[str, Case] = {
    "stop": Case(partial(stops.barrier, True), 0.6, {"spring": {"damping": [0.2, 0.5, 0.9]}}),
    "rebound": Case(partial(stops.barrier, True), 0.4, {"end upper": {"restitution": [0.0, 0.5, 0.8]}}),
    "places beside stops": Case(partial(stops.barrier, True), 0.5, PLACES),
    "ball": Case(stops.ball, 4.0, {"band": {"stiffness": [0.5, 1.0, 30.0]}}),
    "rough ball": Case(rough_ball, 2.0, {"floor": {"friction": [0.1, 0.2, 0.6]}}),
    "limited": Case(stops.limited, 2.0, {"tie": {"stiffness": [10.0, 30.0, 60.0]}}),
    "many contacts": Case(partial(discs, 45), 0.4, {"d44": {"mass": [1.0, 2.0]}}),
    "soft": Case(partial(soft, damping=10.0), 0.8, {"ball": {"mass": [1.0, 1.5]}}),
    "remembers": Case(partial(soft, restitution=0.6), 0.8, {"ball": {"mass": [1.0, 1.5]}}, reactive=False),
    "swing": Case(user_events.swing, 1.5, {"drive": {"torque": [1.0, 2.0, 3.0]}}),
    "bouncing": Case(user_events.ball, 2.0, {"floor": {"restitution": [0.4, 0.6, 0.9]}}),
    "sling": Case(releases.sling, 1.2, {"spring": {"torque": [3.0, 4.0, 5.0]}}),
    "crossing curve with events": Case(partial(coaster, events=True), 2.0, {"tie": dict([TIE])}, reactive=False),
    "geneva turning": Case(partial(guided.free_geneva, 6), 2.0, GENEVA, options={"formulation": "independent"}),
    "genevas": Case(guided.heavy_pair_of_genevas, 2.0, GENEVA, options={"formulation": "independent"}),
    "geneva in reference": Case(partial(guided.free_geneva, 6), 2.0, GENEVA, options={"formulation": "reference"}),
    "cranks swing": Case(releases.cranks, 2.0, {"spring": dict([SPRING])}),
    "cranks turn": Case(partial(releases.cranks, 12.0), 1.5, {"coupler": {"mass": [0.5, 1.0, 2.0]}}, 1e-8, 1e-6),
    "cranks with friction": Case(partial(releases.dry, False), 1.5, {"spring": dict([SPRING])}),
    "cranks that stick": Case(partial(releases.dry, True), 1.5, {"spring": dict([SPRING])}),
    "bell": Case(sticking.bell, 4.0, {"bar": {"mass": [1.0, 1.5]}}),
    "slider-crank": Case(sticking.coasting_slider_crank, 0.6, {"rub": {"preload": [10.0, 12.0]}}),
    "stopped bell": Case(sticking.stopped_bell, 3.0, {"bar": {"mass": [1.0, 1.1]}}),
    "ratchet": Case(sticking.ratchet, 3.0, LOADED),
    "five-bar": Case(sticking.stuck_five_bar, 0.45, {"b": {"mass": [0.8, 0.9]}}),
    "incline": Case(rough_contacts.incline, 1.0, {"rear": {"friction": [0.3, 0.6, 0.9]}}),
    "static": Case(partial(rough_contacts.incline, 0.3, 0.7), 1.0, {"box": {"inertia": [0.005, 0.02]}}),
    "spinning ball": Case(rough_contacts.ball, 2.0, {"ball": {"inertia": [1e-4, 2e-4, 4e-4]}}),
    "belt": Case(rough_contacts.belt, 2.0, {"spring": {"stiffness": [20.0, 50.0, 120.0]}}),
    "hills": Case(rough_contacts.hills, 2.0, {"wheel": {"inertia": [1e-3, 2.5e-3, 5e-3]}}),
    "freewheel": Case(rough_contacts.freewheel, 1.5, {"spring": {"stiffness": [50.0, 80.0, 200.0]}}),
    "loose gears": Case(loose_gears, 0.9, ANGLE),
}
"""Mechanisms with events, contacts, joints that stick, and rows that repeat others; the records of events have more."""


def rows_of(case: Case) -> tuple[Simulations, list[Solution]]:
    """Return the rows of a case and their single simulations; raises AssertionError where a quantity differs."""
    m, options = case.build(), dict(case.options)
    names = [f"{whole}.{key}" for whole, own in case.vary.items() for key in own]
    rows = np.array([column for own in case.vary.values() for column in own.values()]).T
    numbers = [number_named(m, name) for name in names]
    times = np.linspace(0.0, case.duration, STEPS + 1)
    alone = [with_values(m, numbers, row).simulate(times=times, **options) for row in rows.tolist()]
    quantities = {
        name: q
        for name, q in quantity_names(alone[0]).items()
        if q.of_motions is not None and (case.reactive or not q.reactive)
    }
    measure = {name: samples(name, times.tolist()) for name in quantities}
    many = m.simulate_many(vary=case.vary, measure=measure, times=times, **options)
    assert all(why is None or any(words in why for words in BY_ITSELF) for why in many.alone), many.way
    for k, sol in enumerate(alone):
        force = max(1.0, float(np.abs(sol.wrench).max(initial=0.0)), float(np.abs(sol.a).max()))
        for name, quantity in quantities.items():
            there, state = quantity.of_solution(sol), name.rpartition(".")[2] in STATE
            near = case.near * max(1.0, float(np.abs(there).max())) if state else case.forces * force
            mine = many[name][k][: len(there)]
            np.testing.assert_allclose(mine, there, rtol=0.0, atol=near, err_msg=f"{name} of row {k}")
    return many, alone


@pytest.mark.parametrize("formulation", ["auto", "reference"])
@pytest.mark.parametrize("name", SMOOTH)
def test_rows_without_events_are_single_simulations(name: str, formulation: str) -> None:
    case = SMOOTH[name]
    if formulation == "reference" and "method" in case.options:
        pytest.skip("it knows reference coordinates alone")
    rows_of(case._replace(options={**case.options, "formulation": formulation}))


@pytest.mark.parametrize("order", [(0, 1, 2, 3, 4), (4, 3, 2, 1, 0), (3, 0, 4, 1, 2)])
@pytest.mark.parametrize("vary", CROWDED)
def test_numbers_of_one_force_among_many_are_put_in_its_own_place(vary: Vary, order: tuple[int, ...]) -> None:
    many, _ = rows_of(Case(partial(crowded, order), 0.3, vary))
    assert "prepared" not in many.way


@pytest.mark.filterwarnings("ignore::mbsd.base.errors.InitialConditionWarning")
@pytest.mark.parametrize("name", EVENTS)
def test_rows_with_events_are_single_simulations(name: str) -> None:
    case = EVENTS[name]
    rows_of(case._replace(near=max(case.near, ROUNDED)))


def thrown(
    slope: float, friction: float, above: float, restitution: float, feet: int, swing: float, spring: float,
    speed: tuple[float, float, float],
) -> Mechanism:  # fmt: skip
    """A body on some feet above a plane that swings to and fro, tied to ground by a spring, thrown."""
    m = Mechanism("thrown", gravity=(0, -9.81))
    base, body = m.body("base", 1.0, inertia=1.0), m.body("body", 1.0, inertia=0.02)
    m.prismatic("rail", m.ground.at(0, 0, math.radians(slope)), base.origin)
    m.drive_coordinate("motor", m.ground.at(0, 0, math.radians(slope)), base.origin, harmonic(swing, 9.0))
    for k in range(feet):
        angle = -math.pi / 2 + (k - 0.5 * (feet - 1)) * 0.9
        foot = body.at(0.2 * math.cos(angle), 0.2 * math.sin(angle))
        m.rigid_contact(f"foot {k}", base.origin, foot, 0.02, restitution, friction, friction * (1 + above))
    m.spring("spring", m.ground.at(0, 1), body.origin, spring, 0.1, free_length=0.8)
    m.start_near(base=(0, 0, slope), body=(0, 0.5, slope))
    m.start_moving(body=speed)
    return m


@pytest.mark.slow
@settings(max_examples=25)
@given(
    slope=st.floats(-30, 30),
    friction=st.floats(0.05, 0.9),
    above=st.sampled_from([0.0, 0.0, 0.3]),
    restitution=st.sampled_from([0.0, 0.3, 0.7]),
    feet=st.integers(1, 4),
    swing=st.sampled_from([0.0, 0.02, 0.1]),
    spring=st.sampled_from([0.0, 20.0]),
    speed=st.tuples(st.floats(-2, 2), st.floats(-2, 1), st.floats(-10, 10)),
)
def test_random_bodies_thrown_onto_a_rough_plane(**given: Any) -> None:
    rows_of(Case(partial(thrown, **given), 1.0, {"body": {"mass": [1.0, 1.3]}}, near=2e-9))
