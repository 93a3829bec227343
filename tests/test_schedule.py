"""How tests are spread over processes: a file is a group, so is a folder of mechanisms/; the long ones come first."""

from __future__ import annotations

from pathlib import Path

import pytest

from shared.paths import mechanism_names
from tests import conftest


class _Seen:
    """What is collected when all tests are."""

    items: list[pytest.Item]

    def pytest_collection_finish(self, session: pytest.Session) -> None:
        self.items = list(session.items)


def _group(item: pytest.Item) -> str:
    (mark,) = item.iter_markers("xdist_group")
    return mark.args[0]


def test_every_folder_is_a_group_and_comes_before_every_file() -> None:
    seen = _Seen()
    files = [str(Path(__file__).parent / name) for name in ("test_rooms.py", "test_mechanisms.py", "test_schedule.py")]
    pytest.main(["--collect-only", "-q", "-p", "no:cacheprovider", *files], plugins=[seen])
    groups = [_group(item) for item in seen.items]
    folders = [f"mechanisms/{name}" for name in mechanism_names()]
    assert list(dict.fromkeys(groups)) == [*folders, "test_rooms", "test_schedule"]
    assert groups == sorted(groups, key=list(dict.fromkeys(groups)).index), "no group is torn apart"
    assert conftest.pytest_collection_modifyitems
