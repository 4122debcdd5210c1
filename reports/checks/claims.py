"""Claims: sentences with holes, whose contents are computed from the data."""

import re
from dataclasses import dataclass
from typing import Callable

HOLE = "{}"
# The contents of a hole do not reach into the next cell of a table, or the next sentence.
FILLING = r"((?:(?! \| |\. ).){1,200}?)"


@dataclass
class Claim:
    sentence: str
    # Returns the text of the hole, or a tuple with the texts of all holes. Raises `data.Contradicted` if the data say
    # the opposite of the sentence.
    values: Callable[[], object]
    # The heading of the section that has the sentence, if other sections may have a similar one.
    section: str = ""

    def filled(self):
        """Returns the sentence with the values of the data, and the values."""
        values = self.values()
        values = () if values is None else values if isinstance(values, tuple) else (values,)
        parts = self.sentence.split(HOLE)
        if len(parts) != len(values) + 1:
            raise ValueError(f"{len(values)} values for the holes of: {self.sentence}")
        return "".join(part + value for part, value in zip(parts, [*values, ""])), values

    def pattern(self):
        """Returns an expression that finds the sentence with other values."""
        return re.compile(FILLING.join(re.escape(part) for part in self.sentence.split(HOLE)) + r"(?!\w)")


class Claims:
    """The claims of one text, and its definitions: phrases whose numbers are not results, one in each line.

    `printed` says that the text blocks of the page are the printed output of a command, and the source of its claims.
    `measured` is the heading of the only section whose numbers are results.
    """

    def __init__(self, path, definitions="", printed=False, measured=""):
        phrases = [line.strip() for line in definitions.splitlines()]
        self.measured = measured
        self.path, self.definitions, self.printed, self.all = path, [p for p in phrases if p], printed, []

    def says(self, sentence, section=""):
        """Adds the decorated function as the values of a sentence."""
        if sentence.startswith(HOLE) or sentence.endswith(HOLE):
            raise ValueError(f"a sentence begins and ends with text, so that its holes can be found: {sentence}")

        def add(values):
            self.all.append(Claim(" ".join(sentence.split()), values, section))
            return values

        return add

    def row(self, sentence, values, *arguments, section=""):
        """Adds a row of a table."""
        self.says(sentence, section)(lambda: values(*arguments))
