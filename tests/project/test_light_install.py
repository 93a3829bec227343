"""``mbsd`` alone needs numpy, scipy and numba of the versions tried; extras load inside functions alone."""

from __future__ import annotations

import ast
import sys
import tomllib

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
"""Extras that single methods need."""
PACKAGE = {"imageio_ffmpeg": "imageio-ffmpeg", "PIL": "pillow"}
"""Packages that are imported under another name."""


def test_the_solver_imports_its_three_packages_and_its_extras_alone() -> None:
    """Ruff holds that extras load inside functions (TID253), and the syntax of the oldest Python."""
    known = {"mbsd", "llvmlite", *CORE, *OPTIONAL, *sys.stdlib_module_names}  # numba brings llvmlite
    for file in (ROOT / "mbsd").rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text())):
            names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            names += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            assert {name.partition(".")[0] for name in names} <= known, f"{file} imports {names}"
    oldest = PROJECT["requires-python"].removeprefix(">=")
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["ruff"]["per-file-target-version"]
    assert settings == {"mbsd/**/*.py": "py" + oldest.replace(".", "")}
    assert f"Programming Language :: Python :: {oldest}" in PROJECT["classifiers"]


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
def test_tested_versions_are_accepted(version: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(numba, "__version__", version)
    refuse_other_versions()


def test_the_package_asks_for_the_same_versions() -> None:
    bounds = f"numba>={OLDEST[0]}.{OLDEST[1]},<{NEWEST[0]}.{NEWEST[1] + 1}"
    assert bounds in PROJECT["dependencies"]
