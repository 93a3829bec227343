"""``make check`` tells what is missing, and the schemas of the file formats are published."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import jsonschema
import pytest

from shared.contract import Provenance
from shared.contract.clearance import Clearance, PairClearance
from shared.contract.shot import Shot
from shared.stage import jsonfile
from shared.stage.paths import ROOT
from tests.running.make import run
from tests.shared.test_contract import parts_document
from tests.shared.test_space_motion import MOTION as MOTION_IN_SPACE
from tools import check, schema
from tools.models.motions import four_bar_motion, plain_skeleton

# make check: what stands in the way of a run is named with its cure.


def test_faults_are_warned_of_and_fail_the_check(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(check, "locked", lambda _: {"numpy": "1.0", "no-such-package": "2.0"})
    monkeypatch.setattr(check.shutil, "disk_usage", lambda _: type("Usage", (), {"free": 1e9}))
    monkeypatch.setattr(check, "missing_libraries", lambda: ["libGL.so.1"])
    monkeypatch.setattr(check, "missing_programs", lambda: ["rsync"])
    assert check.main() == 1
    out, said = capsys.readouterr()
    assert "programs: missing programs rsync: " in out
    assert "rsync" not in said, "no run needs it"
    assert "no-such-package is missing, requirements.lock has 2.0" in said
    assert "requirements.lock has 1.0; remove .venv and run make install" in said
    assert "libGL.so.1: " in said
    assert "only 1.0 GB free" in said


def test_the_lock_is_read(tmp_path: Path) -> None:
    lock = tmp_path / "requirements.lock"
    lock.write_text("a-b==1.2 \\\n    --hash=sha256:0\nwin==3 ; sys_platform == 'win32' \\\n    --hash=sha256:1\n")
    assert check.locked(lock) == {"a-b": "1.2"}
    assert len(check.locked(ROOT / "requirements.lock")) > 50


def test_check_tells_versions_libraries_disk_and_device() -> None:
    done = run("make", "-o", "install", "check")
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert [line.partition(":")[0] for line in lines] == [
        "python",
        "packages",
        "system libraries",
        "programs",
        "disk",
        "render device",
    ]
    assert re.search(r"numpy \d+\.\d+\.\d+, .*bpy 5\.2", lines[1])
    assert re.search(r"\d+ GB free", lines[4])
    assert re.search(r"(CPU|OPTIX|CUDA|HIP|METAL|ONEAPI).*, Blender 5\.2", lines[5])


# The published schemas are those of the code, and accept what the code writes.


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
    "motion3": MOTION_IN_SPACE,
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
