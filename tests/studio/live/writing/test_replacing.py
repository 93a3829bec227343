"""A file of the author's takes new numbers only while it is what was read; what an editor saves meanwhile stays."""

from __future__ import annotations

import os
import stat
from collections.abc import Callable
from pathlib import Path

import pytest

from shared.stage.errors import UserError
from studio.live import writing
from studio.live.writing import Meanwhile, replace

BEFORE, AFTER, SAVED = b"a = 1\n", b"a = 2\n", b"a = 1  # saved by an editor\n"


@pytest.fixture
def file(tmp_path: Path) -> Path:
    path = tmp_path / "mechanism.py"
    path.write_bytes(BEFORE)
    return path


def by_rename(path: Path) -> None:
    beside = path.with_suffix(".new")
    beside.write_bytes(SAVED)
    beside.replace(path)


def in_place(path: Path) -> None:
    path.write_bytes(SAVED)


def test_it_is_written_whole_with_its_mode(file: Path) -> None:
    file.chmod(0o640)
    replace(file, BEFORE, AFTER)
    assert file.read_bytes() == AFTER
    assert stat.S_IMODE(file.stat().st_mode) == 0o640
    assert os.listdir(file.parent) == ["mechanism.py"]


@pytest.mark.parametrize("save", [by_rename, in_place])
@pytest.mark.parametrize("exchanges", [True, False])
def test_a_save_before_it_is_put_there_stays(
    file: Path, monkeypatch: pytest.MonkeyPatch, save: Callable[[Path], None], exchanges: bool
) -> None:
    if not exchanges:
        monkeypatch.setattr(writing, "_exchanged", lambda first, second: False)
    with pytest.raises(Meanwhile):
        save(file)
        replace(file, BEFORE, AFTER)
    assert file.read_bytes() == SAVED
    assert os.listdir(file.parent) == ["mechanism.py"]


@pytest.mark.skipif(not hasattr(os, "pidfd_open"), reason="only Linux exchanges two files in one step")
@pytest.mark.parametrize("save", [by_rename, in_place])
def test_a_save_between_the_last_look_and_the_exchange_stays(
    file: Path, monkeypatch: pytest.MonkeyPatch, save: Callable[[Path], None]
) -> None:
    exchanged, saves = writing._exchanged, [save]

    def saved_before(first: Path, second: Path) -> bool:
        if saves:
            saves.pop()(file)
        return exchanged(first, second)

    monkeypatch.setattr(writing, "_exchanged", saved_before)
    with pytest.raises(Meanwhile):
        replace(file, BEFORE, AFTER)
    assert file.read_bytes() == SAVED
    assert os.listdir(file.parent) == ["mechanism.py"]


@pytest.mark.skipif(not hasattr(os, "pidfd_open"), reason="only Linux exchanges two files in one step")
def test_an_editor_that_had_opened_the_file_before_is_waited_for(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with file.open("r+b") as editor:

        def writes(_: float) -> None:
            editor.write(SAVED)
            editor.flush()

        monkeypatch.setattr(writing.time, "sleep", writes)
        with pytest.raises(Meanwhile):
            replace(file, BEFORE, AFTER)
    assert file.read_bytes() == SAVED


def test_a_newer_save_is_not_put_back_under_an_older_one(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    exchanged, calls = writing._exchanged, []

    def saved_around(first: Path, second: Path) -> bool:
        if not calls:
            in_place(file)
        calls.append(first)
        done = exchanged(first, second)
        if len(calls) == 1:
            file.write_bytes(b"newest\n")
        return done

    monkeypatch.setattr(writing, "_exchanged", saved_around)
    with pytest.raises(Meanwhile):
        replace(file, BEFORE, AFTER)
    assert file.read_bytes() == b"newest\n"


def test_a_read_only_file_is_left_alone(file: Path) -> None:
    file.chmod(0o444)
    with pytest.raises(UserError, match=r"mechanism\.py is read-only.*chmod u\+w"):
        replace(file, BEFORE, AFTER)
    assert file.read_bytes() == BEFORE


def test_where_the_disk_is_full_the_file_stays(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(path: Path, content: bytes) -> int:
        raise OSError(28, "No space left on device", str(path))

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(UserError, match="No space left on device; free some disk space"):
        replace(file, BEFORE, AFTER)
    assert file.read_bytes() == BEFORE
    assert os.listdir(file.parent) == ["mechanism.py"]


def test_a_file_that_is_gone_is_told(file: Path) -> None:
    file.unlink()
    with pytest.raises(UserError, match="No such file"):
        replace(file, BEFORE, AFTER)
    assert not file.exists()
