"""The join of finished films: clips, titles, words and sound."""

from __future__ import annotations

import io
import re
import subprocess
import wave
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING

from render.film.story.frame import Caption
from render.film.story.words import captions_of, srt
from render.frames import encode
from render.frames.encode import AAC, ffmpeg, refuse_other_than, run_ffmpeg
from render.presets import Preset
from render.showreel import card
from render.showreel.card import Title
from shared.stage.console import say
from shared.stage.errors import UserError
from shared.stage.files import whole_file, write_bytes

if TYPE_CHECKING:
    from PIL.Image import Image


# A finished film as the showreel takes it: its packets and the parameters that its neighbours must share.

CLIP_PATIENCE = 600.0
"""Seconds in which ffmpeg has to read a film."""


@dataclass(frozen=True)
class Parameters:
    """Parameters that players take from the first film of a joined file and use for all."""

    codec: str
    size: str
    tick: str
    """Seconds of a tick of its times, as a fraction."""
    header: str
    """SHA-256 of the codec's own parameters: profile, level, colours, reference frames."""


@dataclass(frozen=True)
class Clip:
    """One film."""

    path: Path
    parameters: Parameters
    frames: int
    fps: int
    packets: tuple[str, ...]
    """SHA-256 of each compressed frame, in the order of the file."""


def read_clip(path: Path) -> Clip:
    """Read a film without decoding it. Raises UserError if it is not one."""
    command = [ffmpeg(), "-v", "error", "-i", str(path)]
    command += ["-map", "0:v:0", "-c", "copy", "-f", "framehash", "-hash", "sha256", "-"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=CLIP_PATIENCE)
    except subprocess.TimeoutExpired:
        raise UserError(f"{path}: ffmpeg did not read it within {CLIP_PATIENCE:.0f} s; run it again") from None
    words = dict(re.findall(r"^#(tb|codec_id|dimensions) 0: (\S+)$", done.stdout, re.MULTILINE))
    header = re.search(r"^#extradata 0,\s*\d+,\s*(\w+)$", done.stdout, re.MULTILINE)
    rows = [re.split(r",\s*", line) for line in done.stdout.splitlines() if line and not line.startswith("#")]
    if done.returncode or not rows or len(words) < 3 or not header:
        said = (done.stderr.strip().splitlines() or ["it has no pictures"])[-1]
        raise UserError(f"{path} is not a film ({said}); remove it and make it again")
    rate = 1 / (Fraction(words["tb"]) * max(1, int(rows[0][3])))
    return Clip(
        path=path,
        parameters=Parameters(words["codec_id"], words["dimensions"], words["tb"], header[1]),
        frames=len(rows),
        fps=max(1, round(rate)),
        packets=tuple(row[-1] for row in rows),
    )


# The subtitles of a showreel: those of its films, each later by where its film begins.


def write_subtitles(films: Sequence[Path], chapters: Sequence[Sequence[Clip]], fps: int, target: Path) -> bool:
    """Write the captions of ``films`` as a SubRip file; False, and no file, if none of them has any.

    Each film is the last clip of its chapter.
    """
    captions: list[Caption] = []
    frames = 0
    for film, clips in zip(films, chapters, strict=True):
        frames += sum(clip.frames for clip in clips)
        end, long = frames / fps, clips[-1].frames / fps
        captions += [
            Caption(end - long + caption.start, min(end - long + caption.end, end), caption.text)
            for caption in captions_beside(film)
            if caption.start < long
        ]
    if not captions:
        target.unlink(missing_ok=True)
        return False
    write_bytes(target, srt(captions).encode())
    return True


