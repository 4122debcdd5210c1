"""Headless Chromium, driven by WebDriver over HTTP. Needs only chromium and chromedriver (Debian: chromium,
chromium-driver)."""

import base64
import json
import re
import subprocess
import time
import urllib.request

# A guard against hanging: the longest answer takes a few seconds on a slow machine.
HANGS_AFTER_S = 600


class Browser:
    def __init__(self):
        # The driver chooses a free port and prints it when it accepts connections.
        self.driver = subprocess.Popen(
            ["chromedriver", "--port=0"],
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )
        started = (re.search(r"started successfully on port (\d+)", line) for line in self.driver.stdout)
        self.port = next(found[1] for found in started if found)
        arguments = [
            "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
            "--disable-background-networking", "--disable-component-update", "--disable-sync",
            "--window-size=1200,900",
        ]
        wanted = {
            "browserName": "chrome",
            "goog:chromeOptions": {"args": arguments},
            "goog:loggingPrefs": {"browser": "ALL", "performance": "ALL"},
        }
        session = self.ask("POST", "/session", {"capabilities": {"alwaysMatch": wanted}})
        self.session = f"/session/{session['sessionId']}"

    def ask(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(f"http://127.0.0.1:{self.port}{path}", data, method=method)
        request.add_header("Content-Type", "application/json")
        with urllib.request.urlopen(request, timeout=HANGS_AFTER_S) as answer:
            return json.load(answer)["value"]

    def open(self, path):
        self.ask("POST", f"{self.session}/url", {"url": path.resolve().as_uri()})

    def run(self, script, *arguments):
        body = {"script": script, "args": list(arguments)}
        return self.ask("POST", f"{self.session}/execute/sync", body)

    def wait(self, script, *arguments):
        """Runs a script until it returns a true value, and returns this value."""
        ends = time.monotonic() + HANGS_AFTER_S
        while not (value := self.run(script, *arguments)):
            if time.monotonic() > ends:
                raise TimeoutError(script)
            time.sleep(0.01)
        return value

    def log(self, kind):
        return self.ask("POST", f"{self.session}/se/log", {"type": kind})

    def devtools(self, command, **parameters):
        body = {"cmd": command, "params": parameters}
        return self.ask("POST", f"{self.session}/goog/cdp/execute", body)

    def screenshot(self, path):
        shot = self.devtools("Page.captureScreenshot", captureBeyondViewport=True)
        path.write_bytes(base64.b64decode(shot["data"]))

    def close(self):
        try:
            self.ask("DELETE", self.session)
        finally:
            self.driver.terminate()
            self.driver.wait()
