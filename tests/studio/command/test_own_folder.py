"""``mbsd`` in a folder of the user's own: three ways to lie there, mbsd.toml, errors, results beside the machines."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from shared.stage.errors import UserError
from shared.stage.paths import ROOT
from studio.command.place import read

CRANK = '''"""A crank of {length} m."""
from dataclasses import dataclass
from mbsd import Mechanism, constant_rate
{imports}

@dataclass(frozen=True)
class Params:
    crank: float = {length}

def build(p: Params) -> Mechanism:
    m = Mechanism("{name}")
    crank = m.bar("crank", p.crank, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.drive_angle("motor", crank, constant_rate(1.0))
    return m
'''


PARTS = """
import cadquery as cq
from shared.shapes.solid import Solid
from shared.shot import Shot

def parts(p: Params):
    plate = Solid("plate", cq.Workplane().box(40, 40, 4), "aluminium", 0)
    bar = Solid("bar", cq.Workplane().box(50, 8, 4), "aluminium", 0)
    return {"ground": [plate], "crank": [bar]}

shot = Shot(turns=2)
"""
"""The solids and the film of CRANK, for the same file."""


def crank(name: str, length: str = "0.05", imports: str = "") -> str:
    return CRANK.format(name=name, length=length, imports=imports)


def mbsd(*words: str, at: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run the program in ``at`` as its script does."""
    names = ("MBSD_OUT", "MBSD_MAKE", "MBSD_FACE", "MBSD_WORKSHOP", "PYTHONPATH", "MECHANISMS", "CLUSTER")
    inherited = {key: value for key, value in os.environ.items() if key not in names}
    command = [sys.executable, "-P", "-m", "mbsd", *words]
    path = {"PYTHONPATH": str(ROOT)}
    return subprocess.run(command, cwd=at, env=inherited | path | environment, capture_output=True, text=True)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a user's folder with a folder, a file, and names that the project has too."""
    (tmp_path / "arm").mkdir()
    (tmp_path / "arm" / "mechanism.py").write_text(crank("arm", imports="from .sizes import LENGTH", length="LENGTH"))
    (tmp_path / "arm" / "sizes.py").write_text("LENGTH = 0.04\n")
    (tmp_path / "wheel.py").write_text(crank("wheel", imports="from lengths import LENGTH", length="LENGTH"))
    (tmp_path / "lengths.py").write_text("LENGTH = 0.03\n")
    for taken in ("shared.py", "render.py", "studio.py", "mbsd.py", "numpy.py", "mechanisms.py"):
        (tmp_path / taken).write_text("raise SystemExit('this file is the user\\'s')\n")
    return tmp_path


def test_folders_and_files_are_solved_where_they_lie_and_again_only_when_they_change(folder: Path) -> None:
    listed = mbsd("list", "--names", at=folder)
    assert listed.stdout.split() == ["arm", "wheel"], listed.stderr
    for name in ("arm", "wheel"):
        done = mbsd("solve", name, at=folder)
        assert done.returncode == 0, done.stderr
        assert "nothing to do" not in done.stdout.splitlines()[-1]
        assert (folder / "out" / name / "data.json").is_file()
        half = folder / "out" / name / ".animation-0123abcd.mp4"  # of an animate that was killed
        half.write_bytes(b"half a film")
        assert f"solve: {name}: nothing to do" in mbsd("solve", name, at=folder).stdout
        assert not half.exists()
    (folder / "lengths.py").write_text("LENGTH = 0.031\n")
    assert "solve: arm: nothing to do" in mbsd("solve", "arm", at=folder).stdout
    assert "nothing to do" not in mbsd("solve", "wheel", at=folder).stdout.splitlines()[-1]


def test_a_folder_of_machines_may_be_moved(folder: Path, tmp_path_factory: pytest.TempPathFactory) -> None:
    assert mbsd("solve", "wheel", at=folder).returncode == 0
    moved = tmp_path_factory.mktemp("moved") / "elsewhere"
    folder.rename(moved)
    assert "solve: wheel: nothing to do" in mbsd("solve", "wheel", at=moved).stdout


