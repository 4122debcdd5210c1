"""Reads the numbers of pages and looks for two that contradict each other: a ratio that is not the quotient of the times
beside it, an interval without its ratio, a table and a figure that differ, a first place in one place only.

    python3 tests/browser/check_figures.py PAGE...

The pages are read as they are, without a browser.
"""

import pathlib
import re
import sys
from html.parser import HTMLParser

UNITS = {"ns": 1, "µs": 1e3, "ms": 1e6, "s": 1e9}
VOID = {"meta", "link", "img", "input", "br", "rect", "path", "circle"}
RATIO_WITH_ENDS = re.compile(r"([\d.,]+)\s×\s\(([\d.,]+) to ([\d.,]+)")
# Three digits are shown: two rounded numbers and their quotient differ by less than this.
ROUNDING = 0.0051


class Node(HTMLParser):
    """A tree of the elements of a page: each has a tag, attributes and children, which are elements or texts."""

    def __init__(self, text):
        super().__init__()
        self.root = ("", {}, [])
        self.open = [self.root]
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        element = (tag, dict(attributes), [])
        self.open[-1][2].append(element)
        if tag not in VOID:
            self.open.append(element)

    def handle_startendtag(self, tag, attributes):
        self.open[-1][2].append((tag, dict(attributes), []))

    def handle_endtag(self, tag):
        if tag not in VOID:
            while self.open.pop()[0] != tag:
                pass

    def handle_data(self, data):
        self.open[-1][2].append(data)


def text(element):
    if isinstance(element, str):
        return element
    if element[0] in ("script", "style"):
        return ""
    return "".join(text(child) for child in element[2])


def find(element, tag, **attributes):
    """All elements below with the tag whose attributes have the given words."""
    for child in element[2]:
        if isinstance(child, str):
            continue
        has = all(word in (child[1].get(name) or "").split(" ") for name, word in attributes.items())
        if child[0] == tag and has:
            yield child
        yield from find(child, tag, **attributes)


def number(shown):
    return float(shown.replace(",", ""))


def shown_time(shown):
    value, unit = shown.replace("~ ", "").replace("≥ ", "").split(" ")
    return number(value) * UNITS[unit]


def is_near(a, b, tolerance=ROUNDING):
    return abs(a - b) <= tolerance * max(abs(a), abs(b))


