"""Results: a measure of a quantity, or a function of the user, as one number for each mechanism."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from mbsd.base.arguments import described
from mbsd.base.errors import MechanismError, ModelError
from mbsd.base.names import shown
from mbsd.dynamics.measures.kinds import Measure
from mbsd.dynamics.measures.quantities import Quantity, quantity_named
from mbsd.model.mechanism import Model

NAME = "result"


class NoNumber(ModelError):
    """The function that gives the result gives something else than a number."""


class FailingResult(ModelError):
    """The function that gives the result raised an error."""

    @property
    def reason(self) -> str:
        """Return the error as the reason of a mechanism."""
        return f"the result fails: {described(self.__cause__ or self)}"


def result_given(owner: str, result: Any) -> Measure | Callable[[Any], Any]:
    """``result``, which must be a measure or a function. Raises ModelError."""
    if isinstance(result, Measure) or (callable(result) and not isinstance(result, type)):
        return result
    raise ModelError(
        f"{owner}: tolerances: result is {shown(result)}; give a measure of mbsd.measures, such as largest('P.y') or "
        "samples('P.y', [0.25]), or a function that gives a number"
    )


def named_after(result: Any) -> str:
    """Return the name of a result: its measure's quantity, or its function."""
    if isinstance(result, Measure):
        return result.quantity
    name = getattr(result, "__name__", "")
    return name if name.isidentifier() else NAME


def numbers_of_batch(owner: str, given: Any, count: int) -> np.ndarray:
    """(n,) what a function of a Batch gave. Raises ModelError for anything else."""
    values = np.asarray(given)
    if values.dtype.kind not in "fiub" or values.shape != (count,):
        what = f"an array {values.shape}" if values.dtype.kind in "fiub" and values.ndim else shown(given)
        raise ModelError(
            f"{owner}: tolerances: result gives {what} of {count} machine{'s' * (count > 1)}; it must give a number of "
            'each, as in lambda batch: batch.points["P"][:, :, 1].max(axis=1)'
        )
    return values.astype(float)


def number_of(owner: str, given: Any) -> float:
    """Return the number that a function of a single mechanism gave. Raises ModelError for no number."""
    value = given.item() if getattr(given, "size", 0) == 1 and hasattr(given, "item") else given
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise NoNumber(f"{owner}: tolerances: result gives {shown(given)}; it must give a number")
    return float(value)


def called(owner: str, function: Callable[..., Any], *given: Any, **named: Any) -> Any:
    """Return the result of a function of the user.

    Raises FailingResult for its errors, but for errors of mechanisms.
    """
    try:
        return function(*given, **named)
    except MechanismError:
        raise
    except Exception as error:
        raise FailingResult(f"{owner}: tolerances: result fails: {described(error)}") from error


def measured(owner: str, measure: Measure, t: np.ndarray, along: Mapping[str, np.ndarray]) -> np.ndarray:
    """(n,) of a measure that gives a number a machine. Raises ModelError for one that gives several."""
    values = measure.of(NAME, t, along)[NAME]
    if values.ndim > 1 and values.shape[1] != 1:
        raise ModelError(
            f"{owner}: tolerances: result gives {values.shape[1]} numbers of '{measure.quantity}'; it must give a "
            "single one: one time, or the largest or smallest"
        )
    return values.reshape(len(values))


class OfSolution:
    """The result of a single solution of ``m``."""

    def __init__(self, m: Model, result: Measure | Callable[[Any], Any]) -> None:
        self.owner, self.result = m.name, result
        self._quantities: dict[str, Quantity] = {}

    def __call__(self, sol: Any) -> float:
        """The number. Raises ModelError for none."""
        if not isinstance(self.result, Measure):
            return number_of(self.owner, called(self.owner, self.result, sol))
        along = {name: self._quantity(sol, name)[None] for name in self.result.quantities}
        return float(measured(self.owner, self.result, sol.t, along)[0])

    def _quantity(self, sol: Any, name: str) -> np.ndarray:
        if name not in self._quantities:
            self._quantities[name] = quantity_named(sol.mechanism, name, list(sol.columns()))
        return np.asarray(self._quantities[name].of_solution(sol))


def placed(m: Model, name: str) -> tuple[str, str, str] | None:
    """Return "body" or "trace", the name and the component of a quantity that ``batch`` gives; else None."""
    whole, _, component = name.rpartition(".")
    if whole in m.bodies:
        return ("body", whole, component) if component in ("x", "y", "theta") else None
    bare = whole.removeprefix("trace ")
    taken = bare == whole and whole in {*m.joints, *m.drivers, *m.forces}
    return ("trace", bare, component) if bare in m.traces and not taken and component in ("x", "y") else None
