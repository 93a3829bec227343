"""Numbers with units: the solver, the pictures and the page write the same one in the same way."""

from __future__ import annotations

import json
import math
import subprocess
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mbsd.base import quantity as of_mbsd
from render.view.bundle import PAGE, node
from shared.contract import quantity as of_shared

CASES: dict[str, list[list[Any]]] = json.loads(Path(__file__).with_name("quantities.json").read_text("utf-8"))
MODULES = pytest.mark.parametrize("module", [of_mbsd, of_shared], ids=["mbsd", "shared"])


@MODULES
def test_python_writes_what_the_table_says(module: ModuleType) -> None:
    for value, unit, digits, words in CASES["written"]:
        assert module.written(value, unit, digits) == words
    for value, digits, words in CASES["figures"]:
        assert module.figures(value, digits) == words
    for words, unit, label in CASES["labelled"]:
        assert module.labelled(words, unit) == label
    for series, unit, value, words in CASES["live"]:
        assert module.live(series, unit)(value) == words
    for span, step in CASES["angle_step"]:
        assert module.angle_step(span) == step


def test_the_page_writes_what_the_table_says() -> None:
    script = """
    import { readFileSync } from "node:fs";
    const cases = JSON.parse(readFileSync(process.argv[1], "utf-8"));
    const { written, figures, labelled, live, angleStep } = await import(process.argv[2]);
    const given = {
      written: (value, unit, digits) => written(value, unit, digits), figures, labelled,
      live: (series, unit, value) => live([series], unit)(value), angle_step: (span) => angleStep(span),
    };
    const made = Object.entries(cases).map(([name, list]) => [name, list.map((one) => [given[name](...one)])]);
    process.stdout.write(JSON.stringify(Object.fromEntries(made)));
    """
    numbers = (PAGE / "src" / "data" / "numbers.js").read_text("utf-8")
    code = "data:text/javascript," + "".join(f"%{byte:02x}" for byte in numbers.encode())
    table = Path(__file__).with_name("quantities.json")
    command = [str(node()), "--input-type=module", "-e", script, str(table), code]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=True, encoding="utf-8")
    made = json.loads(done.stdout)
    for name, cases in CASES.items():
        assert [case[-1] for case in made[name]] == [case[-1] for case in cases], name


@MODULES
@given(value=st.floats(-1e14, 1e14), unit=st.sampled_from(["N", "N m", "m", "s", "W", "rad/s", "kg"]))
def test_no_number_has_an_exponent_five_digits_or_a_hyphen(module: ModuleType, value: float, unit: str) -> None:
    words = module.written(value, unit, 4)
    number = words.split(" ")[0]
    assert "e" not in number
    assert "-" not in number
    assert len(number.replace(module.MINUS, "").replace(".", "").strip("0")) <= 4


@MODULES
@given(value=st.floats(1e-11, 9e14))
def test_what_is_written_is_the_value_but_for_its_digits(module: ModuleType, value: float) -> None:
    number, unit = module.written(value, "N", 4).split(" ")
    factor = {prefix: 10.0**power for power, prefix in module.PREFIXES.items()}[unit.removesuffix("N")]
    assert math.isclose(float(number) * factor, value, rel_tol=6e-4)
