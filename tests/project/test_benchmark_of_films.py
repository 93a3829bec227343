"""make bench-film: films in scratch, a plain script beside them, and a table whose rows are replaced one by one."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.film import measure
from benchmarks.film.runs import Film
from benchmarks.rows import Bar
from render.presets import Preset
from shared.contract.shot import Shot
from shared.stage.errors import UserError
from tools.fixtures import film_fixture

TINY = Preset("tiny", 96, 54, 1)


@pytest.mark.slow
def test_a_film_in_scratch_and_a_plain_script(out_root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("PYTHONUNBUFFERED", raising=False)  # which orders Blender's words and the script's
    out = film_fixture.write(Shot(trails=(), labels=()))
    film = Film("four_bar", TINY, 6, tmp_path / "scratch")
    assert film.run(only=[0, 2, 4]) > 0
    assert film.pictures() == 3
    assert not out.all_frames.exists()
    start, each = film.plain(1)
    assert 0 < each < 300
    assert 0 < start < 300
    assert (film.root / "plain" / "0000.png").is_file()


def test_mechanisms_without_a_film_are_not_measured(out_root: Path, tmp_path: Path) -> None:
    with pytest.raises(UserError, match="four_bar has no motion, parts or shot yet; make poster-four-bar"):
        Film("four_bar", TINY, 6, tmp_path)
    with pytest.raises(UserError, match="no mechanism has its film at tiny"):
        measure.noop("four_bar", TINY, 6, tmp_path)
    with pytest.raises(
        UserError, match="there is no row 'speed'; there is: overhead, plates, plain, resumed, cores, noop"
    ):
        measure.measured(["--only", "speed"])


def test_rows_are_replaced_by_what_they_are_of(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = tmp_path / "benchmarks.md"
    head = "| what | asked for | reached | against | settings | met |\n|---|---|---|---|---|---|"
    page.write_text(f"before\n{measure.BEGIN}\n{head}\n{measure.END}\nafter\n")
    monkeypatch.setattr(measure, "PAGE", page)
    measure._write([Bar("a run", 0.52, 0.51, "all", "short", True, most=True), Bar("two", 1.8, 1.5, "one", "x", False)])
    measure._write([Bar("a run", 0.52, 0.6, "all", "long", False, most=True)])
    rows = ["| a run | at most 0.52 | 0.6 | all | long | **no** |", "| two | 1.8x | 1.5x | one | x | **no** |"]
    assert page.read_text() == "\n".join(["before", measure.BEGIN, head, *rows, measure.END, "after\n"])
