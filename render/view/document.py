"""The HTML document of a page: sketch, data in binary, scripts."""

from __future__ import annotations

import base64
import html
import json
import struct
import zlib
from itertools import batched
from typing import Any

import numpy as np

from render.view.bundle import Bundle

# The payload as bytes: JSON with arrays beside it, compressed. page/src/data/decode.js reads it.
#
# bytes      zlib of what follows, or what follows as it is
# file       "MBSV", version (uint32), length of the header (uint32), header, zeros up to a multiple of 8, blocks
# header     JSON in UTF-8; an array is {"$": [type, offset, count]}: where it begins behind the header (bytes)
# block      the numbers' first bytes, then their second bytes and so on, which compresses better; multiples of 8
# type       f4 f8 i1 u1 i2 u2 u4, little endian

MAGIC, VERSION = b"MBSV", 1
TYPES = {"float32": "f4", "float64": "f8", "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "uint32": "u4"}


def encode(payload: dict[str, Any], compress: bool = True) -> bytes:
    """Return the bytes of dicts, lists, strings, numbers and arrays (flattened); the same each time."""
    blocks = bytearray()

    def plain(value: Any) -> Any:
        if isinstance(value, np.ndarray):
            place = len(blocks)
            blocks.extend(_planes(value))
            blocks.extend(b"\0" * (-len(blocks) % 8))
            return {"$": [TYPES[value.dtype.name], place, value.size]}
        if isinstance(value, dict):
            return {str(key): plain(part) for key, part in value.items()}
        if isinstance(value, list | tuple):
            return [plain(part) for part in value]
        return value

    header = json.dumps(plain(payload), separators=(",", ":"), ensure_ascii=False, allow_nan=False).encode()
    head = MAGIC + struct.pack("<II", VERSION, len(header)) + header
    content = head + b"\0" * (-len(head) % 8) + bytes(blocks)
    return zlib.compress(content, 9) if compress else content


def header_of(content: bytes) -> dict[str, Any]:
    """Return what compressed bytes say without the numbers of their arrays."""
    plain = zlib.decompress(content)
    (length,) = struct.unpack_from("<I", plain, 8)
    return json.loads(plain[12 : 12 + length])


def _planes(values: np.ndarray) -> bytes:
    flat = np.ascontiguousarray(values, values.dtype.newbyteorder("<")).reshape(-1)
    return flat.view(np.uint8).reshape(-1, values.itemsize).T.tobytes()


# The skeleton at its start as SVG in the HTML file: seen before script, payload and WebGL are ready.

ACROSS = 1000.0
"""Length of the longer side of the picture; places are rounded to a tenth."""
ROOM, PAD = 0.09, 2.4
"""Part left free on each side, and beyond the machine in sizes of its symbols, as the 2D view has them
(page/src/view2d)."""
WIDTH = 1.25
"""Pixels of a line that is one point wide."""
TOLD = {"ink": "ink", "paper": "paper"}
"""Classes of style/sketch.css; all else has the ink of a body."""


def sketch(skeleton: dict[str, Any]) -> str:
    """Return an ``<svg>`` of what payload.skeleton says; marks that are shown on demand are left out."""
    pad = PAD * skeleton["unit"]
    low = [value - pad for value in skeleton["low"]]
    size = [high + pad - least for high, least in zip(skeleton["high"], low, strict=True)]
    scale = ACROSS * (1 - 2 * ROOM) / max(*size)
    width, height = (value * scale / (1 - 2 * ROOM) for value in size)
    left, top = ROOM * width, ROOM * height + size[1] * scale

    def path(stroke: dict[str, Any]) -> str:
        corners = (
            f"{left + scale * (float(x) - low[0]):.1f} {top - scale * (float(y) - low[1]):.1f}"
            for x, y in batched(stroke["points"], 2, strict=True)
        )
        end = "z" if stroke["closed"] else ""
        fill = f"fill-{TOLD.get(stroke['fill'], 'body')}" if stroke["fill"] else "fill-none"
        looks = [f'class="{fill} line-{TOLD.get(stroke["ink"], "body")}"']
        if stroke["fill"] and stroke["alpha"] < 1:
            looks.append(f'fill-opacity="{stroke["alpha"]:g}"')
        looks.append(f'stroke-width="{WIDTH * stroke["width"]:g}"')
        if stroke["dash"]:
            looks.append(f'stroke-dasharray="{" ".join(f"{WIDTH * dash:g}" for dash in stroke["dash"])}"')
        return f'<path {" ".join(looks)} d="M{"L".join(corners)}{end}"/>'

    paths = "".join(path(stroke) for stroke in skeleton["strokes"] if not stroke["sign"] and len(stroke["points"]))
    box = f'viewBox="0 0 {width:.1f} {height:.1f}"'
    return f'<svg class="mbsd-sketch" {box} role="img" aria-label="Skeleton">{paths}</svg>'


# The HTML file: style, script, licences and payload inside, nothing from elsewhere.

POLICY = (
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; connect-src {}"
)
"""Sources that the browser lets the page load: none; a live page alone its own server."""
FILE = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1, viewport-fit=cover">
<meta name="color-scheme" content="dark light">
<meta http-equiv="Content-Security-Policy" content="{policy}">
<title>{title}</title>
<link rel="icon" href="data:,">
<style>{style}</style>
</head>
<body>
<div id="mbsd">{sketch}<noscript>This page shows a machine in motion; it needs JavaScript.</noscript></div>
<script type="text/plain" id="mbsd-licences">{licences}</script>
<script type="text/plain" id="mbsd-payload">{payload}</script>
{more}<script>{script}</script>
</body>
</html>
"""


def document(
    title: str, payload: bytes, bundle: Bundle, more: str = "", connect: str = "'none'", sketch: str = ""
) -> bytes:
    """Return the file's bytes.

    ``payload``: from binary.encode; ``sketch``: an SVG that is seen until the script has run.

    A live page adds ``more`` HTML before the script, which may set window.mbsdLive (page/src/main.js), and ``connect``:
    the addresses that it may speak to, as a Content-Security-Policy says.
    """
    return FILE.format(
        policy=html.escape(POLICY.format(connect)),
        title=html.escape(title),
        sketch=sketch,
        style=bundle.style.replace("</style", "<\\/style"),
        script=bundle.script.replace("</script", "<\\/script").replace("<!--", "<\\!--"),
        licences=html.escape(bundle.licences),
        payload=base64.b64encode(payload).decode(),
        more=more,
    ).encode()
