"""The modules of which a user's code consists."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

from mbsd.dependencies.imported import modules_below
from mbsd.studies import inputs as study_inputs


def files_that_import(folder: Path, line: str, count: int = 5) -> list[tuple[Path, str]]:
    files = [folder / f"part_{number}.py" for number in range(count)]
    for file in files:
        file.write_text(f"{line}\n")
    return [(file, "") for file in files]


def test_a_module_that_many_files_import_is_counted_once(tmp_path: Path) -> None:
    met: list[str] = []
    inputs = modules_below(
        files_that_import(tmp_path, "import numpy, numpy.linalg"),
        study_inputs.StudyPlaces(tmp_path),
        lambda module, _inputs, _waiting: met.append(module.__name__),
    )
    assert sorted(met) == ["numpy", "numpy.linalg"]
    assert sorted(inputs.modules) == [f"part_{number}.py" for number in range(5)]


def test_the_version_of_a_package_is_asked_for_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: Counter[str] = Counter()

    def version(name: str) -> str:
        asked[name] += 1
        return "1.0"

    monkeypatch.setattr(study_inputs, "package_state", version)
    inputs = modules_below(
        files_that_import(tmp_path, "import numpy, numpy.linalg, numpy.fft, numpy.random"),
        study_inputs.StudyPlaces(tmp_path),
        study_inputs._count,
    )
    assert inputs.packages == {"numpy": "1.0"}
    assert asked == {"numpy": 1}
