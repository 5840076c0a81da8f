"""Tests of what turns raw results into tables: no measurement, no other package."""
import pathlib
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE / "instructions")]

import report
import result


class Figures(unittest.TestCase):
    def test_exponent_of_a_power(self):
        sizes = [10_000, 30_000, 100_000, 1_000_000]
        self.assertAlmostEqual(report.exponent(sizes, [3 * size**1.25 for size in sizes]), 1.25)
        self.assertAlmostEqual(report.exponent(sizes, [7.0] * 4), 0.0)
        self.assertIsNone(report.exponent(sizes[:1], [1.0]))

    def test_quantiles(self):
        self.assertEqual(report.median([3, 1, 2]), 2)
        self.assertEqual(report.quantile([0, 10], 0.25), 2.5)
        self.assertEqual(report.quantile([4], 0.95), 4)

    def test_numbers_have_three_digits(self):
        self.assertEqual([report.number(x) for x in (0.012345, 1.2345, 12.345, 1234.5, 12345, 0, None)],
                         ["0.0123", "1.23", "12.3", "1 234", "12 345", "0", "–"])

    def test_a_section_is_replaced_and_text_around_it_stays(self):
        text = "before\n<!-- make bench: a -->\nold\n<!-- end of a -->\nafter\n"
        new = report.replace_section(text, "a", "new")
        self.assertEqual(new, "before\n<!-- make bench: a -->\n\nnew\n\n<!-- end of a -->\nafter\n")
        self.assertEqual(report.replace_section(new, "a", "new"), new)
        with self.assertRaises(SystemExit):
            report.replace_section(text, "b", "new")

    def test_every_table_has_its_place(self):
        text = (HERE.parent / "docs" / "PERFORMANCE.md").read_text()
        for name in ("machine", "targets", "change", "stages", "peer", "primitives", "paths", "growth", "bound", "threads",
                     "instructions"):
            report.replace_section(text, name, "")

    def test_ratio_is_that_of_single_pairs(self):
        row = {"set": "made", "limit": 60, "cores": 2, "peer": {"one": {"seconds": [4, 2, 2]}, "all": None}}
        ours = {"paper": [{"seconds": [0.2, 0.1, 0.1]}, {"seconds": [0.04, 0.02, 0.02]}], "default": [{"seconds": [0.1, 0.1, 0.2]}]}
        with tempfile.TemporaryDirectory() as folder:
            (pathlib.Path(folder) / "peer.jsonl").write_text(report.json.dumps(row | ours) + "\n")
            found = report.Report(pathlib.Path(folder))
            found.peer()
        self.assertAlmostEqual(found.figures["peer on one core / `paper`, median over all pairs"][0], 100)
        self.assertAlmostEqual(found.figures["peer on one core / `default`, median over all pairs"][0], 20)
        self.assertIn("over 60 s in 0 (1 core) and 1 (all 2 cores)", found.tables["peer"])


class Instructions(unittest.TestCase):
    def test_counts_are_between_marks(self):
        text = "".join(
            "".join(f"mark {stage} {count}\n" for stage, count in enumerate(counts)) + f"0 0 2 poses  {name}\n    best\n"
            for name, counts in [("mug on hook, paper", (5, 5, 15, 18, 20)), ("mug on hook", (100, 100, 110, 130, 190, 200))])
        counts = result.read(text)["counts"]
        self.assertEqual(counts["paper"], {"object": 10, "supporter": 3, "matching": 2})
        self.assertEqual(counts["default"], {"object": 10, "supporter": 20, "matching": 60})
        with self.assertRaises(ValueError):
            result.read(text.replace("mark 2 110\n", ""))


if __name__ == "__main__":
    unittest.main()
