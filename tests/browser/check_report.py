"""Opens a report in headless Chromium and compares its figures with its data.

    python3 tests/browser/check_report.py DIR [FOLDER FOR SCREENSHOTS]

DIR is the output folder of `sixfold study --report DIR`. The script uses WebDriver over HTTP and
needs only chromium and chromedriver (Debian: chromium, chromium-driver).

The script prints how long the page takes to open, but does not check this time, because it depends
on the machine. It checks the size of the page and the number of its elements instead.
"""

import json
import math
import pathlib
import re
import sys
import time
import xml.etree.ElementTree

from browser import Browser


# Several times the elements of the page of a study of two meshes.
MAX_ELEMENTS = 100_000


# Every mark of a figure: its title and the bounding box of its shape.
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
    mesh: figure.dataset.mesh || null,
    marks: (figure => { MARKS })(figure),
    lines: figure.querySelectorAll('svg path[fill="none"], svg polyline').length,
    text: [...figure.querySelectorAll('svg text')].map(text => text.textContent),
    rows: figure.parentElement.querySelectorAll('tbody tr').length,
    width: figure.querySelector('svg').getBoundingClientRect().width,
}));
""".replace("MARKS", MARKS.replace("arguments[0]", "figure"))


def close_to(a, b, what, tolerance):
    assert abs(a - b) <= tolerance, f"{what}: {a} in the page, {b} in the data"


def rounded(number):
    """Rounds to three significant digits, as the page does."""
    if number == 0 or not math.isfinite(number):
        return number
    places = 2 - math.floor(math.log10(abs(number)))
    # The small term is that of the page: 15.9 / 12.0 is 1.325 on paper, but a little less in binary.
    return math.floor(number * 10.0**places + 0.5 + 1e-9) / 10.0**places


def shown(number):
    """Formats a number as the page does."""
    number = rounded(number)
    if number == 0:
        return "0"
    places = max(0, 2 - math.floor(math.log10(abs(number))))
    return f"{number:,.{places}f}"


def times(ratio):
    return f"{shown(ratio)} ×"


def duration(ns):
    """Formats a time as the page does."""
    for unit, size in [("ns", 1), ("µs", 1e3), ("ms", 1e6), ("s", 1e9)]:
        if rounded(ns) < 1e3 * size or unit == "s":
            return f"{shown(ns / size)} {unit}"


def shown_ratios(rows, time):
    """Returns the ratio of each row to the best row, as the quotient of the shown times; the mean ratio without times."""
    best = next((row[time] for row in rows if row["ratio_to_best"] == 1), None)
    return [rounded(row[time]) / rounded(best) if best and row[time] else row["ratio_to_best"] for row in rows]


def check_places(marks, values, what, axis):
    """Checks that marks are at the positions of their values on a logarithmic axis."""
    size = "width" if axis == "x" else "height"
    places = [mark[axis] + mark[size] / 2 for mark in marks]
    logs = [math.log10(value) for value in values]
    low, high = logs.index(min(logs)), logs.index(max(logs))
    if logs[high] - logs[low] < 1e-3:
        return
    scale = (places[high] - places[low]) / (logs[high] - logs[low])
    assert (scale > 0) == (axis == "x"), f"{what}: the axis has the wrong direction"
    for place, log in zip(places, logs):
        close_to(place, places[low] + (log - logs[low]) * scale, what, 0.6)


def operation_of(figure, kind):
    return re.match(rf"{kind}-(?:\d+-)?(.+)$", figure["id"]).group(1).replace("-", "_")


def check_ranking(figure, rows, ratios, operation):
    assert len(figure["marks"]) == len(rows) == figure["rows"], figure["id"]
    by_name = {row["backend"]: (row, ratio) for row, ratio in zip(rows, ratios)}
    longest = max(0, *map(math.log10, ratios))
    # The axis has a least length, and a bar is at least 2 % of the axis long.
    shortest = 0.02 * max(longest, 0.1)
    widest = max(mark["width"] for mark in figure["marks"])
    for mark in figure["marks"]:
        name, figures = mark["title"].split(": ", 1)
        row, ratio = by_name.pop(name)
        low, high = [row.get(f"ratio_ci_{end}", row.get(f"ci_{end}")) for end in ("low", "high")]
        interval = "" if low is None else f" ({shown(low)} to {shown(high)})"
        bound = "≥ " if row.get("estimated") else ""
        expected = f"{bound}{shown(ratio)}{interval}"
        assert figures.split(" ×")[0] == expected, f"{operation} on {name}: {figures}, but {expected} in the data"
        share = max(math.log10(ratio), shortest) / max(longest, shortest)
        close_to(mark["width"], share * widest, f"the bar of {operation} on {name}", 0.6)


def check_heat_map(figure, ratios, columns, bounds):
    rows = ratios
    measured = {operation for (operation, _), ratio in rows.items() if ratio}
    assert len(figure["marks"]) == len(measured) * len(columns), figure["id"]
    assert figure["rows"] == len(measured), figure["id"]
    for mark in figure["marks"]:
        operation, rest = mark["title"].split(" on ", 1)
        column, found = rest.split(": ", 1)
        ratio = rows.get((operation, column))
        bound = "≥ " if (operation, column) in bounds else ""
        expected = bound + times(ratio) if ratio else "not measured"
        assert found == expected, f"{mark['title']}: {ratio} in the data"


def check_growth(figure, growth):
    operation = operation_of(figure, "growth")
    points = {}
    for size in growth["sizes"]:
        for row in size["results"]:
            ns = row["median_ns"]  # lower bounds are not drawn
            if row["operation"] == operation and ns:
                points[row["backend"], f"{size['faces']:,}"] = (size["faces"], ns)
    assert len(figure["marks"]) == len(points), figure["id"]
    here = []
    for mark in figure["marks"]:
        name, faces, found = re.match(r"(.+), ([\d,]+) faces: ([^,]+(?:,\d+[^,]*)?)", mark["title"]).groups()
        here.append(points[name, faces])
        assert found == duration(here[-1][1]), f"{mark['title']}: {here[-1][1]} ns in the data"
    check_places(figure["marks"], [faces for faces, _ in here], figure["id"], "x")
    check_places(figure["marks"], [ns for _, ns in here], figure["id"], "y")
    for fit in growth["fits"]:
        if fit["operation"] == operation and fit["all"]:
            assert f"{fit['backend']}: {fit['all']['exponent']:.2f}" in figure["text"], fit
    assert figure["rows"] >= len(growth["sizes"]), figure["id"]


def check_orders(figure, orders):
    operation = operation_of(figure, "orders")
    rows = {
        (row["backend"], row["case"]): row for row in orders["results"] if row["operation"] == operation
    }
    backends = {backend for backend, _ in rows}
    assert len(figure["marks"]) == len(backends) * len(orders["orders"]), figure["id"]
    assert figure["rows"] == len(backends), figure["id"]
    lengths = []
    most = math.log10(max([1.5] + [row["ratio_to_best"] or 1 for row in rows.values()]))
    for mark in figure["marks"]:
        name, rest = mark["title"].split(", ", 1)
        order, found = rest.split(": ", 1)
        row = rows.get((name, order), {})
        if row.get("ratio_to_best") is None:
            assert found == "not measured", mark["title"]
        else:
            best = min(other["ns_per_element"] for (backend, _), other in rows.items() if backend == name)
            ratio = rounded(row["ns_per_element"]) / rounded(best)
            assert found.split(" ×")[0] == shown(ratio), f"{mark['title']}: {ratio} in the data"
            lengths.append((mark["height"], max(math.log10(ratio), 0.02 * most)))
    tallest, longest = max(lengths)
    for height, length in lengths:
        close_to(height, tallest * length / longest, figure["id"], 0.6)


def check_roofline(figure, why):
    rows = {
        (row["backend"], row["relation"]): row
        for row in why["rows"]
        if row["timed"] and row["moved_bytes"] > 0
    }
    assert len(figure["marks"]) == len(rows) == figure["rows"], figure["id"]
    here = []
    for mark in figure["marks"]:
        name, relation, rest = re.match(r"(.+), (\w+): (.+)$", mark["title"]).groups()
        row = rows.pop((name, relation))
        close_to(float(rest.split()[0]), row["moved_bytes"], mark["title"], 0.051)
        assert rest.endswith(row["timed"]["bound"]), (mark["title"], row)
        here.append(row)
    check_places(figure["marks"], [row["moved_bytes"] for row in here], figure["id"], "x")
    check_places(figure["marks"], [row["timed"]["ns_per_element"] for row in here], figure["id"], "y")


def check_memory(figure, study):
    columns = {c["name"]: c for c in study["backends"] if c["tables"]}
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


def check_break_even(figure, columns):
    assert figure["rows"] >= 2 and figure["lines"] >= figure["rows"], figure
    assert figure["rows"] <= len(columns), figure


def of_kind(results, kind):
    """Returns the findings of one command. A study has its mesh as `mesh`."""
    found = [finding for finding in results["findings"] if finding["kind"] == kind]
    return [{**one, "mesh": results["meshes"][one["meshes"][0]] if one["meshes"] else None} for one in found]


def check(figure, results):
    """Compares one figure with the data."""
    studies, kind = of_kind(results, "study"), figure["id"]
    lab = re.match(r"(orders|growth|roofline|pick)(?:-(\d+))?(?:-|$)", kind)
    if lab:
        name = {"roofline": "why"}.get(lab.group(1), lab.group(1))
        lab = of_kind(results, name)[int(lab.group(2) or 1) - 1]
    if kind.startswith("orders"):
        return check_orders(figure, lab)
    if kind.startswith("growth"):
        return check_growth(figure, lab)
    if kind.startswith("roofline"):
        return check_roofline(figure, lab)
    if kind.startswith("pick") and kind.endswith("break-even"):
        return check_break_even(figure, [row["backend"] for row in lab["ranking"]])
    if kind.startswith("pick"):
        rows = lab["ranking"]
        return check_ranking(figure, rows, shown_ratios(rows, "ns_per_operation"), lab["workload"]["name"])
    pooled = len(results["planned"]) > 1 and not figure["mesh"]
    if pooled:
        rows = results["pool"]["groups"][0]["pooled"]
        columns = list(dict.fromkeys(row["backend"] for row in rows))
    else:
        [study] = [s for s in studies if s["mesh"]["name"] == figure["mesh"]] if figure["mesh"] else studies
        rows = study["results"]
        columns = [column["name"] for column in study["backends"] if column["holds"]]
    rows = [row for row in rows if row["ratio_to_best"]]
    ratios = {}
    for operation in {row["operation"] for row in rows}:
        of_it = [row for row in rows if row["operation"] == operation]
        found = [row["ratio_to_best"] for row in of_it] if pooled else shown_ratios(of_it, "ns_per_element")
        ratios |= {(operation, row["backend"]): ratio for row, ratio in zip(of_it, found)}
    if kind.startswith("ranking-"):
        operation = operation_of(figure, "ranking")
        rows = [row for row in rows if row["operation"] == operation]
        return check_ranking(figure, rows, [ratios[operation, row["backend"]] for row in rows], operation)
    if kind.endswith("heat-map"):
        bounds = {(row["operation"], row["backend"]) for row in rows if row.get("estimated")}
        return check_heat_map(figure, ratios, columns, bounds)
    if kind.endswith("memory"):
        return check_memory(figure, study)
    if kind.endswith("break-even"):
        return check_break_even(figure, columns)
    raise AssertionError(f"unknown figure {kind}")


def main():
    folder = pathlib.Path(sys.argv[1])
    shots = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else None
    results = json.loads((folder / "results.json").read_text())
    browser = Browser()
    try:
        start = time.monotonic()
        browser.open(folder / "report.html")
        seconds = time.monotonic() - start
        size = (folder / "report.html").stat().st_size
        assert size < 10e6, f"the page has {size} bytes, expected less than 10 MB"
        elements = browser.run("return document.querySelectorAll('*').length")
        assert elements < MAX_ELEMENTS, f"the page has {elements} elements, which take long to open"

        figures = browser.run(FIGURES)
        ids = [figure["id"] for figure in figures]
        assert len(set(ids)) == len(ids), "two figures have the same name"
        for figure in figures:
            check(figure, results)
            # The file of the figure must be valid XML, which is stricter than HTML.
            xml.etree.ElementTree.parse(folder / "figures" / f"{figure['id']}.svg")
        kinds = {re.sub(r"-.*", "", figure["id"]) for figure in figures}
        expected = {name for name in ("orders", "growth") if of_kind(results, name)}
        expected |= {"roofline"} if of_kind(results, "why") else set()
        expected |= {"ranking", "heat"} if of_kind(results, "study") else set()
        assert expected <= kinds, f"{expected - kinds} is missing"

        # On a phone, the page must not be wider than the screen; wide figures scroll in their boxes.
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
                assert url.startswith(("file:", "data:")), f"the page requests {url}"
    finally:
        browser.close()
    print(
        f"{len(figures)} figures compared with the data; opened in {seconds:.2f} s, {size:,} bytes, "
        f"{elements:,} elements"
    )


main()
