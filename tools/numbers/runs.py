"""Runs by name: every kind, every integrator, both formulations, and each analysis; a result each.

Closed forms, the gallery and the published cases come on top (groups.py, blocks.py, published.py).
"""

from __future__ import annotations

import dataclasses
import importlib
import pkgutil
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

import mbsd.dynamics.integrators
from benchmarks.dynamics import mbsd_code
from benchmarks.dynamics.cases import case
from mbsd import Mechanism, constant_rate, harmonic
from mbsd.dynamics.integrators.kind import INTEGRATORS
from mbsd.kinematics.march import kinematics_at
from mbsd.kinematics.prepared import prepare
from mbsd.model.force import FORCE_KINDS
from mbsd.model.joint import CONTACT_KINDS, KINDS
from tools.documents.integrators import four_bar, pendulum

Run = Callable[[], Any]
FORMULATIONS = ("independent", "reference")
INTERVAL = 0.3
"""s, of the short simulations."""


def runs() -> Iterator[tuple[str, Run]]:
    """All, by name."""
    for module in pkgutil.iter_modules(mbsd.dynamics.integrators.__path__):
        importlib.import_module(f"mbsd.dynamics.integrators.{module.name}")
    yield from _kinds()
    yield from _integrators()
    yield from _formulations()
    yield from _contacts()
    yield from _analyses()


def _pair(name: str) -> tuple[Mechanism, Any, Any]:
    """Two bodies that move freely, and a marker on each, off their centres of mass."""
    m = Mechanism(name)
    first = m.body("first", 1.2, (0.1, -0.2), 0.3)
    second = m.body("second", 1.5, (0.3, 0.05), 0.2)
    m.start_near(first=(0.2, 0.1, 10.0), second=(1.1, 0.4, 40.0))
    m.start_moving(first=(0.1, 0.2, 0.5), second=(-0.2, 0.3, -0.4))
    return m, first.at(0.11, 0.2, 0.3), second.at(-0.4, 0.5, -0.6)


def _example(kind: Any, **options: Any) -> Any:
    m, i, j = _pair(kind.name)
    kind.example(m, i, j)
    return m.simulate(INTERVAL, steps=12, **options)


def _kinds() -> Iterator[tuple[str, Run]]:
    registries = {"joint": KINDS, "force": FORCE_KINDS, "contact": CONTACT_KINDS}
    for what, kinds in registries.items():
        meeting = {name for name, kind in KINDS.items() if kind.problem}  # must stand where they meet: see the gallery
        for name in sorted(kinds.keys() - meeting):
            yield f"{what} {name}", partial(_example, kinds[name])


def _integrators() -> Iterator[tuple[str, Run]]:
    for name in sorted(INTEGRATORS):
        method = INTEGRATORS[name]
        if method.package:
            continue  # what another library computes
        step = 0.01 if method.fixed_step else None
        for make in (pendulum, four_bar):

            def run(make=make, name=name, step=step):
                return make().simulate(INTERVAL, steps=7, method=name, step=step, formulation="reference")

            yield f"integrator {name}, {make.__name__}", run


def _formulations() -> Iterator[tuple[str, Run]]:
    makers: dict[str, Callable[[], Mechanism]] = {
        "pendulum": pendulum,
        "four_bar": four_bar,
        "driven_pair": driven_pair,
        "slider_crank": slider_crank,
        "chain of 5": partial(chain, 5),
    }
    for formulation in FORMULATIONS:
        for name, make in makers.items():

            def run(make=make, formulation=formulation):
                return make().simulate(1.0, steps=40, tolerance=1e-9, formulation=formulation)

            yield f"{formulation} {name}", run
        for name in ("A01 pendulum", "A02 N=3", "A03 squeezer"):
            yield f"{formulation} {name}", partial(_benchmark, name, formulation)
    yield "chain with friction", lambda: friction_chain(3).simulate(1.0, steps=40, tolerance=1e-9)
    yield "chain of 60", lambda: chain(60).simulate(0.3, steps=10)


def _benchmark(name: str, formulation: str) -> Any:
    problem = case(name)
    m = mbsd_code.mechanism(problem.model, name.replace(" ", "_"))
    return m.simulate(problem.duration, steps=50, formulation=formulation)


def _contacts() -> Iterator[tuple[str, Run]]:
    for restitution in (0.0, 0.6):
        for friction in (0.0, 0.4):
            yield f"ball {restitution:g} {friction:g}", partial(_ball, restitution, friction)
            yield f"box {restitution:g} {friction:g}", partial(_box, restitution, friction)
    yield "pendulum against a stop", _stopped
    yield "rod with friction that sticks", _sticking


def _analyses() -> Iterator[tuple[str, Run]]:
    def hanging() -> Mechanism:
        m = chain(3)
        m.spring("spring", m.ground.at(1.0, 0.0), m.bodies["rod2"].end, 40.0, damping=0.3, free_length=0.4)
        return m

    yield "equilibrium", lambda: _of_rest(hanging())
    yield "linearise", lambda: _plain(_of_rest(hanging())[1].linearise())
    yield "modes", lambda: [(mode.eigenvalue, mode.shape) for mode in _of_rest(hanging())[1].modes()]
    yield "batch", _batch
    yield "sweep by Newton-Raphson", _newton
    yield "sweep in closed form", lambda: driven_four_bar().sweep(steps=60)
    yield "mobility", lambda: [driven_four_bar().mobility().dof, chain(4).mobility().dof]
    yield "inverse dynamics", _inverse


