"""Many simulations of a mechanism in space that differ in numbers and starts."""

from __future__ import annotations

import copy
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mbsd.base.arguments import number_array
from mbsd.base.errors import MechanismError, ModelError
from mbsd.base.names import shown
from mbsd.base.warning import quiet
from mbsd.dynamics.batch.simulate_many import Simulations

if TYPE_CHECKING:
    from mbsd.spatial.results.solution import Solution

Values = Sequence[Any] | np.ndarray | float
WHY = "in space each simulation is prepared by itself"


def simulate_many(
    m: Any, measure: Callable[[Solution], Mapping[str, Any]], vary: Mapping[str, Mapping[str, Values]],
    start: Mapping[str, Values], moving: Mapping[str, Values], named: Mapping[str, Any],
) -> Simulations:  # fmt: skip
    """Return measures; see :meth:`mbsd.spatial.mechanism.Mechanism.simulate_many`."""
    if not callable(measure):
        raise ModelError(f"{m.name}: measure is {shown(measure)}; give a function of a solution that returns numbers")
    given = {f"'{name}' {key}": number_array(f"{m.name}: {name}.{key}", values)
             for name, changes in vary.items() for key, values in changes.items()}  # fmt: skip
    given |= {f"start of '{name}'": number_array(f"{m.name}: start of '{name}'", v) for name, v in start.items()}
    given |= {f"rate of '{name}'": number_array(f"{m.name}: rate of '{name}'", v) for name, v in moving.items()}
    counts = {what: len(values) for what, values in given.items() if values.ndim > 0}
    if len(set(counts.values())) > 1:
        said = ", ".join(f"{what} {count}" for what, count in counts.items())
        raise ModelError(f"{m.name}: numbers of values differ: {said}; give as many of each, or one for all")
    count = next(iter(counts.values()), 1)
    reasons, rows = list[str | None](), list[dict[str, np.ndarray] | None]()
    own = copy.deepcopy(m)
    for k in range(count):
        try:
            with quiet():
                rows.append(_one(own, measure, vary, start, moving, named, k))
            reasons.append(None)
        except MechanismError as error:
            if isinstance(error, ModelError) and k == 0:
                raise
            rows.append(None)
            reasons.append(str(error))
    shapes = {key: value.shape for row in rows if row is not None for key, value in row.items()}
    columns = {
        key: np.array([np.full(shape, np.nan) if row is None else row[key] for row in rows])
        for key, shape in shapes.items()
    }
    return Simulations(columns, reasons, [WHY] * count, None)


def _one(
    own: Any, measure: Callable[[Solution], Mapping[str, Any]], vary: Mapping[str, Mapping[str, Values]],
    start: Mapping[str, Values], moving: Mapping[str, Values], named: Mapping[str, Any], k: int,
) -> dict[str, np.ndarray]:  # fmt: skip
    def value(values: Values) -> Any:
        array = np.asarray(values, float)
        entry = array[k] if array.ndim else array
        return entry.tolist()

    for name, changes in vary.items():
        own.change(name, **{key: value(values) for key, values in changes.items()})
    own.start_near({name: value(values) for name, values in start.items()})
    own.start_moving({name: value(values) for name, values in moving.items()})
    return {key: np.asarray(number, float) for key, number in measure(own.simulate(**named)).items()}
