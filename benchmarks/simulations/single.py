"""Single runs with events at equal error: a ball, a block on a belt, one at a stop, a cradle.

All are known in closed form; error: the largest of a coordinate at 100 outputs (m). mbsd's time is that of a whole call
on a model that it knows, with these outputs; the peers keep nothing. They press back where mbsd has impacts: a row for
each of several stiffnesses and steps, and the quickest within the limit counts.
"""

from __future__ import annotations

import importlib
import importlib.metadata
import importlib.util
import itertools
import math
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any, NamedTuple

import numpy as np

import mbsd
from benchmarks.harness import Run, bar_of_peers, row_of
from benchmarks.rows import Bar, Row

OUTPUTS = 100
BAR = 1.0
"""How many times the time of mbsd the quickest peer takes at least."""
GRAVITY, BALL_LOSS, HEIGHT = 10.0, 0.5, 1.0
STIFF, SPEED, STATIC, SLIDING = 50.0, 0.1, 0.6, 0.4
"""Spring (N/m) of the block of 1 kg on the belt, speed of this (m/s), coefficients of friction."""
THROWN, WAY, STOP_LOSS, RUB = 3.0, 0.5, 0.6, 0.2
"""A block of 1 kg is thrown (m/s) at a stop that is so far away (m)."""
HEAVY = 1e9
"""kg, the belt of a peer."""
BALLS, RADIUS, GAP, ROLLED = 5, 0.05, 0.02, 1.0
"""Balls on a rail between two walls, apart by a gap (m), the first rolled on (m/s)."""


def ball() -> mbsd.Mechanism:
    """On a vertical guide."""
    m = mbsd.Mechanism("ball", gravity=(0.0, -GRAVITY))
    made = m.body("body 0", 1.0, inertia=1.0)
    m.prismatic("guide", m.ground.at(0, 0, math.pi / 2), made.at(0, 0, math.pi / 2))
    m.rigid_contact("floor", m.ground.origin, made.origin, restitution=BALL_LOSS)
    m.start_near(**{"body 0": (0.0, HEIGHT, 0.0)})
    return m


def belt() -> mbsd.Mechanism:
    """The block begins at the belt's speed."""
    m = mbsd.Mechanism("belt", gravity=(0.0, -GRAVITY))
    moving, block = m.body("belt", 1.0, inertia=1.0), m.body("body 0", 1.0, inertia=1.0)
    m.prismatic("rail", m.ground.origin, moving.origin)
    m.drive_coordinate("motor", m.ground.origin, moving.origin, mbsd.constant_rate(SPEED))
    m.rigid_contact("touch", moving.origin, block.origin, friction=SLIDING, static_friction=STATIC)
    m.spring("spring", m.ground.at(-3, 0), block.origin, STIFF, free_length=3.0)
    m.start_moving(**{"body 0": (SPEED, 0, 0)})
    return m


def stop() -> mbsd.Mechanism:
    """On a rail with friction."""
    m = mbsd.Mechanism("stop", gravity=(0.0, -GRAVITY))
    block = m.body("body 0", 1.0, inertia=1.0)
    rail = m.prismatic("rail", m.ground.origin, block.origin)
    m.friction("rub", "rail", RUB, sticks=True)
    m.stop("end", rail, upper=WAY, restitution=STOP_LOSS)
    m.start_moving(**{"body 0": (THROWN, 0, 0)})
    return m


def cradle() -> mbsd.Mechanism:
    """Nothing is lost."""
    m = mbsd.Mechanism("cradle", gravity=None)
    made = [m.body(f"body {k}", 1.0, inertia=1.0) for k in range(BALLS)]
    for k, body in enumerate(made):
        rail = m.prismatic(f"rail {k}", m.ground.origin, body.origin)
        if k in (0, BALLS - 1):
            m.stop(
                f"wall {k}", rail, **{"upper" if k else "lower": _places()[k] + (GAP if k else -GAP)}, restitution=1.0
            )
        if k:
            m.rigid_discs(f"touch {k}", made[k - 1].origin, body.origin, RADIUS, RADIUS, restitution=1.0)
    m.start_near(**{f"body {k}": (x, 0.0, 0.0) for k, x in enumerate(_places())})
    m.start_moving(**{"body 0": (ROLLED, 0.0, 0.0)})
    return m