class Page:
    def __init__(self, path):
        self.path = path
        self.root = Node(path.read_text(encoding="utf-8")).root
        self.checked = 0
        self.faults = []

    def expect(self, holds, what):
        self.checked += 1
        if not holds:
            self.faults.append(f"{self.path}: {what}")

    def check(self):
        words = " ".join(text(self.root).split())
        for ratio, low, high in RATIO_WITH_ENDS.findall(words):
            holds = number(low) <= number(ratio) <= number(high)
            self.expect(holds, f"{ratio} × is not between {low} and {high}")
        tables = list(find(self.root, "table", **{"class": "operations"}))
        for table in tables[:1]:
            self.check_operations(table)
            self.check_building(table, words)
        return self

    def check_operations(self, table):
        [head] = find(table, "thead")
        backends = [text(cell) for cell in find(head, "th")][1:]
        [body] = find(table, "tbody")
        heat = self.heat_map()
        summary = self.summary()
        for row in find(body, "tr"):
            name = row[1]["data-operation"]
            cells = [Cell(cell) for cell in row[2][1:]]
            # Another one may have 1.00 in three digits: the fastest has no interval.
            best = [cell for cell in cells if cell.ratio == 1 and not cell.is_bound]
            best.sort(key=lambda cell: (cell.exact, cell.ends != ""))
            for place, (backend, cell) in enumerate(zip(backends, cells)):
                where = f"{name} on {backend}"
                self.check_cell(where, cell, best)
                if cell.ratio is not None:
                    self.expect(heat.get((name, backend)) == (cell.mark, cell.shown), f"{where}: {heat.get((name, backend))} in the heat map, {cell.mark, cell.shown} in the table")
                if name == "build" and backend in summary and cell.ratio is not None:
                    self.expect(summary[backend] == (cell.mark, cell.shown), f"{where}: {summary[backend]} on the first screen, {cell.mark, cell.shown} in the table")
                if best and cell.quotients:
                    first = backends[cells.index(best[0])]
                    ratio, *ends = cell.quotients[backends.index(first)].split(" ")
                    self.expect(ratio == cell.figure, f"{where}: {cell.figure} × the fastest, but {ratio} × {first}")
                    if cell is not best[0] and not cell.is_bound:
                        self.expect(" to ".join(ends) == cell.ends, f"{where}: {cell.ends}, but {ends} with {first}")
                for other, there in zip(backends, cell.quotients):
                    compared = cells[backends.index(other)]
                    if there and not cell.is_bound and not compared.is_bound:
                        quotient = shown_time(cell.time) / shown_time(compared.time)
                        shown = number(there.split(" ")[0])
                        self.expect(is_near(quotient, shown), f"{where}: {shown} × {other}, but {quotient:.4g} by their times")
                    back = compared.quotients
                    if there and back and back[place] and not cell.is_bound:
                        product = number(there.split(" ")[0]) * number(back[place].split(" ")[0])
                        self.expect(is_near(product, 1, 2 * ROUNDING), f"{where}: {there} × {other}, but {back[place]} back")

    def check_building(self, table, words):
        """Building is one operation: its sentence has the ratio and the interval of the table."""
        found = re.search(r"Building[^:]*: [^;]*; ([a-z-]+) takes ([\d.,]+) × \(([\d.,]+ to [\d.,]+)", words)
        if not found:
            return
        backend, ratio, ends = found.groups()
        [head] = find(table, "thead")
        place = [text(cell) for cell in find(head, "th")].index(backend)
        row = next(row for row in find(table, "tr") if row[1].get("data-operation") == "build")
        cell = Cell(row[2][place])
        self.expect((ratio, ends) == (cell.figure, cell.ends), f"build on {backend}: {ratio} × ({ends}) in the sentence, {cell.figure} × ({cell.ends}) in the table")

    def check_cell(self, where, cell, best):
        if cell.ratio is None:
            return
        if cell.ends:
            low, high = map(number, cell.ends.split(" to "))
            self.expect(low <= cell.ratio <= high, f"{where}: {cell.figure} is not between {cell.ends}")
        if best:
            quotient = shown_time(cell.time) / shown_time(best[0].time)
            below = 0.011 if cell.is_bound else ROUNDING
            holds = is_near(quotient, cell.ratio, below)
            self.expect(holds, f"{where}: {cell.figure} ×, but {cell.time} is {quotient:.4g} × {best[0].time}")

    def heat_map(self):
        """The marks and ratios of the numbers of the first heat map, by operation and backend."""
        for section in find(self.root, "section"):
            if section[1].get("id", "").endswith("heat-map"):
                [table] = list(find(section, "table"))[:1]
                head, *rows = [[text(cell) for cell in row[2]] for row in find(table, "tr")]
                cells = ((row[0], backend, cell) for row in rows for backend, cell in zip(head[1:], row[1:]))
                return {(name, backend): marked(cell) for name, backend, cell in cells}
        return {}

    def summary(self):
        """The marks and ratios of the column of building on the first screen."""
        for table in list(find(self.root, "table", **{"class": "summary"}))[:1]:
            head, *rows = list(find(table, "tr"))
            names = [text(cell[2][0]) for cell in head[2]]
            if "build" not in names:
                return {}
            column = names.index("build")
            cells = ((text(row[2][0]), row[2][column]) for row in rows if len(row[2]) > column)
            return {name: marked("".join(text(child) for child in cell[2] if child[0] != "small")) for name, cell in cells}
        return {}


def marked(shown):
    """The mark of a first place, and the text without it."""
    shown = " ".join(shown.split())
    mark = shown[0] if shown[:1] in ("●", "◐") else ""
    return mark, shown.lstrip("●◐ ")


class Cell:
    """A cell of the table of operations."""

    def __init__(self, element):
        data = element[1]
        small = list(find(element, "small"))
        words = [text(word) for word in find(element, "span", **{"class": "mark"})]
        shown = " ".join(text(element).split())
        self.ends = text(small[0]) if small else ""
        for part in [self.ends, *words]:
            shown = shown.replace(part, "").strip()
        self.shown = shown
        self.is_bound = "bound" in data["class"].split(" ")
        self.time = data.get("data-time")
        self.quotients = data.get("data-to", "").split("|") if data.get("data-to") else []
        has_ratio = shown.endswith("×")
        self.figure = shown.lstrip("~≥ ").removesuffix(" ×") if has_ratio else None
        self.ratio = number(self.figure) if has_ratio else None
        self.exact = float(data.get("data-ratio") or "inf")
        is_best = any(True for _ in find(element, "b"))
        self.mark = "◐" if words else "●" if is_best else ""


def main():
    pages = [Page(pathlib.Path(path)).check() for path in sys.argv[1:]]
    faults = [fault for page in pages for fault in page.faults]
    checked = sum(page.checked for page in pages)
    for fault in faults:
        print(fault)
    print(f"{len(pages)} pages, {checked} pairs of numbers, {len(faults)} contradictions")
    sys.exit(bool(faults) or checked == 0)


main()
