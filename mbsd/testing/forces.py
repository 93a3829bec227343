"""Checks of a kind of force on random motions: power, action and reaction, potential.

P = Q v,   sum of forces and of moments = 0,   Q = -dV/dq
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from mbsd.arrays.friction_along import normals_along
from mbsd.arrays.laws import compiled_laws
from mbsd.arrays.loads import loads_along, pack_loads
from mbsd.arrays.packing import Packed, pack
from mbsd.arrays.states import ones_of, widened, with_states
from mbsd.base.codes import POTENTIAL_TERMS, PUSH
from mbsd.equations.assembly import tabulate
from mbsd.equations.joint_friction import tabulate_friction
from mbsd.equations.loads import tabulate_loads
from mbsd.mechanism import Mechanism
from mbsd.model.force import Element, Force, ForceKind
from mbsd.results.forces import potential_of
from mbsd.testing.kinds import check_kept, compare, coordinate

SEEDS = range(3)
STEP = 1e-6
"""Step of the differences (m, rad)."""


def check_force(kind: ForceKind, seeds: Iterable[int] = SEEDS) -> None:
    """Check a kind of force between two bodies that move along random paths.

    Its power must be that of its loads; its loads must balance each other, unless it is a load from ``outside``;
    loads of its elastic terms and of its ``potential`` must be the slope of the potential energy. Its example must
    act, and what ``adds`` decorates must keep its arguments. Raises AssertionError.
    """
    for seed in seeds:
        m, packed = example(kind, seed)
        [force] = m.forces.values()
        t, q, v = motion(packed, seed)
        load, power = evaluate(packed, t, q, v)
        what = f"{kind.name}, seed {seed}"
        if not np.abs(load[:, 3:]).max() > 0.0:
            raise AssertionError(f"{what}: the example gives no load, or none that is a number, so nothing is checked")
        compare(
            f"{what}: power against loads times velocities", power, (load * v)[:, 3:].sum(axis=1),
            1e-10 * np.abs(power) + 1e-9 * np.abs(power).max(), lambda k, t=t: f"at t = {t[k]:.3g} s",
        )  # fmt: skip
        if kind.outside:
            _check_others(kind, packed, force, load)
        else:
            _check_reaction(kind, what, force, t, q, load)
        _check_potential(kind, what, packed, force, seed)
        check_kept(m)


def example(kind: ForceKind, seed: int = 0, to_ground: bool = False) -> tuple[Mechanism, Packed]:
    """A mechanism with the example of a kind alone, between bodies with centres of mass off their frames."""
    random = np.random.default_rng(seed)
    m = Mechanism("example")
    first = m.ground if to_ground else m.body("first", 1.0, list(random.normal(size=2)), 1.0)
    second = m.body("second", 1.0, list(random.normal(size=2)), 1.0)
    assert kind.example is not None, "register_force() raises an error without one"
    kind.example(m, first.at(*random.normal(size=3)), second.at(*random.normal(size=3)))
    if [force.kind for force in m.forces.values()] != [kind]:
        raise AssertionError(f"{kind.name}: its example must add one '{kind.name}' and no other force")
    return m, pack(m)


def motion(packed: Packed, seed: int, count: int = 40) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times (T,) and q, v (T, 3 nb) of a smooth random motion of all coordinates; ground rests."""
    random = np.random.default_rng(seed + 50)
    amplitude, phase = random.normal(size=(2, packed.coordinates))
    t = np.linspace(0.0, 1.0, count)
    q, v = np.zeros((2, count, packed.coordinates + 3))
    q[:, 3:] = amplitude * np.sin(2.0 * t[:, None] + phase)
    v[:, 3:] = 2.0 * amplitude * np.cos(2.0 * t[:, None] + phase)
    return t, q, v


