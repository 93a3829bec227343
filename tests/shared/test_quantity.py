"""Numbers with units: the page writes the same one in the same way as the solver, whose words the pictures have."""

from __future__ import annotations

import json
import math
import subprocess
from pathlib import Path
from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from mbsd.base import quantity
from render.view.bundle import PAGE, node

CASES: dict[str, list[list[Any]]] = json.loads(Path(__file__).with_name("quantities.json").read_text("utf-8"))


def test_python_writes_what_the_table_says() -> None:
    for value, unit, digits, words in CASES["written"]:
        assert quantity.written(value, unit, digits) == words
    for value, digits, words in CASES["figures"]:
        assert quantity.figures(value, digits) == words
    for words, unit, label in CASES["labelled"]:
        assert quantity.labelled(words, unit) == label
    for series, unit, value, words in CASES["live"]:
        assert quantity.live(series, unit)(value) == words
    for span, step in CASES["angle_step"]:
        assert quantity.angle_step(span) == step


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


@given(value=st.floats(-1e14, 1e14), unit=st.sampled_from(["N", "N m", "m", "s", "W", "rad/s", "kg"]))
def test_no_number_has_an_exponent_five_digits_or_a_hyphen(value: float, unit: str) -> None:
    words = quantity.written(value, unit, 4)
    number = words.split(" ")[0]
    assert "e" not in number
    assert "-" not in number
    assert len(number.replace(quantity.MINUS, "").replace(".", "").strip("0")) <= 4


@given(value=st.floats(1e-11, 9e14))
def test_written_numbers_are_the_value_but_for_its_digits(value: float) -> None:
    number, unit = quantity.written(value, "N", 4).split(" ")
    factor = {prefix: 10.0**power for power, prefix in quantity.PREFIXES.items()}[unit.removesuffix("N")]
    assert math.isclose(float(number) * factor, value, rel_tol=6e-4)


def test_counted_words_have_their_plural() -> None:
    assert [quantity.counted(n, "impact") for n in (0, 1, 2)] == ["no impacts", "1 impact", "2 impacts"]
    assert [quantity.counted(n, "body") for n in (0, 1, 21)] == ["no bodies", "1 body", "21 bodies"]
