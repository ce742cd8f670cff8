"""Pages in a real browser: Debian's chromium without a window, and what a script finds in them."""

from __future__ import annotations

import json
import shutil
import subprocess
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from queue import Queue
from threading import Thread
from typing import Any

import pytest

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
in_browser = pytest.mark.skipif(CHROMIUM is None, reason="no chromium on this machine")
LONGEST_S = 120.0
ERRORS = """<script>window.failed = [];
addEventListener("error", (e) => failed.push(String(e.message)));
addEventListener("unhandledrejection", (e) => failed.push(String(e.reason)));
console.error = (...said) => failed.push(said.join(" "));</script>"""
OUTER = """<!doctype html><meta charset="utf-8"><link rel="icon" href="data:,"><body style="margin:0">
<script>
const pause = (ms) => new Promise((done) => setTimeout(done, ms)), look = async (window, document) => { SCRIPT };
const say = (said) => fetch("found", { method: "POST", body: JSON.stringify(said) });
const loaded = async ({ contentWindow: inner }) => {
  await pause(300);
  try { const result = await look(inner, inner.document); say({ result, failed: inner.failed }); } catch (error) { say({ failed: [String(error.stack)] }); }
};
</script>
<iframe src="innerVIEW" style="width:WIDTHpx;height:900px;border:0" onload="loaded(this)"></iframe></body>"""


def found(page: str, script: str, folder: Path, width: int = 1200, dark: bool = False, view: str = "") -> Any:
    """What ``script``, the body of an async function of ``window`` and ``document``, returns in a page that is so many pixels ``width`` and on which
    nothing fails. ``folder`` takes the browser's profile; ``view`` stands behind the # of the address."""
    outer = OUTER.replace("SCRIPT", script).replace("WIDTH", str(width)).replace("VIEW", f"#{view}" if view else "")
    pages = {"/": outer, "/inner": page.replace("<head>", f"<head>{ERRORS}", 1)}
    said = Queue[dict[str, Any]]()

    class Site(BaseHTTPRequestHandler):
        """The page in its frame, and where its script leaves what it found."""

        def do_GET(self) -> None:
            self.send_response(200)
            self.send_header("Content-Type", "text/html; charset=utf-8")
            self.end_headers()
            self.wfile.write(pages.get(self.path, "").encode())

        def do_POST(self) -> None:
            said.put(json.loads(self.rfile.read(int(self.headers["Content-Length"]))))
            self.send_response(204)
            self.end_headers()

        def log_message(self, *_: Any) -> None:
            """Nothing on the terminal."""

    flags = ["--headless", "--no-sandbox", "--disable-gpu", "--window-size=1400,1000", "--remote-debugging-port=0"]
    flags += [f"--blink-settings=preferredColorScheme={0 if dark else 1}", f"--user-data-dir={folder / 'profile'}"]
    with ThreadingHTTPServer(("127.0.0.1", 0), Site) as site:
        Thread(target=site.serve_forever, daemon=True).start()
        command = [str(CHROMIUM), *flags, f"http://127.0.0.1:{site.server_port}/"]
        with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as browser:
            try:
                seen = said.get(timeout=LONGEST_S)
            finally:
                browser.terminate()
                site.shutdown()
    assert seen["failed"] == []
    return seen["result"]
