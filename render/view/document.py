"""The HTML file: style, script, licences and payload inside, nothing from elsewhere."""

from __future__ import annotations

import base64
import html

from render.view.bundle import Bundle

POLICY = (
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; connect-src {}"
)
"""What the browser lets the page load: nothing; a live page alone its own server."""
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
    """The file's bytes. ``payload``: from binary.encode; ``sketch``: an SVG that is seen until the script has run.

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
