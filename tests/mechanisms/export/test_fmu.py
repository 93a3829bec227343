"""An exported unit is valid, runs without Python, and moves as m.simulate does: in steps of its own and of others."""

from __future__ import annotations

import math
import platform
import re
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism, polynomial
from mechanisms.stages.export.fmu import fmu
from shared.stage.errors import UserError
from tests.mechanisms.export.unit_models import bouncing, driven, four_bar, geared, lifting, rubbing

fmpy = pytest.importorskip("fmpy")
from fmpy.fmi3 import FMU3Model, FMU3Slave  # noqa: E402
from fmpy.validation import validate_fmu  # noqa: E402

pytestmark = pytest.mark.skipif(not shutil.which("cc"), reason="there is no C compiler")


MODELS: dict[str, tuple[Callable[[], Mechanism], float, int]] = {
    "four_bar": (four_bar, 0.5, 100),
    "driven": (driven, 1.0, 50),
    "geared": (geared, 0.4, 40),
    "rubbing": (rubbing, 1.0, 50),
    "lifting": (lifting, 0.3, 30),
}


@pytest.fixture(scope="module")
def unit(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., str]:
    """The file of a mechanism's unit."""
    folder = tmp_path_factory.mktemp("units")

    def write(m: Mechanism, duration: float = 1.0, steps: int = 50) -> str:
        content, _ = fmu(m.simulate(duration, steps=steps, tolerance=1e-9))
        path = folder / f"{m.name}{len(list(folder.iterdir()))}.fmu"
        path.write_bytes(content)
        return str(path)

    return write


def outputs(path: str) -> list[str]:
    return [v.name for v in fmpy.read_model_description(path).modelVariables if v.causality == "output"]


def assert_same(result: Any, sol: Any, tolerance: float) -> None:
    """Each column of the solution that the unit has, by the largest of its unit."""
    frame = sol.to_frame()
    size: dict[str, float] = {}
    for column in frame.columns:
        kind = column.split(" [")[-1]
        size[kind] = max(size.get(kind, 0.0), float(np.abs(frame[column]).max()), 1e-3)
    compared = 0
    for column in frame.columns:
        name, kind = column.split(" [")
        if name in result.dtype.names:
            compared += 1
            error = np.abs(np.asarray(result[name]) - frame[column].to_numpy()).max() / size[kind]
            assert error < tolerance, f"{name}: {error:.1e}"
    assert compared > 10


@pytest.mark.parametrize("name", MODELS)
def test_it_moves_as_simulate_does(name: str, unit: Any) -> None:
    make, duration, steps = MODELS[name]
    sol = make().simulate(duration, steps=steps, tolerance=1e-11)
    path = unit(make(), duration, steps)
    assert validate_fmu(path) == []
    run = {"stop_time": duration, "output_interval": duration / steps, "output": outputs(path)}
    assert_same(
        fmpy.simulate_fmu(path, fmi_type="CoSimulation", step_size=duration / steps, **run),
        sol,
        1e-6 if name == "lifting" else 1e-7,
    )
    by_importer = fmpy.simulate_fmu(path, fmi_type="ModelExchange", relative_tolerance=1e-9, record_events=False, **run)
    rows = np.searchsorted(by_importer["time"], sol.t - 1e-9)
    assert_same(by_importer[rows], sol, 1e-4 if name in ("rubbing", "lifting") else 1e-6)


class Unit:
    """A unit step by step."""

    def __init__(self, path: str, **start: float) -> None:
        description = fmpy.read_model_description(path)
        self.references = {v.name: v.valueReference for v in description.modelVariables}
        self.folder = fmpy.extract(path)
        identifier = description.coSimulation.modelIdentifier
        self.slave = FMU3Slave(guid=description.guid, unzipDirectory=self.folder, modelIdentifier=identifier)
        self.time = 0.0
        self.slave.instantiate(earlyReturnAllowed=bool(start.pop("early", 0.0)))
        self.set(**start)
        self.slave.enterInitializationMode(startTime=0.0)
        self.slave.exitInitializationMode()

    def set(self, **values: float) -> None:
        for name, value in values.items():
            self.slave.setFloat64([self.references[name]], [value])

    def get(self, *names: str) -> list[float]:
        return self.slave.getFloat64([self.references[name] for name in names])

    def step(self, step: float, count: int = 1) -> None:
        for _ in range(count):
            _, _, _, self.time = self.slave.doStep(self.time, step)


