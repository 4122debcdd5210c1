"""Compares the texts with their claims."""

import argparse
import pathlib
import unittest

from checks import advice, claims, commits, data, text
from checks import chapters, conclusions, edits, front_page, guide, neighbours, repeatability, shorter, subdivision, validity

TEXTS = [*conclusions.TEXTS, *edits.TEXTS, *subdivision.TEXTS, *repeatability.TEXTS, *validity.TEXTS, *guide.TEXTS]
TEXTS += [*neighbours.TEXTS, *shorter.TEXTS, *front_page.TEXTS, *chapters.TEXTS]


class Result:
    """What the check of one text found."""

    def __init__(self, page):
        self.page, self.problems, self.shown, self.covered, self.changes = page, [], [], [], []

    def problem(self, place, message):
        self.problems.append(f"{self.page.at(place)}: {message}")


def check_claim(claim, result):
    page = result.page
    section = page.section(claim.section)
    found = claim.pattern().search(page.flat, *section)
    place = found.start() if found else page.nearest(claim.sentence.split(claims.HOLE)[0])
    if found:
        result.covered.append(found.span())
    try:
        filled, values = claim.filled()
    except data.Contradicted as error:
        return result.problem(place, f'the data do not support "{claim.sentence}": {error}')
    except (data.Missing, LookupError, ValueError, TypeError, ArithmeticError, StopIteration) as error:
        return result.problem(place, f'cannot check "{claim.sentence}": {type(error).__name__}: {error}')
    expected = " ".join(filled.split())
    result.shown.append(f"{page.at(place)}: {expected}")
    spans = page.spans(expected, section)
    result.covered += spans
    if spans:
        return None
    if not found:
        return result.problem(place, f'a sentence is missing: "{expected}"')
    result.changes += [(found.span(hole + 1), value) for hole, value in enumerate(values)]
    return result.problem(place, f'the text says "{found[0]}"\n    the data say "{expected}"')


def check_numbers(said, result):
    """Finds numbers that are in no claim and no definition, and definitions that are not in the text."""
    page = result.page
    covered = result.covered + page.exempt_spans(said.printed)
    for definition in said.definitions:
        spans = page.spans(" ".join(definition.split()))
        covered += spans
        if not spans:
            result.problem(page.nearest(definition), f'the definition "{definition}" is not in the text')
    for number in text.NUMBER.finditer(page.flat, *page.section(said.measured)):
        if not any(start <= number.start() and number.end() <= end for start, end in covered):
            message = f'no claim covers the number "{number[0]}" in "{page.context(number.start())}"'
            result.problem(number.start(), message)


def check_commits(result, known):
    for commit in text.COMMIT.finditer(result.page.flat):
        if not known(commit[0]):
            result.problem(commit.start(), f"the commit {commit[0]} is not in the history of this checkout")


def check_text(said, known=None):
    """Returns the result for the claims of one text. `known` says whether a commit exists; None leaves commits out."""
    try:
        result = Result(text.Text(said.path, data.content(said.path)))
    except data.Missing as error:
        result = Result(text.Text(said.path, ""))
        result.problem(0, str(error))
        return result
    for claim in said.all:
        check_claim(claim, result)
    check_numbers(said, result)
    if known:
        check_commits(result, known)
    return result


def write(result):
    """Writes the values of the data into the text."""
    page, content = result.page, result.page.content
    for (start, end), value in sorted(result.changes, reverse=True):
        content = content[: page.places[start]] + value + content[page.places[end] :]
    (data.ROOT / page.path).write_text(content, encoding="utf-8")


def check_picture(write_it):
    """Returns a problem if the picture of README.md is not that of the data."""
    try:
        drawn = advice.picture()
        if write_it:
            (data.ROOT / advice.PICTURE).write_text(drawn, encoding="utf-8")
            return []
        is_drawn = data.content(advice.PICTURE) == drawn
    except data.Missing as error:
        return [f"{advice.PICTURE}: {error}"]
    return [] if is_drawn else [f"{advice.PICTURE}: not the picture of the data; --write draws it"]


def main(usage):
    as_written = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=usage, formatter_class=as_written, usage="reports/check")
    for option in ("--show", "--write", "--self-test"):
        parser.add_argument(option, action="store_true")
    chosen = parser.parse_args()
    if chosen.self_test:
        suite = unittest.defaultTestLoader.discover(str(pathlib.Path(__file__).parent), top_level_dir=data.ROOT / "reports")
        return not unittest.TextTestRunner().run(suite).wasSuccessful()
    obstacle = commits.obstacle()
    results = [check_text(said, None if obstacle else commits.known) for said in TEXTS]
    for result in results:
        print("".join(f"{line}\n" for line in (result.shown if chosen.show else []) + result.problems), end="")
        if chosen.write:
            write(result)
    drawing = check_picture(chosen.write)
    print("".join(f"{line}\n" for line in drawing), end="")
    problems = sum(len(result.problems) for result in results) + len(drawing)
    print(f"{len(TEXTS)} texts, {sum(len(said.all) for said in TEXTS)} claims, {problems} contradictions")
    if obstacle:
        print(f"The commits were not checked: {obstacle}.")
    return 1 if problems else 0
