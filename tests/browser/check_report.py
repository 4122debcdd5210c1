"""Opens a report in headless Chromium, and holds its figures against its data.

    python3 tests/browser/check_report.py DIR [FOLDER FOR SCREENSHOTS]

DIR is what `sixfold study --report DIR` wrote. Needs chromium and chromedriver (Debian: chromium,
chromium-driver) and nothing else: it speaks WebDriver over HTTP.
"""

import base64
import json
import math
import pathlib
import re
import socket
import subprocess
import sys
import time
import urllib.request

OPERATIONS_PER_FIGURE = re.compile(r"^ranking-(.+)$")


class Browser:
    def __init__(self):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.driver = subprocess.Popen(
            ["chromedriver", f"--port={self.port}", "--log-level=OFF"],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
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
        for _ in range(100):
            try:
                self.session = self.ask("POST", "/session", {"capabilities": {"alwaysMatch": wanted}})
                break
            except (ConnectionError, urllib.error.URLError):
                time.sleep(0.1)
        self.session = f"/session/{self.session['sessionId']}"

    def ask(self, method, path, body=None):
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(f"http://127.0.0.1:{self.port}{path}", data, method=method)
        request.add_header("Content-Type", "application/json")
        with urllib.request.urlopen(request, timeout=60) as answer:
            return json.load(answer)["value"]

    def open(self, path):
        self.ask("POST", f"{self.session}/url", {"url": path.resolve().as_uri()})

    def run(self, script, *arguments):
        body = {"script": script, "args": list(arguments)}
        return self.ask("POST", f"{self.session}/execute/sync", body)

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


# Every mark of a figure: what its title says, and the box of what it draws.
MARKS = """
const marks = [];
for (const group of arguments[0].querySelectorAll('svg g')) {
    const title = group.querySelector(':scope > title');
    const shape = group.querySelector(':scope > rect, :scope > path, :scope > circle');
    if (!title || !shape) continue;
    const box = shape.getBBox();
    marks.push({title: title.textContent, x: box.x, y: box.y, width: box.width, height: box.height});
}
return marks;
"""

FIGURES = """
for (const details of document.querySelectorAll('details')) details.open = true;
return [...document.querySelectorAll('figure[data-figure]')].map(figure => ({
    id: figure.dataset.figure,
    marks: (figure => { MARKS })(figure),
    lines: figure.querySelectorAll('svg path[fill="none"], svg polyline').length,
    rows: figure.parentElement.querySelectorAll('tbody tr').length,
    width: figure.querySelector('svg').getBoundingClientRect().width,
}));
""".replace("MARKS", MARKS.replace("arguments[0]", "figure"))


def close_to(a, b, what, tolerance):
    assert abs(a - b) <= tolerance, f"{what}: {a} in the page, {b} in the data"


def times(ratio):
    """A ratio as the page writes it."""
    if ratio < 1.095:
        return f"{ratio:.2f} ×"
    if ratio < 9.95:
        return f"{ratio:.1f} ×"
    return f"{math.floor(ratio + 0.5):,} ×"


def check_ranking(figure, study):
    operation = OPERATIONS_PER_FIGURE.match(figure["id"]).group(1).replace("-", "_")
    rows = [r for r in study["results"] if r["operation"] == operation and r["ratio_to_best"]]
    assert len(figure["marks"]) == len(rows) == figure["rows"], figure["id"]
    by_name = {row["backend"]: row for row in rows}
    longest = max(row["ratio_to_best"] for row in rows)
    widest = max(mark["width"] for mark in figure["marks"])
    for mark in figure["marks"]:
        name, figures = mark["title"].split(": ", 1)
        row = by_name.pop(name)
        shown = [float(part) for part in re.findall(r"\d+\.\d+", figures.split(" ×")[0])]
        close_to(shown[0], row["ratio_to_best"], f"{operation} on {name}", 6e-4)
        if row["ratio_ci_low"] is not None:
            close_to(shown[1], row["ratio_ci_low"], f"{operation} on {name}, low", 6e-4)
            close_to(shown[2], row["ratio_ci_high"], f"{operation} on {name}, high", 6e-4)
        if longest > 1.2:
            share = max(math.log10(row["ratio_to_best"]), 0.02) / math.log10(longest)
            close_to(mark["width"], share * widest, f"the bar of {operation} on {name}", 0.6)


def check_heat_map(figure, study):
    columns = [name for name, column in study["backends"].items() if column["holds"]]
    rows = {(r["operation"], r["backend"]): r["ratio_to_best"] for r in study["results"]}
    measured = {operation for (operation, _), ratio in rows.items() if ratio}
    assert len(figure["marks"]) == len(measured) * len(columns), figure["id"]
    assert figure["rows"] == len(measured), figure["id"]
    for mark in figure["marks"]:
        operation, rest = mark["title"].split(" on ", 1)
        column, shown = rest.split(": ", 1)
        ratio = rows.get((operation, column))
        expected = times(ratio) if ratio else "not measured"
        assert shown == expected, f"{mark['title']}: {ratio} in the data"


def check_memory(figure, study):
    columns = {n: c for n, c in study["backends"].items() if c["tables"]}
    vertices = study["mesh"]["vertices"]
    shown, heights = {}, {}
    for mark in figure["marks"]:
        place, value = mark["title"].rsplit(": ", 1)
        name, table = place.split(", ", 1)
        shown[name, table] = float(value.split()[0])
        heights[name, table] = mark["height"]
    scale = None
    for name, column in columns.items():
        for table in column["tables"]:
            each = table["bytes"] / vertices
            if table["bytes"]:
                close_to(shown[name, table["table"]], each, f"{name}, {table['table']}", 0.051)
                scale = scale or heights[name, table["table"]] / each
                close_to(heights[name, table["table"]], each * scale, f"the bar of {name}", 1.0)


def check_break_even(figure, study):
    columns = [name for name, column in study["backends"].items() if column["holds"]]
    assert figure["rows"] >= 2 and figure["lines"] >= figure["rows"], figure
    assert figure["rows"] <= len(columns), figure


def main():
    folder = pathlib.Path(sys.argv[1])
    shots = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else None
    results = json.loads((folder / "results.json").read_text())
    studies = results["studies"]
    browser = Browser()
    try:
        start = time.monotonic()
        browser.open(folder / "report.html")
        seconds = time.monotonic() - start
        assert seconds < 2, f"it opens in {seconds:.1f} s"
        size = (folder / "report.html").stat().st_size
        assert size < 10e6, f"{size} bytes"

        figures = browser.run(FIGURES)
        ids = [figure["id"] for figure in figures]
        assert len(set(ids)) == len(ids), "two figures of one name"
        checked = 0
        for figure in figures:
            study = studies[0]
            for other in studies:
                if figure["id"].startswith(re.sub(r"[^0-9a-z]", "-", other["mesh"]["name"].lower())):
                    study = other
            kind = figure["id"]
            pooled = len(studies) > 1 and not any(
                kind.startswith(re.sub(r"[^0-9a-z]", "-", s["mesh"]["name"].lower())) for s in studies
            )
            if pooled:
                assert figure["marks"], figure["id"]
                continue
            checked += 1
            if OPERATIONS_PER_FIGURE.match(kind):
                check_ranking(figure, study)
            elif kind.endswith("heat-map"):
                check_heat_map(figure, study)
            elif kind.endswith("memory"):
                check_memory(figure, study)
            elif kind.endswith("break-even"):
                check_break_even(figure, study)
            else:
                raise AssertionError(f"nobody knows a figure {kind}")
        assert checked >= 2 * len(studies), f"{checked} figures of {len(studies)} studies"

        # On a telephone the page is no wider than the screen; figures are pushed about in theirs.
        for width, theme in [(1200, "light"), (1200, "dark"), (390, "light"), (390, "dark")]:
            browser.devtools(
                "Emulation.setDeviceMetricsOverride",
                width=width, height=900, deviceScaleFactor=1, mobile=width < 500,
            )
            browser.devtools(
                "Emulation.setEmulatedMedia",
                features=[{"name": "prefers-color-scheme", "value": theme}],
            )
            [inside, page, ink, paper] = browser.run(
                "const s = getComputedStyle(document.body);"
                "return [innerWidth, document.documentElement.scrollWidth, s.color, s.backgroundColor]"
            )
            assert page <= inside, f"{page} pixels wide on a screen of {inside}"
            dark = [sum(map(int, re.findall(r"\d+", colour)[:3])) < 380 for colour in (ink, paper)]
            assert dark == ([True, False] if theme == "light" else [False, True]), (theme, ink, paper)
            letters = browser.run(
                "return getComputedStyle(document.querySelector('figure svg text')).fill"
            )
            assert (sum(map(int, re.findall(r"\d+", letters)[:3])) < 380) == (theme == "light"), letters
            if shots:
                shots.mkdir(parents=True, exist_ok=True)
                browser.screenshot(shots / f"report-{theme}-{width}.png")

        complaints = [entry for entry in browser.log("browser") if entry["level"] != "INFO"]
        assert not complaints, complaints
        for entry in browser.log("performance"):
            message = json.loads(entry["message"])["message"]
            if message["method"] == "Network.requestWillBeSent":
                url = message["params"]["request"]["url"]
                assert url.startswith(("file:", "data:")), f"the page asks for {url}"
    finally:
        browser.close()
    print(f"{len(figures)} figures, {checked} held against the data; opened in {seconds:.2f} s, {size:,} bytes")


main()
