"""Whatever decides the numbers of a study decides whether kept ones are returned, and nothing else does.

Each case is a folder with a script and what it uses; nothing is solved, so that a study takes milliseconds.
"""

from __future__ import annotations

import functools
import importlib
import os
import shutil
import subprocess
import sys
import threading
from collections.abc import Iterator
from importlib import metadata
from pathlib import Path
from typing import Any

import pytest

import mbsd
from mbsd import ModelError
from mbsd.dependencies import inputs
from mbsd.dependencies.installed import is_installed
from mbsd.studies import work
from shared.stage.paths import ROOT
from tests.studies.kept_changes import CHANGES, SAME, Change, script


class Folder:
    """A script's folder; its modules are loaded anew for each study, as a new process would."""

    def __init__(self, path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        self.path, self.patch, self.kept = path, monkeypatch, path.parent / "kept"
        self.computed, self._before = 0, set(sys.modules)
        plain = work.result_of

        def counted(*arguments: Any) -> work.Result:
            self.computed += 1
            return plain(*arguments)

        monkeypatch.setattr(work, "result_of", counted)
        # Versions of installed packages stay: looking them up takes half of the time of all studies here.
        monkeypatch.setattr(inputs.metadata, "version", functools.cache(metadata.version))
        for name, module in list(sys.modules.items()):  # what other tests wrote and loaded counts as changed
            file = getattr(module, "__file__", None)
            if isinstance(file, str) and not is_installed(file) and not Path(file).is_relative_to(ROOT):
                monkeypatch.delitem(sys.modules, name)
        # Bytecode counts as fresh by size and second of its source, which these edits do not change.
        monkeypatch.setattr(sys, "dont_write_bytecode", True)
        monkeypatch.setenv("PYTHONDONTWRITEBYTECODE", "1")  # of worker processes

    def write(self, name: str, text: str) -> None:
        file = self.path / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
        os.utime(file, (1e9, 1e9))  # before this process began

    def study(self, processes: int = 1, keep: bool = True, path: Path | None = None) -> list[float]:
        """Return measures at two points; ``computed`` is the number of points that were not known."""
        self.forget()
        self.computed = 0
        with self.patch.context() as patch:
            patch.syspath_prepend(str(path or self.path))
            study: Any = importlib.import_module("script")
            table = mbsd.study(
                study.build, {"x": [1.0, 2.0]}, study.measure,
                folder=self.kept if keep else None, processes=processes, progress=False,
            )  # fmt: skip
        assert list(table["reason"].notna()) == [False, False], list(table["reason"])
        return list(table["y"])

    def forget(self) -> None:
        importlib.invalidate_caches()
        for name in set(sys.modules) - self._before:
            if str(getattr(sys.modules[name], "__file__", None) or "").startswith(str(self.path.parent)):
                del sys.modules[name]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Folder]:
    made = Folder(tmp_path / "project", monkeypatch)
    yield made
    made.forget()


def begin(folder: Folder, change: Change) -> None:
    for name, text in change.files.items():
        folder.write(name, text)


def edit(folder: Folder, change: Change) -> None:
    text = change.files.get(change.edited, "")
    assert change.old in text
    folder.write(change.edited, text.replace(change.old, change.new) if change.old else change.new)


@pytest.mark.parametrize("name", CHANGES)
def test_a_change_is_computed_again(folder: Folder, name: str) -> None:
    change = CHANGES[name]
    begin(folder, change)
    first = folder.study()
    assert (folder.study(), folder.computed) == (first, 0)
    edit(folder, change)
    second = folder.study()
    assert folder.computed == 2
    assert second == folder.study(keep=False) != first
    assert (folder.study(), folder.computed) == (second, 0)


@pytest.mark.parametrize("name", SAME)
def test_changes_of_no_number_compute_nothing_again(folder: Folder, name: str) -> None:
    change = SAME[name]
    begin(folder, change)
    first = folder.study()
    edit(folder, change)
    assert (folder.study(), folder.computed) == (first, 0)


MIXED = """
import functools, importlib.util
from pathlib import Path
HERE = Path(__file__).parent

@functools.cache
def read():
    return float((HERE / "data.txt").read_text())

def by_path():
    spec = importlib.util.spec_from_file_location("other", HERE / "other.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.K

def build(x):
    from helper import K
    return x * K * read() * by_path()

def measure(m):
    return {"y": m}
"""
FILES = {"script.py": MIXED, "helper.py": "K = 2.0\n", "other.py": "K = 5.0\n", "data.txt": "7.0"}


def test_files_that_processes_load_and_read_count(folder: Folder) -> None:
    for name, text in FILES.items():
        folder.write(name, text)
    first = folder.study(2)
    assert first == [70.0, 140.0]
    folder.write("script.py", "# all of it\n" + MIXED)
    assert (folder.study(), folder.computed) == (first, 0)
    for name, text, y in (
        ("helper.py", "K = 3.0\n", 105.0),
        ("other.py", "K = 1.0\n", 14.0),
        ("data.txt", "2.0", 20.0),
    ):
        folder.write(name, text)
        assert (folder.study(), folder.computed) == ([y, 2 * y], 2)
        folder.write(name, FILES[name])  # what was is known again
        assert (folder.study(), folder.computed) == (first, 0)


