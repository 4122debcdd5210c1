"""How the texts write values. All rounding is here.

A ratio has two decimals if it is below 2, otherwise two significant digits. The ends of a range, and bounds such as "at
most", are rounded outwards. So a range contains each of its values, also as a table prints them.
"""

import math

WORDS = "zero one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen".split()


def rounded(value, digits, to=round):
    """Returns the value with this number of significant digits. `to` is round, math.floor or math.ceil."""
    places = digits - 1 - math.floor(math.log10(abs(value))) if value else 0
    # The inner rounding removes errors of binary fractions, such as 1.1 * 100 > 110.
    steps = to(round(value * 10.0**places, 6))
    if steps >= 10**digits:  # 9.97 has become 10.0
        steps, places = steps / 10, places - 1
    return f"{steps / 10.0**places:,.{max(0, places)}f}"


def ratio(value, to=round):
    if value < 2:
        return f"{to(round(value * 100, 6)) / 100:.2f}"
    return rounded(value, 2, to)


def at_least(values):
    return ratio(min(values), math.floor)


def at_most(values):
    return ratio(max(values), math.ceil)


def span(values):
    """Returns the ends of the range of ratios."""
    values = list(values)
    return at_least(values), at_most(values)


def exponent_span(values):
    """Returns the ends of a range of exponents, with two decimals."""
    values = [100 * value for value in values]
    return f"{math.floor(min(values)) / 100:.2f}", f"{math.ceil(max(values)) / 100:.2f}"


def ns_span(values):
    """Returns the ends of a range of times in nanoseconds, with two significant digits."""
    values = list(values)
    return rounded(min(values), 2, math.floor), rounded(max(values), 2, math.ceil)


def percent_at_most(ratios):
    """Returns the largest difference of the ratios from 1, in whole percent."""
    return f"{math.ceil(round(100 * (max(ratios) - 1), 6))} %"


def count(number):
    return f"{number:,}"


def word(number):
    return WORDS[number] if number < len(WORDS) else count(number)


def names(items):
    items = list(items)
    return " and ".join([", ".join(items[:-1]), items[-1]] if len(items) > 1 else items)


def code_names(items):
    return names(f"`{item}`" for item in items)


def three_digits(value):
    """Returns a value as the command prints it."""
    return rounded(value, 3)


def shown(value):
    """Returns the number that a reader sees if the command prints a value."""
    return float(rounded(value, 3).replace(",", ""))


def time(ns):
    """Returns a time with three significant digits and its unit, as the command prints it."""
    for unit, size in (("s", 1e9), ("ms", 1e6), ("µs", 1e3)):
        if ns >= 0.9995 * size:
            return f"{rounded(ns / size, 3)} {unit}"
    return f"{rounded(ns, 3)} ns"
