"""Files of Linkage, PMKS, PMKS+ and pylinkage: links, units, directions, what is left out."""

from __future__ import annotations

import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from shared.stage.errors import UserError
from shared.stage.paths import ROOT
from studio.imports.reading import difference, read, read_text
from studio.imports.sketch import GROUND, Link, Motor, Pin, Sketch, Slide
from studio.imports.writing import mechanism_py
from tests.studio.imports.imported import SAMPLES, built

FOUR_BAR = (
    "0P.TY.K,0.101.MA,A,0mv,0VU,0.GB,B,0e_,E6,0.GC,C,l1,WW,0.KD,D,qD,0Pk,0..YRAB,AB,Fe,Fe,0ix,08i,c5cae9,A,B,,"
    ".YRBC,BC,Fe,Fe,32,NJ,303e9f,B,C,,.YRCD,CD,Fe,Fe,nd,3P,0d125a,C,D,,...JBq"
)
"""The four-bar that PMKS+ offers as a start."""
INCH = 0.0254


def test_linkage_is_read_with_its_units_and_its_direction() -> None:
    sketch, m, names = built(SAMPLES / "bench.linkage2")
    assert list(sketch.links) == ["crank", "L1", "rocker", "rod"]  # neither rail, frame nor what is drawn or measured
    assert names["Params"]().crank == pytest.approx(1.0 * INCH)  # 96 units
    assert m.mobility().dof == 1
    sol = m.sweep(steps=90)
    assert sol.t[-1] == pytest.approx(2.0)  # 30 rpm
    assert sol.body("crank").omega == pytest.approx(-math.pi)  # clockwise
    assert (sol.point("P").x[0], sol.point("P").y[0]) == pytest.approx((2 * INCH, 3 * INCH))
    rod = sol.body("rod")
    assert np.allclose(rod.y + names["Params"]().rod * np.sin(rod.theta), -INCH, atol=1e-12)  # in its slot
    assert sketch.left_out == []


def test_an_actuator_of_linkage_drives_a_distance(tmp_path: Path) -> None:
    text = (SAMPLES / "bench.linkage2").read_text().replace('input="true" rpm="30.000000"', "")
    ram = '<Link id="9" name="ram" actuator="true" throw="48" cpm="10"><connector id="1"/><connector id="9"/></Link>'
    file = tmp_path / "a.linkage2"
    file.write_text(text.replace("</linkage2>", ram + "</linkage2>"))
    sketch, m, _ = built(file)
    assert m.mobility().dof == 1
    sol = m.sweep(6.0, steps=60)
    theta = sol.body("crank").theta
    apart = np.hypot(INCH * np.cos(theta), INCH * np.sin(theta) + 2 * INCH)
    assert apart[0] == pytest.approx(math.hypot(1, 2) * INCH)
    assert np.ptp(apart) == pytest.approx(0.5 * INCH, rel=1e-6)
    assert any("actuator ram" in words for words in sketch.left_out)


@pytest.mark.parametrize("name", ["4bar1.txt", "4bar1.pmks"])
def test_pmks_is_read(name: str) -> None:
    _, m, _ = built(SAMPLES / name)
    sol = m.sweep(steps=36)
    assert sol.body("link_input").omega == pytest.approx(10.0)
    assert (sol.point("E").x[0], sol.point("E").y[0]) == pytest.approx((0.5, 0.125))
    assert np.hypot(sol.body("output").x - 0.6, sol.body("output").y - 0.1) == pytest.approx(math.hypot(0.2, 0.38))


@pytest.mark.parametrize("address", [FOUR_BAR, f"https://app.pmksplus.com/?{FOUR_BAR}"])
def test_an_address_of_pmks_plus_is_read(address: str) -> None:
    sketch, m, _ = built(address)
    assert {name: link.points for name, link in sketch.links.items()}["AB"] == {
        "A": pytest.approx((-0.03129, -0.02014)),
        "B": pytest.approx((-0.02622, 0.00902)),
    }
    assert m.mobility().dof == 1
    assert m.sweep(steps=36).body("ab").omega == pytest.approx(-20 * math.tau / 60)  # clockwise


