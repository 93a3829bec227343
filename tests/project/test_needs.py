"""Missing programs are reported at the start and at the end; their tests are skipped, or refused in CI."""

from __future__ import annotations

import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from shared.stage.paths import ROOT
from tests.running.make import run
from tests.running.needs import SOLVER

LACKING = """
from shared.system import missing
from tests.running import needs
missing.missing_libraries = needs.missing_libraries = lambda: {libraries!r}
for name in list(missing.PROGRAMS):
    del missing.PROGRAMS[name]
missing.PROGRAMS["sh"] = missing.Program("dash")
missing.PROGRAMS["nowhere"] = missing.Program("nowhere-server", "nowhere")
missing.LIBRARIES["libNowhere.so.1"] = "libnowhere1"
needs.TESTS = __import__("pathlib").Path(__file__).parent
"""
TESTS = """
from tests.running.needs import needed, needs
def test_plain():
    pass
def test_there():
    needs("sh")
    assert needed("sh").endswith("sh")
def test_one():
    needs("nowhere", "sh")
def test_two():
    needed("nowhere")
"""
LINE = "missing programs nowhere: {}; tests that use them are skipped"
GET = "brew install nowhere" if sys.platform == "darwin" else "sudo apt-get install -y nowhere-server"


def tried(
    folder: Path, *words: str, libraries: tuple[str, ...] = (), **environment: str
) -> subprocess.CompletedProcess[str]:
    """Run the tests of a folder, on a machine that has no program ``nowhere`` and lacks the libraries."""
    (folder / "conftest.py").write_text(
        LACKING.format(libraries=list(libraries))
        + (ROOT / "tests" / "conftest.py").read_text().replace("from __future__ import annotations\n", "")
    )
    kept = {name: value for name, value in os.environ.items() if name not in ("CI", "STRICT", "PYTEST_ADDOPTS")}
    return subprocess.run(
        [sys.executable, "-m", "pytest", "-ra", "-p", "no:cacheprovider", *words, str(folder)],
        cwd=folder,
        env=kept | {"PYTHONPATH": str(ROOT)} | environment,
        capture_output=True,
        text=True,
        check=False,
    )


def test_tests_of_missing_programs_are_skipped_and_named_first_and_last(tmp_path: Path) -> None:
    """Also by two processes, and in CI where that is asked for."""
    (tmp_path / "test_some.py").write_text(TESTS)
    done = tried(tmp_path, "-n", "2", "--dist", "loadscope", CI="true", STRICT="0")
    assert done.returncode == 0, done.stdout
    assert "2 passed, 2 skipped" in done.stdout
    line = LINE.format(GET)
    assert done.stdout.count(line) == 2, "at the start and in the summary"
    assert line in done.stdout.partition("rootdir:")[0]
    skipped = [line for line in done.stdout.splitlines() if line.startswith("SKIPPED")]
    assert len(skipped) == 1
    assert skipped[0].startswith("SKIPPED [2]")
    assert skipped[0].endswith(f"missing programs nowhere: {GET}")


@pytest.mark.parametrize("variable", ["CI", "STRICT"])
def test_strictly_it_is_an_error_before_the_first_test(tmp_path: Path, variable: str) -> None:
    (tmp_path / "test_some.py").write_text(TESTS)
    done = tried(tmp_path, **{variable: "1"})
    assert done.returncode == pytest.ExitCode.USAGE_ERROR
    assert done.stderr == f"ERROR: missing programs nowhere: {GET} (CI or STRICT=1: no test is skipped)\n\n"
    assert "passed" not in done.stdout


@pytest.mark.skipif(sys.platform != "linux", reason="a Mac needs no libraries")
def test_without_the_libraries_tests_of_the_solver_run_alone(tmp_path: Path) -> None:
    for room in ("dynamics", "render"):
        (tmp_path / room).mkdir()
        code = "import no_such_module\n" if room == "render" else "def test_it():\n    pass\n"
        (tmp_path / room / "test_some.py").write_text(code)
    done = tried(tmp_path, libraries=("libNowhere.so.1",))
    assert done.returncode == 0, done.stdout
    assert "1 passed" in done.stdout
    line = "missing system libraries libNowhere.so.1: sudo apt-get install -y libnowhere1; only tests of the solver run"
    assert done.stdout.count(line) == 2
    done = tried(tmp_path, libraries=("libNowhere.so.1",), CI="1")
    assert done.returncode == pytest.ExitCode.USAGE_ERROR
    assert "sudo apt-get install -y libnowhere1 nowhere-server" in done.stderr


def test_ruff_keeps_blender_and_the_cad_kernel_out_of_all_tests_of_the_solver() -> None:
    ignored = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["ruff"]["lint"]["per-file-ignores"]
    [folders] = [glob for glob, rules in ignored.items() if rules == ["TID251"] and glob.startswith("!")]
    assert set(folders.removeprefix("!{").removesuffix("}/**").split(",")) == {
        *(f"tests/{room}" for room in SOLVER),
        "tools/models",
    }


def test_a_failure_is_shown_at_once(tmp_path: Path) -> None:
    (tmp_path / "test_some.py").write_text("def test_a():\n    assert 1 == 2, 'no two'\ndef test_b():\n    pass\n")
    said = tried(tmp_path).stdout
    line = "FAILED test_some.py::test_a: AssertionError: no two"
    assert line in said.partition("= FAILURES =")[0]


def test_make_asks_before_it_waits_for_the_kernels(tmp_path: Path) -> None:
    """A stand-in for Python that lacks something ends `make test` where none may be skipped, and goes on otherwise."""
    python = tmp_path / "python"
    python.write_text('#!/bin/sh\necho "ran $2 $3"\ncase $2 in shared.system) exit 1;; esac\n')
    python.chmod(0o755)
    for strict, ran in (("1", 1), ("0", 3), ("", 3)):
        done = run("make", "-o", "install", f"PYTHON={python}", f"STRICT={strict}", "test", CI="")
        assert [line.split()[1] for line in done.stdout.splitlines() if line.startswith("ran")] == [
            "shared.system", "tools.compiling", "pytest",
        ][:ran]  # fmt: skip
        assert (done.returncode != 0) == (ran == 1)
    done = run("make", "-o", "install", f"PYTHON={python}", "test", CI="1")
    assert "pytest" not in done.stdout
