"""Parts of a user's own folder by workers that do not see it: the same bytes as here, whatever form the folder has."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import distributed
import msgspec
import psutil
import pytest

from mechanisms.stages.loading.loading import author_code
from mechanisms.stages.parts.on_cluster import answer, built
from mechanisms.stages.parts.on_cluster.author_files import Order, by_content, collected
from shared.cluster.deal import content_hash
from shared.cluster.preload import OF_PARTS, PARTS, identity
from shared.stage import paths
from shared.stage.errors import UserError
from shared.stage.paths import ROOT

MECHANISM = """
from dataclasses import dataclass
from mbsd import Mechanism, constant_rate
import sizes

@dataclass(frozen=True)
class Params:
    length: float = sizes.LENGTH

def build(p):
    m = Mechanism("@NAME@")
    arm = m.bar("arm", p.length)
    m.revolute("A", m.ground.at(0, 0), arm.start)
    m.drive_angle("motor", arm, constant_rate(6.0))
    return m
"""
SOLIDS = """
from shared.shapes.solid import Solid
from lib.boxes import box

def parts(p):
    return {"ground": [Solid("plate", box(20.0, 8.0), "steel", 0)],
            "arm": [Solid("arm", box(1000 * p.length, width()), "steel", 0)]}
"""
BESIDE = """
def width():
    from pathlib import Path
    return float((Path(__file__).parent / "data" / "width.txt").read_text())
"""
OF_SINGLE = """
def width():
    from .lengths import WIDTH
    return WIDTH
"""
BOXES = """
import cadquery as cq
from .thick import T

def box(a, b):
    return cq.Workplane().box(a, b, T)
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A machine in a folder and one in a file, what they import and read, and what is nobody's business."""
    place = tmp_path / "my machines"
    texts = {
        "arm/mechanism.py": MECHANISM.replace("@NAME@", "arm"),
        "arm/parts.py": SOLIDS + BESIDE,
        "arm/data/width.txt": "7.5",
        "arm/.git/secret": "",
        "wheel.py": MECHANISM.replace("@NAME@", "wheel") + SOLIDS + OF_SINGLE,
        "lengths.py": "WIDTH = 6.5\n",
        "sizes.py": "LENGTH = 0.04\n",
        "lib/__init__.py": "",
        "lib/boxes.py": BOXES,
        "lib/thick.py": "T = 3.0\n",
        "lib/unused.py": "",
        "private.py": "",
        "photo.jpg": "",
    }
    for name, text in texts.items():
        (place / name).parent.mkdir(parents=True, exist_ok=True)
        (place / name).write_text(text)
    monkeypatch.setenv("MBSD_WORKSHOP", str(place))
    monkeypatch.setattr(paths, "MECHANISMS", place)
    return place


LIBRARY = {f"workshop:{name}" for name in ("sizes.py", "lib/__init__.py", "lib/boxes.py", "lib/thick.py")}
OF_ARM = {f"workshop:arm/{name}" for name in ("mechanism.py", "parts.py", "data/width.txt")}


def test_files_of_the_mechanism_travel_and_what_they_import_and_no_others(folder: Path) -> None:
    assert set(collected("arm")) == OF_ARM | LIBRARY
    assert set(collected("wheel")) == {"workshop:wheel.py", "workshop:lengths.py"} | LIBRARY


def test_what_was_read_before_travels_if_it_lies_in_the_folder(folder: Path) -> None:
    read = ["workshop:photo.jpg", "workshop:gone.txt", "/etc/passwd", "shared/shot.py", "results:x"]
    assert set(collected("wheel", read)) - set(collected("wheel")) == {"workshop:photo.jpg"}


def test_a_folder_that_is_the_machine_itself_sends_its_three_files(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder / "mechanism.py").write_text("from .helper import K\n")
    (folder / "helper.py").write_text("K = 1\n")
    (folder / "parts.py").write_text("")
    assert set(collected("my_machines")) == {f"workshop:{name}.py" for name in ("mechanism", "parts", "helper")}


