"""make check: what stands in the way of a run is named with its cure."""

from __future__ import annotations

from pathlib import Path

import pytest

from shared.stage.paths import ROOT
from tools import check, system_libraries


def test_a_missing_library_is_named_with_its_package(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(system_libraries.sys, "platform", "linux")
    monkeypatch.setattr(system_libraries, "_loads", lambda name: name not in ("libGL.so.1", "libXi.so.6"))
    assert system_libraries.missing() == ["libGL.so.1", "libXi.so.6"]
    assert system_libraries.cure(system_libraries.missing()) == (
        "missing system libraries libGL.so.1, libXi.so.6: sudo apt-get install -y libgl1 libxi6"
    )
    monkeypatch.setattr(system_libraries.sys, "platform", "darwin")
    assert system_libraries.missing() == []


def test_a_library_is_really_loaded() -> None:
    assert not system_libraries._loads("libThisIsNoLibrary.so.1")


def test_programs_of_tests_are_named_with_their_packages(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(system_libraries, "missing", lambda: ["libGL.so.1"])
    monkeypatch.setattr(
        system_libraries.shutil, "which", lambda name, path=None: None if name != "ssh" else "/usr/bin/ssh"
    )
    for words, out, err in (
        (["--for-tests", "--packages"], "libgl1 chromium rsync openssh-server tmux\n", ""),
        (["--packages"], "libgl1\n", ""),
        (
            ["--for-tests"],
            "",
            "chromium, rsync, sshd, tmux: sudo apt-get install -y chromium rsync openssh-server tmux\n",
        ),
    ):
        monkeypatch.setattr(system_libraries.sys, "argv", ["system_libraries", *words])
        assert system_libraries.main() == 1
        said = capsys.readouterr()
        assert said.out == out
        assert said.err.endswith(err)
    monkeypatch.setattr(system_libraries, "missing", list)
    monkeypatch.setattr(system_libraries.sys, "argv", ["system_libraries"])
    assert system_libraries.main() == 0


def test_faults_are_warned_of_and_fail_the_check(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(check, "locked", lambda _: {"numpy": "1.0", "no-such-package": "2.0"})
    monkeypatch.setattr(check.shutil, "disk_usage", lambda _: type("Usage", (), {"free": 1e9}))
    monkeypatch.setattr(check.system_libraries, "missing", lambda: ["libGL.so.1"])
    assert check.main() == 1
    said = capsys.readouterr().err
    assert "no-such-package is missing, requirements.lock has 2.0" in said
    assert "requirements.lock has 1.0; remove .venv and run make install" in said
    assert "apt-get install -y libgl1" in said
    assert "only 1.0 GB free" in said


def test_the_lock_is_read(tmp_path: Path) -> None:
    lock = tmp_path / "requirements.lock"
    lock.write_text("a-b==1.2 \\\n    --hash=sha256:0\nwin==3 ; sys_platform == 'win32' \\\n    --hash=sha256:1\n")
    assert check.locked(lock) == {"a-b": "1.2"}
    assert len(check.locked(ROOT / "requirements.lock")) > 50
