"""A simulation at other times than its outputs, also after it was pickled: then it is simulated once more."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.results.solution import Solution


class Between:
    """Called with rising times (T,), it gives the motion there."""

    def __init__(
        self, at: Callable[[np.ndarray], Solution] | None, anew: Callable[[], Solution], last: np.ndarray
    ) -> None:
        """``anew`` simulates it again, to the same pose ``last`` (3 nb,) at its end."""
        self.at, self.anew, self.last = at, anew, last

    def __call__(self, times: np.ndarray) -> Solution:
        """Raises ModelError where the mechanism was changed before it was pickled, and does not move so any more."""
        if self.at is None:
            again = self.anew()
            assert isinstance(again.between, Between)
            if not np.array_equal(again.between.last, self.last):
                raise ModelError(
                    f"{again.mechanism.name}: the mechanism was changed after this simulation, so its motion at other "
                    "times is lost; simulate again"
                )
            self.at = again.between.at
        assert self.at is not None
        return self.at(times)

    def __getstate__(self) -> dict[str, Any]:
        """Without the run, which holds compiled functions of this process."""
        return self.__dict__ | {"at": None}
