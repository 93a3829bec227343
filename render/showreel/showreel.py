"""The showreel: films in their order as out/films/showreel-<preset>.mp4, with its .srt."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

from render.blender.process import scratch_folder
from render.film.inputs import named
from render.frames.story.stage import film_of
from render.freshness import Freshness
from render.gallery import sentences
from render.presets import Preset
from render.report import description
from render.showreel.card import Title
from render.showreel.join import Entry, join
from shared.contract.quantity import counted
from shared.contract.shot import read_shot
from shared.stage.console import duration, say, warn
from shared.stage.errors import UserError
from shared.stage.face import to_run
from shared.stage.paths import Out, all_mechanisms, known_name, mechanism_file, out_root, variants_in
from shared.stage.stages import is_recorded

NAME = "showreel"
STORIES = ("explain", "loop")


def run(preset: Preset, only: str = "", show: str = "", story: str = "explain") -> Path:
    """Join the finished films of a preset in alphabetical order, or those of ``only`` in its order.

    Stories are joined where they exist, else loops; with ``story`` "loop" loops alone.

    Raises UserError if there is none, if one of ``only`` is missing, or if a film does not decode.
    """
    names = [known_name(word) for word in only.replace(",", " ").split()] or _all_names()
    if story not in STORIES:
        raise UserError(f"showreel: there is no STORY={story} of several mechanisms; there is: {', '.join(STORIES)}")
    there = {name: film for name in names if (film := _film(name, preset, show, story)).is_file()}
    freshness = Freshness(list(there))
    unknown = {name for name, film in there.items() if not is_recorded(Out(name), film)}
    if unknown:
        say(NAME, f"of no known version, as they were not made here: {', '.join(sorted(unknown))}")
    films = {
        name: film for name, film in there.items() if name in unknown or not _is_older(freshness, name, film, preset)
    }
    left = [name for name in names if name not in there]
    if only.strip() and len(films) < len(there):
        raise UserError("showreel: requested films are older than their machines, as said above; make them again")
    if not films or (only.strip() and left):
        wanted = ", ".join(left) if only.strip() else "any mechanism"
        remedy = f"{to_run('film', (left or ['<name>'])[0])} {preset.request}"
        raise UserError(f"showreel: there is no film of {wanted} at {preset.name}; {remedy}")
    if any("-" not in name for name in left):
        missing = [name for name in left if "-" not in name]  # a variant's film is one that somebody asked for
        say("showreel", f"left out, since they have no film of {preset.name}: {', '.join(missing)}")
    target = named(out_root() / "films" / f"{NAME}-{preset.name}.mp4", show)
    home = out_root() / f".{NAME}"
    say("showreel", f"{counted(len(films), 'film')} of {preset}, each under its title")
    try:
        with scratch_folder(home) as scratch:
            entries = [
                Entry(film, title_of(name), film != _loop(name, preset, show) and _has_title(name))
                for name, film in films.items()
            ]
            row = join(entries, preset, target, scratch)
    finally:
        with suppress(OSError):
            home.rmdir()
    seconds = sum(clip.frames for clip in row) / row[0].fps
    copied = sum(clip.path.parent == target.parent for clip in row)
    words = ", subtitles beside it" if target.with_suffix(".srt").is_file() else ""
    say(
        NAME,
        f"{target}: {duration(seconds)}, {counted(copied, 'film')} copied as they are, {len(films) - copied} "
        f"encoded again, {target.stat().st_size / 1e6:.1f} MB{words}",
    )
    return target


def _is_older(freshness: Freshness, name: str, film: Path, preset: Preset) -> bool:
    """Return True if a film shows the machine as it was, which is reported."""
    why = freshness.why_older(Out(name), film)
    if why:
        warn(
            NAME, f"{film.name} is left out, being of an older version: {why}; {to_run('film', name)} {preset.request}"
        )
    return bool(why)


def _film(name: str, preset: Preset, show: str, story: str) -> Path:
    """Return the story of a mechanism if it is made and asked for, else its loop."""
    explains = film_of(Out(name), preset.name, show)
    return explains if story == "explain" and explains.is_file() else _loop(name, preset, show)


def _has_title(name: str) -> bool:
    """Return True if the story of a mechanism begins with its title."""
    shots = read_shot(Out(name).shot).story.shots
    return shots is None or shots[0] == "title"


def _loop(name: str, preset: Preset, show: str) -> Path:
    return named(Out(name).film(preset.name), show)


def title_of(name: str) -> Title:
    """Return words for a mechanism or variant; what it is comes from mechanism.py."""
    owner, _, variant = name.partition("-")
    words = owner.replace("_", " ") + (f": {variant.replace('_', ' ')}" if variant else "")
    return Title(words[:1].upper() + words[1:], sentences(description(owner)))


def _all_names() -> list[str]:
    names = []
    for owner in all_mechanisms():
        variants = variants_in(mechanism_file(owner))
        names += [owner, *(f"{owner}-{variant}" for variant in variants)]
    return names
