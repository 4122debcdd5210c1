"""Opens the page of `sixfold explore` in headless Chromium, and does what a student does.

    python3 tests/browser/check_explorer.py SIXFOLD RESPOND [FOLDER FOR SCREENSHOTS]

SIXFOLD is the program, and RESPOND the example `respond` of sixfold-explain: the lit rows, the results and the counters of the
page are compared with the responses of the native engine. The script opens the page from the disk, and waits for events, not
for times.
"""

import base64
import csv
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

from browser import Browser

STRUCTURES = ["polygon-soup", "indexed-face-set", "face-vertex", "winged-edge", "half-edge", "corner-table"]
SIZES = {"laptop": (1440, 900), "projector": (1024, 768), "beside": (864, 768), "tablet": (821, 1000), "telephone": (390, 844)}
MAX_BYTES = 3_000_000
CUBE = """v 0 0 0
v 0 0 1
v 0 1 0
v 0 1 1
v 1 0 0
v 1 0 1
v 1 1 0
v 1 1 1
f 1 2 4 3
f 5 7 8 6
f 1 5 6 2
f 3 4 8 7
f 1 3 7 5
f 2 6 8 4
"""

# The counters and the results of each structure.
SHOWN = """
const shown = {};
for (const row of document.querySelectorAll('#race tbody tr')) {
    const counts = [...row.querySelectorAll('td')].slice(1).map(cell => Number(cell.textContent.replaceAll(',', '')));
    const card = document.querySelector(`.card[data-structure=${row.dataset.structure}]`);
    const lit = [...card.querySelectorAll('tr[data-row]')].filter(line => line.querySelector('.read, .read-now'));
    shown[row.dataset.structure] = {
        counts,
        results: card.querySelector('.results').textContent.replace(/^.*?: /, ''),
        lit: lit.map(line => line.dataset.row),
        isWhole: !card.querySelector('.gap'),
        line: [...card.querySelectorAll('.code li')].findIndex(line => line.classList.contains('marked')),
    };
}
return shown;
"""


class Page:
    def __init__(self, browser, sixfold, respond):
        self.browser = browser
        self.sixfold = sixfold
        self.respond = respond
        written = subprocess.run([sixfold, "lessons", "--json", "-"], check=True, capture_output=True, text=True)
        self.lessons = json.loads(written.stdout)

    def open(self, path, hash="", keeps=False):
        """Opens the page, also if only the part after # is another one. Unless it `keeps` it, what the browser kept is gone."""
        browser = self.browser
        browser.ask("POST", f"{browser.session}/url", {"url": "about:blank"})
        if not keeps:
            browser.devtools("Storage.clearDataForOrigin", origin="file://", storageTypes="local_storage")
        browser.ask("POST", f"{browser.session}/url", {"url": path.resolve().as_uri() + hash})
        browser.wait("return document.documentElement.dataset.ready === 'yes'")

    def settle(self):
        self.browser.wait("return !document.documentElement.hasAttribute('data-busy')")

    def click(self, selector):
        self.browser.run("document.querySelector(arguments[0]).click()", selector)
        self.settle()

    def type(self, selector, value):
        self.browser.run(
            "const field = document.querySelector(arguments[0]); field.value = arguments[1];"
            "field.dispatchEvent(new Event('change'))", selector, value)
        self.settle()

    def edit(self, text):
        self.click("[data-tab=edit]")
        self.browser.run("document.getElementById('edit-text').value = arguments[0]", text)
        self.click("#run-edit")

    def text(self, selector):
        return self.browser.run(
            "const found = document.querySelector(arguments[0]); return found && !found.hidden ? found.textContent : ''", selector)

    def native(self, **request):
        asked = json.dumps(request)
        ran = subprocess.run([self.respond], input=asked + "\n", capture_output=True, text=True, check=True)
        return json.loads(ran.stdout)


def check(condition, *what):
    if not condition:
        raise AssertionError(" ".join(str(part) for part in what))


def rows_of(steps):
    rows = set()
    for step in steps:
        if step["step"] == "read":
            first = int(step["row"][1:])
            rows |= {f"{step['row'][0]}{first + k}" for k in range(step["rows"])}
    return rows


def compare_queries(page, mesh, queries, edits=()):
    """Steps each query to its end, and compares rows, results and counters with the native engine."""
    for relation, element in queries:
        page.click("[data-tab=query]")
        page.type("#element", element)
        page.click(f"[data-relation={relation}]")
        response = page.native(mesh=mesh, edits=list(edits), ask={"trace": {"relation": relation, "element": element}})
        page.click("#next")
        first = page.browser.run(SHOWN)
        page.click("#last")
        last = page.browser.run(SHOWN)
        check(response["answers"], relation, response)
        for answer in response["answers"]:
            name = answer["backend"]
            shown = last[name]
            check(shown["counts"] == [answer["reads"], answer["cache_lines"], answer["bytes"]], name, relation, shown, answer)
            check(shown["results"] == (", ".join(answer["results"]) or "none"), name, relation, shown["results"])
            lit, rows = set(shown["lit"]), rows_of(answer["steps"])
            check(lit == rows if shown["isWhole"] else lit and lit <= rows, name, relation, shown["lit"], sorted(rows - lit))
            check(set(first[name]["lit"]) <= rows_of(answer["steps"][:1]), name, relation, first[name]["lit"])
            check(len(first[name]["lit"]) == (answer["steps"][0]["step"] == "read"), name, relation, "rows after one step")
            check(first[name]["line"] == answer["steps"][0]["line"], name, relation, "the marked line")
        for refused in response["refused"]:
            # A structure that refused an edit waits in its state before.
            if refused["backend"] in waiting(page):
                continue
            check(refused["reason"] in page.text(f".card[data-structure={refused['backend']}] .refusal"), refused)


def waiting(page):
    """The structures that refused an edit, and wait until it is undone."""
    return page.browser.run("return [...document.querySelectorAll('.card.stopped')].map(card => card.dataset.structure)")


def edges(page):
    """The names of the edges of the mesh in the page, from its tables, in the order of their rows."""
    pairs = page.browser.run("""
        const rows = document.querySelectorAll('.card[data-structure=winged-edge] tr[data-row^=e]');
        const number = row => Number(row.dataset.row.slice(1));
        return [...rows].sort((a, b) => number(a) - number(b)).map(row => [...row.cells].slice(1, 3).map(cell => cell.lastChild.textContent.trim()));
    """)
    return [sorted(pair, key=lambda name: int(name[1:])) for pair in pairs]


def check_queries(page, path):
    page.open(path)
    mesh = {"shape": {"name": "octahedron"}}
    compare_queries(page, mesh, [
        ("vertex_vertices", "v3"), ("vertex_edges", "v0"), ("vertex_faces", "v5"),
        ("edge_vertices", "v0-v2"), ("edge_edges", "v0-v2"), ("edge_faces", "v1-v4"),
        ("face_vertices", "f7"), ("face_edges", "f2"), ("face_faces", "f0"),
    ])
    page.click("#first")
    check(page.text("#clock").startswith("step 0 of"), page.text("#clock"))
    page.click("#next")
    page.click("#next")
    page.click("#back")
    check(page.text("#clock").startswith("step 1 of"), page.text("#clock"))
    page.browser.run("document.getElementById('speed').value = '1000'")
    page.click("#play")
    page.browser.wait("return document.getElementById('play').textContent.includes('Play')")
    ended = re.fullmatch(r"step (\d+) of (\d+)", page.text("#clock"))
    check(ended and ended[1] == ended[2], page.text("#clock"))


def check_pointer(page, path):
    """Clicks on the mesh: each place on the canvas chooses an element that the mesh has."""
    page.open(path)
    box = page.browser.run("const box = document.getElementById('overlay').getBoundingClientRect(); return [box.x, box.y, box.width, box.height]")
    chosen = set()
    for i in range(5):
        for j in range(5):
            x, y = (round(box[0] + box[2] * (0.14 + 0.18 * i)), round(box[1] + box[3] * (0.14 + 0.18 * j)))
            click = [{"type": "pointerMove", "x": x, "y": y}, {"type": "pointerDown", "button": 0}, {"type": "pointerUp", "button": 0}]
            actions = [{"type": "pointer", "id": "mouse", "parameters": {"pointerType": "mouse"}, "actions": click}]
            page.browser.ask("POST", f"{page.browser.session}/actions", {"actions": actions})
            page.settle()
            chosen.add(page.browser.run("return document.getElementById('element').value"))
    check(len(chosen) > 5, chosen)
    check({name[0] for name in chosen} == {"v", "f"}, chosen)
    check(page.text("#message") == "", page.text("#message"))


