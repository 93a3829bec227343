"""Quantities of a motion by name, for measures: the columns of a solution, without their units.

    door.theta   P.vx   A.fx   motor.effort   spring.length   kinetic   work

Where two things have one name, ``joint A.fx``, ``trace A.x``, ``driver A.power`` or ``force A.length`` says which is
meant. Motions of bodies and traced points, reactions of joints, drivers, kinetic energy and work are found of
many simulations at once; the others are those of single solutions.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.base.names import no_such
from mbsd.model.mechanism import Model
from mbsd.results.columns import FRAME
from mbsd.results.solution import Solution
from mbsd.results.views import moved_frame

ACCELERATIONS = ("ax", "ay", "alpha")
TURNS = ("theta", "omega")
WRENCH = ("fx", "fy", "torque")
"""Components of the reaction of a joint that are found of many at once."""


@dataclass
class Reactive:
    """Reactions and efforts of R simulations at T outputs."""

    joints: list[int]
    """Numbers of the joints whose reactions are wanted."""
    wrench: np.ndarray
    """(R, T, joints, 3) of these, as ``Solution.wrench``."""
    lam: np.ndarray
    """(R, T, drivers) and rows of what comes behind."""
    drives: np.ndarray
    """(T, drivers + 1, 3), or the same for each simulation."""


@dataclass
class Motions:
    """R simulations at T outputs, of one mechanism but for its numbers."""

    body_names: list[str]
    q: np.ndarray
    """(R, T, nb, 3) centres of mass, as v and a."""
    v: np.ndarray
    a: np.ndarray
    work: np.ndarray
    """(R, T) J."""
    com: np.ndarray
    """(R or 1, nb, 2) in the author's frames (m)."""
    mass: np.ndarray
    """(R or 1, nb), as ``inertia``."""
    inertia: np.ndarray
    traces: dict[str, tuple[int, np.ndarray, np.ndarray]]
    """For each traced point its body, its places (R or 1, 2) in the author's frame (m), and angles (R or 1,) (rad)."""
    t: np.ndarray
    """(T,) s, or (R, T) where events of the user ended some before."""
    reactive: Reactive | None = None
    """If any measure reads it."""
    kept: dict[Any, Any] = field(default_factory=dict)

    def frame(self, body: int, place: np.ndarray) -> Any:
        """Motion of places (R or 1, 2) of a body, as (R T,) arrays."""
        count, times = self.q.shape[:2]
        local = np.broadcast_to(place - self.com[:, body], (count, 2)).repeat(times, axis=0)
        q, v, a = (np.ascontiguousarray(part[:, :, body]).reshape(-1, 3) for part in (self.q, self.v, self.a))
        return moved_frame(q, v, a, local.T)

    def of_frame(self, name: str, kind: str, component: str) -> np.ndarray:
        """(R, T) of one component of a body or a traced point."""
        if kind == "body":
            body, place, angle = self.body_names.index(name), np.zeros((1, 2)), np.zeros(1)
        else:
            body, place, angle = self.traces[name]
        shape = self.q.shape[:2]
        direct = {"theta": self.q, "omega": self.v, "alpha": self.a}.get(component)
        if direct is not None:
            return direct[:, :, body, 2] + angle[:, None] if component == "theta" else direct[:, :, body, 2]
        if (kind, name) not in self.kept:
            self.kept[kind, name] = self.frame(body, place)
        return getattr(self.kept[kind, name], component).reshape(shape)

    def of_joint(self, number: int, component: int) -> np.ndarray:
        """(R, T) N or N m."""
        assert self.reactive is not None
        return self.reactive.wrench[:, :, self.reactive.joints.index(number), component]

    def of_driver(self, number: int, component: str) -> np.ndarray:
        """(R, T) of one component of a driver."""
        assert self.reactive is not None
        effort, drive = -self.reactive.lam[:, :, number], self.reactive.drives[..., number + 1, :]
        if component == "value":
            return np.broadcast_to(drive[..., 0], effort.shape)
        return effort if component == "effort" else effort * drive[..., 1]

    def kinetic(self) -> np.ndarray:
        """(R, T) J."""
        v, mass, inertia = self.v, self.mass[:, None], self.inertia[:, None]
        return 0.5 * (mass * (v[..., 0] ** 2 + v[..., 1] ** 2) + inertia * v[..., 2] ** 2).sum(axis=-1)


@dataclass(frozen=True)
class Quantity:
    """One quantity by name."""

    name: str
    of_solution: Callable[[Solution], np.ndarray]
    """(T,) of a single solution."""
    of_motions: Callable[[Motions], np.ndarray] | None = None
    """(R, T), if it is found of many at once."""
    reactive: bool = False
    """True if it comes from multipliers."""
    joint: int | None = None
    """Number of the joint whose reaction it is, if so."""
    turn: tuple[str, int] | None = None
    """Body whose angle (0) or angular velocity (1) it is, if so: a number of the state itself."""

    @property
    def forces(self) -> bool:
        """True if it comes from multipliers or accelerations."""
        return self.reactive or self.name.rpartition(".")[2] in ACCELERATIONS


def quantity_named(m: Model, name: str, columns: list[str]) -> Quantity:
    """The quantity of this name; ``columns`` are those of a solution. Raises ModelError for one that there is not."""
    plain = [column.rpartition(" [")[0] for column in columns]
    known = dict(zip(plain, columns, strict=True))
    whole, _, component = name.rpartition(".")
    if name == "t":
        return Quantity(name, lambda sol: sol.t, lambda motions: np.broadcast_to(motions.t, motions.work.shape))
    if name == "work":
        return Quantity(name, _work, lambda motions: motions.work)
    if name == "kinetic":
        return Quantity(name, lambda sol: sol.energy.kinetic, Motions.kinetic)
    bare = whole.removeprefix("trace ")
    traced = whole not in m.bodies and bare in m.traces and component in FRAME
    if name not in known and not traced:
        raise ModelError(f"{m.name}: measure: {no_such('quantity', name, ['t', *plain, 'work'])}")
    if whole in m.bodies and component in FRAME:
        return Quantity(
            name,
            lambda sol: getattr(sol.body(whole), component),
            lambda motions: motions.of_frame(whole, "body", component),
            turn=(whole, TURNS.index(component)) if component in TURNS else None,
        )
    if traced and (bare != whole or whole not in {*m.joints, *m.drivers, *m.forces}):
        return Quantity(
            name,
            lambda sol: getattr(sol.point(bare), component),
            lambda motions: motions.of_frame(bare, "trace", component),
        )
    if name not in known:
        shared = [column for column in plain if column.endswith(f" {name}")]
        raise ModelError(f"{m.name}: measure: '{whole}' names several things; say which: {', '.join(shared)}")
    column = known[name]
    joint, driver = whole.removeprefix("joint "), whole.removeprefix("driver ")
    if joint in m.joints and component in WRENCH:
        number, c = list(m.joints).index(joint), WRENCH.index(component)
        return Quantity(
            name, lambda sol: sol.columns()[column], lambda motions: motions.of_joint(number, c), True, number
        )
    if driver in m.drivers:
        number = list(m.drivers).index(driver)
        return Quantity(
            name, lambda sol: sol.columns()[column], lambda motions: motions.of_driver(number, component), reactive=True
        )
    return Quantity(name, lambda sol: sol.columns()[column])


def _work(sol: Solution) -> np.ndarray:
    assert sol.work is not None
    return sol.work
