"""The curves that are shown as CSV: saved by the key and by the button, whole and with the numbers of data.json."""

from __future__ import annotations

import csv
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from shared.contract import Motion
from tools.browsers.browser import APP, FRAME, Browser, box, click, press

SECONDS = 20


def tabled(browser: Browser, motion: Motion) -> Iterator[str]:
    """Yield what is wrong with the files that are saved."""
    joint = next(name for name in motion.joints if motion.joints[name].kind == "revolute")
    browser.ask(f"{APP}.store.set({{playing: false, selected: {{kind: 'joint', name: '{joint}'}}}})")
    browser.ask(FRAME)
    button = box(browser, ".choose button")
    ways = {
        "the key s": press("s"),
        "the button": click(button["left"] + button["width"] / 2, button["top"] + button["height"] / 2),
    }
    for way, actions in ways.items():
        for old in browser.saved().iterdir():
            old.unlink()  # some browsers write over what has the name, others find another name
        browser.act(actions)
        file = _new(browser.saved())
        if file is None:
            yield f"{way} saves no file"
            continue
        if not file.name.startswith(f"{motion.mechanism}-{joint}") or file.suffix != ".csv":
            yield f"{way} saves {file.name}"
        yield from (f"{way}: {fault}" for fault in _faults(file, motion, joint))


def _new(folder: Path) -> Path | None:
    end = time.monotonic() + SECONDS
    while time.monotonic() < end:
        there = list(folder.iterdir())
        if len(there) == 1 and there[0].suffix == ".csv" and there[0].stat().st_size:  # on its way it has another name
            return there[0]
        time.sleep(0.1)
    return None


def _faults(file: Path, motion: Motion, joint: str) -> Iterator[str]:
    with file.open(newline="", encoding="utf-8") as stream:
        head, *rows = csv.reader(stream)
    numbers = np.array(rows, float)
    if head[0] != "time [s]" or numbers.shape != (len(motion.time), len(head)):
        yield f"{file.name} has {numbers.shape} numbers under {head}"
        return
    if not np.allclose(numbers[:, 0], motion.time, rtol=0, atol=1e-12):
        yield f"{file.name} has other times than data.json"
    wanted = {f"joint {joint} Reaction {axis} [N]": getattr(motion.joints[joint], f"f{axis}") for axis in "xy"}
    for name, values in wanted.items():
        if name not in head:
            yield f"{file.name} has no {name}, but {', '.join(head)}"
            continue
        top = float(np.abs(values).max())
        if not np.allclose(numbers[:, head.index(name)], values, rtol=1e-6, atol=1e-6 * top):
            yield f"{file.name} has other numbers than data.json under {name}"
