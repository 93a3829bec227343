"""Models as files: every kind and every law comes back as it was; what cannot be read or kept is refused by name."""

from __future__ import annotations

import copy
import json
import math
import os
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mbsd import Mechanism, ModelError, constant_rate, curve, function, harmonic, table
from mbsd.arrays.loads import pack_loads
from mbsd.arrays.packing import pack
from mbsd.model.body import Body
from mbsd.model.force import FORCE_KINDS, ForceKind
from mbsd.model.joint import KINDS, JointKind
from mbsd.model.laws import Motion
from mbsd.model.laws.examples import EXAMPLES
from mbsd.model.laws.function import Function
from mbsd.saving.document import build, document
from mbsd.saving.schema import content, schema
from mbsd.testing import force_kinds, joint_kinds
from mbsd.testing.forces import evaluate
from mbsd.testing.forces import example as force_example
from mbsd.testing.forces import motion as force_motion
from shared.stage.paths import ROOT
from tools.models import four_bars


def _example(kind: JointKind) -> Mechanism:
    m = Mechanism("example")
    first, second = m.body("first", 1.0, (0.1, -0.2), 0.3), m.body("second", 1.5, (0.3, 0.0), 0.2)
    kind.example(m, first.at(0.11, 0.2, 0.3), second.at(-0.4, 0.5, -0.6))
    return m


def _back(m: Mechanism, tmp_path: Path) -> Mechanism:
    m.save(tmp_path / "model.json")
    loaded = Mechanism.load(tmp_path / "model.json")
    loaded.save(tmp_path / "again.json")
    assert (tmp_path / "model.json").read_bytes() == (tmp_path / "again.json").read_bytes()
    return loaded


def test_a_joint_with_a_python_function_cannot_be_saved(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="example: joint 'example': function"):
        _example(KINDS["constraint"]).save(tmp_path / "model.json")


def test_a_force_with_a_python_function_cannot_be_saved(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="example: force 'example': function"):
        force_example(FORCE_KINDS["user_force"], 0)[0].save(tmp_path / "model.json")


@pytest.mark.parametrize("kind", [kind for kind in joint_kinds() if kind.saved], ids=lambda kind: kind.name)
def test_every_kind_comes_back(kind: JointKind, tmp_path: Path) -> None:
    m = _example(kind)
    jsonschema.validate(document(m), schema())
    here, there = pack(m), pack(_back(m, tmp_path))
    for name, array in here.system._asdict().items():
        np.testing.assert_array_equal(array, getattr(there.system, name), err_msg=name)
    times = np.linspace(0.0, 1.0, 7)
    np.testing.assert_array_equal(here.drives(times), there.drives(times))


@pytest.mark.parametrize("to_ground", [False, True], ids=["two_bodies", "to_ground"])
@pytest.mark.parametrize("kind", [kind for kind in force_kinds() if kind.saved], ids=lambda kind: kind.name)
def test_every_kind_of_force_comes_back(kind: ForceKind, to_ground: bool, tmp_path: Path) -> None:
    m, here = force_example(kind, 3, to_ground)
    jsonschema.validate(document(m), schema())
    there = pack(_back(m, tmp_path))
    t, q, v = force_motion(here, 1)
    for a, b in zip(pack_loads(here), pack_loads(there), strict=True):
        np.testing.assert_array_equal(a, b)
    loads = [evaluate(packed, t, q, v)[0] for packed in (here, there)]
    np.testing.assert_array_equal(*loads)
    assert np.abs(loads[0]).max() > 0


def test_forces_with_laws_curves_and_frames_come_back(tmp_path: Path) -> None:
    m = Mechanism("loads")
    a, b = m.body("a", 1.0, inertia=1.0), m.body("b", 2.0, inertia=1.0)
    m.force("wind", a.at(0.1, 0), harmonic(3.0, 2.0), direction=(1.0, 2.0))
    m.force("jet", a.at(0.1, 0.2), 4.0, direction=0.3, frame=a)
    m.torque("drive", b, harmonic(1.0, 5.0), against=a)
    m.torque("brake", b, -0.5)
    m.motor("motor", a, b, curve([0, 1, 2], [3, 2, 0]))
    m.curve_of_length("buffer", a.origin, b.origin, of_length=curve([0, 1, 2], [3, 2, 0], "linear"))
    jsonschema.validate(document(m), schema())
    loaded = _back(m, tmp_path)
    assert [f.kind.name for f in loaded.forces.values()] == [f.kind.name for f in m.forces.values()]
    assert loaded.forces["drive"].i.body.name == "a"
    assert loaded.forces["jet"].i.angle == 0.3
    m.force("user", b.origin, lambda t: 3.0 * t)
    with pytest.raises(ModelError, match=r"loads: force 'user': force is the Python function .*table\("):
        m.save(tmp_path / "model.json")


