"""Inputs of an author's file: each decides whether its stage runs again, and nothing else does.

The stage of shot.py stands for all three: they record alike, and it takes milliseconds.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from mechanisms.stages import shot as shot_stage
from mechanisms.stages.loading import inputs
from mechanisms.stages.loading.inputs import Inputs, observed, recording
from mechanisms.stages.parts.memory import plain_text
from shared.contract.shot import read_shot
from shared.stage.errors import UserError
from shared.stage.paths import Out
from shared.stage.stages import Stage
from tests.mechanisms.author_project import Project, write_file


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, out_root: Path) -> Project:
    return Project(tmp_path / "project", monkeypatch, shot_stage)


def both(first: Callable[[Project], None], second: Callable[[Project], None]) -> Callable[[Project], None]:
    def step(project: Project) -> None:
        first(project)
        second(project)

    return step


def turns() -> int:
    return read_shot(Out("arm").shot).turns


def setenv(value: str) -> Callable[[Project], None]:
    return lambda project: project.patch.setenv("TURNS", value)


HELPER, CSV = "mechanisms/arm/helper.py", "mechanisms/arm/turns.csv"
TURNS, NUMBERS = ("TURNS = 2\n", "TURNS = 3\n"), ("2", "3")
FALLBACK = "try:\n    turns = int({read})\nexcept OSError:\n    turns = 2\nshot = Shot(turns=turns)\n"
READ = "(HERE / 'turns.csv').read_text()"
type Change = Callable[[Project], None]


def nothing(project: Project) -> None:
    pass


def reads(text: str, file: str, contents: tuple[str, str] = TURNS, **beside: str) -> tuple[str, Change, Change]:
    """Return a case that reads a file with the first content, then the second; files of other.py lie ``beside``."""
    first = write_file(file, contents[0])
    for name, content in beside.items():
        first = both(first, write_file(f"mechanisms/{name.replace('__', '/')}.py", content))
    return text, first, write_file(file, contents[1])


CASES: dict[str, tuple[str, Change, Change]] = {
    # what shot.py says; what makes it 2 turns, and what makes it 3
    "a module beside it": reads("from mechanisms.arm.helper import TURNS\nshot = Shot(turns=TURNS)\n", HELPER),
    "a relative import": reads("from . import helper\nshot = Shot(turns=helper.TURNS)\n", HELPER),
    "a package below it": reads(
        "from mechanisms.arm.laws.film import TURNS\nshot = Shot(turns=TURNS)\n", "mechanisms/arm/laws/film.py"
    ),
    "the module's own module": reads(
        "from mechanisms.other.helper import TURNS\nshot = Shot(turns=TURNS)\n", "mechanisms/other/deep.py",
        other__helper="from mechanisms.other.deep import TURNS\n",
    ),
    "another mechanism": reads(
        "from mechanisms.other.mechanism import TURNS\nshot = Shot(turns=TURNS)\n", "mechanisms/other/mechanism.py"
    ),
    "sys.path": reads(
        "import sys\nsys.path.insert(0, str(HERE / 'lib'))\nimport film_turns\nshot = Shot(turns=film_turns.TURNS)\n",
        "mechanisms/arm/lib/film_turns.py",
    ),
    "import_module": reads(
        "import importlib\nshot = Shot(turns=importlib.import_module('mechanisms.arm.helper').TURNS)\n", HELPER
    ),
    "exec": reads("exec((HERE / 'helper.py').read_text())\nshot = Shot(turns=TURNS)\n", HELPER),
    "a module that was not there": (
        "try:\n    from mechanisms.arm.local import TURNS\n"
        "except ImportError:\n    TURNS = 2\nshot = Shot(turns=TURNS)\n",
        nothing, write_file("mechanisms/arm/local.py", TURNS[1]),
    ),
    "open": reads("with open(HERE / 'turns.csv') as file:\n    shot = Shot(turns=int(file.read()))\n", CSV, NUMBERS),
    "numpy": reads("import numpy as np\nshot = Shot(turns=int(np.loadtxt(HERE / 'turns.csv')))\n", CSV, NUMBERS),
    "json": reads(
        "import json\nshot = Shot(turns=json.loads((HERE / 'a.json').read_bytes())['turns'])\n",
        "mechanisms/arm/a.json", ('{"turns": 2}', '{"turns": 3}'),
    ),
    "a file elsewhere": reads(
        "shot = Shot(turns=int((HERE.parents[2] / 'measured.txt').read_text()))\n", "../measured.txt", NUMBERS
    ),
    "a file read by a module": reads(
        "from mechanisms.arm.helper import turns\nshot = Shot(turns=turns())\n", CSV, NUMBERS,
        arm__helper="from pathlib import Path\nFILE = Path(__file__).with_name('turns.csv')\n"
        "def turns():\n    return int(FILE.read_text())\n",
    ),
    "a file that was not there": (FALLBACK.format(read=READ), nothing, write_file(CSV, "3")),
    "a file that is gone": (
        FALLBACK.replace("turns = 2", "turns = 3").format(read=READ), write_file(CSV, "2"),
        lambda project: (project.root / CSV).unlink(),
    ),
    "whether a file exists": (
        "shot = Shot(turns=3 if (HERE / 'long').exists() else 2)\n", nothing, write_file("mechanisms/arm/long", "")
    ),
    "what is in a folder": (
        "shot = Shot(turns=len(list(HERE.glob('*.txt'))))\n",
        both(write_file("mechanisms/arm/a.txt", ""), write_file("mechanisms/arm/b.txt", "")),
        write_file("mechanisms/arm/c.txt", ""),
    ),
    "a variable": ("import os\nshot = Shot(turns=int(os.environ['TURNS']))\n", setenv("2"), setenv("3")),
    "a variable that was not set": (
        "import os\nshot = Shot(turns=int(os.getenv('TURNS', '2')))\n",
        lambda project: project.patch.delenv("TURNS", raising=False), setenv("3"),
    ),
    "a file given to a program": reads(
        "import subprocess\nshot = Shot(turns=int(subprocess.check_output(['cat', str(HERE / 'turns.csv')])))\n",
        CSV, NUMBERS,
    ),
}  # fmt: skip


@pytest.mark.parametrize(("text", "first", "then"), CASES.values(), ids=CASES.keys())
def test_a_change_of_what_is_read_runs_the_stage_again_and_a_touch_does_not(
    project: Project, text: str, first: Callable[[Project], None], then: Callable[[Project], None]
) -> None:
    first(project)
    project.shot(text)
    assert (project.run(), turns()) == (True, 2)
    assert not project.run()
    for file in project.root.parent.rglob("*"):
        os.utime(file, (1e9, 1e9))
    (project.folder / "notes.md").write_text("read by nobody") if "glob" not in text else None
    write_file("mechanisms/other/unused.py", "TURNS = 9\n")(project)
    project.patch.setenv("UNUSED", "9")
    assert not project.run()
    then(project)
    assert (project.run(), turns()) == (True, 3)
    assert not project.run()


def test_files_that_the_run_writes_do_not_count(project: Project) -> None:
    project.shot(
        "import tempfile, os\n"
        "with tempfile.TemporaryDirectory() as folder:\n"
        "    (Path(folder) / 'turns').write_text('2')\n"
        "    turns = int((Path(folder) / 'turns').read_text())\n"
        "with open(HERE / 'log.txt', 'a') as log:\n"
        "    print('loaded', file=log)\n"
        "os.environ['TURNS_OF_ARM'] = '2'\n"
        "shot = Shot(turns=int(os.environ['TURNS_OF_ARM']))\n"
        "del os.environ['TURNS_OF_ARM']\n"
    )
    assert project.run()
    assert not project.run()
    notes = Stage(Out("arm"), "shot", "", []).notes()["inputs"]
    assert (notes["variables"], notes["folders"]) == ([], [])
    assert [name for name in notes["files"] if not name.endswith(".py")] == []


def test_a_dependency_that_is_gone_runs_the_stage_again(project: Project) -> None:
    write_file("mechanisms/arm/helper.py", "TURNS = 2\n")(project)
    project.shot("from mechanisms.arm.helper import TURNS\nshot = Shot(turns=TURNS)\n")
    assert project.run()
    (project.folder / "helper.py").unlink()
    with pytest.raises(UserError, match=r"shot\.py:4: ModuleNotFoundError"):
        project.run()


def test_a_copy_of_the_project_elsewhere_has_the_same_keys(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    keys = []
    for place in ("here", "there"):
        with monkeypatch.context() as patch:
            patch.setenv("MBSD_OUT", str(tmp_path / place / "results"))
            project = Project(tmp_path / place, patch, shot_stage)
            write_file("mechanisms/arm/helper.py", "TURNS = 2\n")(project)
            write_file(CSV, "2")(project)
            write_file("../measured.txt", "2")(project)
            project.shot(
                "from mechanisms.arm.helper import TURNS\n(HERE / 'turns.csv').read_text()\n"
                "(HERE.parents[2] / 'measured.txt').read_text()\nlist(HERE.glob('*'))\nshot = Shot(turns=TURNS)\n"
            )
            project.run()
            stamp = (Out("arm").stamps / "shot.json").read_text()
            keys.append(stamp.partition('"key"')[2].split(",")[0])
            assert str(tmp_path / place) not in stamp
    assert keys[0] == keys[1]


def test_an_edit_within_a_second_that_keeps_the_size_is_seen_in_helpers_too(project: Project) -> None:
    """Python's own cache of compiled files would miss it, and the stamp would then say that all is new."""
    project.shot("from mechanisms.arm.laws.film import TURNS\nshot = Shot(turns=TURNS)\n")
    for count in (2, 3):
        write_file("mechanisms/arm/laws/film.py", f"TURNS = {count}\n")(project)
        os.utime(project.folder / "laws" / "film.py", (1e9, 1e9))
        project.run()
        assert turns() == count


