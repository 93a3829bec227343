"""Sensitivities: what of a motion changes how much with which number of the model."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, fields
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.base.names import Suggesting, names_in, no_such
from mbsd.derivatives.driven.sweeps import SweepTangents
from mbsd.derivatives.free.indexing import watched
from mbsd.derivatives.requests import (
    Wanted,
    labelled,
    needed,
    needs_models,
    needs_reactions,
    of_bodies,
    refuse_unfit,
    wanted,
)
from mbsd.derivatives.simulations import SimulationTangents
from mbsd.dynamics.prepare.large import mobility
from mbsd.dynamics.repeated import Repeated
from mbsd.dynamics.simulate import output_times, refuse_bad_steps
from mbsd.kinematics.sweep import sweep, sweep_times
from mbsd.model.mechanism import Model
from mbsd.numbers.names import Number, numbers_named
from mbsd.results.solution import Solution

if TYPE_CHECKING:
    import pandas


class Tangents(Protocol):
    """A motion, and others along its tangents."""

    t: np.ndarray
    """(T,) s of its outputs."""
    values: dict[str, np.ndarray]
    """What was asked for, where it is known already."""
    slopes: dict[str, np.ndarray]
    """Derivatives (..., P) of the same."""

    def solve(self) -> Solution:
        """The motion as a solution."""
        ...

    def moved(self, k: int, reactions: bool = True) -> list[Solution]:
        """The motion at other values of number k, where its tangents are asked for; without ``reactions`` of joints."""
        ...

    def weights(self, k: int) -> np.ndarray:
        """Return weights of these in a derivative by number k."""
        ...

    def models(self, k: int, number: Number) -> list[Callable[[], Model]]:
        """Return the function that makes the mechanisms of these."""
        ...


@dataclass(frozen=True, eq=False)
class Sensitivities(Suggesting):
    """Derivatives of quantities by numbers of the model, at T times."""

    t: np.ndarray
    """(T,) s."""
    numbers: tuple[str, ...]
    """(P,) by which is differentiated."""
    values: dict[str, np.ndarray]
    """(T,) of each quantity, or one number of each measure."""
    slopes: dict[str, np.ndarray]
    """(T, P), or (P,) of a measure: SI units of the quantity by those of the number."""
    solve: Callable[[], Solution] = field(repr=False)
    """Gives ``solution``."""

    @cached_property
    def solution(self) -> Solution:
        """The motion, with its reactions."""
        return self.solve()

    def __getstate__(self) -> dict[str, Any]:
        solution = self.solution
        return {**self.__dict__, "solve": partial(_itself, solution)}

    def __getitem__(self, label: str) -> np.ndarray:
        """Derivatives of one quantity. Raises ModelError for one that there is not."""
        if label not in self.slopes:
            raise ModelError(f"sensitivities: {no_such('quantity', label, self.slopes)}")
        return self.slopes[label]

    def of(self, label: str, number: str) -> np.ndarray:
        """(T,) of one quantity by one number. Raises ModelError for one that there is not."""
        if number not in self.numbers:
            raise ModelError(f"sensitivities: {no_such('number', number, self.numbers)}")
        return self[label][..., self.numbers.index(number)]

    def table(self) -> pandas.DataFrame:
        """As a pandas DataFrame over time, a column for each quantity and number. Needs the extra ``pandas``."""
        try:
            import pandas
        except ImportError as error:
            raise ModelError("table needs pandas: install mbsd[pandas]") from error
        columns = {
            f"d {label} / d {number}": slope[:, k]
            for label, slope in self.slopes.items()
            if slope.ndim == 2 and len(slope) == len(self.t)
            for k, number in enumerate(self.numbers)
        }
        return pandas.DataFrame({"t": self.t} | columns)

    def __repr__(self) -> str:
        return f"<Sensitivities of {', '.join(self.slopes)} by {', '.join(self.numbers)}>"


def values_and_slopes(
    m: Model, of: Any, tangents: Tangents, numbers: Sequence[Number]
) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """By label, what is asked ``of`` a motion, and its derivatives (..., P) by all numbers. Raises ModelError."""
    values, slopes = tangents.values, tangents.slopes
    if not values and of:
        sol = tangents.solve()
        functions = wanted(m, of, sol)
        values = {label: np.asarray(function(sol)) for label, function in functions.items()}
        slopes = _slopes_along(tangents, numbers, functions, needs_models(of), needs_reactions(m, of))
    for label, slope in slopes.items():
        if not np.isfinite(slope).all() and np.isfinite(values[label]).all():
            raise ModelError(
                f"{m.name}: '{label}' has no derivative: reactions of joints that repeat others, and friction that "
                "contacts at rest share, are not known along a simulation. Free a joint, m.mobility() says which, or "
                "ask for the motion alone"
            )
    return values, slopes


def _slopes_along(
    tangents: Tangents, numbers: Sequence[Number], functions: Wanted, models: bool, reactions: bool
) -> dict[str, np.ndarray]:
    """By label, derivatives (..., P) by all numbers of what functions of a solution give.

    With ``models`` the solutions have mechanisms with the other numbers, for functions that ask them; without
    ``reactions`` those of joints are left out.
    """
    columns: dict[str, list[np.ndarray]] = {label: [] for label in functions}
    for k, number in enumerate(numbers):
        moved, weights = tangents.moved(k, reactions), tangents.weights(k)
        if models:
            moved = [with_model(sol, make) for sol, make in zip(moved, tangents.models(k, number), strict=True)]
        for label, function in functions.items():
            columns[label].append(np.sum([w * function(sol) for w, sol in zip(weights, moved, strict=True)], axis=0))
    return {label: np.stack(column, axis=-1) for label, column in columns.items()}


def _itself(solution: Solution) -> Solution:
    return solution


def sensitivities(
    m: Model,
    of: Any,
    to: Sequence[str] | str,
    duration: float | None,
    steps: int,
    times: Sequence[float] | np.ndarray | None,
    simulated: bool | None = None,
    tolerance: float = 1e-9,
) -> Sensitivities:
    """See :meth:`mbsd.mechanism.Mechanism.sensitivities`."""
    numbers: list[Number] = numbers_named(m, names_in(f"{m.name}: sensitivities: to", to))
    tangents: Tangents
    free = moves_freely(m) if simulated is None else simulated
    grid = output_times(m, duration, steps, times) if free else sweep_times(m, duration, steps, times)
    refuse_bad_steps(m, grid, tolerance, None)
    asked = labelled(m, of)
    refuse_unfit(m, [(f"{m.name}: '{label}'", each) for label, each in asked.items()], grid, free)
    if free:
        tangents = simulation_tangents(m, grid, numbers, tolerance, of)
    else:
        tangents = SweepTangents(m, sweep(m, duration, steps, times), numbers)
    values, slopes = values_and_slopes(m, of, tangents, numbers)
    return Sensitivities(tangents.t, tuple(number.name for number in numbers), values, slopes, tangents.solve)


def moves_freely(m: Model) -> bool:
    """Return True if drivers leave a freedom, so that forces decide the motion."""
    rows = sum(joint.kind.rows for joint in m.joints.values())
    if 3 * (len(m.bodies) - 1) - rows > len(m.drivers):  # joints that repeat others leave more freedoms, never fewer
        return True
    return mobility(m).dof > len(m.drivers)


def simulation_tangents(
    m: Model, grid: np.ndarray, numbers: Sequence[Number], tolerance: float, of: Any
) -> SimulationTangents:
    """Simulate at output times (T,) (s), with tangents by numbers where what is asked ``of`` the motion reads them."""
    refuse_bad_steps(m, grid, tolerance, None)
    return SimulationTangents(
        m, Repeated(watched(m), grid, tolerance), grid, numbers, partial(needed, of), of_bodies(m, of)
    )


class _Later:
    """The attribute: a mechanism, or what makes one."""

    def __get__(self, sol: Any, owner: type) -> Any:
        if sol is None:
            return self
        held = sol.__dict__["mechanism"]
        if isinstance(held, Model):
            return held
        sol.__dict__["mechanism"] = made = held()
        return made

    def __set__(self, sol: Any, value: Any) -> None:
        sol.__dict__["mechanism"] = value


class _WithModel(Solution[Any]):
    mechanism = _Later()  # pyright: ignore[reportAssignmentType]


def with_model(sol: Solution, make: Callable[[], Model]) -> Solution:
    """The solution with the mechanism that ``make`` gives."""
    out = object.__new__(_WithModel)
    out.__dict__.update({part.name: sol.__dict__[part.name] for part in fields(sol)}, mechanism=make)
    return out
