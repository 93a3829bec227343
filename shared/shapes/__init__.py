"""Part library: parametric CadQuery solids for mechanisms, in millimetres.

Every function returns one solid with its axis through the origin and its seat at z = 0, going up; ``placed``
moves it to where it belongs. Outlines are exact lines and arcs, so that edges can be rounded without surprises.
"""
