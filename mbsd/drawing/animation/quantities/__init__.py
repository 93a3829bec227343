"""Quantities of arrows and bars of a film: motions, loads, the flow of energy."""