@pytest.mark.parametrize("law", EXAMPLES, ids=lambda law: type(law).__name__)
def test_every_law_comes_back_or_is_refused_by_name(law: Motion, tmp_path: Path) -> None:
    m = Mechanism("driven")
    m.drive_angle("motor", m.bar("crank", 1.0), law)
    if isinstance(law, Function):
        with pytest.raises(ModelError, match=r"driven: driver 'motor': its law is the Python function.*table\("):
            m.save(tmp_path / "model.json")
        assert list(tmp_path.iterdir()) == []
        return
    jsonschema.validate(document(m), schema())
    loaded = _back(m, tmp_path).drivers["motor"].motion
    assert loaded is not None
    times = np.linspace(0.0, 1.4, 33)
    np.testing.assert_array_equal(law(times), loaded(times))


@given(lengths=four_bars.crank_rockers(), masses=four_bars.mass_sets(), turned=st.floats(-3, 3))
def test_random_models_come_back_number_for_number(lengths: Any, masses: Any, turned: float) -> None:
    m = four_bars.model(lengths, 1.3, masses, turned, (0.2, -0.7))
    m.trace("P", m.bodies["coupler"].at(0.1, 0.2, 0.3))
    m.start_near(rocker=(1.0, 2.0, 30.0))
    m.start_moving(crank=turned, coupler=(0.1, turned, -2.0))
    written = document(m)
    assert document(build(json.loads(json.dumps(written)), Mechanism)) == written


def test_a_mass_that_was_not_given_stays_so() -> None:
    m = Mechanism("masses")
    m.body("none")
    m.body("zero", mass=0)
    m.bar("some", 0.1, mass=0.3)
    written = document(m)
    jsonschema.validate(written, schema())
    assert [written["bodies"][name]["mass"] for name in ("none", "zero", "some")] == [None, 0.0, 0.3]
    assert [body.mass_given for body in build(written, Mechanism).bodies.values()] == [False, False, True, True]


def test_a_loaded_model_moves_as_the_first(tmp_path: Path) -> None:
    m = four_bars.model((4.0, 1.0, 3.5, 3.0), 2.0)
    a, b = m.sweep(steps=12), _back(m, tmp_path).sweep(steps=12)
    np.testing.assert_array_equal(a.q, b.q)
    np.testing.assert_array_equal(a.lam, b.lam)


def test_all_that_a_model_holds_is_in_its_file() -> None:
    assert {field.name for field in fields(Mechanism)} <= set(schema()["properties"])
    assert {field.name for field in fields(Body)} == {
        "name",
        "owner",
        "mass_given",
        "derived",
        *schema()["$defs"]["body"]["properties"],
    }


def test_the_published_schema_is_current() -> None:
    published = (ROOT / "docs" / "schema" / "model.schema.json").read_bytes()
    assert published == content(), "run make schema"
    jsonschema.Draft202012Validator.check_schema(json.loads(published))


def test_the_schema_knows_every_kind() -> None:
    parts = {part: schema()["$defs"][part]["oneOf"] for part in ("joint", "driver", "force")}
    known = {part: {kind["properties"]["kind"]["const"] for kind in kinds} for part, kinds in parts.items()}
    assert known["joint"] | known["driver"] == {kind.name for kind in KINDS.values() if kind.saved}
    assert known["force"] == {kind.name for kind in FORCE_KINDS.values() if kind.saved}


