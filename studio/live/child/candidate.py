"""Numbers that a mechanism.py would have with another source: a change in it may have no effect."""

from __future__ import annotations

import os
from typing import Any

from mechanisms.stages.loading import loading
from shared.stage.paths import mechanism_file
from studio.live.numbers import numbers_of


def numbers_with(name: str, source: bytes) -> list[dict[str, Any]]:
    """Return the numbers of Params with ``source`` in place of the file's.

    This process is of no other use afterwards.

    Raises UserError where it cannot be loaded.
    """
    loading.INSTEAD[os.path.realpath(mechanism_file(name))] = source
    return [vars(number) for number in numbers_of(loading.params(name))]