def _places() -> list[float]:
    return [k * (2 * RADIUS + GAP) for k in range(BALLS)]


def height(t: float) -> float:
    """(m) of the ball: falls that take a part of the time of that before."""
    fall = math.sqrt(2 * HEIGHT / GRAVITY)
    if t < fall:
        return HEIGHT - GRAVITY / 2 * t**2
    t -= fall
    speed = GRAVITY * fall * BALL_LOSS
    while t > 2 * speed / GRAVITY:
        t -= 2 * speed / GRAVITY
        speed *= BALL_LOSS
        if speed < 1e-12:
            return 0.0
    return speed * t - GRAVITY / 2 * t**2


def place_on_belt(t: float) -> float:
    """(m) of the block: it sticks up to the static friction, and slips for more than half a swing."""
    breaks, rests = STATIC * GRAVITY / STIFF, SLIDING * GRAVITY / STIFF
    d, w = breaks - rests, math.sqrt(STIFF)
    slip = 2 / w * (math.pi - math.atan(d * w / SPEED))
    t -= breaks / SPEED
    t = t % (2 * d / SPEED + slip) if t > 0 else t
    if 0 < t < slip:
        return rests + d * math.cos(w * t) + SPEED / w * math.sin(w * t)
    return breaks + SPEED * (t if t <= 0 else t - slip - 2 * d / SPEED)


def place_at_stop(t: float) -> float:
    """(m) of the block: there, and back until friction holds it."""
    slow = RUB * GRAVITY
    strikes = math.sqrt(THROWN**2 - 2 * slow * WAY)
    there = (THROWN - strikes) / slow
    if t < there:
        return THROWN * t - slow / 2 * t**2
    back = min(t - there, STOP_LOSS * strikes / slow)
    return WAY - STOP_LOSS * strikes * back + slow / 2 * back**2


def places_in_cradle(t: float) -> list[float]:
    """(m): equal balls that lose nothing pass through one another, as points without size, and are sorted."""
    points, room = [k * GAP for k in range(BALLS)], (BALLS + 1) * GAP
    way = (points[0] + GAP + ROLLED * t) % (2 * room)
    points[0] = min(way, 2 * room - way) - GAP
    return [x + 2 * RADIUS * k for k, x in enumerate(sorted(points))]


class Problem(NamedTuple):
    """One of them."""

    name: str
    build: Callable[[], mbsd.Mechanism]
    duration: float
    """s"""
    exact: Callable[[float], float | list[float]]
    limit: float
    """Largest error allowed (m); wide enough for contacts that press back."""
    axis: str = "x"


PROBLEMS = (
    Problem("ball that bounces to rest", ball, 2.0, height, 5e-3, "y"),
    Problem("block on a belt, stick and slip", belt, 6.0, place_on_belt, 1e-3),
    Problem("block with friction at a stop", stop, 2.0, place_at_stop, 5e-3),
    Problem("cradle of five balls between walls", cradle, 2.0, places_in_cradle, 2e-2),
)
BALL, BELT, STOP, CRADLE = (problem.name for problem in PROBLEMS)

