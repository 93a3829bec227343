"""The showreel: films are copied packet by packet, titles stand before them, what differs is encoded anew and told."""

from __future__ import annotations

import io
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageDraw

from render import freshness
from render.film.story.frame import Caption
from render.film.story.words import captions_of, srt
from render.frames import encode
from render.presets import Preset
from render.showreel import card, join, showreel
from render.showreel.card import Title
from render.showreel.join import read_clip
from render.sound.sound import wav
from shared.stage.errors import UserError
from shared.stage.paths import Out
from shared.stage.stages import Stage, key_of

TINY = Preset("tiny", 128, 72, 1)


def film(folder: Path, name: str, count: int, fps: int = 30, size: tuple[int, int] = (128, 72)) -> Path:
    """A ball that rolls."""
    path = folder / "films" / f"{name}-tiny.mp4"
    path.parent.mkdir(parents=True, exist_ok=True)
    content = []
    for k in range(count):
        page = Image.new("RGB", size, (20, 40, 70))
        ImageDraw.Draw(page).ellipse((3 * k, 20, 3 * k + 30, 50), fill=(250, 160, 60))
        buffer = io.BytesIO()
        page.save(buffer, format="PNG")
        content.append(buffer.getvalue())
    encode.encode(content, count, Preset("tiny", *size, 1), fps, path)
    return path


