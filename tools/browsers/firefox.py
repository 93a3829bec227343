"""Firefox, by WebDriver BiDi over its own websocket: https://w3c.github.io/webdriver-bidi/."""

from __future__ import annotations

import base64
import json
import subprocess
from pathlib import Path
from typing import Any

from websockets.sync.client import connect

from shared.stage.errors import UserError

SECONDS = 120
"""Any answer may take."""
HELLO = "WebDriver BiDi listening on "


class Firefox:
    """A Firefox with a profile of its own in ``folder``; ``webgl=False`` has none."""

    touches = True

    def __init__(self, program: str, folder: Path, environment: dict[str, str], *, webgl: bool) -> None:
        folder.mkdir()
        self.downloads = folder / "downloads"
        self.downloads.mkdir()
        preferences = {
            "webgl.force-enabled": webgl,
            "webgl.disabled": not webgl,
            "ui.prefersReducedMotion": 1,
            "browser.download.folderList": 2,
            "browser.download.dir": str(self.downloads),
            "dom.w3c_touch_events.enabled": 1,
        }
        lines = [f"user_pref({json.dumps(name)}, {json.dumps(value)});\n" for name, value in preferences.items()]
        (folder / "user.js").write_text("".join(lines))
        command = [program, "--no-remote", "--profile", str(folder), "--remote-debugging-port", "0"]
        log = folder / "log"
        with log.open("w") as sink:
            self.process = subprocess.Popen(command, stdout=sink, stderr=sink, env=environment)
        address = self._address(log)
        self.socket = connect(f"{address}/session", max_size=None, open_timeout=SECONDS, ping_interval=None)
        self.sent = 0
        self.version = self._call("session.new", capabilities={})["capabilities"]["browserVersion"]
        self.tab = self._call("browsingContext.getTree")["contexts"][0]["context"]

    def _address(self, log: Path) -> str:
        import time

        for _ in range(10 * SECONDS):
            for line in log.read_text().splitlines():
                if HELLO in line:
                    return line.split(HELLO)[1].strip()
            if self.process.poll() is not None:
                break
            time.sleep(0.1)
        self.process.kill()
        raise UserError(f"Firefox does not answer: {' '.join(log.read_text().split())[-300:]}")

    def _call(self, method: str, **parameters: Any) -> Any:
        self.sent += 1
        self.socket.send(json.dumps({"id": self.sent, "method": method, "params": parameters}))
        while True:
            answer = json.loads(self.socket.recv(timeout=SECONDS))
            if answer.get("id") != self.sent:
                continue
            if answer["type"] == "error":
                raise UserError(f"Firefox: {method}: {answer.get('message')}")
            return answer["result"]

    def open(self, page: Path, width: int, height: int) -> None:
        """Load a file into a page of that size (CSS pixels)."""
        self._call("browsingContext.setViewport", context=self.tab, viewport={"width": width, "height": height})
        self._call("browsingContext.navigate", context=self.tab, url=page.as_uri(), wait="complete")

    def ask(self, expression: str) -> Any:
        """Return the value of an expression of JavaScript, awaited if it is a promise, as JSON carries it."""
        code = f"(async () => JSON.stringify(await ({expression})) ?? 'null')()"
        answer = self._call("script.evaluate", expression=code, target={"context": self.tab}, awaitPromise=True)
        if answer["type"] != "success":
            raise UserError(f"Firefox: {expression[:80]}: {answer['exceptionDetails']['text']}")
        return json.loads(answer["result"]["value"])

    def act(self, actions: list[dict[str, Any]]) -> None:
        """Perform actions of a hand."""
        self._call("input.performActions", context=self.tab, actions=actions)

    def saved(self) -> Path:
        """Return the folder of its downloads."""
        return self.downloads

    def picture(self) -> bytes:
        """Return the page as PNG."""
        return base64.b64decode(self._call("browsingContext.captureScreenshot", context=self.tab)["data"])

    def close(self) -> None:
        """End the browser."""
        self.socket.close()
        self.process.terminate()
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
