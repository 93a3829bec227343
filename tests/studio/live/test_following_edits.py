"""The server follows the editor: eighty edits, half of them broken, and none brings it down."""

from __future__ import annotations

import os
import random
import time
from pathlib import Path

import psutil
import pytest

from tests.studio.live.arm import arm
from tests.studio.live.served import Served, live_server

LIMIT = 15.0
"""Seconds; on a busy machine a good edit takes some."""
BROKEN = {
    "syntax": lambda text, k: text.replace("def build(", "def build(((", 1),
    "nan": lambda text, k: text.replace("length: float = 0.", 'length: float = float("nan") + 0.', 1),
    "name": lambda text, k: text.replace("p.length", f"p.lenght{k}", 1),
    "import": lambda text, k: f"import no_such_module_{k}\n{text}",
    "negative": lambda text, k: text.replace("p.length", "-p.length", 1),
    "returns": lambda text, k: text.replace("    return m\n", f"    return {k}\n"),
    "raises": lambda text, k: text.replace("    return m\n", f"    raise RuntimeError('number {k}')\n"),
    "exit": lambda text, k: f"{text}\nraise SystemExit({k % 250})\n",
    "dies": lambda text, k: f"import os\n{text}\nos._exit({k % 250})\n",
    "signal": lambda text, k: f"import os\n{text}\nos.kill(os.getpid(), 11)  # {k}\n",
    "bytes": lambda text, k: f"{text}\nx = '\x00 {k}'\n",
    "undriven": lambda text, k: text.replace("    m.drive_angle", f"    {k} or m.drive_angle", 1),
    "empty": lambda text, k: "" if k % 2 else f"# {k}\n",
    "recursion": lambda text, k: f"{text}\n\ndef f():\n    return f() + {k}\n\n\nf()\n",
    "pipes": lambda text, k: f"import os\n{text}\nos.closerange(3, 256)  # {k}\n",
}
"""Edits that cannot be solved; ``k`` makes each another file."""


live = live_server("edited", limit=LIMIT)


def test_eighty_edits_half_of_them_broken(live: Served) -> None:
    chosen = random.Random(20)
    process = psutil.Process()
    used: list[int] = []
    children: list[int] = []
    with live.page() as page:
        page.hear("motion", "state", wanted=lambda header: bool(header["payload"]))
        for k in range(80):
            length = 0.1 + k / 1000
            if k % 2:
                kind = chosen.choice(sorted(BROKEN))
                live.write(BROKEN[kind](arm(length), k))
                error = page.hear("error")["text"]
                assert error, kind
                assert live.session.board.payload, "the last good motion is still there"
            else:
                live.write(arm(length))
                solved = page.hear(
                    "solved", wanted=lambda header, length=length: header["numbers"][0]["value"] == length
                )
                assert solved["numbers"][1]["name"] == "speed"
                assert page.hear("motion")["payload"]
                assert live.session.board.error is None
            if k in (40, 79):
                used.append(process.memory_info().rss)
                children.append(len(process.children(recursive=True)))
    assert used[1] - used[0] < 24e6, "memory is flat"
    assert children[1] <= children[0] + 2, "no process is left behind"  # a killed one and its keeper may just be ending


def test_endless_loops_are_ended_and_newer_edits_do_not_wait(live: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    with live.page() as page:
        live.write(f"{arm(0.31)}\nwhile True:\n    pass\n")
        page.hear("solving")
        live.write(arm(0.32))
        page.hear("solved", wanted=lambda header: header["numbers"][0]["value"] == 0.32)
        page.hear("motion")
        monkeypatch.setattr(live.live.nursery, "limit", 2.0)
        live.write(f"{arm(0.33)}\nimport time\nwhile True:\n    time.sleep(1)\n")
        began = time.monotonic()
        assert "did not end within 2 s" in page.hear("error")["text"]
        assert time.monotonic() - began < 10 * LIMIT
        assert live.session.board.payload


def test_a_file_that_is_gone_is_told_and_may_come_back(live: Served) -> None:
    file = live.folder / "arm" / "mechanism.py"
    with live.page() as page:
        live.write(arm(0.34))
        page.hear("motion")
        file.unlink()
        assert "arm" in page.hear("error")["text"]
        live.write(arm(0.35))
        page.hear("solved", wanted=lambda header: header["numbers"][0]["value"] == 0.35)


def test_imported_files_are_followed_and_a_touch_is_no_edit(live: Served, tmp_path: Path) -> None:
    helper = live.folder / "arm" / "sizes.py"
    helper.write_text("LENGTH = 0.4\n")
    text = arm(0.36).replace("from mbsd", "from mechanisms.arm.sizes import LENGTH\n\nfrom mbsd", 1)
    data = tmp_path / "length.txt"
    data.write_text("0.5")
    text = text.replace("0.36 ", f"LENGTH + float(open({str(data)!r}).read()) ", 1)
    with live.page() as page:
        live.write(text)
        page.hear("solved", wanted=lambda header: header["numbers"][0]["value"] == 0.9)
        helper.write_text("LENGTH = 0.6\n")
        page.hear("solved", wanted=lambda header: header["numbers"][0]["value"] == 1.1)
        data.write_text("0.2")
        page.hear("solved", wanted=lambda header: header["numbers"][0]["value"] == pytest.approx(0.8))
        page.hear("motion")
        os.utime(helper)
        live.write(text)
        with pytest.raises(TimeoutError):
            page._socket.recv(timeout=0.6)


def test_prints_and_warnings_reach_the_page(live: Served) -> None:
    with live.page() as page:
        live.write(f"{arm(0.37)}\nprint('said by the file')\n")
        assert page.hear("line")["text"] == "said by the file"
        page.hear("motion")
    with live.page() as later:
        state = later.hear("state")
        assert "said by the file" in state["lines"]
        assert state["payload"]
        assert state["error"] is None
