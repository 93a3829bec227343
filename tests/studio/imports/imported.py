"""Import of a file for tests: its written text, formatted by ruff and run as a module of its own."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

from mbsd import Mechanism
from studio.imports.reading import read
from studio.imports.sketch import Sketch
from studio.imports.writing import mechanism_py

SAMPLES = Path(__file__).parent / "samples"


def built(source: str | Path) -> tuple[Sketch, Mechanism, dict[str, Any]]:
    """Return the sketch, the mechanism of the written text, and that text's names."""
    sketch = read(str(source))
    names: dict[str, Any] = {}
    text = mechanism_py(sketch, "imported")
    formatted = [sys.executable, "-m", "ruff", "format", "--isolated", "--line-length", "200", "--check", "-"]
    assert subprocess.run(formatted, input=text.encode(), capture_output=True).returncode == 0, text
    exec(compile(text, "mechanism.py", "exec"), names)
    return sketch, names["build"](names["Params"]()), names