def test_forces_and_torques_from_outside(unit: Any) -> None:
    m = four_bar()
    there = Unit(unit(m))
    there.set(**{"coupler.load.fx": 1.5, "coupler.load.fy": -0.5, "rocker.load.torque": 0.02})
    there.step(0.05, 6)
    loaded = four_bar()
    coupler = loaded.bodies["coupler"]
    loaded.force("push", coupler.at(*coupler.com), 1.5)
    loaded.force("press", coupler.at(*coupler.com), -0.5, (0, 1))
    loaded.torque("turn", loaded.bodies["rocker"], 0.02)
    body = loaded.simulate(0.3, steps=6, tolerance=1e-11).body("rocker")
    assert there.get("rocker.theta", "rocker.omega") == pytest.approx([body.theta[-1], body.omega[-1]], abs=1e-7)


def test_parameters_are_those_of_a_changed_model(unit: Any) -> None:
    changed = {f"{name}.mass": 0.5 for name in ("crank", "coupler", "rocker")}
    there = Unit(unit(four_bar()), **{**changed, "spring.stiffness": 80.0, "gravity.y": -3.7})
    there.step(0.05, 6)
    m = four_bar(stiffness=80.0, mass=0.5)
    m.gravity = (0.0, -3.7)
    sol = m.simulate(0.3, steps=6, tolerance=1e-11)
    joint = sol.joint("B")
    assert there.get("crank.theta", "B.fx", "B.fy") == pytest.approx(
        [sol.body("crank").theta[-1], joint.fx[-1], joint.fy[-1]], abs=1e-6
    )
    assert there.get("energy.kinetic")[0] == pytest.approx(sol.energy.kinetic[-1], abs=1e-8)


def test_the_rate_of_a_driver_changes_and_its_angle_goes_on(unit: Any) -> None:
    there = Unit(unit(driven()))
    there.step(0.1, 3)
    there.set(**{"motor.rate": 3.0})
    there.step(0.1, 2)
    m = driven()
    turned = 0.3 * 2 * math.pi + 0.2 * 3.0
    m.change("motor", law=polynomial(turned, 3.0))
    sol = m.simulate(0.01, steps=1)
    assert there.get("motor.value", "motor.speed") == pytest.approx([turned, 3.0], abs=1e-12)
    want = [
        sol.body("rocker").theta[0],
        sol.body("rocker").omega[0],
        sol.joint("B").fx[0],
        sol.driver("motor").effort[0],
    ]
    got = there.get("rocker.theta", "rocker.omega", "B.fx", "motor.effort")
    assert np.exp(1j * got[0]) == pytest.approx(np.exp(1j * want[0]), abs=1e-9)
    assert got[1:] == pytest.approx(want[1:], abs=1e-8)


def test_a_state_is_kept_and_returned_to(unit: Any) -> None:
    there = Unit(unit(four_bar()))
    there.step(0.05, 2)
    state = there.slave.getFMUState()
    there.step(0.05, 4)
    ahead = there.get("rocker.theta", "B.fx", "work")
    kept = there.slave.serializeFMUState(state)
    there.slave.setFMUState(there.slave.deserializeFMUState(kept))
    there.time = 0.1
    there.step(0.05, 4)
    assert there.get("rocker.theta", "B.fx", "work") == ahead
    there.slave.reset()
    there.slave.enterInitializationMode(startTime=0.0)
    there.slave.exitInitializationMode()
    there.time = 0.0
    there.step(0.05, 6)
    assert there.get("rocker.theta") == pytest.approx(ahead[:1], abs=1e-8)


def test_a_state_of_another_unit_is_refused(unit: Any) -> None:
    """It was taken, and the unit moved with the lengths of the other."""
    other = four_bar()
    other.change("coupler", length=0.125)
    there, longer = Unit(unit(four_bar())), Unit(unit(other))
    for each in (there, longer):
        each.step(0.05, 2)
    state = longer.slave.getFMUState()
    kept = longer.slave.serializeFMUState(state)
    before = there.get("rocker.theta", "B.fx")
    assert len(kept) == len(there.slave.serializeFMUState(there.slave.getFMUState())), "their size does not tell"
    with pytest.raises(Exception, match="fmi3DeserializeFMUState"):
        there.slave.deserializeFMUState(kept)
    with pytest.raises(Exception, match="fmi3SetFMUState"):
        there.slave.setFMUState(state)
    assert there.get("rocker.theta", "B.fx") == before
    longer.slave.setFMUState(longer.slave.deserializeFMUState(kept))


