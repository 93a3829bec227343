"""The console: plain lines in a log, a bar on a terminal, one sentence for an error."""

from __future__ import annotations

import errno
import io
import os
import pty
import signal
import subprocess
import sys

import pytest

from shared.stage import console
from shared.stage.errors import UserError
from shared.stage.paths import ROOT
from shared.stage.signals import Stopped

NO_MEMORY = (
    "error: the memory ran out; close other programs or take a smaller preset. The same command goes on from here\n"
)


def test_say_and_warn_are_one_plain_line_in_a_log(capsys: pytest.CaptureFixture[str]) -> None:
    console.say("parts", "four_bar: 5 solids, [bold] 0.412 kg")
    console.warn("check", "little room")
    captured = capsys.readouterr()
    assert captured.out == "parts: four_bar: 5 solids, [bold] 0.412 kg\n"
    assert captured.err == "check: warning: little room\n"


def test_progress_in_a_log_tells_count_pace_and_time_left(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    now = [0.0]
    monkeypatch.setattr(console.time, "monotonic", lambda: now[0])
    with console.progress("frames", 20) as bar:
        for frame in range(20):
            now[0] += 2.0
            bar.advance(note=f"frame {frame}")
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "frames: 3/20, 2.00 s a frame, 34 s left (frame 2)"
    assert lines[-1] == "frames: 20/20, 2.00 s a frame, done (frame 19)"
    assert len(lines) == 7  # every third frame, and the last


def test_a_long_run_does_not_flood_its_log(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    now = [0.0]
    monkeypatch.setattr(console.time, "monotonic", lambda: now[0])
    gaps, before = [], 0.0
    with console.progress("frames", 36000) as bar:
        for _ in range(36000):
            now[0] += 1.0
            bar.advance()
            if capsys.readouterr().out:
                gaps.append(now[0] - before)
                before = now[0]
    assert min(gaps[:-1]) == 5.0
    assert max(gaps) == 60.0


def test_progress_that_is_not_finished_says_nothing_false(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(ValueError, match="boom"), console.progress("frames", 3) as bar:
        bar.advance()
        raise ValueError("boom")
    assert "done" not in capsys.readouterr().out


@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        (0.04, "0.0 s"), (9.94, "9.9 s"), (9.96, "10 s"), (59.4, "59 s"), (59.6, "1 min 00 s"), (200, "3 min 20 s"),
        (3599.6, "1 h 00 min"), (7510, "2 h 05 min"), (90000, "25 h 00 min"),
    ],
)  # fmt: skip
def test_durations_read_well(seconds: float, words: str) -> None:
    assert console.duration(seconds) == words


def in_a_terminal(code: str) -> str:
    """Return the output of ``code`` on a terminal of its own."""
    master, slave = pty.openpty()
    environment = {**os.environ, "TERM": "xterm-256color", "COLUMNS": "100", "PYTHONPATH": str(ROOT)}
    process = subprocess.Popen([sys.executable, "-c", code], stdout=slave, stderr=slave, env=environment)
    os.close(slave)
    shown = b""
    while True:
        try:
            block = os.read(master, 65536)
        except OSError:  # Linux reports the closed terminal so
            break
        if not block:
            break
        shown += block
    os.close(master)
    assert process.wait() == 0
    return shown.decode()


def test_a_terminal_gets_colour_and_a_bar() -> None:
    shown = in_a_terminal(
        "from shared.stage.console import say, progress\n"
        "say('parts', 'five [solids]')\n"
        "with progress('frames', 4) as bar:\n"
        "    for _ in range(4): bar.advance(note='x')\n"
    )
    assert "\x1b[" in shown
    assert "five [solids]" in shown
    assert "4/4" in shown
    assert "a frame, done (x)" in shown


@pytest.mark.parametrize(
    ("raised", "code", "said"),
    [
        (UserError("four_bar: no"), 1, "error: four_bar: no\n"),
        (KeyboardInterrupt(), 130, "error: stopped; what is finished is kept, the same command goes on from here\n"),
        (Stopped(15), 143, "error: stopped; what is finished is kept, the same command goes on from here\n"),
        (
            OSError(errno.EROFS, "Read-only file system", "/no/such/x"),
            1,
            "error: cannot use /no/such/x: Read-only file system; make file and folder accessible or set MBSD_OUT to "
            "another folder\n",
        ),
        (MemoryError(), 1, NO_MEMORY),
        (RuntimeError("can't start new thread"), 1, NO_MEMORY),
    ],
)
def test_run_cli_words_what_a_user_can_cause(
    raised: BaseException, code: int, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    def main() -> None:
        raise raised

    with pytest.raises(SystemExit) as exit_:
        console.run_cli(main)
    assert exit_.value.code == code
    assert capsys.readouterr().err == said


@pytest.mark.parametrize(("result", "code"), [(None, 0), (0, 0), (3, 3)])
def test_run_cli_exits_with_the_result(result: int | None, code: int) -> None:
    with pytest.raises(SystemExit) as exit_:
        console.run_cli(lambda: result)
    assert exit_.value.code == code


@pytest.mark.parametrize(
    "fault", [ZeroDivisionError(), RuntimeError("odd"), OSError(errno.ECHILD, "No child processes")], ids=repr
)
def test_run_cli_does_not_hide_a_fault_of_ours(fault: Exception) -> None:
    def main() -> None:
        raise fault

    with pytest.raises(type(fault)):
        console.run_cli(main)


def test_a_second_sigterm_does_not_disturb_the_cleaning_up() -> None:
    code = (
        "import os, time, signal; from shared.stage.console import run_cli\n"
        "def main():\n"
        "    try:\n"
        "        os.kill(os.getpid(), signal.SIGTERM); time.sleep(30)\n"
        "    finally:\n"
        "        os.kill(os.getpid(), signal.SIGHUP); os.kill(os.getpid(), signal.SIGTERM); print('clean')\n"
        "run_cli(main)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=20)
    assert (done.returncode, done.stdout) == (128 + signal.SIGTERM, "clean\n")


def test_a_closed_pipe_is_no_traceback() -> None:
    code = "from shared.stage.console import run_cli, say\n"
    code += "run_cli(lambda: [say('a', 'b' * 100) for _ in range(20000)] and 0)"
    command = f"{sys.executable} -c '{code.replace(chr(39), chr(34))}' | head -1"
    done = subprocess.run(command, shell=True, cwd=ROOT, capture_output=True, text=True)
    assert done.stderr == ""


def test_the_console_and_the_stages_load_nothing_heavy() -> None:
    """Every stage of a run pays for this before it can say that there is nothing to do."""
    code = "import sys, shared.stage.console, shared.stage.stages, shared.contract\n"
    code += "print([m for m in sys.modules if m in heavy])"
    code = code.replace("heavy", "('rich', 'numpy', 'matplotlib', 'bpy', 'cadquery', 'numba')")
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


def test_a_stream_that_is_no_terminal_is_plain() -> None:
    assert not console._is_terminal(io.StringIO())


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP, signal.SIGINT], ids=lambda number: number.name)
def test_a_signal_that_comes_while_c_calls_python_still_ends_the_program(number: int) -> None:
    """As numba's compiler does, in whose callbacks an exception is printed and lost; and at once, though it waits."""
    code = (
        "import ctypes, os, signal, time\n"
        "from shared.stage.console import run_cli\n"
        "def callback():\n"
        f"    os.kill(os.getpid(), {int(number)}); time.sleep(0.1)\n"
        "def main():\n"
        "    signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "    ctypes.CFUNCTYPE(None)(callback)()\n"
        "    print('went on'); time.sleep(50); print('to the end')\n"
        "run_cli(main)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=40)
    assert (done.returncode, done.stdout) == (128 + number, "went on\n")
    assert done.stderr.startswith("error: stopped")
