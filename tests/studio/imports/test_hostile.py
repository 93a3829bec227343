"""Files that no program wrote: each gives an error in a sentence, and every written file loads."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import MechanismError
from shared.stage.errors import UserError
from shared.stage.paths import ROOT
from studio.imports.limits import DEEPEST, LARGEST_FILE, MOST, RESERVED, Names, Titles
from studio.imports.pmks_records import stamped
from studio.imports.reading import read, read_text, try_out
from studio.imports.sketch import GROUND, Link, Motor, Pin, Sketch, Slide
from studio.imports.writing import mechanism_py
from tests.studio.imports.imported import SAMPLES, built
from tools.hunt.outcome import AGREED, HUNG, REFUSED, WRONG
from tools.hunt_imports.case import run

PIN = "ground,a,R,0,0,0,tfft\n"
DEEP = 100_000
SOON = 10.0
"""s, many times what such a file takes."""


@pytest.mark.parametrize("seed", range(7_000_000, 7_000_120, 12))
def test_damaged_samples_are_read_or_refused(seed: int) -> None:
    results = [run(k) for k in range(seed, seed + 12)]
    wrong = [(result.seed, result.outcomes[-1]) for result in results if result.outcomes[-1].state in (WRONG, HUNG)]
    assert wrong == []
    assert {result.outcomes[-1].state for result in results} <= {AGREED, REFUSED}


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("http://[", "not a file of a known program"),
        ("https://app.pmksplus.com:99999999/?[", "its checksum is wrong"),
        ("https://app.pmksplus.com/?" + stamped(f"0P.TY.K,0.101.{'7' * 300_000}..YRAB...JB."), "is not a joint"),
        ("https://app.pmksplus.com/?" + stamped(f"{'7' * 300_000}.TY.K,0.101.....JB."), "is not a number"),
        ("mech=\n" + PIN + "a,b,R," + "9" * 400 + ",0,0,tfff\n", "it must be a number up to 1e+09"),
        ("mech=\n" + PIN + "a,b,R,nan,0,0,tfff\n", "points of link 'a' is nan"),
        ("mech=\n" + PIN + "a,b,R,1e999,0,0,tfff\n", "it must be a number up to 1e+09"),
        ("mech=\n" + PIN * 500, f"it has 500 joints; a mechanism that can be imported has {MOST} at most"),
        ('{"TypeOfJoint": ' + "[" * DEEP, "its JSON is nested too deeply"),
        ('{"TypeOfJoint": 1, "x": ' + "9" * 5000 + "}", "is not a finite number"),
        ('{"TypeOfJoint": NaN}', "NaN is not a finite number"),
        ('{"TypeOfJoint": 1, "Joints": [{"Links": ["a"], "TypeOfJoint": "R", "X": null, "Y": 0}]}', "it is damaged"),
        ('{"joints": [], "links": [], "position": 0}', "nothing in it moves"),
        ('{"joints": [], "links": [{"id": "a", "joints": []}], "position": 0}', "link 'a' has no joints"),
        (stamped("0P.TY.K,0.101.MA,A,0,0,0..YRAB,AB,0,0,0,0,,,.YRB,B,0,0,0,0,,A,,...JB."), "link AB has no joints"),
        ("<linkage2>" + "<a>" * DEEP, f"it is nested deeper than {DEEPEST} levels"),
        ("<linkage2>" + "<a " * DEEP, "the file has no links"),
        ("<linkage2>" + "<!--" * DEEP, "the file has no links"),
        ('<linkage2><Link id="1"/><connector id="1"/>', "nothing in it moves"),
        ("Assembly\n" + "\n".join("\t" * k + "a" for k in range(1, 500)), f"it is nested deeper than {DEEPEST} levels"),
        ("Assembly\n\tName\n\t\ta\n\tParts\n" + "\t\tPart\n\t\t\tName\n\t\t\t\tb\n" * 2, "two parts of the name b"),
        ("0\nSECTION\n2\nENTITIES\n0\nCIRCLE\n10\nx\n", "this is not a readable DXF"),
    ],
    ids=lambda text: text[:30],
)
def test_hostile_files_are_an_error_and_take_no_time(text: str, said: str) -> None:
    began = time.monotonic()
    with pytest.raises(UserError) as refused:
        read(text) if "://" in text else read_text(text, "file")
    assert said in str(refused.value)
    assert time.monotonic() - began < SOON


@pytest.mark.parametrize("name", ["/dev/zero", "a\0b", "x" * 5000, "", "\udcff"])
def test_missing_files_are_an_error(name: str) -> None:
    """Reading /dev/zero stops at the limit of bytes, though its size is given as 0."""
    with pytest.raises(UserError):
        read(name)


def test_a_file_that_is_too_large_is_an_error(tmp_path: Path) -> None:
    file = tmp_path / "large.txt"
    with file.open("wb") as opened:
        opened.truncate(LARGEST_FILE + 1)
    with pytest.raises(UserError, match="larger than 64 MB"):
        read(str(file))


def test_words_on_a_file_are_printable() -> None:
    """Names of a file end up on a terminal: neither escape codes nor half a surrogate may."""
    said = read_text("mech=\nground,a,R,0,0\na,\x1b[31mb,G,1,1\n", "\udcff\x1b.txt").left_out
    assert said == [words for words in said if words.isprintable()]
    with pytest.raises(UserError) as refused:
        read_text('{"TypeOfJoint": 1, "Joints": [{"Links": [], "TypeOfJoint": "\x1b", "X": 0, "Y": 0}]}', "\udcff")
    assert str(refused.value).isprintable()
    with pytest.raises(UserError) as refused:
        read_text((SAMPLES / "piston.asmt").read_text().replace("CylindricalJoint", "\x1b[2J"), "\x1b")
    assert str(refused.value).isprintable()


def test_a_link_that_is_called_ground_or_speed_stays_what_it_is(tmp_path: Path) -> None:
    """Neither the frame nor the motor's rate takes its place."""
    data = json.loads((SAMPLES / "four_bar_mechanism.json").read_text().replace("rocker", "speed"))
    for link in data["links"]:
        link["id"] = {"ground": "frame", "coupler": "ground"}.get(link["id"], link["id"])
    file = tmp_path / "a.json"
    file.write_text(json.dumps(data | {"ground": "frame"}))
    sketch, m, names = built(file)
    p = names["Params"]()
    assert set(sketch.links) == {"crank", "ground", "speed"}
    assert (p.speed, p.link_ground, p.speed_2) == pytest.approx((3.0, 3.5, 24 * 0.1))
    assert m.mobility().dof == 1


