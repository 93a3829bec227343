"""An edit that leaves what the author's code means redoes nothing; one that changes it does."""

from __future__ import annotations

from pathlib import Path

import pytest

from mbsd.dependencies.inputs import looks_at_itself, meaning
from mechanisms.stages import shot as shot_stage
from mechanisms.stages.solve import stage as solve_stage
from shared.stage.paths import Out
from tests.mechanisms.author_project import Project, write_file

SOURCE = '''"""An arm."""
from math import pi

FACTORS = {"a": 1.0, "b": -2}


class Law:
    """A law."""

    def at(self, t: float, *, scale=1.5):
        """Its value."""
        if t > 0 and not scale:
            return t * pi + 1
        return [f"{t:.3f}", "text", scale]
'''
SAME = {
    "a comment": ("    def at", "    # the value\n    def at"),
    "a comment at the end of a line": ('FACTORS = {"a"', 'FACTORS = {  # of both\n    "a"'),
    "blank lines": ("\n\nclass", "\n\n\n\nclass"),
    "other line breaks": ('{"a": 1.0, "b": -2}', '{\n    "a": 1.0,\n    "b": -2,\n}'),
    "other quotation marks": ('"text"', "'text'"),
    "needless brackets": ("t * pi + 1", "((t * pi) + 1)"),
    "a number in other digits": ("1.5", "1.50"),
    "a docstring of the file": ('"""An arm."""', '"""An arm that turns."""'),
    "a docstring of a class": ('"""A law."""', '"""The law."""'),
    "no docstring": ('        """Its value."""\n', ""),
    "indentation": ("            return t * pi", "              return t * pi"),
    "line ends of another system": ("\n", "\r\n"),
}
OTHER = {
    "a number": ("1.5", "1.6"),
    "an integer for a float": ("1.0", "1"),
    "a sign": ("-2", "2"),
    "a text": ('"text"', '"texts"'),
    "a blank in a text": ('"text"', '"te xt"'),
    "an operator": ("t * pi", "t + pi"),
    "a comparison": ("t > 0", "t >= 0"),
    "precedence": ("t * pi + 1", "t * (pi + 1)"),
    "and for or": (" and not", " or not"),
    "a name": ("import pi", "import tau as pi"),
    "a format": (".3f", ".4f"),
    "an order": ('"a": 1.0, "b": -2', '"b": -2, "a": 1.0'),
    "an argument by keyword": ("*, scale", "scale"),
    "an annotation": ("t: float", "t: int"),
    "a decorator": ("    def at(self, ", "    @staticmethod\n    def at("),
    "a statement less": ("            return t * pi + 1", "            pass"),
    "indentation that moves a statement": ("        return [f", "            return [f"),
}


@pytest.mark.parametrize("change", SAME)
def test_equal_meanings_have_equal_hashes(change: str) -> None:
    assert SAME[change][0] in SOURCE
    assert meaning(SOURCE.replace(*SAME[change]).encode()) == meaning(SOURCE.encode())


@pytest.mark.parametrize("change", OTHER)
def test_other_meanings_have_other_hashes(change: str) -> None:
    assert OTHER[change][0] in SOURCE
    assert meaning(SOURCE.replace(*OTHER[change]).encode()) != meaning(SOURCE.encode())


def test_files_that_are_no_python_count_by_their_bytes() -> None:
    assert meaning(b"def (:") != meaning(b"def (: ")
    assert meaning(b"\xff\xfe\x00") != meaning(b"\xff\xfe\x01")


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, out_root: Path) -> Project:
    return Project(tmp_path / "project", monkeypatch, shot_stage)


HELPER = "mechanisms/arm/helper.py"
SHOT = "from mechanisms.arm.helper import turns\nshot = Shot(turns=turns())\n"


def test_a_comment_in_a_module_runs_no_stage(project: Project) -> None:
    write_file(HELPER, "def turns():\n    return 2\n")(project)
    project.shot(SHOT)
    assert project.run()
    key = Out("arm").stamps.joinpath("shot.json").read_bytes()
    write_file(HELPER, '"""How often."""\n\n\ndef turns():  # of the crank\n    return (2)\n')(project)
    project.shot("# what is filmed\n" + SHOT)
    assert not project.run()
    assert Out("arm").stamps.joinpath("shot.json").read_bytes() == key
    write_file(HELPER, "def turns():\n    return 3\n")(project)
    assert project.run()


@pytest.mark.parametrize(
    ("shot", "before", "after"),
    [
        ("from mechanisms.arm import helper\nshot = Shot(turns=len(helper.__doc__))\n", '"""ab"""', '"""abc"""'),
        ("from mechanisms.arm import helper\nimport inspect\nshot = Shot(turns=inspect.getsource(helper).count('#'))\n",
         "##\n", "###\n"),
        ("shot = Shot(turns=HERE.joinpath('helper.py').read_text().count('#'))\n", "##\n", "###\n"),
    ],
    ids=["a docstring", "its source", "its text"],
)  # fmt: skip
def test_docstrings_count_where_they_are_read(project: Project, shot: str, before: str, after: str) -> None:
    write_file(HELPER, before)(project)
    project.shot(shot)
    assert project.run()
    write_file(HELPER, after)(project)
    assert project.run()


def test_a_module_that_is_loaded_by_its_path_counts(project: Project) -> None:
    """No import statement names it, and sys.modules does not know it."""
    project.shot(
        "import importlib.util\n"
        "spec = importlib.util.spec_from_file_location('film', HERE / 'helper.py')\n"
        "film = importlib.util.module_from_spec(spec)\n"
        "spec.loader.exec_module(film)\n"
        "shot = Shot(turns=film.TURNS)\n"
    )
    write_file(HELPER, "TURNS = 2\n")(project)
    assert project.run()
    write_file(HELPER, "TURNS = 2  # turns\n")(project)
    assert not project.run()
    write_file(HELPER, "TURNS = 30\n")(project)
    assert project.run()


def test_a_comment_in_mechanism_py_solves_nothing_anew(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, out_root: Path
) -> None:
    project = Project(tmp_path / "project", monkeypatch, solve_stage.loading)
    project.stage = solve_stage
    text = (
        '"""An arm."""\nfrom dataclasses import dataclass\nfrom mbsd import Mechanism, constant_rate\n'
        "\n@dataclass(frozen=True)\nclass Params:\n    length: float = 0.04\n\n"
        "def build(p):\n    m = Mechanism('arm')\n"
        "    arm = m.bar('arm', p.length, mass=1.0)\n    m.revolute('A', m.ground.at(0, 0), arm.start)\n"
        "    m.drive_angle('motor', arm, constant_rate(6.0))\n    return m\n\n"
        "def motion(m, p):\n    return m.sweep(steps=4)\n"
    )
    write_file("mechanisms/arm/mechanism.py", text)(project)
    assert project.run()
    made = Out("arm").motion.read_bytes()
    write_file("mechanisms/arm/mechanism.py", text.replace('"""An arm."""', "# An arm.\n\n").replace("'", '"'))(project)
    assert not project.run()
    assert Out("arm").motion.read_bytes() == made
    write_file("mechanisms/arm/mechanism.py", text.replace("6.0", "6.5"))(project)
    assert project.run()
    assert Out("arm").motion.read_bytes() != made


def test_words_that_look_at_source() -> None:
    assert looks_at_itself(b"print(module.__doc__)")
    assert not looks_at_itself(SOURCE.encode())
