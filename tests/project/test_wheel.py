"""``make wheel``: the same bytes each time, and archives that serve in an empty environment outside the clone."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tarfile
import zipfile
from importlib.metadata import distribution
from pathlib import Path

import pytest

import mbsd
from shared.stage.paths import ROOT
from tools.wheel.archives import build, build_with_kernels

NEEDED = ("numpy", "scipy", "numba", "llvmlite")
"""All that the wheel needs, with what these need."""
README_BLOCK = next(
    block
    for block in re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)
    if "sol =" in block
)
SIMULATED = """
p = Mechanism("pendulum")
rod = p.bar("rod", 0.3, mass=0.2)
p.revolute("A", p.ground.at(0, 0), rod.start)
p.start_near(rod=-30)
assert p.simulate(1.0).body("rod").theta[-1] < 0.0
"""
COUNTED = """
import gc
from numba.core.dispatcher import Dispatcher
ours = [one for one in gc.get_objects() if isinstance(one, Dispatcher) and one.py_func.__module__.startswith("mbsd")]
print("compiled", sum(sum(one.stats.cache_misses.values()) for one in ours))
"""
FOLDERS = """
from mbsd.compiling.kernel_cache import KernelCache
opened = [one for one in gc.get_objects() if isinstance(one, KernelCache) and "_files" in vars(one)]
print("folders", *{one.cache_path for one in opened})
"""


def _run(python: Path | str, code: str, folder: Path, **environment: str) -> list[str]:
    """Lines that ``code`` prints, run in ``folder``."""
    variables = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "NUMBA_CACHE_DIR")}
    done = subprocess.run(
        [str(python), "-c", code], cwd=folder, env=variables | environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines() + done.stderr.splitlines()


@pytest.fixture(scope="module")
def archives(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """The sdist and the wheel."""
    return build(ROOT, tmp_path_factory.mktemp("dist"))


@pytest.fixture(scope="module")
def empty(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An environment with pip and what the wheel needs, nothing else."""
    folder = tmp_path_factory.mktemp("environment")
    subprocess.run([sys.executable, "-m", "venv", folder], check=True)
    (site,) = folder.glob("lib/python*/site-packages")
    for name in NEEDED:
        package = distribution(name)
        tops = {file.parts[0] for file in package.files or () if not file.parts[0].startswith(("..", "__pycache__"))}
        for top in tops:
            (site / top).symlink_to(Path(str(package.locate_file(top))))
    return folder


def _installed(empty: Path, wheel: Path) -> Path:
    """The folder of the package after pip installed it."""
    command = [empty / "bin" / "pip", "install", "--quiet", "--no-index", "--force-reinstall", "--no-deps", wheel]
    subprocess.run(command, check=True, cwd=empty)
    subprocess.run([empty / "bin" / "pip", "check"], check=True, cwd=empty)
    (package,) = empty.glob("lib/python*/site-packages/mbsd")
    return package


@pytest.fixture(scope="module")
def installed(archives: list[Path], empty: Path) -> Path:
    """The folder of the package in that environment, from the wheel without kernels."""
    return _installed(empty, archives[1])


def test_the_same_sources_give_the_same_bytes(archives: list[Path], tmp_path: Path) -> None:
    again = build(ROOT, tmp_path)
    assert [file.name for file in again] == [file.name for file in archives]
    assert [file.read_bytes() for file in again] == [file.read_bytes() for file in archives]


def test_the_umask_of_whoever_builds_is_not_in_the_archives(archives: list[Path], tmp_path: Path) -> None:
    command = [sys.executable, "-m", "tools.wheel", "--out", str(tmp_path)]
    subprocess.run(command, cwd=ROOT, umask=0o077, capture_output=True, check=True)
    assert [(tmp_path / file.name).read_bytes() for file in archives] == [file.read_bytes() for file in archives]


def test_the_sdist_builds_the_wheel(archives: list[Path], tmp_path: Path) -> None:
    sdist, wheel = archives
    with tarfile.open(sdist) as archive:
        archive.extractall(tmp_path, filter="data")
    (sources,) = tmp_path.iterdir()
    code = "from setuptools.build_meta import build_wheel; build_wheel('..')"
    _run(sys.executable, code, sources, SOURCE_DATE_EPOCH="315532800")
    assert (tmp_path / wheel.name).read_bytes() == wheel.read_bytes()