TRIED = {
    ("exudyn", BALL): ((1e7, 6000), (1e7, 20_000)),
    ("exudyn", BELT): ((1e7, 6000), (1e7, 20_000)),
    ("exudyn", STOP): ((1e7, 6000),),
    ("exudyn", CRADLE): ((1e7, 20_000), (1e8, 20_000)),
    ("mujoco", BALL): ((1e7, 50_000),),
    ("mujoco", STOP): ((1e7, 50_000),),
    ("mujoco", CRADLE): ((1e6, 16_000), (1e7, 50_000), (1e8, 160_000)),
}
"""Stiffnesses (N/m) and steps of peers; MuJoCo knows no static friction above that of sliding."""
FITTED = {("mujoco", BALL): 0.958, ("mujoco", STOP): 1.019, ("exudyn", STOP): 1.15}
"""Parts of the damping of smooth contacts at which so many steps give back the speed; found by trial."""

Call = Callable[[], Any]


class Case(NamedTuple):
    """One code in one way."""

    code: str
    settings: str
    fresh: Callable[[], Call]
    """A run, whose making is not timed."""
    outputs: Callable[[np.ndarray], np.ndarray]
    """(T, k) coordinates at times, in a run of its own."""


def own(problem: Problem) -> Iterator[Case]:
    """A call as a user makes it."""
    m = problem.build()

    def outputs(times: np.ndarray) -> np.ndarray:
        sol = m.simulate(times=times)
        names = [name for name in m.bodies if name.startswith("body")]
        return np.column_stack([getattr(sol.body(name), problem.axis) for name in names])

    yield Case(
        "mbsd", f"simulate, {OUTPUTS} outputs, tolerance 1e-7",
        lambda: lambda: m.simulate(problem.duration, steps=OUTPUTS), outputs,
    )  # fmt: skip


def damping(code: str, problem: Problem, pulls: bool) -> float:
    """Return the part of the critical damping with which a contact gives back a speed.

    ``pulls`` where it holds on at its end.
    """
    restitution = {BALL: BALL_LOSS, STOP: STOP_LOSS}.get(problem.name, 1.0)
    least, most = 0.0, 0.999999
    for _ in range(60):
        part = (least + most) / 2
        side = math.sqrt(1 - part**2)
        turn = math.pi if pulls else math.atan2(2 * part * side, 2 * part**2 - 1)
        least, most = (part, most) if math.exp(-part / side * turn) > restitution else (least, part)
    return FITTED.get((code, problem.name), 1.0) * least


