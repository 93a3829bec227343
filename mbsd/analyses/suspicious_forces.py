"""Forces and joints that look as if something else was meant: bar for pascal, a spring like a bar, a weld at a pin."""

from __future__ import annotations

from collections.abc import Iterator

from mbsd.analyses.finding import Finding
from mbsd.model.mechanism import Model

LEAST_PRESSURE = 1000.0
"""Pa: a hundredth of the air's. Less is a pressure in bar, or a vacuum that nobody needs to give a number."""
STEEL = 2.1e11
"""Young's modulus of steel (Pa)."""
LOOSE = 0.1
"""Part of a bearing's radius: a running fit has about a thousandth, and worn joints some hundredths."""
THICK = 0.1
"""A spring that is stiffer than a solid steel bar as long as the mechanism and this part of it thick is none."""


def pressures(m: Model) -> Iterator[Finding]:
    """Pressures between nothing and a hundredth of the air's."""
    for name, force in m.forces.items():
        for word, value in force.given.items():
            if (
                "pressure" in word
                and word != "pressure_angle"
                and isinstance(value, int | float)
                and 0.0 < value < LEAST_PRESSURE
            ):
                yield Finding(
                    f"force '{name}'", f"{word} is {value:g} Pa, where the air has 101325",
                    "Pressures are in pascal: multiply bar by 1e5",
                )  # fmt: skip


def springs(m: Model, size: float) -> Iterator[Finding]:
    """Springs that are stiffer than a solid bar; ``size`` (m) is the mechanism's."""
    most = STEEL * THICK**2 * size
    for name, force in m.forces.items():
        stiffness = force.params.get("stiffness")
        if "free_length" in force.params and isinstance(stiffness, int | float) and stiffness > most > 0.0:
            yield Finding(
                f"spring '{name}'",
                f"its stiffness of {stiffness:.3g} N/m is more than that of a steel bar as long as the mechanism and a "
                f"tenth as thick ({most:.1e} N/m)",
                "Stiffness is in N/m: N/mm are multiplied by 1000. What does not give way is m.distance or m.weld",
            )


def plays(m: Model) -> Iterator[Finding]:
    """Bearings in which the journal has much room."""
    for name, force in m.forces.items():
        if force.kind.journal is None:
            continue
        radius, clearance = force.kind.journal(force)
        if clearance > LOOSE * (radius + clearance):
            yield Finding(
                f"force '{name}'",
                f"its clearance of {clearance:g} m is {clearance / (radius + clearance):.0%} of the bearing's radius",
                "Clearance and radius are in metres: 0.1 mm is 0.1e-3; a running fit has about a thousandth of the "
                "radius",
            )


def welds(m: Model) -> Iterator[Finding]:
    """Welds between two bodies that another joint connects as well."""
    pairs: dict[frozenset[str], list[str]] = {}
    for name, joint in m.joints.items():
        pairs.setdefault(frozenset(joint.bodies), []).append(name)
    for name, joint in m.joints.items():
        others = [other for other in pairs[frozenset(joint.bodies)] if other != name]
        if {"point", "angle"} <= set(joint.kind.constraints) and others:
            first, second = joint.bodies
            yield Finding(
                f"weld '{name}'",
                f"it fixes '{second}' to '{first}', which '{others[0]}' connects as well and then lets nothing move",
                "Leave one of the two joints out",
            )
