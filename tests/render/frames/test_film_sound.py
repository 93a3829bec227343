"""A film with its sound: muxed, not rendered or encoded again; the same bytes; whole, whatever goes wrong."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

import msgspec
import numpy as np
import pytest

from render.frames import encode, film, frames
from render.presets import Preset
from shared.contract.shot import Shot, Sound, write_shot
from shared.stage.errors import UserError
from shared.stage.paths import ROOT, Out
from studio.verify.film import decoded
from tests.render.sound.heard import measured
from tools.fixtures import film_fixture

TINY = Preset("tiny", 96, 54, 2)
SHORT = Shot(turns=6, seconds_per_turn=0.2)


def refused(*_: object) -> None:
    raise AssertionError("made again")


@pytest.fixture
def made(out_root: Path) -> Out:
    out = film_fixture.write(SHORT)
    film.run("four_bar", TINY, sound="off")
    return out


def streams(path: Path) -> list[str]:
    said = subprocess.run([encode.ffmpeg(), "-hide_banner", "-i", str(path)], capture_output=True, text=True).stderr
    return [line.split(": ")[1].split(" ")[0] for line in said.splitlines() if "Stream #" in line]


def lag(path: Path, waves: bytes) -> int:
    """Samples by which the film's sound, as players decode it, comes after that of a WAV file."""
    command = [encode.ffmpeg(), "-v", "error", "-i", str(path), "-map", "0:a", "-f", "s16le", "-"]
    heard = np.frombuffer(subprocess.run(command, capture_output=True, check=True).stdout, "<i2")[::2]
    made = np.frombuffer(waves[44:], "<i2")[::2]
    n = len(made)
    alike = np.fft.irfft(np.fft.rfft(heard[:n].astype(float), 2 * n) * np.conj(np.fft.rfft(made.astype(float), 2 * n)))
    return int((np.argmax(alike) + n) % (2 * n) - n)


def test_a_silent_film_gets_its_sound_by_muxing_alone(
    made: Out, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    target = made.film("tiny")
    silent, pictures = target.read_bytes(), decoded(target)
    assert streams(target) == ["Video"]
    monkeypatch.setattr(frames, "render", refused)
    monkeypatch.setattr(encode, "encode", refused)
    film.run("four_bar", TINY)
    assert "with its sound" in capsys.readouterr().out
    with_sound, waves = target.read_bytes(), film.wav_of(target).read_bytes()
    assert streams(target) == ["Video", "Audio"]
    assert decoded(target) == pictures
    level, peak = measured(target)
    assert abs(level + 16.0) < 1.0
    assert peak < -1.0
    assert abs(lag(target, waves)) <= 48  # 1 ms

    film.run("four_bar", TINY)
    assert "nothing to do" in capsys.readouterr().out
    film.wav_of(target).write_bytes(waves[:-10])
    assert not film.is_fresh("four_bar", TINY)
    film.run("four_bar", TINY)
    assert film.wav_of(target).read_bytes() == waves
    assert target.read_bytes() == with_sound

    assert not film.is_fresh("four_bar", TINY, sound="off")
    film.run("four_bar", TINY, sound="off")
    assert target.read_bytes() == silent
    assert not film.wav_of(target).exists()
    film.run("four_bar", TINY, sound="on")
    assert target.read_bytes() == with_sound


def test_a_shot_that_silences_the_motor_costs_no_picture(made: Out, monkeypatch: pytest.MonkeyPatch):
    film.run("four_bar", TINY)
    before = film.wav_of(made.film("tiny")).read_bytes()
    quiet = msgspec.structs.replace(SHORT, sound=Sound(silent=("motor",)))
    write_shot(made.shot, quiet)
    monkeypatch.setattr(encode, "encode", refused)
    film.run("four_bar", TINY)
    assert film.wav_of(made.film("tiny")).read_bytes() != before


def test_a_film_of_before_gets_its_sound_without_a_frame_rendered(made: Out, monkeypatch: pytest.MonkeyPatch):
    """Its silent pictures are not kept beside the frames yet, so they are encoded once."""
    (made.frames("tiny") / "four_bar-tiny.mp4").unlink()
    monkeypatch.setattr(frames, "render", refused)
    film.run("four_bar", TINY)
    assert streams(made.film("tiny")) == ["Video", "Audio"]


def test_a_film_that_is_killed_while_it_is_muxed_goes_on_there(
    made: Out, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    target = made.film("tiny")
    silent = target.read_bytes()
    slow = tmp_path / "ffmpeg"
    slow.write_text('#!/bin/sh\nfor last; do :; done\necho part > "$last"\necho muxing >&2\nexec sleep 3\n')
    slow.chmod(0o755)
    code = f"from render.frames import encode, film; encode.ffmpeg = lambda: {str(slow)!r}; "
    code += "from render.presets import Preset; film.run('four_bar', Preset('tiny', 96, 54, 2))"
    with subprocess.Popen([sys.executable, "-c", code], cwd=ROOT, stdout=subprocess.DEVNULL) as process:
        end = time.monotonic() + 60
        while not list(target.parent.glob(".four_bar-tiny-*.mp4")):
            assert time.monotonic() < end
            time.sleep(0.02)
        process.kill()
    assert target.read_bytes() == silent
    monkeypatch.setattr(frames, "render", refused)
    monkeypatch.setattr(encode, "encode", refused)
    film.run("four_bar", TINY)
    assert streams(target) == ["Video", "Audio"]
    assert {path.name for path in target.parent.iterdir()} == {"four_bar-tiny.mp4", "four_bar-tiny.wav"}


def test_a_mux_that_fails_leaves_the_film_that_was_there(made: Out, monkeypatch: pytest.MonkeyPatch):
    target = made.film("tiny")
    silent = target.read_bytes()
    monkeypatch.setattr(encode, "SOUND_SETTINGS", ("-c:a", "no_such_encoder"))
    with pytest.raises(UserError, match=r"four_bar-tiny\.mp4: ffmpeg could not join pictures and sound: .*SOUND=off"):
        film.run("four_bar", TINY)
    assert target.read_bytes() == silent
    assert not film.is_fresh("four_bar", TINY)
    assert {path.name for path in target.parent.iterdir()} == {"four_bar-tiny.mp4", "four_bar-tiny.wav"}


def test_words_that_are_none_are_refused_before_anything_is_made(out_root: Path):
    out = film_fixture.write(msgspec.structs.replace(SHORT, sound=Sound(silent=("moter",))))
    with pytest.raises(UserError, match="SOUND='loud' is neither on nor off"):
        film.run("four_bar", TINY, sound="loud")
    with pytest.raises(
        UserError, match=r"four_bar: shot\.sound\.silent\[0\] names 'moter'.*known: .*motor.*did you mean"
    ):
        film.run("four_bar", TINY)
    assert not out.film("tiny").exists()
