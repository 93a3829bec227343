"""Numbers that vary, before anything runs: whether each is another one, and may be as its bounds say."""

from __future__ import annotations

from collections.abc import Sequence

from mbsd.base.errors import ModelError
from mbsd.model.mechanism import Model
from mbsd.numbers.names import Number, number_named, with_values
from mbsd.synthesis.wishes import Bounds


def refuse_ends(m: Model, bounds: Bounds, numbers: Sequence[Number]) -> None:
    """Raise ModelError for two names of one number, and for bounds at whose ends the mechanism refuses the number."""
    for k, number in enumerate(numbers):
        for end in (bounds.low[k], bounds.high[k]):
            try:
                other = with_values(m, [number], [float(end)])
            except ModelError as error:
                said = str(error).removeprefix(f"{m.name}: ")
                raise ModelError(
                    f"{m.name}: optimise: '{number.name}' may be from {bounds.low[k]:g} to {bounds.high[k]:g}, and the "
                    f"mechanism refuses {end:g}: {said}"
                ) from error
            if end == number.value:
                continue
            twin = next((name for name in bounds.names[k + 1 :] if _is_that(m, other, name, number, float(end))), None)
            if twin is not None:
                raise ModelError(
                    f"{m.name}: optimise: '{number.name}' and '{twin}' are the same number; leave out one of them"
                )


def _is_that(m: Model, other: Model, name: str, number: Number, value: float) -> bool:
    """Whether ``name`` is what ``number`` is, which has another ``value`` in the mechanism ``other``."""
    return number_named(m, name).value == number.value and number_named(other, name).value == value
