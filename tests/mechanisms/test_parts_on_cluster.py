"""Parts by a scheduler and three workers on loopback, the one at work killed: the same bytes as here."""

from __future__ import annotations

import os
import shutil
import signal
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import dask.config
import distributed
import psutil
import pytest

from mbsd.dealing import hand
from mechanisms.stages.parts import stage as parts_stage
from mechanisms.stages.parts.on_cluster import built, dealt
from mechanisms.stages.parts.on_cluster.answer import Made
from mechanisms.stages.parts.on_cluster.author_files import collected
from shared.stage.errors import UserError
from shared.stage.files import is_abandoned
from tests.mechanisms.author_project import Project, put
from tests.mechanisms.test_inputs_of_parts import MECHANISM, PARTS

WIDE = "def arm(p):\n    return box(1000 * p.length, float((HERE / 'data' / 'width.txt').read_text()))\n"


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, out_root: Path) -> Project:
    """A mechanism whose parts.py reads a file beside it."""
    project = Project(tmp_path / "project", monkeypatch, parts_stage)
    put("mechanisms/arm/mechanism.py", MECHANISM)(project)
    put("mechanisms/arm/parts.py", PARTS + WIDE)(project)
    put("mechanisms/arm/data/width.txt", "7.5")(project)
    put("mechanisms/other/large.step", "not for others")(project)
    return project


@pytest.fixture
def cluster(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """A scheduler and three workers, each a process with a nanny that starts it again."""
    with (
        pytest.MonkeyPatch.context() as patch,
        dask.config.set({"distributed.client.scheduler-info-interval": "200ms"}),
    ):
        patch.setenv("MBSD_OUT", str(tmp_path / "workers"))
        with distributed.LocalCluster(n_workers=3, threads_per_worker=1, dashboard_address=None) as cluster:
            patch.undo()
            monkeypatch.setattr(hand, "REST", 0.1)
            yield cluster


def files(folder: Path) -> dict[str, bytes]:
    paths = sorted(path for path in folder.rglob("*") if path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in paths}


@pytest.mark.slow
def test_a_killed_worker_loses_no_parts_and_changes_none(
    project: Project, cluster: Any, out_root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    killed: list[psutil.Process] = []

    def kill() -> None:
        """The worker that has begun a stage."""
        workers = [psutil.Process(worker.pid) for worker in cluster.workers.values()]
        while not killed:
            for worker in workers:
                if stages := [process for process in worker.children() if "parts" in process.cmdline()]:
                    os.kill(worker.pid, signal.SIGKILL)
                    killed.extend(stages)
                    return
            time.sleep(0.02)

    monkeypatch.setenv("CLUSTER", cluster.scheduler_address)
    killer = threading.Thread(target=kill, daemon=True)
    killer.start()
    assert project.run()
    assert len(killed) == 1
    assert not psutil.wait_procs(killed, timeout=20)[1]
    assert "parts: arm: made by worker tcp://" in capsys.readouterr().out
    assert not project.run()
    far = files(out_root / "arm")

    monkeypatch.setenv("CLUSTER", "")
    shutil.rmtree(out_root / "arm")
    assert project.run()
    assert files(out_root / "arm") == far
    assert len(far) == 6
    left = list((tmp_path / "workers" / ".cluster" / "parts").iterdir())
    assert all(is_abandoned(path / built.LOCK) for path in left)
    assert len(left) <= 1


@pytest.mark.parametrize("change", ["the disk has another file", "the worker refuses"])
def test_what_a_worker_cannot_tell_is_made_here(
    project: Project, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], out_root: Path, change: str
) -> None:
    assert project.run()
    here, stamp = files(out_root / "arm"), parts_stage.Stage(parts_stage.Out("arm"), "parts", "", [])
    solids = {name.removeprefix("parts/"): content for name, content in here.items() if name.startswith("parts/")}
    made = Made(solids.pop("parts.json"), dict.fromkeys(solids, b"other"), stamp.notes())
    put("mechanisms/arm/data/width.txt", "9.0")(project)
    monkeypatch.setenv("CLUSTER", "tcp://127.0.0.1:1")
    monkeypatch.setattr(dealt, "made_elsewhere", lambda *_: made if "disk" in change else None)
    assert project.run()
    said = capsys.readouterr()
    assert ("has otherwise; it is made here" in said.err) == ("disk" in change)
    now = files(out_root / "arm")
    assert now["parts/arm.stl"] not in (b"other", here["parts/arm.stl"])


def test_files_of_authors_travel_and_no_others(project: Project) -> None:
    put("mechanisms/arm/__pycache__/parts.cpython-313.pyc", "")(project)
    put("mechanisms/stages/new.py", "")(project)
    put("mechanisms/automatic.py", "")(project)
    put("mechanisms/helper.py", "")(project)
    (project.folder / "gone.step").symlink_to("nowhere")
    own = {f"mechanisms/arm/{name}" for name in ("mechanism.py", "parts.py", "data/width.txt")}
    assert set(collected("arm")) == own | {"mechanisms/helper.py", "mechanisms/other/mechanism.py"}


@pytest.mark.parametrize("path", ["../x.py", "/etc/x", "shared/x.py", "mechanisms/stages/x.py", "mechanisms/../x.py"])
def test_a_worker_writes_no_other_files(tmp_path: Path, path: str) -> None:
    with pytest.raises(UserError, match="is no file of an author's"):
        built._write_file(tmp_path / "tree", path, b"")
    assert not list(tmp_path.rglob("*.py"))
