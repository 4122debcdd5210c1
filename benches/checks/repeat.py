#!/usr/bin/env python3
"""Repeats the default study many times, and reports how far one study predicts the others.

Usage: repeat.py SIXFOLD OUTPUT [--studies 20] [--budget 60s] [--operations LIST] [--keep FOLDER]

Measures the built-in mesh with `SIXFOLD study`, one study after the other, each with another seed. Writes the report to
the Markdown file OUTPUT, and the figures of all studies beside it, to a CSV file of the same name.

Then compares every two studies with `SIXFOLD compare --fail-if-slower`. All have measured the same program, so each study
that is found slower is a false alarm. To see what is overlooked, the script makes one time of the second study 10 % longer,
another one in each comparison.

With --keep, the documents of the studies stay in FOLDER, and studies that are there are not measured again.
"""

import argparse
import csv
import itertools
import json
import pathlib
import platform
import random
import statistics
import subprocess
import sys
import tempfile

# A planted slowdown.
SLOWDOWN = 1.1
# A sample is disturbed if the machine was slower than usual by this factor, as in the warnings of a study.
DISTURBED = 1.3
# The exit codes of `compare --fail-if-slower`.
SAME, SLOWER, CANNOT_TELL = 0, 1, 3


def measured(sixfold, options, folder, number):
    """Returns the document of one study, and measures it if it is not in the folder."""
    place = folder / f"study-{number}.json"
    if not place.exists():
        command = [sixfold, "study", *options, "--seed", str(number), "--json", place]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        print(f"study {number}", file=sys.stderr)
    return json.loads(place.read_text())


def rows_of(document):
    """Returns the measured times of a document, by operation and backend."""
    [study] = document["findings"]
    return {(row["operation"], row["backend"]): row for row in study["results"] if row["median_ns"]}


def percent(part, whole):
    return f"{100 * part / whole:.1f} %" if whole else "–"


def covered(studies, interval, value):
    """Counts the intervals that contain the median of the other studies, and all intervals. `interval` returns the ends of the
    interval of a row, and `value` the same figure in a study."""
    inside = every = 0
    for number, study in enumerate(studies):
        others = studies[:number] + studies[number + 1:]
        for key, row in study.items():
            low, high = interval(row)
            known = [found for found in (value(other, key, study) for other in others) if found is not None]
            if low is None or len(known) < 2:
                continue
            every += 1
            inside += low <= statistics.median(known) <= high
    return inside, every


def time(study, key, _):
    return study[key]["median_ns"] if key in study else None


def ratio(study, key, named):
    """Returns the ratio to the backend that is the fastest in the study `named`; `None` for this backend itself."""
    operation, backend = key
    fastest = [name for (of, name), row in named.items() if of == operation and row["ratio_to_best"] == 1.0]
    if not fastest or fastest[0] == backend or key not in study or (operation, fastest[0]) not in study:
        return None
    return study[key]["median_ns"] / study[(operation, fastest[0])]["median_ns"]


def winners(studies):
    """Returns the number of named sole winners, and how many of them are the usual winner of their operation."""
    named = {}
    for study in studies:
        for (operation, backend), row in study.items():
            if row["standing"] == "best":
                named.setdefault(operation, []).append(backend)
    usual = sum(max(map(backends.count, backends)) for backends in named.values())
    return sum(map(len, named.values())), usual


def variation(studies, value):
    """Returns the median and the largest standard deviation of a figure from study to study, relative to its mean."""
    spreads = []
    for key in studies[0]:
        known = [found for found in (value(study, key, studies[0]) for study in studies) if found is not None]
        if len(known) > 1:
            spreads.append(statistics.stdev(known) / statistics.mean(known))
    return statistics.median(spreads), max(spreads)


def slowed(document, key):
    """Returns a copy of a document in which one time is longer, in each of its launches and samples."""
    document = json.loads(json.dumps(document))
    [study] = document["findings"]
    for row in study["results"]:
        if (row["operation"], row["backend"]) == key:
            for name in ("median_ns", "ci_low_ns", "ci_high_ns", "ns_per_element"):
                row[name] *= SLOWDOWN
            row["launch_ns"] = [ns and SLOWDOWN * ns for ns in row["launch_ns"]]
    return document


