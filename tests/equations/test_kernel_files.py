"""Files of compiled kernels that a power cut, a full disk or other users have damaged are compiled again."""

from __future__ import annotations

import errno
import logging
import os
import shutil
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mbsd.compiling import kernel_files
from mbsd.compiling.kernel_files import KernelFiles
from tests.equations.test_kernel_cache import _run

DATA = {"code": bytes(range(256)) * 8, "signature": ("float64",)}


def _as_folder(path: Path) -> None:
    path.unlink()
    path.mkdir()


def _flipped(path: Path) -> None:
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)


DAMAGES: dict[str, Callable[[Path], object]] = {
    "cut short": lambda path: os.truncate(path, path.stat().st_size // 3),
    "empty": lambda path: os.truncate(path, 0),
    "zeros": lambda path: path.write_bytes(bytes(path.stat().st_size)),
    "text": lambda path: path.write_text("not a kernel"),
    "one bit": _flipped,
    "a folder": _as_folder,
}


def _files(folder: Path) -> KernelFiles:
    return KernelFiles(str(folder), "value-3.py313", "stamp")


@pytest.mark.parametrize("suffix", [".nbi", ".nbc"])
@pytest.mark.parametrize("damage", DAMAGES.values(), ids=DAMAGES)
def test_a_damaged_file_is_removed_named_once_and_written_again(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch,
    damage: Callable[[Path], object], suffix: str,
) -> None:  # fmt: skip
    monkeypatch.setattr(kernel_files, "_TOLD", [])
    for key in ("one", "two"):
        _files(tmp_path).save(key, DATA)
    damaged = [path for path in tmp_path.iterdir() if path.suffix == suffix]
    for path in damaged:
        damage(path)
    with caplog.at_level(logging.WARNING, "mbsd"):
        assert [_files(tmp_path).load(key) for key in ("one", "two")] == [None, None]
    assert len(caplog.messages) == 1
    assert caplog.messages[0].endswith("its kernel is compiled again")
    assert not any(path.exists() for path in damaged)
    for key in ("one", "two"):
        _files(tmp_path).save(key, DATA)
    assert [_files(tmp_path).load(key) for key in ("one", "two")] == [DATA, DATA]


@given(at=st.integers(0, 10_000), byte=st.integers(1, 255), is_cut=st.booleans())
def test_no_change_of_a_file_raises_or_gives_other_data(
    tmp_path_factory: pytest.TempPathFactory, at: int, byte: int, is_cut: bool
) -> None:
    folder = tmp_path_factory.mktemp("kernels")
    _files(folder).save("key", DATA)
    for path in list(folder.iterdir()):
        content = bytearray(path.read_bytes())
        place = at % len(content)
        content[place] ^= byte
        path.write_bytes(content[:place] if is_cut else content)
        assert _files(folder).load("key") in (None, DATA)
        _files(folder).save("key", DATA)
    assert _files(folder).load("key") == DATA


def test_a_file_without_a_digest_counts_if_it_can_be_unpickled(tmp_path: Path) -> None:
    _files(tmp_path).save("key", DATA)
    (data,) = tmp_path.glob("*.nbc")
    data.write_bytes(data.read_bytes().partition(kernel_files.MARK)[0])
    assert _files(tmp_path).load("key") == DATA


def test_a_process_without_room_for_a_file_removes_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    _files(tmp_path).save("key", DATA)

    def refused(_: Path) -> bytes:
        raise OSError(errno.EMFILE, os.strerror(errno.EMFILE))

    with monkeypatch.context() as patch:
        patch.setattr(Path, "read_bytes", refused)
        assert _files(tmp_path).load("key") is None
    assert _files(tmp_path).load("key") == DATA


KERNEL = "from mbsd.compiling.jit import kernel\n@kernel\ndef value(x):\n    return 2.0 * x\n"
ASKED = """
import sys
sys.path.insert(0, {folder!r})
from pathlib import Path
from mbsd.compiling import kernel_cache
{before}
import kernels
print(kernels.value(1.0), sum(kernels.value.stats.cache_hits.values()))
"""


def _answer(folder: Path, kept: Path, before: str = "") -> str:
    code = ASKED.format(folder=str(folder), before=before)
    return _run(code, folder, NUMBA_CACHE_DIR=str(kept), PYTHONDONTWRITEBYTECODE="1").strip()


def test_runs_go_on_after_all_files_were_cut_short(tmp_path: Path) -> None:
    """Each of them ended in an EOFError, and so did every later run."""
    (tmp_path / "kernels.py").write_text(KERNEL)
    kept = tmp_path / "kept"
    assert [_answer(tmp_path, kept) for _ in range(2)] == ["2.0 0", "2.0 1"]
    for path in kept.rglob("*.nb*"):
        os.truncate(path, path.stat().st_size // 2)
    assert [_answer(tmp_path, kept) for _ in range(2)] == ["2.0 0", "2.0 1"]


def test_damaged_kernels_of_a_wheel_are_passed_over(tmp_path: Path) -> None:
    (tmp_path / "kernels.py").write_text(KERNEL)
    _answer(tmp_path, tmp_path / "first")
    shutil.copytree(tmp_path / "first" / "kernels", tmp_path / "shipped")
    before = f"kernel_cache.SHIPPED = Path({str(tmp_path / 'shipped')!r})"
    kept = tmp_path / "kept"
    assert _answer(tmp_path, kept, before) == "2.0 1", "the wheel's"
    for path in (tmp_path / "shipped").rglob("*.nbc"):
        _flipped(path)
    assert [_answer(tmp_path, kept, before) for _ in range(2)] == ["2.0 0", "2.0 1"]
    assert list(kept.rglob("*.nbc"))


def test_who_cannot_write_to_the_clone_takes_its_kernels_and_adds_to_his_own(tmp_path: Path) -> None:
    (tmp_path / "kernels.py").write_text(KERNEL)
    _answer(tmp_path, tmp_path / "clone")
    before = (
        f"import os; os.environ.pop('NUMBA_CACHE_DIR'); os.environ['XDG_CACHE_HOME'] = {str(tmp_path / 'own')!r}\n"
        f"kernel_cache._beside_package = lambda: Path({str(tmp_path / 'clone')!r})\n"
        "import tempfile; make = tempfile.TemporaryFile\n"
        "def refused(dir=None, **more):\n"
        "    if 'clone' in str(dir): raise PermissionError(13, 'Permission denied')\n"
        "    return make(dir=dir, **more)\n"
        "tempfile.TemporaryFile = refused"
    )
    assert _answer(tmp_path, tmp_path / "unused", before) == "2.0 1"
    (tmp_path / "kernels.py").write_text(KERNEL.replace("2.0", "3.0"))
    assert [_answer(tmp_path, tmp_path / "unused", before) for _ in range(2)] == ["3.0 0", "3.0 1"]
    assert list((tmp_path / "own").rglob("*.nbc"))
    assert len(list((tmp_path / "clone").rglob("*.nbc"))) == 1


@pytest.mark.skipif(sys.platform == "win32", reason="needs /dev/full")
def test_a_disk_that_is_full_keeps_nothing_and_ends_no_run(tmp_path: Path) -> None:
    (tmp_path / "kernels.py").write_text(KERNEL)
    before = "import os\ndef full(handle): raise OSError(28, 'No space left on device')\nos.fsync = full"
    kept = tmp_path / "kept"
    assert _answer(tmp_path, kept, before) == "2.0 0"
    assert not [path for path in kept.rglob("*") if ".nb" in path.name]
