"""Stands for the Blender process, for tests of what starts it: each picture's name says what becomes of it."""

from __future__ import annotations

import os
import signal
import sys
import time
from pathlib import Path

import msgspec

from render.blender.job import Answer, Job


def say(**fields: object) -> None:
    print(msgspec.json.encode(Answer(**fields)).decode(), flush=True)


job = msgspec.json.decode(Path(sys.argv[1]).read_bytes(), type=Job)
print("Warning: a texture is odd", file=sys.stderr, flush=True)
say(device="CPU")
for picture in job.pictures:
    say(doing=f"renders {picture.name}: Sample 1/8")
    mark = Path(picture.folder) / picture.key
    act, first = picture.name, not mark.exists()
    mark.touch()
    if act == "stops" or (act == "stops once" and first):
        os.kill(os.getpid(), signal.SIGSTOP)
    elif act == "sleeps":
        time.sleep(60)
    elif act.startswith("SIG") and (first or not act.endswith(" once")):
        os.kill(os.getpid(), signal.Signals[act.removesuffix(" once")])
    elif act == "grows":
        kept = b"x" * 400_000_000
    elif act == "fails":
        sys.exit("RuntimeError: no such node")
    elif act == "is cut":
        os.write(1, b'{"path": "half a li')
        os.kill(os.getpid(), signal.SIGKILL)
    say(path=str(mark), key=picture.key, cycles=0.01)
    if act == "does not end":
        time.sleep(60)