def test_a_folder_with_mechanism_py_is_the_machine_itself(tmp_path: Path) -> None:
    own = tmp_path / "My crank 2"
    own.mkdir()
    (own / "mechanism.py").write_text(crank("my_crank_2"))
    done = mbsd("solve", "--json", at=own)
    told = json.loads(done.stdout)
    assert told["ok"], done.stderr
    assert told["machine"] == "my_crank_2"
    assert [stage["stage"] for stage in told["stages"]] == ["parts", "solve"]
    assert {"data.json", "skeleton.json"} <= set(told["files"])
    assert told["older"] == []
    assert (own / "out" / "my_crank_2" / "data.json").is_file()


def test_settings_are_said_once_and_found_from_below(folder: Path) -> None:
    (folder / "mbsd.toml").write_text(
        'preset = "draft"\naspect = "1:1"\nout = "results"\nlook = "bench"\nbed = "180x180"\n'
    )
    planned = mbsd("film", "--plan", at=folder / "arm")
    assert planned.stdout.splitlines()[-1].startswith("film arm --preset draft --aspect 1:1  "), planned.stderr
    assert planned.stdout.splitlines()[-1].endswith(f"the film: {folder}/results/films/arm-draft-1x1.mp4")
    assert "--preset final" in mbsd("film", "wheel", "--preset", "final", "--plan", at=folder).stdout
    assert "--bed 180x180" in mbsd("print", "wheel", "--plan", at=folder).stdout
    scene = mbsd("export", "wheel", "--format", "usdz", "--plan", at=folder).stdout.splitlines()
    assert [line.split()[0] for line in scene] == ["parts", "solve", "shot", "export"]
    assert scene[-1].startswith("export wheel --format usdz  ")
    assert scene[-1].endswith(f"the scene as OpenUSD: {folder}/results/wheel/export/")
    table = mbsd("export", "wheel", "--plan", at=folder).stdout.splitlines()
    assert table[-1].split()[:2] == ["export", "wheel"]
    with (folder / "mbsd.toml").open("a") as settings:
        settings.write('scale = "1:20"\n')
    proof = mbsd("print", "wheel", "--plan", at=folder).stdout.splitlines()[-1]
    assert proof.startswith("clearance wheel --scale 1:20  ")
    model = mbsd("print", "wheel", "--scale", "1:5", "--plan", at=folder).stdout
    machine, scaled = model.splitlines()[:2]
    assert machine.endswith("of full size, only if the motion needs their masses")
    assert scaled.startswith("parts wheel --scale 1:5  ")
    assert f"{folder}/results/wheel/scale_1_5/parts/" in scaled
    assert "--scale tiny is not a scale" in mbsd("print", "wheel", "--scale", "tiny", at=folder).stderr
    for command in ("parts", "clearance", "film"):
        assert "scale" not in mbsd(command, "wheel", "--plan", at=folder).stdout
    done = mbsd("solve", at=folder / "arm")
    assert done.returncode == 0, done.stderr
    assert (folder / "results" / "arm" / "data.json").is_file()
    assert not (folder / "arm" / "out").exists()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('preset = "huge"', "--preset huge in mbsd.toml is not a valid preset; choose one of: draft"),
        ('colour = "red"', "unknown field `colour`; its fields are: preset, aspect"),
        ("preset = ", "mbsd.toml: "),
    ],
)
def test_unfit_settings_are_refused(folder: Path, text: str, said: str) -> None:
    (folder / "mbsd.toml").write_text(text)
    done = mbsd("film", "arm", "--plan", at=folder)
    assert done.returncode == 1
    assert said in done.stderr.replace(" - at `$.colour`", "")
    assert "Traceback" not in done.stderr


def test_a_byte_order_mark_is_no_setting(tmp_path: Path) -> None:
    """Editors on Windows write one."""
    (tmp_path / "mbsd.toml").write_bytes(b'\xef\xbb\xbfpreset = "draft"\n')
    assert read(tmp_path).preset == "draft"


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b'preset = "dr\x00aft"', "Illegal character"),
        (b'out = "a\\u0000b"', r"out is 'a\\x00b', with characters that cannot be printed"),
        (b"gap = " + b"[" * 10_000, "nested too deep"),
        (b"x = " + b"{a = " * 3000, "nested too deep"),
        (b"a." * 50_000 + b"b = 1", "larger than 16 kB"),
        (b"gap = " + b"9" * 5000, "4300 digits"),
        (b"\xff\xfe", "can't decode byte 0xff"),
    ],
    ids=["NUL", "NUL in words", "deep list", "deep table", "long key", "a long number", "UTF-16"],
)
def test_files_that_are_no_settings_are_refused_in_a_sentence(tmp_path: Path, content: bytes, said: str) -> None:
    """They ended in tracebacks."""
    (tmp_path / "mbsd.toml").write_bytes(content)
    with pytest.raises(UserError, match=said) as refused:
        read(tmp_path)
    assert str(refused.value).startswith(f"{tmp_path / 'mbsd.toml'}")