def made_far(name: str, place: Path, monkeypatch: pytest.MonkeyPatch, scale: str = "") -> answer.Made:
    """What a worker makes of contents alone, in a folder of its own."""
    files = collected(name)
    hashes = {path: content_hash(content) for path, content in files.items()}
    order = Order(
        name=name, files=hashes, program=identity(PARTS, OF_PARTS), folder=paths.MECHANISMS.name, scale=scale
    )  # fmt: skip
    common = msgspec.json.encode(order)
    place.mkdir()
    for key, content in {**by_content(files), "order": common}.items():
        (place / key).write_bytes(content)
    with monkeypatch.context() as patch:
        patch.setenv("MBSD_OUT", str(place / "out"))
        patch.setenv("MBSD_WORKSHOP", str(place))  # a worker that was started in a folder, too
        contents = {key: place / key for key in (*hashes.values(), "order")}
        return msgspec.msgpack.decode(built.parts(contents, "order", name), type=answer.Made)


def mbsd(folder: Path, *words: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """The program in the user's folder."""
    ours = ("MBSD_OUT", "MBSD_FACE", "MBSD_WORKSHOP", "CLUSTER", "MBSD_MAKE")
    kept = {key: value for key, value in os.environ.items() if key not in ours}
    command = [sys.executable, "-P", "-m", "mbsd", *words]
    return subprocess.run(
        command, cwd=folder, env=kept | {"PYTHONPATH": str(ROOT)} | environment, capture_output=True, text=True
    )  # fmt: skip


def files_in(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir()}


@pytest.mark.parametrize(("name", "scale"), [("arm", ""), pytest.param("wheel", "1:2", marks=pytest.mark.slow)])
def test_a_worker_that_has_contents_alone_makes_the_same_bytes(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, scale: str
) -> None:
    made = made_far(name, tmp_path / "far", monkeypatch, scale)
    assert made.refusal == ""
    done = mbsd(folder, "parts", name, *(["--scale", scale] if scale else []))
    assert done.returncode == 0, done.stderr
    below = folder / "out" / name / ("scale_1_2" if scale else "")
    assert files_in(below / "parts") == {"parts.json": made.document, **made.files}
    assert "workshop:lib/thick.py" in made.notes["inputs"]["modules"]
    assert not scale or not (folder / "out" / name / "parts").exists(), "none of full size are made for a model"


@pytest.mark.parametrize(
    "path", ["workshop:../x.py", "workshop:/etc/x", "workshop:", "../tree/shared/x.py", "workshop:a/../../x"]
)
def test_a_worker_writes_no_file_outside_the_copy_of_the_folder(tmp_path: Path, path: str) -> None:
    tree = tmp_path / "tree"
    with pytest.raises(UserError, match="is no file of an author's"):
        built._write_file(tree, path, b"", built.own_folder(tree, "../machines"))
    assert not list(tmp_path.rglob("*.py"))


def test_functions_of_a_mechanism_run_where_its_folder_is_not(folder: Path) -> None:
    """A worker of a study gets build() and measure() alone, and may have been started in a folder of its own."""
    with author_code("arm"):
        pass
    with pytest.raises(ZeroDivisionError), author_code("elsewhere"):
        raise ZeroDivisionError


@pytest.fixture
def cluster(tmp_path: Path) -> Iterator[Any]:
    """A scheduler and two workers, each a process with a nanny that starts it again."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("MBSD_OUT", str(tmp_path / "workers"))
        with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
            yield cluster


@pytest.mark.slow
def test_a_killed_worker_loses_no_parts_of_an_own_folder(folder: Path, cluster: Any, tmp_path: Path) -> None:
    killed: list[int] = []

    def kill() -> None:
        """The worker that has begun a stage."""
        while not killed:
            for worker in cluster.workers.values():
                if worker.pid and any("parts" in child.cmdline() for child in psutil.Process(worker.pid).children()):
                    killed.append(worker.pid)
                    os.kill(worker.pid, signal.SIGKILL)
                    return
            time.sleep(0.02)

    threading.Thread(target=kill, daemon=True).start()
    far = {"CLUSTER": cluster.scheduler_address, "MBSD_OUT": str(tmp_path / "far")}
    done = mbsd(folder, "parts", "arm", **far)
    assert killed
    assert "parts: arm: made by worker tcp://" in done.stdout, done.stderr
    assert mbsd(folder, "parts", "arm").returncode == 0
    assert files_in(tmp_path / "far" / "arm" / "parts") == files_in(folder / "out" / "arm" / "parts")
    assert "nothing to do" in mbsd(folder, "parts", "arm", **far).stdout
