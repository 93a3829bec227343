"""The files that cross a process: what is written is read back the same, and what does not hold together is refused."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from shared import contract
from shared.contract import BodyMotion, BodyParts, Mass, Motion, Parts, Piece, Provenance
from shared.contract.clearance import Clearance, read_clearance, write_clearance
from shared.contract.shot import Shot, read_shot, write_shot
from shared.stage import jsonfile
from shared.stage.errors import UserError
from tools.models.motions import bouncing_ball, four_bar_motion

MOTION = four_bar_motion(steps=12)
CONTENT = jsonfile.encode(MOTION)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "data.json"


def parts_document(**changes: Any) -> Parts:
    mass = Mass(mass=0.1, com=(0.02, 0.0), inertia=1e-5, volume=4e-5)
    piece = Piece(
        material="steel", stl="crank.stl", step="crank.step", mass=mass, z_range=(0.0, 0.006), triangles=400,
        stl_sha256="0" * 64,
    )  # fmt: skip
    body = BodyParts(pieces={"link": piece}, mass=mass, z=0.003)
    provenance = Provenance(inputs="0" * 64, versions={})
    return Parts(**({"mechanism": "four_bar", "provenance": provenance, "bodies": {"crank": body}} | changes))


def test_a_file_of_another_mechanism_is_refused(path: Path) -> None:
    contract.write_motion(path, MOTION)
    assert contract.read_motion(path, "four_bar") == MOTION
    with pytest.raises(UserError, match=r"data\.json is of the mechanism 'four_bar', but stands among .* 'arm'"):
        contract.read_motion(path, "arm")
    contract.write_parts(path, parts_document())
    (path.parent / "crank.stl").write_bytes(b"solid")
    with pytest.raises(UserError, match=r"is of the mechanism 'four_bar', but stands among .*results of 'arm'"):
        contract.read_parts(path, "arm")


def test_round_trip(path: Path) -> None:
    contract.write_motion(path, MOTION)
    assert contract.read_motion(path) == MOTION


def test_bytes_are_the_same_for_the_same_content(path: Path) -> None:
    contract.write_motion(path, four_bar_motion(steps=12))
    assert path.read_bytes() == CONTENT
    contract.write_motion(path, contract.read_motion(path))
    assert path.read_bytes() == CONTENT


finite = st.floats(allow_nan=False, allow_infinity=False)
positive = st.floats(min_value=0, allow_nan=False, allow_infinity=False)
BODY_SERIES = ("x", "y", "theta", "vx", "vy", "omega", "ax", "ay", "alpha")


@st.composite
def motions(draw: st.DrawFn) -> Motion:
    count = draw(st.integers(2, 5))
    series = st.lists(finite, min_size=count, max_size=count)
    body = st.builds(
        BodyMotion,
        **dict.fromkeys(BODY_SERIES, series),
        z=finite,
        mass=positive,
        com=st.tuples(finite, finite),
        inertia=positive,
    )
    time = draw(st.lists(finite, min_size=count, max_size=count, unique=True).map(sorted))
    bodies = draw(st.dictionaries(st.text(), body, max_size=2))
    energy = contract.Energy(kinetic=draw(series), potential=draw(series))
    margin = draw(series)
    diagnostics = msgspec.structs.replace(MOTION.diagnostics, singularity_margin=margin, dof=draw(st.integers(-9, 9)))
    return Motion(
        mechanism=draw(st.text()), provenance=MOTION.provenance, gravity=(0.0, -9.81),
        period=draw(st.none() | st.just(1.5)), time=time, bodies=bodies, joints={}, drivers={}, points={},
        energy=energy, diagnostics=diagnostics,
    )  # fmt: skip


@given(motions())
def test_any_motion_survives_the_round_trip_bit_by_bit(motion: Motion) -> None:
    content = jsonfile.encode(motion)
    again = jsonfile.decode(content, Motion, "data.json")
    assert again == motion
    assert jsonfile.encode(again) == content


Edit = Callable[[dict[str, Any]], object]
REFUSED: dict[str, tuple[Edit, str]] = {
    "NaN": (lambda d: d["bodies"]["crank"]["x"].__setitem__(3, float("nan")), r"bodies\.crank\.x\[3\] is nan"),
    "infinity": (lambda d: d["joints"]["A"]["fx"].__setitem__(0, float("-inf")), r"joints\.A\.fx\[0\] is -inf"),
    "null": (lambda d: d["bodies"]["crank"]["x"].__setitem__(3, None), r"got `null` at bodies\.crank\.x\[3\]"),
    "overflow": (lambda d: d["points"]["P"]["x"].__setitem__(1, 10**400), r"points\.P\.x"),
    "newer version": (lambda d: d.update(schema_version=4), "schema_version is 4, this program reads 1 or 2 or 3"),
    "no version": (lambda d: d.pop("schema_version"), "schema_version is missing, this program reads 1 or 2 or 3"),
    "another schema": (lambda d: d.update(schema="mbsd.parts"), "schema is 'mbsd.parts', .* reads 'mbsd.motion'"),
    "wrong type": (lambda d: d["bodies"]["crank"].update(mass="heavy"), r"got `str` at bodies\.crank\.mass"),
    "wrong type deep": (lambda d: d["points"]["P"]["vx"].__setitem__(2, "a"), r"got `str` at points\.P\.vx\[2\]"),
    "negative mass": (lambda d: d["bodies"]["rocker"].update(mass=-1), r">= 0\.0 at bodies\.rocker\.mass"),
    "missing field": (lambda d: d["bodies"]["crank"].pop("omega"), r"required field `omega` at bodies\.crank"),
    "missing at the top": (lambda d: d.pop("time"), "required field `time`"),
    "unknown field": (lambda d: d["drivers"]["motor"].update(colour=1), r"unknown field `colour` at drivers\.motor"),
    "unknown at the top": (lambda d: d.update(colour=1), "unknown field `colour`"),
    "wrong length": (lambda d: d["joints"]["B"].update(bodies=["a"]), r"length 2, got 1 at joints\.B\.bodies"),
    "zero period": (lambda d: d.update(period=0), "at period"),
    "ragged": (lambda d: d["bodies"]["crank"]["x"].pop(), r"bodies\.crank\.x has 12 values, time has 13"),
    "ragged joint": (lambda d: d["joints"]["C"]["torque"].append(0.0), r"joints\.C\.torque has 14 values"),
    "ragged point": (lambda d: d["points"]["P"]["ay"].clear(), r"points\.P\.ay has 0 values"),
    "ragged driver": (lambda d: d["drivers"]["motor"]["effort"].pop(), r"drivers\.motor\.effort has 12 values"),
    "ragged energy": (lambda d: d["energy"]["kinetic"].pop(), r"energy\.kinetic has 12 values"),
    "ragged margin": (lambda d: d["diagnostics"]["singularity_margin"].pop(), r"singularity_margin has 12 values"),
    "time stands": (lambda d: d["time"].__setitem__(5, d["time"][4]), r"time\[5\] = .* does not come after"),
    "one time": (lambda d: d.update(time=[0.0]), "time has 1 values"),
    "other units": (lambda d: d["units"].update(length="mm"), r"units\.length is 'mm', this program reads 'm'"),
    "a unit less": (lambda d: d["units"].pop("time"), r"units\.time is missing, this program reads 's'"),
    "a unit more": (lambda d: d["units"].update(volume="l"), r"units\.volume is 'l', this program reads nothing"),
    "other axes": (lambda d: d["conventions"].update(axes="y down"), r"conventions\.axes is 'y down', this program"),
    "long period": (lambda d: d.update(period=2.0), r"period is 2 s, time spans 1 s; a period is the time spanned"),
    "short period": (lambda d: d.update(period=0.5), r"period is 0\.5 s, time spans 1 s"),
    "no return": (
        lambda d: d["bodies"]["rocker"]["theta"].__setitem__(-1, 0.3),
        r"bodies\.rocker\.theta begins at .* and ends at 0\.3, though period",
    ),
    "unknown body of a joint": (
        lambda d: d["joints"]["B"].update(bodies=["crank", "rod"]),
        r"joints\.B\.bodies names 'rod', which is no body; there is: coupler, crank, ground, rocker",
    ),
    "unknown body of a point": (lambda d: d["points"]["P"].update(body="rod"), r"points\.P\.body names 'rod'"),
    "ground moves": (lambda d: d["bodies"].update(ground=d["bodies"]["crank"]), "bodies has 'ground'"),
    "a name with a slash": (
        lambda d: d["points"].update({"../../P": d["points"]["P"]}),
        r"points has the name '../../P'; files are named after it",
    ),
    "a name of nothing": (lambda d: d["bodies"].update({"": d["bodies"]["crank"]}), "bodies has the name ''"),
}  # fmt: skip


@pytest.mark.parametrize(("edit", "words"), REFUSED.values(), ids=REFUSED.keys())
def test_inconsistent_files_are_refused_with_file_and_field(path: Path, edit: Edit, words: str) -> None:
    document = json.loads(CONTENT)
    edit(document)
    path.write_text(json.dumps(document))
    with pytest.raises(UserError, match=words) as refusal:
        contract.read_motion(path)
    assert str(refusal.value).startswith(f"{path}: ")
    assert "$" not in str(refusal.value)
    assert "..." not in str(refusal.value)


DOUBLED = {
    "at the top": (b'"mechanism": "four_bar"', "mechanism"),
    "a unit": (b'"length": "m"', "length"),
    "deep": (b'"omega": [', "omega"),
}


@pytest.mark.parametrize(("entry", "field"), DOUBLED.values(), ids=DOUBLED.keys())
def test_a_field_that_is_there_twice_is_refused(path: Path, entry: bytes, field: str) -> None:
    """Decoders take the last of them in silence."""
    assert entry in CONTENT
    first = {b"{": b"{}", b"[": b"[]"}.get(entry[-1:], b"")
    path.write_bytes(CONTENT.replace(entry, entry.rstrip(b"{[") + first + b", " + entry, 1))
    with pytest.raises(UserError, match=f"has the field '{field}' more than once"):
        contract.read_motion(path)


def test_a_file_in_another_layout_is_read(path: Path) -> None:
    path.write_text(json.dumps(json.loads(CONTENT), sort_keys=True))
    assert contract.read_motion(path) == MOTION


@pytest.mark.parametrize("content", [b"[" * 200_000, b'{"a":' * 200_000, b'{"time":' + b"[" * 200_000])
def test_a_deeply_nested_file_is_refused_with_a_sentence(path: Path, content: bytes) -> None:
    path.write_bytes(content)
    with pytest.raises(UserError, match=r"data\.json: "):
        contract.read_motion(path)


@pytest.mark.parametrize("content", ["[]", "3", '"text"', "null"])
def test_something_other_than_an_object_is_refused(path: Path, content: str) -> None:
    path.write_text(content)
    with pytest.raises(UserError, match="expected an object at the top"):
        contract.read_motion(path)


@given(st.integers(0, len(CONTENT) - 3))
def test_a_file_cut_anywhere_is_refused(cut: int) -> None:
    with pytest.raises(UserError, match=r"data\.json: not a whole JSON file .*make it again"):
        jsonfile.decode(CONTENT[:cut], Motion, "data.json")


def test_a_cut_file_names_the_field_it_breaks_off_in() -> None:
    cut = CONTENT.index(b'"omega"') + 40
    with pytest.raises(UserError, match="breaks off in field 'omega'"):
        jsonfile.decode(CONTENT[:cut], Motion, "data.json")


@given(st.binary(max_size=40))
def test_any_bytes_are_refused_with_a_sentence(content: bytes) -> None:
    with pytest.raises(UserError, match=r"^data\.json: "):
        jsonfile.decode(content, Motion, "data.json")


def test_a_byte_that_is_no_text_is_told_with_its_place() -> None:
    content = b'{"schema": "mbsd.motion", "mechanism": "four\xff"}'
    with pytest.raises(UserError, match=r"^data\.json: byte 44 is 0xff, which is not UTF-8; rebuild it$"):
        jsonfile.decode(content, Motion, "data.json")


def test_a_missing_file_says_what_to_do(path: Path) -> None:
    with pytest.raises(UserError, match=r"data\.json does not exist; run the stage that writes it first"):
        contract.read_motion(path)


def test_a_folder_in_its_place_is_told(path: Path) -> None:
    path.mkdir()
    with pytest.raises(UserError, match="cannot read"):
        contract.read_motion(path)


BROKEN: dict[str, tuple[Callable[[Motion], object], str]] = {
    "NaN": (lambda m: m.bodies["crank"].x.__setitem__(0, float("nan")), r"bodies\.crank\.x\[0\] is nan"),
    "ragged": (lambda m: m.bodies["crank"].x.pop(), r"bodies\.crank\.x has 12 values"),
    "negative mass": (lambda m: setattr(m.bodies["crank"], "mass", -1.0), r"bodies\.crank\.mass"),
    "wrong type": (lambda m: setattr(m.bodies["crank"], "z", "low"), r"bodies\.crank\.z"),
}


@pytest.mark.parametrize(("damage", "words"), BROKEN.values(), ids=BROKEN.keys())
def test_nothing_broken_is_written_and_the_old_file_stays(
    path: Path, damage: Callable[[Motion], object], words: str
) -> None:
    contract.write_motion(path, MOTION)
    broken = copy.deepcopy(MOTION)
    damage(broken)
    with pytest.raises(UserError, match=words):
        contract.write_motion(path, broken)
    assert path.read_bytes() == CONTENT


def test_parts_round_trip_and_need_their_stl(tmp_path: Path) -> None:
    path = tmp_path / "parts.json"
    contract.write_parts(path, parts_document())
    with pytest.raises(UserError, match=r"bodies\.crank\.pieces\.link\.stl names crank\.stl, .* make parts-four-bar"):
        contract.read_parts(path)
    (tmp_path / "crank.stl").write_bytes(b"solid")
    assert contract.read_parts(path) == parts_document()


PARTS_REFUSED: dict[str, tuple[Edit, str]] = {
    "inches": (lambda d: d["units"].update(length="in"), r"units\.length is 'in'"),
    "steps in metres": (lambda d: d["units"].update({"stl, step": "m"}), r"units\.stl, step is 'm', .* reads 'mm'"),
    "a file elsewhere": (
        lambda d: d["bodies"]["crank"]["pieces"]["link"].update(stl="../../other.stl"),
        r"bodies\.crank\.pieces\.link\.stl is '../../other\.stl'; it must name a file beside parts\.json",
    ),
    "one file for two": (
        lambda d: d["bodies"]["crank"]["pieces"].update(pin=d["bodies"]["crank"]["pieces"]["link"]),
        r"pieces\.pin\.stl names crank\.stl, as bodies\.crank\.pieces\.link\.stl does",
    ),
    "upside down": (
        lambda d: d["bodies"]["crank"]["pieces"]["link"].update(z_range=[0.006, 0.0]),
        r"link\.z_range is \[0\.006, 0\.0\]; the lowest point comes first",
    ),
    "a body of no name": (lambda d: d["bodies"].update({"..": d["bodies"]["crank"]}), r"bodies has the name '\.\.'"),
}  # fmt: skip


@pytest.mark.parametrize(("edit", "words"), PARTS_REFUSED.values(), ids=PARTS_REFUSED.keys())
def test_parts_that_do_not_hold_together_are_refused(tmp_path: Path, edit: Edit, words: str) -> None:
    path = tmp_path / "parts.json"
    (tmp_path / "crank.stl").write_bytes(b"solid")
    document = json.loads(jsonfile.encode(parts_document()))
    edit(document)
    path.write_text(json.dumps(document))
    with pytest.raises(UserError, match=words):
        contract.read_parts(path)


def test_a_clearance_or_shot_that_does_not_hold_together_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "clearance.json"
    provenance = Provenance(inputs="0" * 64, versions={})
    good = Clearance(
        mechanism="x", provenance=provenance, limit=5e-5, resolution=5e-6, interpolation_error=0.0, pairs=[], apart=1
    )
    write_clearance(path, good)
    assert read_clearance(path) == good
    path.write_bytes(path.read_bytes().replace(b'"length": "m"', b'"length": "mm"'))
    with pytest.raises(UserError, match=r"units\.length is 'mm', this program reads 'm'"):
        read_clearance(path)
    shot = tmp_path / "shot.json"
    write_shot(shot, Shot(turns=2))
    shot.write_bytes(shot.read_bytes().replace(b'"turns": 2', b'"turns": 2, "turns": 900'))
    with pytest.raises(UserError, match=r"shot\.json: it has the field 'turns' more than once"):
        read_shot(shot)


def test_units_and_conventions_are_written() -> None:
    document = json.loads(CONTENT)
    assert document["units"]["length"] == "m"
    assert "second body" in document["conventions"]["reaction"]
    assert list(document)[:3] == ["schema", "schema_version", "mechanism"]


def test_both_rows_of_an_event_may_share_its_time(path: Path) -> None:
    ball = bouncing_ball()
    contract.write_motion(path, ball)
    assert contract.read_motion(path) == ball
    row = ball.time.index(ball.events[0].time)
    assert ball.time[row] == ball.time[row + 1]
    with pytest.raises(UserError, match=rf"time\[{row + 1}\] = .* no event has that time. Only right before and after"):
        contract.write_motion(path, msgspec.structs.replace(ball, events=[]))
    leaping = list(ball.bodies["ball"].y)
    leaping[row] += 0.01
    with pytest.raises(UserError, match=r"bodies\.ball\.y jumps from 0\.01 to .* poses may not"):
        body = msgspec.structs.replace(ball.bodies["ball"], y=leaping)
        contract.write_motion(path, msgspec.structs.replace(ball, bodies={"ball": body}))
    with pytest.raises(UserError, match="a motion needs two different times"):
        contract.write_motion(path, msgspec.structs.replace(ball, time=[ball.events[0].time] * len(ball.time)))


def test_a_motion_without_events_is_read_as_before(path: Path) -> None:
    document = json.loads(jsonfile.encode(MOTION))
    del document["events"]
    path.write_text(json.dumps(document))
    assert contract.read_motion(path) == MOTION
