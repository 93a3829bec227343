"""The topology of a mechanism as SVG: its graph, laid out."""