def captions_beside(film: Path) -> list[Caption]:
    """Return the captions of the subtitle file beside a film; none where there is no such file.

    Raises UserError for a file that is not SubRip.
    """
    path = film.with_suffix(".srt")
    if not path.is_file():
        return []
    try:
        return captions_of(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise UserError(f"{path} is not a subtitle file ({error}); remove it and make the film again") from error


# The sound of a showreel: that of its films under their pictures, and silence under titles and silent films.

RATE, FRAME = 48_000, 4
"""Samples a second; bytes of one, of two channels of 16 bits."""


def write_sound(row: Sequence[Clip], fps: int, target: Path) -> bool:
    """Write the sound of clips in a row as a WAV file; False, and no file, where none of them has any."""
    sounds = [_samples(clip) for clip in row]
    if not any(sounds):
        return False
    frames = 0
    with wave.open(str(target), "wb") as file:
        file.setnchannels(2)
        file.setsampwidth(2)
        file.setframerate(RATE)
        for clip, sound in zip(row, sounds, strict=True):
            first, last = (round(count / fps * RATE) for count in (frames, frames + clip.frames))
            long = (last - first) * FRAME
            file.writeframes(sound[:long].ljust(long, b"\0"))
            frames += clip.frames
    return True


def _samples(clip: Clip) -> bytes:
    """Return the samples of a film; empty of one without a sound."""
    command = [ffmpeg(), "-v", "error", "-i", str(clip.path), "-map", "0:a:0?", "-ac", "2", "-ar", str(RATE)]
    done = subprocess.run([*command, "-f", "s16le", "-"], capture_output=True, timeout=CLIP_PATIENCE)
    return done.stdout if done.returncode == 0 else b""


# Films and titles as one file: copied where their parameters are the same, encoded anew where they are not.

PATIENCE = 3600.0
"""Seconds for ffmpeg to join or encode one film."""


@dataclass(frozen=True)
class Entry:
    """A film of the showreel; ``has_title`` of one that begins with its own."""

    path: Path
    title: Title
    has_title: bool = False


def join(films: Sequence[Entry], preset: Preset, target: Path, scratch: Path) -> list[Clip]:
    """Write ``target`` from films under their titles, with chapters and subtitles, and return its clips.

    The clips are in order; subtitles stand beside it as .srt. The films' most frequent rate is that of all. Raises
    UserError naming the film that does not decode.
    """
    for film in films:
        captions_beside(film.path)  # refused now, not after the films are joined
    clips = [read_clip(film.path) for film in films]
    fps = Counter(clip.fps for clip in clips).most_common(1)[0][0]
    chapters: list[list[Clip]] = []
    for number, (clip, film) in enumerate(zip(clips, films, strict=True)):
        place = scratch / f"{number:04d}"
        first = _first_picture(film.path).resize((preset.width, preset.height))
        title = card.pictures(first, film.title, fps)
        encode.encode(title, card.number(fps), preset, fps, place.with_suffix(".title.mp4"))
        head = read_clip(place.with_suffix(".title.mp4"))
        if clip.parameters != head.parameters:
            say("showreel", f"{film.path.name}: encoded again, {_difference(clip, head)}")
            clip = _encoded_anew(clip, preset, fps, place.with_suffix(".film.mp4"))
        chapters.append([clip] if film.has_title else [head, clip])
    row = [clip for chapter in chapters for clip in chapter]
    _refuse_unlike(row)
    with whole_file(target) as part:
        _concatenate(chapters, [film.title for film in films], part, scratch)
        _check(row, [film.path for film in films], part, target.name, preset, fps)
    write_subtitles([film.path for film in films], chapters, fps, target.with_suffix(".srt"))
    return row


def _difference(clip: Clip, other: Clip) -> str:
    """Return why a film cannot be copied, in words."""
    ours, two = clip.parameters, other.parameters
    if clip.fps != other.fps:
        return f"{clip.fps} frames a second, not {other.fps}"
    if ours.size != two.size:
        return f"{ours.size} pixels, not {two.size}"
    return "its encoder had other settings"


def _encoded_anew(clip: Clip, preset: Preset, fps: int, target: Path) -> Clip:
    """Return the film at this size and rate."""
    wide, high = preset.width, preset.height
    fit = f"fps={fps},scale={wide}:{high}:force_original_aspect_ratio=decrease:flags=lanczos"
    fit += f",pad={wide}:{high}:(ow-iw)/2:(oh-ih)/2,setsar=0"
    settings = list(encode.SETTINGS)
    at = settings.index("-vf") + 1
    settings[at] = f"{fit},{settings[at]}"
    run_ffmpeg(
        clip.path.name,
        "-i",
        str(clip.path),
        "-map",
        "0:v:0",
        "-map",
        "0:a:0?",
        *settings,
        "-c:a",
        "copy",
        str(target),
        patience=PATIENCE,
    )
    return read_clip(target)


def _refuse_unlike(row: Sequence[Clip]) -> None:
    for clip in row:
        if clip.parameters != row[0].parameters:
            raise UserError(
                f"{clip.path.name}: its parameters differ from its neighbours', even after it was encoded again; "
                "remove it and make the film again"
            )


def _concatenate(parts: Sequence[Sequence[Clip]], titles: Sequence[Title], target: Path, scratch: Path) -> None:
    """Join the films by ffmpeg's concat demuxer, which copies packets, with chapters for players.

    Sound is encoded anew. Films go in without theirs, whose first packet begins 21 ms early: so much later the demuxer
    would show the pictures.
    """
    listing, chapters, at = ["ffconcat version 1.0"], [";FFMETADATA1"], 0
    row = [clip for clips in parts for clip in clips]
    for k, clip in enumerate(row):
        pictures = scratch / f"pictures-{k:04d}.mp4"
        only = ["-i", str(clip.path), "-map", "0:v:0", "-c", "copy", "-map_chapters", "-1", "-fflags", "+bitexact"]
        run_ffmpeg(clip.path.name, *only, str(pictures), patience=PATIENCE)
        listing.append(f"file '{_quoted(pictures.resolve())}'")
        listing.append(f"duration {clip.frames / clip.fps:.9f}")
    for clips, title in zip(parts, titles, strict=True):
        frames = sum(clip.frames for clip in clips)
        chapters += ["[CHAPTER]", f"TIMEBASE=1/{row[0].fps}", f"START={at}", f"END={at + frames}"]
        chapters.append(f"title={_escaped(title.name)}")
        at += frames
    (scratch / "list.txt").write_text("\n".join(listing) + "\n")
    (scratch / "chapters.txt").write_text("\n".join(chapters) + "\n")
    sound, heard = scratch / "sound.wav", write_sound(row, row[0].fps, scratch / "sound.wav")
    inputs = ["-f", "concat", "-safe", "0", "-auto_convert", "0", "-i", str(scratch / "list.txt")]
    inputs += ["-i", str(scratch / "chapters.txt"), *(["-i", str(sound)] if heard else [])]
    streams = ["-map", "0:v:0", *(["-map", "2:a:0", *AAC] if heard else [])]
    run_ffmpeg(
        target.name,
        *(*inputs, *streams, "-map_metadata", "1", "-map_chapters", "1", "-c:v", "copy"),
        *("-movflags", "+faststart", "-fflags", "+bitexact", str(target)),
        patience=PATIENCE,
    )


def _check(row: Sequence[Clip], films: Sequence[Path], part: Path, name: str, preset: Preset, fps: int) -> None:
    """Raise UserError naming the film whose packets are not in order or whose frames do not decode."""
    count = sum(clip.frames for clip in row)
    try:
        refuse_other_than(part, name, encode.ffmpeg(), count, preset, fps, PATIENCE)
    except UserError:
        for path in films:
            _first_picture(path, whole=True)
        raise
    if read_clip(part).packets != tuple(packet for clip in row for packet in clip.packets):
        raise UserError(f"{name}: not every packet of the films was copied; run it again")


def _first_picture(film: Path, whole: bool = False) -> Image:
    """Return the first picture.

    ``whole``: the film is decoded to its end. Raises UserError naming the film if that fails.
    """
    from PIL import Image

    command = [encode.ffmpeg(), "-v", "error", *["-xerror"] * whole, "-i", str(film)]
    command += ["-map", "0:v:0", "-frames:v", "1", "-f", "image2pipe", "-c:v", "png", "-"]
    command += ["-map", "0:v:0", "-f", "null", "-"] * whole
    done = subprocess.run(command, capture_output=True, timeout=PATIENCE)
    try:
        picture = Image.open(io.BytesIO(done.stdout)).convert("RGB")
        if whole and (done.returncode or done.stderr.strip()):
            raise ValueError
        return picture
    except (OSError, SyntaxError, ValueError) as error:
        said = done.stderr.decode(errors="replace").strip().splitlines()
        reason = said[-1] if said else "it has no picture"
        raise UserError(f"{film}: the film does not decode ({reason}); remove it and make it again") from error


def _quoted(path: Path) -> str:
    return str(path).replace("'", r"'\''")


def _escaped(words: str) -> str:
    """Return the text escaped for ffmpeg's metadata files."""
    return "".join(f"\\{letter}" if letter in "=;#\\\n" else letter for letter in words)