def test_errors_name_the_users_file_and_line(folder: Path) -> None:
    (folder / "wheel.py").write_text(crank("wheel").replace("crank.start)", "crank.strat)"))
    done = mbsd("solve", "wheel", at=folder)
    assert done.returncode == 1
    assert "error: wheel.py:13: " in done.stderr
    assert "Traceback" not in done.stderr
    (folder / "wheel.py").write_text(crank("wheel").replace("def build", "def biuld"))
    assert "wheel.py does not define 'build'" in mbsd("solve", "wheel", at=folder).stderr
    (folder / "arm" / "mechanism.py").write_text("def build(:\n")
    assert "error: arm/mechanism.py:1: invalid syntax" in mbsd("solve", "arm", at=folder).stderr


def test_a_motion_whose_masses_are_given_needs_no_solids(tmp_path: Path) -> None:
    text = crank("wheel") + PARTS
    (tmp_path / "wheel.py").write_text(text)
    solved = mbsd("solve", "wheel", at=tmp_path)
    assert solved.returncode == 0, solved.stderr
    assert not (tmp_path / "out" / "wheel" / "parts").exists()
    assert "parts: wheel: 2 solids" in mbsd("parts", "wheel", at=tmp_path).stdout
    assert "masses of mechanism.py count" in mbsd("solve", "wheel", at=tmp_path).stdout
    (tmp_path / "wheel.py").write_text(text.replace("0.05", "0.06"))  # the parts are now those of an older version
    again = mbsd("solve", "wheel", at=tmp_path)
    assert again.returncode == 0, again.stderr
    assert "masses of mechanism.py count" not in again.stdout
    assert "nothing to do" in mbsd("solve", "wheel", at=tmp_path).stdout
    (tmp_path / "wheel.py").write_text(text.replace(", mass=1.0", ""))
    assert "solve: wheel: 361 times" in mbsd("solve", "wheel", at=tmp_path).stdout


@pytest.mark.parametrize("path", ["wheel.py", "./wheel.py", "arm", "arm/", "arm/mechanism.py", "./arm"])
def test_a_machine_may_be_given_by_its_path(folder: Path, path: str) -> None:
    name = "arm" if "arm" in path else "wheel"
    assert f"check: {name}: 1 body," in mbsd("check", path, at=folder).stdout
    assert f"check: {name}: 1 body," in mbsd("check", str(folder / path), at=folder.parent).stdout


def test_a_path_without_a_machine_is_an_error(folder: Path) -> None:
    missing = mbsd("check", "lamp.py", at=folder)
    assert missing.returncode == 1
    assert "error: lamp.py is not a file or folder of a mechanism; give the name or the path" in missing.stderr
    (folder / "empty").mkdir()
    assert "error: empty/ has no mechanism.py" in mbsd("check", "empty/", at=folder).stderr
    assert "there is: arm, wheel; did you mean 'wheel'?" in mbsd("check", "Wheel", at=folder).stderr


def test_unknown_words_are_answered_by_what_was_meant(tmp_path: Path) -> None:
    unknown = mbsd("chekc", at=tmp_path)
    assert unknown.returncode == 2
    assert "there is no command 'chekc'; mbsd --help lists all; did you mean 'check'?" in unknown.stderr
    option = mbsd("film", "--prset", "draft", at=tmp_path)
    assert option.returncode == 2
    assert "mbsd film has no option '--prset'" in option.stderr
    assert "did you mean '--preset'?" in option.stderr
    alone = mbsd(at=tmp_path)
    assert alone.returncode == 2
    assert "look for likely mistakes in a model" in alone.stderr


