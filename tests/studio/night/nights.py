"""Nights whose stages are stand-ins: the order, the locks and the ends are real."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from shared.stage.paths import ROOT


@dataclass
class Night:
    """A folder of results, and what the stand-ins shall do."""

    folder: Path

    def __post_init__(self) -> None:
        self.folder.mkdir(exist_ok=True)
        script = self.folder / "python"
        stand_in = Path(__file__).with_name("stand_in.py")
        script.write_text(f"#!/bin/sh\nexec '{sys.executable}' -I -S '{stand_in}' '{self.folder}' \"$@\"\n")
        script.chmod(0o755)

    def tell(self, name: str, step: str, words: str) -> None:
        """Set the behaviour of this step of this mechanism, which else ends well at once."""
        (self.folder / f"{name}.{step}").write_text(words)

    def ran(self) -> list[str]:
        """``name step`` of every stage that was started, in order."""
        file = self.folder / "ran.txt"
        return file.read_text().splitlines() if file.exists() else []

    def start(
        self, only: str, *words: str, command: str = "run", hurried: bool = False, **variables: str
    ) -> subprocess.Popen[str]:
        """Start one, ``hurried`` with short waits; what it says can be read from its pipes."""
        module = "tests.studio.night.hurried" if hurried else "studio.night"
        inherited = {key: value for key, value in os.environ.items() if key not in ("MBSD_MAKE", "TMUX")}
        variables |= {"MBSD_OUT": str(self.folder / "out")}
        more = [f"--python={self.folder}/python", *words]
        return subprocess.Popen(
            [sys.executable, "-m", module, command, "--preset=draft", f"--only={only}", *more],
            cwd=ROOT,
            env=inherited | variables,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
        )

    def say(self, command: str) -> str:
        """Return the output of ``status`` or ``stop``."""
        variables = os.environ | {"MBSD_OUT": str(self.folder / "out")}
        words = [sys.executable, "-m", "studio.night", command]
        return subprocess.run(words, cwd=ROOT, env=variables, capture_output=True, text=True, check=True).stdout


def finished(night: subprocess.Popen[str], seconds: float = 60.0) -> tuple[int, str, str]:
    """Exit code, stdout and stderr of a night after its end."""
    out, err = night.communicate(timeout=seconds)
    return night.returncode, out, err
