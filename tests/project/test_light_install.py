"""``mbsd`` alone needs numpy, scipy and numba of the versions tried; extras load inside functions alone."""

from __future__ import annotations

import ast
import sys
import tomllib
from collections.abc import Iterator
from functools import cache

import numba
import pytest

from mbsd import MechanismError
from mbsd.compiling.numba_version import NEWEST, OLDEST, refuse_other_versions
from shared.stage.paths import ROOT

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
CORE = {"numpy", "scipy", "numba"}
OPTIONAL = {
    "pandas": "pandas",
    "matplotlib": "draw",
    "imageio_ffmpeg": "animate",
    "PIL": "animate",
    "cloudpickle": "study",
    "loky": "study",
    "pyarrow": "study",
    "rich": "study",
    "distributed": "cluster",
}
"""What single methods ask for, and the extra that brings it."""
PACKAGE = {"imageio_ffmpeg": "imageio-ffmpeg", "PIL": "pillow"}
"""Of what is imported under another name."""


@cache
def trees() -> dict[str, ast.Module]:
    """Return the syntax trees of the solver's files, by path; each keeps to the syntax of the oldest Python."""
    oldest = tuple(map(int, PROJECT["requires-python"].removeprefix(">=").split(".")))
    return {
        str(file): ast.parse(file.read_text(), filename=str(file), feature_version=oldest)
        for file in (ROOT / "mbsd").rglob("*.py")
    }


def imported(node: ast.AST, inside: bool = False) -> Iterator[tuple[str, bool]]:
    """Yield what is imported below a node, and whether inside a function or for types alone."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.Import):
            yield from ((alias.name.partition(".")[0], inside) for alias in child.names)
        elif isinstance(child, ast.ImportFrom):
            yield (child.module or "").partition(".")[0], inside
        for_types = isinstance(child, ast.If) and ast.unparse(child.test) == "TYPE_CHECKING"
        yield from imported(child, inside or for_types or isinstance(child, ast.FunctionDef))


def test_the_solver_imports_an_extra_only_inside_a_function() -> None:
    known = {"mbsd", "llvmlite", *CORE, *sys.stdlib_module_names}  # numba brings llvmlite
    for file, tree in trees().items():
        for top, inside in imported(tree):
            assert top in known or top in OPTIONAL, f"{file} imports {top}"
            assert top in known or inside, f"{file} imports {top} when it is itself imported"


def test_the_solver_keeps_to_the_syntax_of_its_oldest_python() -> None:
    oldest = PROJECT["requires-python"].removeprefix(">=")
    assert f"Programming Language :: Python :: {oldest}" in PROJECT["classifiers"]
    assert trees()


def test_each_optional_import_has_its_extra() -> None:
    extras = PROJECT["optional-dependencies"]
    for package, extra in OPTIONAL.items():
        assert any(need.startswith(PACKAGE.get(package, package)) for need in extras[extra])


@pytest.mark.parametrize("version", ["0.60.0", "0.69.0", "0.69.0rc1", "1.0.0", "0.100.0"])
def test_another_numba_is_refused_with_the_remedy(version: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(numba, "__version__", version)
    with pytest.raises(
        MechanismError, match=rf"numba {version} is installed.*pip install 'numba>=0\.61,<0\.69'"
    ) as refused:
        refuse_other_versions()
    assert isinstance(refused.value, ImportError)


@pytest.mark.parametrize("version", ["0.61.0", "0.61.2", "0.68.1", "0.68.0rc1"])
def test_those_that_were_tried_are_taken(version: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(numba, "__version__", version)
    refuse_other_versions()


def test_the_package_asks_for_the_same_versions() -> None:
    bounds = f"numba>={OLDEST[0]}.{OLDEST[1]},<{NEWEST[0]}.{NEWEST[1] + 1}"
    assert bounds in PROJECT["dependencies"]