def test_an_address_that_is_cut_off_is_refused_as_one() -> None:
    with pytest.raises(UserError, match=r"it was changed or cut off; copy all of it, in quotes"):
        read("https://app.pmksplus.com/?0P.TY.K,0.101.MA,A,0mv")


def test_pylinkage_is_read() -> None:
    _, m, names = built(SAMPLES / "four_bar_mechanism.json")
    p = names["Params"]()
    assert (p.crank, p.coupler, p.rocker) == pytest.approx((1.0, 3.5, 3.0))
    assert p.speed == pytest.approx(24 * 0.1)  # 0.1 rad a step, 24 steps a second
    assert m.sweep(steps=36).body("rocker").theta[0] == pytest.approx(math.atan2(2.842815, 4 - 3.0416667), abs=1e-6)


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"", "is not a file of a known program; known are: PMKS+"),
        (b"hello", "is not a file of a known program"),
        (b"\0\1\2", "is not text"),
        (b"<linkage2></linkage2>", "the file has no links"),
        (b"ground,input,R,a,b", "is not a file of a known program"),
        (b"mech=\nground,input,R,1,2\nrubbish", "line 3 is not a joint of PMKS"),
        (b'{"joints": [], "links": [{"position": 1}]}', "no file of pylinkage (JSON) (KeyError: 'id')"),
        (b'{"TypeOfJoint"', "its JSON cannot be read"),
        (b"freeCAD\nAssembly\n", "Assembly has no Name"),
    ],
)
def test_unknown_formats_are_refused(tmp_path: Path, content: bytes, said: str) -> None:
    file = tmp_path / "file"
    file.write_bytes(content)
    with pytest.raises(UserError) as refused:
        read(str(file))
    assert said in str(refused.value)


@pytest.mark.parametrize(("written", "metres"), [(".04", 4e-5), ("-.1", -1e-4), ("+2.5e1", 0.025), ("3.", 0.003)])
def test_numbers_of_pmks_may_begin_with_a_point(tmp_path: Path, written: str, metres: float) -> None:
    file = tmp_path / "a.txt"
    file.write_text((SAMPLES / "4bar1.txt").read_text().replace("350.00,100.00", f"{written},{written}"))
    assert read(str(file)).links["input"].points["B"] == pytest.approx((metres, metres))


def test_links_of_pmks_may_be_called_as_a_kind_of_joint(tmp_path: Path) -> None:
    file = tmp_path / "a.txt"
    file.write_text((SAMPLES / "4bar1.txt").read_text().replace("input", "R").replace("output", "P"))
    assert set(read(str(file)).links) == {"R", "coupler", "P"}
    file.write_text("mech=\nground,R,R,x,1,2\n")
    with pytest.raises(UserError, match="line 2 is not a joint of PMKS"):
        read(str(file))


def test_a_slot_of_pmks_has_its_direction_and_carries_all_links_on_it(tmp_path: Path) -> None:
    """The rod slides up and down the ground; the arm on the same pin hangs free."""
    file = tmp_path / "a.txt"
    file.write_text("ground,crank,R,0,0\ncrank,rod,R,30,40\nground,rod,arm,RP,-110,20,-90\narm,R,-200,30\n")
    sketch, m, _ = built(file)
    assert sketch.freedom == sketch.counted_freedom() == m.mobility().dof == 2
    slot = sketch.joints[2]
    assert isinstance(slot, Slide)
    assert (slot.first, slot.second, slot.angle) == (GROUND, "rod", pytest.approx(-math.pi / 2))
    assert sketch.joints[3] == Pin("C_pin", "rod", "arm", slot.place)


def test_a_slider_and_a_floating_pin_of_pmks_are_driven(tmp_path: Path) -> None:
    file = tmp_path / "a.txt"
    lines = ["ground,crank,R,0,0", "crank,rod,R,30,40", "rod,block,R,-60,0", "block,ground,P,-60,0,0"]
    for first, bodies in (3, ("ground", "block")), (1, ("crank", "rod")):  # the first joint is the input
        file.write_text("\n".join([lines[first], *(line for line in lines if line != lines[first])]) + "\n")
        m = built(file)[1]
        assert m.drivers["motor"].bodies == bodies
        assert np.isfinite(m.sweep(0.01, steps=5).driver("motor").effort).all()


