"""validation_test.py BUILD: tools/validate passes what is right and fails what is wrong, on its cheapest cases."""

import dataclasses
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import exr
from cases import ROOT
from program import Program
from run import Settings, run_case
from table import BASELINE_TESTS

HERE = pathlib.Path(__file__).parent
BUILD = pathlib.Path(sys.argv.pop()).resolve()


class Validation(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def validate(self, *options):
        command = [sys.executable, HERE, "--build", BUILD, "--out", self.folder, "--spp-scale", "0.1", *options]
        return subprocess.run(list(map(str, command)), capture_output=True, text=True)

    def flat(self, value):
        file = self.folder / "flat.exr"
        exr.write(file, 64, 64, lambda x, y: (value,) * 3)
        return file

    def assert_result(self, run, code):
        self.assertEqual(run.returncode, code, run.stdout + run.stderr)
        return run.stdout

    def test_right_pictures_pass_and_the_page_holds_them(self):
        output = self.assert_result(self.validate("--only", "furnace", "--only", "furnace-exact"), 0)
        self.assertIn("2 passed", output)
        page = (self.folder / "index.html").read_text()
        self.assertEqual(page.count("data:image/png;base64,"), 4 + 3)
        self.assertFalse(re.findall(r"(?:src|href)=\"(?!data:|#)", page), "the page needs other files")

    def test_a_wrong_picture_fails(self):
        # 2 %: the mean of 64 * 64 pixels with 13 samples of deviation 0.4 is known to 0.17 %.
        output = self.assert_result(self.validate("--only", "furnace", "--reference", self.flat(1.02)), 1)
        self.assertIn("FAILED", output)
        self.assertIn("1 FAILED", output)

    def test_a_picture_of_another_size_is_an_error(self):
        exr.write(self.folder / "small.exr", 8, 8, lambda x, y: (1, 1, 1))
        output = self.assert_result(self.validate("--only", "furnace", "--reference", self.folder / "small.exr"), 1)
        self.assertIn("must have one size", output)

    def test_tests_show_their_figures(self):
        case = BASELINE_TESTS[-1]
        output = self.assert_result(self.validate("--only", case.name), 0)
        figure = r"p = [\d.e-]+, chi-square [\d.]+ of \d+, \d+ samples; finds [\d.]+ % \(power 0.99\)"
        self.assertRegex(output, figure)
        page = (self.folder / "index.html").read_text()
        self.assertRegex(page, figure)
        self.assertRegex(page, r"seeded defect, [^\n]*: p = ")

    def test_a_test_that_is_missing_is_an_error(self):
        settings = Settings(Program(BUILD, ROOT, "vulkan"), self.folder)
        for change in ({"filter": "*NoSuchTest*"}, {"folder": "no_such"}):
            result = run_case(dataclasses.replace(BASELINE_TESTS[-1], **change), settings)
            self.assertEqual(result.status, "error")
            self.assertIn("no test", result.reason)

    def test_wrong_usage_is_told_from_failure(self):
        self.assertIn("there are", self.validate("--only", "furnaces").stderr)
        self.assert_result(self.validate("--only", "furnaces"), 2)
        self.assert_result(self.validate("--reference", self.flat(1)), 2)


if __name__ == "__main__":
    unittest.main()
