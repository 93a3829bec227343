"""The wheel in an environment of its own: the program ``mbsd`` in an empty folder, without the clone."""

from __future__ import annotations

import os
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

from shared.cluster.identity import sources_of
from shared.cluster.preload import PARTS
from shared.stage.paths import ROOT
from tools.wheel.archives import build


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """``mbsd`` as pip installs it; what it needs lies in the environment of the tests."""
    folder = tmp_path_factory.mktemp("environment")
    subprocess.run([sys.executable, "-m", "venv", folder], check=True)
    (site,) = folder.glob("lib/python*/site-packages")
    for entry in Path(sysconfig.get_path("purelib")).iterdir():
        if not entry.name.startswith(("mbsd", "pip", "__pycache__")) and not (site / entry.name).exists():
            (site / entry.name).symlink_to(entry)
    wheel = build(ROOT, tmp_path_factory.mktemp("dist"))[1]
    install = [folder / "bin" / "pip", "install", "--quiet", "--no-index", "--no-deps", wheel]
    subprocess.run(install, check=True, cwd=folder)
    return folder / "bin" / "mbsd"


def run(program: Path, *words: str, at: Path) -> subprocess.CompletedProcess[str]:
    """The program, in ``at``, as in a shell that knows nothing of the clone."""
    ours = ("PYTHONPATH", "MBSD_OUT", "MBSD_MAKE", "MBSD_FACE", "MBSD_PYTHON", "MBSD_WORKSHOP", "MECHANISMS", "CLUSTER")
    kept = {key: value for key, value in os.environ.items() if key not in ours}
    return subprocess.run([program, *words], cwd=at, env=kept, capture_output=True, text=True)


def test_a_new_machine_is_solved_in_an_empty_folder_by_the_files_of_the_wheel(program: Path, tmp_path: Path) -> None:
    for words in (("new", "crank", "--single"), ("check",), ("solve",), ("export", "--format", "csv")):
        done = run(program, *words, at=tmp_path)
        assert done.returncode == 0, done.stderr
        assert str(ROOT) not in done.stdout + done.stderr
    made = {path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*") if path.is_file()}
    assert {"crank.py", "mbsd.toml", "out/crank/data.json", "out/crank/export/crank.csv"} <= made
    assert "solve: crank: nothing to do" in run(program, "solve", at=tmp_path).stdout


def test_the_rooms_are_no_names_for_others(program: Path, tmp_path: Path) -> None:
    python = program.parent / "python"
    code = (
        "import importlib.util as u; print([n for n in ('shared', 'render', 'studio', 'mechanisms') if u.find_spec(n)])"
    )
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    done = subprocess.run(
        [python, "-P", "-c", code], cwd=tmp_path, env=environment, capture_output=True, text=True, check=True
    )
    assert done.stdout == "[]\n"


COPY = """
import sys
from pathlib import Path
import mbsd
sys.path.insert(0, str(Path(mbsd.__file__).parent / "rooms"))
from mechanisms.stages.parts.on_cluster.built import copy_program
from shared.cluster.identity import sources_of
from shared.cluster.preload import PARTS
copy_program(Path("tree"))
assert all(sources_of(room) == sources_of(room, Path("tree").resolve()) for room in PARTS)
print([sources_of(room) for room in PARTS])
"""


def test_a_worker_of_the_wheel_is_as_one_of_the_clone_and_makes_parts_in_the_same_copy(
    program: Path, tmp_path: Path
) -> None:
    environment = {key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "MBSD_WORKSHOP")}
    python = program.parent / "python"
    done = subprocess.run([python, "-P", "-c", COPY], cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == str([sources_of(room) for room in PARTS])
    assert not (tmp_path / "tree" / "mbsd" / "rooms").exists()


def test_all_commands_are_there(program: Path, tmp_path: Path) -> None:
    done = run(program, "--help", at=tmp_path)
    assert done.returncode == 0
    assert all(
        f"    {name} " in done.stdout for name in ("run", "film", "print", "overnight", "import", "export", "live")
    )
    assert run(program, "run", at=tmp_path).returncode == 1
