"""Records what an author's code reads while it runs (mbsd/dependencies/recording.py), as inputs of the project."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from mbsd.dependencies import recording as dependencies
from mbsd.dependencies.installed import is_installed
from mbsd.dependencies.recorder import Recorder
from mechanisms.stages.loading.inputs import PROJECT

__all__ = ["Recorder", "is_installed", "recording"]


@contextmanager
def recording() -> Iterator[Recorder]:
    """Record what the author's code reads in this block."""
    with dependencies.recording(Recorder(PROJECT)) as recorder:
        yield recorder
