"""Variables of a synthesis: names with bounds as one vector, and the author's functions that use them."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from mbsd.base.arguments import described, named_parameters, number_array
from mbsd.base.errors import MechanismError, ModelError
from mbsd.base.names import no_such, shown
from mbsd.model.mechanism import Model
from mbsd.numbers.names import Number

Value = float | tuple[float, ...]
FORM = 'give "name": (lowest, highest), or for a place "name": ((lowest, highest), (lowest, highest))'


@dataclass(frozen=True)
class Varied:
    """Names, and the columns of the vector that are theirs."""

    sizes: dict[str, int]
    """Numbers of each name: 1 of a length, 2 of a place; 0 stands for a single number, which is no tuple."""
    low: np.ndarray
    high: np.ndarray
    """(k,) bounds in the units of the numbers themselves (m)."""

    @property
    def count(self) -> int:
        """How many numbers there are."""
        return len(self.low)

    def columns(self) -> list[tuple[str, slice, bool]]:
        """Return each name, the slice of its numbers, and True if it is a single number."""
        out, first = [], 0
        for name, size in self.sizes.items():
            out.append((name, slice(first, first + max(size, 1)), size == 0))
            first += max(size, 1)
        return out

    def values(self, x: np.ndarray) -> dict[str, Value]:
        """Return, by name, the numbers of a vector x (k,)."""
        return {
            name: float(x[part][0]) if single else tuple(float(v) for v in x[part])
            for name, part, single in self.columns()
        }


def varied(name: str, vary: Mapping[str, Any]) -> Varied:
    """Check ``vary`` of the mechanism called ``name``. Raises ModelError."""
    if not isinstance(vary, Mapping) or not vary:
        raise ModelError(f"{name}: fit_path: vary is {shown(vary)}; {FORM}")
    sizes: dict[str, int] = {}
    rows: list[tuple[float, float]] = []
    for key, bounds in vary.items():
        try:
            pairs = number_array(f"{name}: fit_path: bounds of {shown(key)}", bounds, finite=False)
        except ModelError:
            pairs = np.zeros(0)
        if not isinstance(key, str) or pairs.shape[-1:] != (2,) or pairs.ndim not in (1, 2) or not len(pairs):
            raise ModelError(f"{name}: fit_path: bounds of {shown(key)} are {shown(bounds)}; {FORM}")
        wrong = ~(np.isfinite(pairs).all(axis=-1) & (pairs[..., 0] < pairs[..., 1]))
        if wrong.any():
            low, high = np.atleast_2d(pairs)[np.atleast_1d(wrong)][0]
            raise ModelError(
                f"{name}: fit_path: '{key}' may be from {low:g} to {high:g}; the first must be smaller, both finite "
                "(leave out what keeps its value)"
            )
        sizes[key] = 0 if pairs.ndim == 1 else len(pairs)
        rows += [(float(low), float(high)) for low, high in np.atleast_2d(pairs)]
    bounds = np.array(rows)
    return Varied(sizes, bounds[:, 0], bounds[:, 1])


def refuse_names(m: Model, given: Varied) -> None:
    """Raise ModelError for names that are no length or position of ``m``, and for invalid bounds.

    Lengths must be above 0.
    """
    bars = [name for name, body in m.bodies.items() if body.length is not None]
    lengths = [*bars, *(name for name, joint in m.joints.items() if joint.kind.constraints == ("distance",))]
    places = [*m.joints, *m.traces]
    for name, columns, single in given.columns():
        if name not in lengths and name not in places:
            known = [*lengths, *(place for place in places if place not in lengths)]
            raise ModelError(f"{m.name}: fit_path: {no_such('bar, rod, joint or traced point', name, known)}")
        if single and name not in lengths:
            raise ModelError(f"{m.name}: fit_path: '{name}' is a place, so give bounds of x and of y: {_PLACE}")
        if not single and (name not in places or given.sizes[name] != 2):
            what = "a place, so give bounds of x and of y" if name in places else "a length, so give one pair of bounds"
            raise ModelError(f"{m.name}: fit_path: '{name}' is {what}: {_PLACE if name in places else _LENGTH}")
        low, high = float(given.low[columns][0]), float(given.high[columns][0])
        if single and low <= 0.0:
            raise ModelError(
                f"{m.name}: fit_path: '{name}' may be from {low:g} to {high:g} m; a length is above 0, so begin there"
            )


_LENGTH = '"name": (lowest, highest)'
_PLACE = '"name": ((lowest, highest), (lowest, highest))'


def refuse_build(what: str, build: Any, names: Sequence[str]) -> None:
    """Raise ModelError for what is no function of arguments ``names``, as far as its signature says."""
    if not callable(build):
        raise ModelError(f"{what}: build is {shown(build)}; give a function that returns the mechanism")
    parameters = named_parameters(build)
    if parameters is None:
        return
    for name in names:
        if name not in parameters or parameters[name].kind is inspect.Parameter.POSITIONAL_ONLY:
            raise ModelError(f"{what}: build has no argument '{name}'; it has {', '.join(parameters) or 'none'}")
    for name, p in parameters.items():
        if name not in names and p.default is p.empty and p.kind is not p.VAR_POSITIONAL:
            raise ModelError(f"{what}: argument '{name}' of build neither varies nor has a default; give it one")


def numbers_of_build(
    names: Sequence[str], x: np.ndarray, size: np.ndarray, model: Callable[[np.ndarray], Model]
) -> list[Number]:
    """Return the numbers x (k,) of a mechanism that ``model`` builds.

    ``size``: (k,) how far their bounds are apart.
    """

    def place(m: Model, value: float) -> None:
        raise AssertionError("it is built")

    def neighbour(k: int, value: float) -> Model:
        return model(np.where(np.arange(len(x)) == k, value, x))

    return [
        Number(name, float(x[k]), place, partial(neighbour, k), reach=float(size[k])) for k, name in enumerate(names)
    ]


def built(what: str, build: Callable[..., Any], values: Mapping[str, Any]) -> Model:
    """Return the result of ``build``.

    Raises ModelError for anything but a Mechanism, and for errors not of mbsd.
    """
    try:
        made = build(**values)
    except MechanismError:
        raise
    except Exception as error:
        raise ModelError(f"{what}: build fails: {described(error)}") from error
    if not isinstance(made, Model):
        raise ModelError(f"{what}: build returned {type(made).__name__}, not a Mechanism")
    return made
