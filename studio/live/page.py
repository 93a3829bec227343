"""HTML of the page: the page of ``mbsd view`` with its live part.

Before a first motion it is a page that waits.
"""

from __future__ import annotations

import html
import json
from typing import TYPE_CHECKING

from render.view.bundle import bundle
from render.view.document import document

if TYPE_CHECKING:
    from studio.live.session import Session

LIVE = "<script>window.mbsdLive = {server: true}</script>"
WAITING = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="dark light">
<title>{title}</title>
<link rel="icon" href="data:,">
<style>body {{ font: 16px/1.5 system-ui, sans-serif; max-width: 50rem; margin: 12vh auto; padding: 0 1.5rem }}
pre {{ white-space: pre-wrap }}</style>
</head>
<body>
<h1>{title}</h1>
<p id="state" role="status">{state}</p>
<pre id="error">{error}</pre>
<script>
const name = {name};
const speak = () => {{
  const socket = new WebSocket(location.href.replace(/^http/, "ws").replace(/[?#].*$/, "") + "socket");
  socket.binaryType = "arraybuffer";
  socket.onmessage = ({{ data }}) => {{
    const size = new DataView(data).getUint32(0, true);
    const message = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, size)));
    if (message.kind === "motion" || (message.kind === "state" && data.byteLength > 4 + size)) location.reload();
    const error = message.kind === "error" ? message.text : message.error;
    if (error) {{
      document.getElementById("state").textContent = `${{name}} cannot be solved yet. This page follows the file.`;
      document.getElementById("error").textContent = error;
    }}
  }};
  socket.onclose = () => setTimeout(speak, 1000);
}};
speak();
</script>
</body>
</html>
"""


def page(session: Session) -> bytes:
    """Return the page that a browser gets. Raises UserError if it cannot be bundled."""
    title = session.name.replace("_", " ")
    if session.board.payload is None:
        state = "It cannot be solved yet. This page follows the file." if session.board.error else "It is being solved."
        name = json.dumps(session.name)
        return WAITING.format(
            title=html.escape(title), state=state, error=html.escape(session.board.error or ""), name=name
        ).encode()
    return document(f"{title}, live", session.board.payload, bundle(), LIVE, "'self'")
