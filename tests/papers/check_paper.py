#!/usr/bin/env python3
"""Checks the folder of `--figures`: check_paper.py DIR results.json

Each figure has its four files. The PDF has the text of the picture (needs `pdftotext`), and the SVG has the outlines of the same
letters, each once. The rankings, drawn again by
crates/report/examples/redraw.py (needs matplotlib), have the numbers of results.json.
"""

import json
import subprocess
import sys
import xml.etree.ElementTree
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "crates/report/examples"))
sys.dont_write_bytecode = True
import redraw  # noqa: E402


def check_files(folder):
    figures = sorted(folder.glob("*.svg"))
    assert figures, "no figure"
    for svg in figures:
        for ending in (".pdf", ".csv", ".txt"):
            assert svg.with_suffix(ending).stat().st_size > 0, svg.with_suffix(ending)
        text = subprocess.run(["pdftotext", svg.with_suffix(".pdf"), "-"], check=True, capture_output=True, text=True).stdout
        assert "half-edge" in text, f"{svg.stem}.pdf has no name of a structure: {text!r}"
        fonts = subprocess.run(["pdffonts", svg.with_suffix(".pdf")], check=True, capture_output=True, text=True).stdout
        fonts = [line.split()[0] for line in fonts.splitlines()[2:]]
        assert fonts and all("DejaVuSans" in font for font in fonts), f"{svg.stem}.pdf uses {fonts}"
        check_outlines(svg, text)
    return len(figures)


def check_outlines(svg, text_of_pdf):
    elements = list(xml.etree.ElementTree.parse(svg).iter())
    tags = [element.tag.rpartition("}")[2] for element in elements]
    assert "text" not in tags and "use" in tags, svg
    ids = [element.get("id") for element in elements if element.get("id")]
    references = {element.get("{http://www.w3.org/1999/xlink}href") for element in elements} - {None}
    assert len(set(ids)) == len(ids) and references == {f"#{name}" for name in ids}, svg
    # A text is named by its words, as the whole picture is.
    texts = [element.get("aria-label") for element in elements[1:] if element.get("aria-label")]
    letters, expected = (sorted("".join(words.split())) for words in ("".join(texts), text_of_pdf))
    assert letters == expected, f"{svg} and its PDF have other letters"


def check_rankings(folder, document):
    import matplotlib

    matplotlib.use("agg")
    import matplotlib.pyplot as plt

    [study] = [finding for finding in document["findings"] if finding["kind"] == "study"]
    operations = sorted({row["operation"] for row in study["results"]})
    table = redraw.rows(folder / "rankings.csv")
    drawn = 0
    for operation in operations:
        ranked = [row for row in study["results"] if row["operation"] == operation and row["ratio_to_best"] is not None]
        ranked.sort(key=lambda row: row["ratio_to_best"])
        figure, axes = plt.subplots()
        redraw.draw(redraw.ranking(table, operation), axes)
        names = [label.get_text() for label in axes.get_yticklabels()]
        assert names == [row["backend"] for row in ranked], (operation, names)
        ends = [bar.get_x() + bar.get_width() for bar in axes.patches]
        expected = [row["ratio_to_best"] for row in ranked]
        assert all(abs(end / ratio - 1) < 1e-12 for end, ratio in zip(ends, expected, strict=True)), (operation, ends)
        intervals = [list(line.get_xdata()) for line in axes.lines]
        expected = [[row["ratio_ci_low"], row["ratio_ci_high"]] for row in ranked if row["ratio_ci_low"] is not None]
        assert intervals == expected, (operation, intervals)
        plt.close(figure)
        drawn += 1
    assert drawn > 0, "no ranking was drawn"
    return drawn


def main():
    folder, results = map(Path, sys.argv[1:])
    figures = check_files(folder)
    rankings = check_rankings(folder, json.loads(results.read_text()))
    print(f"{figures} figures for a paper, {rankings} rankings drawn again")


main()
