"""Drawings of a model: its skeleton (matplotlib, extra ``draw``) and its topology as SVG."""
