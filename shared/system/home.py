"""Home folder that is unknown or not writable: libraries keep their files elsewhere."""

from __future__ import annotations

import os
from pathlib import Path

KEPT = {"XDG_CACHE_HOME": "cache", "MPLCONFIGDIR": "matplotlib"}
"""Variables by which libraries find another place for what they keep, and the folder that each gets."""


def without_home(spare: Path) -> None:
    """Keep the files of libraries below ``spare`` if the home folder takes none.

    This holds for this process and those that it starts.

    Otherwise matplotlib warns and looks through all fonts in each process; where there is no home at all (a user whom
    the system knows by number alone, as in a container), libraries fail while they are imported.
    """
    try:
        home = Path.home()
    except RuntimeError:
        home = None
    if home is not None and os.access(home, os.W_OK | os.X_OK):
        return
    if home is None:
        os.environ["HOME"] = str(spare)
    for variable, folder in KEPT.items():
        os.environ.setdefault(variable, str(spare / folder))
