"""modelDescription.xml: units, variables with their value references, and what depends on what.

Source: FMI 3.0, section 2.4.
"""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from mbsd.native.quantities import INPUT, OUTPUT, PARAMETER, RATE, STATE, Quantity

KINDS = {"kg": {"kg": 1}, "m": {"m": 1}, "rad": {"rad": 1}, "s": {"s": 1}, "s2": {"s": 2}, "m2": {"m": 2},
         "N": {"kg": 1, "m": 1, "s": -2}, "J": {"kg": 1, "m": 2, "s": -2}, "W": {"kg": 1, "m": 2, "s": -3}}  # fmt: skip
"""Exponents of the base units."""
CAUSALITY = {STATE: "local", INPUT: "input", PARAMETER: "parameter", OUTPUT: "output"}


def description(
    name: str, token: str, identifier: str, quantities: Sequence[Quantity], span: tuple[float, float, float],
    tolerance: float, early: bool, exchange: bool,
) -> str:  # fmt: skip
    """The text. ``span``: start, end and step (s); ``early``: whether a step may end where contacts begin and end;
    ``exchange``: whether the unit may be integrated by the importer."""
    root = Element("fmiModelDescription", fmiVersion="3.0", modelName=name, instantiationToken=token,
                   description=f"{name}, a planar mechanism", generationTool="mbsd",
                   variableNamingConvention="flat")  # fmt: skip
    able = {"modelIdentifier": identifier, "needsExecutionTool": "false", "canGetAndSetFMUState": "true",
            "canSerializeFMUState": "true"}  # fmt: skip
    if exchange:
        SubElement(root, "ModelExchange", able)
    steps = {"canHandleVariableCommunicationStepSize": "true"}
    if early:
        steps["mightReturnEarlyFromDoStep"] = "true"
    SubElement(root, "CoSimulation", able | steps)
    _units(root, quantities)
    categories = SubElement(root, "LogCategories")
    for category in ("logStatusWarning", "logStatusError"):
        SubElement(categories, "Category", name=category)
    start, end, step = span
    SubElement(root, "DefaultExperiment", startTime=repr(start), stopTime=repr(end), stepSize=repr(step),
               tolerance=repr(tolerance))  # fmt: skip
    _variables(root, quantities)
    _structure(root, quantities)
    indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + tostring(root, encoding="unicode") + "\n"


def _units(root: Element, quantities: Sequence[Quantity]) -> None:
    units = SubElement(root, "UnitDefinitions")
    for name in sorted({"s", *(quantity.unit for quantity in quantities)}):
        SubElement(SubElement(units, "Unit", name=name), "BaseUnit", _exponents(name))


def _exponents(unit: str) -> dict[str, str]:
    """Exponents of the base units in a unit like N.m/rad."""
    above, _, below = unit.partition("/")
    out: dict[str, int] = {}
    for side, parts in ((1, above), (-1, below)):
        for part in filter(None, parts.split(".")):
            for base, exponent in KINDS[part].items():
                out[base] = out.get(base, 0) + side * exponent
    return {base: str(exponent) for base, exponent in out.items() if exponent}


def _variables(root: Element, quantities: Sequence[Quantity]) -> None:
    variables = SubElement(root, "ModelVariables")
    SubElement(variables, "Float64", name="time", valueReference="0", causality="independent",
               variability="continuous", unit="s")  # fmt: skip
    references = {quantity.name: k for k, quantity in enumerate(quantities, 1)}
    for reference, quantity in enumerate(quantities, 1):
        said = {"name": quantity.name, "valueReference": str(reference), "causality": CAUSALITY[quantity.role],
                "variability": _variability(quantity), "unit": quantity.unit}  # fmt: skip
        if quantity.words:
            said["description"] = quantity.words
        if quantity.role == STATE:
            said["initial"] = "exact"
        if quantity.role != OUTPUT:
            said["start"] = repr(float(quantity.start))
        if quantity.rate_of:
            said["derivative"] = str(references[quantity.rate_of])
        SubElement(variables, "Float64", said)


def _variability(quantity: Quantity) -> str:
    if quantity.role == PARAMETER:
        return "fixed"
    return "discrete" if quantity.kind == RATE else "continuous"


def _structure(root: Element, quantities: Sequence[Quantity]) -> None:
    structure = SubElement(root, "ModelStructure")
    for reference, quantity in enumerate(quantities, 1):
        if quantity.role == OUTPUT:
            SubElement(structure, "Output", valueReference=str(reference))
    for reference, quantity in enumerate(quantities, 1):
        if quantity.rate_of:
            SubElement(structure, "ContinuousStateDerivative", valueReference=str(reference))
    for reference, quantity in enumerate(quantities, 1):
        if quantity.role == OUTPUT:
            SubElement(structure, "InitialUnknown", valueReference=str(reference))