def check_edits(page, path):
    page.open(path)
    tables = "return document.getElementById('cards').textContent"
    page.click("[data-tab=edit]")
    before = page.browser.run(tables)
    edits = []
    # Splits and flips of edges that exist, as a student would click them.
    for round in range(20):
        [a, b] = edges(page)[(7 * round) % len(edges(page))]
        kind = "split_edge" if round % 3 == 0 else "flip_edge"
        page.type("#element", f"{a}-{b}")
        page.click(f'[data-edit="{kind} {a}-{b}"]')
        if "nothing is changed" in page.text("#edit-result summary"):
            page.edit("split_edge " + "-".join(edges(page)[0]))
        edits.append(page.text("#edit-result summary code"))
    changed = page.browser.run("return document.querySelectorAll('.changed').length")
    check(changed > 0, "no row is marked after an edit")
    compare_queries(page, {"shape": {"name": "octahedron"}}, [("vertex_vertices", "v0"), ("face_faces", "f0")], edits)
    for _ in range(20):
        check(page.text("#undo") and not page.browser.run("return document.getElementById('undo').disabled"), "nothing to undo")
        page.click("#undo")
    check(page.browser.run("return document.getElementById('undo').disabled"), "more than 20 edits")
    page.type("#element", "v0")
    page.click("[data-tab=edit]")
    check(page.browser.run(tables) == before, "the tables after twenty undos")
    for _ in range(20):
        page.click("#redo")
    # Compaction moves rows, and the elements keep their names.
    for edit in ("remove_vertex v0", "compact"):
        page.edit(edit)
        edits.append(page.text("#edit-result summary code"))
    compare_queries(page, {"shape": {"name": "octahedron"}}, [("vertex_edges", "v1")], edits)


def check_refusals(page, path):
    page.open(path)
    # A third face at an edge: half of the structures refuse the mesh, and a repair makes one that they hold.
    page.click("[data-tab=edit]")
    page.type("#element", "v0-v2")
    page.click("button.fault")
    verdicts = page.browser.run("return Object.fromEntries([...document.querySelectorAll('#verdicts tr')].map(row => [row.dataset.structure, row.cells[1].className]))")
    check([verdicts[name] for name in STRUCTURES] == ["good"] * 3 + ["refusal"] * 3, verdicts)
    check("edge v0–v2 has 3 faces" in page.text("#verdicts"), page.text("#verdicts"))
    page.click("[data-repair=half-edge]")
    page.click("#take-repair")
    check("refusal" not in page.browser.run("return document.getElementById('verdicts').innerHTML"), page.text("#verdicts"))
    # Some structures accept this edit, and others refuse it and wait.
    page.open(path)
    page.edit("add_face v0 v1 v2")
    refusing = waiting(page)
    check(refusing and "polygon-soup" not in refusing, refusing)
    page.edit("split_edge v0-v2")
    check(set(refusing) <= set(waiting(page)), waiting(page))
    mesh = {"shape": {"name": "octahedron"}}
    page.click("[data-tab=query]")
    native = page.native(mesh=mesh, edits=[], structures=refusing, ask={"trace": {"relation": "vertex_vertices", "element": "v0"}})
    page.type("#element", "v0")
    page.click("[data-relation=vertex_vertices]")
    page.click("#last")
    shown = page.browser.run(SHOWN)
    for answer in native["answers"]:
        check(shown[answer["backend"]]["results"] == ", ".join(answer["results"]), "a waiting structure", answer)
    page.click("#undo")
    page.click("#undo")
    check(not waiting(page), "still waiting", waiting(page))
    # All refuse this one.
    page.edit("remove_face f99")
    check("f99" in page.text("#say"), page.text("#say"))
    check(page.browser.run("return document.getElementById('undo').disabled"), "a refused edit is no change")


def stl():
    """A tetrahedron as a binary STL file."""
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    faces = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]
    import struct
    facets = b"".join(
        struct.pack("<12fH", 0, 0, 0, *(float(x) for corner in face for x in corners[corner]), 0) for face in faces)
    return b"\0" * 80 + struct.pack("<I", len(faces)) + facets


def drop(page, name, content):
    page.browser.run("""
        const bytes = Uint8Array.from(atob(arguments[1]), letter => letter.charCodeAt(0));
        const data = new DataTransfer();
        data.items.add(new File([bytes], arguments[0]));
        document.dispatchEvent(new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true }));
    """, name, base64.b64encode(content).decode())
    page.settle()


