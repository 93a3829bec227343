"""Records what an author's code reads while it runs (mbsd/dependencies/recording.py), as inputs of the project."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from mbsd.dependencies import recording as recorded_reads
from mbsd.dependencies.recorder import Recorder
from mechanisms.stages.loading.inputs import PROJECT


@contextmanager
def recording() -> Iterator[Recorder]:
    """Record what the author's code reads in this block."""
    with recorded_reads.recording(Recorder(PROJECT)) as recorder:
        yield recorder
