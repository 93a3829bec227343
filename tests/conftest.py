"""Fixtures for every test file, and plugins that order and report the tests (tests/running/)."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import settings

from tests.running.needs import Needs
from tests.running.order import Order, Recording
from tests.running.shown import Failures
from tests.running.warm import Warm

settings.register_profile("local", deadline=None)
settings.register_profile("ci", deadline=None, derandomize=True, print_blob=True)
settings.load_profile("ci" if os.environ.get("CI") else "local")

# Each process of tests works on one core, as those of a study do: with two threads each, two on two cores wait for each
# other in every solution of some hundred equations. Set before any test loads numpy, and for all that tests start.
for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")

# What a shell starts in the background, or nohup, ignores these, and so would all that the tests start and interrupt.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
if signal.getsignal(signal.SIGHUP) is signal.SIG_IGN:
    signal.signal(signal.SIGHUP, signal.SIG_DFL)


def pytest_addoption(parser: pytest.Parser) -> None:
    """A word of make test PYTEST="..."."""
    parser.addoption("--record-seconds", action="store_true", help="write how long each group of tests takes")


def pytest_configure(config: pytest.Config) -> None:
    """Register what orders, skips and shows. Raises pytest.UsageError where a program is missing and none may be."""
    plugins = config.pluginmanager
    plugins.register(Needs())
    plugins.register(Order())
    if hasattr(config, "workerinput"):  # a process of xdist, whose results the first process shows
        return
    if plugins.hasplugin("xdist"):  # where one process ends, those left do the rest: a new one would wait for ever
        config.option.maxworkerrestart = "0"
    plugins.register(Failures(config))
    if config.getoption("--record-seconds"):
        plugins.register(Recording())


@pytest.fixture
def out_root(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder for results, in this process and in the ones it starts."""
    folder = tmp_path / "out"
    monkeypatch.setenv("MBSD_OUT", str(folder))
    return folder


@pytest.fixture(scope="session")
def warm() -> Iterator[Warm]:
    """Yield a runner of commands in processes that need not load the libraries."""
    process = Warm()
    yield process
    process.close()
