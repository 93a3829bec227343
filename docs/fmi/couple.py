"""A DC motor turns a four-bar: two units, coupled step by step with FMPy. python docs/fmi/couple.py four_bar.fmu"""

from __future__ import annotations

import platform
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

import fmpy
from fmpy.fmi3 import FMU3Slave

HERE = Path(__file__).parent


def motor_unit(folder: Path) -> Path:
    """The motor's unit, compiled and packed."""
    library, file = folder / "dc_motor.so", folder / "dc_motor.fmu"
    command = ["cc", "-O2", "-fPIC", "-shared", str(HERE / "dc_motor.c"), "-o", str(library), "-lm"]
    subprocess.run(command, check=True)
    machine = {"arm64": "aarch64"}.get(platform.machine(), platform.machine())
    with zipfile.ZipFile(file, "w") as archive:
        archive.write(HERE / "modelDescription.xml", "modelDescription.xml")
        archive.write(library, f"binaries/{machine}-linux/dc_motor.so")
    return file


class Unit:
    """A unit whose variables have names."""

    def __init__(self, file: Path) -> None:
        description = fmpy.read_model_description(str(file))
        self.references = {variable.name: variable.valueReference for variable in description.modelVariables}
        assert description.coSimulation is not None
        identifier = description.coSimulation.modelIdentifier
        folder = fmpy.extract(str(file))
        self.slave = FMU3Slave(guid=description.guid, unzipDirectory=folder, modelIdentifier=identifier)
        self.slave.instantiate()
        self.slave.enterInitializationMode(startTime=0.0)
        self.slave.exitInitializationMode()

    def get(self, name: str) -> float:
        """The value of a variable."""
        return self.slave.getFloat64([self.references[name]])[0]

    def set(self, name: str, value: float) -> None:
        """Give an input a value."""
        self.slave.setFloat64([self.references[name]], [value])


def coupled(mechanism: Path, crank: str, duration: float, step: float) -> list[tuple[float, float, float]]:
    """Time (s), speed of the crank (rad/s) and current (A) after each step."""
    with tempfile.TemporaryDirectory() as folder:
        motor, machine = Unit(motor_unit(Path(folder))), Unit(mechanism)
    driven = [name.removesuffix(".rate") for name in machine.references if name.endswith(".rate")]
    if driven:
        raise SystemExit(
            f"error: {mechanism}: driver '{driven[0]}' imposes a motion, whatever torque acts on '{crank}'; "
            "leave it out of build() and export again"
        )
    rows = []
    for k in range(round(duration / step)):
        motor.set("speed", machine.get(f"{crank}.omega"))
        motor.slave.doStep(k * step, step)
        machine.set(f"{crank}.load.torque", motor.get("torque"))
        machine.slave.doStep(k * step, step)
        rows.append(((k + 1) * step, machine.get(f"{crank}.omega"), motor.get("current")))
    return rows


if __name__ == "__main__":
    for time, speed, current in coupled(Path(sys.argv[1]), "crank", 0.5, 1e-3)[49::50]:
        print(f"{time:5.2f} s  {speed:8.3f} rad/s  {current:7.3f} A")
