"""The live page goes on when its warm process is killed or stopped, folders move and stages misbehave, and says so."""

from __future__ import annotations

import os
import signal
import sys
import time

import httpx
import psutil
import pytest

from studio.live.processes import stages
from studio.live.processes.pipe import LONGEST
from tests.studio.live.arm import arm
from tests.studio.live.served import Page, Served, live_server

live = live_server("faulty", limit=60.0)


def followed(live: Served, page: Page, length: float) -> None:
    """Save a length and wait until the page shows it."""
    live.write(arm(length))
    page.hear("solved", wanted=lambda header: header["numbers"][0]["value"] == length)
    assert page.hear("motion")["payload"]


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGSTOP])
def test_a_warm_process_hit_at_the_moment_of_a_save(live: Served, number: signal.Signals) -> None:
    warm = live.live.nursery.warm_pid
    with live.page() as page:
        length = 0.3 + number / 1000
        live.write(arm(length))
        os.kill(warm, number)
        assert httpx.get(live.live.address, timeout=10).status_code == 200
        told = page.hear("line")["text"]
        assert "the process from which those of mechanism.py are forked" in told
        assert "it is replaced" in told
        page.hear("solved", wanted=lambda header: header["numbers"][0]["value"] == length)
        followed(live, page, length + 0.0005)
    assert live.live.nursery.warm_pid != warm


def test_a_save_ends_a_fit_and_the_page_hears_of_it(live: Served) -> None:
    with live.page() as page:
        followed(live, page, 0.42)
        page.say(do="fit", point="P", path=[[0.3, 0.1], [0.2, 0.2]], starts=100, generations=50_000)
        page.hear("progress")
        live.write(arm(0.425))
        assert page.hear("fitted")["cancelled"]
        page.hear("motion")
        page.say(do="cancel")
        assert page.hear("fitted")["cancelled"], "a page that waits for nothing is let go"


def test_a_process_stopped_while_it_solves_is_replaced(live: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    with live.page() as page:
        followed(live, page, 0.43)
        ends = time.monotonic() + 60
        # Its numbers are described after the motion, within the old limit.
        while (live.session._good is None or live.session._good.busy) and time.monotonic() < ends:
            time.sleep(0.05)
        assert live.session._good is not None
        monkeypatch.setattr(live.session._good, "_limit", 1.0)
        os.kill(live.session._good.pid, signal.SIGSTOP)
        page.say(do="set", values={"length": 0.44})
        assert "did not end within 1 s" in page.hear("refused")["text"]
        page.hear("motion")


def test_saves_one_upon_the_other_end_with_the_last(live: Served) -> None:
    with live.page() as page:
        for k in range(25):
            live.write(arm(0.5 + k / 1000))
            time.sleep(0.02 * (k % 3))
        page.hear("solved", wanted=lambda header: header["numbers"][0]["value"] == 0.524)
        page.hear("motion")
    ends = time.monotonic() + 60
    mine = psutil.Process(live.live.nursery.warm_pid)
    while len(mine.children()) > 1 and time.monotonic() < ends:
        time.sleep(0.05)
    assert len(mine.children()) == 1, "the keeper of the last good process"


def test_a_file_that_forks_is_answered_once(live: Served) -> None:
    """Both processes go on with the file, but only one of them speaks with the server."""
    with live.page() as page:
        live.write(f"{arm(0.441)}\nimport os\nos.fork()\nprint('said')\n")
        page.hear("motion")
        for length in (0.442, 0.443, 0.444):
            page.say(do="set", values={"length": length})
            assert page.hear("motion", "error", "refused", "line")["values"] == {"length": length}
        followed(live, page, 0.445)


def test_a_folder_that_was_renamed_may_come_back(live: Served) -> None:
    folder, away = live.folder / "arm", live.folder / "away"
    with live.page() as page:
        folder.rename(away)
        assert "arm" in page.hear("error")["text"]
        page.say(do="set", values={"length": 0.45}, final=True)
        page.hear("motion")
        page.say(do="write")
        assert "nothing is written" in page.hear("refused")["text"]
        away.rename(folder)
        page.hear("solved")
        page.hear("motion")
        live.session.history.add({})
        followed(live, page, 0.46)


def test_an_error_of_the_server_does_not_end_following(live: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(parts_ready: bool = False) -> None:
        monkeypatch.undo()
        raise RuntimeError("a fault of ours")

    with live.page() as page:
        monkeypatch.setattr(live.session, "reload", fails)
        live.write(arm(0.47))
        assert "a fault of ours" in page.hear("error")["text"]
        followed(live, page, 0.48)


def test_a_stage_that_prints_without_end_or_cannot_begin_is_done(live: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    """A line of two million characters, without a newline at the end; a child of it that holds its pipe open."""
    prints = "import os, sys, time; print('x' * 200_000); sys.stdout.write('ü' * 2_000_000); sys.stdout.flush()"
    monkeypatch.setattr(live.session, "_wants_parts", True)
    for code, said in (
        (f"{prints}; os.fork() or time.sleep(600); sys.exit(1)", ["x" * LONGEST + " ...", "ü" * LONGEST + " ..."]),
        ("import os; os.kill(os.getpid(), 9)", ["the stage that makes the parts ended with exit code 137"]),
        ("no\0code", ["the parts cannot be made"]),
    ):
        with live.page() as page:
            page.hear("state")
            monkeypatch.setattr(stages, "COMMAND", [sys.executable, "-c", code])
            live.write(f"# {code!r}\n", "parts.py")
            heard = [page.hear("line")["text"] for _ in said]
            assert all(text.startswith(begin) for text, begin in zip(heard, said, strict=True))
            assert all(len(text) < LONGEST + 60 for text in heard)
            assert page.hear("parts", wanted=lambda header: header["state"] != "making")["state"] == "failed"