@pytest.mark.parametrize("command", ["list", "all", "overnight", "site", "gallery", "showreel"])
def test_a_folder_without_machines_is_refused_with_the_remedy(command: str, tmp_path: Path) -> None:
    done = mbsd(command, at=tmp_path)
    assert done.returncode == 1
    assert f"there are no mechanisms in {tmp_path}; mbsd new excavator makes one" in done.stderr


def test_a_machine_that_is_not_there_is_refused_with_those_that_are(folder: Path) -> None:
    done = mbsd("run", "whel", at=folder)
    assert done.returncode == 1
    assert f"there is no mechanism 'whel' in {folder}; there is: arm, wheel; did you mean 'wheel'?" in done.stderr
    assert "name a mechanism; there is: arm, wheel" in mbsd("run", at=folder).stderr
    (folder / "empty").mkdir()
    assert "mbsd new excavator makes one" in mbsd("run", at=folder / "empty").stderr
    assert mbsd("rnu", "arm", at=folder).returncode == 2


def test_missing_folders_and_double_names_are_refused(folder: Path) -> None:
    for place in ("nowhere", "wheel.py"):
        done = mbsd("-C", place, "list", at=folder)
        assert (done.returncode, f"{folder / place} is not a folder" in done.stderr) == (1, True)
    (folder / "wheel").mkdir()
    (folder / "wheel" / "mechanism.py").write_text(crank("wheel"))
    done = mbsd("solve", "wheel", at=folder)
    assert done.returncode == 1
    assert f"wheel/mechanism.py and wheel.py in {folder} have the same name; rename one of them" in done.stderr
    (folder / "wheel" / "mechanism.py").unlink()
    assert "write VARIANTS" in (said := mbsd("compare", "wheel", at=folder).stderr)
    assert "beside build() in wheel.py, each" in said


@pytest.mark.parametrize("single", [False, True])
@pytest.mark.parametrize("kind", ["driven", "simulated"])
def test_a_new_machine_runs_and_marks_its_folder(tmp_path: Path, kind: str, single: bool) -> None:
    done = mbsd("new", "excavator", f"--kind={kind}", *["--single"] * single, at=tmp_path)
    assert done.stdout.rstrip().endswith("mbsd run excavator runs it"), done.stderr
    assert (tmp_path / ("excavator.py" if single else "excavator/mechanism.py")).is_file()
    assert (tmp_path / "mbsd.toml").is_file()
    checked = mbsd("check", at=tmp_path)
    assert checked.returncode == 0, checked.stderr
    assert "nothing odd" in checked.stdout
    again = mbsd("new", "excavator", at=tmp_path)
    assert again.returncode == 1
    assert "is there already" in again.stderr


def test_a_check_says_what_does_not_close(tmp_path: Path) -> None:
    far = crank("far").replace("    return m", "    m.distance('rod', crank.end, m.ground.at(1, 0), 0.1)\n    return m")
    (tmp_path / "far.py").write_text(far)
    checked = mbsd("check", "far", "--json", at=tmp_path)
    assert checked.returncode == 1, checked.stderr
    said = json.loads(checked.stdout)
    assert said["freedom"] is None
    assert [finding["name"] for finding in said["findings"]] == ["start"]
    assert "joint A stays open" in said["findings"][0]["problem"]


@pytest.mark.parametrize("name", ["stages", "automatic", "all", "class", "2fast", "", "../x"])
def test_names_that_cannot_be_are_refused(tmp_path: Path, name: str) -> None:
    done = mbsd("new", "--", name, at=tmp_path)
    assert done.returncode == 1
    assert list(tmp_path.iterdir()) == []
    assert "Traceback" not in done.stderr


def test_a_single_file_may_hold_its_parts_and_its_shot(tmp_path: Path) -> None:
    (tmp_path / "crank.py").write_text(crank("crank") + PARTS)
    done = mbsd("parts", "crank", at=tmp_path)
    assert "parts: crank: 2 solids of 2 bodies" in done.stdout, done.stderr
    assert "parts: crank: nothing to do" in mbsd("parts", "crank", at=tmp_path).stdout
    shot = mbsd("film", "crank", "--plan", at=tmp_path)
    assert "\nshot crank  " in shot.stdout
