"""Inputs of parts and motion beyond their own file: helpers, measured data, CAD files, and no more."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from mechanisms.stages.loading.inputs import sources_state
from mechanisms.stages.parts import stage as parts_stage
from mechanisms.stages.solve import stage as solve_stage
from shared.contract import read_motion, read_parts
from shared.stage.errors import UserError
from shared.stage.paths import ROOT, Out
from shared.stage.stages import Stage
from tests.mechanisms.author_project import Project, write_file

MECHANISM = """
from dataclasses import dataclass
from pathlib import Path
from mbsd import Mechanism, constant_rate

WIDTH = 8.0

@dataclass(frozen=True)
class Params:
    length: float = 0.04
    speed: float = 6.0

    def area(self):
        return self.length * WIDTH

def build(p):
    m = Mechanism("arm")
    arm = m.bar("arm", p.length)
    m.revolute("A", m.ground.at(0, 0), arm.start)
    m.drive_angle("motor", arm, constant_rate(p.speed))
    return m

def motion(m, p):
    return m.sweep(steps=12)
"""
PARTS = """
from pathlib import Path
import cadquery as cq
from mechanisms.arm.mechanism import Params
from shared.shapes.solid import Solid

HERE = Path(__file__).parent

def box(length, width=8.0):
    return cq.Workplane().box(length, width, 3.0)

def parts(p: Params) -> dict[str, list[Solid]]:
    return {"ground": [Solid("plate", box(20.0), "steel", 0)], "arm": [Solid("arm", arm(p), "steel", 0)]}

