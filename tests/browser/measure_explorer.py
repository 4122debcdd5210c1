"""Measures how fast the page of `sixfold explore` is in headless Chromium without a graphics card, at 1440 × 900. Run by hand, on a
quiet machine:

    python3 tests/browser/measure_explorer.py SIXFOLD [SCREENSHOT]

Prints milliseconds: the median and the largest of several.
"""

import base64
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

from browser import Browser
from check_explorer import Page, drop

OPENINGS = 9
# A torus of triangles has 2 m n faces.
MESHES = [(8, 6), (50, 20), (250, 200)]

# The times of 200 steps: from the click to the end of layout, with the drawing of the marks.
STEPS = """
const next = document.getElementById('next');
const times = [];
document.getElementById('first').click();
for (let i = 0; i < 200; i += 1) {
    const begun = performance.now();
    next.click();
    document.body.offsetHeight;
    times.push(performance.now() - begun);
}
return times;
"""

# The times between 60 frames while the mesh is turned.
TURN = """
const done = arguments[0];
const overlay = document.getElementById('overlay');
const point = (type, x) => overlay.dispatchEvent(new PointerEvent(type, { pointerId: 1, clientX: 100 + x, clientY: 300, bubbles: true }));
overlay.setPointerCapture = () => {};
point('pointerdown', 0);
const times = [];
let last = null;
function frame(now) {
    if (last !== null) times.push(now - last);
    last = now;
    if (times.length === 60) { point('pointerup', 70); done(times); return; }
    point('pointermove', 5 + times.length);
    requestAnimationFrame(frame);
}
requestAnimationFrame(frame);
"""


def show(what, times):
    print(f"{what:<44} {statistics.median(times):8.1f} {max(times):8.1f}")


def main():
    sixfold = sys.argv[1]
    with tempfile.TemporaryDirectory() as scratch:
        path = pathlib.Path(scratch) / "explorer.html"
        subprocess.run([sixfold, "explore", "--no-open", "-o", path], check=True, stdout=subprocess.DEVNULL)
        print(f"page: {path.stat().st_size} bytes\n{'':<44} {'median':>8} {'largest':>8}")
        browser = Browser()
        try:
            page = Page(browser, sixfold, None)
            browser.devtools("Emulation.setDeviceMetricsOverride", width=1440, height=900, deviceScaleFactor=1, mobile=False)
            opened = []
            for _ in range(OPENINGS):
                page.open(path)
                opened.append(browser.run("return performance.getEntriesByName('ready')[0].startTime"))
            show("from opening until the page can be used", opened)
            for m, n in MESHES:
                measure(page, m, n)
            if len(sys.argv) > 2:
                page.open(path)
                for _ in range(6):
                    page.click("#next")
                shot = browser.devtools("Page.captureScreenshot")
                pathlib.Path(sys.argv[2]).write_bytes(base64.b64decode(shot["data"]))
        finally:
            browser.close()


def measure(page, m, n):
    browser = page.browser
    shape = {"shape": {"name": "triangle-torus", "parameters": {"m": m, "n": n}}}
    state = {"sixfold": 1, "subject": {"mesh": shape}, "name": "torus", "edits": [], "view": {}}
    timed = lambda act: browser.run("window.begun = performance.now()") or act() or browser.run("return performance.now() - window.begun")
    loaded = timed(lambda: drop(page, "state.json", json.dumps(state).encode()))
    faces = f"{2 * m * n:,} faces: "
    show(faces + "opening the mesh", [loaded])
    show(faces + "a step", browser.run(STEPS))
    body = {"script": TURN, "args": []}
    show(faces + "between frames while it turns", browser.ask("POST", f"{browser.session}/execute/async", body))
    show(faces + "another query", [timed(lambda: page.click("[data-relation=face_faces]"))])
    show(faces + "an edit", [timed(lambda: page.edit("collapse_edge v0-v1 v0"))])
    show(faces + "undo", [timed(lambda: page.click("#undo"))])
    page.click("[data-tab=query]")


if __name__ == "__main__":
    main()
