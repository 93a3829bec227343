"""Everything that is seen: plots, report, pictures and films, from files alone."""

from shared.stage.paths import ROOT

_INSIGHTS = ROOT / "render" / "insights"
FRAME_SOURCES = (ROOT / "render" / "magnitudes.py", _INSIGHTS, *sorted(_INSIGHTS.glob("*.toml")))
"""Sources of magnitudes and insights: stages that show them are made again when these change."""
