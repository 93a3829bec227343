"""make overnight: in tmux, without it, beside another run, and where the system ends all at the logout."""

from __future__ import annotations

import os
import re
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from studio.night import background
from tests.running.needs import needs
from tests.running.processes import until
from tests.studio.night.nights import Night, finished


@pytest.fixture
def night(tmp_path: Path) -> Iterator[Night]:
    made = Night(tmp_path / "night")
    made.tell("four_bar", "clearance", "sleep 300")
    yield made
    for name in ("four_bar", "slider_crank"):
        made.tell(name, "clearance", "")
    made.say("stop")


def tools(folder: Path, *without: str) -> str:
    """A PATH with all programs but these."""
    folder.mkdir()
    for place in os.environ["PATH"].split(os.pathsep):
        for program in Path(place).iterdir() if Path(place).is_dir() else ():
            if program.name not in without and program.is_file() and not os.path.lexists(folder / program.name):
                (folder / program.name).symlink_to(program)
    return str(folder)


def test_it_goes_on_without_its_terminal_and_says_how_to_attach(night: Night, tmp_path: Path):
    needs("tmux")
    code, out, err = finished(night.start("four_bar", command="start"))
    assert code == 0, err
    assert "started as run 1; it continues after you log out" in out
    attach = re.findall(r"attach to it: tmux (-L \S+) attach -t (night\S*)", out)[0]
    listing = subprocess.run(["tmux", *attach[0].split(), "list-sessions", "-F", "#S"], capture_output=True, text=True)
    assert attach[1] in listing.stdout.split()
    until(lambda: "four_bar clearance" in night.ran())
    again = finished(night.start("slider_crank", command="start"))
    assert "run 1 is running already (process" in again[2]
    assert "started as run 2" in again[1]
    assert "attach -t night-2" in again[1]
    until(lambda: "slider_crank film" in night.ran())
    assert "run 1 has ended after" in night.say("stop")
    listed = ["tmux", *attach[0].split(), "list-sessions"]
    until(lambda: subprocess.run(listed, capture_output=True).stdout == b"")


def test_without_tmux_it_goes_on_as_well_and_that_is_told(night: Night, tmp_path: Path):
    path = tools(tmp_path / "bin", "tmux", "busctl")
    code, out, err = finished(night.start("four_bar", command="start", PATH=path))
    assert code == 0, err
    assert "tmux is not installed" in err
    assert f"tail -f {night.folder}/out/night/log.txt" in out
    until(lambda: "four_bar clearance" in night.ran())
    assert "at work as process" in night.say("status")


def test_where_the_system_ends_all_at_the_logout_a_scope_and_a_word_stand_against_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    programs = tmp_path / "bin"
    programs.mkdir()
    for name, word in (("busctl", "b true"), ("systemd-run", "")):
        (programs / name).write_text(f"#!/bin/sh\necho '{word}'\n")
        (programs / name).chmod(0o755)
    monkeypatch.setenv("PATH", f"{programs}:{os.environ['PATH']}")
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    monkeypatch.setattr(background, "LINGERING", tmp_path)
    monkeypatch.setenv("LOGNAME", "ada")
    said: list[str] = []
    background.warn_if_it_ends_all(lambda _, text: said.append(text))
    assert said == ["this system ends all programs of yours when you log out; run: loginctl enable-linger ada"]
    assert background.scope()[:3] == ["systemd-run", "--user", "--scope"]
    (tmp_path / "ada").touch()
    background.warn_if_it_ends_all(lambda _, text: said.append(text))
    assert len(said) == 1
    (programs / "busctl").write_text("#!/bin/sh\necho 'b false'\n")
    assert background.scope() == []
    monkeypatch.setenv("PATH", str(tmp_path))
    assert not background.ends_all()
