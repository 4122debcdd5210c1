"""Checks that the check finds faults, on changed copies of the texts and the data."""

import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

from checks import advice, chapters, claims, commits, conclusions, data, figures, front_page, main, repeatability

ROOT = pathlib.Path(__file__).resolve().parents[2]
README = "reports/README.md"
CHOICE = "Choose it if you do not know the workload and have polygons."


class Changed(unittest.TestCase):
    """Runs the check in a copy of the files."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        skipped = shutil.ignore_patterns("*.svg", "*.png", "*.html", "__pycache__")
        for name in ("reports", "docs", chapters.SOURCES):
            shutil.copytree(ROOT / name, self.root / name, ignore=skipped)
        for name in ("README.md", advice.PICTURE):
            shutil.copy(ROOT / name, self.root / name)
        data.use(self.root)
        self.addCleanup(data.use, ROOT)

    def change(self, path, old, new):
        """Replaces a text that occurs in a file, and returns the number of its line."""
        content = (self.root / path).read_text(encoding="utf-8")
        self.assertIn(old, content)
        (self.root / path).write_text(content.replace(old, new, 1), encoding="utf-8")
        data.use(self.root)
        return content[: content.index(old)].count("\n") + 1

    def problems(self, said, known=None):
        return main.check_text(said, known).problems

    def assert_problem(self, problems, place, *parts):
        """Checks that one of the problems is at a place and has all parts."""
        told = [problem for problem in problems if problem.startswith(f"{place}: ")]
        self.assertTrue(any(all(part in problem for part in parts) for problem in told), "\n".join(problems) or "no problem")

    def test_the_files_are_right(self):
        for said in main.TEXTS:
            self.assertEqual(self.problems(said), [], said.path)

    def test_a_changed_digit(self):
        line = self.change(README, "needs 120 bytes per vertex", "needs 121 bytes per vertex")
        self.assert_problem(self.problems(conclusions.page), f"{README}:{line}", "needs 121 bytes", "needs 120 bytes")

    def cell(self, pattern, path=README):
        """Returns the group of a pattern in a text."""
        return re.search(pattern, (self.root / path).read_text(encoding="utf-8"))[1]

    def test_a_swapped_winner(self):
        right = self.cell(r"\| smoothing \| (\*\*relation tables\*\*, half-edge [\d.]+)")
        wrong = right.replace("**relation tables**, half-edge", "**half-edge**, relation tables")
        line = self.change(README, right, wrong)
        self.assert_problem(self.problems(conclusions.page), f"{README}:{line}", wrong, right)

    def test_another_advice(self):
        right = self.cell(r"\| changes polygons: modelling \| (\S+)", "README.md")
        line = self.change("README.md", f"modelling | {right}", "modelling | [winged-edge](crates/winged-edge)")
        self.assert_problem(self.problems(front_page.page), f"README.md:{line}", "[winged-edge]", right)

    def test_another_picture(self):
        self.assertEqual(main.check_picture(write_it=False), [])
        path = self.root / "reports/workloads/built-in-smoothing.json"
        document = json.loads(path.read_text(encoding="utf-8"))
        for row in document["findings"][0]["ranking"]:
            row["ns_per_operation"] *= 1 + (row["backend"] == "half-edge")
        path.write_text(json.dumps(document), encoding="utf-8")
        data.use(self.root)
        self.assertIn("not the picture of the data", main.check_picture(write_it=False)[0])
        main.check_picture(write_it=True)
        data.use(self.root)
        self.assertEqual(main.check_picture(write_it=False), [])

    def test_a_swapped_column(self):
        path = "reports/editing/README.md"
        self.change(path, "winged-edge | half-edge", "half-edge | winged-edge")
        said = next(said for said in main.TEXTS if said.path == path)
        self.assertTrue(any("a sentence is missing" in problem for problem in self.problems(said)))

    def test_a_number_without_a_claim(self):
        line = self.change(README, CHOICE, f"{CHOICE} This took 17 minutes.")
        self.assert_problem(self.problems(conclusions.page), f"{README}:{line}", 'no claim covers the number "17"')

    def test_only_measured_sections_need_claims(self):
        path = chapters.halves.path
        self.change(path, "One\nhalf-edge for each vertex", "17\nhalf-edges for each vertex")
        self.assertEqual(self.problems(chapters.halves), [])
        line = self.change(path, "[corner table](corner-table.md) 64", "[corner table](corner-table.md) 65")
        self.assert_problem(self.problems(chapters.halves), f"{path}:{line}", "corner-table.md) 65", "corner-table.md) 64")

    def test_a_number_as_a_word(self):
        line = self.change(README, CHOICE, f"{CHOICE} It won three times.")
        self.assert_problem(self.problems(conclusions.page), f"{README}:{line}", 'no claim covers the number "three"')

    def test_a_deleted_sentence(self):
        self.change(README, "Half-edge needs 96 bytes per vertex.", "")
        self.assertTrue(any('a sentence is missing: "Half-edge needs 96' in each for each in self.problems(conclusions.page)))

    def test_a_stale_definition(self):
        line = self.change("docs/measuring.md", "exactly 20 rounds", "exactly these rounds")
        problems = self.problems(front_page.measuring)
        self.assert_problem(problems, f"docs/measuring.md:{line}", 'the definition "exactly 20 rounds" is not in the text')

    def test_an_unknown_commit(self):
        line = self.change(README, "measured at commit 85aa324", "measured at commit 0badc0de1")
        problems = self.problems(conclusions.page, known=lambda commit: commit != "0badc0de1")
        self.assert_problem(problems, f"{README}:{line}", "the commit 0badc0de1 is not in the history")
        self.assert_problem(problems, f"{README}:{line}", "commit 85aa324")

    def test_a_missing_data_file(self):
        (self.root / "reports/orders/orders.json").unlink()
        data.use(self.root)
        line = (self.root / README).read_text(encoding="utf-8").split("On 1,003,520 triangles")[0].count("\n") + 1
        self.assert_problem(self.problems(conclusions.page), f"{README}:{line}", "cannot read reports/orders/orders.json")

    def test_a_missing_workload(self):
        (self.root / "reports/workloads/built-in-smoothing.json").unlink()
        data.use(self.root)
        self.assertTrue(any("no measurement of smoothing on built-in.obj" in each for each in self.problems(conclusions.page)))

    def test_a_missing_text(self):
        (self.root / repeatability.page.path).unlink()
        data.use(self.root)
        self.assert_problem(self.problems(repeatability.page), "reports/repeatability/README.md:1", "cannot read")

    def test_changed_data(self):
        self.change_samples("remeshing", samples=3)
        line = (self.root / README).read_text(encoding="utf-8").split("| remeshing |")[0].count("\n") + 1
        self.assert_problem(self.problems(conclusions.page), f"{README}:{line}", "| no winner: ")

    def change_samples(self, workload, samples):
        path = self.root / f"reports/workloads/built-in-{workload}.json"
        document = json.loads(path.read_text(encoding="utf-8"))
        for row in document["findings"][0]["ranking"]:
            row["samples"] = samples
        path.write_text(json.dumps(document), encoding="utf-8")
        data.use(self.root)

    def test_values_are_written(self):
        before = (self.root / "README.md").read_text(encoding="utf-8")
        wrong_values = {r"[\d.]+ µs +\*1\.00": "77.7 µs  *1.00", r"half-edge takes up to [\d.]+×": "half-edge takes up to 77×"}
        for pattern, wrong in wrong_values.items():
            self.change("README.md", re.search(pattern, before)[0], wrong)
        main.write(main.check_text(front_page.page))
        self.assertEqual((self.root / "README.md").read_text(encoding="utf-8"), before)

    def test_a_folder_without_history(self):
        self.assertIn("no history", commits.obstacle())

    def test_exit_codes(self):
        run = lambda: subprocess.run([sys.executable, self.root / "reports/check"], capture_output=True, text=True, check=False)
        self.assertEqual(run().returncode, 0)
        self.assertIn("The commits were not checked", run().stdout)
        self.change("README.md", "15,000 quads", "15,001 quads")
        self.assertEqual(run().returncode, 1)


class Parts(unittest.TestCase):
    def test_ranges_are_rounded_outwards(self):
        self.assertEqual(figures.span([1.231, 7.91]), ("1.23", "8.0"))
        self.assertEqual(figures.span([0.939, 33_921]), ("0.93", "34,000"))
        self.assertEqual(figures.span([1.1, 2.2]), ("1.10", "2.2"))
        self.assertEqual(figures.ratio(1.996), "2.00")
        self.assertEqual(figures.time(999_700), "1.00 ms")

    def test_an_interval_of_a_workload_is_that_of_the_command(self):
        for (name, mesh), workload in data.workloads().items():
            if name in ("subdivision", "smoothing"):
                row = workload.rows["half-edge"] if workload.fastest != "half-edge" else workload.rows["winged-edge"]
                found = advice.mean([workload], row["backend"], workload.fastest)
                for end, expected in ((found.low, row["ci_low"]), (found.high, row["ci_high"])):
                    self.assertAlmostEqual(end / expected, 1, delta=1e-3, msg=f"{name} on {mesh}")
        for freedom, quantile in ((1, 12.706), (2, 4.303), (5, 2.571), (20, 2.086)):
            self.assertAlmostEqual(advice.student(freedom), quantile, delta=1e-3)

    def test_a_hole_ends_with_its_sentence(self):
        said = claims.Claim("In {} of {} rows", lambda: None)
        self.assertEqual(said.pattern().search("In some. In 4 of 5 rows")[1], "4")

    def test_a_sentence_that_begins_with_a_hole(self):
        with self.assertRaises(ValueError):
            claims.Claims("a.md").says("{} is faster")


if __name__ == "__main__":
    unittest.main()
