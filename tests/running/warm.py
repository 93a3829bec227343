"""A process that has loaded the libraries of the stages and forks one for each command: loading takes long.

    warm.run("mechanisms", "parts", "four_bar", MBSD_OUT=folder)

What is forked has loaded nothing of the project, so that it runs as ``python -m mechanisms parts four_bar`` does.
"""

from __future__ import annotations

import importlib
import json
import os
import runpy
import subprocess
import sys
import tempfile
import traceback
from pathlib import Path
from typing import Any

from shared.stage.paths import ROOT
from tests.running.processes import ends_with_us

LIBRARIES = (
    *("cadquery", "manifold3d", "msgspec", "numba", "numpy", "trimesh", "rich", "pysat.solvers", "llvmlite.binding"),
    *("scipy.interpolate", "scipy.optimize", "scipy.sparse.csgraph", "scipy.spatial", "scipy.linalg", "scipy.stats"),
)
FORKS = sys.platform == "linux"
"""Elsewhere libraries of the system take it amiss, and each command is a process of its own."""


class Warm:
    """See the file. Started by the first command; :meth:`close` ends it."""

    def __init__(self) -> None:
        self.process: subprocess.Popen[str] | None = None

    def run(self, module: str, *words: str, **environment: str) -> subprocess.CompletedProcess[str]:
        """``python -m module words`` from the project's folder, with these variables besides those of the test."""
        variables = dict(os.environ) | environment
        if not FORKS:
            return subprocess.run(
                [sys.executable, "-m", module, *words], cwd=ROOT, env=variables, capture_output=True, text=True
            )
        if self.process is None:
            pipe = subprocess.PIPE
            self.process = subprocess.Popen(
                [sys.executable, "-m", __name__], cwd=ROOT, stdin=pipe, stdout=pipe, text=True, preexec_fn=ends_with_us
            )
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        self.process.stdin.write(json.dumps({"module": module, "words": words, "variables": variables}) + "\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline()
        if not answer:
            raise RuntimeError(f"the warm process ended with code {self.process.wait()}")
        done = json.loads(answer)
        return subprocess.CompletedProcess([module, *words], done["code"], done["out"], done["err"])

    def close(self) -> None:
        """End it."""
        if self.process is not None:
            self.process.communicate()


def serve() -> None:
    """Load the libraries; then a line of JSON comes for each command, and one goes when it has ended."""
    for name in LIBRARIES:
        importlib.import_module(name)
    for line in sys.stdin:
        with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:
            child = os.fork()
            if child == 0:
                _become(json.loads(line), out.fileno(), err.fileno())
            code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
            said = {name: _read(file) for name, file in (("out", out), ("err", err))}
        print(json.dumps({"code": code} | said), flush=True)


def _become(asked: dict[str, Any], out: int, err: int) -> None:
    """Run a command in the forked process, and end it."""
    code: Any = 1
    for name in [name for name in sys.modules if name.partition(".")[0] in ("shared", "tests")]:
        del sys.modules[name]
    try:
        nothing = os.open(os.devnull, os.O_RDONLY)
        for source, target in ((nothing, 0), (out, 1), (err, 2)):
            os.dup2(source, target)
        os.environ.clear()
        os.environ.update(asked["variables"])
        sys.argv = [str(Path(asked["module"]) / "__main__.py"), *asked["words"]]
        runpy.run_module(asked["module"], run_name="__main__", alter_sys=True)
        code = 0
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else int(end.code is not None)
    except BaseException:
        traceback.print_exc()
    finally:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)


def _read(file: Any) -> str:
    file.seek(0)
    return file.read()


if __name__ == "__main__":
    serve()
