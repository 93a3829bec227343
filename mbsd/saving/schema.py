"""The published schema of a saved model: ``make schema`` writes docs/schema/model.schema.json.

Kinds and laws are read off the registries and the signatures of their methods.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import mbsd.model.building  # noqa: F401 (it registers all kinds)
from mbsd.base.files import write_whole
from mbsd.model.change import Role, arguments
from mbsd.model.cylinders.cycle import GasCycle
from mbsd.model.force import FORCE_KINDS
from mbsd.model.joint import CONTACT_KINDS, KINDS
from mbsd.saving.document import SCHEMA, SCHEMA_VERSION
from mbsd.saving.laws import CYCLES, loadable_laws

NUMBER: dict[str, Any] = {"type": "number"}
PAIR: dict[str, Any] = {"type": "array", "items": NUMBER, "minItems": 2, "maxItems": 2}
TYPES: dict[Any, dict[str, Any]] = {
    float: NUMBER,
    int: {"type": "integer"},
    bool: {"type": "boolean"},
    str: {"type": "string"},
    Sequence[int]: {"type": "array", "items": {"type": "integer"}},
    Sequence[float]: {"type": "array", "items": NUMBER},
    type(None): {"type": "null"},
    GasCycle: {"$ref": "#/$defs/cycle"},
}
"""Arguments of other types are whatever they are."""


def schema() -> dict[str, Any]:
    """The JSON Schema of a saved model."""
    along = {"z": ({"type": ["number", "null"]}, False)}
    marker = _object({"body": {"type": "string"}, "x": NUMBER, "y": NUMBER, "angle": NUMBER}, along)
    body = _object(  # com and inertia of a bar that is a uniform rod are null
        {
            "mass": {"type": ["number", "null"], "minimum": 0},
            "com": {"anyOf": [PAIR, {"type": "null"}]},
            "inertia": {"type": ["number", "null"], "minimum": 0},
            "length": {"type": ["number", "null"], "exclusiveMinimum": 0},
        },
        along | {"products": ({"anyOf": [PAIR, {"type": "null"}]}, False), "looks": ({"type": "string"}, False)},
    )
    start, velocity = (
        _object({key: NUMBER, "place": {"anyOf": [PAIR, {"type": "null"}]}}) for key in ("angle", "omega")
    )
    laws, cycles = (
        [
            _object({"law": {"const": name}}, _parameters(f))
            for name, f in loadable_laws().items()
            if f.__module__.startswith(CYCLES) == cycles
        ]
        for cycles in (False, True)
    )
    top = {
        "schema": {"const": SCHEMA},
        "schema_version": {"const": SCHEMA_VERSION},
        "name": {"type": "string", "minLength": 1},
        "gravity": PAIR,
        "bodies": _table("body"),
        "joints": _table("joint"),
        "drivers": _table("driver"),
        "forces": _table("force"),
        "contacts": _table("contact"),
        "traces": _table("marker"),
        "starts": _table("start"),
        "velocities": _table("velocity"),
    }
    definitions = {"marker": marker, "body": body, "start": start, "velocity": velocity, "law": {"oneOf": laws}}
    definitions["cycle"] = {"oneOf": cycles}
    corners = {"type": "array", "minItems": 2, "items": PAIR | {"minItems": 3, "maxItems": 3}}
    definitions["outline"] = _object({"body": {"type": "string"}, "corners": corners, "hole": {"type": "boolean"}})
    definitions["joint"] = {
        "oneOf": [_kind(name) for name, kind in sorted(KINDS.items()) if kind.saved and not kind.driven]
    }
    definitions["driver"] = {"oneOf": [_kind(name) for name, kind in sorted(KINDS.items()) if kind.driven]}
    definitions["force"] = {"oneOf": [_force(name) for name, kind in sorted(FORCE_KINDS.items()) if kind.saved]}
    definitions["contact"] = {"oneOf": [_contact(name) for name in sorted(CONTACT_KINDS)]}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Model",
        "description": "A mechanism: SI units, radians, counter-clockwise. Body 'ground' is always there.",
        **_object(
            top, {"outlines": (_table("outline"), False), "events": ({"type": "object", "maxProperties": 0}, False)}
        ),
        "$defs": definitions,
    }


def content() -> bytes:
    """The schema as published."""
    return (json.dumps(schema(), indent=2) + "\n").encode()


def _adds(name: str) -> Callable[..., Any]:
    """The function that adds one of a kind of joint, driver, force or contact."""
    kind = (KINDS | CONTACT_KINDS | FORCE_KINDS)[name]
    assert kind.add is not None
    return kind.add


def _kind(name: str) -> dict[str, Any]:
    reference = {"$ref": "#/$defs/marker"}
    fixed: dict[str, Any] = {"kind": {"const": name}, "i": reference, "j": reference}
    fixed["params"] = _object({}, _parameters(_adds(name)))
    if KINDS[name].driven:
        fixed["law"] = {"$ref": "#/$defs/law"}
    return _object(fixed)


def _contact(name: str) -> dict[str, Any]:
    reference = {"$ref": "#/$defs/marker"}
    params = _object({}, _parameters(_adds(name)))
    return _object({"kind": {"const": name}, "i": reference, "j": reference, "params": params})


def _force(name: str) -> dict[str, Any]:
    reference = {"$ref": "#/$defs/marker"}
    method = _adds(name)
    params, law = _parameters(method), ({"$ref": "#/$defs/law"}, False)
    laws = {parameter.name: law for parameter in arguments(method) if parameter.role in (Role.AMOUNT, Role.CURVE)}
    amounts = {key: (NUMBER, False) for key in laws if key in params}
    fixed = {"kind": {"const": name}, "i": reference, "j": reference}
    return _object(fixed | {"params": _object({}, params | amounts), "laws": _object({}, laws)})


def _parameters(function: Callable[..., Any]) -> dict[str, tuple[dict[str, Any], bool]]:
    """Return schemas of a method's or law's own arguments, with True if one is required.

    Names, markers, bodies and laws are left out.
    """
    out = {}
    for parameter in arguments(function):
        if parameter.role in (Role.VALUE, Role.AMOUNT):
            types = [TYPES[known] for known in parameter.types if known in TYPES]
            types = [] if types == [TYPES[type(None)]] else types  # all but None is of another type
            known = types[0] if len(types) == 1 else {"anyOf": types} if types else {}
            if parameter.several:
                known = {"type": "array", "items": known}
            out[parameter.name] = known, parameter.needed
    return out


def _object(fixed: dict[str, Any], optional: dict[str, tuple[dict[str, Any], bool]] | None = None) -> dict[str, Any]:
    optional = optional or {}
    return {
        "type": "object",
        "properties": fixed | {name: known for name, (known, _) in optional.items()},
        "required": [*fixed, *(name for name, (_, needed) in optional.items() if needed)],
        "additionalProperties": False,
    }


def _table(name: str) -> dict[str, Any]:
    return {"type": "object", "additionalProperties": {"$ref": f"#/$defs/{name}"}}


if __name__ == "__main__":
    write_whole(Path(sys.argv[1]), content())
