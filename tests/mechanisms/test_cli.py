"""The command line of the mechanisms: a broken file of an author's is told with file and line, never a traceback."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import time
from pathlib import Path

import msgspec
import pytest

import mechanisms
from mechanisms.stages import shot as shot_stage
from mechanisms.stages.loading import loading
from shared.contract import Parts, Provenance, write_motion, write_parts
from shared.contract.shot import read_shot
from shared.stage import paths
from shared.stage.errors import UserError
from shared.stage.paths import ROOT, Out
from tools.models.motions import four_bar_motion

MECHANISM = '''"""A test linkage.

More about it.
"""
from dataclasses import dataclass

@dataclass(frozen=True)
class Params:
    length: float = 0.1

def build(p):
    return p.length
'''


def cli(*arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "mechanisms", *arguments],
        cwd=ROOT,
        capture_output=True,
        text=True,
        env=os.environ | environment,
    )


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest) -> Path:
    """An own mechanisms/ with one mechanism in it, whose name no other test has imported."""
    root = tmp_path / "mechanisms"
    monkeypatch.setattr(paths, "MECHANISMS", root)
    monkeypatch.setattr(loading, "MECHANISMS", root)
    monkeypatch.setattr(mechanisms, "__path__", [*mechanisms.__path__, str(root)])
    name = "linkage_" + "".join(c if c.isalnum() else "_" for c in request.node.name).lower()
    (root / name).mkdir(parents=True)
    (root / name / "mechanism.py").write_text(MECHANISM)
    return root / name


def test_the_three_files_are_loaded(folder: Path) -> None:
    (folder / "parts.py").write_text(
        f"from mechanisms.{folder.name}.mechanism import Params\ndef parts(p): return {{}}"
    )
    (folder / "shot.py").write_text("shot = 1")
    assert loading.load(folder.name, "mechanism").build(loading.params(folder.name)) == 0.1
    assert loading.load(folder.name.replace("_", "-"), "parts").parts(None) == {}
    assert loading.load(folder.name, "shot").shot == 1


def test_an_edit_within_a_second_that_keeps_the_size_is_seen(folder: Path) -> None:
    """Python's own bytecode cache would miss it: it compares size and whole seconds."""
    stamp = time.time()
    for length in ("0.1", "0.2"):
        (folder / "mechanism.py").write_text(MECHANISM.replace("0.1", length))
        os.utime(folder / "mechanism.py", (stamp, stamp))
        code = (
            "import mechanisms; from shared.stage import paths\n"
            "from mechanisms.stages.loading import loading; from pathlib import Path\n"
            f"root = Path({str(folder.parent)!r}); paths.MECHANISMS = loading.MECHANISMS = root\n"
            f"mechanisms.__path__.append(str(root)); print(loading.params({folder.name!r}).length)"
        )
        done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
        assert done.stdout.strip() == length


BROKEN = {
    "syntax": ("def build(p:\n    pass\n", r"mechanism\.py:1: .*was never closed: def build\(p:"),
    "indentation": ("def build(p):\npass\n", r"mechanism\.py:2: expected an indented block"),
    "import": ("import math\nimport no_such_module\n", r"mechanism\.py:2: ModuleNotFoundError: .*no_such_module"),
    "name": ("x = 1\n\ny = length\n", r"mechanism\.py:3: NameError: name 'length' is not defined"),
    "other mechanism": ("from mechanisms.nowhere.mechanism import Params\n", r"mechanism\.py:1: ModuleNotFoundError"),
    "leaves": ("import sys\nsys.exit(0)\n", r"mechanism\.py:2: SystemExit: the file ends the program with exit\(0\)"),
    "the line": ("x = 1 / 0  # here\n", r"mechanism\.py:1: ZeroDivisionError: .*, at: x = 1 / 0  # here"),
    "exit": ("raise ValueError('too short')\n", r"mechanism\.py:1: ValueError: too short"),
    "no Params": ("def build(p): ...\n", r"mechanism\.py does not define 'Params'; write a frozen dataclass"),
    "no build": ("class Params: ...\n", r"mechanism\.py does not define 'build'; write def build\(p: Params\)"),
}


@pytest.mark.parametrize(("text", "words"), BROKEN.values(), ids=BROKEN.keys())
def test_a_broken_file_is_told_with_file_and_line(folder: Path, text: str, words: str) -> None:
    (folder / "mechanism.py").write_text(text)
    with pytest.raises(UserError, match=rf"mechanisms/{folder.name}/{words}"):
        loading.load(folder.name, "mechanism")


def test_a_fault_below_the_authors_line_names_the_authors_line(folder: Path) -> None:
    (folder / "mechanism.py").write_text(MECHANISM + "\nimport json\njson.loads('{')\n")
    with pytest.raises(UserError, match=r"mechanism\.py:\d+: JSONDecodeError"):
        loading.load(folder.name, "mechanism")


