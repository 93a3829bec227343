"""Mechanisms over which the registry tests of mechanisms/ run."""

from __future__ import annotations

from shared.stage.paths import mechanism_folder, mechanism_names, variants_in


def folders_and_variants() -> list[str]:
    """Names of all mechanisms, each followed by those of its variants."""
    return [
        name
        for owner in mechanism_names()
        for name in (
            owner,
            *(f"{owner}-{variant}" for variant in variants_in(mechanism_folder(owner) / "mechanism.py")),
        )
    ]
