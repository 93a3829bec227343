"""make check: what stands in the way of a run is named with its cure."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from shared.stage.paths import ROOT
from tests.running.make import run
from tools import check


def test_faults_are_warned_of_and_fail_the_check(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(check, "locked", lambda _: {"numpy": "1.0", "no-such-package": "2.0"})
    monkeypatch.setattr(check.shutil, "disk_usage", lambda _: type("Usage", (), {"free": 1e9}))
    monkeypatch.setattr(check, "missing_libraries", lambda: ["libGL.so.1"])
    monkeypatch.setattr(check, "missing_programs", lambda: ["rsync"])
    assert check.main() == 1
    out, said = capsys.readouterr()
    assert "programs: missing programs rsync: " in out
    assert "rsync" not in said, "no run needs it"
    assert "no-such-package is missing, requirements.lock has 2.0" in said
    assert "requirements.lock has 1.0; remove .venv and run make install" in said
    assert "libGL.so.1: " in said
    assert "only 1.0 GB free" in said


def test_the_lock_is_read(tmp_path: Path) -> None:
    lock = tmp_path / "requirements.lock"
    lock.write_text("a-b==1.2 \\\n    --hash=sha256:0\nwin==3 ; sys_platform == 'win32' \\\n    --hash=sha256:1\n")
    assert check.locked(lock) == {"a-b": "1.2"}
    assert len(check.locked(ROOT / "requirements.lock")) > 50


def test_check_tells_versions_libraries_disk_and_device() -> None:
    done = run("make", "-o", "install", "check")
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert [line.partition(":")[0] for line in lines] == [
        "python",
        "packages",
        "system libraries",
        "programs",
        "disk",
        "render device",
    ]
    assert re.search(r"numpy \d+\.\d+\.\d+, .*bpy 5\.2", lines[1])
    assert re.search(r"\d+ GB free", lines[4])
    assert re.search(r"(CPU|OPTIX|CUDA|HIP|METAL|ONEAPI).*, Blender 5\.2", lines[5])
