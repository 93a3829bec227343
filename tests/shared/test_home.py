"""A home that takes no files, or that nobody knows: kernels, studies, stages and plots work all the same."""

from __future__ import annotations

import ctypes
import os
import subprocess
import sys
from pathlib import Path

import pytest

from render.view import bundle
from shared.stage import jsonfile, paths
from shared.stage.paths import ROOT

PR_CAPBSET_DROP, CAP_DAC_OVERRIDE = 24, 1
"""Constants of Linux's <sys/prctl.h> and <linux/capability.h>."""
STUDY = """
import runpy, sys
from pathlib import Path
from mbsd import Mechanism, study
from mbsd.compiling import kernel_cache

def build(x):
    m = Mechanism("bar")
    m.bar("bar", x, mass=1.0)
    return m

def measure(m):
    return {"double": 2.0 * m.bodies["bar"].length}

print(list(study(build, {"x": [1.0, 2.0]}, measure, folder=sys.argv[1], processes=1, progress=False)["double"]))
kernel_cache._PACKAGE = Path("/dev/null")  # as where the package is installed for all
kernel_cache.cache_root.cache_clear()
print(kernel_cache.cache_root())
"""
NOBODY = """
import pwd, runpy, sys
def unknown(number):
    raise KeyError(number)
pwd.getpwuid = unknown  # as for a user by number alone, in a container
module = sys.argv.pop(1)
runpy.run_module(module, run_name="__main__", alter_sys=True)
"""


def _as_a_user() -> None:
    """Files that root may not write, it does not: a shell of root would else write anywhere."""
    if sys.platform == "linux" and os.geteuid() == 0:
        ctypes.CDLL(None).prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE)


def said(*command: str, **environment: str) -> str:
    """Return the output of a command without a writable home; it must end well without warnings."""
    taken = ("HOME", "XDG_CACHE_HOME", "XDG_CONFIG_HOME", "MPLCONFIGDIR", "NUMBA_CACHE_DIR")
    kept = {name: value for name, value in os.environ.items() if name not in taken}
    done = subprocess.run(
        [sys.executable, *command], cwd=ROOT, env=kept | {"PYTHONPATH": str(ROOT)} | environment,
        preexec_fn=_as_a_user, capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert not done.stderr
    return done.stdout


@pytest.fixture
def home(tmp_path: Path) -> Path:
    """Return a home to which nothing can be written."""
    folder = tmp_path / "home"
    folder.mkdir(mode=0o500)
    return folder


def test_stages_and_plots_keep_what_they_need_beside_the_results(home: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    for module, stage in (("mechanisms", "solve"), ("render", "plots")):
        assert "pendulum: " in said("-m", module, stage, "pendulum", HOME=str(home), MBSD_OUT=str(out))
    assert list((out / ".home" / "matplotlib").glob("fontlist*"))
    assert not list(home.iterdir())


def test_a_study_and_the_kernels_need_no_home(home: Path, tmp_path: Path) -> None:
    kept, temporary = tmp_path / "kept", tmp_path / "temporary"
    temporary.mkdir()
    doubled, root = said("-c", STUDY, str(kept), HOME=str(home), TMPDIR=str(temporary)).splitlines()
    assert doubled == "[2.0, 4.0]"
    assert list(kept.rglob("*.jsonl"))
    assert Path(root).is_relative_to(temporary)
    assert Path(root).parent.stat().st_mode & 0o077 == 0, "nobody else puts code there"


PAGE = """
import sys
from pathlib import Path
from shared.stage import jsonfile, paths
from render.view import bundle
paths.ROOT = Path(sys.argv[1])
print([str(folder) for folder in paths.cache_roots()])
print(bundle.bundle().script)
"""


def _clone(folder: Path) -> Path:
    """Return a clone of another user who has built a page there."""
    kept = folder / ".cache" / "page" / f"main-{bundle.sources_key()[:24]}.json"
    jsonfile.write(kept, bundle.Bundle(script="kept in the clone", style="", licences=""))
    (folder / "Makefile").touch()
    for place in (folder, *folder.rglob("*")):
        place.chmod(0o555 if place.is_dir() else 0o444)
    return folder


def test_who_cannot_write_to_the_clone_reads_its_packed_page_and_keeps_his_own(tmp_path: Path) -> None:
    """It was an error, with a remedy that cured nothing."""
    clone, own = _clone(tmp_path / "clone"), tmp_path / "own"
    roots, script = said("-c", PAGE, str(clone), HOME=str(tmp_path), XDG_CACHE_HOME=str(own)).splitlines()
    assert roots == str([str(own / "mbsd"), str(clone / ".cache")])
    assert script == "kept in the clone"


def test_who_may_write_to_the_clone_keeps_the_page_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "Makefile").touch()
    monkeypatch.setattr(paths, "ROOT", tmp_path)
    assert paths.cache_roots() == [tmp_path / ".cache"]


def test_a_user_without_a_home_solves(tmp_path: Path) -> None:
    """Libraries failed while they were imported."""
    out = tmp_path / "out"
    assert "pendulum: " in said("-c", NOBODY, "mechanisms", "solve", "pendulum", MBSD_OUT=str(out))


def test_a_temporary_folder_that_others_have_made_is_not_used(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Whoever writes kernels there has them run."""
    from mbsd.compiling import kernel_cache

    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    folder = kernel_cache._own_temporary()
    assert folder is not None
    folder.chmod(0o777)
    assert kernel_cache._own_temporary() is None
    folder.rmdir()
    folder.symlink_to(tmp_path)
    assert kernel_cache._own_temporary() is None
