"""A numba that the kernels are not made for is refused with a sentence."""

from __future__ import annotations

import tomllib

import numba
import pytest

from mbsd import MechanismError
from mbsd.compiling.numba_version import NEWEST, OLDEST, refuse_other_versions
from shared.stage.paths import ROOT


@pytest.mark.parametrize("version", ["0.60.0", "0.69.0", "0.69.0rc1", "1.0.0", "0.100.0"])
def test_another_numba_is_refused_with_the_remedy(version: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(numba, "__version__", version)
    with pytest.raises(
        MechanismError, match=rf"numba {version} is installed.*pip install 'numba>=0\.61,<0\.69'"
    ) as refused:
        refuse_other_versions()
    assert isinstance(refused.value, ImportError)


@pytest.mark.parametrize("version", ["0.61.0", "0.61.2", "0.68.1", "0.68.0rc1"])
def test_those_that_were_tried_are_taken(version: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(numba, "__version__", version)
    refuse_other_versions()


def test_the_package_asks_for_the_same_versions() -> None:
    asked = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["dependencies"]
    bounds = f"numba>={OLDEST[0]}.{OLDEST[1]},<{NEWEST[0]}.{NEWEST[1] + 1}"
    assert bounds in asked
