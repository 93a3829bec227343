"""Parts that take long: what is finished is kept, a refusal is remembered, and what is left is shown."""

from __future__ import annotations

from pathlib import Path

import pytest

from mechanisms.stages.parts import bodies, memory
from mechanisms.stages.parts import stage as parts_stage
from mechanisms.stages.parts_files import stl_bytes
from shared.stage import console
from shared.stage.errors import UserError
from shared.stage.paths import Out
from tests.mechanisms.printed_pieces import Press, solids


@pytest.fixture
def press(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Press:
    monkeypatch.setenv("MBSD_OUT", str(tmp_path))
    return Press(monkeypatch)


def meshed(monkeypatch: pytest.MonkeyPatch, stop_after: int | None = None) -> list[object]:
    """Yield the list of pieces meshed from now on; after so many pieces the user stops it."""
    made: list[object] = []

    def counting(shape: object, tolerance: float | None = None) -> bytes:
        if len(made) == stop_after:
            raise KeyboardInterrupt
        made.append(shape)
        return stl_bytes(shape, tolerance)

    monkeypatch.setattr("mechanisms.stages.parts_files.stl_bytes", counting)
    return made


def test_a_stopped_stage_goes_on_from_there(press: Press, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory.KeptPieces.__init__, "__defaults__", (0.0,))
    total = sum(map(len, solids().values()))
    meshed(monkeypatch, stop_after=7)
    with pytest.raises(KeyboardInterrupt):
        press.make()
    folder = press.out.folder / ".pieces"
    assert len(list(folder.iterdir())) == 7
    assert not press.out.parts.is_file()
    again = meshed(monkeypatch)
    press.make()
    assert len(again) == total - 7
    assert not folder.exists()


def test_kept_pieces_are_those_that_are_made(press: Press, monkeypatch: pytest.MonkeyPatch) -> None:
    press.make()
    plain = {path.name: path.read_bytes() for path in press.out.parts_folder.iterdir()}
    monkeypatch.setattr(memory.KeptPieces.__init__, "__defaults__", (0.0,))
    monkeypatch.setattr(memory.KeptPieces, "clear", lambda self: None)
    for _ in range(2):
        press.out.parts.unlink()
        press.make()
    assert {path.name: path.read_bytes() for path in press.out.parts_folder.iterdir()} == plain


def test_a_damaged_piece_is_made_again(press: Press, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory.KeptPieces.__init__, "__defaults__", (0.0,))
    meshed(monkeypatch, stop_after=3)
    with pytest.raises(KeyboardInterrupt):
        press.make()
    for kept in (press.out.folder / ".pieces").iterdir():
        kept.write_bytes(kept.read_bytes()[:1000])
    again = meshed(monkeypatch)
    press.make()
    assert len(again) == sum(map(len, solids().values()))


def test_parts_that_end_soon_write_nothing_twice(press: Press, monkeypatch: pytest.MonkeyPatch) -> None:
    meshed(monkeypatch, stop_after=7)
    with pytest.raises(KeyboardInterrupt):
        press.make()
    assert not (press.out.folder / ".pieces").exists()


class Refusing:
    """parts() of four_bar that refuses, and how often it ran."""

    def __init__(self, press: Press, words: str = "four_bar: no order of layers") -> None:
        self.runs, self.words = 0, words
        press.parts = self

    def __call__(self) -> dict[str, list[object]]:
        self.runs += 1
        raise UserError(self.words)


def test_a_refusal_that_took_long_is_not_looked_for_again(press: Press, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, "LONG", 0.0)
    refusing = Refusing(press)
    with pytest.raises(UserError, match=r"^four_bar: no order of layers$"):
        press.make()
    with pytest.raises(
        UserError, match=r"nothing has changed since this was found; make parts-four-bar ANYWAY=1 looks"
    ):
        press.make()
    assert refusing.runs == 1
    with pytest.raises(UserError, match=r"^four_bar: no order of layers$"):
        parts_stage.run("four_bar", anyway=True)
    assert refusing.runs == 2


def test_a_change_is_looked_at_anew(press: Press, monkeypatch: pytest.MonkeyPatch) -> None:
    """Another density, as another parameter or file, is in the key; and parts that are made end it."""
    monkeypatch.setattr(memory, "LONG", 0.0)
    refusing = Refusing(press)
    with pytest.raises(UserError):
        press.make()
    with monkeypatch.context() as other:
        other.setattr(parts_stage, "PACKAGES", ("numpy",))
        with pytest.raises(UserError, match=r"^four_bar: no order of layers$"):
            press.make()
    assert refusing.runs == 2
    press.parts = solids
    parts_stage.run("four_bar", anyway=True)
    assert not list(Out("four_bar").stamps.glob("*refused*"))


def test_quick_refusals_and_those_of_the_disk_are_tried_again(press: Press, monkeypatch: pytest.MonkeyPatch) -> None:
    soon = Refusing(press)
    for _ in range(2):
        with pytest.raises(UserError, match=r"^four_bar: no order of layers$"):
            press.make()
    assert soon.runs == 2
    monkeypatch.setattr(memory, "LONG", 0.0)
    full = Refusing(press, "cannot write x: free some disk space")
    for _ in range(2):
        with pytest.raises(UserError, match=r"space$"):
            press.make()
    assert full.runs == 2


def test_a_model_and_its_machine_are_made_side_by_side(press: Press) -> None:
    """Solids of an author become smaller as they are; a second scale and the machine stay what they were."""
    press.make()
    machine = press.out.parts.read_bytes()
    for scale in ("1:2", "1:4"):
        parts_stage.run("four_bar", scale=scale)
    assert press.out.parts.read_bytes() == machine
    masses = [described_masses(text) for text in ("", "1:2", "1:4")]
    assert masses[1] == pytest.approx(masses[0] / 8, rel=1e-6)
    assert masses[2] == pytest.approx(masses[0] / 64, rel=1e-6)


def described_masses(text: str) -> float:
    """The mass of the crank's pieces."""
    from shared.contract import read_parts
    from shared.stage.scale import scale_of

    return read_parts(Out("four_bar", scale_of(text)).parts).bodies["crank"].mass.mass


def test_a_model_is_made_once(press: Press, capsys: pytest.CaptureFixture[str]) -> None:
    parts_stage.run("four_bar", scale="1:2")
    parts_stage.run("four_bar", scale="0.5")
    assert capsys.readouterr().out.splitlines()[-1] == "parts: four_bar at 1:2: nothing to do"


def test_long_stages_show_the_time_that_is_left(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    now = [0.0]
    monkeypatch.setattr(console.time, "monotonic", lambda: now[0])
    shown = console.Shown("parts", "walker", 20, "solids written")
    for _ in range(20):
        now[0] += 2.0
        shown.advance("a note")
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "parts: walker: 3 of 20 solids written, 6.0 s so far (a note)"
    assert lines[1] == "parts: walker: 6 of 20 solids written, 12 s so far, about 28 s left (a note)"
    assert 5 <= len(lines) <= 7
    soon = console.Shown("parts", "four_bar", 2, "solids written")
    for _ in range(2):
        now[0] += 2.0
        soon.advance()
    assert capsys.readouterr().out == ""


def test_the_stage_describes_a_piece_by_its_shape_alone(tmp_path: Path) -> None:
    """Two shapes that are made alike have one key; a moved one and another name have others."""
    kept = memory.KeptPieces(tmp_path, "program")
    plate, screw, *_ = solids()["ground"]
    same = solids()["ground"][0]
    keys = [kept.key(piece.shape.solids().vals()[0], piece, False) for piece in (plate, same)]
    assert keys[0] == keys[1]
    assert kept.key(screw.shape.solids().vals()[0], screw, False) not in keys
    assert bodies.described_body("m", "ground", [plate], {}, None, kept=kept).mass.mass > 0
