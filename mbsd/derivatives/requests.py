"""Requests for derivatives: quantities by name, measures, functions of a solution."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from mbsd.base.arguments import described, refuse_other_arguments
from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.base.warning import quiet
from mbsd.derivatives.numbers.terms import rows_of
from mbsd.dynamics.measures.kinds import Measure
from mbsd.dynamics.measures.quantities import ACCELERATIONS, Motions, quantity_named
from mbsd.dynamics.simulate import simulate
from mbsd.kinematics.sweep import sweep
from mbsd.model.mechanism import Model
from mbsd.results.columns import DRIVER, FRAME, JOINT, columns
from mbsd.results.solution import Solution

Wanted = Mapping[str, Callable[[Solution], np.ndarray]]


def wanted(m: Model, of: Any, sol: Solution) -> dict[str, Callable[[Solution], np.ndarray]]:
    """By label, a function that gives a number or numbers of a solution. Raises ModelError for what cannot be."""
    return {label: _function(m, label, each, sol) for label, each in labelled(m, of).items()}


def labelled(m: Model, of: Any) -> dict[str, Any]:
    """Return requests by label: quantities by name, measures, functions. Raises ModelError for anything else."""
    given, of = of, _labelled(of)
    if not isinstance(of, Mapping) or not of:
        raise ModelError(
            f"{m.name}: of is {shown(given)}; give names of quantities, a measure, or labels and quantities: "
            "{'x': 'P.x'}"
        )
    for label, each in of.items():
        if not isinstance(each, str | Measure) and not callable(each):
            raise ModelError(
                f"{m.name}: '{label}' is {shown(each)}; give the name of a quantity, a measure such as "
                "largest('motor.effort') of mbsd.measures, or a function of a solution"
            )
    return {str(label): each for label, each in of.items()}


def _labelled(of: Any) -> Any:
    """Return requests by label: names are their own, a measure alone has that of its quantity."""
    if isinstance(of, Measure):
        return {of.quantity: of}
    of = [of] if isinstance(of, str) or callable(of) else of
    if isinstance(of, list | tuple):
        return {each if isinstance(each, str) else str(k): each for k, each in enumerate(of)}
    return of


OfMotions = Callable[[Motions], np.ndarray]
"""Gives (K, ...) numbers of K motions."""


@dataclass
class OfBodies:
    """Requests for the motion of bodies and traced points alone."""

    by_label: dict[str, OfMotions]
    accelerations: bool
    """True if any of it reads accelerations."""


def of_bodies(m: Model, of: Any) -> OfBodies | None:
    """Return the requests; None where anything asks for more than how bodies move."""
    of = _labelled(of)
    if not isinstance(of, Mapping) or not of:
        return None
    out, every = dict[str, OfMotions](), set[str]()
    for label, each in of.items():
        names = each.quantities if isinstance(each, Measure) else (each,)
        parts = {name: reads_bodies(m, name) for name in names if isinstance(name, str)}
        known = {name: part for name, part in parts.items() if part is not None}
        if len(known) < len(names):
            return None
        out[str(label)] = known[each] if isinstance(each, str) else partial(_measured, each, str(label), known)
        every.update(name.rpartition(".")[2] for name in names)
    return OfBodies(out, bool(every & {*ACCELERATIONS}))


def _measured(measure: Measure, label: str, quantities: Mapping[str, OfMotions], motions: Motions) -> np.ndarray:
    return measure.of(label, motions.t, {name: of(motions) for name, of in quantities.items()})[label]


def reads_bodies(m: Model, name: str) -> OfMotions | None:
    """(K, T) of a quantity of bodies or traced points; None of any other."""
    if name == "kinetic":
        return Motions.kinetic
    whole, _, component = name.rpartition(".")
    if component not in FRAME:
        return None
    if whole in m.bodies and whole != "ground":
        return lambda motions: motions.of_frame(whole, "body", component)
    bare = whole.removeprefix("trace ")
    if (
        whole not in m.bodies
        and bare in m.traces
        and (bare != whole or whole not in {*m.joints, *m.drivers, *m.forces})
    ):
        return lambda motions: motions.of_frame(bare, "trace", component)
    return None


def reads_forces(m: Model, name: str) -> Callable[[Solution], np.ndarray] | None:
    """(T,) of a quantity that is clearly one of a joint, a driver or the potential energy; None of any other."""
    whole, _, component = name.rpartition(".")
    if name == "potential":
        return lambda sol: sol.energy.potential
    if whole in m.bodies or whole in m.traces:
        return None
    if whole in m.joints and component in JOINT:
        return lambda sol: getattr(sol.joint(whole), component)
    if whole in m.drivers and component in DRIVER:
        return lambda sol: getattr(sol.driver(whole), component)
    return None


def needed(of: Any, t: np.ndarray) -> np.ndarray:
    """Rows of output times (T,) of which tangents are asked: where measures alone are, those that they read."""
    given = _each(of)
    if not given or not all(isinstance(each, Measure) for each in given):
        return np.arange(len(t))
    return np.unique(np.concatenate([each.needed(t) for each in given]))


def needs_models(of: Any) -> bool:
    """Return True if a function of the user may ask the mechanism of a solution."""
    return any(callable(each) for each in _each(of))


def needs_reactions(m: Model, of: Any) -> bool:
    """Return True if anything may ask for the reactions of joints."""
    given = _each(of)
    names = [[each] if isinstance(each, str) else getattr(each, "quantities", [""]) for each in given]
    things = {name.rpartition(".")[0] for own in names for name in own}
    return not things <= {*m.bodies, *m.traces, *m.drivers} or bool(things & {*m.joints})


def _each(of: Any) -> list[Any]:
    return list(of.values()) if isinstance(of, Mapping) else list(of) if isinstance(of, list | tuple) else [of]


def _function(m: Model, label: str, given: Any, sol: Solution) -> Callable[[Solution], np.ndarray]:
    if isinstance(given, str):
        return _quantity(m, given, sol)
    if isinstance(given, Measure):
        given.check(f"{m.name}: '{label}'", sol.t)
        quantities = {name: _quantity(m, name, sol) for name in given.quantities}

        def measured(sol: Solution) -> np.ndarray:
            along = {name: quantity(sol)[None] for name, quantity in quantities.items()}
            return given.of(label, sol.t, along)[label][0]

        return measured
    return lambda other: _numbers(m, label, given, other, finite=other is sol)


def _quantity(m: Model, name: str, sol: Solution) -> Callable[[Solution], np.ndarray]:
    """(T,) of a quantity by name, without all others."""
    if name == "work":
        raise ModelError(f"{m.name}: derivatives of 'work' are not known; take the integral of a power, or 'kinetic'")
    whole, _, component = name.rpartition(".")
    if whole in m.bodies and whole != "ground" and component in FRAME:
        return lambda sol: getattr(sol.body(whole), component)
    of_force = reads_forces(m, name)
    if of_force is not None:
        return of_force
    known = list(columns(rows_of(sol, np.arange(1))))
    quantity = quantity_named(m, name, known)
    title = whole.split(" ", 1)[-1] if whole.split(" ", 1)[0] in ("joint", "driver", "force") else whole
    if whole in m.bodies or name == "kinetic" or whole.startswith("trace "):
        return quantity.of_solution
    if title in m.joints and component in JOINT:
        return lambda sol: getattr(sol.joint(title), component)
    if title in m.drivers:
        return lambda sol: getattr(sol.driver(title), component)
    column = next((column for column in known if column.rpartition(" [")[0] == name), "")
    if title in m.forces and column:
        return lambda sol: sol.force(title).columns(whole)[column]
    return quantity.of_solution


def _numbers(m: Model, label: str, given: Callable[[Solution], Any], sol: Solution, finite: bool) -> np.ndarray:
    """Return what a function of the user gives. Raises ModelError for no numbers, or for infinite ones if that matters.

    Beside the motion itself NaN stands for what has no derivative.
    """
    try:
        value = given(sol)
    except Exception as error:
        raise ModelError(f"{m.name}: the function '{label}' fails: {described(error)}") from error
    try:
        out = np.asarray(value)
    except (TypeError, ValueError):  # rows of several lengths
        out = np.asarray(None)
    if out.dtype.kind not in "fiu" or not out.size or (finite and not np.isfinite(out).all()):
        raise ModelError(f"{m.name}: '{label}' gives {shown(value)}; it must give a number, or an array of them")
    return out.astype(float)


INSTANT = 1e-9
"""s of a simulation that tells the names of quantities."""


def refuse_unfit(m: Model, wishes: Sequence[tuple[str, Any]], grid: np.ndarray, free: bool) -> None:
    """Raise ModelError for quantities that there are not, and for what does not suit output times (T,) (s).

    ``wishes`` are quantities by name, measures and functions, each with the words that an error begins
    with. Names that may not be are looked for in the motion at its start: a simulation if it is ``free``, else a sweep.
    """
    names: list[str] = []
    for what, wish in wishes:
        if isinstance(wish, Measure):
            wish.check(what, grid)
            names += wish.quantities
        elif isinstance(wish, str):
            names.append(wish)
        elif callable(wish):
            refuse_other_arguments(what, wish, "a solution")
    doubtful = [name for name in names if reads_bodies(m, name) is None and reads_forces(m, name) is None]
    if not doubtful:
        return
    with quiet():  # the motion itself says it again
        if free:
            first = simulate(m, None, 1, grid[0] + INSTANT * np.arange(2.0), "dop853", 1e-6, None, None, {})
        else:
            first = sweep(m, None, 1, grid[:1])
    known = list(columns(first))
    for name in doubtful:
        quantity_named(m, name, known)