def check_files(page, path):
    page.open(path)
    drop(page, "four.stl", stl())
    check(page.text("#mesh-size") == "4 vertices, 6 edges, 4 faces", page.text("#mesh-size"))
    mesh = {"file": {"name": "four.stl", "base64": base64.b64encode(stl()).decode()}}
    compare_queries(page, mesh, [("vertex_faces", "v2"), ("edge_edges", "v0-v1")])
    # A bad file has the message of the command line, and changes nothing.
    for name, content in [("bad.obj", b"v 0 0\nf 1 2 9\n"), ("none.xyz", b"1 2 3\n"), ("cut.stl", stl()[:100]), ("x.json", b"{}")]:
        drop(page, name, content)
        message = page.text("#message")
        check(message, name, "has no message")
        if not name.endswith(".json"):
            file = {"name": name, "base64": base64.b64encode(content).decode()}
            check(page.native(mesh={"file": file}, ask="facts")["error"] in message, message)
        check(page.text("#mesh-name") == "four.stl", page.text("#mesh-name"))
    # Text from files stays text.
    drop(page, "<img src=x onerror=alert(1)>.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    check(page.text("#mesh-name").startswith("<img"), page.text("#mesh-name"))
    check(page.browser.run("return document.querySelectorAll('img').length") == 0, "markup from a file name")


# Meshes that some structures cannot hold, by positions and faces from 1.
FAULTY = {
    "möbius": (5, [[1, 2, 3], [3, 2, 4], [3, 4, 5], [5, 4, 1], [5, 1, 2]]),
    "möbius of quads": (6, [[1, 2, 4, 3], [3, 4, 6, 5], [5, 6, 1, 2]]),
    "projective plane": (6, [[1, 2, 3], [1, 3, 4], [1, 4, 5], [1, 5, 6], [1, 6, 2], [2, 3, 5], [3, 4, 6], [4, 5, 2], [5, 6, 3], [6, 2, 4]]),
    "three at an edge": (5, [[1, 2, 3], [2, 1, 4], [2, 1, 5]]),
    "three quads at an edge": (8, [[1, 2, 3, 4], [2, 1, 5, 6], [2, 1, 7, 8]]),
    "same direction": (4, [[1, 2, 3], [1, 2, 4]]),
    "two fans": (5, [[1, 2, 3], [1, 4, 5]]),
    "lone vertex": (4, [[1, 2, 3]]),
    "quad": (4, [[1, 2, 3, 4]]),
    "quads, two fans": (7, [[1, 2, 3, 4], [1, 5, 6, 7]]),
    "twice": (4, [[1, 2, 3], [1, 2, 3], [1, 3, 4]]),
    "back to back and lone": (5, [[1, 2, 3], [3, 2, 1], [1, 3, 4]]),
}


def faulty(name):
    vertices, faces = FAULTY[name]
    positions = [f"v {math.cos(i):.3f} {math.sin(i):.3f} {0.3 * i * i:.3f}" for i in range(vertices)]
    return "\n".join([*positions, *("f " + " ".join(map(str, face)) for face in faces), ""])


def check_remedies(page, path):
    """Each remedy that is offered is carried out, and then the structure holds the mesh. Refusals and faults are those of the native engine."""
    offered = 0
    for name in FAULTY:
        mesh = {"file": {"name": "faulty.obj", "text": faulty(name)}}
        native = page.native(mesh=mesh, ask="verdicts")
        refusing = {verdict["backend"]: verdict["reason"] for verdict in native["verdicts"] if not verdict["holds"]}
        check(refusing, name)
        triangulated = page.native(mesh=mesh, triangulate=True, ask="verdicts")
        held = {verdict["backend"] for verdict in triangulated["verdicts"] if verdict["holds"]}
        for structure in refusing:
            page.open(path)
            drop(page, "faulty.obj", faulty(name).encode())
            button = f".card[data-structure={structure}] .refusal button"
            has_button = page.browser.run("return document.querySelector(arguments[0]) !== null", button)
            check(has_button == (structure in held), name, structure, "triangulate")
            check(refusing[structure] in page.text(f".card[data-structure={structure}] .refusal"), name, structure)
            if has_button:
                page.click(button)
                check(page.text(f".card[data-structure={structure}] .refusal") == "", name, structure, "with triangles")
                page.click("#undo")
                offered += 1
            page.click("[data-tab=check]")
            row = f"#verdicts [data-structure={structure}]"
            check(refusing[structure] in page.text(row), name, page.text(row))
            shown = page.text("#faults")
            check(all(f"{fault['count']} {fault['title']}" in shown for fault in native["faults"]), name, shown)
            page.click(f"[data-repair={structure}]")
            check("{" not in page.text("#repair"), page.text("#repair"))
            page.click("#take-repair")
            check("holds the mesh" in page.text(row), name, page.text(row))
            offered += 1
    check(offered > 30, offered)


VISIBLE = """
    return Object.fromEntries([...document.querySelectorAll('.card')].filter(card => !card.hidden).map(card => [card.dataset.structure,
        Math.max(...[...card.querySelectorAll('.tables table')].map(table => {
            const box = card.querySelector('.tables').getBoundingClientRect(), head = table.querySelector('thead').getBoundingClientRect().bottom;
            return [...table.querySelectorAll('tbody tr')].map(row => row.getBoundingClientRect())
                .filter(row => row.top >= head - 1 && row.bottom <= box.bottom + 1).length;
        }))]))
"""


def check_shown(page, path):
    """Two structures that are shown have the room of all six, and stay chosen in a link."""
    page.open(path)
    check(set(page.browser.run(VISIBLE)) == set(STRUCTURES), "all are shown")
    for name in STRUCTURES:
        if name not in ("half-edge", "corner-table"):
            page.click(f"[data-shown={name}]")
    rows = page.browser.run(VISIBLE)
    check(set(rows) == {"half-edge", "corner-table"} and min(rows.values()) >= 12, rows)
    page.click("#share-button")
    link = page.browser.run("return document.getElementById('link').value")
    page.open(path, link[link.index("#"):])
    check(page.browser.run(VISIBLE) == rows, page.browser.run(VISIBLE))
    page.click("[data-shown=half-edge]")
    page.click("[data-shown=corner-table]")
    # The last one stays, and it is in front.
    check(list(page.browser.run(VISIBLE)) == ["corner-table"], page.browser.run(VISIBLE))
    check(page.browser.run("return document.querySelector('.card.front').dataset.structure") == "corner-table", "in front")
    page.click("[data-tab=check]")
    check(page.browser.run("return document.getElementById('chosen').hidden"), "no choice without cards")


# What a card has to scroll aside, and the tables in which the lit rows are not the first ones.
ASIDE = """
    return [...document.querySelectorAll('.card')].filter(card => !card.hidden && card.querySelector('.tables').scrollWidth
        > card.querySelector('.tables').clientWidth).map(card => card.dataset.structure)
"""
NOT_FIRST = """
    return [...document.querySelectorAll('.card:not([hidden]) tbody')].filter(body => {
        const lit = [...body.rows].map(row => row.querySelector('.read, .read-now, .changed') !== null);
        return lit.lastIndexOf(true) >= lit.filter(one => one).length;
    }).map(body => body.closest('.card').dataset.structure)
"""
AT_HAND = """
    return [...document.querySelectorAll('.card:not([hidden]) .read-now')].filter(cell => {
        const row = cell.getBoundingClientRect(), box = cell.closest('.tables').getBoundingClientRect();
        return row.top < box.top || row.bottom > box.bottom;
    }).length
"""


def check_cards(page, path):
    """The rows that are read or changed come first, the row at hand is visible, and no card scrolls aside."""
    page.open(path)
    for shown in (STRUCTURES, ("half-edge", "winged-edge")):
        for name in STRUCTURES:
            if name not in shown:
                page.click(f"[data-shown={name}]")
        page.click("#first")
        for _ in range(12):
            page.click("#next")
            check(page.browser.run(NOT_FIRST) == [], "read rows first", page.browser.run(NOT_FIRST))
            check(page.browser.run(AT_HAND) == 0, "the row at hand is hidden")
        check(page.browser.run(ASIDE) == [], len(shown), "structures", page.browser.run(ASIDE))
        page.click("#back")
        check(page.browser.run(NOT_FIRST) == [], "one step back", page.browser.run(NOT_FIRST))
    page.edit("flip_edge v0-v2")
    check(page.browser.run(NOT_FIRST) == [], "changed rows first", page.browser.run(NOT_FIRST))
    check(page.browser.run(ASIDE) == [], "after an edit", page.browser.run(ASIDE))


# The page's view of the mesh and its marks, for the checks.
WATCH = """
    const { mark, drawNow } = View.prototype;
    View.prototype.mark = function (marks) { window.shownView = this; window.shownMarks = marks; return mark.call(this, marks); };
    View.prototype.drawNow = function () { window.shownView = this; return drawNow.call(this); };
    view_is_still = () => window.shownView && !window.shownView.turning;
    is_seen = () => { const { at } = window.shownMarks.find((one) => one.isAtHand).place, view = window.shownView;
        return view.model.isFree(at, view.turn.slice(6).map((part, axis) => view.centre[axis] + 4.2 * view.radius * part)); };
    labels = () => window.shownMarks.filter((one) => one.style === 'thin').flatMap((one) => one.label.split(', ')).sort();
"""


def check_turns(page, path):
    """The mesh turns to each element that it hides, also at once for those who want no motion, and not to one that it shows."""
    for motion in ("no-preference", "reduce"):
        page.browser.devtools("Emulation.setEmulatedMedia", features=[{"name": "prefers-reduced-motion", "value": motion}])
        page.open(path)
        page.browser.run(WATCH)
        page.type("#element", "v4")
        turn = page.browser.run("return [...window.shownView.turn]")
        turned = 0
        for element in ("v0", "v1", "v2", "v3", "v4", "v5", "f0", "f7", "f2", "f5", "v0-v4", "v1-v5", "v2-v5", "v3-v4"):
            page.type("#element", element)
            if motion == "reduce":
                check(page.browser.run("return view_is_still()"), element, "turns softly")
            page.browser.wait("return view_is_still()")
            check(page.browser.run("return is_seen()"), element, "is hidden")
            turned += page.browser.run("return [...window.shownView.turn]") != turn
            turn = page.browser.run("return [...window.shownView.turn]")
        check(3 < turned < 13, turned, "turns")
        page.type("#element", "v0")
        page.browser.wait("return view_is_still()")
        turn = page.browser.run("return [...window.shownView.turn]")
        page.click("#next")
        check(page.browser.run("return [...window.shownView.turn]") == turn, "turned to a place that is seen")
    page.browser.devtools("Emulation.setEmulatedMedia", features=[])


def check_arrows(page, path):
    """The fields of the row at hand are arrows on the mesh."""
    page.open(path)
    page.browser.run(WATCH)
    wings = ["left next", "left prev", "right next", "right prev"]
    for structure, labels in (("half-edge", ["next", "prev", "twin"]), ("winged-edge", wings), ("corner-table", ["next", "opposite", "prev"]), ("polygon-soup", [])):
        page.click(f".card[data-structure={structure}] h3 button")
        page.click("#first")
        for _ in range(2):
            page.click("#next")
        check(page.browser.run("return labels()") == labels, structure, page.browser.run("return labels()"))


# Steps through an edit: the rows of a card that are changed and its sentence after each step, from the beginning.
EDIT_STEPS = """
    const card = document.querySelector(`.card[data-structure=${arguments[0]}]`);
    const steps = [];
    for (let step = 0; step <= arguments[1]; step += 1) {
        document.getElementById(step ? 'next' : 'first').click();
        const changed = [...card.querySelectorAll('tr[data-row]')].filter(row => row.querySelector('.changed'));
        steps.push([changed.map(row => row.dataset.row), card.querySelector('.now').textContent]);
    }
    return steps;
"""


def check_edit_steps(page, path):
    """An edit plays through its writes: the tables and the mesh of before, row by row, to those of after, and back."""
    stored = """
        const card = document.querySelector(`.card[data-structure=${arguments[0]}]`);
        return [...card.querySelectorAll('tr[data-row]')].map(row => [row.dataset.row, [...row.querySelectorAll('td:not(.derived)')].map(cell => cell.textContent).join()]).sort()
    """
    tables = """return document.getElementById('cards').innerHTML.replaceAll(' class=""', '')"""
    for edit in ("flip_edge v0-v2", "split_edge v0-v2", "set_position v0 1,2,3", "remove_vertex v0"):
        page.open(path)
        before = {name: dict(page.browser.run(stored, name)) for name in STRUCTURES}
        page.edit(edit)
        native = page.native(mesh={"shape": {"name": "octahedron"}}, ask={"edit": edit})
        for answer in native["answers"]:
            name = answer["backend"]
            if answer["refusal"]:
                continue
            page.click(f".card[data-structure={name}] h3 button")
            writes = [row for row in answer["rows"] if row["written"]]
            check(page.text("#clock") == f"step {len(writes)} of {len(writes)}", name, edit, page.text("#clock"))
            end = page.browser.run(tables)
            page.click("#first")
            if edit.startswith(("flip", "set")) and name != "face-vertex":
                # Each row stays, with the same columns.
                check(dict(page.browser.run(stored, name)) == before[name], name, edit, "the tables before")
            steps = page.browser.run(EDIT_STEPS, name, len(writes))
            check(steps[0] == [[], "before the edit"], name, edit, steps[0])
            for number in range(1, len(writes) + 1):
                begun = {row["table"] for row in writes[:number]}
                done = writes[:number] + [row for row in answer["rows"] if not row["written"] and (row["table"] in begun or number == len(writes))]
                expected = {row["row"] for row in done if row["before"] != row["after"]}
                changed, sentence = steps[number]
                check(set(changed) == expected and writes[number - 1]["row"] in sentence, name, edit, number, steps[number])
            check(page.browser.run(tables) == end, name, edit, "the end is not as before")
            page.click("#back")
            page.click("#next")
            check(page.browser.run(tables) == end, name, edit, "the end is not as before")
    # The mesh is the one of before until the last write; so is that of a link.
    page.open(path)
    page.browser.run(WATCH)
    page.edit("poke_face f0")
    faces = "return window.shownView.model.faceCount"
    check(page.browser.run(faces) == 10, "the mesh after the edit")
    page.click("#back")
    check(page.browser.run(faces) == 8, "the mesh before the edit")
    page.click("#share-button")
    link = page.browser.run("return document.getElementById('link').value")
    page.open(path, link[link.index("#"):])
    page.browser.run(WATCH)
    page.click("#first")
    check(page.browser.run(faces) == 8, "the mesh before the edit of a link")
    page.click("#last")
    check(page.browser.run(faces) == 10, "the mesh after the edit of a link")


def check_elements(page, path):
    """All elements are in a list, which chooses them by keys; it follows the mesh and the level."""
    page.open(path)
    page.click("#elements summary")
    listed = "return [...document.querySelectorAll('#elements option')].map(one => one.value)"
    check(len(page.browser.run(listed)) == 6 + 12 + 8, page.browser.run(listed))
    page.browser.run("document.querySelector('#elements select').focus()")
    down = [{"type": "keyDown", "value": "\ue015"}, {"type": "keyUp", "value": "\ue015"}]
    page.browser.ask("POST", f"{page.browser.session}/actions", {"actions": [{"type": "key", "id": "keys", "actions": down}]})
    page.settle()
    check(page.browser.run("return document.getElementById('element').value") == "v1", "the next element by a key")
    choose = "const list = document.querySelector('#elements select'); list.value = arguments[0]; list.dispatchEvent(new Event('change', { bubbles: true }))"
    page.browser.run(choose, "v1-v3")
    page.settle()
    check(page.browser.run("return document.getElementById('element').value") == "v1-v3", "an edge of the list")
    page.edit("poke_face f0")
    check({"v6", "f9"} <= set(page.browser.run(listed)), page.browser.run(listed))
    page.click("[data-tab=subdivide]")
    page.browser.run(choose, "v12")
    page.settle()
    check(page.browser.run("return document.getElementById('point').value") == "v12", "a point of a level")


def check_primary(page, path):
    """One button is the primary one: the one that is pressed next."""
    shown = """
        return [...document.querySelectorAll('button.main')].filter(one => one.checkVisibility() && !one.closest('#lesson'))
            .map(one => one.id || one.dataset.edit || one.dataset.repair)
    """
    def expect(*names):
        check(page.browser.run(shown) == list(names), names, page.browser.run(shown))
    page.open(path)
    expect("next")
    page.click("#next")
    expect("next")
    page.click("#last")
    expect()
    page.click("[data-tab=edit]")
    expect("remove_vertex v0")
    page.edit("flip_edge v0-v2")
    expect("play")
    page.click("#first")
    expect("next")
    page.click("[data-tab=walk]")
    expect()
    write = "const field = document.getElementById('walk-text'); field.value = 'yield v1'; field.dispatchEvent(new Event('input', { bubbles: true }))"
    page.browser.run(write)
    expect("run-walk")
    page.click("#run-walk")
    expect("next")
    page.click("[data-tab=measure]")
    expect("measure")
    page.click("[data-tab=edit]")
    page.type("#element", "v0-v3")
    page.click("button.fault")
    expect("winged-edge")
    page.click("[data-repair=half-edge]")
    expect("take-repair")


def check_failure(page, path):
    """The engine fails once: the page shows it, starts the engine again, and has lost nothing."""
    page.open(path)
    page.edit("flip_edge v0-v2")
    page.browser.run("""
        const post = Worker.prototype.postMessage;
        Worker.prototype.postMessage = function (message) {
            Worker.prototype.postMessage = post;
            post.call(this, { number: message.number, bytes: Uint8Array.of(0) });
        };
    """)
    page.click("[data-tab=query]")
    check("Please report it" in page.text("#message"), page.text("#message"))
    compare_queries(page, {"shape": {"name": "octahedron"}}, [("vertex_faces", "v2")], ["flip_edge v0-v2"])
    check(page.text("#message") == "", page.text("#message"))


def check_links(page, path):
    page.open(path)
    page.edit("flip_edge v0-v2")
    page.edit("split_edge v1-v4")
    page.click("[data-tab=query]")
    page.type("#element", "v6")
    page.click("#next")
    page.click("#next")
    before = page.browser.run(SHOWN)
    clock = page.text("#clock")
    page.click("#share-button")
    link = page.browser.run("return document.getElementById('link').value")
    page.open(path, link[link.index("#"):])
    check(page.text("#clock") == clock, page.text("#clock"), clock)
    check(page.browser.run(SHOWN) == before, "the state of the link")
    page.click("#undo")
    page.click("#undo")
    check(page.browser.run("return document.getElementById('undo').disabled"), "the edits of a link can be undone")
    state = {"sixfold": 1, "subject": {"mesh": {"shape": {"name": "cube"}}}, "name": "mine", "edits": [], "view": {"element": "f3", "relation": "face_faces"}}
    drop(page, "state.json", json.dumps(state).encode())
    check(page.text("#mesh-name") == "mine", page.text("#message"))
    check(page.browser.run("return document.getElementById('element').value") == "f3", "the element of a state file")
    for link, message in [("#s=AAAA", "damaged"), ("#s=!", "damaged"), ("#what", "not known"), ("#lesson=flap", "no lesson flap"), ("#show=flip/9", "number 9"), ("#show=flip/1&only=all", "not known"), ("#show=flip/9&only=cards", "number 9")]:
        page.open(path, link)
        check(message in page.text("#message"), link, page.text("#message"))
        check(page.text("#mesh-name") == "octahedron", link, page.text("#mesh-name"))
    # One part alone.
    for only, shown, hidden in (("cards", "#cards", "#view"), ("mesh", "#view", "#cards")):
        page.open(path, f"#show=flip/1&only={only}")
        visible = "return ['header', 'nav', '#panel', '#race', arguments[0], arguments[1], '#player'].map(one => document.querySelector(one).getClientRects().length > 0)"
        check(page.browser.run(visible, hidden, shown) == [False] * 5 + [True] * 2, only, page.browser.run(visible, hidden, shown))
        check(page.browser.run("return document.documentElement.scrollWidth <= innerWidth"), only, "is wider than the page")
        page.click("#next")
        check(page.browser.run("return localStorage.getItem('sixfold-explorer')") is None, only, "is kept")
    page.open(path)
    # A state that is not one changes nothing.
    page.edit("flip_edge v0-v2")
    cube = {"mesh": {"shape": {"name": "cube"}}}
    for state in ({}, {"sixfold": 9, "subject": cube}, {"sixfold": 1, "subject": {"mesh": "last"}}, {"sixfold": 1, "subject": {"mesh": {"shape": {"name": "cub"}}}}):
        drop(page, "state.json", json.dumps(state).encode())
        check(page.text("#message") and page.text("#mesh-name") == "octahedron", state, page.text("#message"))
    # Fields of a state that cannot be are those of a new page.
    view = {"tab": "__proto__", "element": "v99", "time": -5, "focus": "none", "level": 1.5, "point": "v0-v1", "lesson": 7, "__proto__": {"tab": "x"}}
    drop(page, "state.json", json.dumps({"sixfold": 1, "subject": cube, "view": view, "edits": ["remove_face f99", "poke_face f0"]}).encode())
    check("remove_face f99" in page.text("#message"), page.text("#message"))
    check(page.text("#mesh-size") == "9 vertices, 16 edges, 9 faces", page.text("#mesh-size"))
    for _ in range(3):
        page.click("#undo")
    check(page.text("#mesh-name") == "octahedron", "a state that is opened can be undone")


def predict(page, *values):
    """Fills the fields of a prediction, and checks it. Returns the verdicts."""
    page.browser.run("""
        const fields = [...document.querySelectorAll("#predict .ask input.number, #predict .ask select, #predict .ask fieldset")];
        arguments[0].forEach((value, i) => {
            if (Array.isArray(value)) for (const box of fields[i].querySelectorAll("input")) box.checked = value.includes(box.value);
            else if (value !== null) fields[i].value = String(value);
        });
    """, list(values))
    page.click("#predict-check")
    return page.browser.run("return [...document.querySelectorAll('#verdict li')].map((one) => one.textContent)")


def check_predictions(page, path):
    """Queries, edits, levels and refusals are predicted before they are shown; the native engine knows what is right."""
    octahedron = {"mesh": {"shape": {"name": "octahedron"}}}
    page.open(path)
    page.click("#quiz")
    check(page.browser.run("return document.getElementById('next').disabled"), "the next step is not hidden")
    native = page.native(**octahedron, structures=["half-edge"], ask={"trace": {"relation": "vertex_vertices", "element": "v0"}})
    reads = [step["row"] for step in native["answers"][0]["steps"] if step["step"] == "read"]
    check(predict(page) == [] and "Answer this first: rows read" in page.text("#predict-say"))
    check(predict(page, len(reads) + 1) == [f"✗ rows read: you {len(reads) + 1}, it is {len(reads)}"], page.text("#predict"))
    row = ".card[data-structure=half-edge] tr[data-row={}] th"
    page.click(row.format("h9"))
    check(page.text("#quiz-line").startswith("Not h9"), page.text("#quiz-line"))
    for name in reads:
        page.click(row.format(name))
        check(page.text("#quiz-line").startswith(f"Right: {name}"), page.text("#quiz-line"))
    check(f"{len(reads) - 1} right at once, 1 wrong" in page.text("#quiz-line"), page.text("#quiz-line"))
    for relation in ("vertex_faces", "vertex_edges"):
        page.click(f"[data-relation={relation}]")
        native = page.native(**octahedron, structures=["half-edge"], ask={"trace": {"relation": relation, "element": "v0"}})
        reads = native["answers"][0]["reads"]
        check(predict(page, reads) == [f"✓ rows read: {reads}"], relation, page.text("#predict"))
    page.click("#predict-show")
    check(not page.browser.run("return document.getElementById('next').disabled"), "the steps are shown")
    check_predicted_edits(page, octahedron)
    # A step of subdivision.
    page.open(path)
    page.click("#quiz")
    page.click("[data-tab=subdivide]")
    page.type("#level", 0)
    levels = page.native(**octahedron, ask={"subdivide": {"scheme": "loop", "levels": 1}})["levels"][1]
    edges = {tuple(sorted(pair)) for face in levels["faces"] for pair in zip(face, face[1:] + face[:1])}
    counts = [len(levels["vertices"]), len(edges), len(levels["faces"])]
    verdict = predict(page, *counts, 7)
    check([one[0] for one in verdict] == ["✓", "✓", "✓", "✗"] and "irregular vertices: you 7, it is 6" in verdict[3], verdict)
    check(page.browser.run("return document.getElementById('level').value") == "1")
    # A mesh that structures refuse.
    page.open(path)
    page.click("#quiz")
    drop(page, "book.obj", b"v 0 0 0\nv 0 0 1\nv 1 0 0\nv -1 1 0\nv -1 -1 0\nf 1 2 3\nf 2 1 4\nf 1 2 5\n")
    page.click("[data-tab=check]")
    check(page.text("#verdicts") == "", "the verdicts are shown")
    verdict = predict(page, STRUCTURES[3:])
    check(verdict == [f"✓ these structures refuse the mesh: {', '.join(STRUCTURES[3:])}"] and page.text("#verdicts"), verdict)


def check_predicted_edits(page, octahedron):
    """An edit waits until it is predicted, cell by cell."""
    page.edit("flip_edge v0-v2")
    check(page.text("#edit-result") == "" and "flip_edge v0-v2 on half-edge" in page.text("#predict"), page.text("#predict"))
    [native] = page.native(**octahedron, structures=["half-edge"], ask={"edit": "flip_edge v0-v2"})["answers"]
    for change in native["rows"]:
        for i, (before, after) in enumerate(zip(change["before"], change["after"])):
            if before != after:
                page.browser.run("""
                    const cells = [...document.querySelectorAll(`.card[data-structure=half-edge] tr[data-row=${arguments[0]}] td:not(.derived)`)];
                    const stored = cells.length > arguments[2] ? cells.slice(-arguments[2]) : cells;
                    stored[arguments[1]].click();
                """, change["row"], i, len(change["before"]))
    after = native["after"]
    verdict = predict(page, "done", None, native["changed"], after["vertices"], after["edges"], after["faces"] + 1)
    check(verdict[0] == "✓ flip_edge v0-v2 on half-edge" and any(one.startswith("✓ cells marked: all") for one in verdict), verdict)
    check([one for one in verdict if one[0] == "✗"] == [f"✗ F after: you {after['faces'] + 1}, it is {after['faces']}"], verdict)
    check("flip_edge v0-v2" in page.text("#edit-result"), page.text("#edit-result"))
    page.edit("collapse_edge v0-v2 v0")
    page.click("#predict-cancel")
    check("Choose the next edit" in page.text("#predict"), page.text("#predict"))
    tetrahedron = {"sixfold": 1, "subject": {"mesh": {"shape": {"name": "tetrahedron"}}}, "name": "tetrahedron", "edits": [], "view": {"tab": "edit", "quiz": True}}
    drop(page, "state.json", json.dumps(tetrahedron).encode())
    page.edit("flip_edge v0-v1")
    verdict = predict(page, "refused", "a vertex would keep too few edges")
    check([one[0] for one in verdict] == ["✓", "✓", "✓"] and "only three edges" in verdict[0], verdict)


def check_walks(page, path):
    page.open(path)
    page.click("[data-tab=walk]")
    written = "return document.getElementById('walk-text').value"
    # The task comes first, without an answer.
    check(page.browser.run(written) == "" and page.text("#walk-result") == "", page.text("#walk-result"))
    check("that yields the vertices beside v0" in page.text("#panel"), page.text("#panel"))
    page.click("#hint")
    check("leaving(v0)" in page.text("#walk-hint") and page.browser.run(written) == "", page.text("#walk-hint"))
    page.browser.run("document.getElementById('walk-text').value = 'h = leaving(v0)\\nyield frobnicate(h)'")
    page.click("#run-walk")
    check("frobnicate" in page.text("#walk-result"), page.text("#walk-result"))
    # The solution is that of the chosen element, and of the chosen structure.
    page.type("#element", "v3")
    page.click("#solution")
    for name in ("winged-edge", "corner-table", "half-edge"):
        page.click(f".card[data-structure={name}] h3 button")
        check("v3" in page.browser.run(written), name)
        check("Right: the walk yields vertex_vertices" in page.text("#walk-result"), name, page.text("#walk-result"))
    for name in STRUCTURES[:3]:
        page.click(f".card[data-structure={name}] h3 button")
        check("does not yield" in page.text("#walk-result"), name, page.text("#walk-result"))


def check_measurements(page, path):
    page.open(path)
    page.click("[data-tab=measure]")
    page.click("#measure")
    rows = page.browser.run("return [...document.querySelectorAll('#times tr[data-structure]')].map(row => row.dataset.structure)")
    check(sorted(rows) == sorted(STRUCTURES), rows)
    check(page.text("#message") == "", page.text("#message"))
    # Another relation is chosen here, and the times of both stand beside each other.
    page.click("[data-relation=face_faces]")
    page.click("#measure")
    heads = page.browser.run("return [...document.querySelector('#measured tr').cells].map(one => one.textContent)")
    check(heads == ["structure", "VV", "FF"], heads)


def check_memory(page, path):
    """The bytes, the formulas and the tables of each structure are those of the native engine."""
    page.open(path)
    for name, mesh in (("octahedron", {"shape": {"name": "octahedron"}}), ("cube.obj", {"file": {"name": "cube.obj", "text": CUBE}})):
        if "file" in mesh:
            drop(page, name, CUBE.encode())
        page.click("[data-tab=measure]")
        native = page.native(mesh=mesh, ask="memory")
        check(native["answers"], native)
        for answer in native["answers"]:
            row = f"#memory [data-structure={answer['backend']}]"
            check(f"{answer['bytes']} bytes, " in page.text(f"{row} .size"), page.text(row), answer)
            formula, numbers = page.text(f"{row} .formula").split(" = ")
            check(formula == answer["formula"], formula, answer)
            check(sum(math.prod(int(factor) for factor in term.split(" · ")) for term in numbers.split(" + ")) == answer["bytes"], numbers, answer)
            page.click(f"{row} summary")
            tables = page.browser.run("""return [...document.querySelectorAll(arguments[0])].map(row =>
                [row.dataset.table, ...[1, 2, 3].map(i => row.cells[i].firstChild.textContent.replace(/.* = /, ''))])""", f"{row} tr[data-table]")
            check(tables == [[one["table"]] + [str(one[key]) for key in ("rows", "row_bytes", "bytes")] for one in answer["tables"]], tables, answer)
        for refused in native["refused"]:
            check(page.text(f"#memory [data-structure={refused['backend']}]") == refused["reason"], refused)


def check_weld(page, path):
    """The corners of the soup become the vertices that the native engine says, at each tolerance."""
    page.open(path)
    drop(page, "cube.obj", CUBE.encode())
    page.click("[data-tab=check]")
    mesh = {"file": {"name": "cube.obj", "text": CUBE}}
    read = """return { tolerance: Number(document.getElementById('tolerance-value').textContent), counts: document.querySelector('#weld-counts').textContent,
        map: [...document.querySelectorAll('.weld-map line')].map(line => Number(line.dataset.to)) }"""
    for step in (0, 1, 25, 50):
        page.type("#tolerance", str(step)) if step else None
        page.browser.run("document.getElementById('tolerance').dispatchEvent(new Event('input'))")
        shown = page.browser.run(read)
        check((shown["tolerance"] == 0) == (step == 0), shown)
        native = page.native(mesh=mesh, ask={"weld": {"tolerance": shown["tolerance"]}})["weld"]
        check(shown["counts"].startswith(f"{native['corners']} corners → {native['vertices']} vertices"), shown, native)
        check(len(shown["map"]) >= 12 and shown["map"] == native["map"][:len(shown["map"])], shown, native)
    # Vertices that are closer than the tolerance become one.
    near = CUBE.replace("v 1 1 1", "v 0.05 0.05 0.05")
    drop(page, "near.obj", near.encode())
    page.click("[data-tab=check]")
    page.type("#tolerance", "50")
    page.browser.run("document.getElementById('tolerance').dispatchEvent(new Event('input'))")
    shown = page.browser.run(read)
    native = page.native(mesh={"file": {"name": "near.obj", "text": near}}, ask={"weld": {"tolerance": shown["tolerance"]}})["weld"]
    check(native["vertices"] == 7 and "8 different vertices become 7" in shown["counts"], native, shown)
    check(f"{native['vertices']} vertices" in shown["counts"] and f"{native['faces_changed']} face" in shown["counts"], shown, native)
    page.browser.run("document.querySelector('.weld-map [data-vertex=\"0\"]').dispatchEvent(new MouseEvent('click', { bubbles: true }))")
    page.settle()
    chosen = page.browser.run("return [...document.querySelectorAll('.weld-map line.chosen')].map(line => Number(line.dataset.corner))")
    check(chosen == [c for c, v in enumerate(native["map"]) if v == 0], chosen, native)


def check_levels(page, path):
    page.open(path)
    page.click("[data-tab=subdivide]")
    check(page.text("#mesh-size") == "18 vertices, 48 edges, 32 faces", page.text("#mesh-size"))
    page.type("#point", "v8")
    native = page.native(mesh={"shape": {"name": "octahedron"}}, ask={"stencil": {"scheme": "loop", "level": 1, "point": 8}})
    shown = page.browser.run("return [...document.querySelectorAll('#stencil tr')].map(row => [...row.cells].map(cell => cell.textContent))")
    value = lambda text: int(text.split("/")[0]) / int((text + "/1").split("/")[1]) if "." not in text else float(text)
    # The parents are points of the level before.
    expected = [[parent["vertex"] + "⁰", parent["weight"]] for parent in native["parents"]]
    check([[name, value(weight)] for name, weight in shown] == expected, shown, expected)
    check(page.text("#stencil caption").startswith("v8¹ = "), page.text("#stencil caption"))
    levels = "return [...document.querySelectorAll('#levels tr')].slice(1).map(row => [...row.cells].map(cell => cell.textContent))"
    # Each vertex of an octahedron has valence 4, each new point of Loop's scheme valence 6.
    check(page.browser.run(levels) == [["0", "6", "12", "8", "2", "64"], ["1", "18", "48", "32", "2", "64126"]], page.browser.run(levels))
    drawn = """return [...document.querySelectorAll('[data-picture]')].map(one =>
        new Set(one.getContext('2d').getImageData(0, 0, one.width, one.height).data).size > 8)"""
    check(page.browser.run(drawn) == [True, True], "the pictures of the levels", page.browser.run(drawn))
    page.click("[data-level='0']")
    check(page.text("#mesh-size").startswith("6 vertices"), page.text("#mesh-size"))
    # A sharp edge stays with its mesh, and goes with an edit that deletes it.
    page.open(path)
    page.type("#element", "v0-v2")
    page.click("[data-tab=subdivide]")
    page.browser.run("[...document.querySelectorAll('#panel button')].find(one => one.textContent === 'make sharp').click()")
    page.settle()
    check("1 sharp element" in page.text("#panel"), page.text("#panel"))
    page.edit("split_edge v1-v4")
    page.click("[data-tab=subdivide]")
    check("1 sharp element" in page.text("#panel"), page.text("#panel"))
    page.edit("flip_edge v0-v2")
    page.click("[data-tab=subdivide]")
    check("no sharp elements" in page.text("#panel") and not page.text("#message"), page.text("#panel"))
    page.open(path)
    page.click("[data-tab=subdivide]")
    page.type("#scheme", "doo-sabin")
    check(page.text("#mesh-size") == "24 vertices, 48 edges, 26 faces", page.text("#mesh-size"))


def check_regularity(page, path):
    """Irregular vertices and boundary loops can be seen."""
    def irregular():
        page.browser.run("document.querySelector('#names [value=valence]').checked || document.querySelector('#names [value=valence]').click()")
        return page.browser.run("return window.shownView.valenceMarks().length")

    def open_shape(shape, **parameters):
        state = {"sixfold": 1, "subject": {"mesh": {"shape": {"name": shape, "parameters": parameters}}}, "name": shape, "edits": []}
        drop(page, "state.json", json.dumps(state).encode())

    page.open(path)
    page.browser.run(WATCH)
    expected = {"octahedron": 6, "triangle-torus": 0, "torus": 0, "grid": 4, "cube": 8, "icosahedron": 12, "dodecahedron": 0}
    for shape, number in expected.items():
        open_shape(shape, **({"m": 6, "n": 6} if shape in ("grid", "torus", "triangle-torus") else {}))
        check(irregular() == number, shape, irregular())
    loops = "return [...document.querySelectorAll('[data-loop]')].map(one => one.textContent)"
    for shape, parameters, lengths in (("grid-with-hole", {"m": 3, "n": 3}, [12, 4]), ("moebius", {"n": 6}, None), ("octahedron", {}, [])):
        open_shape(shape, **parameters)
        page.click("[data-tab=check]")
        shown = page.browser.run(loops)
        if lengths is None:
            check(len(shown) == 1, shape, shown)
        else:
            check(sorted(shown) == sorted(f"{length} edges" for length in lengths), shape, shown)
    open_shape("grid-with-hole", m=3, n=3)
    page.click("[data-tab=check]")
    page.click("[data-loop]")
    check(page.browser.run("return window.shownMarks.length") in (4, 12), "the marks of a loop")


def check_lessons(page, path):
    """Opens each lesson, shows all that its commands show, and answers all questions, with answers that the native program
    works out: wrong ones first, and then the right ones. The program grades the file of answers."""
    lessons = page.lessons
    page.open(path)
    page.click("#lessons-button")
    names = page.browser.run("return [...document.querySelectorAll('[data-lesson]')].map(one => one.dataset.lesson)")
    check(names == [lesson["name"] for lesson in lessons], names)
    asked = 0
    for lesson in lessons:
        page.click(f"[data-lesson={lesson['name']}]")
        sections = page.browser.run("return document.querySelectorAll('#lesson .section').length")
        check(sections == 1, lesson["name"], sections)
        for part in lesson["parts"]:
            if "question" not in part:
                continue
            answer_question(page, part)
            asked += len(part.get("asks", []))
            check("Next" not in page.text("#lesson .question:last-of-type"))
            if page.text("#lesson-next"):
                page.click("#lesson-next")
        count = len([part for part in lesson["parts"] if "question" in part])
        right = len([part for part in lesson["parts"] if part.get("asks")])
        check(page.text("#progress") == f"{count} of {count} question{'' if count == 1 else 's'} answered, {right} right", page.text("#progress"))
        shows = page.browser.run("return document.querySelectorAll('#lesson .show').length")
        for i in range(shows):
            page.browser.run("document.querySelectorAll('#lesson .show')[arguments[0]].click()", i)
            page.settle()
            check(page.text("#message") == "", lesson["name"], page.text("#message"))
        page.click("#lesson .link")
    check(asked > 60, asked, "values are asked for")
    page.type("#student", "Ada =1+1")
    text = saved(page, "#save-answers")
    check_reload(page, path)
    check_grades(page, text, lessons)


def answer_question(page, part):
    """Answers the question of a lesson."""
    names = ["polygon-soup", "corner-table"]
    wrong = {"number": lambda truth: truth + 1, "list": lambda truth: [name for name in names if name not in truth][:1], "text": lambda truth: ""}
    element = f"[data-question='{part['id']}']"
    if not part.get("asks"):
        page.click(f"[data-check='{part['id']}']")
        check(page.text(f"{element} .feedback").startswith("Give an answer"), part)
        page.browser.run("document.querySelector(arguments[0]).value = arguments[1]", f"{element} textarea", "<b>because</b>")
        page.click(f"[data-check='{part['id']}']")
        check("because" in page.text(element) and page.text(f"{element} .solution"), part)
        return
    for is_right in (False, True):
        for i, ask in enumerate(part["asks"]):
            truth = ask["truth"]
            kind = "list" if isinstance(truth, list) else "text" if "options" in ask else "number"
            value = truth if is_right else wrong[kind](truth) if kind != "text" else next(one for one in ask["options"] if one != truth)
            page.browser.run("""
                const field = document.querySelectorAll(`${arguments[0]} > p`)[arguments[1] + 1];
                const value = arguments[2];
                if (Array.isArray(value)) for (const box of field.querySelectorAll("input")) box.checked = value.includes(box.value);
                else field.querySelector("input, select").value = String(value);
            """, element, i, value)
        if not is_right and page.browser.run("return !!document.querySelector(arguments[0])", f"[data-hint='{part['id']}']"):
            page.click(f"[data-hint='{part['id']}']")
            check(page.text(f"{element} .feedback").startswith("Hint: "), part)
        page.click(f"[data-check='{part['id']}']")
        if not is_right:
            check(page.text(f"{element} .feedback").startswith("Not yet: ") and not page.text(f"{element} .solution"), part, page.text(element))
    check(page.text(f"{element} .solution") and "✓" in page.text(element) and "you:" not in page.text(element), part, page.text(element))


def saved(page, selector):
    """The text of a file that a button offers."""
    page.browser.run("""
        window.offered = null;
        const make = URL.createObjectURL;
        URL.createObjectURL = (blob) => { blob.text().then((text) => { window.offered = text; }); URL.createObjectURL = make; return "data:,"; };
    """)
    page.click(selector)
    return page.browser.wait("return window.offered")


def check_reload(page, path):
    """Answers, mesh and edits come back after a reload, until they are forgotten; without room for them, this is said once."""
    page.open(path)
    page.edit("poke_face f0")
    page.click("#lessons-button")
    page.click("[data-lesson=flip]")
    page.browser.wait("return JSON.parse(localStorage.getItem('sixfold-explorer') ?? '{}').state?.includes('triangulate')")
    page.click("#lesson-next" if page.text("#lesson-next:enabled") else "#open-all")
    page.edit("flip_edge v0-v2")
    page.browser.wait("return JSON.parse(localStorage.getItem('sixfold-explorer')).state.includes('flip_edge')")
    before = [page.text(one) for one in ("#mesh-name", "#mesh-size", "#lesson")]
    page.open(path, keeps=True)
    check([page.text(one) for one in ("#mesh-name", "#mesh-size", "#lesson")] == before, "after a reload")
    check(not page.browser.run("return document.getElementById('undo').disabled"))
    page.click("#lesson .link")
    page.click("#forget")
    page.click("#forget")
    page.browser.run("localStorage.setItem('sixfold-explorer', '{\"own\": 1, \"course\": {\"answers\": {\"x\": 7}, \"sections\": [1]}}')")
    page.open(path, keeps=True)
    check(page.text("#mesh-name") == "octahedron" and page.text("#message") == "")
    page.browser.run("Storage.prototype.setItem = () => { throw new DOMException('full', 'QuotaExceededError'); }")
    page.type("#element", "v1")
    page.browser.wait("return document.getElementById('message').textContent.includes('local storage')")
    page.click("#message button")
    page.type("#element", "v2")
    page.browser.run("return new Promise((done) => setTimeout(done, 700))")
    check(page.text("#message") == "", page.text("#message"))


def check_grades(page, text, lessons):
    """The program grades the file of answers, and names what was changed or belongs to another lesson."""
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        good, changed = scratch / "good.json", scratch / "changed.json"
        good.write_text(text)
        changed.write_text(text.replace('"tries":2', '"tries":1'))
        graded = subprocess.run([page.sixfold, "lessons", "--check", good, "--csv", scratch / "all.csv"], capture_output=True, text=True)
        check(graded.returncode == 0 and "Ada =1+1" in graded.stdout, graded)
        for lesson in lessons:
            right = len([part for part in lesson["parts"] if part.get("asks")])
            check(re.search(rf"{lesson['name']} +{right} of {right} ", graded.stdout), lesson["name"], graded.stdout)
        rows = list(csv.DictReader((scratch / "all.csv").open()))
        check({row["right"] for row in rows} == {"true", ""} and {row["student"] for row in rows} == {"Ada =1+1"}, rows[0])
        both = subprocess.run([page.sixfold, "lessons", "--check", good, changed], capture_output=True, text=True)
        check(both.returncode == 1 and "changed.json: was changed after the export" in both.stderr, both)


def check_sizes(page, path, folder):
    for name, (width, height) in SIZES.items():
        page.browser.devtools("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 500)
        for scheme in ("light", "dark"):
            page.browser.devtools("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
            page.open(path)
            for _ in range(5):
                page.click("#next")
            wide = page.browser.run("return document.documentElement.scrollWidth")
            check(wide <= width, name, "is", wide, "pixels wide")
            over = page.browser.run("""
                const race = document.getElementById('race').getBoundingClientRect(), cards = document.getElementById('cards').getBoundingClientRect();
                return Math.min(race.right, cards.right) - Math.max(race.left, cards.left) > 1
                    && Math.min(race.bottom, cards.bottom) - Math.max(race.top, cards.top) > 1;
            """)
            check(not over, name, "the counters are over the cards")
            for button in ("#next", "#undo", "#share-button", "[data-tab=edit]"):
                box = page.browser.run("const box = document.querySelector(arguments[0]).getBoundingClientRect(); return [box.width, box.height]", button)
                check(min(box) >= 24, name, button, box)
            if folder:
                shot = page.browser.devtools("Page.captureScreenshot")
                (folder / f"{name}-{scheme}.png").write_bytes(base64.b64decode(shot["data"]))


# Finds texts and controls that overlap, are cut off, or make the page scroll aside.
LAYOUT = """
    const found = [];
    const nameOf = one => (one.id ? '#' + one.id : one.tagName.toLowerCase() + (one.className ? '.' + one.className : '')) + ' “' + (one.textContent || one.value || '').trim().slice(0, 30) + '”';
    if (document.documentElement.scrollWidth > innerWidth) found.push('the page scrolls aside: ' + document.documentElement.scrollWidth);
    const isShown = one => one.checkVisibility({ visibilityProperty: true, contentVisibilityAuto: true });
    const controls = 'button, input, select, textarea, summary';
    const shown = [...document.querySelectorAll('body *:not(script, style, option, optgroup, noscript)')].filter(isShown);
    // The part of a box that its scroll boxes show.
    const visible = (one, box) => {
        let [left, top, right, bottom] = [box.left, box.top, box.right, box.bottom];
        for (let above = one.parentElement; above && above !== document.body; above = above.parentElement) {
            const style = getComputedStyle(above), outer = above.getBoundingClientRect();
            if (style.overflowX !== 'visible') [left, right] = [Math.max(left, outer.left), Math.min(right, outer.right)];
            if (style.overflowY !== 'visible') [top, bottom] = [Math.max(top, outer.top), Math.min(bottom, outer.bottom)];
        }
        return right - left > 3 && bottom - top > 3 ? { left, top, right, bottom } : null;
    };
    const boxes = [];
    for (const one of shown) {
        const texts = [...one.childNodes].filter(node => node.nodeType === 3 && node.data.trim());
        const isControl = one.matches(controls);
        if (!isControl && !texts.length) continue;
        // Text that is cut off says so with an ellipsis, and has a title; a field or a list scrolls.
        const style = getComputedStyle(one);
        const scrolls = ['auto', 'scroll'].includes(style.overflowX) || one.matches('input, textarea, select[size]');
        const isCut = one.clientWidth > 0 && one.scrollWidth > one.clientWidth + 1;
        if (isCut && !scrolls && style.textOverflow !== 'ellipsis') found.push('cut off: ' + nameOf(one));
        if (isControl) boxes.push({ one, box: visible(one, one.getBoundingClientRect()) });
        else if (!one.closest('button, summary, select')) for (const text of texts) {
            const range = document.createRange();
            range.selectNodeContents(text);
            for (const rect of range.getClientRects()) boxes.push({ one, box: visible(one, rect) });
        }
    }
    const isSticky = one => one.closest('thead, footer');
    const all = boxes.filter(({ box }) => box);
    all.forEach((a, i) => {
        for (const b of all.slice(i + 1)) {
            const wide = Math.min(a.box.right, b.box.right) - Math.max(a.box.left, b.box.left);
            const high = Math.min(a.box.bottom, b.box.bottom) - Math.max(a.box.top, b.box.top);
            if (wide < 3 || high < 6 || a.one.contains(b.one) || b.one.contains(a.one)) continue;
            // Headings of tables and the player stay in place over what scrolls.
            if (isSticky(a.one) !== isSticky(b.one)) continue;
            found.push('overlap: ' + nameOf(a.one) + ' and ' + nameOf(b.one));
        }
    });
    const aside = [...document.querySelectorAll('#panel, #panel section, #panel .grow, .tables, #right, #left, dialog, #race')].filter(one => isShown(one) && one.scrollWidth > one.clientWidth + 1);
    return [...found, ...aside.map(one => 'scrolls aside: ' + nameOf(one))].slice(0, 12);
"""

# Texts whose contrast with their background is below 4.5 to 1 (WCAG 2.1).
CONTRAST = """
    const pen = Object.assign(document.createElement('canvas'), { width: 1, height: 1 }).getContext('2d', { willReadFrequently: true });
    const known = new Map();
    const parts = colour => {
        if (!known.has(colour)) {
            pen.clearRect(0, 0, 1, 1);
            pen.fillStyle = colour;
            pen.fillRect(0, 0, 1, 1);
            known.set(colour, [...pen.getImageData(0, 0, 1, 1).data]);
        }
        return known.get(colour);
    };
    const light = ([r, g, b]) => [r, g, b].map(part => part / 255).map(part => part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4)
        .reduce((sum, part, i) => sum + part * [0.2126, 0.7152, 0.0722][i], 0);
    const found = new Set();
    for (const one of document.querySelectorAll('body *:not(script, style, option, optgroup, noscript)')) {
        if (![...one.childNodes].some(node => node.nodeType === 3 && node.data.trim()) || !one.checkVisibility({ visibilityProperty: true })) continue;
        if (one.closest(':disabled, .absent, .stopped')) continue;
        let ground = one;
        while (ground && parts(getComputedStyle(ground).backgroundColor)[3] < 200) ground = ground.parentElement;
        const [a, b] = [light(parts(getComputedStyle(one).color)), light(parts(getComputedStyle(ground ?? document.body).backgroundColor))];
        const contrast = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
        if (contrast < 4.5) found.add(`${one.tagName}.${one.className} “${one.textContent.slice(0, 20)}” ${contrast.toFixed(2)}`);
    }
    return [...found].slice(0, 12);
"""

WIDTHS = {1440: 900, 1024: 768, 864: 768, 820: 1000, 768: 1024, 390: 844}


def check_layout(page, path):
    """In each tab and at each width: no overlap, nothing cut off, nothing that scrolls aside, and the mesh stays in its place."""
    for width, height in WIDTHS.items():
        page.browser.devtools("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 500)
        page.open(path)
        places = set()
        for tab in ("query", "edit", "walk", "subdivide", "check", "measure"):
            page.click(f"[data-tab={tab}]")
            if tab == "query":
                page.click("#next")
            if tab == "edit":
                page.edit("flip_edge v0-v2")
            if tab == "walk":
                page.click("#solution")
            if tab == "subdivide":
                page.type("#point", "v8")
            if tab == "measure" and width in (1440, 390):
                page.click("#measure")
            found = page.browser.run(LAYOUT)
            check(not found, width, tab, *found)
            places.add(tuple(page.browser.run("const box = document.getElementById('view').getBoundingClientRect(); return [box.x + scrollX, box.y + scrollY, box.width, box.height]")))
        check(len(places) == 1, width, "the mesh moves", places)
        for button in ("#mesh-button", "#share-button", "#help-button"):
            page.click(button)
            page.browser.wait("return document.getElementById('dialog').open")
            found = [one for one in page.browser.run(LAYOUT.replace("'body *:not", "'dialog *:not")) if "the page" not in one]
            check(not found, width, button, *found)
            page.click("#dialog-close")
    page.browser.devtools("Emulation.setDeviceMetricsOverride", width=1440, height=900, deviceScaleFactor=1, mobile=False)


def check_contrast(page, path):
    for scheme in ("light", "dark"):
        page.browser.devtools("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
        page.open(path)
        for tab in ("query", "edit", "walk", "subdivide", "check", "measure"):
            page.click(f"[data-tab={tab}]")
            if tab == "query":
                for _ in range(4):
                    page.click("#next")
            if tab == "edit":
                page.edit("remove_vertex v0")
            if tab == "walk":
                page.click("#solution")
            check(not page.browser.run(CONTRAST), scheme, tab, *page.browser.run(CONTRAST))
        page.click("#mesh-button")
        check(not page.browser.run(CONTRAST), scheme, "meshes", *page.browser.run(CONTRAST))
    page.browser.devtools("Emulation.setEmulatedMedia", features=[])


def check_quiet(browser):
    """No errors in the console, and no request but for the page itself."""
    errors = [entry["message"] for entry in browser.log("browser") if entry["level"] == "SEVERE"]
    check(not errors, errors)
    for entry in browser.log("performance"):
        message = json.loads(entry["message"])["message"]
        if message["method"] == "Network.requestWillBeSent":
            url = message["params"]["request"]["url"]
            check(url.startswith(("file:", "data:", "blob:", "about:")), "a request to", url)


def main():
    sixfold, respond = sys.argv[1:3]
    folder = pathlib.Path(sys.argv[3]) if len(sys.argv) > 3 else None
    with tempfile.TemporaryDirectory() as scratch:
        path = pathlib.Path(scratch) / "explorer.html"
        subprocess.run([sixfold, "explore", "--no-open", "-o", path], check=True, stdout=subprocess.DEVNULL)
        check(path.stat().st_size <= MAX_BYTES, path.stat().st_size, "bytes")
        browser = Browser()
        try:
            page = Page(browser, sixfold, respond)
            browser.devtools("Emulation.setDeviceMetricsOverride", width=1440, height=900, deviceScaleFactor=1, mobile=False)
            for part in (check_queries, check_shown, check_cards, check_turns, check_arrows, check_elements, check_primary, check_pointer, check_edits, check_edit_steps, check_refusals, check_remedies, check_files, check_failure, check_links, check_predictions,
                         check_walks, check_measurements, check_memory, check_weld, check_levels, check_regularity, check_layout, check_contrast, check_lessons):
                part(page, path)
                check_quiet(browser)
            check_sizes(page, path, folder)
            check_quiet(browser)
        finally:
            browser.close()
    print("the explorer does what it should")


if __name__ == "__main__":
    main()
