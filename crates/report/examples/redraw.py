#!/usr/bin/env python3
"""Draws a ranking again from its data: redraw.py DIR/rankings.csv vertex_normal [FIGURE.pdf]

Reads the CSV file of a figure from `sixfold study MESH --figures DIR`. Without the name of a figure, prints the numbers that would
be drawn. Drawing needs matplotlib; reading needs only Python. `rows` also reads `results.csv` of `sixfold study MESH --report DIR`.
"""

import csv
import sys


def rows(path):
    """Returns the rows of a CSV file as dictionaries. Numbers are floats, and an empty cell is None."""
    with open(path, newline="", encoding="utf-8") as file:
        return [{name: value_of(cell) for name, cell in row.items()} for row in csv.DictReader(file)]


def value_of(cell):
    if cell in ("true", "false"):
        return cell == "true"
    try:
        return float(cell) if cell else None
    except ValueError:
        return cell


def ranking(table, operation):
    """Returns, for an operation, (backend, ratio, low end, high end) for each measured ratio, the fastest first. The ends of the 95 % interval are
    None if there were too few samples."""
    measured = [row for row in table if row["operation"] == operation and row["ratio_to_best"] is not None and not row.get("lower_bound")]
    measured.sort(key=lambda row: row["ratio_to_best"])
    return [(row["backend"], row["ratio_to_best"], row["ratio_ci_low"], row["ratio_ci_high"]) for row in measured]


def draw(bars, axes):
    """Draws the bars with their intervals. The axis is logarithmic and begins at 1, the time of the fastest."""
    for place, (backend, ratio, low, high) in enumerate(bars):
        axes.barh(place, ratio - 1, left=1, label=backend)
        if low is not None and high is not None:
            axes.plot([low, high], [place, place], color="black")
    axes.set_xscale("log")
    axes.set_yticks(range(len(bars)), [backend for backend, *_ in bars])
    axes.invert_yaxis()
    axes.set_xlabel("time relative to the fastest")


def main():
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    bars = ranking(rows(sys.argv[1]), sys.argv[2])
    if len(sys.argv) == 3:
        for backend, *numbers in bars:
            print(backend, *("-" if number is None else number for number in numbers))
        return
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(7, 1 + 0.4 * len(bars)), layout="constrained")
    draw(bars, axes)
    figure.savefig(sys.argv[3])


if __name__ == "__main__":
    main()
