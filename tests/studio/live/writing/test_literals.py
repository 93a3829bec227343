"""Numbers written into mechanism.py: exactly these, with every other byte as it was."""

from __future__ import annotations

import ast
import dataclasses

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from shared.stage.errors import UserError
from studio.live.numbers import changed, numbers_of
from studio.live.writing import deciding_line, replaced

FILE = "mechanisms/x/mechanism.py"
SOURCE = '''# -*- coding: {coding} -*-
"""Länge μ → 3"""
import dataclasses
from dataclasses import dataclass, field
from math import pi


@dataclass
class Params:
    """of a crank — ö"""
    a: float = 0.120  # ü: keeps
    b: float = -1.5e-3; c: int = 7
    d: tuple[float, ...] = (  # first
        0.1,  # one
        (-2, 3.0),
    )
    e: float = 2 * pi  # computed
    f: float = field(default=4.0, metadata={{"range": (1, 9)}})
    g: float = dataclasses.field(metadata={{}}, default=-(5.0))
    h: str = "ä"; i: float = 1_000.0


VARIANTS = {{"long": {{"a": 0.3, "d": (1.0, (2, 3))}}, "other": {{}}}}
'''


def params(source: bytes) -> object:
    scope: dict = {"__name__": __name__}
    exec(compile(ast.parse(source), FILE, "exec"), scope)
    return scope["Params"]()


NAMES = ("a", "b", "d[0]", "d[1][0]", "d[1][1]", "e", "f", "g", "i")


@settings(max_examples=30, deadline=None)
@given(
    values=st.dictionaries(st.sampled_from(NAMES), st.floats(-1e99, 1e99), min_size=1),
    whole=st.integers(-(10**9), 10**9),
    coding=st.sampled_from(["utf-8", "latin-1", "bom"]),
    newline=st.sampled_from(["\n", "\r\n", "\r"]),
)
def test_written_values_are_read_and_the_rest_stays(values: dict, whole: int, coding: str, newline: str) -> None:
    text = SOURCE.format(coding="utf-8" if coding == "bom" else coding)
    if coding == "latin-1":
        text = text.replace("μ → 3", "").replace("—", "")
    source = text.replace("\n", newline).encode("utf-8-sig" if coding == "bom" else coding)
    after = replaced(source, FILE, {**values, "c": whole})
    p = params(after)
    expected = {number.name: number.value for number in numbers_of(params(source))} | values | {"c": whole}
    assert {number.name: number.value for number in numbers_of(p)} == expected
    # Written back as they were, the numbers leave the file as it was but for how these are spelt.
    before = {number.name: number.value for number in numbers_of(params(source))}
    back = replaced(after, FILE, {name: before[name] for name in values} | {"c": 7})
    spelt = replaced(source, FILE, {name: before[name] for name in values} | {"c": 7})
    assert back == spelt


def test_only_the_literal_changes() -> None:
    source = SOURCE.format(coding="utf-8").encode()
    after = replaced(source, FILE, {"a": 0.13, "d[1][0]": 2.5, "g": 6.0})
    expected = source.replace(b"0.120", b"0.13").replace(b"(-2, 3.0)", b"(2.5, 3.0)").replace(b"=-(5.0)", b"=6.0")
    assert after == expected


def test_a_variant_has_its_own() -> None:
    source = SOURCE.format(coding="utf-8").encode()
    assert replaced(source, FILE, {"a": 0.4, "d[1][1]": 5}, "long") == source.replace(
        b'"a": 0.3, "d": (1.0, (2, 3))', b'"a": 0.4, "d": (1.0, (2, 5))'
    )
    with pytest.raises(UserError, match=r"VARIANTS\['other'\] does not replace 'a'"):
        replaced(source, FILE, {"a": 0.4}, "other")


