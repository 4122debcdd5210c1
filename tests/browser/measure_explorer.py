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
from check_explorer import STRUCTURES, Page, drop

OPENINGS = 9
QUERIES = 5
# Most structures read some rows, and two all corners.
RELATIONS = {"vertex_vertices": "v0", "edge_faces": "v0-v1", "face_faces": "f0"}
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

# The time from dropping a file, or a click on a relation, until the answer is shown and drawn.
UNTIL_DRAWN = """
const [text, relation, done] = arguments;
const root = document.documentElement;
const data = new DataTransfer();
if (text) data.items.add(new File([text], 'torus.obj'));
const begun = performance.now();
new MutationObserver((_, observer) => {
    if (root.hasAttribute('data-busy')) return;
    observer.disconnect();
    requestAnimationFrame(() => setTimeout(() => done(performance.now() - begun)));
}).observe(root, { attributes: true, attributeFilter: ['data-busy'] });
if (text) document.dispatchEvent(new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true }));
else document.querySelector(`[data-relation=${relation}]`).click();
"""

# The times of queries on each structure: from the request until the response is read, without the page.
TRACES = """
const [text, structures, relations, repeats, done] = arguments;
(async () => {
    const packed = Uint8Array.from(atob(document.getElementById('engine').textContent), letter => letter.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
    const { instance } = await WebAssembly.instantiate(await new Response(stream).arrayBuffer(), {});
    const { memory, reserve, call, release } = instance.exports;
    const respond = request => {
        const bytes = new TextEncoder().encode(JSON.stringify(request));
        const asked = reserve(bytes.length);
        new Uint8Array(memory.buffer, asked + 4, bytes.length).set(bytes);
        const answered = call(asked);
        const length = new DataView(memory.buffer).getUint32(answered, true);
        const response = new TextDecoder().decode(new Uint8Array(memory.buffer, answered + 4, length));
        release(answered);
        return JSON.parse(response);
    };
    respond({ mesh: { file: { name: 'a.obj', text } }, ask: { tables: { rows: [0, 0] } } });
    const times = structures.map(structure => relations.map(([relation, element]) => Array.from({ length: repeats }, () => {
        const begun = performance.now();
        const { answers } = respond({ mesh: 'last', structures: [structure], ask: { trace: { relation, element } } });
        if (answers.length !== 1) throw new Error(`${structure} does not answer`);
        return performance.now() - begun;
    })));
    done({ times });
})().catch(error => done({ error: String(error) }));
"""


def show(what, times):
    print(f"{what:<52} {statistics.median(times):8.1f} {max(times):8.1f}")


def main():
    sixfold = sys.argv[1]
    with tempfile.TemporaryDirectory() as scratch:
        path = pathlib.Path(scratch) / "explorer.html"
        subprocess.run([sixfold, "explore", "--no-open", "-o", path], check=True, stdout=subprocess.DEVNULL)
        print(f"page: {path.stat().st_size} bytes\n{'':<52} {'median':>8} {'largest':>8}")
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
            m, n = MESHES[-1]
            mesh = pathlib.Path(scratch) / "torus.obj"
            torus = ["triangle-torus", f"m={m}", f"n={n}"]
            subprocess.run([sixfold, "generate", *torus, "-o", mesh], check=True, stdout=subprocess.DEVNULL)
            measure_file(page, path, mesh.read_bytes(), f"{2 * m * n:,} faces: ")
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


def measure_file(page, path, mesh, faces):
    """Measures the opening of a mesh file, each time in a new page, and queries on each structure."""
    browser = page.browser
    run = lambda script, *arguments: browser.ask("POST", f"{browser.session}/execute/async", {"script": script, "args": arguments})
    opened = []
    for _ in range(QUERIES):
        page.open(path)
        opened.append(run(UNTIL_DRAWN, mesh.decode(), ""))
    show(faces + "opening the file", opened)
    another = [run(UNTIL_DRAWN, "", relation) for relation in ["face_faces", "vertex_faces", "edge_faces", "edge_edges", "vertex_vertices"]]
    show(faces + "another query in the page, on all six", another)
    traced = run(TRACES, mesh.decode(), STRUCTURES, list(RELATIONS.items()), QUERIES)
    if "error" in traced:
        raise RuntimeError(traced["error"])
    for structure, times in zip(STRUCTURES, traced["times"]):
        for relation, one in zip(RELATIONS, times):
            show(f"{faces}{relation} on {structure}", one)


if __name__ == "__main__":
    main()
