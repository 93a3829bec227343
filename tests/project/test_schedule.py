"""How tests are spread over processes: a file is a group, so is a folder of mechanisms/; the long ones come first."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from shared.stage.paths import mechanism_names
from tests.conftest import group_of

TESTS = Path(__file__).parents[1]


class _Seen:
    """What is collected when all tests are."""

    items: list[pytest.Item]

    def pytest_collection_finish(self, session: pytest.Session) -> None:
        self.items = list(session.items)


def test_every_folder_is_a_group_and_comes_before_every_file() -> None:
    seen = _Seen()
    files = [
        str(TESTS / name)
        for name in ("project/test_rooms.py", "mechanisms/test_mechanisms.py", "project/test_schedule.py")
    ]
    pytest.main(["--collect-only", "-q", "-p", "no:cacheprovider", *files], plugins=[seen])
    groups = [group_of(item.nodeid) for item in seen.items]
    folders = [f"tests/mechanisms/test_mechanisms.py[{name}]" for name in mechanism_names()]
    assert list(dict.fromkeys(groups)) == [*folders, "tests/project/test_rooms.py", "tests/project/test_schedule.py"]
    assert groups == sorted(groups, key=list(dict.fromkeys(groups)).index), "no group is torn apart"


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


def test_a_folder_is_made_in_one_process_and_folders_in_both(tmp_path: Path) -> None:
    """By the words that make gives pytest."""
    (tmp_path / "test_mechanisms.py").write_text(SHARED)
    (tmp_path / "conftest.py").write_text((TESTS / "conftest.py").read_text())
    given = re.search(r"^PYTEST \?= (.*)$", (TESTS.parent / "Makefile").read_text(), flags=re.MULTILINE)
    assert given is not None
    command = [sys.executable, "-m", "pytest", "-v", "-p", "no:cacheprovider", *given[1].split(), str(tmp_path)]
    told = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False).stdout
    where: dict[str, set[str]] = {}
    for process, folder in re.findall(r"\[(gw\d)\].*PASSED.*\[(\w)\]", told):
        where.setdefault(folder, set()).add(process)
    assert sorted(where) == ["a", "b", "c", "d"], told
    assert all(len(processes) == 1 for processes in where.values()), told
    assert len(set.union(*where.values())) == 2, told
