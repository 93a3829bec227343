"""Mechanisms of a test's own, in a folder elsewhere: for the process that serves, and for those it forks.

Importing it in the warm process takes the folder from the environment, and loads what is always loaded.
"""

from __future__ import annotations

import os
from pathlib import Path

import mechanisms
from mechanisms.stages.loading import loading
from shared.stage import paths

FOLDER = "MBSD_TEST_MECHANISMS"


def move(folder: Path) -> None:
    """From now on this process finds its mechanisms in ``folder``, a folder ``mechanisms``."""
    paths.ROOT = folder.parent
    for module in (paths, loading):
        module.MECHANISMS = folder
    mechanisms.__path__ = [*mechanisms.__path__, str(folder)]


if FOLDER in os.environ:
    from studio.live.child.warm import serve  # noqa: F401  (its sources are found where they are)

    move(Path(os.environ[FOLDER]))
