"""The archives of ``make wheel``: their bytes and content, and what they serve in environments outside the clone."""

from __future__ import annotations

import email
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import zipfile
from importlib.metadata import distribution
from pathlib import Path

import pytest

import mbsd
from shared.cluster.preload import PARTS, sources_of
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
USE = """
import os, sys, tempfile, warnings
import mbsd
heavy = {"scipy", "numba"} & set(sys.modules)
assert not heavy, f"import mbsd loads {heavy}"
from mbsd import Mechanism, ModelError, constant_rate, table
m = Mechanism("slider_crank")
crank, rod, slider = m.bar("crank", 0.05, 0.2), m.bar("rod", 0.15, 0.3), m.body("slider", 0.5)
m.revolute("O", m.ground.at(0, 0), crank.start)
m.revolute("A", crank.end, rod.start)
m.revolute("B", rod.end, slider.origin)
m.prismatic("guide", m.ground.at(0, 0), slider.origin)
m.start_near(crank=30, rod=-10)
assert m.mobility().dof == 1
m.simulate(0.01, steps=4)
m.drive_angle("motor", crank, table([0, .1, .2, .3, .4, .5], [0, .1, .2, .3, .4, .5]))
sol = m.sweep(duration=0.4, steps=8)
assert abs(sol.body("slider").x[0] - 0.2) < 1e-12
sol._repr_html_()
with tempfile.TemporaryDirectory() as folder:
    m.save(os.path.join(folder, "model.json"))
    assert Mechanism.load(os.path.join(folder, "model.json")).mobility().dof == 1
assert m.topology()._repr_svg_().startswith("<svg")
def film():
    sol.animate("crank.mp4")
asked = (("pandas", sol.to_frame), ("draw", m.draw), ("draw", sol.draw), ("animate", film))
for extra, ask in asked:
    try:
        ask()
    except ModelError as error:
        assert f"mbsd[{extra}]" in str(error), error
    else:
        raise AssertionError(extra)
print(os.path.dirname(mbsd.__file__))
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


# -- the archives -----------------------------------------------------------------------------------------------------


def test_the_same_sources_give_the_same_bytes_whatever_the_umask(archives: list[Path], tmp_path: Path) -> None:
    command = [sys.executable, "-m", "tools.wheel", "--out", str(tmp_path)]
    subprocess.run(command, cwd=ROOT, umask=0o077, capture_output=True, check=True)
    assert sorted(file.name for file in archives) == sorted(file.name for file in tmp_path.iterdir())
    assert [(tmp_path / file.name).read_bytes() for file in archives] == [file.read_bytes() for file in archives]


def test_the_sdist_builds_the_wheel(archives: list[Path], tmp_path: Path) -> None:
    sdist, wheel = archives
    with tarfile.open(sdist) as archive:
        archive.extractall(tmp_path, filter="data")
    (sources,) = tmp_path.iterdir()
    code = "from setuptools.build_meta import build_wheel; build_wheel('..')"
    _run(sys.executable, code, sources, SOURCE_DATE_EPOCH="315532800")
    assert (tmp_path / wheel.name).read_bytes() == wheel.read_bytes()


def test_the_wheel_holds_the_solver_the_rooms_and_nothing_else(archives: list[Path]) -> None:
    with zipfile.ZipFile(archives[1]) as archive:
        names = set(archive.namelist())
    sources = {f.relative_to(ROOT).as_posix() for f in (ROOT / "mbsd").rglob("*.py")}
    sources |= {"mbsd/drawing/player.js", "mbsd/drawing/carriers.js"}
    for room in ("mechanisms", "render", "shared", "studio"):
        files = {f for f in (ROOT / room).rglob("*") if f.is_file() and "__pycache__" not in f.parts}
        gallery = {folder.parent for folder in (ROOT / "mechanisms").glob("*/mechanism.py")}
        kept = {f for f in files if not gallery & set(f.parents)}
        sources |= {f"mbsd/rooms/{f.relative_to(ROOT).as_posix()}" for f in kept}
    assert {name for name in names if ".dist-info/" not in name} == sources | {"mbsd/py.typed"}
    assert archives[1].stat().st_size < 3_000_000


def test_the_wheel_needs_three_packages(archives: list[Path]) -> None:
    with zipfile.ZipFile(archives[1]) as archive:
        (metadata,) = (name for name in archive.namelist() if name.endswith("METADATA"))
        fields = email.message_from_bytes(archive.read(metadata))
    needs = fields.get_all("Requires-Dist", [])
    plain = {re.split(r"[^\w-]", need)[0] for need in needs if "extra ==" not in need}
    assert plain == {"numpy", "scipy", "numba"}
    assert {"draw", "animate", "cad", "film", "studio", "pandas"} <= set(fields.get_all("Provides-Extra", []))


# -- the solver in an empty environment -------------------------------------------------------------------------------


def test_it_solves_runs_the_readme_and_checks_a_kind_of_ones_own(installed: Path, empty: Path, tmp_path: Path) -> None:
    """With the first joint of docs/extending.md, which has no more than the wheel at hand."""
    page = (ROOT / "docs" / "extending.md").read_text()
    (block,) = (code for code in re.findall(r"```python\n(.*?)```", page, re.DOTALL) if "PARALLEL_ARM = " in code)
    check = "from mbsd.testing import check_joint\ncheck_joint(PARALLEL_ARM, seeds=[0])\nprint('agrees')"
    code = f"{USE}\n{README_BLOCK}\n{block}\n{check}"
    told = _run(empty / "bin" / "python", code, tmp_path, NUMBA_DISABLE_JIT="1")
    assert Path(told[0]) == installed
    assert told[1] == "1 degree of freedom (1 nominal)"
    assert "agrees" in told


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
        "from mbsd.compiling import kernel_cache, kernel_files\n"
        "kernel_cache.SHIPPED = Path('shipped'); kernel_files.MADE_FOR = Path('shipped/made_for.json')\n"
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


# -- the program in an environment with all extras -------------------------------------------------------------------


@pytest.fixture(scope="module")
def program(archives: list[Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """``mbsd`` as pip installs it; what it needs lies in the environment of the tests."""
    folder = tmp_path_factory.mktemp("environment")
    subprocess.run([sys.executable, "-m", "venv", folder], check=True)
    (site,) = folder.glob("lib/python*/site-packages")
    for entry in Path(sysconfig.get_path("purelib")).iterdir():
        if not entry.name.startswith(("mbsd", "pip", "__pycache__")) and not (site / entry.name).exists():
            (site / entry.name).symlink_to(entry)
    install = [folder / "bin" / "pip", "install", "--quiet", "--no-index", "--no-deps", archives[1]]
    subprocess.run(install, check=True, cwd=folder)
    return folder / "bin" / "mbsd"


def _called(program: Path, *words: str, at: Path) -> subprocess.CompletedProcess[str]:
    """The program, in ``at``, as in a shell that knows nothing of the clone."""
    ours = ("PYTHONPATH", "MBSD_OUT", "MBSD_MAKE", "MBSD_FACE", "MBSD_PYTHON", "MBSD_WORKSHOP", "MECHANISMS", "CLUSTER")
    kept = {key: value for key, value in os.environ.items() if key not in ours} | {"NUMBA_DISABLE_JIT": "1"}
    return subprocess.run([program, *words], cwd=at, env=kept, capture_output=True, text=True)


def test_a_new_machine_is_solved_in_an_empty_folder_by_the_files_of_the_wheel(program: Path, tmp_path: Path) -> None:
    for words in (("new", "crank", "--single"), ("check",), ("solve",), ("export", "--format", "csv")):
        done = _called(program, *words, at=tmp_path)
        assert done.returncode == 0, done.stderr
        assert str(ROOT) not in done.stdout + done.stderr
    made = {path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*") if path.is_file()}
    assert {"crank.py", "mbsd.toml", "out/crank/data.json", "out/crank/export/crank.csv"} <= made
    assert "solve: crank: nothing to do" in _called(program, "solve", at=tmp_path).stdout


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
from shared.cluster.preload import sources_of
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