def test_a_copy_in_another_folder_and_touched_files_are_known(folder: Folder) -> None:
    for name, text in FILES.items():
        folder.write(name, text)
    first = folder.study()
    there = folder.path.with_name("another project")
    shutil.copytree(folder.path, there)
    for file in there.iterdir():
        os.utime(file)
    assert (folder.study(path=there), folder.computed) == (first, 0)
    (there / "data.txt").write_text("8.0")
    assert folder.study(path=there) == [80.0, 160.0]
    assert (folder.study(), folder.computed) == (first, 0)


def test_a_file_that_changes_meanwhile_leaves_nothing_kept(folder: Folder) -> None:
    change = CHANGES["read_text"]
    begin(folder, change)
    plain = work.result_of

    def changing(*arguments: Any) -> work.Result:
        result = plain(*arguments)
        folder.write("data.txt", "3.0")
        return result

    with folder.patch.context() as patch:
        patch.setattr(work, "result_of", changing)
        assert folder.study() == [2.0, 6.0]
    assert folder.study() == [3.0, 6.0]


def test_a_module_that_was_edited_after_it_was_loaded_is_not_taken_for_the_new_one(folder: Folder) -> None:
    """As in a notebook, whose kernel goes on with what it has."""
    change = CHANGES["an attribute of a module by its name"]
    begin(folder, change)
    plain, folder.forget = folder.forget, lambda: None
    folder.study()
    (folder.path / "helper.py").write_text("def f():\n    return 3.0\n")
    assert folder.study() == [2.0, 4.0]
    folder.forget = plain
    os.utime(folder.path / "helper.py", (1e9, 1e9))  # a new process
    assert folder.study() == [3.0, 6.0]


def test_another_version_of_a_package_is_computed_again(folder: Folder) -> None:
    begin(folder, script("import pandas\n", "len(pandas.Series([1, 2]))"))
    folder.study()
    plain = inputs.package_state
    folder.patch.setattr(inputs, "package_state", lambda name: "9.9" if name == "pandas" else plain(name))
    folder.study()
    assert folder.computed == 2


def test_a_variable_of_the_environment_counts(folder: Folder) -> None:
    begin(folder, script("import os\n", "float(os.environ.get('FACTOR', '1'))"))
    for value, y in (("", 1.0), ("2.5", 2.5)):
        folder.patch.setenv("FACTOR", value) if value else folder.patch.delenv("FACTOR", raising=False)
        assert folder.study() == [y, 2 * y]
        assert (folder.study(), folder.computed) == ([y, 2 * y], 0)


def test_a_relative_path_leads_elsewhere_from_another_folder(folder: Folder, tmp_path: Path) -> None:
    begin(folder, script("import numpy as np\n", "float(np.loadtxt('factor.txt'))"))
    for name, y in (("here", 2.0), ("there", 3.0)):
        place = tmp_path / name
        place.mkdir()
        (place / "factor.txt").write_text(str(y))
        folder.patch.chdir(place)
        assert folder.study() == [y, 2 * y]


def test_a_script_that_is_run_keeps_its_results(tmp_path: Path) -> None:
    """Its functions are of __main__; a cached one, a dataclass and an import inside go to two processes."""
    code = """
import functools, sys
from dataclasses import dataclass
from mbsd import study

@dataclass(frozen=True)
class Params:
    factor: float = 2.0

@functools.cache
def factor():
    from helper import K
    return K

def build(x):
    return x * Params().factor

def measure(m):
    print("computed", file=sys.stderr)
    return {"y": m * factor()}

print(list(study(build, {"x": [1.0, 2.0]}, measure, processes=PROCESSES, progress=False)["y"]))
"""
    helper = tmp_path / "helper.py"
    helper.write_text("K = 1.0\n")
    script = tmp_path / "script.py"

    def run(text: str) -> tuple[str, int]:
        script.write_text(text)
        environment = os.environ | {"PYTHONPATH": str(ROOT), "PYTHONDONTWRITEBYTECODE": "1"}
        done = subprocess.run(
            [sys.executable, "script.py"], cwd=tmp_path, env=environment, capture_output=True, text=True, check=True
        )
        return done.stdout.strip(), done.stderr.count("computed")

    code = code.replace("PROCESSES", "1")
    assert run(code) == ("[2.0, 4.0]", 2)
    assert run("# a comment\n" + code.replace("[1.0, 2.0]}", "[1.0, 2.0, 3.0]}")) == ("[2.0, 4.0, 6.0]", 1)
    helper.write_text("K = 3.0\n")
    assert run(code.replace("processes=1", "processes=2"))[0] == "[6.0, 12.0]"


def test_objects_without_content_are_refused_with_the_remedy(tmp_path: Path) -> None:
    lock = threading.Lock()
    with pytest.raises(ModelError, match=r"refers to <unlocked .*content is unknown.*folder=None"):
        mbsd.study(lambda x: x, {"x": [1]}, lambda m: {"y": lock.locked()}, folder=tmp_path)