def test_films_are_joined(out_root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    first, second = film(out_root, "four_bar", 20), film(out_root, "pendulum", 33)
    other = film(out_root, "jansen_leg", 24, fps=24, size=(64, 64))
    variant = film(out_root, "chain-three", 11)
    target = showreel.run(TINY)
    said = capsys.readouterr().out
    assert "left out, since they have no film of tiny: belt_drive, " in said
    assert "jansen_leg-tiny.mp4: encoded again, 24 frames a second, not 30" in said
    assert "3 films copied as they are, 1 encoded again" in said
    reel, title = read_clip(target), card.number(30)
    assert reel.frames == 4 * title + 11 + 20 + 30 + 33
    at = title
    for path, frames in ((variant, 11), (first, 20), (other, 30), (second, 33)):
        packets = reel.packets[at : at + frames]
        assert (packets == read_clip(path).packets) is (path != other)  # as they are, in alphabetical order
        at += frames + title
    listing = subprocess.run([encode.ffmpeg(), "-i", str(target)], capture_output=True, text=True).stderr
    assert re.findall(r"title\s*: (.*)", listing) == ["Chain: three", "Four bar", "Jansen leg", "Pendulum"]
    assert "start 2.966667, end 6.233333" in listing  # a chapter begins with its title
    assert sorted(path.name for path in out_root.iterdir()) == ["films"]
    before = target.read_bytes()
    assert showreel.run(TINY).read_bytes() == before  # same films, same bytes; it is no film of its own


def test_only_some_in_their_order(out_root: Path) -> None:
    first, second = film(out_root, "four_bar", 9), film(out_root, "pendulum", 7)
    target = showreel.run(TINY, "pendulum, four-bar")
    title = card.number(30)
    assert read_clip(target).packets[title : title + 7] == read_clip(second).packets
    assert read_clip(target).packets[-9:] == read_clip(first).packets


def test_films_of_older_versions_are_left_out(
    out_root: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """They were joined beside new ones without a word."""
    monkeypatch.setattr(freshness, "current_names", set)
    for name in ("four_bar", "pendulum"):
        out, path = Out(name), film(out_root, name, 5)
        out.folder.mkdir()
        out.motion.write_text("as it was filmed")
        Stage(out, "film-tiny", key_of(out.motion), [path]).record()
    Out("pendulum").motion.write_text("solved again")
    showreel.run(TINY)
    said = capsys.readouterr()
    assert "pendulum-tiny.mp4 is left out, being of an older version: it is of an older data.json" in said.err
    assert "1 film of" in said.out
    with pytest.raises(UserError, match="requested films are older"):
        showreel.run(TINY, "pendulum")
    monkeypatch.setattr(freshness, "current_names", lambda names: {"pendulum"})
    with pytest.raises(UserError, match="requested films are older"):
        showreel.run(TINY, "four-bar")
    assert "the machine has changed since it was solved" in capsys.readouterr().err


def test_films_are_heard_under_their_pictures(out_root: Path) -> None:
    film(out_root, "pendulum", 10)
    path = film(out_root, "four_bar", 30)
    silent, t = path.rename(path.with_suffix(".silent.mp4")), np.arange(48_000) / 48_000
    tone = 0.3 * np.sin(2 * np.pi * 500 * t)
    path.with_suffix(".wav").write_bytes(wav(np.stack([tone, tone])))
    encode.mux(silent, path.with_suffix(".wav"), 30, TINY, 30, path)
    silent.unlink()
    target = showreel.run(TINY, "pendulum,four_bar")
    command = [encode.ffmpeg(), "-v", "error", "-i", str(target), "-map", "0:a:0", "-f", "s16le", "-"]
    heard = np.frombuffer(subprocess.run(command, capture_output=True, check=True).stdout, "<i2")[::2] / 32768
    first = (2 * card.number(30) + 10) * 1600
    assert len(heard) >= first + 48_000
    assert np.abs(heard[: first - 2400]).max() < 0.001
    assert np.abs(heard[first + 2400 : first + 45_600]).max() == pytest.approx(0.3, abs=0.02)
    title = card.number(30)
    assert read_clip(target).packets[-30:] == read_clip(path).packets
    assert read_clip(target).frames == 2 * title + 40
    assert shown_at(target) == [k / 30 for k in range(2 * title + 40)], "also where a film with sound begins"
    before = target.read_bytes()
    assert showreel.run(TINY, "pendulum,four_bar").read_bytes() == before


def test_films_have_their_captions_where_they_are(out_root: Path) -> None:
    """Two films are joined, and one of another rate is encoded again; one without a file has no captions."""
    film(out_root, "pendulum", 30)
    first = film(out_root, "four_bar", 60)
    other = film(out_root, "jansen_leg", 48, fps=24, size=(64, 64))
    first.with_suffix(".srt").write_text(srt([Caption(0.5, 1.25, "The crank turns."), Caption(1.5, 9.0, "It rests.")]))
    other.with_suffix(".srt").write_text(srt([Caption(0.25, 1.0, "A leg,\nof eight links"), Caption(2.5, 3, "late")]))
    target = showreel.run(TINY, "pendulum,four_bar,jansen_leg")
    title, words = card.number(30) / 30, captions_of(target.with_suffix(".srt").read_text())
    begin, then = 2 * title + 1.0, 3 * title + 3.0
    assert [caption.text for caption in words] == ["The crank turns.", "It rests.", "A leg,\nof eight links"]
    times = [(begin + 0.5, begin + 1.25), (begin + 1.5, begin + 2.0), (then + 0.25, then + 1.0)]
    assert [(caption.start, caption.end) for caption in words] == [pytest.approx(pair, abs=6e-4) for pair in times]
    listing = subprocess.run([encode.ffmpeg(), "-i", str(target)], capture_output=True, text=True).stderr
    starts = [float(start) for start in re.findall(r"start (\d+\.\d+), end", listing)]
    assert starts == pytest.approx([0.0, title + 1.0, 2 * title + 3.0], abs=1e-5), "a chapter for each film"


def test_subtitles_go_with_their_films_and_are_refused_before_any_is_joined(out_root: Path) -> None:
    first, second = film(out_root, "four_bar", 6), film(out_root, "pendulum", 6)
    first.with_suffix(".srt").write_text(srt([Caption(0.0, 0.1, "It turns.")]))
    target, chapters = out_root / "reel.srt", [[read_clip(first)], [read_clip(second)]]
    assert join.write_subtitles([first, second], chapters, 30, target)
    assert captions_of(target.read_text()) == [Caption(0.0, 0.1, "It turns.")]
    assert not join.write_subtitles([second], chapters[1:], 30, target)
    assert not target.exists(), "no words of films that are no longer in it"
    second.with_suffix(".srt").write_text("1\nsoon --> later\nIt swings.\n")
    with pytest.raises(UserError, match=r"pendulum-tiny\.srt is not a subtitle file .*'1 soon --> later It swings\.'"):
        showreel.run(TINY, "pendulum,four_bar")


def shown_at(path: Path) -> list[float]:
    """Seconds at which the pictures of a film are shown."""
    command = [encode.ffmpeg(), "-v", "error", "-i", str(path), "-map", "0:v:0", "-c", "copy", "-f", "framehash", "-"]
    said = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    ticks = int(re.findall(r"#tb 0: 1/(\d+)", said)[0])
    rows = [line.split(",") for line in said.splitlines() if not line.startswith("#")]
    return sorted(int(row[2]) / ticks for row in rows)


def test_missing_or_damaged_films_are_named(out_root: Path) -> None:
    with pytest.raises(UserError, match="there is no film of any mechanism at tiny; make film-belt-drive PRESET=tiny"):
        showreel.run(TINY)
    path = film(out_root, "four_bar", 20)
    with pytest.raises(UserError, match="there is no film of pendulum at tiny; make film-pendulum"):
        showreel.run(TINY, "four_bar,pendulum")
    content = path.read_bytes()
    start = content.index(b"mdat") + 700
    path.write_bytes(content[:start] + bytes(400) + content[start + 400 :])
    with pytest.raises(UserError, match=r"four_bar-tiny\.mp4: the film does not decode"):
        showreel.run(TINY)
    path.write_bytes(b"no film")
    with pytest.raises(UserError, match=r"four_bar-tiny\.mp4 is not a film .*; remove it and make it again"):
        showreel.run(TINY)
    assert [file.name for file in path.parent.iterdir()] == [path.name]


def test_a_title_leads_to_the_film() -> None:
    first = Image.effect_noise((160, 90), 80).convert("RGB")
    pages = [np.asarray(Image.open(io.BytesIO(page))) for page in card.pictures(first, Title("Crank", "It turns."), 30)]
    assert len(pages) == card.number(30) == 78
    middle = pages[39]
    assert middle.max() > 220  # the name
    assert middle.mean() < 0.5 * np.asarray(first).mean()
    assert np.array_equal(middle, pages[45])
    far = [np.abs(page.astype(int) - np.asarray(first)).mean() for page in pages[-14:]]
    assert far == sorted(far, reverse=True)
    assert far[-1] < 6
    few = list(card.pictures(first, Title("Crank"), 1))
    assert len(few) == card.number(1) == 3


@pytest.mark.parametrize(
    "words", ["Wheel", "A mechanism with a name that is far too long for one line of a title " * 2]
)
def test_words_stay_inside(words: str) -> None:
    drawn = card._words((320, 180), Title(words, "It is said at length, over and over again. " * 20))[..., 3]
    assert drawn.any()
    edge = round(320 * card.LEFT * 0.9)
    assert not drawn[:, :edge].any()
    assert not drawn[:, -edge:].any()
    assert not drawn[-10:].any()