def evaluate(packed: Packed, t: np.ndarray, q: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(T, 3 nb) loads and (T,) their power (W).

    Friction acts under reactions by multipliers of 1, 2, 3 ..., forces with states under different ones of ``one``.
    """
    wide = with_states(packed)
    if wide is not packed:
        states = ones_of(wide) * packed.size * (1.0 + 0.5 * np.sin(t[:, None] + np.arange(wide.states)))
        force, power = evaluate(wide, t, widened(wide, q), widened(wide, v, states))
        return force[:, : q.shape[1]], power
    loads, laws = pack_loads(packed), compiled_laws(packed, 0.0, 1.0)
    force, power = np.zeros_like(q), np.zeros(len(t))
    tabulate_loads(packed.system, loads, laws, t, q, v, packed.ws, force, power)
    if len(loads.friction):
        rows = len(packed.ws.phi)
        phi, gamma, compact = *np.zeros((2, len(t), rows)), np.zeros((len(t), rows, 6))
        tabulate(packed.system, packed.drives(t), q, v, packed.ws, phi, compact, gamma)
        normal = normals_along(packed, loads, q, compact, np.tile(1.0 + np.arange(rows), (len(t), 1)))
        tabulate_friction(packed.system, loads, q, v, normal, packed.ws, force, power)
    force[:, :3] = 0.0
    return force, power


def _check_others(kind: ForceKind, packed: Packed, force: Force, load: np.ndarray) -> None:
    """A load from outside acts on its own bodies alone."""
    acted = {force.j.body.name} | {interaction.j.body.name for interaction in kind.interactions(force, packed.masses)}
    for b, name in enumerate(packed.body_names):
        if name not in acted and load[:, 3 * b : 3 * b + 3].any():
            raise AssertionError(f"{kind.name}: a load from outside on '{force.j.body.name}' acts on '{name}', too")


def _check_reaction(kind: ForceKind, what: str, force: Force, t: np.ndarray, q: np.ndarray, load: np.ndarray) -> None:
    """Forces and moments about the world's origin add up to zero."""
    if any(element.kind == PUSH for element in kind.elements(force)):
        raise AssertionError(f"{kind.name}: PUSH acts on one body alone; say outside=True")
    of, place = load.reshape(len(t), -1, 3), q.reshape(len(t), -1, 3)
    moment = of[..., 2] + place[..., 0] * of[..., 1] - place[..., 1] * of[..., 0]
    total = np.column_stack([of[..., :2].sum(axis=1), moment.sum(axis=1)])
    size = np.abs(load).max()
    compare(
        f"{what}: action and reaction", total, 0.0 * total, size * np.array([1e-12, 1e-12, 1e-11]),
        lambda k, c: f"{('force along x', 'force along y', 'moment')[c]} at t = {t[k]:.3g} s",
    )  # fmt: skip


def _check_potential(kind: ForceKind, what: str, packed: Packed, force: Force, seed: int) -> None:
    """Loads of bodies at rest are the slope of the potential energy, but for terms that have none."""
    elements = kind.elements(force)
    terms = {term.kind for element in elements for term in element.terms}
    t, q, v = motion(packed, seed, 7)
    if not terms & set(POTENTIAL_TERMS) and not potential_of(packed, force, q).any():
        return
    load = loads_along(packed, pack_loads(packed), compiled_laws(packed, 0.0, 1.0), t, q, np.zeros_like(v))
    load = load - _without_potential(packed, elements, q)
    for c in range(3, q.shape[1]):
        step = np.zeros(q.shape[1])
        step[c] = STEP
        slope = (potential_of(packed, force, q + step) - potential_of(packed, force, q - step)) / (2 * STEP)
        compare(
            f"{what}: loads against -dV/dq", load[:, c], -slope, 2e-6 * (np.abs(slope) + np.abs(load).max()),
            lambda k, c=c: f"{coordinate(packed.body_names, c)} at t = {t[k]:.3g} s",
        )  # fmt: skip


def _without_potential(packed: Packed, elements: Sequence[Element], q: np.ndarray) -> np.ndarray:
    """Loads at rest that come from no potential: constants, and curves of rate at zero."""
    if not elements:
        return np.zeros_like(q)
    loads, laws = pack_loads(packed), compiled_laws(packed, 0.0, 1.0)
    loads.number[np.isin(loads.term[:, 0], POTENTIAL_TERMS), 0] = 0.0
    return loads_along(packed, loads, laws, np.zeros(len(q)), q, np.zeros_like(q))
