"""Insights: what a motion shows, each with a number, a time and a sentence, the most telling first."""

from render.insights.insight import Insight
from render.insights.ranking import insights

__all__ = ["Insight", "insights"]
