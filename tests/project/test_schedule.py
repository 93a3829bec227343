"""How tests are spread over processes: a file is a group, so is a folder of mechanisms/; quick ones come first."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

from shared.stage.paths import ROOT, planar_names
from tests.mechanisms.test_mechanisms import SLOW
from tests.running import order
from tests.running.order import group_of, place_of
from tests.running.samples import SAMPLES

TESTS = ROOT / "tests"


class _Seen:
    """Plugin that keeps all collected tests."""

    items: list[pytest.Item]

    def pytest_collection_finish(self, session: pytest.Session) -> None:
        self.items = list(session.items)


def test_files_that_are_not_known_to_be_long_come_before_every_folder_and_no_group_is_torn(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    seen = _Seen()
    long = {group: seconds for group, seconds in order.recorded().items() if order.FOLDERS in group}
    monkeypatch.setattr(order, "recorded", lambda: long)
    files = [
        str(TESTS / name)
        for name in ("mechanisms/test_mechanisms.py", "project/test_rooms.py", "project/test_schedule.py")
    ]
    pytest.main(["--collect-only", "-q", "-p", "no:cacheprovider", *files], plugins=[seen])
    groups = list(dict.fromkeys(group_of(item.nodeid) for item in seen.items))
    folders = {f"tests/mechanisms/test_mechanisms.py[{name}]" for name in planar_names()}
    assert groups[:2] == ["tests/project/test_rooms.py", "tests/project/test_schedule.py"]
    assert set(groups[2:]) == {*folders, "tests/mechanisms/test_mechanisms.py"}, "a file's other tests are one group"
    assert len(groups) == 3 + len(folders), "no group is torn apart"


def test_quick_groups_keep_their_order_and_long_ones_are_longest_first() -> None:
    seconds = {"a.py": 5.0, "b.py": 90.0, "c.py": 20.0}
    groups = ["a.py", "x.py", "b.py", "y.py", "c.py", "test_mechanisms.py[new]"]
    ordered = sorted(groups, key=lambda group: place_of(group, seconds))
    assert ordered == ["x.py", "y.py", "b.py", "c.py", "test_mechanisms.py[new]", "a.py"]


def test_the_recorded_groups_exist_and_are_long() -> None:
    for group, seconds in order.recorded().items():
        assert (ROOT / group.partition("[")[0]).is_file(), f"{group} is gone; take it out of tests/running/seconds.json"
        assert "[" not in group or group.partition("[")[2].rstrip("]") in planar_names(), group
        assert seconds >= order.LONG


@pytest.mark.parametrize("test", SAMPLES)
def test_tests_sampled_by_make_test_exist(test: str) -> None:
    file, _, name = test.partition("::")
    assert re.search(rf"^def {name}\b", (ROOT / file).read_text(), re.M), (
        f"{test} is gone; mend tests/running/samples.py"
    )


def test_seconds_of_long_groups_are_recorded(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(order, "SECONDS", tmp_path / "seconds.json")
    order.SECONDS.write_text(json.dumps({"tests/old.py": 50.0, "tests/a.py": 9.0}))
    recording = order.Recording()
    for nodeid, duration in (("tests/a.py::x", 20.0), ("tests/a.py::y", 10.04), ("tests/b.py::x", 1.0)):
        report = pytest.TestReport(nodeid, ("", 0, ""), {}, "passed", None, "call", duration=duration)
        recording.pytest_runtest_logreport(report)
    recording.pytest_sessionfinish()
    assert json.loads(order.SECONDS.read_text()) == {"tests/old.py": 50.0, "tests/a.py": 30.0}


def test_fast_are_quick_files_of_rooms_that_start_no_program() -> None:
    seconds = {"tests/dynamics/test_long.py": 5.0}
    assert order.is_fast("tests/dynamics/test_new.py::test_a[1]", seconds)
    assert not order.is_fast("tests/dynamics/test_long.py::test_a", seconds)
    assert not order.is_fast("tests/render/test_plots.py::test_a", seconds)
    assert not order.is_fast("tests/mechanisms/test_mechanisms.py::test_a[four_bar]", seconds)


def test_slow_folders_exist_and_each_target_has_its_tests() -> None:
    """`make test` and `make test-slow`, which choose by one mark, together run every test once."""
    assert set(planar_names()) > SLOW
    seen = _Seen()
    files = [str(TESTS / "mechanisms" / "test_mechanisms.py"), str(TESTS / "project" / "test_rooms.py")]
    pytest.main(["--collect-only", "-q", "-p", "no:cacheprovider", *files], plugins=[seen])
    marked = {mark: [item for item in seen.items if item.get_closest_marker(mark)] for mark in ("slow", "fast")}
    assert {group_of(item.nodeid).partition("[")[2].rstrip("]") for item in marked["slow"]} == SLOW
    assert {group_of(item.nodeid) for item in marked["fast"]} == {"tests/project/test_rooms.py"}
    assert not set(map(id, marked["fast"])) & set(map(id, marked["slow"]))


SHARED = """
import pytest, time
@pytest.fixture(scope="module", params="abcd")
def made(request):
    return request.param
def test_one(made):
    time.sleep(0.1)
def test_two(made):
    time.sleep(0.1)
def test_three(made):
    time.sleep(0.1)
"""


def test_a_folder_is_made_in_one_process_and_folders_in_both(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """By the words that make gives pytest."""
    (tmp_path / "test_mechanisms.py").write_text(SHARED)
    (tmp_path / "conftest.py").write_text((TESTS / "conftest.py").read_text())
    monkeypatch.setenv("PYTHONPATH", str(ROOT))
    given = re.search(r"^PYTEST \?= (.*)$", (ROOT / "Makefile").read_text(), flags=re.MULTILINE)
    assert given is not None
    command = [sys.executable, "-m", "pytest", "-v", "-p", "no:cacheprovider", *given[1].split(), str(tmp_path)]
    told = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False).stdout
    where: dict[str, set[str]] = {}
    for process, folder in re.findall(r"\[(gw\d)\].*PASSED.*\[(\w)\]", told):
        where.setdefault(folder, set()).add(process)
    assert sorted(where) == ["a", "b", "c", "d"], told
    assert all(len(processes) == 1 for processes in where.values()), told
    assert len(set.union(*where.values())) == 2, told