def test_the_readme_runs_in_an_empty_environment(installed: Path, empty: Path, tmp_path: Path) -> None:
    code = f"{README_BLOCK}\nimport mbsd; print(mbsd.__file__)"
    told = _run(empty / "bin" / "python", code, tmp_path, NUMBA_DISABLE_JIT="1")
    assert told[0] == "1 degree of freedom (1 nominal)"
    assert Path(told[-1]).parent == installed


@pytest.mark.usefixtures("installed")
def test_a_kind_of_ones_own_is_checked_in_an_empty_environment(empty: Path, tmp_path: Path) -> None:
    """The first joint of docs/extending.md, which has no more than the wheel at hand."""
    page = (ROOT / "docs" / "extending.md").read_text()
    (block,) = (code for code in re.findall(r"```python\n(.*?)```", page, re.DOTALL) if "PARALLEL_ARM = " in code)
    code = f"{block}\nfrom mbsd.testing import check_joint\ncheck_joint(PARALLEL_ARM, seeds=[0])\nprint('agrees')"
    assert _run(empty / "bin" / "python", code, tmp_path, NUMBA_DISABLE_JIT="1")[0] == "agrees"


def _compiled_before(folder: Path, sources: Path, python: Path) -> None:
    """The kernels that the runs below need, from where this clone keeps them."""
    code = README_BLOCK + SIMULATED + COUNTED + FOLDERS
    (told,) = (line for line in _run(sys.executable, code, ROOT) if line.startswith("folders "))
    for kernels in told.split()[1:]:
        shutil.copytree(kernels, folder / Path(kernels).name, ignore=shutil.ignore_patterns(".lock", "*.tmp.*"))


@pytest.mark.slow
def test_a_wheel_with_kernels_compiles_nothing_and_writes_nothing(empty: Path, tmp_path: Path) -> None:
    wheel = build_with_kernels(ROOT, tmp_path / "dist", fill=_compiled_before)
    version = f"cp{sys.version_info.major}{sys.version_info.minor}"
    assert wheel.name.startswith(f"mbsd-{mbsd.__version__}-{version}-{version}-")
    with zipfile.ZipFile(wheel) as archive:
        assert "mbsd/kernels/made_for.json" in archive.namelist()
    package = _installed(empty, wheel)
    shutil.rmtree(package / "__pycache__")
    (package / "__pycache__").write_text("no folder can be made here, as in a folder that is read-only")
    for path in package.rglob("*"):
        path.chmod(0o555 if path.is_dir() else 0o444)
    code = README_BLOCK + SIMULATED + COUNTED
    told = _run(empty / "bin" / "python", code, tmp_path, XDG_CACHE_HOME=str(tmp_path / "cache"))
    assert told[-1] == "compiled 0"
    assert not list((tmp_path / "cache").rglob("*.nb*"))


@pytest.mark.slow
def test_without_its_kernels_the_wheel_compiles_into_the_users_folder(tmp_path: Path) -> None:
    """A kernel of another file, so that this takes a second; the wheel's folder is one that lacks it."""
    (tmp_path / "kernels.py").write_text(
        "from mbsd.compiling.jit import kernel\n@kernel\ndef value(x):\n    return 2.0 * x\n"
    )
    (tmp_path / "shipped").mkdir()
    (tmp_path / "shipped" / "made_for.json").write_text('{"numba": "0.1"}')
    code = (
        "import sys; from pathlib import Path; sys.path.insert(0, '.')\n"
        "from mbsd.compiling import kernel_cache, shipped_kernels\n"
        "kernel_cache.SHIPPED = Path('shipped'); shipped_kernels.MADE_FOR = Path('shipped/made_for.json')\n"
        "import kernels; print(kernels.value(1.0), sum(kernels.value.stats.cache_hits.values()))"
    )
    kept = {"PYTHONPATH": str(ROOT), "NUMBA_CACHE_DIR": str(tmp_path / "kept"), "PYTHONDONTWRITEBYTECODE": "1"}
    first = _run(sys.executable, code, tmp_path, **kept)
    assert first[0] == "2.0 0"
    assert "the kernels of its wheel are for Python None" in first[1]
    assert "numba 0.1 (here " in first[1]
    assert _run(sys.executable, code, tmp_path, **kept) == ["2.0 1"]
    shutil.copytree(tmp_path / "kept" / "kernels", tmp_path / "shipped", dirs_exist_ok=True)
    assert _run(sys.executable, code, tmp_path, **kept | {"NUMBA_CACHE_DIR": str(tmp_path / "new")}) == ["2.0 1"]
    assert not list((tmp_path / "new").rglob("*.nb*"))
