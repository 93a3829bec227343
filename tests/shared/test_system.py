"""Missing libraries are named with their package; the table has all that packages really load."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from shared.stage.console import run_cli
from shared.stage.paths import ROOT
from shared.system import __main__ as command
from shared.system import missing
from shared.system.missing import LIBRARIES, PROGRAMS

LINUX = pytest.mark.skipif(sys.platform != "linux", reason="a Mac needs no libraries")


def lacks(patch: pytest.MonkeyPatch, *names: str, platform: str = "linux") -> None:
    """Pretend that this machine lacks these libraries and programs."""
    patch.setattr(missing.sys, "platform", platform)
    patch.setattr(missing, "_loads", lambda name: name not in names)
    patch.setattr(missing.shutil, "which", lambda name, path=None: None if name in names else f"/bin/{name}")
    patch.delenv("CHROMIUM", raising=False)


def test_a_missing_library_is_named_with_its_package(monkeypatch: pytest.MonkeyPatch) -> None:
    lacks(monkeypatch, "libGL.so.1", "libXi.so.6")
    assert missing.missing_libraries() == ["libGL.so.1", "libXi.so.6"]
    assert missing.sentence(missing.missing_libraries()) == (
        "missing system libraries libGL.so.1, libXi.so.6: sudo apt-get install -y libgl1 libxi6"
    )
    monkeypatch.setattr(missing.sys, "platform", "darwin")
    assert missing.missing_libraries() == []


def test_a_library_is_really_loaded() -> None:
    assert not missing._loads("libThisIsNoLibrary.so.1")


def test_programs_are_found_by_each_of_their_names_by_a_variable_and_beside_a_users_path(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    for name in ("google-chrome", "sshd"):
        (tmp_path / name).touch(0o755)
    monkeypatch.setattr(missing, "SBIN", str(tmp_path))
    monkeypatch.setenv("PATH", "/nowhere")
    monkeypatch.delenv("CHROMIUM", raising=False)
    assert missing.program("sshd") == str(tmp_path / "sshd")
    assert missing.program("chromium") == str(tmp_path / "google-chrome")
    monkeypatch.setenv("CHROMIUM", "/opt/browser")
    assert missing.program("chromium") == "/opt/browser"
    assert missing.missing_programs(["sshd", "chromium", "tmux", "no-such-program"]) == ["tmux", "no-such-program"]


@pytest.mark.parametrize(
    ("platform", "command"),
    [
        ("linux", "sudo apt-get install -y libgl1 chromium openssh-client openssh-server"),
        ("darwin", "brew install --cask chromium"),
    ],
)
def test_the_command_that_installs_is_that_of_the_system(
    platform: str, command: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(missing.sys, "platform", platform)
    names = ["chromium", "ssh", "ssh-keygen", "sshd", "no-such-program"]
    assert missing.remedy([*(["libGL.so.1"] if platform == "linux" else []), *names]) == command
    assert missing.sentence(programs=["no-such-program"]) == "missing programs no-such-program"


def test_the_command_prints_a_sentence_or_packages(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    lacks(monkeypatch, "libGL.so.1", "rsync", "sshd")
    line = "missing system libraries libGL.so.1 and programs rsync, sshd: "
    for words, out, err in (
        (["--for-tests", "--packages"], "libgl1 rsync openssh-server\n", ""),
        (["--packages"], "libgl1\n", ""),
        (["--for-tests"], "", f"{line}sudo apt-get install -y libgl1 rsync openssh-server\n"),
        ([], "", "missing system libraries libGL.so.1: sudo apt-get install -y libgl1\n"),
    ):
        monkeypatch.setattr(sys, "argv", ["shared.system", *words])
        assert command.main() == 1
        assert capsys.readouterr() == (out, err)
    lacks(monkeypatch, "rsync")
    monkeypatch.setattr(sys, "argv", ["shared.system"])
    assert command.main() == 0


def test_each_of_the_programs_of_tests_is_named_when_it_alone_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("chromium", "rsync", "ssh", "sshd", "tmux"):
        lacks(monkeypatch, *(PROGRAMS[name].names or (name,)))
        assert missing.missing_programs() == [name]
        assert missing.sentence(programs=[name]).endswith(f": sudo apt-get install -y {PROGRAMS[name].debian}")


def test_a_stage_that_cannot_load_for_want_of_a_library_says_which(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def stage() -> None:
        raise ImportError("libGL.so.1: cannot open shared object file")

    lacks(monkeypatch, "libGL.so.1")
    with pytest.raises(SystemExit) as ended:
        run_cli(stage)
    assert ended.value.code == 1
    line = "error: missing system libraries libGL.so.1: sudo apt-get install -y libgl1 (libGL.so.1: cannot open shared"
    assert line in capsys.readouterr().err
    lacks(monkeypatch)
    with pytest.raises(ImportError):  # a fault of the program
        run_cli(stage)


@LINUX
@pytest.mark.parametrize("module", ["bpy", "cadquery, lib3mf, manifold3d, pysat.solvers, trimesh"])
def test_the_table_has_all_libraries_that_packages_load_from_the_system(module: str) -> None:
    """By what the loader tells of each library: who needs it. Those of the C compiler and library are everywhere."""
    everywhere = (
        r"(libpython3.*|libc|libm|libdl|librt|libpthread|libutil|libmvec|libgcc_s|libstdc\+\+|libz|ld-linux.*)\.so.*"
    )
    done = subprocess.run(
        [sys.executable, "-c", f"import {module}"],
        cwd=ROOT,
        env=os.environ | {"LD_DEBUG": "files"},
        capture_output=True,
        text=True,
        errors="replace",
        check=True,
    )
    needs = re.findall(r"file=(\S+) \[0\];  needed by (\S+)", done.stderr)
    if not needs:
        pytest.skip("this system's loader tells nothing")
    brought = {path.name for path in Path(sys.prefix).rglob("*.so*")}
    wanted = {name for name, by in needs if by.startswith(sys.prefix) and "/" not in name} - brought
    assert "libGL.so.1" in wanted
    assert {name for name in wanted if not re.fullmatch(everywhere, name)} <= set(LIBRARIES)


def test_any_python_can_ask() -> None:
    """Before there is an environment: the standard library alone, without the site's packages."""
    code = f"import sys; sys.path.insert(0, {str(ROOT)!r}); import shared.system.__main__"
    done = subprocess.run([sys.executable, "-S", "-I", "-c", code], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
