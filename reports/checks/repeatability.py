"""The claims of reports/repeatability/README.md, from what the repeated studies wrote."""

from checks import data, figures
from checks.claims import Claims

ALL = "reports/repeatability/output.md"
NAMED = "reports/repeatability/named.md"

page = Claims(
    "reports/repeatability/README.md",
    definitions="""
        with two hardware threads
        Two named operations
        To find 10 % in a minute
        could have changed by 10 % unnoticed
        So one study predicts
        the exit code says so (3)
    """,
)


def runs(path=ALL):
    """Returns the number of studies and the seconds of each."""
    return data.quoted(path, r"(\d+) studies of the built-in mesh, (\d+) s each")


def disturbed():
    return data.quoted(ALL, r"In ([\d.]+ %) of the samples")[0]


def coverage(kind, path=ALL):
    """Returns the share of intervals that contain the median of the other studies."""
    return data.quoted(path, rf"\| {kind} \| ([\d.]+ %) \| [\d,]+ \|")[0]


def winners(path=ALL):
    """Returns the number of sole winners of a study, and how many of them are the usual ones."""
    return data.quoted(path, r"sole winners, ([\d.]+) each. ([\d.]+ %) of them")


def variation(kind, path=ALL):
    return data.quoted(path, rf"\| {kind} \| ([\d.]+ %) \| [\d.]+ % \|")[0]


def within_study():
    return data.quoted(ALL, r"two times differ by ([\d.]+ %)")[0]


def alarms(path=ALL):
    """Returns the number of false alarms and of comparisons."""
    return data.quoted(path, r"false alarm[^|]*\|[^|]*\| (\d+) of (\d+) \|")


def found(path):
    return data.quoted(path, r"longer is found \| ([\d.]+ %) \|")[0]


@page.says("The built-in mesh was studied {} times, one study after the other, for {} s each")
def studied():
    return runs()


@page.says("In {} of the samples, the machine was more than 1.3 times slower than at best.")
def busy():
    return disturbed()


@page.says("Of the 95 % intervals of ratios, {} contain the median of the other studies; of those of times, {} do.")
def covered():
    return coverage("ratios"), coverage("times")


@page.says("A study names a sole winner for {} of the 28 operations, and {} of these are the usual winner.")
def named():
    return winners()


@page.says(
    "A time varies by {} from study to study, and a ratio by {} (standard deviation divided by the mean; median over all). The "
    "two times of the structure that is measured twice in a study differ by {} (median)."
)
def varied():
    return variation("times"), variation("ratios"), within_study()


@page.says("In {} of {} comparisons of two of these studies, `compare --fail-if-slower` gives a false alarm.")
def compared():
    return alarms()


@page.says("Of times that were made 10 % longer, it finds {}: in a study")
def planted():
    return found(ALL)


@page.says("Two named operations were studied {} times in the same way, in {} launches each.")
def studied_named():
    return runs(NAMED)[0], data.quoted(NAMED, r"A study has (\d+) launches")[0]


@page.says("The machine became faster in the meantime: a time varies by {} from study to study.")
def varied_named():
    return variation("times", NAMED)


@page.says(
    "So one study predicts the others less well: {} of the intervals of ratios contain the median of the other studies, and {} of "
    "those of times."
)
def covered_named():
    return coverage("ratios", NAMED), coverage("times", NAMED)


@page.says("The sole winners are the usual ones in {} of the rows.")
def won_named():
    return winners(NAMED)[1]


@page.says("In {} of {} comparisons, `compare --fail-if-slower` gives a false alarm. Of times that were made 10 % longer, it finds {}; in "
           "studies that follow each other, {}.")
def compared_named():
    return *alarms(NAMED), found(NAMED), data.quoted(NAMED, r"follow each other \| ([\d.]+ %) \|")[0]


TEXTS = [page]
