"""All looks by name."""

from __future__ import annotations

from render.looks.bench import BENCH
from render.looks.blueprint import BLUEPRINT
from render.looks.cyclorama import CYCLORAMA
from render.looks.daylight import DAYLIGHT
from render.looks.look import Look
from render.looks.road import ROAD
from render.looks.sand import SAND
from render.looks.studio import STUDIO

LOOKS: dict[str, Look] = {look.name: look for look in (STUDIO, CYCLORAMA, BENCH, DAYLIGHT, ROAD, SAND, BLUEPRINT)}
