"""The table of a study as a pandas DataFrame, and its file."""

from __future__ import annotations

import io
import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mbsd.base.errors import ModelError
from mbsd.base.files import frame_csv, write_whole
from mbsd.base.names import shown
from mbsd.studies.points import REASON, Point
from mbsd.studies.work import Result

if TYPE_CHECKING:
    import pandas

SUFFIXES = (".parquet", ".csv")


def pandas_here() -> Any:
    """Return the package; raises ModelError naming the extra that brings it."""
    try:
        import pandas
    except ImportError as error:
        raise ModelError("study needs pandas: install mbsd[study]") from error
    return pandas


def table_of(points: Sequence[Point], results: Sequence[Result], index: Any = None) -> pandas.DataFrame:
    """Return one row a point: its values, its measures, and the reason if it failed.

    Measures are NaN if it failed; the reason is missing otherwise.

    Raises ModelError if measure uses a name that a point or the reason has.
    """
    columns: dict[str, list[Any]] = {}
    named = {name: None for point in points for name in point}
    for name in named:
        columns[name] = [point.get(name) for point in points]
    measured = {name: None for result in results for name in result.values or ()}
    for name in measured:
        refuse_taken(name, named)
        columns[name] = [(result.values or {}).get(name, float("nan")) for result in results]
    columns[REASON] = [result.reason for result in results]
    return pandas_here().DataFrame(columns, index=index)


def refuse_taken(name: str, taken: Any) -> None:
    """Raise ModelError if measure uses a name that the table has already."""
    if name in taken or name == REASON:
        raise ModelError(f"study: measure gives '{name}', which is a column of the points; choose another name")


def refuse_format(path: str | os.PathLike[str]) -> None:
    """Raise ModelError before anything is computed if the table cannot be written like that."""
    if not isinstance(path, str | os.PathLike):
        raise ModelError(f"study: save is {shown(path)}; give the path of a file")
    if Path(path).suffix not in SUFFIXES:
        raise ModelError(f"study: save is {shown(os.fspath(path))}; its name must end with {' or '.join(SUFFIXES)}")
    if Path(path).suffix == ".parquet":
        try:
            import pyarrow  # noqa: F401
        except ImportError as error:
            raise ModelError("a parquet file needs pyarrow: install mbsd[study]") from error


def save_table(frame: pandas.DataFrame, path: str | os.PathLike[str]) -> None:
    """Write the table whole."""
    if Path(path).suffix == ".csv":
        write_whole(path, frame_csv(frame, index=False).encode())
        return
    content = io.BytesIO()
    frame.to_parquet(content, index=False)
    write_whole(path, content.getvalue())
