"""A study over Dask gives the table of a local one; workers that do not fit are refused by name."""

from __future__ import annotations

import os
import signal
import sys
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import dask.config
import distributed
import pytest
from pandas.testing import assert_frame_equal

import mbsd
from mbsd import Mechanism, ModelError
from mbsd.studies import orders

LENGTHS = {"length": [0.1, 0.2, 0.3, -0.1, 0.5, 0.6]}
QUIET = {"progress": False, "folder": None}


def build(length: float) -> Mechanism:
    m = Mechanism("pendulum")
    bar = m.bar("bar", length, mass=1.0)
    m.revolute("O", m.ground.at(0, 0), bar.start)
    m.start_near(bar=30)
    return m


def fastest(m: Mechanism) -> dict[str, float]:
    return {"fastest": float(m.simulate(0.5, steps=20).body("bar").omega.max())}


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    """Two workers, processes of their own on loopback."""
    settings = {"distributed.scheduler.allowed-failures": 0, "distributed.worker.daemon": True}
    with (
        dask.config.set(settings),
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        yield client


def test_the_table_is_that_of_a_local_study(client: Any) -> None:
    alone = mbsd.study(build, LENGTHS, fastest, processes=1, **QUIET)
    assert list(alone["reason"].notna()).count(True) == 1
    assert_frame_equal(mbsd.study(build, LENGTHS, fastest, client, **QUIET), alone)
    assert_frame_equal(mbsd.study(build, LENGTHS, fastest, client.scheduler.address, **QUIET), alone)


def test_files_that_workers_read_and_import_decide_which_points_are_known(
    client: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Workers live on: what they have imported for one call is not what the next one means."""
    data, helper = tmp_path / "data.txt", tmp_path / "helper_of_workers.py"
    monkeypatch.setattr(sys, "dont_write_bytecode", True)

    def measure(m: Mechanism) -> dict[str, float]:
        sys.dont_write_bytecode = True
        if str(tmp_path) not in sys.path:
            sys.path.insert(0, str(tmp_path))
        import helper_of_workers  # pyright: ignore[reportMissingImports]

        return {"y": float(data.read_text()) * helper_of_workers.K}

    def measured() -> list[float]:
        lengths = {"length": [0.1, 0.2]}
        return list(mbsd.study(build, lengths, measure, client, progress=False, folder=tmp_path / "kept")["y"])

    for text, k, y in (("2.0", 1.0, 2.0), ("3.0", 1.0, 3.0), ("3.0", 7.0, 21.0)):
        data.write_text(text)
        helper.write_text(f"K = {k}\n")
        assert measured() == [y, y]
        kept = sorted((tmp_path / "kept").rglob("*.jsonl"))
        assert measured() == [y, y]
        assert sorted((tmp_path / "kept").rglob("*.jsonl")) == kept


@pytest.mark.filterwarnings("ignore:study.*one is given")
def test_a_point_that_ends_workers_is_told(client: Any) -> None:
    def deadly(m: Mechanism) -> dict[str, float]:
        if m.bodies["bar"].length == 0.3:
            os.kill(os.getpid(), signal.SIGKILL)
        return {"mass": m.bodies["bar"].mass}  # no kernel is loaded in the workers that come after

    table = mbsd.study(build, LENGTHS, deadly, client, **QUIET)
    assert list(table["reason"].notna()).count(True) == 2
    assert table["reason"][2].startswith("its process was ended")


def test_workers_with_other_versions_are_refused_by_name(client: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    ours = orders.identity() | {"numpy": "1.0"}
    monkeypatch.setattr(orders, "identity", lambda: ours)
    with (
        warnings.catch_warnings(),
        pytest.raises(ModelError, match=r"; tcp://[\d.:]+.*: numpy .*, here 1.0; start workers"),
    ):
        warnings.simplefilter("ignore")
        mbsd.study(build, LENGTHS, fastest, client, **QUIET)
