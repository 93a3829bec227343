"""Rooms: who may import whom where import-linter cannot look, and that the tree and its documents agree."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

from shared.stage.paths import MECHANISMS, ROOT

ALLOWED = {
    "mechanism.py": {"mbsd", "numpy"},
    "parts.py": {"shared", "cadquery", "numpy"},
    "shot.py": {"shared"},
    "tolerances.py": {"mbsd", "numpy"},
}
FILES = [file for folder in sorted(MECHANISMS.glob("*/mechanism.py")) for file in sorted(folder.parent.glob("*.py"))]
TEMPLATES = sorted((MECHANISMS / "stages" / "new" / "templates").glob("*/*.py.txt"))


def imports(file: Path) -> set[str]:
    """Modules that a file imports, dotted."""
    modules = set()
    for node in ast.walk(ast.parse(file.read_text().replace("@NAME@", "new_templates"))):
        if isinstance(node, ast.Import):
            modules |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{file} imports relatively"
            modules.add(node.module or "")
    return modules


@pytest.mark.parametrize("file", FILES + TEMPLATES, ids=lambda file: f"{file.parent.name}/{file.name}")
def test_a_mechanism_imports_its_own_world_and_no_other_mechanism(file: Path) -> None:
    own = "mechanisms.new_templates." if file in TEMPLATES else f"mechanisms.{file.parent.name}."
    allowed = ALLOWED[file.name.removesuffix(".txt")]
    for module in imports(file):
        top = module.partition(".")[0]
        by_itself = file.name.startswith("parts.py") and module == "mechanisms.automatic"
        assert by_itself or module.startswith(own) or top in allowed or top in sys.stdlib_module_names, (
            f"{file} imports {module}"
        )


def test_a_mechanism_is_four_files_at_most() -> None:
    for folder in {file.parent for file in FILES}:
        files = {f.name for f in folder.iterdir() if f.name != "__pycache__"}
        assert "mechanism.py" in files
        assert files <= set(ALLOWED), folder


def test_import_linter_sees_every_other_folder() -> None:
    """It skips folders without an __init__.py."""
    for room in ("mbsd", "render", "shared", "mechanisms"):
        for file in (ROOT / room).rglob("*.py"):
            if file not in FILES:
                assert (file.parent / "__init__.py").is_file(), file


HEAVY = {"bpy", "cadquery", "distributed", "trimesh", "manifold3d", "matplotlib", "numba", "scipy", "rich"}
STAGES = [
    *(f"mechanisms.stages.{name}" for name in ("parts.stage", "solve.stage", "clearance.stage", "shot", "tolerances")),
    "render.plots", "render.frames.still", "render.frames.frames", "render.frames.film", "render.frames.blend",
]  # fmt: skip


def test_a_stage_loads_nothing_heavy_before_it_knows_that_it_must_run() -> None:
    """One process loads all; the first that brings something heavy is named."""
    code = "import importlib, sys\nfor name in sys.argv[1:]:\n    importlib.import_module(name)\n"
    code += f"    print(name, *(set(sys.modules) & {HEAVY!r}))"
    done = subprocess.run([sys.executable, "-c", code, *STAGES], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == STAGES


PACKAGES = sorted(
    file for room in ("mbsd", "mechanisms", "render", "shared", "studio") for file in (ROOT / room).rglob("__init__.py")
)


def test_every_package_says_in_a_sentence_what_it_holds() -> None:
    """The tree is the map: there is no other list of files."""
    silent = [file for file in PACKAGES if not (ast.get_docstring(ast.parse(file.read_text())) or "").strip()]
    assert len(PACKAGES) > 50
    assert not silent, f"write a docstring of one sentence: {silent}"


NAMING = [ROOT / "ARCHITECTURE.md", *sorted((ROOT / "docs" / "decisions").rglob("*.md"))]


def test_files_and_folders_that_architecture_and_decisions_name_exist() -> None:
    sources = [
        file.relative_to(ROOT)
        for room in ("benchmarks", "docs", "mbsd", "mechanisms", "render", "shared", "studio", "tests", "tools")
        for file in (ROOT / room, *(ROOT / room).rglob("*"))
        if "node_modules" not in file.parts
    ]
    known = {f"/{file.as_posix()}" for file in sources}
    for page in NAMING:
        for name in re.findall(r"`([\w./-]+(?:\.(?:py|js|md)|/))`", page.read_text()):
            ending = f"/{name.rstrip('/')}"
            assert any(path.endswith(ending) for path in known), f"{page.relative_to(ROOT)} names {name}"


def test_every_decision_is_listed_and_is_one_thing() -> None:
    folder = ROOT / "docs" / "decisions"
    listed = set(re.findall(r"\]\(([a-z-]+/[a-z-]+\.md)\)", (folder / "README.md").read_text()))
    assert listed == {file.relative_to(folder).as_posix() for file in folder.rglob("*.md")} - {"README.md"}
    for file in folder.glob("*/*.md"):
        assert re.findall(r"^#+ ", file.read_text(), flags=re.MULTILINE) == ["# "], file


def test_the_architecture_has_two_pages() -> None:
    text = (ROOT / "ARCHITECTURE.md").read_text()
    assert len(text.splitlines()) <= 120
    assert max(len(line) for line in text.splitlines() if not line.startswith("|")) <= 135