WORDS = [
    "e",
    "float",
    "lambda",
    "None",
    "t",
    "p",
    "m",
    "self",
    "sqrt",
    "sin",
    "harmonic",
    "Mechanism",
    "Params",
    "DURATION",
]


@pytest.mark.parametrize(
    "word", [*WORDS, "\ud800", "\0", "a\u2028b", '"""', "\\", "x" * 3000, "日本", "__class__", "{p.a}", " "]
)
def test_a_name_of_any_form_makes_a_file_that_loads(word: str) -> None:
    sketch = Sketch(word, word, left_out=[word, word], unit="a metre")
    for k, name in enumerate((word, word + "a", "crank")):
        sketch.links[name] = Link(name, {word: (float(k), 0.0), f"{word}.": (k + 1.0, 0.5)})
        sketch.joints += [Pin(word, GROUND, name, (float(k), 0.0))]
        sketch.motors += [Motor(word, GROUND, name, 0.0, 0.0, "sin(pi*t) + e**t - 1.0")]
        sketch.traces[f"{word}{k}"] = (name, (0.0, 0.0))
    m = try_out(mechanism_py(sketch, "odd"), "odd")
    assert (len(m.bodies), len(m.joints), len(m.drivers), len(m.traces)) == (4, 3, 3, 3)


@given(st.lists(st.tuples(st.text(), st.sampled_from(["link", "number"])), max_size=30))
@settings(max_examples=60, deadline=None)
def test_names_are_names_of_python_and_differ(words: list[tuple[str, str]]) -> None:
    names = Names()
    given_names = {(word, kind): names.name_for(word, kind) for word, kind in words}
    assert len(set(given_names.values())) == len(given_names)
    for (word, kind), name in given_names.items():
        assert name.isidentifier()
        assert name not in RESERVED
        assert names.name_for(word, kind) == name


@given(st.lists(st.text(st.characters()), max_size=20))
@settings(max_examples=60, deadline=None)
def test_titles_are_printable_and_differ(words: list[str]) -> None:
    titles = Titles()
    titled = [titles.title_for(word) for word in words]
    assert len(set(titled)) == len(titled)
    assert all(title.isprintable() and title == title.strip() and title for title in titled)


PLACES = st.tuples(st.floats(-10, 10), st.floats(-10, 10))
LINKS = st.sampled_from([GROUND, "a", "speed", "\u2028"])


@given(
    st.lists(
        st.tuples(st.text(max_size=5), LINKS, LINKS, PLACES, st.floats(-7, 7), st.booleans()), min_size=1, max_size=6
    ),
    st.lists(st.tuples(LINKS, st.floats(), st.sampled_from(["", "t", "e**t", "sqrt(t)"])), max_size=3),
)
@settings(max_examples=60, deadline=None)
def test_a_sketch_that_is_sound_makes_a_file_that_loads(joints: list[tuple], motors: list[tuple]) -> None:
    """Or a mechanism that mbsd refuses, but never a fault of the written text."""
    sketch = Sketch("a sketch", "a test")
    for name, first, second, place, angle, turns in joints:
        sketch.joints.append(
            Slide(name, first, second, place, angle, turns) if turns else Pin(name, first, second, place)
        )
        for link in {first, second} - {GROUND}:
            sketch.link(link).points[name] = place
    sketch.motors += [Motor("m", GROUND, link, rate, law=law) for link, rate, law in motors]
    said = ""
    try:
        sketch.check()
        try_out(mechanism_py(sketch, "odd"), "odd")
    except UserError as error:
        said = str(error)
    assert "fault of this importer" not in said


def test_a_file_that_does_not_load_is_never_left(tmp_path: Path) -> None:
    """A mass that is negative: what is read cannot be built, and nothing is in the way of the next import."""
    text = (SAMPLES / "slider_crank_mbsd_core.json").read_text()
    data = json.loads(text)
    data["bodies"][1]["mass"] = -1.0
    file = tmp_path / "piston.json"
    file.write_text(json.dumps(data))
    inherited = {key: value for key, value in os.environ.items() if not key.startswith("MBSD_")}  # of make test
    environment = {**inherited, "PYTHONPATH": str(ROOT), "HOME": str(tmp_path)}
    command = [sys.executable, "-P", "-m", "mbsd", "import", "piston.json"]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert (done.returncode, "Traceback" in done.stderr) == (1, False)
    assert "the file makes no valid mechanism: piston: body 'crank'" in done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["piston.json"]
    file.write_text(text)
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("error", [KeyError("a"), UserError("that is a fault of this importer"), MechanismError("odd")])
def test_the_hunt_finds_what_is_no_sentence(monkeypatch: pytest.MonkeyPatch, error: Exception) -> None:
    def broken(source: str) -> Sketch:
        raise error

    monkeypatch.setattr("tools.hunt_imports.case.read", broken)
    assert run(1).outcomes[-1].state == WRONG
