"""A night whose pictures are postage stamps: ``python stamped.py -m studio.night|render|mechanisms ...``.

The coordinator, the poster, the film and Blender are those of a user; what stands before the shot is there already.
"""

from __future__ import annotations

import runpy
import sys

from render import presets

presets.PRESETS["draft"] = presets.Preset("draft", 64, 36, 1)

if __name__ == "__main__":
    _, _, module, command, *_ = sys.argv
    if module == "studio.night" or command in ("poster", "film"):
        sys.argv = [module, *sys.argv[3:]]
        runpy.run_module(module, run_name="__main__", alter_sys=True)
