"""``study``: build and measure a mechanism at every point of a grid."""

from __future__ import annotations

import hashlib
import itertools
import os
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import closing, nullcontext
from typing import TYPE_CHECKING, Any
from uuid import uuid4

import numpy as np

from mbsd.base.arguments import checked
from mbsd.base.errors import ModelError, ModelWarning
from mbsd.base.names import shown
from mbsd.base.quantity import counted
from mbsd.base.running import cores
from mbsd.base.warning import warn
from mbsd.dealing.connection import connected
from mbsd.dependencies.recorder import Recorder
from mbsd.mechanism import Mechanism
from mbsd.model.mechanism import Model
from mbsd.studies.content import Content, own_sources
from mbsd.studies.inputs import StudyPlaces, loaded_inputs, root_of
from mbsd.studies.orders import Deals, by_cluster, by_here, by_processes, manner_of
from mbsd.studies.points import Point, points_of, refuse_names
from mbsd.studies.progress import VOICE
from mbsd.studies.progress import progress as reported
from mbsd.studies.simulated import Simulated
from mbsd.studies.store import Store
from mbsd.studies.table import pandas_here, refuse_format, refuse_taken, save_table, table_of
from mbsd.studies.work import Order, Result, bytes_of

if TYPE_CHECKING:
    import pandas

    from mbsd.studies.points import Point


WAY = "way"
"""Key in ``attrs`` of a table for how its points were simulated."""
LOOKED_AT = 9
"""Points from which the way is found."""


@checked
def study(
    build: Callable[..., Mechanism],
    grid: Mapping[str, Any] | Iterable[Mapping[str, Any]] | pandas.DataFrame,
    measure: Callable[[Mechanism], Mapping[str, float]],
    client: Any = None,
    *,
    folder: str | os.PathLike[str] | None = "studies",
    save: str | os.PathLike[str] | None = None,
    processes: int | None = None,
    progress: bool = True,
) -> pandas.DataFrame:
    """Build and measure a mechanism at every point; a table back, a row a point in the order of the grid.

    ``build(**point)`` gives the mechanism, ``measure(mechanism)`` solves it and gives numbers by name. ``grid`` maps
    names to values, of which all combinations are taken (the last name varies fastest), or lists points as mappings or
    rows of a DataFrame. Columns of the table: the point, what was measured, and ``reason``: why build or measure
    failed there, where the numbers are NaN; missing where they did not. ``save`` writes it as ``.parquet`` or ``.csv``.

    ``measure`` may be :func:`mbsd.simulated`, whose points go through one compiled loop where they differ in numbers
    alone.

    Without ``client`` the work is done by ``processes`` of this machine, by default one a core; 1 stays in this
    process. ``client`` is a ``distributed.Client`` or the address of a scheduler. Neither changes an order or a number.

    Results are kept in ``folder``, named by the content of build and measure (their code, constants and helper
    functions), the point and mbsd's own sources: what is known is not computed again, so a study that was stopped goes
    on, and a larger grid costs what is new. None keeps nothing. Points at which the machine failed, not the mechanism,
    are computed again.

    Needs the extra ``study``. Raises ModelError for a grid that is none, names that ``build`` does not take, a
    ``measure`` that uses a name of the points, a scheduler that does not answer and workers none of which has the same
    versions.
    """
    for name, function in (("build", build), ("measure", measure)):
        if not callable(function):
            raise ModelError(f"study: {name} is {shown(function)}; give a function")
    pandas_here()
    if save is not None:
        refuse_format(save)
    points = points_of(grid)
    refuse_names(build, points)
    places = StudyPlaces(root_of(build))
    content = Content(folder is not None, places.root).add(build).add(measure)
    store = None if folder is None else _store(folder, content, places)
    keys = [_key_of(point) for point in points] if store else []
    results: dict[int, Result] = {n: store.known[k] for n, k in enumerate(keys) if k in store.known} if store else {}
    todo = {number: point for number, point in enumerate(points) if number not in results}
    if todo and isinstance(measure, Simulated):
        _refuse_measure(build, measure, todo.values())
    if todo:
        names = {name for point in points for name in point}
        with (
            _client(client) as connected,
            closing(
                _deals(build, measure, content, store and places, connected, processes, points, len(todo))(todo)
            ) as parts,
            reported(len(points), len(results), progress) as tell,
        ):
            try:
                for part, inputs in parts:
                    if store is not None:
                        store.depend(inputs)
                    for number, result in part:
                        results[number] = result
                        for name in result.values or ():
                            refuse_taken(name, names)
                        if store is not None and not result.passing:
                            store.keep(keys[number], result)
                    tell(len(part), sum(result.values is None for _, result in part))
            finally:
                if store is not None:
                    store.flush()
    if points and all(result.values is None for result in results.values()):
        warn(f"study: all of {counted(len(points), 'point')} failed, the first for: {results[0].reason}", ModelWarning)
    frame = table_of(points, [results[number] for number in range(len(points))], _index_of(grid))
    if isinstance(measure, Simulated):
        frame.attrs[WAY] = _way(build, measure, points)
    if save is not None:
        save_table(frame, save)
    return frame


