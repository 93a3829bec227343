"""Everything that is seen: plots, report, pictures and films, from files alone."""

from shared.stage.paths import ROOT

FRAME_SOURCES = tuple(ROOT / "render" / f"{name}.py" for name in ("shaking", "crank", "magnitudes"))
"""Sources of what the frame feels: stages that show it are made again when these change."""
