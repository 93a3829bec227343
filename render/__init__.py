"""Everything that is seen: plots, report, pictures and films, from files alone."""

from shared.stage.paths import ROOT

FRAME_SOURCES = (ROOT / "render" / "magnitudes.py",)
"""Sources of what the frame feels: stages that show it are made again when these change."""
