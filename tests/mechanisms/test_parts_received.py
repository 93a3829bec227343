"""Parts from workers: believed only where document, names, hashes, meshes, solids and masses hold together."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cadquery
import msgspec
import pytest

from mbsd.dealing.report import WrongAnswer
from mechanisms.stages.loading.inputs import Inputs
from mechanisms.stages.parts.bodies import described_body
from mechanisms.stages.parts.on_cluster import answer
from mechanisms.stages.parts.on_cluster.answer import Made
from mechanisms.stages.parts.on_cluster.solids_check import refuse_wrong
from mechanisms.stages.parts_files import binary_stl, read_triangles
from shared.contract import Parts, Provenance
from shared.shapes.solid import Solid
from shared.stage import jsonfile
from shared.stage.errors import UserError

OWN, PROGRAM = "mechanisms/arm/parts.py", {"cadquery": "2.5", "trimesh": "4.0"}
NOTES: dict[str, Any] = {"parameters": ["length"], "inputs": Inputs().names() | {"modules": [OWN]}}
Document = dict[str, Any]


@pytest.fixture(scope="module")
def made() -> Made:
    """A bar with a hole, as a worker makes it."""
    bar = cadquery.Workplane().box(40, 10, 5).faces(">Z").workplane().hole(4)
    files: dict[str, bytes] = {}
    body = described_body("arm", "bar", [Solid("bar", bar, "steel", 1)], files, None)
    document = Parts(mechanism="arm", provenance=Provenance(inputs="0" * 64, versions=PROGRAM), bodies={"bar": body})
    return Made(jsonfile.encode(document), files, NOTES)


def bytes_of(made: Made) -> bytes:
    return msgspec.msgpack.encode(made)


def changed(made: Made, change: Callable[[Document], object], files: dict[str, bytes] | None = None) -> Made:
    document = msgspec.json.decode(made.document)
    change(document)
    new = msgspec.json.format(msgspec.json.encode(document), indent=1) + b"\n"
    return Made(new, files or made.files, made.notes)


def with_files(made: Made, **files: bytes) -> Made:
    """Other bytes under these names, whose hash the document tells."""
    new = made.files | {name.replace("_", "."): content for name, content in files.items()}

    def hashed(document: Document) -> None:
        document["bodies"]["bar"]["pieces"]["bar"]["stl_sha256"] = hashlib.sha256(new["bar.stl"]).hexdigest()

    return changed(made, hashed, new)


def piece(document: Document) -> Document:
    return document["bodies"]["bar"]["pieces"]["bar"]


def test_right_parts_are_taken(made: Made) -> None:
    assert answer.read("arm", bytes_of(made), OWN, PROGRAM) == made
    assert answer.read("arm", bytes_of(Made(refusal="no\x1b[2J")), OWN, PROGRAM).refusal == "no [2J"


FALSE: dict[str, Callable[[Made], Any]] = {
    "None": lambda made: None,
    "a list": lambda made: [1],
    "no document": lambda made: Made(b"", made.files, made.notes),
    "text": lambda made: Made(b"parts", made.files, made.notes),
    "a document cut short": lambda made: Made(made.document[:-40], made.files, made.notes),
    "another mechanism": lambda made: changed(made, lambda d: d.update(mechanism="other")),
    "another version": lambda made: changed(made, lambda d: d.update(schema_version=7)),
    "other packages": lambda made: changed(made, lambda d: d["provenance"].update(versions={"cadquery": "1"})),
    "a name with dots": lambda made: changed(
        made, lambda d: piece(d).update(stl="../../x.stl"), {"../../x.stl": made.files["bar.stl"]}
    ),
    "a file of another name": lambda made: changed(
        made,
        lambda d: piece(d).update(stl="x.stl"),
        {"x.stl": made.files["bar.stl"], "bar.step": made.files["bar.step"]},
    ),
    "a file too many": lambda made: Made(made.document, made.files | {"../../x.py": b""}, made.notes),
    "a file too few": lambda made: Made(made.document, {"bar.stl": made.files["bar.stl"]}, made.notes),
    "another hash": lambda made: Made(made.document, made.files | {"bar.stl": b"solid"}, made.notes),
    "no notes": lambda made: Made(made.document, made.files),
    "notes of numbers": lambda made: Made(made.document, made.files, NOTES | {"parameters": [1]}),
    "notes without the author's file": lambda made: Made(
        made.document, made.files, NOTES | {"inputs": Inputs().names()}
    ),
    "sources of the whole disk": lambda made: Made(
        made.document,
        made.files,
        NOTES | {"inputs": NOTES["inputs"] | {"sources": ["/"]}},
    ),
}


@pytest.mark.parametrize("kind", FALSE)
def test_what_does_not_hold_together_is_refused(
    made: Made, kind: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(answer, "_refuse_other_solids", lambda *_: pytest.fail("nothing may be written"))
    with pytest.raises(WrongAnswer, match=r"arm"):
        answer.read("arm", msgspec.msgpack.encode(FALSE[kind](made)), OWN, PROGRAM)


def half(stl: bytes) -> bytes:
    """A whole file of half of the triangles."""
    corners = read_triangles(stl).astype("f4")
    return binary_stl(corners[: len(corners) // 2])


WRONG: dict[str, Callable[[Made], Made]] = {
    "an STL cut in half": lambda made: with_files(made, bar_stl=made.files["bar.stl"][:2000]),
    "half of the triangles": lambda made: with_files(made, bar_stl=half(made.files["bar.stl"])),
    "a text as STL": lambda made: with_files(made, bar_stl=b"this is no mesh"),
    "a coordinate that is no number": lambda made: with_files(
        made, bar_stl=made.files["bar.stl"][:96] + b"\x00\x00\xc0\x7f" + made.files["bar.stl"][100:]
    ),
    "a STEP cut in half": lambda made: with_files(made, bar_step=made.files["bar.step"][:4000]),
    "a STEP cut in half with an end": lambda made: with_files(
        made, bar_step=made.files["bar.step"][:4000] + b"\nENDSEC;\nEND-ISO-10303-21;\n"
    ),
    "a text as STEP": lambda made: with_files(made, bar_step=b"ISO-10303-21;\nrubbish\nEND-ISO-10303-21;\n"),
    "another solid": lambda made: with_files(made, bar_step=made.files["bar.step"].replace(b"20.", b"23.")),
    "another mass": lambda made: changed(made, lambda d: piece(d)["mass"].update(mass=1.0)),
    "another mass of the body": lambda made: changed(made, lambda d: d["bodies"]["bar"]["mass"].update(mass=1.0)),
    "another material": lambda made: changed(made, lambda d: piece(d).update(material="cheese")),
    "other heights": lambda made: changed(made, lambda d: piece(d).update(z_range=[0.0, 1.0])),
    "another count of triangles": lambda made: changed(made, lambda d: piece(d).update(triangles=3)),
}


def written(made: Made, folder: Path) -> Path:
    (folder / "parts.json").write_bytes(made.document)
    for name, content in made.files.items():
        (folder / name).write_bytes(content)
    return folder


def test_right_solids_are_taken(made: Made, tmp_path: Path) -> None:
    refuse_wrong(written(made, tmp_path))


@pytest.mark.parametrize("kind", WRONG)
def test_solids_that_are_not_as_told_are_refused(made: Made, kind: str, tmp_path: Path) -> None:
    with pytest.raises(UserError, match="bar"):
        refuse_wrong(written(WRONG[kind](made), tmp_path))


def test_solids_are_read_by_a_process_of_their_own(made: Made) -> None:
    with pytest.raises(WrongAnswer, match=r"the parts of arm: bar: bar: bar.stl is no whole binary STL \(2000 bytes\)"):
        answer.read("arm", bytes_of(WRONG["an STL cut in half"](made)), OWN, PROGRAM)
