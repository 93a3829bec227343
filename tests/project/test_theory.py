"""docs/theory.md is what the docstrings say now."""

from __future__ import annotations

import subprocess
import sys

from shared.stage.paths import ROOT


def test_the_page_is_up_to_date() -> None:
    done = subprocess.run([sys.executable, str(ROOT / "tools" / "theory.py"), "--check"], check=False)
    assert done.returncode == 0, "the solver's docstrings have changed: make docs"
