"""Films fetched through a real sshd on loopback: only changed ones, and the rest of partial ones."""

from __future__ import annotations

import getpass
import os
import random
import re
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from shared.stage.errors import UserError
from shared.stage.paths import ROOT
from studio.fetch import fetch, transfer
from tests.running.needs import needs
from tests.running.processes import working_for
from tests.studio.loopback_ssh import Machine, machine

HOST = f"{getpass.getuser()}@127.0.0.1"
LARGE = 6_000_000


@pytest.fixture(scope="module")
def other(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Machine]:
    needs("rsync", "ssh", "ssh-keygen", "sshd")
    with machine(tmp_path_factory.mktemp("ssh") / "machine") as host:
        yield host


@pytest.fixture
def project(tmp_path: Path, other: Machine, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the project on the other machine, with films; $RSYNC_RSH leads there."""
    monkeypatch.setenv("RSYNC_RSH", other.shell())
    films = tmp_path / "there" / "out" / "films"
    films.mkdir(parents=True)
    for name, size in (("arm-preview.mp4", 4000), ("leg-preview.mp4", LARGE)):
        (films / name).write_bytes(random.Random(name).randbytes(size))
    (films / ".arm-preview-x1.mp4").write_bytes(b"half a film")
    (films / "notes.txt").write_text("no film")
    return tmp_path / "there"


def there(project: Path) -> dict[str, bytes]:
    films = (project / "out" / "films").glob("[!.]*")
    return {path.name: path.read_bytes() for path in films if path.suffix in (".mp4", ".srt")}


def here(out_root: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in (out_root / "films").iterdir()}


def test_films_come_and_only_what_changed(
    out_root: Path, project: Path, other: Machine, capsys: pytest.CaptureFixture[str]
) -> None:
    assert fetch.run(HOST, str(project)) == ["arm-preview.mp4", "leg-preview.mp4"]
    assert here(out_root) == there(project)
    assert [path.name for path in out_root.iterdir()] == ["films"]
    assert int(other.counted.read_text()) > LARGE
    assert "fetch: leg-preview.mp4: 6.0 MB" in capsys.readouterr().out

    assert fetch.run(HOST, str(project)) == []
    assert int(other.counted.read_text()) < 20_000
    assert "nothing to do: all films are here" in capsys.readouterr().out

    arm = project / "out" / "films" / "arm-preview.mp4"
    stat = arm.stat()
    arm.write_bytes(arm.read_bytes()[::-1])
    os.utime(arm, ns=(stat.st_atime_ns, stat.st_mtime_ns))  # of the same size and age, as after a clock was set back
    future = time.time() + 1e6
    for path in (out_root / "films").iterdir():
        os.utime(path, (future, future))
    (arm.parent / "arm-preview.srt").write_text("1\n00:00:00,500 --> 00:00:02,000\nIt lifts.\n")
    assert fetch.run(HOST, str(project)) == ["arm-preview.mp4", "arm-preview.srt"]
    assert "2 films and subtitles came" in capsys.readouterr().out
    assert int(other.counted.read_text()) < 30_000
    assert here(out_root) == there(project)


@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT, None])
def test_a_killed_transfer_goes_on(out_root: Path, project: Path, other: Machine, how: signal.Signals | None) -> None:
    """The line hangs half-way, everything is killed or the line breaks, and the next run brings the rest alone."""
    command = [sys.executable, "-m", "studio.fetch", HOST, "--folder", str(project)]
    environment = os.environ | {"RSYNC_RSH": other.shell(most=LARGE // 2)}
    run = subprocess.Popen(
        command, cwd=ROOT, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    part = out_root / ".fetch" / "leg-preview.mp4"
    end = time.monotonic() + 60
    while (part.stat().st_size if part.is_file() else 0) < LARGE // 4 and time.monotonic() < end:
        assert run.poll() is None, run.communicate()
        time.sleep(0.02)
    time.sleep(0.3)
    if how is None:
        said = run.communicate(timeout=60)[1]
        assert run.returncode == 1
        assert re.search(r"error: fetch: the transfer ended early: .*\. [23]\.\d MB are kept, the same command", said)
    else:
        run.send_signal(how)
        run.communicate(timeout=30)
        assert run.returncode == (-how if how == signal.SIGKILL else 128 + how)
    assert not here(out_root)  # no half film under a name
    kept = part.stat().st_size
    assert LARGE // 4 <= kept <= LARGE // 2

    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    assert re.search(r"fetch: [23]\.\d MB remain from a stopped run", done.stdout)
    assert here(out_root) == there(project)
    assert [path.name for path in out_root.iterdir()] == ["films"]
    # Blocks and what ssh adds; rsync may have written on for a moment before it ended.
    assert abs(int(other.counted.read_text()) - (LARGE - kept)) < 0.03 * LARGE
    end = time.monotonic() + 15
    while (left := working_for(project)) and time.monotonic() < end:
        time.sleep(0.1)
    assert not left


def test_two_at_once_do_not_disturb_each_other(out_root: Path, project: Path) -> None:
    command = [sys.executable, "-m", "studio.fetch", HOST, "--folder", str(project)]
    runs = [subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE) for _ in range(2)]
    assert [run.wait(timeout=60) for run in runs] == [0, 0], [run.communicate() for run in runs]
    assert here(out_root) == there(project)
    assert [path.name for path in out_root.iterdir()] == ["films"]


def test_obstacles_are_reported(out_root: Path, project: Path, other: Machine, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(UserError, match=r"nowhere/out/films does not exist; make fetch HOST=.* FOLDER=<the project's"):
        fetch.run(HOST, str(project / "nowhere"))
    assert [path.name for path in out_root.iterdir()] == ["films"]
    monkeypatch.setenv("RSYNC_RSH", other.shell(port=1))
    with pytest.raises(UserError, match=r"fetch: .*@127\.0\.0\.1 cannot be reached: .*; try ssh "):
        fetch.run(HOST, str(project))
    monkeypatch.setenv("RSYNC_RSH", "no-such-shell -x")
    with pytest.raises(UserError, match="fetch: no-such-shell is not installed here"):
        fetch.run(HOST, str(project))
    monkeypatch.delenv("RSYNC_RSH")
    for name, package in (("rsync", "rsync"), ("ssh", "openssh-client")):
        monkeypatch.setattr(transfer.missing, "program", lambda word, name=name: None if word == name else word)
        with pytest.raises(UserError, match=f"fetch: {name} is not installed here; sudo apt-get install -y {package}"):
            fetch.run(HOST, str(project))
    assert not here(out_root)
    assert [path.name for path in out_root.iterdir()] == ["films"]


def test_the_other_machine_has_no_rsync() -> None:
    result = transfer.Transfer(code=12, said=["bash: line 1: rsync: command not found", "rsync error: ... (code 12)"])
    assert fetch._reason(result, "anna@box", "anna@box:mbsd/out/films", 0).startswith(
        "fetch: rsync is not installed on anna@box"
    )


@pytest.mark.parametrize(
    "host",
    ["", "-oProxyCommand=touch pwned", "a b", "anna@", "anna@-x", "x;touch pwned", "$(touch pwned)", "a:b", "::1"],
)
def test_no_name_of_a_machine(out_root: Path, host: str) -> None:
    with pytest.raises(UserError, match=r"HOST=.* is not user@machine"):
        fetch.run(host)
    assert not out_root.exists()


@pytest.mark.parametrize("folder", ["a b", "$(touch pwned)", "x;y", "`x`", "a\nb", "a'b", "~anna/mbsd", "*"])
def test_no_path(out_root: Path, folder: str) -> None:
    with pytest.raises(UserError, match=r"FOLDER=.* cannot pass through two shells"):
        fetch.run("anna@box", folder)


@pytest.mark.parametrize(
    ("host", "folder", "source"),
    [
        ("anna@box", "", "anna@box:mbsd/out/films"),
        ("box.example.org", "~/code/mbsd/", "box.example.org:code/mbsd/out/films"),
        ("anna@[fe80::1%eth0]", "/srv/mbsd-1.0", "anna@[fe80::1%eth0]:/srv/mbsd-1.0/out/films"),
    ],
)
def test_where_the_films_are(host: str, folder: str, source: str) -> None:
    assert fetch.source_of(host, folder) == source
