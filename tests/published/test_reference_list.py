"""The list of published answers names every file and a test that reads it."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

TESTS = Path(__file__).parents[1]
FOLDER = Path(__file__).parent / "reference"
ROWS = re.findall(r"^\| \[[^]]*\]\((\w+)\.json\) \| (.*) \|$", (FOLDER / "README.md").read_text(), re.MULTILINE)


def test_every_file_is_listed_once() -> None:
    assert sorted(name for name, _ in ROWS) == sorted(file.stem for file in FOLDER.glob("*.json"))


@pytest.mark.parametrize(("name", "tests"), ROWS, ids=[name for name, _ in ROWS])
def test_its_test_reads_it(name: str, tests: str) -> None:
    named = re.findall(r"`(test_\w+\.py)(?:::(\w+))?`", tests)
    assert named
    for file, function in named:
        [place] = TESTS.rglob(file)
        source = place.read_text()
        assert name in source, f"{file} does not read {name}.json"
        functions = {node.name for node in ast.walk(ast.parse(source)) if isinstance(node, ast.FunctionDef)}
        assert not function or function in functions
