"""A comparison of postage stamps, from its pictures to its sound: made once, silent where that is asked for."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from render.frames.encode import ffmpeg, refuse_other_than
from render.frames.story import comparison
from render.frames.story.comparison import pair_of
from render.presets import Preset
from shared.contract.shot import Shot
from tests.render.sound.heard import measured
from tools.fixtures import film_fixture

TINY = Preset("draft-tiny", 96, 54, 1)


def test_it_has_both_pictures_and_both_sounds(out_root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    outs = [film_fixture.write(Shot(seconds_per_turn=0.3), name=name) for name in ("v_twin", "v_twin-bank_45")]
    comparison.run("v_twin", TINY)
    capsys.readouterr()
    film = outs[1].film("draft-tiny").with_stem("v_twin-bank_45-draft-tiny-compare")
    waves, subtitles = film.with_suffix(".wav"), film.with_suffix(".srt")
    listing = subprocess.run([ffmpeg(), "-i", str(film)], capture_output=True, text=True).stderr
    assert re.search(r"Audio: aac.*48000 Hz, stereo", listing)
    assert re.findall(r"title\s*: (.*)", listing) == ["V twin", "Title", "Side by side"]
    total = pair_of(outs, TINY, comparison.half(TINY)).tellings[0].story.total
    refuse_other_than(film, film.name, ffmpeg(), total, TINY, 30, 60.0)
    assert abs(measured(waves)[0] + 16.0) < 0.3
    content = film.read_bytes(), waves.read_bytes(), subtitles.read_bytes()

    comparison.run("v_twin", TINY)
    assert "nothing to do" in capsys.readouterr().out
    comparison.run("v_twin", TINY, "off")
    said = capsys.readouterr().out
    assert "silent" in said
    assert "to render" not in said
    assert not waves.exists()
    assert "Audio" not in subprocess.run([ffmpeg(), "-i", str(film)], capture_output=True, text=True).stderr
    comparison.run("v_twin", TINY)
    assert "to render" not in capsys.readouterr().out
    assert (film.read_bytes(), waves.read_bytes(), subtitles.read_bytes()) == content
