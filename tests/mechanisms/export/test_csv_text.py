"""No text of a table is a formula to a spreadsheet, and every number is one."""

from __future__ import annotations

import csv
import io
import math

import pandas
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mbsd import Mechanism, constant_rate
from mbsd.base.files import FORMULA, csv_text, frame_csv
from mechanisms.stages.export import stage as export
from mechanisms.stages.export.assembly import Wanted
from mechanisms.stages.print.making import HEADER, Bought, table
from shared.stage.paths import Out

EVIL = '=HYPERLINK("http://elsewhere";A1)'
values = st.one_of(st.text(max_size=20), st.floats(), st.integers())


def _read(text: str) -> list[list[str]]:
    return list(csv.reader(io.StringIO(text, newline="")))


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


@given(st.lists(st.text(max_size=20), min_size=2, max_size=2), st.lists(st.tuples(values, values), max_size=5))
def test_texts_are_no_formulas_and_numbers_stay(names: list[str], rows: list[tuple[object, object]]) -> None:
    text = csv_text(names, rows)
    assert not [cell for row in _read(text) for cell in row if cell.startswith(FORMULA) and not _is_number(cell)]
    for row, seen in zip(rows, _read(text)[1:], strict=True):
        for value, cell in zip(row, seen, strict=True):
            if isinstance(value, float):
                assert cell == "" if math.isnan(value) else float(cell) == value
            elif isinstance(value, int):
                assert int(cell) == value


@pytest.mark.parametrize("word", ["=1+1", "+crank", "-rod", "@sum", "\tcrank", "-1+1|cmd"])
def test_what_would_be_a_formula_has_an_apostrophe(word: str) -> None:
    assert _read(csv_text(["name"], [[word]])) == [["name"], [f"'{word}"]]


def test_numbers_below_zero_stay_numbers() -> None:
    assert csv_text(["a"], [[-1.5], ["-1.5"], [-3], [math.nan]]) == 'a\n-1.5\n-1.5\n-3\n""\n'


def test_tables_of_pandas_have_the_same_cells() -> None:
    frame = pandas.DataFrame({EVIL: [-1.5, math.nan], "why": [EVIL, None]})
    assert _read(frame_csv(frame, index=False)) == [[f"'{EVIL}", "why"], ["-1.5", f"'{EVIL}"], ["", ""]]
    assert list(frame.columns) == [EVIL, "why"], "it is left as it was"


def test_names_of_bodies_and_pieces_are_no_formulas() -> None:
    """A body's name went into tables as it was."""
    m = Mechanism("crank")
    crank = m.bar(EVIL, 0.05, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.drive_angle("motor", crank, constant_rate(-1.0))
    content, _ = export.FORMATS["csv"][1](Wanted(m.sweep(steps=4), 0.0, Out("crank"), None))
    head, *rows = _read(content.decode())
    assert any(EVIL in name for name in head)
    assert not [name for name in head if name.startswith(FORMULA)]
    assert all(_is_number(cell) for row in rows for cell in row)
    rows = _read(table([], [Bought("+M3 screw", (EVIL, "b"), "-steel")]))
    assert len(rows[1]) == len(HEADER)
    assert rows[1][1] == "'+M3 screw"
    assert rows[1][3] == "'-steel"
    assert rows[1][-1] == f"'{EVIL} b"
