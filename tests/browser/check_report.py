"""Opens a report in headless Chromium and compares its figures with its data.

    python3 tests/browser/check_report.py DIR [FOLDER FOR SCREENSHOTS]

DIR is the output folder of `sixfold study --report DIR` or `sixfold compare --report DIR`. The script uses WebDriver over HTTP and
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


# Every mark of a figure: its title, the title of its panel, and the bounding box of its shape.
FIGURES = """
for (const details of document.querySelectorAll('details')) details.open = true;
const marks = (svg) => [...svg.querySelectorAll('g')].flatMap((group) => {
    const title = group.querySelector(':scope > title');
    const shape = group.querySelector(':scope > rect, :scope > path, :scope > circle');
    if (!title || !shape) return [];
    const {x, y, width, height} = shape.getBBox();
    return [{title: title.textContent, panel: svg.querySelector('text').textContent, x, y, width, height}];
});
return [...document.querySelectorAll('figure[data-figure]')].map((figure) => ({
    id: figure.dataset.figure,
    mesh: figure.dataset.mesh || null,
    marks: [...figure.querySelectorAll('svg')].flatMap(marks),
    dots: [...figure.querySelectorAll('svg path[d*="h2.4v2.4"]')].reduce((sum, path) =>
        sum + path.getAttribute('d').split('M').length - 1, 0),
    lines: figure.querySelectorAll('svg path[fill="none"], svg polyline').length,
    text: [...figure.querySelectorAll('svg text')].map((text) => text.textContent),
    label: figure.querySelector('svg').getAttribute('aria-label'),
    source: figure.parentElement.querySelector('details > p.faint')?.textContent,
    rows: figure.closest('section').querySelectorAll('tbody tr').length,
    link: figure.closest('section').querySelector('a.permalink').getAttribute('href'),
    clipped: [...figure.querySelectorAll('svg')].flatMap((svg) => [...svg.querySelectorAll('text')].filter((text) => {
        const box = text.getBBox(), view = svg.viewBox.baseVal;
        return box.x < -1 || box.x + box.width > view.width + 1;
    }).map((text) => text.textContent)),
}));
"""


def close_to(a, b, what, tolerance):
    assert abs(a - b) <= tolerance, f"{what}: {a} in the page, {b} in the data"


def rounded(number):
    """Rounds to three significant digits, as the page does."""
    if number == 0 or not math.isfinite(number):
        return number
    places = 2 - math.floor(math.log10(abs(number)))
    # The small term is that of the page: 15.9 / 12.0 is 1.325 on paper, but a little less in binary.
    return math.floor(number * 10.0**places + 0.5 + 1e-9) / 10.0**places


def rounded_down(number):
    places = 2 - math.floor(math.log10(abs(number)))
    return math.floor(number * 10.0**places + 1e-9) / 10.0**places


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


def check_places(marks, values, what, axis, tolerance=0.6):
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
        close_to(place, places[low] + (log - logs[low]) * scale, what, tolerance)


def mark_text(row, ratio):
    """Returns what a mark of a ranking says."""
    if is_bound(row):
        return f"≥ {shown(rounded_down(ratio))}"
    ends = [row.get(f"ratio_ci_{end}", row.get(f"ci_{end}")) for end in ("low", "high")]
    has_interval = ends[0] is not None and row.get("samples", 99) >= 3 and shown(ends[0]) != shown(ends[1])
    # An interval whose ends differ by more than a factor of 1,000 is not shown.
    if "ratio_ci_low" in row and (ratio == 1 or ends[0] is not None and ends[1] > 1000 * ends[0]):
        has_interval = False
    return f"{shown(ratio)} ({shown(ends[0])} to {shown(ends[1])})" if has_interval else shown(ratio)


def check_means(figure, rows, studies):
    """Compares the means over meshes with rows of the pool: the places of the lines, and the number of dots."""
    # Their numbers are those of the table of operations.
    assert len(figure["marks"]) == len(rows) and figure["rows"] == 0, figure["id"]
    by_name = {(row["operation"], row["backend"]): row for row in rows}
    places, ratios = [], []
    for mark in figure["marks"]:
        name, figures = mark["title"].split(": ", 1)
        row = by_name[mark["panel"], name]
        expected = mark_text(row, row["ratio_to_best"])
        found = figures.split(" × the")[0]
        # Over few meshes, the least and the largest ratio of a mesh stand in the place of an interval.
        if 1 < row["meshes"] < 6:
            found = found.split(" (")[0]
        assert found == expected, (mark, expected)
        if not is_bound(row):
            places.append({**mark, "y": 0, "height": 0})
            ratios.append(min(1000, max(1, row["ratio_to_best"])))
    check_places(places, ratios, figure["id"], "x")
    timed = {(row["operation"], row["backend"]) for row in rows if not is_bound(row)}
    dots = [row for study in studies for row in study["results"]
            if row["ratio_to_best"] is not None and (row["operation"], row["backend"]) in timed]
    assert figure["dots"] >= len(dots), (figure["dots"], len(dots))


def check_distribution(figure, results, studies):
    """Compares the dots of the meshes with the data: all places, and the ratios of builds."""
    pool = results["pool"]
    overall = pool["groups"][0]["overall"]
    titles = {"Building": "build", "Queries": "query", "Edits": "edit", "Subdivision": "subdivide"}
    for title, purpose in titles.items():
        marks = [mark for mark in figure["marks"] if mark["panel"] == title]
        rows = [row for row in overall if row["purpose"] == purpose]
        assert bool(marks) == (len(rows) > 1), (title, rows)
        if not marks:
            continue
        leader = rows[0]
        for row in rows:
            ratio = row["ratio_to_best"] / leader["ratio_to_best"]
            sign, ratio = ("≥ ", rounded_down(ratio)) if row["bound"] else ("", ratio)
            assert any(text.startswith(f"{sign}{times(ratio)}") for text in figure["text"]), (row, ratio)
        found = {}
        for mark in marks:
            name, ratio = mark["title"].rsplit(": ", 1)
            found[name] = (float(ratio.removeprefix("≥ ").removesuffix(" ×").replace(",", "")), mark)
        inside = [(ratio, mark) for ratio, mark in found.values() if 0.001 < ratio < 1000]
        # The marks are rounded to three digits.
        check_places([mark for _, mark in inside], [ratio for ratio, _ in inside], title, "x", 1.5)
        if purpose == "build":
            names = {row["backend"] for row in rows}
            for study in studies:
                each = {row["backend"]: rounded(row["ns_per_element"]) for row in study["results"]
                        if row["operation"] == "build" and row["ns_per_element"] and row["backend"] in names}
                short = study["mesh"]["name"].rsplit("/", 1)[-1]
                for backend, ns in each.items():
                    name = f"{short}, {backend}"
                    if leader["backend"] in each and name in found:
                        expected = rounded(ns / each[leader["backend"]])
                        close_to(found[name][0], expected, name, 0.006 * expected)


def check_ranking(figure, rows, ratios):
    """Compares bars with rows. `rows` are (panel, row); `ratios` are their ratios, None if there is no bar."""
    shown_rows = [(panel, row, ratio) for (panel, row), ratio in zip(rows, ratios) if ratio]
    # Those of all operations have their numbers in the table of operations.
    expected_rows = 0 if figure["id"] == "rankings" else len(shown_rows)
    assert len(figure["marks"]) == len(shown_rows) and figure["rows"] == expected_rows, figure["id"]
    by_name = {(panel, row["backend"]): (row, ratio) for panel, row, ratio in shown_rows}
    # One scale for all panels: at least to 2; bars beyond 10 are cut.
    longest = min(10, max([2.0] + [ratio for _, _, ratio in shown_rows]))
    whole = max(mark["width"] / max(math.log(min(by_name[mark["panel"], mark["title"].split(": ")[0]][1], longest), longest), 1e-9)
                for mark in figure["marks"] if by_name[mark["panel"], mark["title"].split(": ")[0]][1] > 1.5)
    for mark in figure["marks"]:
        name, figures = mark["title"].split(": ", 1)
        row, ratio = by_name[mark["panel"], name]
        expected = mark_text(row, ratio)
        found = figures.split(" × the")[0]
        assert found == expected, f"{mark['panel']} on {name}: {found}, but {expected} in the data"
        width = max(2.0, math.log(max(1.0, min(ratio, longest)), longest) * whole)
        close_to(mark["width"], width, f"the bar of {mark['panel']} on {name}", 0.6)


def is_bound(row):
    return bool(row.get("estimated")) or (row.get("estimated_ns") is not None and row.get("median_ns") is None)


def check_heat_map(figure, ratios, columns, bounds, sampled):
    measured = {operation for (operation, _), ratio in ratios.items() if ratio}
    # On a slow machine, a time budget may leave an operation without a time.
    drawn = {mark["title"].split(" on ", 1)[0] for mark in figure["marks"]}
    assert measured <= drawn <= {operation for operation, _ in ratios}, drawn
    assert len(figure["marks"]) == len(drawn) * len(columns), figure["id"]
    assert figure["rows"] == len(drawn), figure["id"]
    for mark in figure["marks"]:
        operation, rest = mark["title"].split(" on ", 1)
        column, found = rest.split(": ", 1)
        ratio = ratios.get((operation, column))
        # Without a measured time of the operation, a bound is not compared.
        if (operation, column) in bounds and ratio:
            assert found == f"≥ {times(rounded_down(ratio))}", f"{mark['title']}: {ratio} in the data"
        elif ratio:
            sign = "~ " if (operation, column) in sampled else ""
            assert found == sign + times(ratio), f"{mark['title']}: {ratio} in the data"
            assert sign + times(ratio) in figure["text"], f"the cell of {mark['title']} has no number"
        else:
            assert found in ("not measured", "not possible"), mark["title"]


def check_growth(figure, growth):
    operations = {fit["operation"] for fit in growth["fits"]}
    points = {}
    for size in growth["sizes"]:
        for row in size["results"]:
            ns = row["median_ns"]  # lower bounds are not drawn
            if row["operation"] in operations and ns:
                sign = "~" if row["sampled"] else ""
                points[row["operation"], row["backend"], f"{size['faces']:,}"] = (size["faces"], ns, sign)
    assert len(figure["marks"]) == len(points), figure["id"]
    here = []
    for mark in figure["marks"]:
        name, faces, found = re.match(r"(.+), ([\d,]+) faces: ([^,]+(?:,\d+[^,]*)?)", mark["title"]).groups()
        here.append(points[mark["panel"], name, faces])
        _, ns, sign = here[-1]
        assert found == sign + duration(ns), f"{mark['title']}: {ns} ns in the data"
    check_places(figure["marks"], [faces for faces, *_ in here], figure["id"], "x")
    check_places(figure["marks"], [ns for _, ns, _ in here], figure["id"], "y")
    for fit in growth["fits"]:
        if fit["all"]:
            assert f"{fit['backend']}: {fit['all']['exponent']:.2f}" in figure["text"], fit
    assert figure["rows"] >= len(growth["sizes"]), figure["id"]


def check_orders(figure, orders):
    rows = {(row["operation"], row["backend"], row["case"]): row for row in orders["results"]}
    timed = {key: row for key, row in rows.items() if row["ratio_to_best"] is not None}
    assert len(figure["marks"]) == len(timed), figure["id"]
    assert figure["rows"] == len({(operation, backend) for operation, backend, _ in rows}), figure["id"]
    ratios = []
    for mark in figure["marks"]:
        name, rest = mark["title"].split(", ", 1)
        order, found = rest.split(": ", 1)
        row = timed.pop((mark["panel"], name, order))
        best = min(
            other["ns_per_element"]
            for (operation, backend, _), other in rows.items()
            if (operation, backend) == (mark["panel"], name) and other["ns_per_element"]
        )
        ratio = rounded(row["ns_per_element"]) / rounded(best)
        assert found.split(" ×")[0] == shown(ratio), f"{mark['title']}: {ratio} in the data"
        ratios.append(max(1.0, ratio))
    check_places(figure["marks"], ratios, figure["id"], "x")


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
        value, unit = rest.split(", ")[0].split(" ")
        moved = float(value.replace(",", "")) * {"byte": 1, "bytes": 1, "kB": 1e3, "MB": 1e6, "GB": 1e9}[unit]
        close_to(moved, row["moved_bytes"], mark["title"], max(0.51, 0.006 * row["moved_bytes"]))
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
        heights[name, table] = mark["width"]
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
    for mark in figure["marks"]:
        name, count = re.match(r"(.+) pays after ([\d,]+) ", mark["title"]).groups()
        # The number stands at the point, or with the name at the right.
        assert name in columns and any(count in text.split() for text in figure["text"]), mark


def of_kind(results, kind):
    """Returns the findings of one command. A study has its mesh as `mesh`."""
    found = [finding for finding in results["findings"] if finding["kind"] == kind]
    return [{**one, "mesh": results["meshes"][one["meshes"][0]] if one["meshes"] else None} for one in found]


def ratios_of(rows, pooled):
    """Returns the ratio of each pair of an operation and a backend, as the page shows it; None if there is none."""
    ratios = {}
    for operation in {row["operation"] for row in rows}:
        of_it = [row for row in rows if row["operation"] == operation]
        if pooled:
            ratios |= {(operation, row["backend"]): row["ratio_to_best"] for row in of_it}
            continue
        best = next((row["ns_per_element"] for row in of_it if row["ratio_to_best"] == 1), None)
        for row in of_it:
            key = (operation, row["backend"])
            if is_bound(row) and best and row["elements"]:
                ratios[key] = row["estimated_ns"] / row["elements"] / best
            else:
                known = row["ratio_to_best"] and best
                ratios[key] = rounded(row["ns_per_element"]) / rounded(best) if known else None
    return ratios


TABLE = """
const table = document.querySelector('#operations table');
return {
    columns: [...table.tHead.rows[0].cells].map((cell) => cell.textContent),
    sorts: [...table.tHead.rows[0].cells].map((cell) => cell.getAttribute('aria-sort')),
    rows: [...table.tBodies[0].rows].filter((row) => !row.hidden).map((row) => ({
        name: row.dataset.operation,
        cells: [...row.cells].slice(1).map((cell, column) => ({
            backend: table.tHead.rows[0].cells[column + 1].textContent,
            source: ['bound', 'none'].find((name) => cell.classList.contains(name)) ?? (cell.dataset.sign ? 'sampled' : 'measured'),
            ns: cell.dataset.ns && Number(cell.dataset.ns.split(' ')[0]),
            text: [...cell.childNodes].filter((node) => node.nodeName !== 'SMALL').map((node) => node.textContent).join(''),
            small: cell.querySelector('small')?.textContent ?? '',
            at: Number(cell.style.getPropertyValue('--at') || 0),
            from: Number(cell.style.getPropertyValue('--from') || 0),
            to: Number(cell.style.getPropertyValue('--to') || 0),
        })),
    })),
};
"""

CHOOSE = """
const control = document.querySelector(`#operations [name=${arguments[0]}]`);
control.value = arguments[1];
control.dispatchEvent(new Event('input', {bubbles: true}));
control.dispatchEvent(new Event('change', {bubbles: true}));
"""

CLICK = "document.querySelectorAll('#operations thead button')[arguments[0]].click()"


def quotient(studies, operation, backend, other, pooled):
    """Returns the ratio of the times of two backends as the page shows it: of one mesh, or the mean over meshes."""
    # The geometric mean, in which each power of ten of the number of faces has the same weight.
    logs = {}
    for study in studies:
        of_it = {row["backend"]: row for row in study["results"]
                 if row["operation"] == operation and row["median_ns"]
                 and row["agreement"] not in ("mismatch", "other_edits")}
        if backend in of_it and other in of_it:
            own, base = of_it[backend], of_it[other]
            if not pooled:
                return rounded(own["ns_per_element"]) / rounded(base["ns_per_element"])
            decade = len(str(study["mesh"]["faces"]))
            shown = rounded(own["ns_per_element"]) / rounded(base["ns_per_element"])
            logs.setdefault(decade, []).append(math.log(shown))
    means = [sum(values) / len(values) for values in logs.values()]
    return math.exp(sum(means) / len(means)) if means else None


def check_line(cell, scale):
    """Compares the line of an interval with the numbers of the cell. `scale` is the place of a ratio."""
    if not cell["small"]:
        assert cell["from"] == cell["to"] == 0, cell
        return
    for end, text in zip(("from", "to"), cell["small"].split(" to ")):
        place = min(1, max(0, scale(float(text.replace(",", "")))))
        close_to(cell[end], place, f"the line of {cell}", 4e-3)


OPEN = """
document.querySelectorAll('#operations tbody th button')[0].click();
const opened = document.querySelector('#operations .samples');
return opened && {
    name: opened.previousElementSibling.dataset.operation,
    names: [...opened.querySelectorAll('text[text-anchor=end]')].map((text) => text.textContent).slice(1),
    drawn: [...opened.querySelectorAll('path title')].map((title) => title.textContent.split(',')[0]),
    ticks: [...opened.querySelectorAll('path')].reduce((sum, path) => sum + path.getAttribute('d').split('M').length - 1, 0),
};
"""


def check_samples(browser, studies, pooled):
    """Checks that the first operation opens to all its samples, and closes."""
    if pooled:
        assert not browser.run("return document.querySelectorAll('#operations tbody th button').length")
        return
    # On a slow machine, every time is that of a run before the rounds.
    if not any(s["wall_ns"] for s in studies[0]["samples"]):
        return
    opened = browser.run(OPEN)
    timed = {row["backend"] for row in studies[0]["results"] if row["operation"] == opened["name"] and row["median_ns"]}
    names = [name for name in opened["names"] if not name.startswith("beyond: ")]
    drawn = set(opened["drawn"])
    assert set(names) == timed and len(names) == len(timed), opened
    # Those beyond the axis have a text in the place of ticks.
    assert len(opened["names"]) - len(names) == len(timed - drawn) and drawn, opened
    ticks = 0
    for row in studies[0]["results"]:
        if row["operation"] == opened["name"] and row["backend"] in drawn:
            own = [s for s in studies[0]["samples"]
                   if s["operation"] == opened["name"] and s["backend"] == row["backend"] and not s["control"]]
            launches = own[0].get("launches", []) if own else []
            # A launch without samples has its time.
            alone = [ns for launch, ns in enumerate(row.get("launch_ns", [])) if ns and launch not in launches]
            ticks += sum(len(s["wall_ns"]) for s in own) + len(alone)
    assert opened["ticks"] == ticks, (opened, ticks)
    assert browser.run(OPEN) is None, "the samples do not close"


def check_operations(browser, rows, ratios, studies, pooled):
    """Checks the table of operations: its figures, and what its controls do."""
    names = list(dict.fromkeys(row["operation"] for row in rows))
    before = browser.run(TABLE)
    assert sorted(row["name"] for row in before["rows"]) == sorted(names), before["rows"]
    for row in before["rows"]:
        for cell in row["cells"]:
            ratio = ratios.get((row["name"], cell["backend"]))
            if not ratio:
                assert cell["source"] in ("none", "bound", "measured", "sampled"), cell
                assert cell["text"] in ("not possible", "not run", "not compared"), cell
                continue
            sign = {"bound": "≥ ", "sampled": "~ "}.get(cell["source"], "")
            number = shown(rounded_down(ratio) if cell["source"] == "bound" else ratio)
            assert cell["text"].removesuffix(" undecided").removesuffix(" equal") == f"{sign}{number} ×", (row["name"], cell, ratio)
            close_to(cell["at"], min(1, max(0, math.log10(ratio))), f"the dot of {row['name']} on {cell['backend']}", 2e-3)
            check_line(cell, lambda end: math.log10(end))
    # Times.
    browser.run(CHOOSE, "figures", "times")
    for row in browser.run(TABLE)["rows"]:
        for cell in row["cells"]:
            if cell["ns"]:
                text = cell["text"].removeprefix("≥ ").removeprefix("~ ")
                if cell["source"] != "bound":
                    # The attribute has five digits, of which the last can round the third.
                    near = [duration(cell["ns"] * factor) for factor in (0.9999, 1, 1.0001)]
                    assert text in near, (row["name"], cell)
    browser.run(CHOOSE, "figures", "ratios")
    # Another baseline.
    column = before["columns"][-1]
    browser.run(CHOOSE, "baseline", column)
    compared = 0
    for row in browser.run(TABLE)["rows"]:
        base = next(cell for cell in row["cells"] if cell["backend"] == column)
        for cell in row["cells"]:
            if not cell["ns"]:
                continue
            if not base["ns"] or base["source"] == "bound":
                assert cell["text"] == "–", (row["name"], cell)
            elif cell["source"] != "bound":
                expected = quotient(studies, row["name"], cell["backend"], column, pooled)
                sign = "~ " if cell["source"] == "sampled" else ""
                assert cell["text"] == sign + times(expected), (row["name"], cell, expected)
                if cell["small"]:
                    low, high = (float(end.replace(",", "")) for end in cell["small"].split(" to "))
                    assert low <= rounded(expected) <= high, (row["name"], cell)
                # Another baseline moves the dots and their lines: the scale goes from 1/10 to 10.
                scale = lambda ratio: (math.log10(ratio) + 1) / 2
                close_to(cell["at"], min(1, max(0, scale(expected))), f"the dot of {row['name']} on {cell['backend']}", 2e-3)
                check_line(cell, scale)
                compared += 1
    assert compared, "no ratio to another baseline"
    browser.run(CHOOSE, "baseline", "")
    assert browser.run(TABLE) == before, "the table is not as before"
    # Order: ascending, descending, and as before. Operations without a figure come last.
    for down in (False, True):
        browser.run(CLICK, 1)
        table = browser.run(TABLE)
        assert table["sorts"][1] == ("descending" if down else "ascending"), table["sorts"]
        first = [ratios.get((row["name"], row["cells"][0]["backend"])) for row in table["rows"]]
        known = [ratio for ratio in first if ratio]
        assert known == sorted(known, reverse=down), known
        assert all(ratio is None for ratio in first[len(known):]), first
    browser.run(CLICK, 1)
    assert [row["name"] for row in browser.run(TABLE)["rows"]] == [row["name"] for row in before["rows"]]
    check_samples(browser, studies, pooled)
    # Filters.
    browser.run(CHOOSE, "search", names[-1])
    found = [row["name"] for row in browser.run(TABLE)["rows"]]
    assert names[-1] in found and all(names[-1] in name for name in found), found
    browser.run(CHOOSE, "search", "no such operation")
    assert not browser.run(TABLE)["rows"]
    status = browser.run("return document.querySelector('#operations output').textContent")
    assert status == f"0 of {len(names)} operations", status
    browser.run(CHOOSE, "search", "")
    group = browser.run("return document.querySelector('#operations [name=group]').options[1].value")
    browser.run(CHOOSE, "group", group)
    groups = browser.run(
        "return [...document.querySelectorAll('#operations tbody tr')].filter(r => !r.hidden).map(r => r.dataset.group)"
    )
    assert groups and set(groups) == {group}, groups
    browser.run(CHOOSE, "group", "")


PAGE = """
const links = [...document.querySelectorAll('a[href^="#"]')].map((link) => link.getAttribute('href').slice(1));
return {
    missing: links.filter((id) => !document.getElementById(id)),
    contents: document.querySelectorAll('nav a').length,
    headings: [...document.querySelectorAll('h1, h2, h3')].map((heading) => Number(heading.tagName[1])),
    bare: [...document.querySelectorAll('th:not([scope])')].length,
    images: [...document.images].map((image) => [image.alt, image.naturalWidth]),
    unlabelled: [...document.querySelectorAll('figure[data-figure] svg')].filter(
        (svg) => !svg.getAttribute('aria-label') && svg.getAttribute('aria-hidden') !== 'true').length,
    answer: [...document.querySelectorAll('.answer p')].map((p) => p.textContent),
    summary: [...document.querySelectorAll('table.summary tbody tr')].map((row) =>
        [...row.cells].map((cell) => cell.textContent)),
};
"""


def check_page(page, results, studies):
    """Checks the first screen, the links, and what screen readers read."""
    assert not page["missing"], f"links to nothing: {page['missing']}"
    assert page["contents"] >= 3, page["contents"]
    levels = page["headings"]
    assert levels[0] == 1 and levels.count(1) == 1, levels
    assert all(b <= a + 1 for a, b in zip(levels, levels[1:])), f"a level of headings is left out: {levels}"
    assert not page["bare"] and not page["unlabelled"], page
    assert all(alt and width for alt, width in page["images"]), page["images"]
    # One sentence for each kind of work, how sure or which meshes, and the worst warning.
    assert 1 <= len(page["answer"]) <= 6, page["answer"]
    assert all(len(sentence) < 260 for sentence in page["answer"]), page["answer"]
    if len(results["planned"]) == 1 and len(studies) == 1:
        [study] = studies
        assert len(page["images"]) == bool(study["mesh"].get("picture")), page["images"]
        names = [column["name"] for column in study["backends"]]
        assert sorted(row[0] for row in page["summary"]) == sorted(names), page["summary"]
        # The fastest in queries is the first.
        queries = [row for row in study["overall"] if row["purpose"] == "query"] if "overall" in study else []
        assert not queries or page["summary"][0][0] == queries[0]["backend"], page["summary"]
        memory = [row for row in study["backends"] if row["bytes_per_vertex"]]
        for row in memory:
            text = next(cells for cells in page["summary"] if cells[0] == row["name"])
            each = row["bytes_per_vertex"] * study["mesh"]["vertices"] / study["mesh"]["faces"]
            expected = f"{shown(row['bytes_per_vertex'])} B{shown(each)} B per "
            assert any(expected in cell for cell in text), (text, expected)


def check_meshes(browser, studies):
    """Checks that each mesh has a row, and that the link of the row opens the section of the mesh."""
    links = browser.run("return [...document.querySelectorAll('#meshes tbody th a')].map((a) => a.getAttribute('href'))")
    assert len(links) == len(studies), links
    for link in (links[0], links[-1]):
        browser.run("for (const details of document.querySelectorAll('#meshes details')) details.open = false")
        browser.run("document.querySelector(`#meshes a[href='${arguments[0]}']`).click()", link)
        opened = browser.run(
            "return [...document.querySelectorAll('#meshes details[open] > div')].map((section) => '#' + section.id)"
        )
        assert opened == [link], (link, opened)


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
        rows, name = lab["ranking"], lab["workload"]["name"]
        return check_ranking(figure, [(name, row) for row in rows], shown_ratios(rows, "ns_per_operation"))
    pooled = len(results["planned"]) > 1 and not figure["mesh"]
    if pooled:
        rows = results["pool"]["groups"][0]["pooled"]
        columns = list(dict.fromkeys(row["backend"] for row in rows))
    else:
        # A section has the name of the mesh without its folders, if no other mesh has the same.
        here = [s for s in studies if s["mesh"]["name"] == figure["mesh"]]
        here = here or [s for s in studies if s["mesh"]["name"].rsplit("/", 1)[-1] == figure["mesh"]]
        [study] = here if figure["mesh"] else studies
        rows = study["results"]
        columns = [column["name"] for column in study["backends"] if column["holds"]]
    ratios = ratios_of(rows, pooled)
    if kind == "distribution":
        return check_distribution(figure, results, studies)
    if kind == "rankings" and pooled:
        names = results["pool"]["groups"][0]["meshes"]
        return check_means(figure, rows, [study for study in studies if study["mesh"]["name"] in names])
    if kind.startswith("rankings"):
        of = [ratios[row["operation"], row["backend"]] for row in rows]
        return check_ranking(figure, [(row["operation"], row) for row in rows], of)
    if kind.endswith("heat-map"):
        bounds = {(row["operation"], row["backend"]) for row in rows if is_bound(row)}
        sampled = {(row["operation"], row["backend"]) for row in rows if row.get("sampled")}
        return check_heat_map(figure, ratios, columns, bounds, sampled)
    if kind.endswith("memory"):
        return check_memory(figure, study)
    if kind.endswith("break-even"):
        return check_break_even(figure, columns)
    raise AssertionError(f"unknown figure {kind}")


def check_changes(figures, changes):
    """Compares the figures of a comparison with its rows."""
    divisor = changes["overall"] if changes["relative"] else 1
    rows = changes["rows"]
    changed = [row for row in rows if row["other_checksum"] or row["verdict"] in ("faster", "slower")]
    changed.sort(key=lambda row: (row["other_checksum"], -abs(math.log(row["ratio"] / divisor))))
    same_work = [row for row in rows if not row["other_checksum"]]
    backends = list(dict.fromkeys(row["backend"] for row in same_work))
    same_work.sort(key=lambda row: (backends.index(row["backend"]), row["ratio"]))
    expected = {"changes": changed[:40], "ratios": same_work}
    if all(row["other_checksum"] for row in changed):
        del expected["changes"]
    assert [figure["id"] for figure in figures] == list(expected), figures
    for figure in figures:
        rows = expected[figure["id"]]
        assert len(figure["marks"]) == len(rows), figure["id"]
        places = []
        for mark, row in zip(figure["marks"], rows):
            assert mark["title"].startswith(f"{row['operation']} on {row['backend']}"), (mark, row)
            assert f": {shown(row['ratio'] / divisor)} ×" in mark["title"], (mark, row)
            # The first shape of a change is its interval.
            is_interval = figure["id"] == "changes" and row["ci_low"] is not None
            ends = [row["ci_low"], row["ci_high"]] if is_interval else [row["ratio"]]
            middle = sum(math.log(end / divisor) for end in ends) / len(ends)
            places.append((middle, mark["x"] + mark["width"] / 2))
        # The axis is logarithmic, and faster is left.
        (low, left), (high, right) = min(places), max(places)
        for middle, x in places if high > low else []:
            close_to(x, left + (middle - low) / (high - low) * (right - left), figure["id"], 0.5)
        assert right > left or high == low, figure["id"]


def check_kinds(browser, figures, results):
    """Checks that the page of a study has all figures and tables."""
    kinds = {re.sub(r"-.*", "", figure["id"]) for figure in figures}
    expected = {name for name in ("orders", "growth") if of_kind(results, name)}
    expected |= {"roofline"} if of_kind(results, "why") else set()
    studies = of_kind(results, "study")
    expected |= {"rankings", "heat"} if studies else set()
    assert expected <= kinds, f"{expected - kinds} is missing"
    check_page(browser.run(PAGE), results, studies)
    if studies:
        pooled = len(results["planned"]) > 1
        rows = results["pool"]["groups"][0]["pooled"] if pooled else studies[0]["results"]
        names = results["pool"]["groups"][0]["meshes"] if pooled else [studies[0]["mesh"]["name"]]
        compared = [study for study in studies if study["mesh"]["name"] in names]
        check_operations(browser, rows, ratios_of(rows, pooled), compared, pooled)
        if pooled:
            check_meshes(browser, studies)


def main():
    folder = pathlib.Path(sys.argv[1])
    shots = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else None
    changes = folder / "changes.json"
    is_comparison = changes.exists()
    results = json.loads((changes if is_comparison else folder / "results.json").read_text())
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
        if is_comparison:
            check_changes(figures, results)
        for figure in figures:
            if not is_comparison:
                check(figure, results)
            assert figure["link"] == f"#{figure['id']}" and figure["label"], figure["id"]
            # The rankings repeat the table of operations, and say no more.
            if figure["id"] != "rankings":
                assert re.search(r"\d{4}-\d\d-\d\d.*seed \d+", figure["source"]), figure["source"]
            assert not figure["clipped"], f"{figure['id']}: texts beyond the picture: {figure['clipped']}"
            # The file of the figure must be valid XML, which is stricter than HTML.
            xml.etree.ElementTree.parse(folder / "figures" / f"{figure['id']}.svg")
        if not is_comparison:
            check_kinds(browser, figures, results)

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
