"""Messages of a stage: in colour and with a progress bar on a terminal, else as plain lines."""

from __future__ import annotations

import os
import signal
import sys
import time
import traceback
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from importlib.util import find_spec
from pathlib import Path
from typing import IO, NoReturn, Protocol

from shared.stage import signals
from shared.stage.errors import UserError
from shared.stage.face import to_run
from shared.stage.files import OF_THE_DISK, refusal
from shared.stage.paths import out_root
from shared.stage.signals import Stopped, terminable
from shared.system.home import without_home
from shared.system.missing import missing_libraries, sentence

SHORTEST, LONGEST = 5.0, 60.0
"""Seconds between two lines of progress in a log; the gap grows with the time that has passed."""
FEW = 3
"""After so few nobody knows how long the rest takes."""
HOME = ".home"
"""Folder of the results that stands in for a home folder that takes no files."""
RED, YELLOW, CYAN = "31", "33", "36"


class Progress(Protocol):
    """Progress that :func:`progress` yields."""

    def advance(self, n: int = 1, note: str = "") -> None:
        """Count ``n`` more units as done; ``note`` is a word on the newest one."""
        ...


def say(stage: str, text: str) -> None:
    """Print one line, ``stage: text``."""
    _line(stage, text, CYAN, sys.stdout)


def warn(stage: str, text: str) -> None:
    """Print one line of warning on stderr."""
    _line(stage, f"warning: {text}", YELLOW, sys.stderr)


def fail(text: str) -> None:
    """Print one line ``error: text`` on stderr."""
    _line("error", text, RED, sys.stderr)


def markdown_table(head: Sequence[str], rows: Iterable[Sequence[str]], numbers: Collection[int] = ()) -> list[str]:
    """Return the lines of a table in Markdown; columns ``numbers`` are set to the right."""
    marks = ["--:" if k in numbers else "---" for k in range(len(head))]
    return [f"| {' | '.join(head)} |", f"|{'|'.join(marks)}|", *(f"| {' | '.join(row)} |" for row in rows)]


@contextmanager
def progress(label: str, total: int, unit: str = "frame") -> Iterator[Progress]:
    """Show how much of ``total`` is done, the seconds a unit and the time left, while the block runs."""
    if not _is_terminal(sys.stdout):
        yield _PlainProgress(label, total, unit)
        return
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn
    from rich.progress import Progress as RichBar

    columns = (
        TextColumn("[bold cyan]{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn("{task.fields[pace]}"),
    )
    with RichBar(*columns) as bar:
        task = bar.add_task(label, total=total, pace="")

        def show(count: int, pace: str) -> None:
            bar.update(task, completed=count, pace=pace)

        yield _TerminalProgress(total, unit, show)


class Shown:
    """Slow work, shown in a line now and then with the time left; quick work prints nothing."""

    def __init__(self, stage: str, name: str, total: int, unit: str) -> None:
        self.stage, self.name, self.total, self.unit = stage, name, total, unit
        self.count, self.began = 0, time.monotonic()
        self._last = self.began

    def advance(self, note: str = "") -> None:
        """Count one more as done; ``note`` is a word on it."""
        self.count += 1
        now = time.monotonic()
        gone = now - self.began
        if now - self._last < min(max(SHORTEST, 0.1 * gone), LONGEST):
            return
        self._last = now
        pace = gone / self.count
        left = f", about {duration(pace * (self.total - self.count))} left" if self.total and self.count > FEW else ""
        of = f" of {self.total}" if self.total else ""
        words = f" ({note})" if note else ""
        say(self.stage, f"{self.name}: {self.count}{of} {self.unit}, {duration(gone)} so far{left}{words}")


def duration(seconds: float) -> str:
    """Return a time in words: ``0.4 s``, ``12 s``, ``3 min 20 s``, ``2 h 05 min``."""
    if seconds < 9.95:
        return f"{seconds:.1f} s"
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60:02d} s"
    minutes = round(seconds / 60)
    return f"{minutes // 60} h {minutes % 60:02d} min"