"""
HELPER = "mechanisms/arm/helper.py"
WIDER = write_file("mechanisms/arm/mechanism.py", MECHANISM.replace("WIDTH = 8.0", "WIDTH = 9.0"))
FASTER = write_file("mechanisms/arm/mechanism.py", MECHANISM.replace("speed: float = 6.0", "speed: float = 7.0"))
LONGER = write_file("mechanisms/arm/mechanism.py", MECHANISM.replace("length: float = 0.04", "length: float = 0.05"))


def step_file(width: float) -> Callable[[Project], None]:
    def write(project: Project) -> None:
        import cadquery as cq

        cq.exporters.export(cq.Workplane().box(40.0, width, 3.0), str(project.folder / "bought.step"))

    return write


def nothing(project: Project) -> None:
    pass


@pytest.fixture
def parts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, out_root: Path) -> Project:
    project = Project(tmp_path / "project", monkeypatch, parts_stage)
    write_file("mechanisms/arm/mechanism.py", MECHANISM)(project)
    return project


BY_VALUE = "def arm(p):\n    return box(1000 * p.length)\n"
NUMBER = "from mechanisms.arm.mechanism import WIDTH\ndef arm(p):\n    return box(40.0, WIDTH)\n"
WIDTHS = write_file("mechanisms/arm/width.csv", "8"), write_file("mechanisms/arm/width.csv", "9")
CASES: dict[str, tuple[str, Callable[[Project], None], Callable[[Project], None], bool]] = {
    # what parts.py adds; before the first run; the change; whether the parts are made again
    "a parameter": (BY_VALUE, nothing, LONGER, True),
    "a parameter that it does not read": (BY_VALUE, nothing, FASTER, False),
    "a number of mechanism.py that it does not use": (BY_VALUE, nothing, WIDER, False),
    "a number of mechanism.py": (NUMBER, nothing, WIDER, True),
    "mechanism.py as a module": (
        "from mechanisms.arm import mechanism\ndef arm(p):\n    return box(40.0, mechanism.WIDTH)\n",
        nothing, WIDER, True,
    ),
    "a method of the parameters": ("def arm(p):\n    return box(40.0, p.area() / p.length)\n", nothing, WIDER, True),
    "parameters of its own": ("P = Params()\ndef arm(p):\n    return box(1000 * P.length)\n", nothing, LONGER, True),
    "a helper that uses mechanism.py": (
        "from mechanisms.arm.helper import width\ndef arm(p):\n    return box(40.0, width())\n",
        write_file(HELPER, "def width():\n    from mechanisms.arm.mechanism import WIDTH\n    return WIDTH\n"),
        WIDER, True,
    ),
    "a helper": (
        "from mechanisms.arm.helper import WIDTH\ndef arm(p):\n    return box(40.0, WIDTH)\n",
        write_file(HELPER, "WIDTH = 8.0\n"), write_file(HELPER, "WIDTH = 9.0\n"), True,
    ),
    "measured data": (
        "import numpy as np\ndef arm(p):\n    return box(40.0, float(np.loadtxt(HERE / 'width.csv')))\n", *WIDTHS, True,
    ),
    "a STEP file, which the kernel opens by itself": (
        "def arm(p):\n    return cq.importers.importStep(str(HERE / 'bought.step'))\n",
        step_file(8.0), step_file(9.0), True,
    ),
}  # fmt: skip


@pytest.mark.parametrize(("text", "first", "change", "again"), CASES.values(), ids=CASES.keys())
def test_parts_follow_from_what_parts_py_uses(
    parts: Project, text: str, first: Callable[[Project], None], change: Callable[[Project], None], again: bool
) -> None:
    write_file("mechanisms/arm/parts.py", PARTS + text)(parts)
    first(parts)
    assert parts.run()
    before = read_parts(Out("arm").parts).bodies["arm"].mass.mass
    for file in parts.folder.iterdir():
        os.utime(file, (1e9, 1e9))
    assert not parts.run()
    change(parts)
    assert parts.run() == again
    assert (read_parts(Out("arm").parts).bodies["arm"].mass.mass != before) == again
    assert not parts.run()


def test_only_the_mount_of_shot_py_counts(parts: Project) -> None:
    """Its imports and its files count only where parts.py has them too, which then finds them as new."""
    write_file("mechanisms/arm/parts.py", PARTS + CASES["a helper"][0])(parts)
    write_file(HELPER, "WIDTH = 8.0\n")(parts)
    camera = "from shared.shot import Camera\nfrom mechanisms.arm.helper import WIDTH\n"
    steps = [
        ("shot = Shot()", "desk", True),
        (camera + "shot = Shot(camera=Camera(azimuth=WIDTH))", "desk", False),
        (camera + "shot = Shot(camera=Camera(azimuth=2 * WIDTH), mount='stand')", "stand", True),
        (camera + "shot = Shot(camera=Camera(azimuth=WIDTH), mount='st' + 'and')", "stand", False),
        ("shot = Shot(mount='wall')", "wall", True),
        ("shot = Shot(mount='desk')", "desk", True),
    ]
    for text, kind, again in steps:
        parts.shot(text)
        assert parts.run() == again
        assert read_parts(Out("arm").parts).mount.kind == kind
    modules = Stage(Out("arm"), "parts", "", []).notes()["inputs"]["modules"]
    assert {"mechanisms/arm/helper.py", "mechanisms/arm/parts.py"} <= set(modules)
    assert "mechanisms/arm/shot.py" not in modules
    parts.shot("shot = Shot(mount='ceiling')")
    with pytest.raises(UserError, match=r"mechanisms/arm/shot\.py.*mount"):
        parts.run()


def test_solids_by_hand_that_stand_follow_gravity(parts: Project) -> None:
    """mechanism.py counts for them then."""
    write_file("mechanisms/arm/parts.py", PARTS + BY_VALUE)(parts)
    parts.shot("shot = Shot(mount='ground')")
    assert parts.run()
    assert read_parts(Out("arm").parts).mount.up == (0.0, 1.0, 0.0)
    write_file("mechanisms/arm/mechanism.py", MECHANISM.replace('("arm")', '("arm", gravity=(9.81, 0.0))'))(parts)
    assert parts.run()
    assert read_parts(Out("arm").parts).mount.up == (-1.0, 0.0, 0.0)


@pytest.mark.parametrize("said", ["('shelf', (0.0, 1.0, 0.0))", "('stand', (0.0, 2.0, 0.0))", "'stand'"])
def test_a_mount_of_parts_py_that_cannot_be_is_refused(parts: Project, said: str) -> None:
    text = BY_VALUE + "_plain = parts\ndef parts(p: Params):\n    from shared.shapes.bodies import Bodies\n"
    text += f"    made = Bodies(_plain(p))\n    made.mount = {said}\n    return made\n"
    write_file("mechanisms/arm/parts.py", PARTS + text)(parts)
    with pytest.raises(UserError, match=r"arm: parts\(\): mount is"):
        parts.run()
    write_file("mechanisms/arm/parts.py", PARTS + text.replace(said, "('wall', (0.6, 0.8, 0.0))"))(parts)
    assert parts.run()
    assert read_parts(Out("arm").parts).mount.kind == "wall"


def test_where_mechanism_py_counts_the_solver_counts_that_it_imports(parts: Project) -> None:
    for text, counts in ((BY_VALUE, []), (CASES["a method of the parameters"][0], ["mbsd"])):
        write_file("mechanisms/arm/parts.py", PARTS + text)(parts)
        assert parts.run()
        assert Stage(Out("arm"), "parts", "", []).notes()["inputs"]["sources"] == counts


def test_parameters_from_measured_data_count_by_their_value(parts: Project) -> None:
    """mechanism.py reads the file when it is loaded; parts.py gets the number."""
    text = MECHANISM.replace("0.04", "float((Path(__file__).parent / 'length.txt').read_text())")
    write_file("mechanisms/arm/mechanism.py", text)(parts)
    write_file("mechanisms/arm/parts.py", PARTS + BY_VALUE)(parts)
    write_file("mechanisms/arm/length.txt", "0.04")(parts)
    assert parts.run()
    write_file("mechanisms/arm/length.txt", "0.0400")(parts)
    assert not parts.run()
    write_file("mechanisms/arm/length.txt", "0.05")(parts)
    assert parts.run()


MOTION: dict[str, tuple[str, str, Callable[[Project], None], Callable[[Project], None]]] = {
    # a text of mechanism.py and what stands there instead; before the first run; the change
    "mechanism.py": ("speed: float = 6.0", "speed: float = 6.0", nothing, FASTER),
    "a helper": (
        "constant_rate(p.speed)",
        "constant_rate(__import__('mechanisms.arm.helper', fromlist=['x']).SPEED)",
        write_file(HELPER, "SPEED = 6.0\n"),
        write_file(HELPER, "SPEED = 7.0\n"),
    ),
    "a file that build() reads": (
        "constant_rate(p.speed)",
        "constant_rate(float((Path(__file__).parent / 'speed.txt').read_text()))",
        write_file("mechanisms/arm/speed.txt", "6"),
        write_file("mechanisms/arm/speed.txt", "7"),
    ),
    "a file that motion() reads": (
        "m.sweep(steps=12)",
        "m.sweep(steps=int((Path(__file__).parent / 'steps.txt').read_text()))",
        write_file("mechanisms/arm/steps.txt", "12"),
        write_file("mechanisms/arm/steps.txt", "13"),
    ),
    "a model that the solver loads": (
        "m.sweep(steps=12)",
        "m.sweep(steps=len(Mechanism.load(Path(__file__).parent / 'model.json').bodies) + 10)",
        lambda project: saved(project, "one"),
        lambda project: saved(project, "one", "two"),
    ),
}


def saved(project: Project, *bodies: str) -> None:
    from mbsd import Mechanism

    m = Mechanism("saved")
    for body in bodies:
        m.bar(body, 0.1)
    m.save(project.folder / "model.json")


@pytest.mark.parametrize(("old", "new", "first", "change"), MOTION.values(), ids=MOTION.keys())
def test_the_motion_follows_from_what_mechanism_py_uses(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    out_root: Path,
    old: str,
    new: str,
    first: Callable[[Project], None],
    change: Callable[[Project], None],
) -> None:
    with monkeypatch.context() as patch:
        made = Project(tmp_path / "made", patch, parts_stage)
        write_file("mechanisms/arm/mechanism.py", MECHANISM)(made)
        write_file("mechanisms/arm/parts.py", PARTS + BY_VALUE)(made)
        made.run()
    project = Project(tmp_path / "project", monkeypatch, solve_stage)
    assert old in MECHANISM
    write_file("mechanisms/arm/mechanism.py", MECHANISM.replace(old, new))(project)
    first(project)
    assert project.run()
    before = read_motion(Out("arm").motion)
    for file in project.folder.iterdir():
        os.utime(file, (1e9, 1e9))
    write_file("mechanisms/arm/notes.md", "read by nobody")(project)
    assert not project.run()
    change(project)
    assert project.run()
    after = read_motion(Out("arm").motion)
    assert (after.time != before.time) or (after.bodies != before.bodies)
    assert after.provenance.inputs != before.provenance.inputs
    assert not project.run()


def test_an_edit_of_the_solver_counts_and_one_of_its_drawing_does_not(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import shutil

    from shared.stage import paths

    shutil.copytree(ROOT / "mbsd", tmp_path / "mbsd", ignore=shutil.ignore_patterns("__pycache__"))
    before = sources_state("mbsd")
    monkeypatch.setattr(paths, "ROOT", tmp_path)
    assert sources_state("mbsd") == before
    drawn = sources_state("mbsd/drawing")
    with (tmp_path / "mbsd" / "drawing" / "skeleton.py").open("a") as file:
        file.write("# thicker\n")
    assert (sources_state("mbsd") == before, sources_state("mbsd/drawing") == drawn) == (True, False)
    with (tmp_path / "mbsd" / "kinematics.py").open("a") as file:
        file.write("# closer\n")
    assert sources_state("mbsd") != before