def test_parameters_that_cannot_be_made_are_told(folder: Path) -> None:
    (folder / "mechanism.py").write_text(MECHANISM.replace("length: float = 0.1", "length: float"))
    with pytest.raises(UserError, match=r"mechanism\.py: Params\.length has no default; give it one"):
        loading.params(folder.name)


def test_a_missing_file_is_told(folder: Path) -> None:
    with pytest.raises(
        UserError, match=r"parts\.py is missing; a mechanism has mechanism\.py, and where it needs them"
    ):
        loading.load(folder.name, "parts")


def test_an_unknown_name_is_told_with_the_known_ones(folder: Path) -> None:
    with pytest.raises(UserError, match=f"there is no mechanism 'nope' in mechanisms/; there is: {folder.name}"):
        loading.load("nope", "mechanism")


def test_a_fault_of_ours_stays_a_traceback(folder: Path) -> None:
    with pytest.raises(ZeroDivisionError), loading.author_code(folder.name):
        raise ZeroDivisionError


def test_a_sentence_passes_through_unchanged(folder: Path) -> None:
    with pytest.raises(UserError, match=r"^already worded$"), loading.author_code(folder.name):
        raise UserError("already worded")


def test_the_shot_stage_writes_the_shot_once(
    folder: Path, out_root: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    file = folder / "shot.py"
    file.write_text("from shared.shot import Shot\nshot = Shot(turns=2, fps=24)\n")
    shot_stage.run(folder.name)
    out = Out(folder.name)
    assert (read_shot(out.shot).turns, read_shot(out.shot).fps) == (2, 24)
    assert capsys.readouterr().out.startswith(f"shot: {folder.name}: 2 turns at 24 frames a second")
    os.utime(file)
    with monkeypatch.context() as patch:
        patch.setattr(shot_stage, "load", lambda *_: pytest.fail("touched only, yet loaded again"))
        shot_stage.run(folder.name)
    assert capsys.readouterr().out == f"shot: {folder.name}: nothing to do\n"
    out.shot.write_text("{}")
    shot_stage.run(folder.name)
    assert read_shot(out.shot).turns == 2


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("shot = {'turns': 3}\n", r"shot\.py: 'shot' is a dict; write shot = Shot\(\.\.\.\)"),
        ("from shared.shot import Shot\nshot = Shot(turns=0)\n", r"turns"),
        ("from shared.shot import Shot\nshot = Shot(trun=1)\n", r"shot\.py:2: TypeError: .*trun"),
    ],
)
def test_a_wrong_shot_is_told(folder: Path, out_root: Path, text: str, words: str) -> None:
    (folder / "shot.py").write_text(text)
    with pytest.raises(UserError, match=words):
        shot_stage.run(folder.name)
    assert not Out(folder.name).shot.exists()


def test_a_fillet_too_large_is_told_with_its_line_and_a_remedy(folder: Path) -> None:
    (folder / "parts.py").write_text(
        "import cadquery as cq\n\ndef plate(radius):\n    box = cq.Workplane().box(10, 10, 3)\n"
        "    return box.edges().fillet(radius)\n\ndef parts(p):\n    return {'crank': [plate(8.0)]}\n"
    )
    with pytest.raises(UserError) as told, loading.author_code(folder.name):
        loading.load(folder.name, "parts").parts(None)
    for words in (
        "parts.py:5: StdFail_NotDone",
        "in plate(): return box.edges().fillet(radius)",
        "(from line 8: return {'crank': [plate(8.0)]})",
        "fillet(radius=8): a fillet must be smaller than half",
    ):
        assert words in str(told.value)


