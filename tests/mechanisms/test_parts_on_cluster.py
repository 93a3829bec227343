"""Parts made by workers of a cluster, with files of an author's own, and what comes back."""

from __future__ import annotations

import hashlib
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import cadquery
import dask.config
import distributed
import msgspec
import psutil
import pytest

from mbsd.dealing import hand
from mbsd.dealing.report import WrongAnswer
from mechanisms.stages.loading.inputs import Inputs
from mechanisms.stages.loading.loading import author_code
from mechanisms.stages.parts import stage as parts_stage
from mechanisms.stages.parts.bodies import described_body
from mechanisms.stages.parts.on_cluster import answer, built, dealt
from mechanisms.stages.parts.on_cluster.answer import WorkerParts
from mechanisms.stages.parts.on_cluster.built import Order, by_content, collected
from mechanisms.stages.parts.on_cluster.solids_check import refuse_wrong
from mechanisms.stages.parts_files import binary_stl, read_triangles
from shared.cluster import preload
from shared.cluster.deal import content_hash
from shared.cluster.preload import identity
from shared.contract import Parts, Provenance
from shared.shapes.solid import Solid
from shared.stage import jsonfile, paths
from shared.stage.errors import UserError
from shared.stage.files import is_abandoned
from shared.stage.paths import ROOT
from tests.mechanisms.author_project import Project, write_file
from tests.mechanisms.test_inputs_of_parts import MECHANISM, PARTS

# Parts by a scheduler and three workers on loopback, the one at work killed: the same bytes as here.


WIDE = "def arm(p):\n    return box(1000 * p.length, float((HERE / 'data' / 'width.txt').read_text()))\n"


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, out_root: Path) -> Project:
    """A mechanism whose parts.py reads a file beside it."""
    project = Project(tmp_path / "project", monkeypatch, parts_stage)
    write_file("mechanisms/arm/mechanism.py", MECHANISM)(project)
    write_file("mechanisms/arm/parts.py", PARTS + WIDE)(project)
    write_file("mechanisms/arm/data/width.txt", "7.5")(project)
    write_file("mechanisms/other/large.step", "not for others")(project)
    return project


