"""Variants of a mechanism: ``VARIANTS = {"no_gravity": {"gravity": 0.0}}`` in mechanism.py, other values of Params.

A variant is the same mechanism with some fields of its Params replaced; switches are fields that are True or False.
``DURATION`` and ``STEPS`` may be replaced as well. It is called by its mechanism's name and its own, has results of its
own, and goes through all stages as a mechanism does.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from types import ModuleType
from typing import Any

from shared.stage.errors import UserError
from shared.stage.paths import NAME, NAME_RULE, mechanism_file, shown_file, variant_of, variants_in
from shared.stage.suggestions import did_you_mean

CONSTANTS = ("DURATION", "STEPS")
"""Beside the fields of Params."""


def checked_variants(name: str, module: ModuleType) -> dict[str, dict[str, Any]]:
    """``VARIANTS`` of a mechanism.py; empty where there is none. Raises UserError naming the variant and the field."""
    file = shown_file(name)
    given = getattr(module, "VARIANTS", None)
    if given is None:
        return {}
    form = 'VARIANTS = {"no_gravity": {"gravity": 0.0}}'
    if not isinstance(given, Mapping) or not all(isinstance(values, Mapping) for values in given.values()):
        raise UserError(f"{file}: VARIANTS must be a dict of dicts by name, as in {form}")
    for variant in given:
        if not isinstance(variant, str) or not NAME.fullmatch(variant):
            raise UserError(f"{file}: {variant!r} cannot name a variant: {NAME_RULE}")
    known = variants_in(mechanism_file(name))
    if set(known) != set(given):
        raise UserError(
            f"{file}: VARIANTS must be written out with its names in quotes, as in {form}, so that they are known "
            "without running the file"
        )
    kind: Any = getattr(module, "Params", None)
    if given and not dataclasses.is_dataclass(kind):
        raise UserError(f"{file}: VARIANTS replace fields of Params, which must be a dataclass")
    fields = [field.name for field in dataclasses.fields(kind) if field.init]
    for variant, values in given.items():
        for field in values:
            if field not in (*fields, *CONSTANTS):
                raise UserError(
                    f"{file}: VARIANTS['{variant}'] has '{field}', which Params has not; it has: {', '.join(fields)}"
                    f"{did_you_mean(str(field), fields)}"
                )
    return {variant: dict(values) for variant, values in given.items()}


def replaced(name: str, module: ModuleType, p: Any) -> Any:
    """``p`` with the fields that the variant ``name`` replaces; ``p`` itself of a mechanism."""
    values = _values(name, module)
    fields = {field: value for field, value in values.items() if field not in CONSTANTS}
    return dataclasses.replace(p, **fields) if fields else p


def constant(name: str, module: Any, which: str) -> Any:
    """``DURATION`` or ``STEPS`` of a mechanism or variant; None where it is not said."""
    return _values(name, module).get(which, getattr(module, which, None))


def _values(name: str, module: Any) -> dict[str, Any]:
    variant = variant_of(name)
    return {} if variant is None else checked_variants(name, module)[variant]
