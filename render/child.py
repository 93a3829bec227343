"""Runs the Blender process and relays its answers. However this ends, no process and no temporary folder stays."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import msgspec

from render.blender.job import Answer, Job
from shared.errors import UserError
from shared.paths import ROOT, out_root, refuse_links
from shared.signals import terminable


@contextmanager
def blender(job: Job) -> Iterator[Iterator[Answer]]:
    """Start the job in a process of its own; yields its answers as they come.

    The process is stopped when the block ends, also by Ctrl-C or SIGTERM. Raises UserError with what the process
    said last if it failed.
    """
    home = out_root() / ".blender"
    scratch = home / f"tmp-{os.getpid()}"
    for folder in (home / "user", home / "cache", scratch):
        refuse_links(folder)
    _sweep(home)
    scratch.mkdir(parents=True, exist_ok=True)
    process: subprocess.Popen[bytes] | None = None
    try:
        with terminable(), tempfile.TemporaryFile(dir=scratch) as chat:
            paper = scratch / "job.json"
            paper.write_bytes(msgspec.json.encode(job))
            process = subprocess.Popen(
                [sys.executable, "-m", "render.blender.worker", str(paper)],
                cwd=ROOT,
                env=_environment(home, scratch),
                stdin=subprocess.PIPE,  # closes with us, which ends the worker even if we are killed
                stdout=subprocess.PIPE,
                stderr=chat,
                start_new_session=True,  # Ctrl-C on the terminal reaches us alone
            )
            yield _answers(process, chat)
    finally:
        if process is not None:
            process.kill()
            process.wait()
            for pipe in (process.stdin, process.stdout):
                if pipe:
                    pipe.close()
        shutil.rmtree(scratch, ignore_errors=True)


def _answers(process: subprocess.Popen[bytes], chat: object) -> Iterator[Answer]:
    assert process.stdout is not None
    for line in process.stdout:
        answer = msgspec.json.decode(line, type=Answer)
        if answer.error:
            raise UserError(answer.error)
        yield answer
    code = process.wait()
    if code:
        chat.seek(0)  # type: ignore[attr-defined]
        said = chat.read().decode(errors="replace").strip().splitlines()  # type: ignore[attr-defined]
        reason = f"signal {signal.Signals(-code).name}" if code < 0 else f"code {code}"
        if code == -signal.SIGKILL:
            reason += " (often: out of memory)"
        raise UserError(f"Blender stopped with {reason}: {said[-1] if said else 'it said nothing'}")


def _environment(home: Path, scratch: Path) -> dict[str, str]:
    """Everything Blender writes for itself goes below ``out``, nothing into the home folder."""
    return dict(
        os.environ,
        BLENDER_USER_RESOURCES=str(home / "user"),
        XDG_CACHE_HOME=str(home / "cache"),
        TMPDIR=str(scratch),
        PYTHONPATH=os.pathsep.join(filter(None, [str(ROOT), os.environ.get("PYTHONPATH", "")])),
    )


def _sweep(home: Path) -> None:
    """Remove what a process left that was killed without a chance to clean up."""
    for folder in home.glob("tmp-*"):
        owner = folder.name.removeprefix("tmp-")
        if owner.isdigit() and not _is_running(int(owner)):
            shutil.rmtree(folder, ignore_errors=True)


def _is_running(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True