def _refuse_measure(build: Callable[..., Mechanism], measure: Simulated, points: Iterable[Point]) -> None:
    """Raise ModelError for simulations and measures that the first model built cannot have.

    This is before any is run.
    """
    for point in itertools.islice(points, LOOKED_AT):
        try:
            m = build(**point)
        except Exception:
            continue  # that is the reason of the point
        if isinstance(m, Model):
            measure.refuse(m)
            return


def _way(build: Callable[..., Mechanism], measure: Simulated, points: Sequence[Point]) -> str:
    """Return how points like some of these are simulated, in words."""
    if not points:
        return "there are no points"
    some = []
    for number in sorted({*np.linspace(0, len(points) - 1, LOOKED_AT, dtype=int).tolist()}):
        try:
            some.append(build(**points[number]))
        except Exception:
            continue  # that is the reason of the point
    return measure.way(some)


def _index_of(grid: Any) -> Any:
    """Return the rows of a DataFrame keep their names."""
    return grid.index if hasattr(grid, "to_dict") and hasattr(grid, "columns") else None


def _key_of(point: Point) -> str:
    """Return names in any order are one point."""
    return Content().add(dict(sorted(point.items()))).hexdigest()[:32]


def _store(folder: str | os.PathLike[str], content: Content, places: StudyPlaces) -> Store:
    """Return the store of this build and measure with their present inputs."""
    key = hashlib.sha256(f"{own_sources()} {sys.version_info[:3]} {content.hexdigest()}".encode()).hexdigest()
    return Store(folder, key, places, loaded_inputs(content, places))


def _client(client: Any) -> Any:
    """Return a connection of our own is closed at the end, the user's stays."""
    if client is None or hasattr(client, "scheduler_info"):
        return nullcontext(client)
    if not isinstance(client, str):
        raise ModelError(f"study: client is {shown(client)}; give a distributed.Client or the address of a scheduler")
    return connected(client, VOICE)


def _deals(
    build: Any,
    measure: Any,
    content: Content,
    places: StudyPlaces | None,
    client: Any,
    processes: int | None,
    points: Sequence[Point],
    todo: int,
) -> Deals:
    """Return the deal that computes ``todo`` of the points.

    ``places`` name inputs of build and measure, if recorded.
    """
    count = cores() if processes is None else processes
    if client is None and count < 1:
        raise ModelError(f"study: processes is {count}; it must be 1 at least")
    if client is None and min(count, todo) == 1:
        for cache in content.caches if places else ():
            cache.cache_clear()  # what is remembered would not be read, and not be recorded
        return by_here(build, measure, None if places is None else Recorder(places))
    root = None if places is None else str(places.root)
    order = Order(bytes_of(build, measure, content.modules), root, uuid4().hex)
    if client is not None:
        return by_cluster(order, client, points)
    return by_processes(order, min(count, todo), manner_of(measure))
