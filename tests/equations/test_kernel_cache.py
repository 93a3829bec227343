"""Compiled code is kept by what it is made of, and the user's numba is left alone."""

from __future__ import annotations

import importlib
import json
import os
import re
import subprocess
import sys
import time
from pathlib import Path

import pytest

import mbsd
from mbsd.compiling import kernel_cache

ROOT = Path(__file__).parents[2]

LEFT_ALONE = """
import json, os, numba
from numba.core.registry import cpu_target
def settings():
    config = numba.config
    code = cpu_target.target_context.codegen().magic_tuple()
    return [config.CPU_NAME, config.CPU_FEATURES, config.CACHE_DIR, list(code)]
variables, before = dict(os.environ), settings()
import mbsd.compiling.jit
from mbsd.compiling.kernel_target import GENERIC
@mbsd.compiling.jit.kernel
def twice(x):
    return 2.0 * x
assert twice(1.5) == 3.0
assert dict(os.environ) == variables and settings() == before
print(json.dumps(GENERIC.target_context.codegen().magic_tuple()))
"""


def _run(code: str, folder: Path, **environment: str) -> str:
    script = folder / "script.py"
    script.write_text(code)
    variables = os.environ | {"PYTHONPATH": str(ROOT), **environment}
    told = subprocess.run([sys.executable, script], env=variables, capture_output=True, text=True, check=False)
    assert told.returncode == 0, told.stderr
    return told.stdout


@pytest.mark.parametrize("first", ["import numba", "import mbsd"])
def test_settings_of_the_user_stay_and_kernels_are_the_same_everywhere(tmp_path: Path, first: str) -> None:
    assert json.loads(_run(f"{first}\n{LEFT_ALONE}", tmp_path))[1:] == ["generic", ""]


def test_the_users_own_kernels_are_kept_where_numba_keeps_them(tmp_path: Path) -> None:
    code = "import mbsd.compiling.jit, numba\n@numba.njit(cache=True)\ndef own(x):\n    return x + 1.0\nown(1.0)\n"
    _run(code, tmp_path, NUMBA_CACHE_DIR="")
    assert list((tmp_path / "__pycache__").glob("script.own*.nbc"))


KERNELS = """
import sys
sys.path.insert(0, {folder!r})
import kernels
print(kernels.value(1.0), sum(kernels.value.stats.cache_hits.values()))
"""


def test_an_edit_of_an_imported_constant_compiles_anew_and_going_back_does_not(tmp_path: Path) -> None:
    """numba alone would keep the old number."""
    (tmp_path / "kernels.py").write_text(
        "from mbsd.compiling.jit import kernel\nfrom constants import FACTOR\n"
        "@kernel\ndef value(x):\n    return FACTOR * x\n"
    )
    kept = {"NUMBA_CACHE_DIR": str(tmp_path / "kept")}

    def value(factor: float) -> str:
        (tmp_path / "constants.py").write_text(f"FACTOR = {factor}\n")
        (tmp_path / "unrelated.py").write_text(f"FACTOR = {factor + time.time()}\n")
        return _run(KERNELS.format(folder=str(tmp_path)), tmp_path, PYTHONDONTWRITEBYTECODE="1", **kept).strip()

    assert [value(factor) for factor in (2.0, 2.0, 3.0, 2.0)] == ["2.0 0", "2.0 1", "3.0 0", "2.0 1"]


CALLED = """
from mbsd.compiling.jit import apart, kernel, merged
@merged
def twice(x):
    return 2.0 * x
@apart
def inner(x, y):
    return twice(x) + y
@kernel
def outer(x):
    return inner(x, 1.0) * inner(x, 2.0)
"""
CALLS = """
import sys
sys.path.insert(0, {folder!r})
import numba, called
@numba.njit(cache=True)
def own(x):
    return called.outer(x) + 1.0
print({call}(3.0), sum(called.outer.stats.cache_hits.values()), sum(called.inner.stats.cache_hits.values()))
"""


def test_a_kernel_calls_one_that_is_compiled_apart_also_when_both_or_one_of_them_are_kept(tmp_path: Path) -> None:
    (tmp_path / "called.py").write_text(CALLED)
    kept = {"NUMBA_CACHE_DIR": str(tmp_path / "kept")}

    def told(call: str = "called.outer") -> str:
        return _run(CALLS.format(folder=str(tmp_path), call=call), tmp_path, **kept).strip()

    assert told() == "56.0 0 0"
    assert told() == "56.0 1 1"
    for path in (tmp_path / "kept").rglob("called.inner*"):
        path.unlink()
    assert told() == "56.0 1 0"
    assert told("own") == "57.0 1 1"
    assert told("own") == "57.0 0 0", "the user's function is kept with all that it calls"


KERNEL = re.compile(r"^@(kernel|internal|apart|inlined|merged|threaded|equation|interaction)\b", re.MULTILINE)
FILES = [path for path in sorted(Path(mbsd.__file__).parent.rglob("*.py")) if KERNEL.search(path.read_text())]


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_kernels_are_made_of_no_model_and_no_drawing(path: Path) -> None:
    """Or else an edit there compiles for minutes."""
    importlib.import_module(".".join(path.relative_to(ROOT).with_suffix("").parts))
    names = {kernel_cache._name(source) for source in kernel_cache._sources(str(path))}
    assert {path.relative_to(ROOT).as_posix(), "mbsd/compiling/jit.py"} <= names
    assert not {
        name for name in names if name.startswith(("mbsd/drawing", "mbsd/saving", "mbsd/mechanism", "mbsd/model"))
    }


def test_a_kernel_is_made_of_what_its_imports_import() -> None:
    import mbsd.dynamics.integrators.dop853.loop

    names = {
        kernel_cache._name(source) for source in kernel_cache._sources(mbsd.dynamics.integrators.dop853.loop.__file__)
    }
    assert {"mbsd/dynamics/state.py", "mbsd/equations/assembly.py", "mbsd/equations/constraints.py"} <= names


def test_old_versions_go(tmp_path: Path) -> None:
    folder = tmp_path
    for k in range(kernel_cache.KEPT + 3):
        folder = tmp_path / f"mbsd.equations.loads-{k:016x}"
        folder.mkdir()
        os.utime(folder, (k, k))
        kernel_cache._forget_old(folder)
    (tmp_path / "mbsd.loads_more-0000000000000000").mkdir()
    kernel_cache._forget_old(folder)
    left = sorted(path.name for path in tmp_path.iterdir())
    assert left == [
        *(f"mbsd.equations.loads-{k:016x}" for k in range(3, kernel_cache.KEPT + 3)),
        "mbsd.loads_more-0000000000000000",
    ]


def test_without_a_folder_to_write_to_the_next_one_serves(tmp_path: Path) -> None:
    blocked = tmp_path / "blocked"
    blocked.write_text("a file, where a folder should be")
    code = "from mbsd.compiling.kernel_cache import cache_root; print(cache_root())"
    assert not Path(_run(code, tmp_path, NUMBA_CACHE_DIR=str(blocked)).strip()).is_relative_to(blocked)
    assert Path(_run(code, tmp_path, NUMBA_CACHE_DIR=str(tmp_path)).strip()) == tmp_path / "kernels"
