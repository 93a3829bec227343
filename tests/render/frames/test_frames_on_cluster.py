"""A film by a scheduler and three workers on loopback, some of which are killed: all frames, none different."""

from __future__ import annotations

import os
import random
import signal
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import dask.config
import distributed
import pytest

from mbsd.dealing import hand
from render.frames import frames
from render.frames.store import FrameIndex, FrameStore
from render.presets import Preset
from shared.contract.shot import Shot
from shared.stage import jsonfile
from tools.fixtures import film_fixture

SMALL = Preset("small", 320, 180, 8)
"""Large enough for frames to be put together from plates, one of each worker."""
FRAMES = 16


@pytest.fixture
def cluster(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """A scheduler and three workers, each a process with a nanny that starts it again."""
    monkeypatch.setenv("MBSD_OUT", str(tmp_path / "workers"))
    monkeypatch.setattr(hand, "REST", 0.1)
    with (
        dask.config.set({"distributed.client.scheduler-info-interval": "200ms"}),
        distributed.LocalCluster(n_workers=3, threads_per_worker=1, dashboard_address=None) as cluster,
    ):
        yield cluster


def pictures(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.glob("*.png")}


def test_killed_workers_lose_no_frame_and_change_none(
    cluster: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    shot = Shot(fps=FRAMES, turns=1, seconds_per_turn=1.0)
    monkeypatch.setenv("MBSD_OUT", str(tmp_path / "far"))
    far = film_fixture.write(shot)
    monkeypatch.setenv("CLUSTER", cluster.scheduler_address)
    store = FrameStore(far.frames(SMALL.name))
    ended: list[int] = []

    def kill() -> None:
        """One worker as soon as two frames are there."""
        while len(list(store.folder.glob("*.png"))) < 2:
            time.sleep(0.05)
        worker = random.Random(3).choice(list(cluster.workers.values()))
        os.kill(worker.pid, signal.SIGKILL)
        ended.append(worker.pid)

    killer = threading.Thread(target=kill)
    killer.start()
    frames.run("four_bar", SMALL)
    killer.join()
    assert len(ended) == 1
    assert "frames: four_bar: made by " in capsys.readouterr().out

    monkeypatch.setenv("MBSD_OUT", str(tmp_path / "near"))
    monkeypatch.setenv("CLUSTER", "")
    near = film_fixture.write(shot)
    frames.run("four_bar", SMALL)
    here = pictures(near.frames(SMALL.name))
    assert len(here) >= FRAMES - 1
    assert pictures(store.folder) == here
    index = jsonfile.read(store.index, FrameIndex)
    assert index == jsonfile.read(FrameStore(near.frames(SMALL.name)).index, FrameIndex)
    assert not list((tmp_path / "workers").glob(".cluster/**/*.png"))