def mujoco(problem: Problem) -> Iterator[Case]:
    """Contacts and limits of one degree of freedom."""
    module = importlib.import_module("mujoco")
    for stiffness, steps in TRIED["mujoco", problem.name]:
        pull = 2 * damping("mujoco", problem, pulls=False) * math.sqrt(stiffness)
        reference = f'"{-stiffness!r} {-pull!r}"'
        hard = 'solimp="0.9999 0.9999 0.001 0.5 2"'
        geom = f'condim="1" friction="0 0 0" solref={reference} {hard}'
        step = problem.duration / steps
        bodies, moving = "", 0.0
        if problem.name == BALL:
            bodies = (
                f'<geom type="plane" size="1 1 1" {geom}/><body pos="0 0 {0.1 + HEIGHT}"><joint type="slide" '
                f'axis="0 0 1" ref="{HEIGHT}"/><geom type="sphere" size="0.1" mass="1" {geom}/></body>'
            )
        elif problem.name == STOP:
            moving = THROWN
            limit = f'limited="true" range="-9 {WAY}" solreflimit={reference} solimplimit="0.9999 0.9999 0.001 0.5 2"'
            rub = f'frictionloss="{RUB * GRAVITY}" solreffriction="{2.5 * step!r} 1" {hard.replace("=", "friction=")}'
            bodies = (
                f'<body><joint type="slide" axis="1 0 0" {limit} {rub}/>'
                '<geom type="sphere" size="0.1" mass="1" contype="0" conaffinity="0"/></body>'
            )
        else:
            moving = ROLLED
            for x, way in ((-GAP - RADIUS, 1), (_places()[-1] + GAP + RADIUS, -1)):
                bodies += f'<geom type="plane" size="1 1 1" pos="{x!r} 0 0" zaxis="{way} 0 0" {geom}/>'
            for x in _places():
                bodies += (
                    f'<body pos="{x!r} 0 0"><joint type="slide" axis="1 0 0" ref="{x!r}"/>'
                    f'<geom type="sphere" size="{RADIUS}" mass="1" {geom}/></body>'
                )
        model = module.MjModel.from_xml_string(
            f'<mujoco><compiler autolimits="false"/><option timestep="{step!r}" integrator="implicitfast" '
            f'gravity="0 0 {-GRAVITY if problem.name == BALL else 0}"><flag refsafe="disable" eulerdamp="disable"/>'
            f"</option><worldbody>{bodies}</worldbody></mujoco>"
        )
        data = module.MjData(model)

        def reset(model: Any = model, data: Any = data, moving: float = moving) -> None:
            module.mj_resetData(model, data)
            data.qvel[0] = moving
            module.mj_forward(model, data)

        def fresh(model: Any = model, data: Any = data, steps: int = steps, reset: Call = reset) -> Call:
            reset()
            return lambda: module.mj_step(model, data, steps)

        def outputs(
            times: np.ndarray, model: Any = model, data: Any = data, steps: int = steps, reset: Call = reset
        ) -> np.ndarray:
            reset()
            out = [data.qpos.copy()]
            for _ in times[1:]:
                module.mj_step(model, data, steps // (len(times) - 1))
                out.append(data.qpos.copy())
            return np.array(out)

        yield Case("mujoco", f"implicitfast, {steps} steps, stiffness {stiffness:g}", fresh, outputs)


def _exudyn_system(exu: Any, u: Any, problem: Problem, stiffness: float) -> tuple[Any, Any]:
    """Return a system of Exudyn and the nodes of its bodies."""
    system = exu.SystemContainer().AddSystem()
    ground = system.AddMarker(u.MarkerNodeCoordinate(nodeNumber=system.AddNode(u.NodePointGround()), coordinate=0))
    places = {BALL: [HEIGHT], CRADLE: _places()}.get(problem.name, [0.0])
    speed = {BALL: 0.0, BELT: SPEED, STOP: THROWN, CRADLE: ROLLED}[problem.name]

    def mass(x: float, speed: float, size: float = 1.0) -> tuple[Any, Any]:
        node = system.AddNode(u.Node1D(referenceCoordinates=[0.0], initialCoordinates=[x], initialVelocities=[speed]))
        system.AddObject(u.Mass1D(mass=size, nodeNumber=node))
        return node, system.AddMarker(u.MarkerNodeCoordinate(nodeNumber=node, coordinate=0))

    nodes, markers = zip(*(mass(x, 0.0 if k else speed) for k, x in enumerate(places)), strict=True)

    def touch(first: Any, second: Any, gap: float, mass: float) -> None:
        contact = u.ObjectContactCoordinate(
            markerNumbers=[first, second], contactStiffness=stiffness, offset=gap,
            contactDamping=2 * damping("exudyn", problem, pulls=True) * math.sqrt(stiffness * mass),
            nodeNumber=system.AddNode(u.NodeGenericData(initialCoordinates=[1.0], numberOfDataCoordinates=1)),
        )  # fmt: skip
        system.AddObject(contact)

    def rub(other: Any, sliding: float, **more: Any) -> None:
        data = u.NodeGenericData(initialCoordinates=[0, 0, 0], numberOfDataCoordinates=3)
        friction = u.CoordinateSpringDamperExt(
            markerNumbers=[other, markers[0]], nodeNumber=system.AddNode(data), dynamicFrictionForce=sliding, **more
        )
        system.AddObject(friction)

    if problem.name == BALL:
        system.AddLoad(u.LoadCoordinate(markerNumber=markers[0], load=-GRAVITY))
        touch(ground, markers[0], 0.0, 1.0)
    elif problem.name == BELT:
        spring = u.CoordinateSpringDamper(markerNumbers=[ground, markers[0]], stiffness=STIFF)
        system.AddObject(spring)
        sticks = {"stickingStiffness": stiffness, "stickingDamping": 2 * math.sqrt(stiffness)}
        above = (STATIC - SLIDING) * GRAVITY
        rub(
            mass(0.0, SPEED, HEAVY)[1],
            SLIDING * GRAVITY,
            staticFrictionOffsetForce=above,
            exponentialDecayStatic=1e-4,
            **sticks,
        )
    elif problem.name == STOP:
        touch(markers[0], ground, -WAY, 1.0)
        rub(ground, RUB * GRAVITY, frictionProportionalZone=1e-3)
    else:
        touch(ground, markers[0], -GAP, 1.0)
        touch(markers[-1], ground, -(_places()[-1] + GAP), 1.0)
        for first, second in itertools.pairwise(markers):
            touch(first, second, 2 * RADIUS, 0.5)
    return system, nodes


def exudyn(problem: Problem) -> Iterator[Case]:
    """One coordinate for each body, contacts of coordinates, bristles for friction."""
    exu, u = importlib.import_module("exudyn"), importlib.import_module("exudyn.utilities")
    exu.config.printToConsole = False
    kind = exu.DynamicSolverType.TrapezoidalIndex2
    for stiffness, steps in TRIED["exudyn", problem.name]:
        settings = exu.SimulationSettings()
        settings.solution.file.write = False
        settings.parallel.numberOfThreads = 1
        settings.timeIntegration.endTime = problem.duration
        settings.timeIntegration.numberOfSteps = steps
        settings.timeIntegration.verboseMode = 0

        build_system = partial(_exudyn_system, exu, u, problem, stiffness)

        def fresh(settings: Any = settings, build: Callable[[], Any] = build_system) -> Call:
            system, _ = build()
            settings.solution.sensors.writePeriod = 1e9
            system.Assemble()
            return lambda: system.SolveDynamic(settings, solverType=kind)

        def outputs(times: np.ndarray, settings: Any = settings, build: Callable[[], Any] = build_system) -> np.ndarray:
            system, nodes = build()
            words = {"storeInternal": True, "outputVariableType": exu.OutputVariableType.Coordinates}
            sensors = [system.AddSensor(u.SensorNode(nodeNumber=node, **words)) for node in nodes]
            settings.solution.sensors.writePeriod = float(times[1])
            system.Assemble()
            system.SolveDynamic(settings, solverType=kind)
            return np.column_stack([system.GetSensorStoredData(sensor)[:, 1] for sensor in sensors])

        yield Case("exudyn", f"trapezoidal rule, {steps} steps, stiffness {stiffness:g}", fresh, outputs)


CODES = {"mbsd": own, "exudyn": exudyn, "mujoco": mujoco}


def measured() -> tuple[list[Row], list[Bar]]:
    """Return rows of all codes installed, and a bar where a peer keeps the limit."""
    rows: list[Row] = []
    bars: list[Bar] = []
    for problem in PROBLEMS:
        times = np.linspace(0.0, problem.duration, OUTPUTS + 1)
        exact = np.array([problem.exact(t) for t in times.tolist()]).reshape(len(times), -1)
        own_rows = []
        for code, cases in CODES.items():
            if importlib.util.find_spec(code) is None:
                continue
            for case in cases(problem) if code == "mbsd" or (code, problem.name) in TRIED else ():
                version = importlib.metadata.version(code) if code != "mbsd" else mbsd.__version__
                error = float(np.abs(case.outputs(times) - exact).max())
                run = Run(version, case.settings, case.fresh, lambda _, error=error: {"": error}, {"": problem.limit})
                own_rows.append(row_of(code, problem.name, run))
        rows += own_rows
        if any(row.within_limits for row in own_rows[1:]):
            bars.append(bar_of_peers(own_rows, BAR))
    return rows, bars
