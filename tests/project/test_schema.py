"""The published schemas are those of the code, and accept what the code writes."""

from __future__ import annotations

import json
from typing import Any

import jsonschema
import pytest

from shared.contract import Provenance
from shared.contract.clearance import Clearance, PairClearance
from shared.contract.shot import Shot
from shared.stage import jsonfile
from tests.shared.test_contract import parts_document
from tools import schema
from tools.models.motions import four_bar_motion, plain_skeleton

PAIR = PairClearance(
    bodies=("ground", "crank"), pieces=("pin_A", "bushing_A"), gap=9e-5, proven=9e-5, time=None, proof="turn", poses=0
)
CLEARANCE = Clearance(
    mechanism="four_bar",
    provenance=Provenance(inputs="0" * 64, versions={}),
    limit=5e-5,
    resolution=5e-6,
    interpolation_error=1e-9,
    pairs=[PAIR],
    apart=3,
)
DOCUMENTS = {
    "motion": four_bar_motion(steps=3),
    "parts": parts_document(),
    "clearance": CLEARANCE,
    "shot": Shot(),
    "skeleton": plain_skeleton(four_bar_motion(steps=12)),
}


def published(name: str) -> dict[str, Any]:
    return json.loads(schema.path_of(name).read_bytes())


@pytest.mark.parametrize("name", schema.PUBLISHED)
def test_published_schemas_are_current(name: str) -> None:
    assert schema.path_of(name).read_bytes() == schema.content(schema.PUBLISHED[name]), "run make schema"


@pytest.mark.parametrize("name", schema.PUBLISHED)
def test_written_files_fit_the_schema(name: str) -> None:
    jsonschema.Draft202012Validator.check_schema(published(name))
    jsonschema.validate(json.loads(jsonfile.encode(DOCUMENTS[name])), published(name))


@pytest.mark.parametrize("name", schema.PUBLISHED)
@pytest.mark.parametrize("field", ["schema", "schema_version"])
def test_a_file_must_say_what_it_is(name: str, field: str) -> None:
    document = json.loads(jsonfile.encode(DOCUMENTS[name]))
    del document[field]
    with pytest.raises(jsonschema.ValidationError, match=f"'{field}' is a required property"):
        jsonschema.validate(document, published(name))


def test_every_schema_has_a_document_in_these_tests() -> None:
    assert set(DOCUMENTS) == set(schema.PUBLISHED)
