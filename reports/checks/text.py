"""A text whose sentences and numbers can be found, with the line of each place."""

import bisect
import re

# A run of white space, also across the marks of a block quote.
SPACE = re.compile(r"\s*\n> ?|\s+")
# Parts whose numbers are not results: code blocks, code in a line, the targets of links, and the numbers of items.
EXEMPT = re.compile(r"^```(?P<kind>\w*).*?^```|`[^`\n]+`|\]\([^)]*\)|^(?:#+ )?\d+\. ", re.DOTALL | re.MULTILINE)
WORDS = """two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen seventeen eighteen
nineteen twenty thirty forty fifty sixty seventy eighty ninety hundred thousand million twice dozen"""
NUMBER = re.compile(
    r"(?<![\w.])\d[\d,]*(?:\.\d+)?|\bone of\b|\bhalf\b(?!-edge)|\b(?:a|an) (?:third|quarter|fifth|tenth|hundredth)\b"
    rf"|\b(?:{'|'.join(WORDS.split())})\b",
    re.IGNORECASE,
)
# The hash of a compiler, which is followed by its date, is not a commit of this project.
COMMIT = re.compile(r"\b(?=[0-9a-f]*[0-9])(?=[0-9a-f]*[a-f])[0-9a-f]{7,40}\b(?! \d{4}-)")


class Text:
    """A file, and its content with every run of white space as one space."""

    def __init__(self, path, content):
        self.path, self.content = path, content
        self.flat, self.places = flattened(content)

    def line(self, place):
        """Returns the number of the line of a place in the flat content."""
        return self.content.count("\n", 0, self.places[place]) + 1

    def at(self, place):
        return f"{self.path}:{self.line(place)}"

    def section(self, heading):
        """Returns where the section with this heading begins and ends; the whole text without a heading."""
        first = max(0, self.flat.find(heading))
        end = self.flat.find("## ", first + 3) if heading.startswith("## ") else -1
        return first, len(self.flat) if end < 0 else end

    def spans(self, phrase, section=()):
        """Returns where a phrase occurs in a section, except inside of longer numbers and words."""
        start = r"(?<![\w.])" if phrase[:1].isalnum() else ""
        end = r"(?!\w|[.,]\d)" if phrase[-1:].isalnum() else ""
        return [found.span() for found in re.compile(start + re.escape(phrase) + end).finditer(self.flat, *section)]

    def exempt_spans(self, printed):
        """Returns the flat spans of code and of the targets of links; also of printed output, if `printed`."""
        kept = [found.span() for found in EXEMPT.finditer(self.content) if printed or found["kind"] != "text"]
        return [tuple(bisect.bisect_left(self.places, end) for end in span) for span in kept]

    def context(self, place):
        """Returns the words around a place."""
        return "… " + self.flat[max(0, place - 50) : place + 50].strip() + " …"

    def nearest(self, sentence):
        """Returns the place up to which the text has the longest beginning of the sentence."""
        words = sentence.split(" ")
        for count in range(len(words), 0, -1):
            place = self.flat.find(" ".join(words[:count]))
            if place >= 0:
                return place
        return 0


def flattened(content):
    """Returns the flat content, and the place of each of its characters in the content."""
    parts, places, end = [], [], 0
    for found in SPACE.finditer(content):
        parts += [content[end : found.start()], " "]
        places += [*range(end, found.start()), found.start()]
        end = found.end()
    parts.append(content[end:])
    places += range(end, len(content) + 1)
    return "".join(parts), places
