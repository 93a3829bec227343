"""Table of all commands: what each acts on, the options that it takes, and its stages."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from studio.command import stages
from studio.command.stages import Stage

Of = Literal["machine", "new", "file", "host", "scheduler", "folder", ""]


@dataclass(frozen=True)
class Command:
    """One command. ``help`` is its line in ``mbsd --help`` and in ``make help``."""

    name: str
    help: str
    stages: tuple[Stage, ...]
    of: Of = "machine"
    defaults: Mapping[str, str] = field(default_factory=dict)
    """Values of options where they are other than usual."""
    example: str = ""
    never_kept: tuple[str, ...] = ()
    """Options that mbsd.toml does not say for it."""
    target: str = ""
    """Its name as a target of make, where it is another; ``-`` where there is none."""

    @property
    def options(self) -> tuple[str, ...]:
        """Names of the options that its stages take, each once."""
        return tuple(dict.fromkeys(name for stage in self.stages for name in stage.options))

    @property
    def make_target(self) -> str:
        """Target of make: ``run-<name>``, ``status``; empty if make has none."""
        target = self.target or self.name
        return "" if target == "-" else f"{target}-<name>" if self.of == "machine" else target


_NIGHT = ("preset", "aspect", "only", "show", "sound", "spectra", "watts", "anyway")
COMMANDS: dict[str, Command] = {
    command.name: command
    for command in (
        Command(
            "run", "everything of one mechanism: parts, motion, clearance, report, plots, GLB, poster, film",
            (*stages.MOTION, stages.CLEARANCE_OR_WARNING, stages.SHOT, stages.REPORT, stages.PLOTS, stages.GLB,
             stages.POSTER, stages.FILM),
            example="mbsd run excavator --preset production",
        ),
        Command(
            "all", "the same of every mechanism; goes on after a failure",
            (Stage("studio.night", "run", _NIGHT, starts_stages=True, solids=True),), of="", target="run-all",
            example="mbsd all --only excavator,loader",
        ),
        Command(
            "overnight", "all of it in the background, also after the logout",
            (Stage("studio.night", "start", _NIGHT, starts_stages=True, solids=True),), of="",
            example="mbsd overnight --preset final",
        ),
        Command("status", "progress of every film: frames, seconds a frame, time left, last error",
                (Stage("studio.night", "status"),), of=""),
        Command("stop", "stop `overnight` after the current frame; run `overnight` again to resume",
                (Stage("studio.night", "stop"),), of=""),
        Command("check", "look for likely mistakes in a model before anything is built",
                (Stage("mechanisms", "check", ("json",)),)),
        Command("parts", "the solids: out/<name>/parts/ (STL, STEP, parts.json)", (stages.MODEL,),
                example="mbsd parts excavator --scale 1:20", never_kept=("scale",)),
        Command(
            "print", "plates to print (3MF, STL), outlines to cut (DXF), lists",
            (stages.MODEL, stages.MODEL_PRINT), example="mbsd print excavator --bed 180x180 --scale 1:20",
        ),
        Command("solve", "the motion: out/<name>/data.json", stages.BARE_MOTION),
        Command("animate", "the moving skeleton with its arrows: animation.mp4, .gif",
                (stages.ANIMATE,), example="mbsd animate excavator --view reactions"),
        Command("clearance", "proof that no two parts touch over the whole motion: clearance.json",
                (*stages.MOTION, stages.MODEL_CLEARANCE), never_kept=("scale",)),
        Command("plot", "the plots: out/<name>/plots/",
                (*stages.BARE_MOTION, stages.PLOTS)),
        Command("report", "what was found, in sentences and tables: out/<name>/report.md",
                (*stages.BARE_MOTION, stages.REPORT)),
        Command("compare", "the motions of all its variants on the same pages: out/<name>/compare/",
                (stages.COMPARE,)),
        Command("glb", "the parts with their motion in one file for any glTF viewer: out/<name>/<name>.glb",
                (*stages.SCENERY, stages.GLB)),
        Command("view", "one HTML page with the machine, its forces and its plots: out/<name>/view.html",
                (stages.PARTS_IF_ANY, stages.SOLVE, stages.SHOT, stages.VIEW)),
        Command("article", "one HTML page that explains the machine, with numbers to drag: out/<name>/article.html",
                (stages.PARTS_IF_ANY, stages.SOLVE, stages.SHOT, stages.DESIGNS, stages.ARTICLE)),
        Command(
            "live", "a page that follows the editor: sliders, dragging, fits to a path; prints its address",
            (Stage("studio.live", options=("port", "limit", "no-parts", "open")),),
            example="mbsd live excavator --open",
        ),
        Command("poster", "one picture at its best: out/<name>/poster.png", (*stages.SCENERY, stages.POSTER)),
        Command("contact", "contact sheet of twelve frames, draft quality by default: out/<name>/contact.png",
                (*stages.SCENERY, stages.CONTACT), defaults={"preset": "draft"}),
        Command("exploded", "the parts taken apart, with names and masses: out/<name>/exploded.png, .glb",
                (*stages.SCENERY, stages.EXPLODED)),
        Command("still", "one frame of the film: out/<name>/stills/",
                (*stages.SCENERY, stages.STILL), example="mbsd still excavator --frame 15"),
        Command("frames", "the frames of the film: out/<name>/frames/<preset>/", (*stages.SCENERY, stages.FRAMES)),
        Command("film", "the film: out/films/<name>-<preset>.mp4", (*stages.SCENERY, stages.FILM),
                example="mbsd film excavator --story explain --aspect 9:16"),
        Command("scene-ui", "open the scene in an installed Blender", (*stages.SCENERY, stages.SCENE_UI)),
        Command("scene", "save the scene: out/<name>/<name>.blend", (*stages.SCENERY, stages.SCENE)),
        Command(
            "verify", "solids, motion, some frames and the film made again in scratch and compared",
            (Stage("studio.verify", options=("preset", "aspect", "frames", "show"), solids=True),),
        ),
        Command("view-all", "all pages and a picture of each by Chromium: view.html, view.png",
                (Stage("studio.pages", options=("only",)),), of=""),
        Command("site", "a wall of all machines in motion and a page for each, for any web host",
                (Stage("studio.site", options=("only",)),), of="", example="mbsd site --only excavator,loader"),
        Command("showreel", "the finished films, each under its title, as one",
                (Stage("render", "showreel", ("preset", "aspect", "only", "show", "story")),), of="",
                defaults={"story": "explain"}),
        Command("gallery", "posters of all mechanisms and the page that shows them",
                (stages.CLEARANCE, stages.POSTER), of=""),
        Command("fetch", "copy new films from another computer",
                (Stage("studio.fetch", options=("folder",)),), of="host", example="mbsd fetch anna@server"),
        Command("scheduler", "scheduler of a cluster; it prints its address",
                (Stage("shared.cluster", "scheduler", ("host",)),), of=""),
        Command(
            "worker", "makes frames and parts for whoever asks the same scheduler",
            (Stage("shared.cluster", "worker", ("host",), solids=True),), of="scheduler",
        ),
        Command("certificates", "certificates, so that a cluster lets nobody else in",
                (Stage("shared.cluster", "certificates"),), of="folder"),
        Command("new", "a new mechanism that already runs",
                (Stage("mechanisms", "new", ("kind", "single")),), of="new", example="mbsd new excavator"),
        Command("import", "a mechanism of Linkage, PMKS, pylinkage or Ondsel, or a DXF sketch",
                (Stage("studio.imports", options=("as", "single")),), of="file", example="mbsd import walker.linkage2"),
        Command("export", "tables, drawings, STEP, USD, MuJoCo, URDF, FMI, Modelica",
                (stages.PARTS_IF_ANY, Stage("mechanisms", "export", ("format", "time")),),
                example="mbsd export excavator --format mjcf"),
        Command("study", "a grid of its Params solved, as a table (study.csv)",
                (Stage("mechanisms", "study", ("over",)),),
                example="mbsd study four_bar --over 'crank=0.03:0.05:5; speed=6,12'"),
        Command("tolerances", "how far results stray as its parts do, by its tolerances.py; what to tighten",
                (Stage("mechanisms", "tolerances"),), example="mbsd tolerances slider_crank"),
        Command("list", "the mechanisms and what is made of them",
                (Stage("mechanisms", "list", ("names", "json")),), of=""),
    )
}  # fmt: skip
"""In the order of ``make help``."""