def test_freedoms_that_differ_from_the_files_are_said(tmp_path: Path) -> None:
    """Gears of PMKS are left out; the sliders of a Linkage file are lost where their limits are."""
    file = tmp_path / "a.txt"
    file.write_text("ground,a,R,0,0\nground,b,R,30,0\na,b,G,10,0\na,R,1,1\nb,R,31,1\n")
    sketch, m, _ = built(file)
    assert difference(sketch, m).startswith("the degrees of freedom differ: 1 in the file, 2 in this mechanism")
    sketch, m, _ = built(SAMPLES / "bench.linkage2")
    assert difference(sketch, m) == ""
    file.write_text((SAMPLES / "bench.linkage2").read_text().replace("slidelimit", "other"))
    sketch, m, _ = built(file)
    assert difference(sketch, m).startswith("the inputs of the file (1) move all of it there")


def test_freedoms_that_differ_though_nothing_was_left_out_are_an_error() -> None:
    text = (SAMPLES / "slider_crank_mbsd_core.json").read_text().replace('"revolute_joints": 3', '"revolute_joints": 2')
    with pytest.raises(UserError, match="its counts say 2 revolute joints, and there are 3"):
        read_text(text, "a.json")
    sketch = read(str(SAMPLES / "4bar1.txt"))
    del sketch.joints[1]
    with pytest.raises(UserError, match="its degrees of freedom are 1, and 3 of what was read of it; that is a fault"):
        sketch.check()
    sketch.left_out.append("joint B")
    sketch.check()


def test_connectors_of_linkage_that_share_a_name_stay_apart(tmp_path: Path) -> None:
    """A connector that is called as another one's number would be."""
    file = tmp_path / "a.linkage2"
    text = (SAMPLES / "bench.linkage2").read_text()
    file.write_text(text.replace('name=""', 'name="P1"', 1))
    assert built(file)[1].mobility().dof == built(SAMPLES / "bench.linkage2")[1].mobility().dof


def test_names_of_any_form_become_names_of_python() -> None:
    sketch = Sketch('a "quoted"\nname \\ ', "a test")
    for k, name in enumerate(['1st "link"', "class", "m", "Größe", "a b", "a-b", "pi"]):
        sketch.links[name] = Link(name, {f"P{k}": (float(k), 0.0), f"Q{k}": (k + 1.0, 0.5)})
        sketch.joints.append(Pin(f"P{k}", GROUND, name, (float(k), 0.0)))
        sketch.motors.append(Motor(f"motor {k}", GROUND, name, 1.0 + k))
    sketch.left_out = ['what says """ and \\']
    names: dict = {}
    exec(compile(mechanism_py(sketch, "odd"), "mechanism.py", "exec"), names)
    m = names["build"](names["Params"]())
    assert len(m.bodies) == 8
    m.sweep(0.1, steps=2)


def test_the_program_imports_into_a_folder(tmp_path: Path) -> None:
    command = [sys.executable, "-P", "-m", "mbsd"]
    environment = {"PYTHONPATH": str(ROOT), "PATH": "/usr/bin:/bin", "HOME": str(tmp_path)}
    (tmp_path / "Walker 2.linkage2").write_bytes((SAMPLES / "bench.linkage2").read_bytes())
    words = [*command, "import", "Walker 2.linkage2"]
    done = subprocess.run(words, cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "import: walker_2/mechanism.py: 4 links" in done.stdout
    assert "1 degree of freedom" in done.stdout
    assert (tmp_path / "mbsd.toml").is_file()
    again = subprocess.run(words, cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert again.returncode == 1
    assert "walker_2/mechanism.py is there already" in again.stderr
    assert "--as NAME gives another" in again.stderr
    wrong = subprocess.run(
        [*command, "import", "no.txt"], cwd=tmp_path, env=environment, capture_output=True, text=True
    )
    assert (wrong.returncode, "Traceback" in wrong.stderr) == (1, False)
