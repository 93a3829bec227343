"""Tables as CSV that spreadsheets read unchanged: the user's names stay text, however they begin.

A spreadsheet takes a cell that begins with = + - @, a tab or a line end for a formula, which may open files and
addresses. Such a text gets an apostrophe in front, as OWASP advises (CSV Injection); numbers stay numbers.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pandas

FORMULA = ("=", "+", "-", "@", "\t", "\r", "\n")
"""Characters with which a formula begins."""


def csv_text(names: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """Return a table with all digits, a line for ``names`` first; NaN is an empty cell."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    for row in (names, *rows):
        writer.writerow([cell(value) for value in row])
    return text.getvalue()


def cell(value: Any) -> Any:
    """Return a value as a cell: a text that is no number is no formula either, and NaN is empty."""
    if isinstance(value, str):
        return f"'{value}" if value.startswith(FORMULA) and not _is_number(value) else value
    return "" if value != value else value


def frame_csv(frame: pandas.DataFrame, **options: Any) -> str:
    """Return a table of pandas as CSV by its ``to_csv`` with ``options``, names and texts as :func:`cell`."""
    plain = frame.rename(columns=cell).rename_axis(index=cell)
    for place, kind in enumerate(frame.dtypes):
        if kind.kind == "O":
            texts = plain.iloc[:, place].map(lambda value: cell(value) if isinstance(value, str) else value)
            plain.isetitem(place, texts)
    return plain.to_csv(lineterminator="\n", **options)


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
