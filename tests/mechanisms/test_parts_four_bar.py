"""The four-bar's own solids: made by the stage, put together as in the film."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections import Counter
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

from mechanisms.four_bar.mechanism import Params
from mechanisms.stages.clearance import stage as clearance_stage
from mechanisms.stages.clearance.pieces import MeshPiece, read_pieces
from mechanisms.stages.clearance.stage import check
from shared.contract import Parts, read_parts, write_motion
from shared.contract.clearance import read_clearance
from shared.stage.errors import UserError
from shared.stage.paths import ROOT, Out
from tools.models.motions import four_bar_motion


def start_parts(out_root: Path, name: str = "four_bar") -> subprocess.Popen[str]:
    """Start ``python -m mechanisms parts <name>`` into ``out_root``, in a process of its own."""
    command, environment = [sys.executable, "-m", "mechanisms", "parts", name], os.environ | {"MBSD_OUT": str(out_root)}
    pipe = subprocess.PIPE
    return subprocess.Popen(command, cwd=ROOT, env=environment, stdout=pipe, stderr=pipe, text=True)


def make_parts(out_root: Path, name: str = "four_bar") -> subprocess.CompletedProcess[str]:
    """Run the same to its end."""
    process = start_parts(out_root, name)
    stdout, stderr = process.communicate()
    return subprocess.CompletedProcess(process.args, process.returncode, stdout, stderr)


@pytest.fixture(scope="module")
def roots(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """The parts made twice, by two processes."""
    first, second = tmp_path_factory.mktemp("first"), tmp_path_factory.mktemp("second")
    for process in [start_parts(first), start_parts(second)]:
        _, errors = process.communicate()
        assert process.returncode == 0, errors
    return first, second


@pytest.fixture(scope="module")
def parts(roots: tuple[Path, Path]) -> Parts:
    return read_parts(roots[0] / "four_bar" / "parts" / "parts.json")


@pytest.fixture(scope="module")
def pieces(roots: tuple[Path, Path], parts: Parts) -> dict[str, MeshPiece]:
    return {piece.name: piece for piece in read_pieces(parts, roots[0] / "four_bar" / "parts")}


def test_two_processes_write_the_same_bytes(roots: tuple[Path, Path]) -> None:
    first, second = (sorted(path for path in root.rglob("*") if path.is_file()) for root in roots)
    assert [path.name for path in first] == [path.name for path in second]
    assert len([path for path in first if path.suffix in (".stl", ".step")]) > 40
    for file, counterpart in zip(first, second, strict=True):
        assert file.read_bytes() == counterpart.read_bytes(), file.name


def test_a_lost_or_damaged_file_is_made_again(roots: tuple[Path, Path]) -> None:
    folder = roots[1] / "four_bar" / "parts"
    (folder / "crank.stl").unlink()
    with (folder / "rocker.step").open("ab") as damaged:
        damaged.write(b" ")
    result = make_parts(roots[1])
    assert "2 files written" in result.stdout
    for file in ("crank.stl", "rocker.step"):
        assert (folder / file).read_bytes() == (roots[0] / "four_bar" / "parts" / file).read_bytes()


def test_every_body_has_its_pieces_and_masses(parts: Parts) -> None:
    assert list(parts.bodies) == ["ground", "crank", "coupler", "rocker"]
    for body in parts.bodies.values():
        assert body.mass.mass == pytest.approx(sum(piece.mass.mass for piece in body.pieces.values()))
        assert body.mass.inertia > max(piece.mass.inertia for piece in body.pieces.values())
    assert sum(piece.triangles for body in parts.bodies.values() for piece in body.pieces.values()) < 130_000
    lengths = {"crank": Params().crank, "coupler": Params().coupler, "rocker": Params().rocker}
    for body, length in lengths.items():
        assert 0.2 * length < parts.bodies[body].mass.com[0] < 0.8 * length


def test_the_coupler_carries_the_point_that_is_traced(pieces: dict[str, MeshPiece]) -> None:
    corners = pieces["stylus_P"].triangles.reshape(-1, 3)
    tip = corners[corners[:, 2] > corners[:, 2].max() - 0.01]
    assert (tip[:, :2].min(axis=0) + tip[:, :2].max(axis=0)) / 2 == pytest.approx([60.0, 30.0], abs=0.01)
    assert pieces["stylus_P"].body == "coupler"


def test_bought_pieces_are_listed(parts: Parts) -> None:
    bought = Counter(piece.buy for body in parts.bodies.values() for piece in body.pieces.values() if piece.buy)
    assert bought == {
        "shim ring 8x14x1 DIN 988": 6,
        "circlip 8x0.8 DIN 471": 2,
        "M3x12 socket head cap screw ISO 4762": 6,
        "M5x10 socket head cap screw ISO 4762": 4,  # they hold the back plate on its column
        "M4x16 socket head cap screw ISO 4762": 2,  # and this in its foot
    }


def test_the_coupler_is_marked_at_its_pins(pieces: dict[str, MeshPiece]) -> None:
    """The floors of B and C are 0.6 mm under its upper face, beside the joints."""
    corners = pieces["coupler"].triangles.reshape(-1, 3)
    face = 7.0 + pieces["coupler"].z_range[0]
    floors = np.unique(corners[np.abs(corners[:, 2] - (face - 0.6)) < 1e-3][:, 0])
    assert floors[floors < 60] == pytest.approx(18.0, abs=4.0)
    assert floors[floors > 60] == pytest.approx(102.0, abs=4.0)
    assert len(floors) > 20


def test_pieces_of_one_body_do_not_overlap(pieces: dict[str, MeshPiece]) -> None:
    """Meshes cut corners by up to the tolerance of the mesh: a gap of a fit may be closed by that, not by more."""
    touching = 0
    for first, second in combinations(pieces.values(), 2):
        if first.body == second.body:
            gap = first.manifold.min_gap(second.manifold, 0.1)
            common = (first.manifold ^ second.manifold).volume()
            touching += gap < 0.1
            assert common < 0.5, f"{first.name} and {second.name} share {common:.3f} mm^3"
    assert touching > 20  # they do sit in each other


def test_pins_stand_where_the_joints_are(pieces: dict[str, MeshPiece]) -> None:
    joints = {"pin_A": (0, 0), "pin_B": (40, 0), "pin_C": (120, 0), "pin_D": (120, 0)}
    for name, point in joints.items():
        assert pieces[name].centre == pytest.approx(np.array(point), abs=0.02)


def test_no_two_parts_touch_over_the_motion(pieces: dict[str, MeshPiece], parts: Parts) -> None:
    clearance = check(parts, four_bar_motion(), list(pieces.values()), "key")
    gaps = {frozenset(pair.pieces): pair for pair in clearance.pairs}
    for joint, pin in (("A", "pin_A"), ("B", "pin_B"), ("C", "pin_C"), ("D", "pin_D")):
        for side in ("low", "high"):
            assert gaps[frozenset((pin, f"bushing_{joint}_{side}"))].gap == pytest.approx(0.1e-3, abs=0.02e-3)
    assert gaps[frozenset(("washer_B", "bushing_B_low"))].gap == pytest.approx(0.4e-3, abs=1e-6)


def test_the_clearance_stage_writes_its_proof_and_then_has_nothing_to_do(
    roots: tuple[Path, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copytree(roots[0] / "four_bar", tmp_path / "four_bar")
    monkeypatch.setenv("MBSD_OUT", str(tmp_path))
    out = Out("four_bar")
    write_motion(out.motion, four_bar_motion())
    clearance_stage.run("four_bar")
    assert "none touch; nearest pin_" in capsys.readouterr().out
    first = out.clearance.read_bytes()
    assert read_clearance(out.clearance).pairs[0].proven > 0.05e-3
    clearance_stage.run("four_bar")
    assert capsys.readouterr().out == "clearance: four_bar: nothing to do\n"
    out.clearance.unlink()
    clearance_stage.run("four_bar")
    assert out.clearance.read_bytes() == first
    write_motion(out.motion, four_bar_motion(speed=1.0))
    clearance_stage.run("four_bar")
    assert "none touch" in capsys.readouterr().out


@pytest.mark.parametrize(("layers", "victim"), [(-1, "crank"), (1, "rocker")])
def test_a_coupler_on_the_wrong_layer_collides(
    pieces: dict[str, MeshPiece], parts: Parts, layers: int, victim: str
) -> None:
    """The stage says which parts, when and how deep."""
    shifted = [
        replace(piece, triangles=piece.triangles + np.array([0.0, 0.0, 9.8 * layers]))
        if piece.body == "coupler"
        else piece
        for piece in pieces.values()
    ]
    with pytest.raises(UserError, match=r"four_bar: .* collide: deepest at t=.* s by .* mm") as caught:
        check(parts, four_bar_motion(), shifted, "key")
    assert "coupler" in str(caught.value)
    assert victim in str(caught.value)


def test_a_file_that_was_swapped_is_noticed(roots: tuple[Path, Path], parts: Parts, tmp_path: Path) -> None:
    for path in (roots[0] / "four_bar" / "parts").iterdir():
        (tmp_path / path.name).write_bytes(path.read_bytes())
    (tmp_path / "crank.stl").write_bytes((tmp_path / "rocker.stl").read_bytes())
    with pytest.raises(UserError, match=r"crank\.stl is not the file that parts\.json describes"):
        read_pieces(parts, tmp_path)