def test_recording_ends_and_leaves_everything_as_it_was(tmp_path: Path) -> None:
    plain = os.stat, type(os.environ), list(sys.meta_path)
    with pytest.raises(ZeroDivisionError), recording() as recorder:
        raise ZeroDivisionError
    assert (os.stat, type(os.environ), list(sys.meta_path)) == plain
    (tmp_path / "a").write_text("a")
    (tmp_path / "a").read_text()
    assert recorder.inputs() == Inputs()


def test_names_that_are_none_are_not_taken() -> None:
    recorded = Inputs(files={"README.md": "x"})
    assert observed(recorded.names()) == Inputs(files={"README.md": inputs.file_state("README.md")})
    for damaged in (None, [], {"files": ["a"]}, {**recorded.names(), "files": [1]}, {**recorded.names(), "more": []}):
        assert observed(damaged) is None


def test_a_parameter_counts_to_its_last_bit() -> None:
    import numpy as np

    values = np.linspace(0.0, 1.0, 5000)
    moved = values.copy()
    moved[2500] += 1e-15
    assert plain_text(values) == plain_text(values.copy())
    assert plain_text(values) != plain_text(moved)
    assert plain_text((0.1, {"a": [1]})) != plain_text((0.1, {"a": [1.0]}))
    assert plain_text(0.1 + 0.2) != plain_text(0.3)
    assert plain_text(lambda: 1) is None
    assert plain_text([object()]) is None


def test_the_solver_is_hashed_once_however_many_of_its_modules_are_loaded(monkeypatch: pytest.MonkeyPatch) -> None:
    """Once for each import it took half of the time in which parts are made."""
    import mechanisms.automatic as face

    asked: list[str] = []
    monkeypatch.setattr(inputs, "sources_state", lambda name: asked.append(name) or "hash")
    imported = inputs.loaded_inputs(Path(face.__file__), "mechanisms", set(sys.modules))
    assert "mbsd" in imported.sources
    assert len(imported.modules) > 20
    assert sorted(asked) == sorted(imported.sources)
