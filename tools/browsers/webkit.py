"""Safari's engine: WebKitGTK's small browser, by WebDriver: https://www.w3.org/TR/webdriver2/."""

from __future__ import annotations

import base64
import json
import subprocess
import time
from pathlib import Path
from typing import Any

import httpx

from shared.stage.errors import UserError

PACKAGES = "webkit2gtk-driver"
SECONDS = 120
"""Any answer may take."""
BROWSERS = ("/usr/lib/*/webkit2gtk-4.1/MiniBrowser", "/usr/lib*/webkit2gtk-4.1/MiniBrowser")


class WebKit:
    """A MiniBrowser and its driver; ``webgl=False`` has none."""

    touches = False

    def __init__(self, program: str, folder: Path, environment: dict[str, str], *, webgl: bool) -> None:
        folder.mkdir()
        # It saves where the user's folder of downloads is; the user is one of its own.
        self.downloads = folder / "downloads"
        self.downloads.mkdir()
        (folder / "user-dirs.dirs").write_text(f'XDG_DOWNLOAD_DIR="{self.downloads}"\n')
        environment = environment | {"HOME": str(folder), "XDG_CONFIG_HOME": str(folder)}
        browsers = [path for pattern in BROWSERS for path in Path("/").glob(pattern[1:])]
        if not browsers:
            raise UserError(f"no MiniBrowser of WebKitGTK at {BROWSERS[0]}; Debian: apt-get install {PACKAGES}")
        port = _free_port()
        with (folder / "log").open("w") as sink:
            self.process = subprocess.Popen([program, f"--port={port}"], stdout=sink, stderr=sink, env=environment)
        self.client = httpx.Client(base_url=f"http://127.0.0.1:{port}", timeout=SECONDS, trust_env=False)
        arguments = ["--automation", *([] if webgl else ["--enable-webgl=false"])]
        options = {"webkitgtk:browserOptions": {"binary": str(browsers[0]), "args": arguments}}
        self.session = ""
        try:
            self._wait()
            made = self._call("/session", {"capabilities": {"alwaysMatch": options}})
        except BaseException:
            self.close()
            raise
        self.session = f"/session/{made['sessionId']}"
        self.version = made["capabilities"]["browserVersion"]

    def _wait(self) -> None:
        for _ in range(10 * SECONDS):
            try:
                self.client.get("/status")
            except httpx.TransportError:
                if self.process.poll() is not None:
                    break
                time.sleep(0.1)
            else:
                return
        raise UserError("WebKitWebDriver does not answer")

    def _call(self, what: str, content: dict[str, Any] | None = None) -> Any:
        path = self.session + what
        answer = self.client.get(path) if content is None else self.client.post(path, json=content)
        value = answer.json()["value"]
        if answer.is_error:
            raise UserError(f"WebKit: {what}: {value.get('error')}: {value.get('message')}")
        return value

    def open(self, page: Path, width: int, height: int) -> None:
        """Load a file into a page of that size (CSS pixels)."""
        self._call("/window/rect", {"width": width, "height": height})
        self._call("/url", {"url": page.as_uri()})
        for _ in range(20):  # its bars take some of the window, and their height is known late
            w, h = self.ask("[innerWidth, innerHeight]")
            if (w, h) == (width, height):
                return
            there = self._call("/window/rect")
            self._call("/window/rect", {"width": there["width"] + width - w, "height": there["height"] + height - h})
            time.sleep(0.2)

    def ask(self, expression: str) -> Any:
        """Return the value of an expression of JavaScript, awaited if it is a promise, as JSON carries it."""
        code = (
            f"const done = arguments[0]; (async () => JSON.stringify(await ({expression})) ?? 'null')()"
            ".then(done, (error) => done(JSON.stringify({failed: String(error)})))"
        )
        value = json.loads(self._call("/execute/async", {"script": code, "args": []}))
        if isinstance(value, dict) and "failed" in value:
            raise UserError(f"WebKit: {expression[:80]}: {value['failed']}")
        return value

    def act(self, actions: list[dict[str, Any]]) -> None:
        """Perform actions of a hand."""
        self._call("/actions", {"actions": actions})

    def saved(self) -> Path:
        """Return the folder of its downloads."""
        return self.downloads

    def picture(self) -> bytes:
        """Return the page as PNG."""
        return base64.b64decode(self._call("/screenshot"))

    def close(self) -> None:
        """End the browser and its driver."""
        if self.session:
            self.client.delete(self.session)
        self.client.close()
        self.process.terminate()
        self.process.wait(20)


def _free_port() -> int:
    import socket

    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]