def _change(*path: str, to: Any) -> Callable[[dict], None]:
    def change(written: dict) -> None:
        for key in path[:-1]:
            written = written[key]
        if to is None:
            del written[path[-1]]
        else:
            written[path[-1]] = to

    return change


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (_change("schema", to="mbsd.motion"), r"schema is 'mbsd.motion', this program reads 'mbsd.model'"),
        (_change("schema_version", to=99), r"schema_version is 99, this program reads 1; save the model again"),
        (_change("schema_version", to=None), "schema_version is missing"),
        (
            _change("joints", "A", "kind", to="ball"),
            r"joints\.A: there is no joint of kind 'ball'; there is: .*revolute",
        ),
        (_change("joints", "A", "kind", to="drive_angle"), "there is no joint of kind 'drive_angle'"),
        (
            _change("drivers", "motor", "law", "law", to="wobble"),
            r"drivers\.motor: there is no law 'wobble'; .*harmonic",
        ),
        (_change("drivers", "motor", "law", "law", to="function"), "there is no law 'function'"),
        (_change("drivers", "motor", "law", "speed", to=1.0), r"drivers\.motor: .*unexpected keyword argument 'speed'"),
        (_change("drivers", "motor", "law", "rate", to="fast"), r"drivers\.motor: .*number"),
        (
            _change("bodies", "crank", "mass", to=-1.0),
            r"bodies\.crank: .*'crank' has mass -1 kg; it cannot be negative",
        ),
        (_change("bodies", "crank", "mass", to=math.nan), r"bodies\.crank\.mass is nan; every number must be finite"),
        (_change("bodies", "crank", "com", to=[1.0]), r"com is \[1\.0\]; it must be a list of 2 numbers"),
        (_change("bodies", "crank", "weight", to=1.0), r"bodies\.crank: there is no field 'weight'; there is: mass"),
        (_change("bodies", "crank", "mass", to=None), r"bodies\.crank: the field 'mass' is missing"),
        (_change("bodies", "crank", to=3), r"bodies\.crank is 3; it must be an object"),
        (_change("joints", "A", "i", "body", to="moon"), r"joints\.A\.i: .*no body 'moon'"),
        (_change("joints", "A", "i", "x", to="left"), r"joints\.A\.i\.x is 'left'; it must be a number"),
        (_change("joints", "A", "params", "length", to=1.0), r"joints\.A: .*unexpected keyword argument 'length'"),
        (_change("joints", "R", "params", "length", to=-1.0), r"joints\.R: .*length -1 m; it must be positive"),
        (_change("joints", "R", "params", "length", to=None), r"joints\.R: .*missing a required argument: 'length'"),
        (_change("starts", "moon", to={"angle": 0.0, "place": None}), r"starts\.moon: .*no body 'moon'"),
        (_change("springs", to={}), "there is no field 'springs'"),
        (_change("name", to=7), r"name is 7; it must be a text"),
    ],
)
def test_a_wrong_file_is_refused(change: Callable[[dict], None], says: str, tmp_path: Path) -> None:
    m = four_bars.model((4.0, 1.0, 3.5, 3.0))
    m.distance("R", m.ground.at(0, 1), m.bodies["rocker"].at(0, 1), 2.0)
    written = copy.deepcopy(document(m))
    change(written)
    path = tmp_path / "model.json"
    path.write_text(json.dumps(written))
    with pytest.raises(ModelError, match=says) as refusal:
        Mechanism.load(path)
    assert str(path) in str(refusal.value)
    beyond_a_schema = any(word in says for word in ("moon", "must be positive", "nan"))
    assert jsonschema.Draft202012Validator(schema()).is_valid(written) == beyond_a_schema


def test_a_truncated_file_is_refused_at_every_length(tmp_path: Path) -> None:
    path = tmp_path / "model.json"
    four_bars.model((4.0, 1.0, 3.5, 3.0)).save(path)
    whole = path.read_bytes()
    for length in range(0, len(whole) - 2, 97):
        path.write_bytes(whole[:length])
        with pytest.raises(ModelError, match=r"not a whole JSON file \(.*\); save the model again"):
            Mechanism.load(path)


def test_twins_other_types_and_missing_files_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "model.json"
    path.write_text('{"name": "a", "name": "b"}')
    with pytest.raises(ModelError, match="two of the name 'name'"):
        Mechanism.load(path)
    path.write_text("[1, 2]")
    with pytest.raises(ModelError, match=r"is \[1, 2\]; it must be an object"):
        Mechanism.load(path)
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ModelError, match="not a whole JSON file"):
        Mechanism.load(path)
    with pytest.raises(ModelError, match=r"cannot read .*nowhere.json: No such file"):
        Mechanism.load(tmp_path / "nowhere.json")


def test_a_refused_save_leaves_the_older_file(tmp_path: Path) -> None:
    path = tmp_path / "model.json"
    m = Mechanism("driven")
    m.drive_angle("motor", m.bar("crank", 1.0), constant_rate(1.0))
    m.save(path)
    before = path.read_bytes()
    m.drive_angle("other", m.bar("rod", 1.0), function(math.sin))
    with pytest.raises(ModelError, match="driver 'other': its law is the Python function 'sin'"):
        m.save(path)
    assert path.read_bytes() == before
    assert [file.name for file in tmp_path.iterdir()] == ["model.json"]


def test_a_save_that_dies_half_way_leaves_the_older_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "model.json"
    Mechanism("one").save(path)

    def full_disk(_handle: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full_disk)
    with pytest.raises(ModelError, match=r"cannot write .*No space left on device; choose another place"):
        Mechanism("two").save(path)
    monkeypatch.undo()
    assert Mechanism.load(path).name == "one"
    assert [file.name for file in tmp_path.iterdir()] == ["model.json"]
    with pytest.raises(ModelError, match="cannot write"):
        Mechanism("two").save(tmp_path / "no_folder" / "model.json")


def test_tables_keep_every_digit(tmp_path: Path) -> None:
    t = np.linspace(0.0, 1.0, 11) / 3.0
    m = Mechanism("driven")
    m.drive_angle("motor", m.bar("crank", 0.1 + 0.2), table(t, np.sin(t)))
    loaded = _back(m, tmp_path)
    assert loaded.bodies["crank"].length == 0.1 + 0.2
    np.testing.assert_array_equal(pack(loaded).drives(t), pack(m).drives(t))


def test_a_byte_order_mark_is_no_part_of_a_model(tmp_path: Path) -> None:
    path = tmp_path / "model.json"
    Mechanism("swing").save(path)
    path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())
    assert Mechanism.load(path).name == "swing"