@pytest.mark.parametrize(
    ("source", "name", "says"),
    [
        ("class Params:\n    a: float = 1.0\n", "b", "does not define 'b' itself"),
        ("class Params(Base):\n    pass\n", "a", "does not define 'a' itself"),
        ("class Params:\n    a: tuple = pair()\n", "a[0]", "no number of its own"),
        ("class Params:\n    a: tuple = (*b, 1.0)\n", "a[0]", r"one of \*b"),
        ("class Params:\n    a: float = field(default_factory=f)\n", "a", "no default of its own"),
        ("class Params:\n    a: float = (\n", "a", "fix it first"),
    ],
)
def test_where_there_is_no_literal_it_is_refused(source: str, name: str, says: str) -> None:
    with pytest.raises(UserError, match=says):
        replaced(source.encode(), FILE, {name: 2.0})


@dataclasses.dataclass(frozen=True)
class Some:
    a: float = 0.04
    b: float = 0.0
    c: int = 0
    d: tuple[float, tuple[int, str]] = (-2.0, (3, "x"))
    e: bool = True
    f: float = dataclasses.field(default=4.0, metadata={"range": (1, 9)})
    g: float = 1e-9
    h: list[float] = dataclasses.field(default_factory=lambda: [1.0])


def test_numbers_have_sensible_ranges() -> None:
    numbers = {number.name: number for number in numbers_of(Some())}
    assert list(numbers) == ["a", "b", "c", "d[0]", "d[1][0]", "f", "g", "h[0]"]
    for number in numbers.values():
        assert number.low <= number.value <= number.high
        assert number.low < number.high
        assert 0 < number.step < number.high - number.low
    assert (numbers["f"].low, numbers["f"].high) == (1, 9)
    assert numbers["a"].low > 0
    assert numbers["d[0]"].high < 0
    assert numbers["b"].low < 0 < numbers["b"].high
    assert numbers["c"].whole
    assert numbers["c"].step == 1
    assert numbers_of(object()) == []
    assert numbers_of(Some(a=float("inf"), b=float("nan"), c=10**400))[0].name == "d[0]"
    assert numbers_of(Some(a=5e-324))[0].step > 0


def test_params_are_changed_by_name() -> None:
    p = changed(Some(), {"a": 0.05, "d[1][0]": 4.2, "c": 3.0, "h[0]": 2.0})
    assert (p.a, p.d, p.c, p.h) == (0.05, (-2.0, (4, "x")), 3, [2.0])
    assert isinstance(p.c, int)
    assert changed(Some(), {}) == Some()
    with pytest.raises(UserError, match="no number 'e'"):
        changed(Some(), {"e": 0.0})
    with pytest.raises(UserError, match="must be a finite number"):
        changed(Some(), {"a": float("nan")})


@dataclasses.dataclass
class Wrong:
    a: float = dataclasses.field(default=4.0, metadata={"range": (9, 1)})


def test_a_range_that_is_none_is_told() -> None:
    with pytest.raises(UserError, match=r"Params\.a: .* is no range"):
        numbers_of(Wrong())


VARIED = """class Params:
    a: float = 1.0


VARIANTS = {"long": {"a": 2.0}}
"""


@pytest.mark.parametrize(
    ("after", "variant", "line"),
    [
        ("setattr(Params, 'a', 5)\n", None, 6),
        ("Params = replaced(Params, a=3)\n", None, 6),
        ("if True:\n    class Params:\n        a: float = 3.0\n", None, 7),
        ('VARIANTS["long"]["a"] = 3.0\n', "long", 6),
        ('VARIANTS = VARIANTS | {"long": {"a": 3.0}}\n', "long", 6),
        ("VARIANTS.update(more)\n", "long", 6),
        ("x = 3\n", None, None),
    ],
)
def test_the_line_that_decides_a_number_is_found(after: str, variant: str | None, line: int | None) -> None:
    assert deciding_line((VARIED + after).encode(), "a", FILE, variant) == line


def test_a_key_that_stands_twice_is_named() -> None:
    source = VARIED.replace('"a": 2.0', '"a": 2.0,\n    "a": 3.0').encode()
    assert deciding_line(source, "a", FILE, "long") == 6