def test_work_and_energy_balance(unit: Any) -> None:
    there = Unit(unit(four_bar()))
    names = "energy.kinetic", "energy.gravity", "work"
    before = there.get(*names)
    there.step(0.05, 6)
    after = there.get(*names)
    assert after[2] != pytest.approx(0.0, abs=1e-3)
    assert after[0] + after[1] - after[2] == pytest.approx(before[0] + before[1] - before[2], abs=1e-7)


def test_a_step_may_end_early_where_a_contact_begins(unit: Any) -> None:
    path = unit(bouncing())
    begins = math.sqrt(2 * 0.25 / 9.80665)
    there = Unit(path, early=1.0)
    there.step(1.0)
    assert there.time == pytest.approx(begins, abs=1e-3)
    assert there.get("ball.y")[0] == pytest.approx(0.05, abs=5e-3)
    whole = Unit(path)
    whole.step(0.5)
    assert whole.time == 0.5
    while there.time < 0.5 - 1e-12:
        there.step(0.5 - there.time)
    ball = bouncing().simulate(0.5, steps=2, tolerance=1e-11).body("ball")
    for unit_at_end in (whole, there):
        assert unit_at_end.get("ball.y", "ball.vy") == pytest.approx([ball.y[-1], ball.vy[-1]], abs=1e-6)


def test_invalid_models_are_refused_in_words(unit: Any) -> None:
    path, said = unit(four_bar()), []
    description = fmpy.read_model_description(path)
    identifier = description.coSimulation.modelIdentifier
    slave = FMU3Slave(guid=description.guid, unzipDirectory=fmpy.extract(path), modelIdentifier=identifier)

    def log(_environment: Any, _status: int, _category: bytes, message: bytes) -> None:
        said.append(message.decode())

    slave.instantiate(loggingOn=True, logMessage=fmpy.fmi3.fmi3LogMessageCallback(log))
    references = {v.name: v.valueReference for v in description.modelVariables}
    for name, value, words in (
        ("crank.mass", -1.0, "crank.mass is -1; it must be positive"),
        ("gravity.x", math.nan, "gravity.x: nan is no number"),
        ("B.fx", 1.0, "B.fx is no input"),
    ):
        with pytest.raises(Exception, match="fmi3SetFloat64"):
            slave.setFloat64([references[name]], [value])
        assert words in said[-1]
    with pytest.raises(Exception, match="fmi3EnterInitializationMode"):
        slave.enterInitializationMode(startTime=2.0)
    assert "it starts at t = 0 s, not at 2 s" in said[-1]
    slave.setFloat64([references["crank.center.x"]], [3.0])
    slave.enterInitializationMode(startTime=0.0)
    with pytest.raises(Exception, match="fmi3ExitInitializationMode"):
        slave.exitInitializationMode()
    assert "to fulfil the constraints" in said[-1]


def test_a_wrong_token_makes_no_instance(unit: Any) -> None:
    path = unit(geared())
    identifier = fmpy.read_model_description(path).modelExchange.modelIdentifier
    with pytest.raises(Exception, match="instantiate"):
        FMU3Model(guid="{0}", unzipDirectory=fmpy.extract(path), modelIdentifier=identifier).instantiate()


