"""make over everything: clean and check."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

from shared.stage.paths import ROOT
from tests.project.making import run


def test_clean_removes_the_results_and_leaves_a_folder_of_the_users_alone(tmp_path: Path) -> None:
    shutil.copytree(ROOT / "tools", tmp_path / "tools")
    (tmp_path / "out" / "four_bar").mkdir(parents=True)
    mine = tmp_path / "mine"
    mine.mkdir()
    done = run("sh", "tools/clean.sh", cwd=tmp_path, MBSD_OUT=str(mine))
    assert done.returncode == 0
    assert not (tmp_path / "out").exists()
    assert mine.exists()
    assert str(mine) in done.stderr
    (mine / "data.json").touch()
    (tmp_path / "out").symlink_to(mine)
    done = run("sh", "tools/clean.sh", cwd=tmp_path)
    assert (done.returncode, (tmp_path / "out").is_symlink(), (mine / "data.json").exists()) == (0, True, True)
    assert f"out is a link, so it and the folder it leads to are left to you: {mine}" in done.stderr


def test_check_tells_versions_libraries_disk_and_device() -> None:
    done = run("make", "-o", "install", "check")
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert [line.partition(":")[0] for line in lines] == [
        "python",
        "packages",
        "system libraries",
        "programs",
        "disk",
        "render device",
    ]
    assert re.search(r"numpy \d+\.\d+\.\d+, .*bpy 5\.2", lines[1])
    assert re.search(r"\d+ GB free", lines[4])
    assert re.search(r"(CPU|OPTIX|CUDA|HIP|METAL|ONEAPI).*, Blender 5\.2", lines[5])
