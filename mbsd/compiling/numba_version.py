"""The version of numba that kernels need: they use inner parts, which change between versions."""

from __future__ import annotations

import re

from mbsd.base.errors import MechanismError

OLDEST, NEWEST = (0, 61), (0, 68)
"""The oldest and the newest that is taken, as in pyproject.toml; tests run with that of requirements.lock."""


class NumbaVersionError(MechanismError, ImportError):
    """This numba is not one that the kernels are made for."""


def refuse_other_versions() -> None:
    """Raise NumbaVersionError, with the remedy, unless the installed numba is one of those."""
    import numba

    version = numba.__version__
    numbers = tuple(int(number) for number in re.findall(r"\d+", version)[:2])
    if not OLDEST <= numbers <= NEWEST:
        raise NumbaVersionError(
            f"numba {version} is installed, and this mbsd is made for numba {_shown(OLDEST)} to {_shown(NEWEST)}: "
            f"pip install 'numba>={_shown(OLDEST)},<{_shown((NEWEST[0], NEWEST[1] + 1))}', or take a newer mbsd"
        )


def _shown(version: tuple[int, int]) -> str:
    return ".".join(map(str, version))
