"""Verification of one mechanism: everything rebuilt in scratch, compared and reported.

What the author's files give (solids, motion, shot), plates, outlines and files for other programs are made by the same
stages, frames and film by the same code, all in fresh processes; nothing that is there is touched.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections import Counter
from contextlib import suppress
from functools import partial
from pathlib import Path

from render.blender.process import scratch_folder
from render.film.inputs import named
from render.frames.film import wav_of, write_sound
from render.frames.store import FrameIndex, FrameStore
from render.presets import Preset
from shared.contract.quantity import counted
from shared.stage.console import fail, say
from shared.stage.errors import UserError
from shared.stage.face import to_run
from shared.stage.paths import ROOT, Out, out_root
from studio.verify import again, files, film, products
from studio.verify.files import Finding


def run(name: str, preset: Preset, frames: str = "", show: str = "") -> int:
    """Compare, print each finding, and return 1 if anything differs.

    Raises UserError if there is nothing to compare.

    ``frames``: numbers such as ``0,30``; three frames of the film if empty.
    """
    out = Out(name)
    if not out.motion.is_file():
        raise UserError(f"{out.name}: {out.motion} does not exist; {to_run('run', out.name)} first")
    home = out_root() / ".verify"
    try:
        with scratch_folder(home) as scratch:
            findings = _compared(out, preset, frames, show, scratch)
    finally:
        with suppress(OSError):
            home.rmdir()  # unless another run uses it
    for finding in findings:
        (say if finding.verdict in ("same", "missing") else _complain)("verify", f"{out.name}: {finding}")
    return _sum(out.name, findings)


def _compared(out: Out, preset: Preset, frames: str, show: str, scratch: Path) -> list[Finding]:
    store = FrameStore(out.frames(preset.name))
    index = film.index_of(store)
    wanted = film.chosen(frames, len(index.frames), out.name) if index else []  # reported before the work
    root = scratch / "out"
    solids = out.parts.is_file()
    for stage in (
        ("parts", "solve", "shot") if solids else ("solve",)
    ):  # masses are those of solids, where there are some
        _stage(root, "mechanisms", stage, out.name)
    made = root / out.name
    findings = [_of_parts(out, made)] if solids else [Finding("solids", "missing", "there are none")]
    for what, path in (("motion", out.motion), ("skeleton", out.skeleton), ("shot", out.shot)):
        if path.is_file() and (solids or path != out.shot):
            findings.append(files.compare(f"{what} ({path.name})", path, made / path.name))
    again_in = partial(_stage, root)
    findings += [*(products.of_print(out, made, again_in) if solids else []), *products.of_exports(out, made, again_in)]
    if index is None or not solids:
        hint = f"{to_run('film', out.name)} {preset.request} first"
        return [*findings, Finding("frames and film", "missing", f"none of {preset.name} are there; {hint}")]
    return [*findings, *_of_pictures(out, preset, index, wanted, show, scratch)]


def _of_pictures(
    out: Out, preset: Preset, index: FrameIndex, wanted: list[int], show: str, scratch: Path
) -> list[Finding]:
    root, store = scratch / "out", FrameStore(out.frames(preset.name))
    _stage(root, "studio.verify.again", out.name, again.preset_words(preset), ",".join(map(str, wanted)), show)
    made = FrameStore(root / out.name / "frames" / preset.name)
    findings = [film.compare_frame(frame, index.frames[frame], store, made) for frame in wanted]
    there = named(out.film(preset.name), show)
    sound = wav_of(there)
    if not sound.is_file():
        return [*findings, film.compare_film(there, scratch, store, index, preset)]
    what = f"sound ({sound.name})"
    try:
        heard = write_sound(out, preset, show, scratch / sound.name)
    except UserError as error:
        findings.append(Finding(what, "differs", f"it cannot be rebuilt: {error}"))
        return [*findings, film.compare_film(there, scratch, store, index, preset)]
    findings.append(files.compare(what, sound, heard))
    return [*findings, film.compare_film(there, scratch, store, index, preset, heard)]


def _of_parts(out: Out, again: Path) -> Finding:
    """Compare parts.json and all STL and STEP files; return one finding, of the first difference."""
    described = files.compare("parts.json", out.parts, again / "parts" / "parts.json")
    if described.verdict != "same":
        return Finding(f"solids ({described.what})", described.verdict, described.detail)
    here, there = out.parts_folder, again / "parts"
    names = sorted({path.name for folder in (here, there) for path in folder.glob("*.st[el]*")})
    findings = [files.compare(name, here / name, there / name) for name in names]
    wrong = [finding for finding in findings if finding.verdict != "same"]
    if wrong:
        detail = f"{len(wrong)} of {counted(len(findings), 'file')}, such as {wrong[0].what} {wrong[0].detail}"
        return Finding("solids (STL, STEP)", "differs", detail)
    return Finding("solids (parts.json, STL, STEP)", "same", counted(len(findings) + 1, "file"))


def _stage(root: Path, module: str, *arguments: str) -> None:
    """Run a stage as a process with its results below ``root``; raises UserError if it fails."""
    command = [sys.executable, "-m", module, *arguments]
    done = subprocess.run(command, cwd=ROOT, env=os.environ | {"MBSD_OUT": str(root)})
    if done.returncode:
        raise UserError(f"{' '.join(command[2:])}: ended with code {done.returncode}; its error is above")


def _complain(_: str, text: str) -> None:
    fail(text)


def _sum(name: str, findings: list[Finding]) -> int:
    """Print the last line and return the exit code."""
    counts = Counter(finding.verdict for finding in findings)
    words = [f"{counts['same']} the same"]
    if counts["missing"]:
        words.append(f"{counts['missing']} not compared")
    if counts["outdated"]:
        words.append(f"{counts['outdated']} made from other inputs: {to_run('run', name)}, then again")
    if counts["differs"]:
        words.append(f"{counts['differs']} different")
    say("verify", f"{name}: {', '.join(words)}")
    return int(bool(counts["differs"] or counts["outdated"]))
