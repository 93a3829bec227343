"""Assemblies of Ondsel: places, reactions and torques as its own solver wrote them into the file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from shared.stage.errors import UserError
from studio.imports.expressions import as_law
from studio.imports.reading import read
from tests.studio.imports.imported import SAMPLES, built


def series(file: Path) -> dict[str, dict[str, np.ndarray]]:
    """Return the rows of numbers by owner, without the input state in front of them."""
    owners: dict[str, dict[str, np.ndarray]] = {}
    owner = "times"
    for line in file.read_text("latin-1").partition("\nTimeSeries")[2].splitlines():
        words = line.split()
        if words and words[0].endswith("Series"):
            owner = words[1].split("/")[-1]
        elif len(words) > 3:
            owners.setdefault(owner, {})[words[0]] = np.array(words[2:], float)
    return owners


@pytest.mark.parametrize("name", ["piston", "Gears", "crank_slider"])
def test_parts_are_where_the_files_own_solver_put_them(name: str) -> None:
    file = SAMPLES / f"{name}.asmt"
    sketch, m, _ = built(file)
    kept = series(file)
    sol = m.sweep(times=kept["times"]["Time"])
    for part in sketch.links:
        body = sol.body(part.lower())
        expected = kept[part]
        place = np.column_stack([expected["X"], expected["Y"]])
        ours = np.column_stack([body.x, body.y])
        assert np.abs(ours - place).max() < 2e-9 * max(np.abs(place).max(), 1.0), part


def test_reactions_and_torque_are_those_of_the_files_own_solver() -> None:
    file = SAMPLES / "piston.asmt"
    _, m, _ = built(file)
    kept = series(file)
    sol = m.sweep(times=kept["times"]["Time"])
    for joint in ("Joint1", "Joint2", "Joint3"):
        theirs = np.column_stack([kept[joint]["FXonI"], kept[joint]["FYonI"]])
        ours = sol.joint(joint).force
        scale = np.abs(theirs).max()
        assert min(np.abs(ours - theirs).max(), np.abs(ours + theirs).max()) < 2e-6 * scale, joint
    torque = kept["Motion1"]["TZonI"]
    ours = sol.driver("Motion1").effort
    assert min(np.abs(ours - torque).max(), np.abs(ours + torque).max()) < 2e-6 * np.abs(torque).max()


SPATIAL = (SAMPLES / "piston.asmt").read_text()


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("RevoluteJoint", "SphericalJoint", "no joint gives the plane of motion"),
        ("CylindricalJoint", "ScrewJoint", "ScrewJoint Joint4 cannot be expressed in the plane of the pins"),
        ("/Assembly1/Part1/Marker2", "/Assembly1/Part1/Marker9", "there is no marker /Assembly1/Part1/Marker9"),
        ("2.0d*pi*time", "step(time)", "'step(time)' is not understood"),
        ("2.0d*pi*time", "__import__('os')", "is not understood"),
        ("\t\t\tRevoluteJoint", "\t\t\t\t\t\tRevoluteJoint", "is indented by 6 tabs below one with"),
        ("MarkerI", "MarkerK", "has no MarkerI"),
    ],
)
def test_spatial_and_damaged_files_are_refused_by_name(tmp_path: Path, old: str, new: str, said: str) -> None:
    assert old in SPATIAL
    file = tmp_path / "a.asmt"
    file.write_text(SPATIAL.replace(old, new))
    with pytest.raises(UserError, match=r"^a\.asmt: ") as refused:
        read(str(file))
    assert said in str(refused.value)


def test_a_law_that_is_zero_at_each_tenth_of_a_second_moves_the_motor(tmp_path: Path) -> None:
    """Samples at tenths take sin(10 pi t) for a motor that stands still."""
    file = tmp_path / "a.asmt"
    file.write_text(SPATIAL.partition("\nTimeSeries")[0].replace("2.0d*pi*time", "0.2d*sin(10.0d*pi*time)"))
    sketch, m, _ = built(file)
    assert sketch.motors[0].law
    still = built(SAMPLES / "piston.asmt")[1].sweep(0.2, steps=40)
    sol = m.sweep(0.2, steps=40)
    turned = sol.driver("Motion1").value - sol.driver("Motion1").value[0]
    np.testing.assert_allclose(np.abs(turned), np.abs(0.2 * np.sin(10 * np.pi * sol.t)), atol=1e-12)
    assert still.t.shape == sol.t.shape


def test_a_machine_in_another_plane_moves_the_same(tmp_path: Path) -> None:
    """The world's axes permuted in the whole file: what lay in x y lies in y z."""
    file = tmp_path / "turned.asmt"
    file.write_text("\n".join(_turned(SPATIAL.partition("\nTimeSeries")[0].splitlines())) + "\n")
    _, flat, _ = built(SAMPLES / "piston.asmt")
    _, m, _ = built(file)
    a, b = flat.sweep(1.0, steps=50), m.sweep(1.0, steps=50)
    assert np.allclose(np.abs(a.driver("Motion1").effort), np.abs(b.driver("Motion1").effort), rtol=1e-9, atol=1e-9)
    assert np.allclose(a.body("part3").y, np.hypot(b.body("part3").x, b.body("part3").y), atol=1e-9)


def _turned(lines: list[str]) -> list[str]:
    """With x, y, z of the assembly as y, z, x: its parts and its markers are turned, what is in them is not."""
    turn = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    out = list(lines)
    for k, line in enumerate(lines):
        word, depth = line.strip(), len(line) - len(line.lstrip("\t"))
        indent = "\t" * (depth + 1)
        if word == "ConstantGravity" or (word in ("Position3D", "Velocity3D", "Omega3D") and depth == 3):
            vector = turn @ np.array(lines[k + 1].split(), float)
            out[k + 1] = indent + " ".join(map(repr, map(float, vector)))
        if word == "RotationMatrix" and depth == 3:
            matrix = turn @ np.array([row.split() for row in lines[k + 1 : k + 4]], float)
            out[k + 1 : k + 4] = [indent + " ".join(map(repr, map(float, row))) for row in matrix]
    return out


@pytest.mark.parametrize(
    ("text", "zero", "rate"),
    [
        ("2.0d*pi*time", 0.0, 2 * np.pi),
        ("1.5 + 3*time", 1.5, 3.0),
        ("-time/2", 0.0, -0.5),
        ("sin(2*time)", 0.0, None),
        ("sin(10*pi*time)", 0.0, None),
        ("time + sin(20*pi*time)", 0.0, None),
        ("time*time", 0.0, None),
        ("sin(1.0)*2 - time*3^2/2", np.sin(1.0) * 2, -4.5),
        ("-(time - 1)*exp(0)", 1.0, -1.0),
        ("time^1.0", 0.0, 1.0),
    ],
)
def test_functions_of_time_are_read(text: str, zero: float, rate: float | None) -> None:
    law = as_law(text, "motion")
    assert law.at_zero == pytest.approx(zero)
    assert law.rate == (None if rate is None else pytest.approx(rate))


@pytest.mark.parametrize(
    "text",
    [
        "",
        "1/0",
        "a",
        "time.real",
        "[1]",
        "lambda: 1",
        "sin(time, 2)",
        "True",
        "(-1)**0.5",
        "1e999*time",
        "9**9**9**9",
        "(" * 300,
        "-" * 5000 + "1",
        "e" * 2000,
        "time\0",
        "1" + "0" * 5000,
    ],
)
def test_texts_that_are_no_function_of_time_are_refused(text: str) -> None:
    with pytest.raises(UserError, match="motion: the function of time"):
        as_law(text, "motion")
