"""The tools answer mistakes with a line that names them and exit code 2, and Ctrl-C with 130; never with a traceback."""

import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

TOOLS = pathlib.Path(__file__).resolve().parent
VALIDATION = TOOLS / "validation"
TIMEOUT = 60  # seconds; each takes well below one


class Tools(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_tool(self, tool, *arguments):
        command = [*([sys.executable] if pathlib.Path(tool).suffix == ".py" or tool == VALIDATION else []), tool, *arguments]
        done = subprocess.run(list(map(str, command)), cwd=self.folder, capture_output=True, text=True, timeout=TIMEOUT)
        self.assertNotIn("Traceback", done.stderr)
        return done

    def assert_refuses(self, words, tool, *arguments):
        done = self.run_tool(tool, *arguments)
        self.assertEqual(done.returncode, 2, f"{tool} {arguments}\n{done.stdout}{done.stderr}")
        for word in words:
            self.assertIn(word, done.stderr)

    def build_with(self, script):
        """A build folder whose program is a shell script."""
        program = self.folder / "build" / "parhelion"
        program.parent.mkdir(exist_ok=True)
        program.write_text(script)
        program.chmod(0o755)
        return program.parent

    def test_validate_refuses_folders_without_the_program(self):
        for folder in ("nowhere", ".", __file__):
            for tool in (VALIDATION, TOOLS / "validate"):
                self.assert_refuses(["--build: expected a build folder", str(folder)], tool, "--build", folder)
        self.build_with("").joinpath("parhelion").chmod(0o644)
        self.assert_refuses(["--build", "got build"], VALIDATION, "--build=build")

    def test_validate_refuses_wrong_options(self):
        build = self.build_with("#!/bin/sh\n")
        file = self.folder / "file"
        file.touch()
        for words, *options in ((["--out: expected a folder", "file"], "--out", file),
                                (["--out: expected a folder", "file/below"], "--out", file / "below"),
                                (["--reference", "missing.exr"], "--only", "furnace", "--reference", "missing.exr"),
                                (["--reference", "is no file"], "--only", "furnace", "--reference", self.folder),
                                (["--spp-scale", "got inf"], "--spp-scale", "inf"),
                                (["--spp-scale", "got nan"], "--spp-scale", "nan"),
                                (["--spp-scale", "got many"], "--spp-scale", "many"),
                                (["no case furnaces", "furnace-exact"], "--only", "furnaces"),
                                (["--backend", "cuda"], "--backend", "cuda"),
                                (["--frobnicate"], "--frobnicate")):
            with self.subTest(options=options):
                self.assert_refuses(words, VALIDATION, "--build", build, *options)

    @unittest.skipIf(os.geteuid() == 0, "root may write anywhere")
    def test_validate_refuses_a_folder_it_may_not_write_into(self):
        locked = self.folder / "locked"
        locked.mkdir(mode=0o500)
        self.assert_refuses(["--out", "locked"], VALIDATION, "--build", self.build_with("#!/bin/sh\n"), "--out", locked)

    def test_validate_reports_a_program_that_does_no_work(self):
        for script, words in (("#!/bin/sh\necho hello\n", "--json"), ("#!/bin/sh\nkill -9 $$\n", "SIGKILL"),
                              ("#!/no/such/shell\n", "No such file"), ("\x7fELF", "Exec format"),
                              ("#!/bin/sh\nprintf '\\377' >&2; exit 3\n", ""), ("#!/bin/sh\nexit 3\n", "exit code 3")):
            with self.subTest(script=script):
                done = self.run_tool(VALIDATION, "--build", self.build_with(script), "--out", self.folder / "out",
                                     "--only", "furnace")
                self.assertEqual(done.returncode, 1, done.stderr)
                self.assertIn("1 ERROR", done.stdout)
                self.assertIn(words, done.stdout)

    def test_validate_ends_on_ctrl_c(self):
        build = self.build_with("#!/bin/sh\ntouch started\nexec sleep 60\n")
        started = TOOLS.parent / "started"  # the program runs in the project's folder
        self.addCleanup(started.unlink, missing_ok=True)
        run = subprocess.Popen([sys.executable, VALIDATION, "--build", build, "--out", self.folder / "out", "--only",
                                "furnace"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                               start_new_session=True)
        end = time.monotonic() + TIMEOUT
        while not started.exists() and time.monotonic() < end:
            time.sleep(0.01)
        os.killpg(run.pid, signal.SIGINT)
        error = run.communicate(timeout=TIMEOUT)[1]
        self.assertEqual(run.returncode, 130, error)
        self.assertIn("interrupted", error)
        self.assertNotIn("Traceback", error)

    def test_output_that_nobody_reads_is_no_error(self):
        run = subprocess.Popen(["bash", "-c", f'"{sys.executable}" "{VALIDATION}" --list | true; echo ${{PIPESTATUS[0]}}'],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        output, error = run.communicate(timeout=TIMEOUT)
        self.assertIn(output.strip(), ("0", str(128 + signal.SIGPIPE)))
        self.assertEqual(error, "")

    def test_checks_refuse_folders_that_are_no_project(self):
        for name in ("check_floors.py", "check_mirror.py", "check_parity_coverage.py", "check_sizes.py",
                     "check_hard_cases.py"):
            self.assert_refuses([name, "missing"], TOOLS / name, self.folder)
        (self.folder / "host").mkdir()
        (self.folder / "host" / "latin.cpp").write_bytes(b"// \xe9\n")
        self.assert_refuses(["UTF-8"], TOOLS / "check_sizes.py", self.folder)

    def test_test_refuses_options_that_are_none_before_it_builds(self):
        for words, *options in ((["--al"], "--al"), (["--frobnicate"], "-R", "Sky", "--frobnicate=4"),
                                (["regular expression", "*("], "-R", "*("), (["regular expression"], "-L", "[")):
            self.assert_refuses(words, TOOLS / "test", *options)

    def test_render_refuses_scenes_that_are_no_files_before_it_builds(self):
        self.assert_refuses(["tools/render: error", "missing.xml"], TOOLS / "render", "missing.xml")
        self.assert_refuses([str(self.folder)], TOOLS / "render", self.folder)

    def test_dearest_tests_refuses_what_is_no_report(self):
        (self.folder / "cut.xml").write_text("<testsuite>")
        self.assert_refuses(["cut.xml", "JUnit"], TOOLS / "dearest_tests.py", "cut.xml")
        self.assert_refuses(["missing.xml"], TOOLS / "dearest_tests.py", "missing.xml")
        self.assert_refuses(["one argument"], TOOLS / "dearest_tests.py")

    def test_generators_refuse_places_they_cannot_write_to(self):
        for name in ("make_knot.py", "make_environment.py", "make_courtyard.py"):
            self.assert_refuses([name, "missing"], TOOLS / name, self.folder / "missing" / "very" / "deep")
            self.assert_refuses(["--frobnicate"], TOOLS / name, "file", "--frobnicate")
        self.assert_refuses(["FILE.obj"], TOOLS / "make_knot.py")

    def test_tools_of_mitsuba_refuse_wrong_options_or_say_what_they_need(self):
        for name, *arguments in (("benchmark.py", "missing.xml", "--program", "missing"),
                                 ("benchmark.py", "missing.xml", "--rounds", "0"),
                                 ("checkerboard_texture.py",), ("checkerboard_texture.py", "missing/deep/file.exr"),
                                 ("environment_maps.py", "--output", "missing/deep/file.csv"),
                                 ("make_references.py", "no_scene"), ("make_references.py", "--size", "0"),
                                 ("make_references.py", "--variant", "no_variant")):
            self.assert_refuses([name], TOOLS / "mitsuba" / name, *arguments)


if __name__ == "__main__":
    unittest.main()
