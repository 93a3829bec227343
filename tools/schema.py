"""File formats, published: ``python -m tools.schema`` writes docs/schema/*.schema.json from structs."""

from __future__ import annotations

import json
from pathlib import Path

import msgspec

from shared.contract import Motion, Motion3, Parts
from shared.contract.clearance import Clearance
from shared.contract.shot import Shot
from shared.contract.skeleton import Skeleton
from shared.stage.files import write_bytes
from shared.stage.paths import ROOT

FOLDER = ROOT / "docs" / "schema"
PUBLISHED: dict[str, type[msgspec.Struct]] = {
    "motion": Motion,
    "motion3": Motion3,
    "parts": Parts,
    "clearance": Clearance,
    "shot": Shot,
    "skeleton": Skeleton,
}


def content(kind: type[msgspec.Struct]) -> bytes:
    """The JSON Schema of one file type, as published.

    ``schema``, ``schema_version`` and ``space`` have defaults in the code, but a file must carry them.
    """
    schema = msgspec.json.schema(kind)
    definition = schema["$defs"][kind.__name__]
    said = [name for name in ("schema", "schema_version", "space") if name in definition["properties"]]
    definition["required"] = [*said, *definition.get("required", [])]
    whole = {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": kind.__name__, **schema}
    return (json.dumps(whole, indent=2, ensure_ascii=False) + "\n").encode()


def path_of(name: str) -> Path:
    """Where the schema of ``name`` is published."""
    return FOLDER / f"{name}.schema.json"


if __name__ == "__main__":
    for name, kind in PUBLISHED.items():
        write_bytes(path_of(name), content(kind))