def test_a_name_that_motion_and_parts_lack_is_told_by_the_shot_stage(
    folder: Path, out_root: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = Out(folder.name)
    write_motion(out.motion, msgspec.structs.replace(four_bar_motion(steps=4), mechanism=folder.name))
    write_parts(out.parts, Parts(mechanism=folder.name, provenance=Provenance(inputs="", versions={}), bodies={}))
    text = "from shared.shot import Label, Shot, Trail\nshot = Shot(trails=(Trail(point='{}'),))\n"
    (folder / "shot.py").write_text(text.format("p"))
    with pytest.raises(UserError, match=r"shot\.trails\[0\]\.point names 'p', .*known: P; did you mean 'P'\?"):
        shot_stage.run(folder.name)
    assert not out.shot.exists()
    del sys.modules[f"mechanisms.{folder.name}.shot"]
    (folder / "shot.py").write_text(text.format("P"))
    shot_stage.run(folder.name)
    motion = four_bar_motion(steps=4)
    del sys.modules[f"mechanisms.{folder.name}.shot"]
    write_motion(out.motion, msgspec.structs.replace(motion, mechanism=folder.name, points={"Q": motion.points["P"]}))
    with pytest.raises(UserError, match="known: Q"):
        shot_stage.run(folder.name)


def test_the_traceback_can_be_asked_for() -> None:
    quiet, whole = cli("solve", "nope"), cli("solve", "nope", MBSD_TRACEBACK="1")
    assert "Traceback" not in quiet.stderr
    assert "Traceback" in whole.stderr
    assert whole.stderr.splitlines()[-1] == quiet.stderr.strip()
    assert whole.returncode == 1


def test_the_listing_tells_what_is_made(out_root: Path) -> None:
    environment = {"MBSD_OUT": str(out_root)}
    assert "made: nothing yet" in cli("list", **environment).stdout
    out = Out("four_bar")
    write_motion(out.motion, four_bar_motion(steps=4))
    out.film("draft").parent.mkdir(parents=True)
    out.film("draft").touch()
    listed = cli("list", **environment).stdout
    assert "four-bar " in listed
    assert "Four-bar crank-rocker" in listed
    assert "1 degree of freedom; made: film (draft); of an older version: motion" in listed, "no stage has solved it"


PENDULUM = """
from dataclasses import dataclass
from mbsd import Mechanism

@dataclass(frozen=True)
class Params:
    length: float = 0.3

DURATION = 0.1

def build(p):
    m = Mechanism("swing")
    rod = m.bar("rod", p.length, mass=0.2)
    m.revolute("A", m.ground.at(0, 0), rod.start)
    m.start_near(rod=-30)
    return m
"""


def test_the_listing_names_what_is_of_an_older_version(tmp_path: Path) -> None:
    """A report beside a motion that was solved since was listed like any other."""
    environment = {"MBSD_WORKSHOP": str(tmp_path), "MBSD_OUT": str(tmp_path / "out")}
    model = tmp_path / "swing.py"

    def listed() -> str:
        return cli("list", **environment).stdout.splitlines()[1].strip().partition("made: ")[2]

    def plotted() -> None:
        words = [sys.executable, "-m", "render", "plots", "swing"]
        subprocess.run(words, cwd=ROOT, env=os.environ | environment, capture_output=True, check=True)

    model.write_text(PENDULUM)
    assert cli("solve", "swing", **environment).returncode == 0
    plotted()
    assert listed() == "motion, plots"
    assert cli("current", "swing", **environment).stdout == "swing\n"
    model.write_text(PENDULUM.replace("0.3", "0.4"))
    assert listed() == "nothing yet; of an older version: motion, plots"
    assert cli("current", "swing", **environment).stdout == ""
    assert cli("solve", "swing", **environment).returncode == 0
    assert listed() == "motion; of an older version: plots"
    plotted()
    assert listed() == "motion, plots"


def test_no_machine_shares_a_folder_of_results(tmp_path: Path) -> None:
    """A machine called site had its results between the pages of the site."""
    environment = {"MBSD_WORKSHOP": str(tmp_path), "MBSD_OUT": str(tmp_path / "out")}
    (tmp_path / "site.py").write_text(PENDULUM)
    (tmp_path / "films").mkdir()
    (tmp_path / "films" / "mechanism.py").write_text(PENDULUM)
    for name, why in (("site", "out/site holds the site"), ("films", "out/films holds the films")):
        refused = cli("solve", name, **environment)
        assert refused.returncode == 1
        assert refused.stderr == f"error: '{name}' cannot name a mechanism, because {why}; give it another name\n"
    listed = cli("list", **environment)
    assert "'site' is left out, because that cannot name a mechanism: out/site holds the site" in listed.stderr
    assert not (tmp_path / "out").exists()


def test_every_folder_of_results_is_reserved() -> None:
    folders = {"out"}
    for room in ("shared", "render", "mechanisms", "studio", "tools"):
        for source in (ROOT / room).rglob("*.py"):
            folders |= set(re.findall(r'out_root\(\) / "([a-z_]+)"', source.read_text()))
    assert {"films", "site", "night", "gallery"} <= folders <= set(paths.RESERVED)


def test_an_unknown_mechanism_is_one_sentence() -> None:
    done = cli("solve", "nope")
    assert done.returncode == 1
    assert done.stderr.startswith("error: there is no mechanism 'nope' in mechanisms/; there is: ")
    assert done.stdout == ""


@pytest.mark.parametrize("command", [(), ("draw", "four_bar"), ("solve",)])
def test_a_wrong_command_shows_the_usage(command: tuple[str, ...]) -> None:
    done = cli(*command)
    assert done.returncode == 2
    assert "usage: python -m mechanisms" in done.stderr
