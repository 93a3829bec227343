"""The motion of a model at a scale: that of the machine, geometrically similar; angles and times stay. And what a
refusal of its parts adds.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import msgspec

from shared.shapes.fit import Fit

if TYPE_CHECKING:
    from shared.contract import Motion
    from shared.contract.loads import Shape
    from shared.contract.motion import BodyMotion, JointMotion
    from shared.stage.scale import Scale

LENGTHS = ("x", "y", "vx", "vy", "ax", "ay")
"""Series of a body that are lengths and their rates."""
OF_SHAPE = ("radius_first", "radius_second", "pin_radius", "length")


def at_scale(motion: Motion, ratio: float) -> Motion:
    """What the proof of clearance reads of a motion, ``ratio`` times as large; loads, masses and energies stay those of
    the machine.
    """
    bodies = {name: _body(body, ratio) for name, body in motion.bodies.items()}
    joints = {name: _joint(joint, ratio) for name, joint in motion.joints.items()}
    return msgspec.structs.replace(motion, bodies=bodies, joints=joints)


def _body(body: BodyMotion, ratio: float) -> BodyMotion:
    return msgspec.structs.replace(body, **{name: _times(getattr(body, name), ratio) for name in LENGTHS})


def _joint(joint: JointMotion, ratio: float) -> JointMotion:
    shape = joint.shape and _shape(joint.shape, ratio)
    return msgspec.structs.replace(joint, x=_times(joint.x, ratio), y=_times(joint.y, ratio), shape=shape)


def _shape(shape: Shape, ratio: float) -> Shape:
    (x, y, a), (u, v, b) = shape.markers
    lengths = {name: value * ratio for name in OF_SHAPE if (value := getattr(shape, name)) is not None}
    outline = [(px * ratio, py * ratio) for px, py in shape.outline]
    markers = (x * ratio, y * ratio, a), (u * ratio, v * ratio, b)
    return msgspec.structs.replace(shape, markers=markers, outline=outline, **lengths)


def _times(values: list[float], ratio: float) -> list[float]:
    return [value * ratio for value in values]


def what_shrinks(scale: Scale) -> str:
    """The end of a refusal of parts at ``scale``: why a parts.py that fits its machine need not fit the model."""
    running = Fit().running
    return (
        f"what a parts.py gives in millimetres, clearances too, shrinks with the machine: Fit(running="
        f"{running / scale.ratio:.3g}) leaves {running:g} mm at {scale}, and fit_at_scale(pin) of mechanisms.automatic "
        "chooses for any scale; without a parts.py pins and fits are chosen for the scale"
    )
