"""A file is there whole or as it was: through an exception, a kill and a full disk."""

from __future__ import annotations

import errno
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from mbsd.base.files import write_whole
from shared.stage.errors import UserError
from shared.stage.files import file_hash, remove_leftovers, sources_hash, whole_file, write_bytes
from shared.stage.paths import ROOT


@pytest.fixture
def target(tmp_path: Path) -> Path:
    path = tmp_path / "deep" / "data.json"
    write_bytes(path, b"old")
    return path


def only(target: Path) -> bool:
    """Return True if the folder holds the target and no rest of a temporary file."""
    return list(target.parent.iterdir()) == [target]


def test_written_whole(target: Path) -> None:
    write_bytes(target, b"new")
    assert target.read_bytes() == b"new"
    assert only(target)


@pytest.mark.parametrize(("umask", "mode"), [(0o022, 0o644), (0o077, 0o600), (0o002, 0o664)])
def test_the_umask_decides_who_may_read(target: Path, umask: int, mode: int) -> None:
    """Results were for everyone to read."""
    before = os.umask(umask)
    try:
        write_bytes(target, b"new")
        write_whole(target.with_name("model.json"), b"new")
    finally:
        os.umask(before)
    assert [path.stat().st_mode & 0o777 for path in sorted(target.parent.iterdir())] == [mode, mode]


def test_the_temporary_file_keeps_the_suffix(tmp_path: Path) -> None:
    with whole_file(tmp_path / "frame.png") as temporary:
        assert temporary.suffix == ".png"
        assert temporary.parent == tmp_path
        temporary.write_bytes(b"x")


def test_a_writer_that_fails_keeps_the_old_file(target: Path) -> None:
    with pytest.raises(ZeroDivisionError), whole_file(target) as temporary:
        temporary.write_bytes(b"half of a new")
        raise ZeroDivisionError
    assert target.read_bytes() == b"old"
    assert only(target)


def test_ctrl_c_keeps_the_old_file(target: Path) -> None:
    with pytest.raises(KeyboardInterrupt), whole_file(target) as temporary:
        temporary.write_bytes(b"half of a new")
        raise KeyboardInterrupt
    assert target.read_bytes() == b"old"
    assert only(target)


def test_a_killed_writer_keeps_the_old_file(target: Path) -> None:
    code = (
        "import sys, time; from pathlib import Path; from shared.stage.files import whole_file\n"
        "with whole_file(Path(sys.argv[1])) as temporary:\n"
        "    temporary.write_bytes(b'half of a new'); print('half', flush=True); time.sleep(60)\n"
    )
    process = subprocess.Popen([sys.executable, "-c", code, str(target)], cwd=ROOT, stdout=subprocess.PIPE)
    assert process.stdout is not None
    assert process.stdout.readline() == b"half\n"
    process.kill()
    assert process.wait() == -signal.SIGKILL
    process.stdout.close()
    assert target.read_bytes() == b"old"


def test_files_of_a_killed_writer_are_removed_and_open_ones_are_not(target: Path) -> None:
    elsewhere = target.with_name("elsewhere")
    elsewhere.write_bytes(b"a file of the user's")
    target.with_name(".data-0123abcd.json").write_bytes(b"part")
    target.with_name(".data-4567abcd.json").symlink_to(elsewhere)
    with whole_file(target) as temporary:
        write_bytes(target, b"by another process")
        assert temporary.exists()
        assert not target.with_name(".data-0123abcd.json").exists()
        temporary.write_bytes(b"new")
    assert target.read_bytes() == b"new"
    assert elsewhere.read_bytes() == b"a file of the user's"


def test_leftovers_of_all_targets_are_removed_but_for_files_of_the_user(target: Path) -> None:
    kept = [target.with_name(name) for name in (".data-of-mine.json", ".gitignore", "film-0123abcd.mp4")]
    for path in (*kept, target.with_name(".film-0123abcd.mp4"), target.with_name(".film-89abcdef.gif")):
        path.write_bytes(b"part")
    with whole_file(target) as temporary:
        temporary.write_bytes(b"new")
        remove_leftovers(target.parent)
        assert sorted(target.parent.iterdir()) == sorted([*kept, target, temporary])
    remove_leftovers(target.parent / "nowhere")


def test_the_word_for_what_stands_in_the_way(target: Path) -> None:
    target.unlink()
    target.mkdir()
    with pytest.raises(UserError, match=r"cannot write .*data\.json: Is a directory; remove or rename what is in its"):
        write_bytes(target, b"new")
    assert only(target)


def test_a_real_limit_on_file_size_keeps_the_old_file(target: Path) -> None:
    code = (
        "import resource, signal, sys; from pathlib import Path\n"
        "from shared.stage.console import run_cli; from shared.stage.files import write_bytes\n"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))\n"
        "run_cli(lambda: write_bytes(Path(sys.argv[1]), bytes(5000)))\n"
    )
    done = subprocess.run([sys.executable, "-c", code, str(target)], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 1
    assert done.stderr.startswith(f"error: cannot write {target}: File too large; free some disk space")
    assert target.read_bytes() == b"old"
    assert only(target)


def test_a_full_disk_is_told_with_the_remedy(target: Path) -> None:
    sentence = r"cannot write .*data\.json: No space left on device; free some disk space \([\d.]+ MB are free\) or"
    with pytest.raises(UserError, match=sentence), whole_file(target) as temporary:
        temporary.write_bytes(b"half")
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    assert target.read_bytes() == b"old"
    assert only(target)


def test_a_file_in_the_place_of_a_folder_is_told(tmp_path: Path) -> None:
    (tmp_path / "out").write_text("a file")
    with pytest.raises(UserError, match=r"cannot write .*MBSD_OUT"):
        write_bytes(tmp_path / "out" / "data.json", b"x")


def test_file_hash_is_sha256(tmp_path: Path) -> None:
    (tmp_path / "abc").write_bytes(b"abc")
    assert file_hash(tmp_path / "abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"


def test_sources_hash_follows_names_and_content(tmp_path: Path) -> None:
    folder = tmp_path / "room"
    folder.mkdir()
    (folder / "a.py").write_text("1")
    first = sources_hash(folder)
    (folder / "notes.txt").write_text("not a source")
    assert sources_hash(folder) == first
    (folder / "a.py").write_text("2")
    changed = sources_hash(folder)
    (folder / "a.py").rename(folder / "b.py")
    assert len({first, changed, sources_hash(folder)}) == 3
    assert sources_hash(folder / "b.py") != sources_hash(folder)