def compared(sixfold, before, after, folder):
    """Returns the exit code of the comparison of two documents, and the times that are slower."""
    for name, document in (("before", before), ("after", after)):
        (folder / f"{name}.json").write_text(json.dumps(document))
    command = [sixfold, "compare", "before.json", "after.json", "--fail-if-slower", "--json", "changes.json"]
    done = subprocess.run(command, cwd=folder, check=False, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode not in (SAME, SLOWER, CANNOT_TELL):
        sys.exit(f"compare failed: {done.stderr}")
    changes = json.loads((folder / "changes.json").read_text())
    verdicts = {(row["operation"], row["backend"]): row["verdict"] for row in changes["rows"]}
    return done.returncode, verdicts


def alarms(sixfold, documents):
    """Compares every two documents. Returns the exit codes, the number of single times and of those called slower or not
    decided, and for each comparison the distance of the two studies and whether the planted slowdown was found."""
    chosen = random.Random(1)
    codes, times, slower, open_times, found = [], 0, 0, 0, []
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        for (first, before), (second, after) in itertools.combinations(enumerate(documents), 2):
            code, verdicts = compared(sixfold, before, after, scratch)
            codes.append(code)
            times += len(verdicts)
            slower += sum(verdict == "slower" for verdict in verdicts.values())
            open_times += sum(verdict == "cannot_tell" for verdict in verdicts.values())
            key = chosen.choice(sorted(verdicts))
            _, verdicts = compared(sixfold, before, slowed(after, key), scratch)
            found.append((second - first, verdicts[key] == "slower"))
    return codes, times, slower, open_times, found


def report(sixfold, output, options, documents):
    studies = [rows_of(document) for document in documents]
    run = documents[0]["runs"][0]
    machine, count = run["environment"], len(studies)
    times = sum(map(len, studies)) // count
    slowdowns = [each for document in documents for samples in document["findings"][0]["samples"] for each in samples["slowdowns"]]
    disturbed = sum(each > DISTURBED for each in slowdowns)
    noises = [document["findings"][0]["control"]["typical"] for document in documents if document["findings"][0]["control"]]
    named, usual = winners(studies)
    lines = [
        "# Repeated studies", "",
        "```sh", f"benches/checks/repeat.py sixfold reports/repeatability/{output.name} --studies {count} {' '.join(options)}", "```", "",
        f"{machine['cpu_model']}, {machine['cores']} cores, Linux {machine['kernel'] or platform.release()}; {machine['rustc']}; "
        f"sixfold {machine['commit'] or machine['sixfold']}.", "",
        f"{count} studies of the built-in mesh, {run['settings']['budget_s']:.0f} s each, ran one after the other. A study has {run['settings']['launches'] or 1} "
        f"launches and {times} times. In {percent(disturbed, len(slowdowns))} of the samples, the machine was more than {DISTURBED} times slower than at best.", "",
        "## Intervals", "", "| 95 % intervals of | contain the median of the other studies | number of intervals |", "|---|---|---|",
    ]
    kinds = [
        ("times", lambda row: (row["ci_low_ns"], row["ci_high_ns"]), time),
        ("ratios", lambda row: (row["ratio_ci_low"], row["ratio_ci_high"]), ratio),
    ]
    for name, interval, value in kinds:
        inside, intervals = covered(studies, interval, value)
        lines.append(f"| {name} | {percent(inside, intervals)} | {intervals:,} |")
    lines += ["", "## Winners", "", f"The studies name {named} sole winners, {named / count:.1f} each. {percent(usual, named)} of them are the "
              "usual winner of the operation.", "", "## Variation", "", "| figure | standard deviation from study to study, median | largest |", "|---|---|---|"]
    for name, _, value in kinds:
        typical, worst = variation(studies, value)
        lines.append(f"| {name} | {100 * typical:.1f} % | {100 * worst:.1f} % |")
    lines += ["", f"In each study, one structure is measured twice. The two times differ by {100 * (statistics.median(noises) - 1):.1f} % (median over "
              f"the operations, then over the studies; at most {100 * (max(noises) - 1):.1f} %).", ""]
    codes, times, slower, open_times, planted = alarms(sixfold, documents)
    near = [is_found for distance, is_found in planted if distance == 1]
    found = sum(is_found for _, is_found in planted)
    lines += [
        "## Comparisons of two studies", "",
        f"`sixfold compare --fail-if-slower` compared every two studies of the same program, {len(codes)} comparisons of {times // len(codes)} times.", "",
        "| result | share | number |", "|---|---|---|",
        f"| false alarm: the second study is slower | {percent(codes.count(SLOWER), len(codes))} | {codes.count(SLOWER)} of {len(codes)} |",
        f"| single times called slower | {percent(slower, times)} | {slower:,} of {times:,} |",
        f"| single times that cannot be told | {percent(open_times, times)} | {open_times:,} of {times:,} |",
        f"| a time that was made {100 * (SLOWDOWN - 1):.0f} % longer is found | {percent(found, len(codes))} | {found} of {len(codes)} |",
        f"| the same, in studies that follow each other | {percent(sum(near), len(near))} | {sum(near)} of {len(near)} |", "",
    ]
    return "\n".join(lines)


def write_figures(place, documents):
    names = ["median_ns", "ci_low_ns", "ci_high_ns", "ratio_to_best", "ratio_ci_low", "ratio_ci_high", "standing", "samples", "disturbed"]
    with place.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["study", "operation", "backend", *names])
        for number, document in enumerate(documents, 1):
            for (operation, backend), row in rows_of(document).items():
                shown = [f"{row[name]:.6g}" if isinstance(row[name], float) else row[name] for name in names]
                writer.writerow([number, operation, backend, *shown])


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("sixfold")
    parser.add_argument("output", type=pathlib.Path)
    parser.add_argument("--studies", type=int, default=20)
    parser.add_argument("--budget", default="60s")
    parser.add_argument("--operations")
    parser.add_argument("--keep", type=pathlib.Path)
    chosen = parser.parse_args()
    sixfold = str(pathlib.Path(chosen.sixfold).resolve()) if "/" in chosen.sixfold else chosen.sixfold
    with tempfile.TemporaryDirectory() as scratch:
        folder = chosen.keep or pathlib.Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        options = ["--budget", chosen.budget] + (["--operations", chosen.operations] if chosen.operations else [])
        documents = [measured(sixfold, options, folder, number) for number in range(1, chosen.studies + 1)]
    chosen.output.write_text(report(sixfold, chosen.output, options, documents))
    write_figures(chosen.output.with_suffix(".csv"), documents)


if __name__ == "__main__":
    main()
