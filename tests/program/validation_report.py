#!/usr/bin/python3
"""Claims about the validation report: it is what the stored results say, and every case has runs in both tiers."""

import os
import sys
import tempfile
import unittest

ROOT = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "scripts"))

from validation import catalogue, packing, report  # noqa: E402
from validation.case import Row, Spread  # noqa: E402
from validation.store import Store  # noqa: E402

FOLDER = os.path.join(ROOT, "docs", "validation")


class Report(unittest.TestCase):
    def test_the_page_is_what_the_stored_results_say(self):
        with tempfile.TemporaryDirectory() as folder:
            path = report.make(catalogue.CASES, FOLDER, os.path.join(folder, "validation.md"), figures=False)
            with open(path, encoding="utf-8") as made, open(FOLDER + ".md", encoding="utf-8") as kept:
                self.assertEqual(made.read(), kept.read(), "run scripts/validate --report")

    def test_every_stored_result_belongs_to_a_run(self):
        for case in catalogue.CASES:
            known = [(run.function.__name__, run.arguments) for run in case.runs(False)]
            for result in Store(FOLDER, case.name).results:
                self.assertIn((result.function, result.arguments), known, case.name)

    def test_every_case_has_a_quick_tier(self):
        for case in catalogue.CASES:
            quick, full = (sum(run.cost for run in case.runs(tier)) for tier in (True, False))
            self.assertGreater(quick, 0, case.name)
            self.assertLessEqual(quick, full, case.name)


class Verdicts(unittest.TestCase):
    def test_a_target_is_met_or_not(self):
        self.assertTrue(Row("K", "", "", -0.01, 0.01).met)
        self.assertFalse(Row("K", "", "", 0.0101, 0.01).met)
        self.assertFalse(Row("K", "", "", 0.001, 0.01, worst=0.02).met)
        self.assertFalse(Row("K", "", "", 0.001, 0.01, scatter=0.02, scatter_target=0.01).met)
        self.assertFalse(Row("K", "", "", float("nan"), 0.01).met)
        self.assertIsNone(Row("K", "", "", 0.5).met)

    def test_a_spread_with_a_hole_is_none(self):
        self.assertNotEqual(Spread.of([0.0, float("inf")]).worst, Spread.of([0.0]).worst)
        self.assertEqual(Spread.of([-0.03, 0.01]).worst, 0.03)
        self.assertEqual(Spread.of([-0.03, 0.01]).scatter, 0.02)


class Packing(unittest.TestCase):
    def test_spheres_do_not_overlap_and_the_seed_decides(self):
        for gap in (None, 1.5):
            centres, radius = packing.packing(20, 0.4, seed=5, sweeps=20, gap=gap)
            self.assertEqual(centres, packing.packing(20, 0.4, seed=5, sweeps=20, gap=gap)[0])
            self.assertAlmostEqual(20 * 4 / 3 * 3.141592653589793 * radius**3, 0.4 * (gap or 1), delta=1e-12)
            for i, a in enumerate(centres):
                if gap:
                    self.assertTrue(radius <= a[2] <= gap - radius)
                for b in centres[:i]:
                    apart = [x - y - (0 if gap and d == 2 else round(x - y)) for d, (x, y) in enumerate(zip(a, b))]
                    self.assertGreaterEqual(sum(x * x for x in apart), (2 * radius) ** 2 * (1 - 1e-12))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "-v"])
