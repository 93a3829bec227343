"""``make bench-start``: the table of start-up in docs/benchmarks.md.

Each row has processes and folders of its own.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
import zipfile
from pathlib import Path

from benchmarks import user_calls
from shared.stage.console import markdown_table, say
from shared.stage.errors import UserError
from shared.stage.files import write_bytes
from shared.stage.paths import ROOT
from tools.documents.pages import replaced
from tools.wheel.archives import build_with_kernels

PAGE = ROOT / "docs" / "benchmarks.md"
BEGIN, END = "<!-- rows of make bench-start -->", "<!-- end of bench-start -->"
EDITED = ("drawing/skeleton.py", "model/mechanism.py", "saving/file.py")
"""No kernel is made of these files."""
FIRST = {
    "first_sweep": "first sweep, four-bar",
    "first_simulation": "first simulation, pendulum",
    "first_contact": "first simulation with contact, falling ball",
}
AGAIN = {
    "again_sweep": "`m.sweep()` of the four-bar, 360 steps, again",
    "again_changed_sweep": "the same after `m.change`",
    "again_simulation": "`m.simulate(10.0)` of the pendulum, again",
}


def measured() -> int:
    """Measure, show, and write the table."""
    with tempfile.TemporaryDirectory() as folder:
        rows = [("`python -m mbsd compile`", "empty", _compile(folder))]
        rows.append(("first simulation, pendulum", "in the wheel", _from_wheel(folder)))
    for name, what in FIRST.items():
        with tempfile.TemporaryDirectory() as folder:
            rows.append((what, "empty", _run(name, folder)))
    rows.append(("an edit in drawing, model and saving, then a pendulum", "filled before the edit", _edited()))
    rows += [(what, "filled", _run(name, None)) for name, what in AGAIN.items()]
    for what, _, seconds in rows:
        say("bench-start", f"{what}: {_told(seconds)}")
    cells = [(what, kernels, _told(seconds)) for what, kernels, seconds in rows]
    lines = markdown_table(("what", "compiled kernels", "time"), cells, numbers=[2])
    write_bytes(PAGE, replaced(PAGE.read_text(), BEGIN, END, "\n".join(lines)).encode())
    return 0


def _told(seconds: float) -> str:
    return f"{seconds:.1f} s" if seconds >= 0.1 else f"{1000 * seconds:.2g} ms"


def _compile(folder: str) -> float:
    begun = time.perf_counter()
    _python(["-m", "mbsd", "compile"], ROOT, folder)
    return time.perf_counter() - begun


def _from_wheel(compiled: str) -> float:
    """A wheel that carries what was compiled into a folder, unpacked where nothing else is compiled."""

    def fill(folder: Path, sources: Path, python: Path) -> None:
        shutil.copytree(Path(compiled) / "kernels", folder, ignore=shutil.ignore_patterns(".lock"))

    with tempfile.TemporaryDirectory() as folder:
        tree = Path(folder) / "tree"
        with zipfile.ZipFile(build_with_kernels(ROOT, Path(folder), fill=fill)) as archive:
            archive.extractall(tree)
        for room in ("benchmarks", "shared"):
            shutil.copytree(ROOT / room, tree / room)
        return _run("first_simulation", str(Path(folder) / "empty"), tree)


def _run(name: str, kernels: str | None, tree: Path = ROOT) -> float:
    """Return the seconds of one function of user_calls.py.

    ``kernels``: the folder for compiled code, the usual one if None.
    """
    if not hasattr(user_calls, name):
        raise UserError(f"bench-start: benchmarks/user_calls.py has no '{name}'")
    return float(json.loads(_python(["-m", "benchmarks.user_calls", name], tree, kernels)))


def _edited() -> float:
    """A copy of the package whose kernels are compiled, then edited where no kernel is made."""
    with tempfile.TemporaryDirectory() as folder:
        tree = Path(folder) / "tree"
        for room in ("mbsd", "benchmarks", "shared"):
            shutil.copytree(ROOT / room, tree / room)
        _run("first_simulation", None, tree)
        for name in EDITED:
            file = tree / "mbsd" / name
            file.write_text(file.read_text() + "\n# edited\n")
        return _run("first_simulation", None, tree)


def _python(arguments: list[str], tree: Path, kernels: str | None) -> str:
    environment = {name: value for name, value in os.environ.items() if name != "NUMBA_CACHE_DIR"}
    environment |= {"PYTHONPATH": str(tree)} | ({"NUMBA_CACHE_DIR": kernels} if kernels else {})
    done = subprocess.run([sys.executable, *arguments], cwd=tree, env=environment, capture_output=True, text=True)
    if done.returncode != 0:
        raise UserError(f"bench-start: {' '.join(arguments)} failed: {done.stderr.strip()[-500:]}")
    return done.stdout