def driven_four_bar() -> Mechanism:
    """A crank-rocker whose crank is driven."""
    m = Mechanism("driven_four_bar")
    crank, coupler, rocker = m.bar("crank", 0.1, 0.5), m.bar("coupler", 0.38, 1.0), m.bar("rocker", 0.3, 0.7)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", rocker.start, m.ground.at(0.4, 0.02))
    m.drive_angle("motor", crank, constant_rate(6.0))
    m.trace("P", coupler.at(0.2, 0.1))
    m.start_near(crank=0, coupler=45, rocker=90)
    return m


def driven_pair() -> Mechanism:
    """A rod hung on a driven crank."""
    m = Mechanism("driven_pair")
    crank, rod = m.bar("crank", 0.4, 1.0), m.bar("rod", 0.7, 0.8)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, rod.start)
    m.drive_angle("motor", crank, harmonic(0.6, 5.0, 0.2, 0.3))
    m.start_near(rod=-60)
    return m


def slider_crank() -> Mechanism:
    """Pushed and damped, its crank free."""
    m = Mechanism("slider_crank")
    crank, rod, slider = m.bar("crank", 0.1, 0.8), m.bar("rod", 0.35, 0.6), m.body("slider", 1.5, inertia=0.01)
    m.revolute("A", m.ground.origin, crank.start)
    m.revolute("B", crank.end, rod.start)
    m.revolute("C", rod.end, slider.origin)
    m.prismatic("guide", m.ground.origin, slider.origin)
    m.spring("spring", m.ground.at(0.6, 0.05), slider.origin, 150.0, damping=8.0, free_length=0.2)
    m.torque("motor", crank, lambda t: 2.0 + t)
    m.start_near(crank=60, rod=-15, slider=(0.38, 0, 0))
    return m


def chain(count: int) -> Mechanism:
    """Rods hung one on the other, let go from a crooked pose."""
    m = Mechanism("chain")
    end = m.ground.origin
    for k in range(count):
        rod = m.bar(f"rod{k}", 0.3, mass=0.5 + 0.1 * (k % 4))
        m.revolute(f"pin{k}", end, rod.start)
        m.start_near(**{f"rod{k}": -90.0 + 25.0 * (-1) ** k})
        end = rod.end
    return m


def friction_chain(count: int) -> Mechanism:
    """The same with friction in its pins."""
    m = chain(count)
    for k in range(count):
        m.friction(f"rub{k}", f"pin{k}", coefficient=0.2, radius=0.01)
    return m


def _ball(restitution: float, friction: float) -> Any:
    m = Mechanism("ball")
    body = m.body("ball", 2.0, inertia=0.1)
    m.rigid_contact("floor", m.ground.origin, body.origin, radius=0.1, restitution=restitution, friction=friction)
    m.start_near(ball=(0, 0.4, 0))
    m.start_moving(ball=(0.5, 0, 0))
    return m.simulate(1.0, steps=50)


def _box(restitution: float, friction: float) -> Any:
    m = Mechanism("box")
    body = m.body("box", 4.0, inertia=0.4)
    for k, x in enumerate((-0.5, 0.5)):
        ends = m.ground.origin, body.at(x, -0.25)
        m.rigid_contact(f"foot {k}", *ends, restitution=restitution, friction=friction)
    m.start_near(box=(0, 0.35, 4.0))
    m.start_moving(box=(0.3, 0, 0))
    return m.simulate(0.8, steps=40)


def _stopped() -> Any:
    m = pendulum()
    m.angle_stop("stop", m.ground.origin, m.bodies["rod"].start, -1.9, restitution=0.5)
    return m.simulate(2.0, steps=60)


def _sticking() -> Any:
    m = Mechanism("sticking")
    rod = m.bar("rod", 0.5, mass=1.0)
    m.revolute("A", m.ground.origin, rod.start)
    m.friction("rub", "A", coefficient=0.4, radius=0.12, sticks=True)
    m.start_near(rod=-20)
    return m.simulate(2.0, steps=60)


def _of_rest(m: Mechanism) -> Any:
    rest = m.equilibrium()
    return rest.solution, rest.model, rest.stiffness, rest.stability


def _batch() -> Any:
    lengths = {"crank": np.linspace(0.08, 0.12, 9), "coupler": np.linspace(0.42, 0.30, 9)}
    return driven_four_bar().batch(lengths=lengths, angles=("rocker",), steps=45, threads=1)


def _newton() -> Any:
    return kinematics_at(dataclasses.replace(prepare(driven_four_bar()), groups=None), np.linspace(0.0, 1.0, 40))


def _inverse() -> Any:
    m = slider_crank()
    del m.forces["motor"]
    m.torque("motor", m.bodies["crank"], 0.0)
    m.drive_coordinate("way", m.ground.origin, m.bodies["slider"].origin, harmonic(0.03, 5.0, 0.2, 0.37))
    made = m.inverse_dynamics(m.sweep(1.0, steps=50), ["motor"])
    return made.efforts, made.residual


def _plain(linear: Any) -> Any:
    return linear.a, linear.b, linear.c, linear.mass
