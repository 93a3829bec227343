"""Motions without events, known between a few looks: tangents by differences in independent coordinates."""
