"""Stands for the interpreter that runs the stages: each notes that it ran, and does what a file of its name says.

``python stand_in.py FOLDER -m mechanisms|render STEP NAME ...``. In the folder a file ``<name>.<step>``
holds words such as ``fail``, ``crash``, ``once crash``, ``busy``, ``sleep 5``, ``wait FILE``, ``hang``; ``ran.txt``
gets a line each time.
"""

from __future__ import annotations

import os
import signal
import sys
import time
from pathlib import Path


def sleep(seconds: float) -> None:
    """Sleep, but end with the night, as every stage does (shared/stage/signals.py)."""
    end, parent = time.monotonic() + seconds, os.getppid()
    while time.monotonic() < end:
        if os.getppid() != parent:
            sys.exit(1)
        time.sleep(0.05)


def main() -> int:
    folder = Path(sys.argv.pop(1))
    step = sys.argv[3]
    if step == "overview":
        print("TABLE", *sys.stdin.read().split("\n"), sep="\n")
        return 0
    name = sys.argv[4]
    with (folder / "ran.txt").open("a") as file:
        file.write(f"{name} {step}\n")
    told = folder / f"{name}.{step}"
    words = told.read_text().split() if told.exists() else []
    if words[:1] == ["once"]:
        told.unlink()
        words = words[1:]
    print(f"{step}: {name}: {' '.join(sys.argv[5:])}", flush=True)
    match words:
        case ["fail"]:
            print(f"error: {name} has a bad link; make it longer", file=sys.stderr)
            return 1
        case ["crash"]:
            os.kill(os.getpid(), signal.SIGSEGV)
        case ["killed"]:
            os.kill(os.getpid(), signal.SIGKILL)
        case ["busy"]:
            print("error: another process renders into a folder", file=sys.stderr)
            return 75
        case ["hang"]:
            signal.signal(signal.SIGTERM, signal.SIG_IGN)
            sleep(600)
        case ["wait", path]:
            while not Path(path).exists():
                time.sleep(0.05)
        case ["sleep", seconds]:
            sleep(float(seconds))
        case _:
            pass
    print(f"{step}: {name}: done", flush=True)
    return 0


sys.exit(main())
