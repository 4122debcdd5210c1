"""The claims of reports/repeatability/README.md, from the printed output of the studies."""

import re

from checks import data, figures
from checks.claims import Claims
from checks.data import RELATIONS

OUTPUT = "reports/repeatability/output.md"

page = Claims(
    "reports/repeatability/README.md",
    definitions="""
        with two cores of an AMD EPYC
        differ by more than 10 %
    """,
)


def runs():
    """Returns the number of studies and the seconds of each."""
    return data.quoted(OUTPUT, r"reports/repeatability (\d+) (\d+)")


def leaders():
    """Returns for each relation how often each backend is best or tied."""
    rows = [line.strip("| ").split(" | ") for line in data.content(OUTPUT).splitlines() if re.search(r"(best|shared|tied) \d", line)]
    led = lambda cell: {each.split()[0]: sum(map(int, re.findall(r"\d+", each))) for each in cell.split("; ")}
    return {relation: led(cell) for relation, cell in rows}


def triangles():
    return data.quoted(OUTPUT, r"torus of ([\d,]+) triangles")[0]


def require_same_leader():
    always = [relation for relation, led in leaders().items() if max(led.values()) == int(runs()[0])]
    data.require(always == list(RELATIONS.values()), f"one structure always leads only for {always}")


def pairs():
    """Returns the numbers of pairs, of those that are apart, and of those whose order is the same in 95 % of the studies."""
    apart, every, steady = data.quoted(OUTPUT, r"In (\d+) of the (\d+) comparisons.* In (\d+) of these comparisons")
    return every, apart, steady


def variation(figure):
    return data.quoted(OUTPUT, rf"\| {figure} \| ([\d.]+ %) \| ([\d.]+ %) \| ([\d.]+ %)")


def within_study():
    """Returns the typical and the largest difference between two times of one structure in one study."""
    return data.quoted(OUTPUT, r"differ by ([\d.]+ %).* and by at most ([\d.]+ %)")


def coverage(kind):
    """Returns the share of intervals that contain the median, and their number."""
    return data.quoted(OUTPUT, rf"\| {kind} \| (\d+ %) \| (\d+) \|")


@page.says("A torus of {} triangles in random order was studied {} times, one study after the other, for {} s each")
def studied():
    return triangles(), *runs()


@page.says("For each of the {} relations, one structure is best or tied with the best in all {} studies.")
def same_leader():
    require_same_leader()
    return figures.word(len(RELATIONS)), runs()[0]


@page.says(
    "The times of every two structures were compared for each relation. In {} of {} comparisons, the medians over all "
    "studies differ by more than 10 %. In {} of these, the same structure is faster in at least 95 % of the studies."
)
def compared():
    every, apart, steady = pairs()
    return apart, every, steady


@page.says("are {} results of backends that take more than 1.1 times the time of the best (median over all studies). In {} of "
           "them, the study finds the backend slower.")
def differences():
    every, slower = data.quoted(OUTPUT, r"backends have (\d+) results.* In (\d+) of these results")
    return every, slower


@page.says(
    "A time varies by {} from study to study, and a ratio to the best backend by {} (the standard deviation divided by the "
    "mean; median over all)."
)
def varied():
    return variation("time")[0], variation("ratio to the best")[0]


@page.says("Two times of one structure in the same study differ by {} (median), and by at most {}.")
def same_study():
    return within_study()


@page.says(
    "So {} of the {} intervals of times, and {} of the {} intervals of ratios, contain the median of all studies "
    "(structures that scan are left out)."
)
def covered():
    return *coverage("the time"), *coverage("the ratio to the best")


@page.says("The additional variation has a standard deviation of {}, and the intervals of a study assume {}.")
def drift():
    return data.quoted(OUTPUT, r"standard deviation of ([\d.]+ %).* intervals assume ([\d.]+ %)")


TEXTS = [page]
