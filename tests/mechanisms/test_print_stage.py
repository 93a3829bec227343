"""The print stage: plates, outlines, lists; what it redoes and what it refuses."""

from __future__ import annotations

import csv
import io
import os
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import lib3mf
import numpy as np
import pytest

from mechanisms.stages.parts_files import read_mesh
from mechanisms.stages.print import stage as print_stage
from mechanisms.stages.print.making import Product, markdown, table
from shared.contract import read_parts
from shared.stage.errors import UserError
from shared.stage.paths import ROOT
from tests.mechanisms.printed_pieces import SCREW, Press, solids


@pytest.fixture(scope="module")
def shared_root(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("print")


@pytest.fixture
def press(shared_root: Path, monkeypatch: pytest.MonkeyPatch) -> Press:
    """On parts that are made once for all tests."""
    monkeypatch.setenv("MBSD_OUT", str(shared_root))
    made = Press(monkeypatch)
    if not made.out.parts.is_file():
        made.make()
    return made


def rows(files: dict[str, bytes], do: str) -> dict[str, dict[str, str]]:
    return {row["name"]: row for row in csv.DictReader(io.StringIO(files["pieces.csv"].decode())) if row["do"] == do}


def test_every_piece_is_made_or_bought_once(press: Press) -> None:
    files = press.run()
    parts = read_parts(press.out.parts)
    pieces = {name: piece for body in parts.bodies.values() for name, piece in body.pieces.items()}
    made, bought = rows(files, "make"), rows(files, "buy")
    listed = [name for row in [*made.values(), *bought.values()] for name in row["pieces"].split()]
    assert sorted(listed) == sorted(pieces)
    assert all(int(row["count"]) == len(row["pieces"].split()) for row in [*made.values(), *bought.values()])
    assert set(bought) == {SCREW}
    assert bought[SCREW]["count"] == "3"
    for name, row in made.items():
        assert row["material"] == pieces[name].material
        assert float(row["mass_g"]) == pytest.approx(1000 * pieces[name].mass.mass, rel=1e-3)
    text = files["pieces.md"].decode()
    assert f"| {SCREW} | 3 | screw_0, screw_1, screw_2 |" in text
    assert "[plate_8mm.dxf](plate_8mm.dxf)" in text


def test_masses_of_heavy_pieces_are_written_without_exponents() -> None:
    """pieces.md had 6.269e+04 g and 1.861e+08 g."""
    piece = SimpleNamespace(size=(10.0, 20.0, 30.0))
    heavy = [
        Product(("bob", "bob_2"), "cast_iron", 62.69, piece),  # pyright: ignore[reportArgumentType]
        Product(("base",), "concrete", 186100.0, piece),  # pyright: ignore[reportArgumentType]
        Product(("pin",), "steel", 0.0002661, piece),  # pyright: ignore[reportArgumentType]
    ]
    text, rows = markdown("crane", "250 x 210", heavy, []), table(heavy, [])
    assert "## To make: 4, 186 t" in text
    assert [line.split(" | ")[4] for line in text.splitlines() if line.startswith("| b")] == ["62.7 kg", "186 t"]
    assert [row.split(",")[7] for row in rows.splitlines()[1:]] == ["62690", "186100000", "0.2661"]


def test_equal_pieces_are_one_kind_and_mirror_images_are_two(press: Press) -> None:
    made = rows(press.run(), "make")
    assert made["crank"]["pieces"] == "crank spare"  # turned over and round
    assert {"left", "right"} <= set(made)


def test_plates_hold_closed_meshes_that_stand_on_the_bed_and_keep_apart(press: Press) -> None:
    files = press.run(bed="130x100", gap="4")
    made = rows(files, "make")
    plates = sorted(name for name in files if name.endswith(".stl"))
    assert plates == ["plate_1.stl", "plate_2.stl", "plate_3.stl"]
    counts = Counter()
    for name in plates:
        mesh = read_mesh(files[name])
        assert mesh.is_watertight
        assert mesh.bounds[0] == pytest.approx([0.0, 0.0, 0.0], abs=1e-4)
        assert (mesh.bounds[1][:2] <= [130.0 + 1e-4, 100.0 + 1e-4]).all()
        pieces = mesh.split()
        assert all(piece.is_watertight and piece.volume > 0 and abs(piece.bounds[0][2]) < 1e-4 for piece in pieces)
        boxes = [piece.bounds[:, :2] for piece in pieces]
        for k, box in enumerate(boxes):
            for other in boxes[:k]:
                assert np.maximum(box[0] - other[1], other[0] - box[1]).max() > 4.0 - 1e-4
        number = int(name[6])
        expected = sum(row["plates"].split().count(str(number)) for row in made.values())
        assert len(pieces) == expected
        counts[number] = expected
    assert sum(counts.values()) == sum(int(row["count"]) for row in made.values())


def test_a_3mf_is_valid_and_names_every_piece(press: Press, tmp_path: Path) -> None:
    files = press.run()
    assert [name for name in files if name.endswith(".3mf")] == ["plate_1.3mf"]
    model: Any = lib3mf.get_wrapper().CreateModel()
    reader = model.QueryReader("3mf")
    reader.SetStrictModeActive(True)
    reader.ReadFromBuffer(files["plate_1.3mf"])
    assert reader.GetWarningCount() == 0
    assert model.GetUnit() == lib3mf.ModelUnit.MilliMeter
    names, meshes = Counter(), model.GetMeshObjects()
    while meshes.MoveNext():
        mesh = meshes.GetCurrentMeshObject()
        assert mesh.IsManifoldAndOriented()
        assert mesh.IsValid()
        names[mesh.GetName()] += 1
    made = rows(files, "make")
    assert names == Counter(made.keys())  # equal pieces share a mesh
    items, numbers = model.GetBuildItems(), []
    while items.MoveNext():
        numbers.append(items.GetCurrent().GetPartNumber())
    assert sorted(numbers) == sorted(name for row in made.values() for name in row["pieces"].split())


def test_the_3mf_and_the_stl_are_the_same_plate(press: Press) -> None:
    files = press.run()
    model: Any = lib3mf.get_wrapper().CreateModel()
    model.QueryReader("3mf").ReadFromBuffer(files["plate_1.3mf"])
    corners, items = [], model.GetBuildItems()
    while items.MoveNext():
        item = items.GetCurrent()
        mesh = model.GetMeshObjectByID(item.GetObjectResourceID())
        vertices = np.array([list(v.Coordinates) for v in mesh.GetVertices()])
        fields = np.array([list(row) for row in item.GetObjectTransform().Fields])
        corners.append(vertices @ fields[:3] + fields[3])
    of_stl = read_mesh(files["plate_1.stl"])
    both = np.concatenate(corners)
    assert both.min(axis=0) == pytest.approx(of_stl.bounds[0], abs=1e-3)
    assert both.max(axis=0) == pytest.approx(of_stl.bounds[1], abs=1e-3)
    assert both.sum(axis=0) == pytest.approx(of_stl.vertices.sum(axis=0), rel=1e-4)


@pytest.mark.slow
def test_two_processes_write_the_same_bytes(press: Press, tmp_path: Path) -> None:
    """From the same parts, in folders of other names, without and with a seed for hashes."""
    outputs = []
    for seed in ("0", "17"):
        out = tmp_path / f"run_{seed}" / "four_bar" / "parts"
        out.mkdir(parents=True)
        for path in press.out.parts_folder.iterdir():
            (out / path.name).write_bytes(path.read_bytes())
        environment = os.environ | {"MBSD_OUT": str(out.parent.parent), "PYTHONHASHSEED": seed}
        command = [sys.executable, "-m", "mechanisms", "print", "four-bar", "--bed", "150x150"]
        done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        outputs.append({p.name: p.read_bytes() for p in sorted((out.parent / "print").iterdir())})
    assert outputs[0] == outputs[1]
    assert {Path(name).suffix for name in outputs[0]} == {".3mf", ".stl", ".dxf", ".md", ".csv"}


def test_it_is_done_again_only_for_another_bed_gap_or_piece(press: Press, capsys: pytest.CaptureFixture[str]) -> None:
    press.run(bed="200x200")
    capsys.readouterr()
    press.run(bed="200x200", gap="5")
    assert capsys.readouterr().out == "print: four_bar: nothing to do\n"
    press.run(bed="200x200", gap="6")
    assert "pieces on 1 plate of 200 x 200 mm, 6 outlines to cut, 3 pieces to buy" in capsys.readouterr().out
    (press.out.print_folder / "pieces.csv").write_text("")
    assert rows(press.run(bed="200x200", gap="6"), "make")


def test_a_run_that_ends_early_leaves_whole_files_and_the_next_one_completes_it(
    press: Press, monkeypatch: pytest.MonkeyPatch
) -> None:
    wanted = press.run(bed="140x140")
    press.run(bed="100x200")
    plain, written = print_stage.write_bytes, []

    def interrupted(path: Path, content: bytes) -> None:
        if len(written) == 2:
            raise KeyboardInterrupt
        written.append(path.name)
        plain(path, content)

    monkeypatch.setattr(print_stage, "write_bytes", interrupted)
    with pytest.raises(KeyboardInterrupt):
        press.run(bed="140x140")
    left = {path.name: path.read_bytes() for path in press.out.print_folder.iterdir()}
    assert all(left[name] == wanted[name] for name in written)
    assert not [name for name in left if name.startswith(".")]
    monkeypatch.setattr(print_stage, "write_bytes", plain)
    assert press.run(bed="140x140") == wanted


def test_files_of_pieces_that_are_gone_are_removed(press: Press) -> None:
    assert "plate_2.3mf" in press.run(bed="100x100")
    (press.out.print_folder / "old_3.00mm.dxf").write_text("of a piece that is gone")
    files = press.run(bed="230x230")
    assert "plate_2.3mf" not in files
    assert "old_3.00mm.dxf" not in files


def test_a_piece_larger_than_the_bed_is_named_with_the_bed_that_it_needs(
    press: Press, capsys: pytest.CaptureFixture[str]
) -> None:
    files = press.run(bed="105x90")
    said = capsys.readouterr()
    needed = "larger bed than 105 x 90 mm, so they are on no plate: bar of 150 x 12 mm"
    assert f"these pieces need a {needed}; give BED=150x12, or print a model: SCALE=1:2 fits" in said.out + said.err
    made = rows(files, "make")
    assert made["bar"]["bed_mm"] == "150 x 12"
    assert made["bar"]["plates"] == ""
    assert "needs a bed of 150 x 12 mm" in files["pieces.md"].decode()
    assert made["plate"]["plates"]
    assert rows(press.run(bed="150x90"), "make")["bar"]["plates"]


def test_a_long_piece_lies_across_where_it_fits_so_alone(press: Press) -> None:
    """150 x 12 mm at 45 degrees needs 162 / sqrt(2) = 114.6 mm."""
    files = press.run(bed="116x116")
    assert rows(files, "make")["bar"]["plates"]
    assert not rows(press.run(bed="114x114"), "make")["bar"]["plates"]


def test_a_piece_that_is_too_high_needs_a_higher_printer(press: Press) -> None:
    made = rows(press.run(bed="220x220x20"), "make")
    assert made["pin"]["bed_mm"] == "14 x 14 x 34"
    assert made["plate"]["plates"]


@pytest.mark.parametrize("bed", ["220", "axb", "0x100", "-5x10", "1e3x100", "nanx5", "1x2x3x4", "220 x 220"])
def test_a_bed_that_is_none_is_refused(press: Press, bed: str) -> None:
    with pytest.raises(UserError, match=rf"BED={re.escape(bed)} is no size of a bed.*BED=220x220"):
        press.run(bed=bed)


@pytest.mark.parametrize("gap", ["-1", "five", "nan", "1e2"])
def test_a_gap_that_is_none_is_refused(press: Press, gap: str) -> None:
    with pytest.raises(UserError, match=f"GAP={gap} is no gap"):
        press.run(gap=gap)


def test_a_file_of_the_parts_that_is_gone_or_swapped_is_named(out_root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    press = Press(monkeypatch)
    press.parts = lambda: {"ground": solids()["ground"][:1], "crank": solids()["coupler"][3:]}
    press.make()
    step = press.out.parts_folder / "plate.step"
    whole = step.read_bytes()
    step.unlink()
    with pytest.raises(UserError, match=r"plate\.step is missing; run make parts-four-bar"):
        press.run()
    step.write_bytes(whole[: len(whole) // 3])
    with pytest.raises(UserError, match=r"cannot read .*plate\.step"):
        press.run()
    step.write_bytes(whole)
    press.run()
    (press.out.parts_folder / "plate.stl").write_bytes((press.out.parts_folder / "ring.stl").read_bytes())
    with pytest.raises(UserError, match=r"plate\.stl is not the file that parts\.json describes"):
        press.run(bed="99x99")


def test_where_all_pieces_are_too_large_the_lists_are_there(out_root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    press = Press(monkeypatch)
    press.parts = lambda: {"ground": solids()["ground"][:1]}
    press.make()
    files = press.run(bed="20x20")
    assert sorted(files) == ["pieces.csv", "pieces.md", "plate_8mm.dxf"]
