"""The scene as a .blend that plays the motion, and Blender opened on it."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

from render.film.inputs import named, stage_key
from render.presets import Preset
from shared.contract.quantity import counted
from shared.stage.console import say
from shared.stage.errors import UserError
from shared.stage.face import to_run
from shared.stage.paths import Out
from shared.stage.stages import Stage

USUAL_PLACES = (
    "/Applications/Blender.app/Contents/MacOS/Blender",
    "~/Applications/Blender.app/Contents/MacOS/Blender",
    "/snap/bin/blender",
    "/var/lib/flatpak/exports/bin/org.blender.Blender",
    "/usr/local/bin/blender",
    "/opt/blender*/blender",
    "/usr/local/blender*/blender",
    "~/blender*/blender",
    "~/.local/bin/blender",
)


def save(name: str, preset: Preset, show: str = "") -> Path:
    """Return the stage: out/<mechanism>/<mechanism>.blend with the motion once on its timeline."""
    out = Out(name)
    target = named(out.scene, show, preset.suffix)
    stage = Stage(out, target.stem.replace(out.name, "scene", 1), stage_key(out, preset, show), [target])
    if stage.is_fresh():
        say("scene", f"{out.name}: {target}: nothing to do")
        return target
    from render.blender.child import blender
    from render.blender.job import Job
    from render.film.inputs import read_film

    film = read_film(out, show, preset.aspect)
    job = Job(
        scene=film.scene,
        states=[film.state(frame) for frame in range(film.clock.frames)],
        blend=str(target.resolve()),
        width=preset.width,
        height=preset.height,
        samples=preset.samples,
        motion_blur=preset.motion_blur,
    )
    try:
        with blender(job) as answers:
            for _ in answers:
                pass
    finally:
        for part in out.folder.glob(".*.part.blend*"):
            part.unlink(missing_ok=True)
    stage.record()
    say("scene", f"{out.name}: {target}: {counted(len(job.states), 'frame')}, {target.stat().st_size / 1e6:.1f} MB")
    return target


def open_in_blender(name: str, preset: Preset, show: str = "") -> None:
    """Save the scene and open it in an installed Blender; raises UserError if there is none."""
    program = find_blender()
    scene = save(name, preset, show)
    subprocess.Popen(
        [program, str(scene)], start_new_session=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    say("scene", f"{scene.name} opens in {program}")


def find_blender() -> str:
    """Return an installed Blender: $BLENDER, the PATH, then the usual places of Linux and macOS."""
    named = os.environ.get("BLENDER")
    if named:
        if os.access(named, os.X_OK):
            return named
        raise UserError(f"BLENDER is set to {named}, which is not a program")
    path = shutil.which("blender")
    if path:
        return path
    for place in USUAL_PLACES:
        pattern = Path(place).expanduser()
        for program in sorted(Path(pattern.anchor).glob(str(pattern.relative_to(pattern.anchor))), reverse=True):
            if os.access(program, os.X_OK):
                return str(program)
    raise UserError(
        "no installed Blender was found to open the scene in; install Blender 5.2 or newer (blender.org), "
        f"or set BLENDER to its program. {to_run('scene', '<name>')} saves the .blend without it"
    )
