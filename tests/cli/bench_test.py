"""`isolux bench` as users call it."""
import os
import unittest

from support import CommandLineTest


class Bench(CommandLineTest):
    def setUp(self):
        super().setUp()
        if self.isolux("bench", "--help").returncode != 0:
            self.skipTest("a build may leave it out")

    def test_writes_results_and_a_report(self):
        self.succeed("bench", "intersect", "--smoke", "-o", "results", "--threads", "02", "--report", "report.json")
        report = self.report()
        self.assertEqual(report["settings"]["threads"], 2)
        self.assertIn("intersect", report["seconds"])
        self.assertIn("intersect.json", os.listdir(os.path.join(self.folder, "results")))

    def test_refuses_what_it_does_not_know(self):
        self.fail(2, "bench", "walk", says=("walk", "trace"))
        for count in ("0x2", "0"):
            self.fail(2, "bench", "intersect", "--threads", count, says=("--threads", f"'{count}'"))
        self.fail(2, "bench", "intersect", "--smoke", "--full", says=("--quick",))


if __name__ == "__main__":
    unittest.main()
