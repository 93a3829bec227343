"""An installation that does nothing twice, and says what is missing; the locked versions."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from shared.stage.paths import ROOT
from tests.running.make import copy_tools, run


def test_the_locks_hold_hashes_and_no_addresses() -> None:
    for lock in ("requirements.lock", "requirements-bench.lock"):
        text = (ROOT / lock).read_text()
        assert not re.search(r"https?:|file:|^-|--index|--find-links", text, flags=re.MULTILINE)
        for block in re.split(r"\n(?=\S)", text.strip()):
            assert re.match(r"[a-z0-9._-]+==\S+( ; .*)? \\\n    --hash=sha256:[0-9a-f]{64}", block), block[:200]


def test_the_benchmarks_add_to_the_locked_versions_and_change_none() -> None:
    from tools.check import locked

    main, bench = locked(ROOT / "requirements.lock"), locked(ROOT / "requirements-bench.lock")
    assert {"exudyn", "pylinkage"} <= set(bench)
    assert all(main[name] == version for name, version in bench.items() if name in main)


NOT_COMPILED = shutil.ignore_patterns("__pycache__")


class Tree:
    """A copy of the bootstrap in a folder of its own, with a uv that writes down what it is asked for."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        copy_tools(folder)
        shutil.copytree(ROOT / "shared" / "system", folder / "shared" / "system", ignore=NOT_COMPILED)
        shutil.copy(ROOT / "shared" / "__init__.py", folder / "shared")
        (folder / "mbsd").mkdir()
        (folder / "mbsd" / "__init__.py").touch()
        (folder / "mbsd" / "__main__.py").write_text("import sys; print('mbsd', *sys.argv[1:])\n")
        self.lock = folder / "requirements.lock"
        self.lock.write_text("numpy==2.5.5\n")
        (folder / "requirements-bench.lock").write_text("exudyn==1\n")
        self.bin = folder / "bin"
        self.bin.mkdir()
        self.asked = folder / "asked"
        self.uv("exit 0")

    def uv(self, sync: str) -> None:
        """Install a uv that makes the environment from the Python of the tests and answers a sync with ``sync``."""
        script = f"""#!/bin/sh
        [ "$1" = --version ] && exit 0
        echo "$@" >>{self.asked}
        if [ "$1" = venv ]; then
            mkdir -p .venv/bin
            printf '#!/bin/sh\\nexec {sys.executable} "$@"\\n' >.venv/bin/python
            chmod +x .venv/bin/python
        else
            {sync}
        fi
        """
        (self.bin / "uv").write_text(script)
        (self.bin / "uv").chmod(0o755)

    def install(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        self.asked.unlink(missing_ok=True)
        path = f"{self.bin}:{os.environ['PATH']}"
        return run("sh", "tools/install.sh", *arguments, cwd=self.folder, PATH=path, HOME=str(self.folder))

    def python(self, module: str, *arguments: str) -> subprocess.CompletedProcess[str]:
        """Run a module of the folder."""
        return run(str(self.folder / ".venv" / "bin" / "python"), "-m", module, *arguments, cwd=self.folder)

    @property
    def calls(self) -> list[str]:
        """The first two words of each call."""
        lines = self.asked.read_text().splitlines() if self.asked.exists() else []
        return [" ".join(line.split()[:2]) for line in lines]


@pytest.fixture
def tree(tmp_path: Path) -> Tree:
    return Tree(tmp_path)


def test_install_makes_the_environment_once(tree: Tree) -> None:
    first = tree.install()
    assert first.returncode == 0, first.stderr
    assert tree.calls == ["venv --quiet", "pip sync"]
    assert "--require-hashes requirements.lock" in tree.asked.read_text()
    assert "compiling the solver's kernels in the background" in first.stdout
    assert tree.python("tools.compiling", "wait").returncode == 0
    assert (tree.folder / ".venv" / "kernels.log").read_text() == "mbsd compile\n"
    again = tree.install()
    assert (again.returncode, again.stdout, again.stderr, tree.calls) == (0, "", "", [])


def test_install_follows_the_content_of_the_lock(tree: Tree) -> None:
    tree.install()
    os.utime(tree.lock)
    tree.install()
    assert tree.calls == []
    tree.lock.write_text("numpy==2.5.6\n")
    tree.install()
    assert tree.calls == ["pip sync"]


def test_a_failed_install_is_told_and_tried_again(tree: Tree) -> None:
    tree.uv("echo no network >&2; exit 2")
    failed = tree.install()
    assert failed.returncode == 1
    assert "no network" in failed.stderr
    assert "error: the packages of requirements.lock could not be installed" in failed.stderr
    tree.uv("exit 0")
    assert tree.install().returncode == 0
    assert tree.calls == ["pip sync"]


def test_a_failed_compilation_is_told_by_who_waits_and_by_the_next_install(tree: Tree) -> None:
    (tree.folder / "mbsd" / "__main__.py").write_text("raise SystemExit('no room')\n")
    assert tree.install().returncode == 0
    waited = tree.python("tools.compiling", "wait")
    assert (waited.returncode, waited.stderr) == (1, "no room\n")
    again = tree.install()
    assert again.returncode == 0
    assert re.search(r"warning: kernels were not compiled .*: no room \(.*kernels\.log\)", again.stderr)
    tree.python("tools.compiling", "wait")
    (tree.folder / "mbsd" / "__main__.py").write_text("")
    assert tree.python("tools.compiling", "wait").returncode == 0
    assert tree.install().stderr == ""


def test_kernels_are_compiled_once_beside_what_goes_on_and_waited_for(tree: Tree) -> None:
    """A second install starts none; a Ctrl-C at the terminal does not reach it; it has the lowest priority."""
    begun, go = tree.folder / "begun", tree.folder / "go"
    code = f"""
import os, time
with open({str(begun)!r}, "a") as file:
    file.write(f"{{os.nice(0)}} {{os.getsid(0) == {os.getsid(0)}}}\\n")
while not os.path.exists({str(go)!r}):
    time.sleep(0.01)
"""
    (tree.folder / "mbsd" / "__main__.py").write_text(code)
    assert "in the background" in tree.install().stdout
    assert tree.install().stdout == ""
    with subprocess.Popen(
        [sys.executable, "-m", "tools.compiling", "wait"], cwd=tree.folder, stdout=subprocess.PIPE, text=True
    ) as waiting:
        assert waiting.stdout is not None
        assert waiting.stdout.readline() == "install: waiting for the solver's kernels\n"
        assert waiting.poll() is None
        go.touch()
        assert waiting.wait(30) == 0
    assert begun.read_text() == f"{min(os.nice(0) + 19, 19)} False\n"


def test_an_environment_whose_python_is_gone_is_made_again(tree: Tree) -> None:
    tree.install()
    (tree.folder / ".venv" / "bin" / "python").unlink()
    tree.install()
    assert tree.calls == ["venv --quiet", "pip sync"]


def test_a_missing_system_library_is_named_with_its_cure_until_it_is_there(tree: Tree) -> None:
    probe = tree.folder / "shared" / "system" / "missing.py"
    text = probe.read_text()
    probe.write_text(text.replace('"libGL.so.1"', '"libNotThere.so.1"'))
    done = tree.install()
    assert done.returncode == 0
    if sys.platform == "linux":
        line = "missing system libraries libNotThere.so.1: sudo apt-get install -y libgl1\n"
        assert done.stderr == 2 * line, "before packages are fetched and at the end"
        assert "libNotThere" in tree.install().stderr
    probe.write_text(text)
    tree.install()
    probe.unlink()  # found once, asked no more
    assert tree.install().returncode == 0


def test_the_peers_of_the_benchmarks_are_added_once(tree: Tree) -> None:
    tree.install()
    tree.install("bench")
    assert tree.calls == ["pip install"]
    tree.install("bench")
    assert tree.calls == []


def test_without_uv_and_without_a_network_the_remedy_is_told(tree: Tree) -> None:
    (tree.bin / "uv").write_text("#!/bin/sh\nexit 127\n")  # as a version manager's shim may do
    home = tree.folder / "home"
    home.mkdir()
    path = f"{tree.bin}:/usr/bin:/bin"
    no_network = {"PIP_NO_INDEX": "1", "PIP_FIND_LINKS": str(home), "PIP_BREAK_SYSTEM_PACKAGES": "1"}
    done = run("sh", "tools/install.sh", cwd=tree.folder, PATH=path, HOME=str(home), **no_network)
    assert done.returncode == 1
    assert "error: uv could not be installed" in done.stderr
    assert "brew install uv" in done.stderr
    assert not (tree.folder / ".venv-uv").exists()
