"""``mbsd`` alone is a light package: its wheel needs numpy, scipy and numba, and solving touches nothing else."""

from __future__ import annotations

import ast
import email
import os
import re
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

from shared.stage.paths import ROOT
from tools.wheel.archives import build

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
BLOCKER = """
import sys
ALLOWED = set(sys.stdlib_module_names) | {"numpy", "scipy", "numba", "llvmlite", "mbsd"}
class Blocker:
    def find_spec(self, name, path=None, target=None):
        top = name.partition(".")[0]
        if top not in ALLOWED and not top.startswith("_"):  # the interpreter's own files may begin so
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)
sys.meta_path.insert(0, Blocker())
"""
USE = """
import os, tempfile, warnings
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


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel that ``make wheel`` builds."""
    return build(ROOT, tmp_path_factory.mktemp("wheel"))[1]


def test_the_wheel_holds_the_solver_the_rooms_and_nothing_else(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        names = set(archive.namelist())
    sources = {f.relative_to(ROOT).as_posix() for f in (ROOT / "mbsd").rglob("*.py")}
    sources.add("mbsd/drawing/view/player.js")
    for room in ("mechanisms", "render", "shared", "studio"):
        files = {f for f in (ROOT / room).rglob("*") if f.is_file() and "__pycache__" not in f.parts}
        gallery = {folder.parent for folder in (ROOT / "mechanisms").glob("*/mechanism.py")}
        kept = {f for f in files if not gallery & set(f.parents)}
        sources |= {f"mbsd/rooms/{f.relative_to(ROOT).as_posix()}" for f in kept}
    assert {name for name in names if ".dist-info/" not in name} == sources | {"mbsd/py.typed"}
    assert wheel.stat().st_size < 3_000_000


def test_the_wheel_needs_three_packages(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        (metadata,) = (name for name in archive.namelist() if name.endswith("METADATA"))
        fields = email.message_from_bytes(archive.read(metadata))
    needs = fields.get_all("Requires-Dist", [])
    plain = {re.split(r"[^\w-]", need)[0] for need in needs if "extra ==" not in need}
    assert plain == CORE
    assert {"draw", "animate", "cad", "film", "studio", "pandas"} <= set(fields.get_all("Provides-Extra", []))


def test_the_wheel_solves_where_no_extra_is_installed(wheel: Path, tmp_path: Path) -> None:
    site = tmp_path / "site"
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(site)
    environment = os.environ | {"PYTHONPATH": str(site), "NUMBA_DISABLE_JIT": "1"}
    done = subprocess.run(
        [sys.executable, "-c", BLOCKER + USE], cwd=tmp_path, env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert Path(done.stdout.strip()) == site / "mbsd"


def test_the_solver_imports_an_extra_only_inside_a_function() -> None:
    for file in (ROOT / "mbsd").rglob("*.py"):
        tree = ast.parse(file.read_text())
        inside = {id(node) for f in ast.walk(tree) if isinstance(f, ast.FunctionDef) for node in ast.walk(f)}
        for node in ast.walk(tree):
            modules = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            modules += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            known = {"mbsd", "llvmlite", *CORE, *sys.stdlib_module_names}  # numba brings llvmlite
            for top in {module.partition(".")[0] for module in modules} - known:
                assert top in OPTIONAL, f"{file} imports {top}"
                assert id(node) in inside or _for_types(tree, node), f"{file} imports {top} when it is itself imported"


def _for_types(tree: ast.Module, node: ast.AST) -> bool:
    """Under ``if TYPE_CHECKING:``."""
    return any(
        isinstance(block, ast.If) and ast.unparse(block.test) == "TYPE_CHECKING" and node in block.body
        for block in tree.body
    )


def test_the_solver_keeps_to_the_syntax_of_its_oldest_python() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    oldest = tuple(map(int, project["requires-python"].removeprefix(">=").split(".")))
    assert f"Programming Language :: Python :: {oldest[0]}.{oldest[1]}" in project["classifiers"]
    for file in (ROOT / "mbsd").rglob("*.py"):
        ast.parse(file.read_text(), filename=str(file), feature_version=oldest)


def test_each_optional_import_has_its_extra() -> None:
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["optional-dependencies"]
    for package, extra in OPTIONAL.items():
        assert any(need.startswith(PACKAGE.get(package, package)) for need in extras[extra])