def run_cli(main: Callable[[], int | None]) -> NoReturn:
    """Run ``main`` and exit with its code.

    The code is 0 or its return value, 1 on a UserError (one sentence), 75 if another process has the files, 128 +
    number on a signal.

    A disk that is full or read-only, a folder or file that is not what it should be, and a library of the system that
    is missing are a sentence as well.
    With ``MBSD_TRACEBACK=1`` in the environment a UserError also prints its traceback, and that of its cause.
    """
    try:
        with terminable():
            signals.end_with_make()
            without_home(Path(os.path.abspath(out_root())) / HOME)
            code = main() or 0
            sys.stdout.flush()
    except UserError as error:
        if os.environ.get("MBSD_TRACEBACK", "0") not in ("", "0"):
            traceback.print_exc()
        fail(str(error))
        code = error.code
    except (KeyboardInterrupt, Stopped) as stop:
        with suppress(OSError):  # the terminal may be what has gone
            fail(f"stopped{_reason(stop)}; what is finished is kept, the same command goes on from here")
        code = stop.code if isinstance(stop, Stopped) else 130
    except (MemoryError, RuntimeError) as error:
        if isinstance(error, RuntimeError) and "start new thread" not in str(error):
            raise
        fail("the memory ran out; close other programs or take a smaller preset. The same command goes on from here")
        code = 1
    except ImportError as error:
        libraries = missing_libraries()
        words = f"{sentence(libraries)} ({error})" if libraries else _missing_package(error)
        if not words:
            raise
        fail(words)
        code = 1
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        code = 1
    except OSError as error:
        if error.errno not in OF_THE_DISK:
            raise
        fail(refusal(error.filename or "a file", error, "use"))
        code = 1
    sys.exit(code)


def _missing_package(error: ImportError) -> str:
    """Return a sentence on a package that is not installed; empty for another error."""
    package = (error.name or "").partition(".")[0]
    if not package or find_spec(package) is not None:
        return ""
    if package == "bpy":
        python = f"{sys.version_info[0]}.{sys.version_info[1]}"
        return (
            "pictures and films need Blender's package bpy, which exists for Python 3.13 alone; this is Python "
            f"{python}. Install mbsd there: uv tool install --python 3.13 'mbsd[studio]'"
        )
    return f"this needs the package '{package}', which is not installed: pip install 'mbsd[studio]'"


def _reason(stop: BaseException) -> str:
    """Return the reason of a signal, as far as this process knows."""
    if signals.ended:
        return ", because the command that started this stage has ended"
    if isinstance(stop, Stopped) and stop.code == 128 + signal.SIGHUP:
        return f", because its terminal was closed ({to_run('overnight')} works without one)"
    return ""


class _Pace:
    """Pace of a progress: counted units in words, ``8.3 s a frame, 6 min 38 s left``."""

    def __init__(self, total: int, unit: str) -> None:
        self.total = total
        self.unit = unit
        self.count = 0
        self.started = time.monotonic()

    def words(self, note: str) -> str:
        each = (time.monotonic() - self.started) / max(self.count, 1)
        each_words = f"{each:.2f} s" if each < 9.95 else duration(each)
        left = max(self.total - self.count, 0) * each
        words = f"{each_words} a {self.unit}, " + (f"{duration(left)} left" if self.count < self.total else "done")
        return f"{words} ({note})" if note else words


class _PlainProgress(_Pace):
    """Line now and then, fit for a log; the last unit always gets one."""

    def __init__(self, label: str, total: int, unit: str) -> None:
        super().__init__(total, unit)
        self.label = label
        self.last_line = self.started

    def advance(self, n: int = 1, note: str = "") -> None:
        self.count += n
        now = time.monotonic()
        gap = min(max(SHORTEST, 0.05 * (now - self.started)), LONGEST)
        if self.count >= self.total or now - self.last_line >= gap:
            self.last_line = now
            say(self.label, f"{self.count}/{self.total}, {self.words(note)}")


class _TerminalProgress(_Pace):
    """Progress bar with count and pace."""

    def __init__(self, total: int, unit: str, show: Callable[[int, str], None]) -> None:
        super().__init__(total, unit)
        self.show = show

    def advance(self, n: int = 1, note: str = "") -> None:
        self.count += n
        self.show(self.count, self.words(note))


def _is_terminal(stream: IO[str]) -> bool:
    return stream.isatty() and os.environ.get("TERM") != "dumb"


def _line(stage: str, text: str, colour: str, stream: IO[str]) -> None:
    """Print one line; without rich, whose loading would double the start of an idle stage."""
    if _is_terminal(stream) and not os.environ.get("NO_COLOR"):
        stage = f"\x1b[1;{colour}m{stage}\x1b[0m"
    print(f"{stage}: {text}", file=stream, flush=True)