MAIN = r"""
#include <dlfcn.h>
#include <stdio.h>
#include "fmi.h"
#define LOAD(type, name) type = dlsym(unit, name)
int main(int count, char **words) {
    (void)count;
    void *unit = dlopen(words[1], RTLD_NOW | RTLD_LOCAL);
    if (!unit) { puts(dlerror()); return 1; }
    LOAD(void *(*make)(Text, Text, Text, bool, bool, bool, bool, const Reference *, size_t, void *, Log,
         IntermediateUpdate), "fmi3InstantiateCoSimulation");
    LOAD(Status (*begin)(void *, bool, double, double, bool, double), "fmi3EnterInitializationMode");
    LOAD(Status (*ready)(void *), "fmi3ExitInitializationMode");
    LOAD(Status (*step)(void *, double, double, bool, bool *, bool *, bool *, double *), "fmi3DoStep");
    LOAD(Status (*get)(void *, const Reference *, size_t, double *, size_t), "fmi3GetFloat64");
    void *it = make("it", words[2], "", false, false, false, false, NULL, 0, NULL, NULL, NULL);
    if (!it || begin(it, false, 0, 0, false, 0) || ready(it)) return 2;
    bool event, end, early;
    double last, value;
    Reference which = (Reference)atoi(words[3]);
    for (int k = 0; k < 10; k++)
        if (step(it, 0.05 * k, 0.05, true, &event, &end, &early, &last)) return 3;
    if (get(it, &which, 1, &value, 1)) return 4;
    printf("%.17g\n", value);
    return 0;
}
"""


def test_a_program_in_c_runs_it_without_python(unit: Any, tmp_path: Path) -> None:
    if platform.system() != "Linux":
        pytest.skip("dlopen and nm as on Linux")
    path = unit(four_bar())
    with zipfile.ZipFile(path) as archive:
        archive.extractall(tmp_path)
    (library,) = tmp_path.glob("binaries/*/*.so")
    named = subprocess.run(["nm", "-D", str(library)], capture_output=True, text=True, check=True).stdout
    assert not re.search(r"Py|numba|NRT|python", named)
    assert "TEXTREL" not in subprocess.run(["readelf", "-d", str(library)], capture_output=True, text=True).stdout
    (tmp_path / "main.c").write_text(MAIN.replace("#include <stdio.h>", "#include <stdio.h>\n#include <stdlib.h>"))
    program = tmp_path / "main"
    subprocess.run(
        ["cc", "-I", str(tmp_path / "sources"), str(tmp_path / "main.c"), "-o", str(program), "-ldl"], check=True
    )
    description = fmpy.read_model_description(path)
    reference = next(v.valueReference for v in description.modelVariables if v.name == "rocker.theta")
    done = subprocess.run(
        [str(program), str(library), description.guid, str(reference)], capture_output=True, text=True, env={}
    )
    assert done.returncode == 0, done.stdout
    theta = four_bar().simulate(0.5, steps=10, tolerance=1e-11).body("rocker").theta[-1]
    assert float(done.stdout) == pytest.approx(theta, abs=1e-7)


def test_functions_in_python_are_refused_by_name() -> None:
    stopped = Mechanism("door")
    leaf = stopped.bar("leaf", 0.5, mass=1.0)
    stopped.revolute("hinge", stopped.ground.origin, leaf.start, limits=(-0.5, 3.0))
    own = four_bar()
    own.user_force("wind", lambda t, q, v: [math.sin(t), 0.0, 0.0], own.bodies["coupler"])
    for m, words in ((stopped, "'hinge lower' opens, closes or sticks"), (own, "force 'wind' is a function of Python")):
        with pytest.raises(UserError, match=words):
            fmu(m.simulate(0.05, steps=5))


def test_without_a_compiler_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    monkeypatch.delenv("CC", raising=False)
    with pytest.raises(UserError, match="needs a C compiler"):
        fmu(four_bar().simulate(0.05, steps=5))


AGAIN = """
import hashlib, sys
from tests.mechanisms.export.unit_models import driven, geared
from mechanisms.stages.export.fmu import fmu
if sys.argv[1] == "other":
    fmu(geared().simulate(0.1, steps=5))
print(hashlib.sha256(fmu(driven().simulate(1.0, steps=50))[0]).hexdigest())
"""


def test_the_same_mechanism_gives_the_same_bytes_in_every_process() -> None:
    made = {
        subprocess.run([sys.executable, "-c", AGAIN, which], capture_output=True, text=True, check=True).stdout
        for which in ("alone", "other")
    }
    assert len(made) == 1


def test_rates_of_drivers_and_constant_forces_are_inputs(unit: Any) -> None:
    inputs = {
        v.name: v.start for v in fmpy.read_model_description(unit(geared())).modelVariables if v.causality == "input"
    }
    assert float(inputs["motor.torque"]) == 0.02
    steady = {v.name for v in fmpy.read_model_description(unit(driven())).modelVariables if v.causality == "input"}
    assert "motor.rate" in steady