@pytest.fixture
def cluster(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """A scheduler and three workers, each a process with a nanny that starts it again."""
    with (
        pytest.MonkeyPatch.context() as patch,
        dask.config.set({"distributed.client.scheduler-info-interval": "200ms"}),
    ):
        patch.setenv("MBSD_OUT", str(tmp_path / "workers"))
        with distributed.LocalCluster(n_workers=3, threads_per_worker=1, dashboard_address=None) as cluster:
            patch.undo()
            monkeypatch.setattr(hand, "REST", 0.1)
            yield cluster


def files(folder: Path) -> dict[str, bytes]:
    paths = sorted(path for path in folder.rglob("*") if path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in paths}


@pytest.mark.slow
def test_a_killed_worker_loses_no_parts_and_changes_none(
    project: Project, cluster: Any, out_root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    killed: list[psutil.Process] = []

    def kill() -> None:
        """The worker that has begun a stage."""
        workers = [psutil.Process(worker.pid) for worker in cluster.workers.values()]
        while not killed:
            for worker in workers:
                if stages := [process for process in worker.children() if "parts" in process.cmdline()]:
                    os.kill(worker.pid, signal.SIGKILL)
                    killed.extend(stages)
                    return
            time.sleep(0.02)

    monkeypatch.setenv("CLUSTER", cluster.scheduler_address)
    killer = threading.Thread(target=kill, daemon=True)
    killer.start()
    assert project.run()
    assert len(killed) == 1
    assert not psutil.wait_procs(killed, timeout=20)[1]
    assert "parts: arm: made by worker tcp://" in capsys.readouterr().out
    assert not project.run()
    far = files(out_root / "arm")

    monkeypatch.setenv("CLUSTER", "")
    shutil.rmtree(out_root / "arm")
    assert project.run()
    assert files(out_root / "arm") == far
    assert len(far) == 6
    left = list((tmp_path / "workers" / ".cluster" / "parts").iterdir())
    assert all(is_abandoned(path / built.LOCK) for path in left)
    assert len(left) <= 1


@pytest.mark.parametrize("change", ["the disk has another file", "the worker refuses"])
def test_parts_that_a_worker_cannot_build_are_built_here(
    project: Project, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], out_root: Path, change: str
) -> None:
    assert project.run()
    here, stamp = files(out_root / "arm"), parts_stage.Stage(parts_stage.Out("arm"), "parts", "", [])
    solids = {name.removeprefix("parts/"): content for name, content in here.items() if name.startswith("parts/")}
    made = WorkerParts(solids.pop("parts.json"), dict.fromkeys(solids, b"other"), stamp.notes())
    write_file("mechanisms/arm/data/width.txt", "9.0")(project)
    monkeypatch.setenv("CLUSTER", "tcp://127.0.0.1:1")
    monkeypatch.setattr(dealt, "made_elsewhere", lambda *_: made if "disk" in change else None)
    assert project.run()
    said = capsys.readouterr()
    assert ("has otherwise; it is made here" in said.err) == ("disk" in change)
    now = files(out_root / "arm")
    assert now["parts/arm.stl"] not in (b"other", here["parts/arm.stl"])


def test_files_of_authors_travel_and_no_others(project: Project) -> None:
    write_file("mechanisms/arm/__pycache__/parts.cpython-313.pyc", "")(project)
    write_file("mechanisms/stages/new/new.py", "")(project)
    write_file("mechanisms/automatic.py", "")(project)
    write_file("mechanisms/helper.py", "")(project)
    (project.folder / "gone.step").symlink_to("nowhere")
    own = {f"mechanisms/arm/{name}" for name in ("mechanism.py", "parts.py", "data/width.txt")}
    assert set(collected("arm")) == own | {"mechanisms/helper.py", "mechanisms/other/mechanism.py"}


OUTSIDE = [
    (path, None) for path in ("../x.py", "/etc/x", "shared/x.py", "mechanisms/stages/x.py", "mechanisms/../x.py")
]
OUTSIDE += [
    (path, "../machines")
    for path in ("workshop:../x.py", "workshop:/etc/x", "workshop:", "../tree/shared/x.py", "workshop:a/../../x")
]
"""Paths, and the folder of machines to which they belong, if it is one of the user's own."""


@pytest.mark.parametrize(("path", "own"), OUTSIDE)
def test_a_worker_writes_no_other_files(tmp_path: Path, path: str, own: str | None) -> None:
    tree = tmp_path / "tree"
    with pytest.raises(UserError, match="is no file of an author's"):
        built._write_file(tree, path, b"", built.own_folder(tree, own) if own else None)
    assert not list(tmp_path.rglob("*.py"))


# Parts of a user's own folder by workers that do not see it: the same bytes as here, whatever form the folder has.


MECHANISM_of_own = """
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
        "arm/mechanism.py": MECHANISM_of_own.replace("@NAME@", "arm"),
        "arm/parts.py": SOLIDS + BESIDE,
        "arm/data/width.txt": "7.5",
        "arm/.git/secret": "",
        "wheel.py": MECHANISM_of_own.replace("@NAME@", "wheel") + SOLIDS + OF_SINGLE,
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


def test_files_read_before_travel_if_they_lie_in_the_folder(folder: Path) -> None:
    read = ["workshop:photo.jpg", "workshop:gone.txt", "/etc/passwd", "shared/shot.py", "results:x"]
    assert set(collected("wheel", read)) - set(collected("wheel")) == {"workshop:photo.jpg"}


def test_a_folder_that_is_the_machine_itself_sends_its_three_files(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder / "mechanism.py").write_text("from .helper import K\n")
    (folder / "helper.py").write_text("K = 1\n")
    (folder / "parts.py").write_text("")
    assert set(collected("my_machines")) == {f"workshop:{name}.py" for name in ("mechanism", "parts", "helper")}


def made_far(name: str, place: Path, monkeypatch: pytest.MonkeyPatch, scale: str = "") -> answer.WorkerParts:
    """Return what a worker builds of contents alone, in a folder of its own."""
    files = collected(name)
    hashes = {path: content_hash(content) for path, content in files.items()}
    order = Order(
        name=name, files=hashes, program=identity(preload.PARTS, preload.OF_PARTS),
        folder=paths.MECHANISMS.name, scale=scale,
    )  # fmt: skip
    common = msgspec.json.encode(order)
    place.mkdir()
    for key, content in {**by_content(files), "order": common}.items():
        (place / key).write_bytes(content)
    with monkeypatch.context() as patch:
        patch.setenv("MBSD_OUT", str(place / "out"))
        patch.setenv("MBSD_WORKSHOP", str(place))  # a worker that was started in a folder, too
        contents = {key: place / key for key in (*hashes.values(), "order")}
        return msgspec.msgpack.decode(built.parts(contents, "order", name), type=answer.WorkerParts)


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


def test_functions_of_a_mechanism_run_where_its_folder_is_not(folder: Path) -> None:
    """A worker of a study gets build() and measure() alone, and may have been started in a folder of its own."""
    with author_code("arm"):
        pass
    with pytest.raises(ZeroDivisionError), author_code("elsewhere"):
        raise ZeroDivisionError


# Parts from workers: believed only where document, names, hashes, meshes, solids and masses hold together.


OWN, PROGRAM = "mechanisms/arm/parts.py", {"cadquery": "2.5", "trimesh": "4.0"}
NOTES: dict[str, Any] = {"parameters": ["length"], "inputs": Inputs().names() | {"modules": [OWN]}}
Document = dict[str, Any]


@pytest.fixture(scope="module")
def worker_parts() -> WorkerParts:
    """A bar with a hole, as a worker makes it."""
    bar = cadquery.Workplane().box(40, 10, 5).faces(">Z").workplane().hole(4)
    files: dict[str, bytes] = {}
    body = described_body("arm", "bar", [Solid("bar", bar, "steel", 1)], files, None)
    document = Parts(mechanism="arm", provenance=Provenance(inputs="0" * 64, versions=PROGRAM), bodies={"bar": body})
    return WorkerParts(jsonfile.encode(document), files, NOTES)


def bytes_of(worker_parts: WorkerParts) -> bytes:
    return msgspec.msgpack.encode(worker_parts)


def changed(
    worker_parts: WorkerParts, change: Callable[[Document], object], files: dict[str, bytes] | None = None
) -> WorkerParts:
    document = msgspec.json.decode(worker_parts.document)
    change(document)
    new = msgspec.json.format(msgspec.json.encode(document), indent=1) + b"\n"
    return WorkerParts(new, files or worker_parts.files, worker_parts.notes)


def with_files(worker_parts: WorkerParts, **files: bytes) -> WorkerParts:
    """Other bytes under these names, whose hash the document tells."""
    new = worker_parts.files | {name.replace("_", "."): content for name, content in files.items()}

    def hashed(document: Document) -> None:
        document["bodies"]["bar"]["pieces"]["bar"]["stl_sha256"] = hashlib.sha256(new["bar.stl"]).hexdigest()

    return changed(worker_parts, hashed, new)


def piece(document: Document) -> Document:
    return document["bodies"]["bar"]["pieces"]["bar"]


def test_right_parts_are_taken(worker_parts: WorkerParts) -> None:
    assert answer.read("arm", bytes_of(worker_parts), OWN, PROGRAM) == worker_parts
    assert answer.read("arm", bytes_of(WorkerParts(refusal="no\x1b[2J")), OWN, PROGRAM).refusal == "no [2J"


FALSE: dict[str, Callable[[WorkerParts], Any]] = {
    "None": lambda worker_parts: None,
    "a list": lambda worker_parts: [1],
    "no document": lambda worker_parts: WorkerParts(b"", worker_parts.files, worker_parts.notes),
    "text": lambda worker_parts: WorkerParts(b"parts", worker_parts.files, worker_parts.notes),
    "a document cut short": lambda worker_parts: WorkerParts(
        worker_parts.document[:-40], worker_parts.files, worker_parts.notes
    ),
    "another mechanism": lambda worker_parts: changed(worker_parts, lambda d: d.update(mechanism="other")),
    "another version": lambda worker_parts: changed(worker_parts, lambda d: d.update(schema_version=7)),
    "other packages": lambda worker_parts: changed(
        worker_parts, lambda d: d["provenance"].update(versions={"cadquery": "1"})
    ),
    "a name with dots": lambda worker_parts: changed(
        worker_parts, lambda d: piece(d).update(stl="../../x.stl"), {"../../x.stl": worker_parts.files["bar.stl"]}
    ),
    "a file of another name": lambda worker_parts: changed(
        worker_parts,
        lambda d: piece(d).update(stl="x.stl"),
        {"x.stl": worker_parts.files["bar.stl"], "bar.step": worker_parts.files["bar.step"]},
    ),
    "a file too many": lambda worker_parts: WorkerParts(
        worker_parts.document, worker_parts.files | {"../../x.py": b""}, worker_parts.notes
    ),
    "a file too few": lambda worker_parts: WorkerParts(
        worker_parts.document, {"bar.stl": worker_parts.files["bar.stl"]}, worker_parts.notes
    ),
    "another hash": lambda worker_parts: WorkerParts(
        worker_parts.document, worker_parts.files | {"bar.stl": b"solid"}, worker_parts.notes
    ),
    "no notes": lambda worker_parts: WorkerParts(worker_parts.document, worker_parts.files),
    "notes of numbers": lambda worker_parts: WorkerParts(
        worker_parts.document, worker_parts.files, NOTES | {"parameters": [1]}
    ),
    "notes without the author's file": lambda worker_parts: WorkerParts(
        worker_parts.document, worker_parts.files, NOTES | {"inputs": Inputs().names()}
    ),
    "sources of the whole disk": lambda worker_parts: WorkerParts(
        worker_parts.document, worker_parts.files, NOTES | {"inputs": NOTES["inputs"] | {"sources": ["/"]}}
    ),
}


@pytest.mark.parametrize("kind", FALSE)
def test_inconsistent_files_are_refused(
    worker_parts: WorkerParts, kind: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(answer, "_refuse_other_solids", lambda *_: pytest.fail("nothing may be written"))
    with pytest.raises(WrongAnswer, match=r"arm"):
        answer.read("arm", msgspec.msgpack.encode(FALSE[kind](worker_parts)), OWN, PROGRAM)


def half(stl: bytes) -> bytes:
    """A whole file of half of the triangles."""
    corners = read_triangles(stl).astype("f4")
    return binary_stl(corners[: len(corners) // 2])


WRONG: dict[str, Callable[[WorkerParts], WorkerParts]] = {
    "an STL cut in half": lambda worker_parts: with_files(worker_parts, bar_stl=worker_parts.files["bar.stl"][:2000]),
    "half of the triangles": lambda worker_parts: with_files(worker_parts, bar_stl=half(worker_parts.files["bar.stl"])),
    "a text as STL": lambda worker_parts: with_files(worker_parts, bar_stl=b"this is no mesh"),
    "a coordinate that is no number": lambda worker_parts: with_files(
        worker_parts,
        bar_stl=worker_parts.files["bar.stl"][:96] + b"\x00\x00\xc0\x7f" + worker_parts.files["bar.stl"][100:],
    ),
    "a STEP cut in half": lambda worker_parts: with_files(worker_parts, bar_step=worker_parts.files["bar.step"][:4000]),
    "a STEP cut in half with an end": lambda worker_parts: with_files(
        worker_parts, bar_step=worker_parts.files["bar.step"][:4000] + b"\nENDSEC;\nEND-ISO-10303-21;\n"
    ),
    "a text as STEP": lambda worker_parts: with_files(
        worker_parts, bar_step=b"ISO-10303-21;\nrubbish\nEND-ISO-10303-21;\n"
    ),
    "another solid": lambda worker_parts: with_files(
        worker_parts, bar_step=worker_parts.files["bar.step"].replace(b"20.", b"23.")
    ),
    "another mass": lambda worker_parts: changed(worker_parts, lambda d: piece(d)["mass"].update(mass=1.0)),
    "another mass of the body": lambda worker_parts: changed(
        worker_parts, lambda d: d["bodies"]["bar"]["mass"].update(mass=1.0)
    ),
    "another material": lambda worker_parts: changed(worker_parts, lambda d: piece(d).update(material="cheese")),
    "other heights": lambda worker_parts: changed(worker_parts, lambda d: piece(d).update(z_range=[0.0, 1.0])),
    "another count of triangles": lambda worker_parts: changed(worker_parts, lambda d: piece(d).update(triangles=3)),
}


def written(worker_parts: WorkerParts, folder: Path) -> Path:
    (folder / "parts.json").write_bytes(worker_parts.document)
    for name, content in worker_parts.files.items():
        (folder / name).write_bytes(content)
    return folder


def test_right_solids_are_taken(worker_parts: WorkerParts, tmp_path: Path) -> None:
    refuse_wrong(written(worker_parts, tmp_path))


@pytest.mark.parametrize("kind", WRONG)
def test_solids_that_are_not_as_told_are_refused(worker_parts: WorkerParts, kind: str, tmp_path: Path) -> None:
    with pytest.raises(UserError, match="bar"):
        refuse_wrong(written(WRONG[kind](worker_parts), tmp_path))


def test_solids_are_read_by_a_process_of_their_own(worker_parts: WorkerParts) -> None:
    with pytest.raises(WrongAnswer, match=r"the parts of arm: bar: bar: bar.stl is no whole binary STL \(2000 bytes\)"):
        answer.read("arm", bytes_of(WRONG["an STL cut in half"](worker_parts)), OWN, PROGRAM)
