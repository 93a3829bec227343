"""Numbers that vary, before anything runs: whether each is another one, and may be as its bounds say."""

from __future__ import annotations

from collections.abc import Sequence

from mbsd.base.errors import ModelError
from mbsd.model.mechanism import Model
from mbsd.numbers.names import Number, twin_of, with_values
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
            twin = twin_of(number, other, float(end), numbers[k + 1 :])
            if twin is not None:
                raise ModelError(
                    f"{m.name}: optimise: '{number.name}' and '{twin.name}' are the same number; leave out one of them"
                )
