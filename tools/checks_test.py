"""Each structure check accepts a small sound tree and finds a violation seeded into it."""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

from source_text import functions

TOOLS = pathlib.Path(__file__).parent

SHADER = """// Phase functions.
#ifndef VOLUME_PHASE_GLSL
#define VOLUME_PHASE_GLSL

layout(set = 0, binding = 1, scalar) readonly buffer Lobes { float lobes[]; };

// Brace { and quote ' in a comment.
float evalPhase(float mu) {
    if (mu > 0.0) { return mu; }
    return 0.0;
}

// Shader only: lanes.
uint lane() { return 0u; }

float samplePhase(float u) { return u; }
#endif
"""
TWIN = """#pragma once
#include "base/math.h"

namespace parhelion::reference {

struct Lobe { float g = 0; };

template <typename Real>
Real evalPhase(Real mu) {
    const auto positive = [](Real x) { return x > 0; };
    return positive(mu) ? mu : 0 * 1'000;
}

/// Reference only: text.
inline const char* name() { return "{"; }

template <typename Real>
Real samplePhase(Real u) { return u; }

}  // namespace parhelion::reference
"""


PARITY = """TEST(Phase, Agrees) {
    Parity value("volume/phase", "evalPhase", 7),
        sample("volume/phase", "samplePhase", 9);
}
"""

HARD_CASES = """# Hard cases

- **H1** g next to 1. Here: products. `parity/phase_test` `Phase.Agrees`.
- **H2** g = 0. The
  tests of H1.
- **H3** Refraction. Here: not
  applicable yet.
"""

PYTHON_CHECKS = ("check_floors.py", "check_hard_cases.py", "check_mirror.py", "check_parity_coverage.py", "check_sizes.py")


class Checks(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.write("shaders/volume/phase.glsl", SHADER)
        self.write("host/reference/volume/phase.h", TWIN)
        self.write("host/base/math.h", "#pragma once\n#include <cmath>\n")
        self.write("host/gpu/device.cpp", '#include <volk.h>\n#include "base/math.h"\n')
        self.write("tests/parity/phase_test.cpp", PARITY)
        self.write("tests/HARD_CASES.md", HARD_CASES)
        self.write("scenes/fog.xml", "<!-- H1 -->\n")
        self.write("tools/make.cpp", "int main() {}\n")
        version = (TOOLS.parent / ".clang-format").read_text().split("\n")[0]
        self.write(".clang-format", version + "\nBasedOnStyle: Google\n")

    def write(self, name, text):
        file = self.root / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)

    def run_check(self, name):
        return subprocess.run([sys.executable, TOOLS / name, self.root], capture_output=True, text=True)

    def assert_finds(self, name, *words):
        result = self.run_check(name)
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        for word in words:
            self.assertIn(word, result.stdout)

    def test_sound_tree_passes(self):
        for name in PYTHON_CHECKS:
            result = self.run_check(name)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_nothing_to_check_is_no_pass(self):
        for folder in ("host", "tests", "shaders"):
            shutil.rmtree(self.root / folder)
        for name in PYTHON_CHECKS:
            result = self.run_check(name)
            self.assertEqual(result.returncode, 2, name)
            self.assertIn("missing", result.stderr)

    def test_parity_coverage_finds_a_function_without_a_record(self):
        self.write("tests/parity/phase_test.cpp", PARITY.replace("samplePhase", "sampleLobe"))
        self.assert_finds("check_parity_coverage.py", "shaders/volume/phase.glsl", "no parity record", "samplePhase")

    def test_parity_coverage_reads_choices(self):
        self.write("tests/parity/phase_test.cpp", PARITY.replace('"evalPhase"', 'isEven() ? "other" : "evalPhase"'))
        self.assertEqual(self.run_check("check_parity_coverage.py").returncode, 0)

    def test_parity_coverage_tells_modules_apart(self):
        self.write("shaders/light/sky.glsl", "float evalPhase(float mu) { return mu; }\n")
        self.assert_finds("check_parity_coverage.py", "shaders/light/sky.glsl: no parity record", "evalPhase")

    def test_hard_cases_finds_one_that_nobody_explains(self):
        self.write("shaders/volume/walk.glsl", "// Planes from the integer cell\n// (H27).\n")
        self.write("tests/unit/walk_test.cpp", "TEST(Walk, EndsH1H28) {}\n")
        self.assert_finds("check_hard_cases.py", "shaders/volume/walk.glsl:2: H27", "tests/unit/walk_test.cpp:1: H28")

    def test_hard_cases_reads_no_other_words(self):
        self.write("tools/words.py", "# H264, RGH4, H4x, PATH9, H0\n")
        self.assertEqual(self.run_check("check_hard_cases.py").returncode, 0)

    def test_hard_cases_finds_tests_that_are_gone(self):
        self.write("tests/HARD_CASES.md", HARD_CASES.replace("Phase.Agrees", "Phase.Differs"))
        self.assert_finds("check_hard_cases.py", "H1 names Phase.Differs")
        self.write("tests/HARD_CASES.md", HARD_CASES.replace("parity/phase_test", "unit/phase_test"))
        self.assert_finds("check_hard_cases.py", "no tests/unit/phase_test.cpp")

    def test_hard_cases_finds_entries_without_a_test_and_twins(self):
        self.write("tests/HARD_CASES.md", HARD_CASES.replace("not\n  applicable yet", "nothing") + "- **H1** The tests of H1.\n")
        self.assert_finds("check_hard_cases.py", "H3 names no test", "H1 has two entries")

    def run_style(self):
        result = subprocess.run(["bash", TOOLS / "check_style.sh", self.root], capture_output=True, text=True)
        if result.returncode == 77:
            self.skipTest(result.stdout)
        return result

    def test_style_finds_what_clang_format_would_change(self):
        for name, text in (("host/base/math.h", "#pragma once\n"), ("host/gpu/device.cpp", "int f();\n"),
                           ("host/reference/volume/phase.h", "#pragma once\n"),
                           ("tests/parity/phase_test.cpp", "int g();\n")):
            self.write(name, text)
        result = self.run_style()
        self.assertEqual(result.returncode, 0, result.stderr)
        self.write("tools/make.cpp", "int  main( ) {}\n")
        result = self.run_style()
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("tools/make.cpp:1", result.stderr)

    def test_style_is_skipped_where_the_formatter_has_another_version(self):
        self.write(".clang-format", "# clang-format 1\nBasedOnStyle: Google\n")
        self.write("tools/make.cpp", "int  main( ) {}\n")
        result = subprocess.run(["bash", TOOLS / "check_style.sh", self.root], capture_output=True, text=True)
        self.assertEqual(result.returncode, 77, result.stderr)
        self.assertIn("clang-format 1,", result.stdout)

    def test_style_without_a_folder_is_no_pass(self):
        shutil.rmtree(self.root / "tests")
        self.assertNotEqual(self.run_style().returncode, 0)

    def test_floors_finds_an_include_of_a_floor_above(self):
        self.write("host/base/text.h", '#include "reference/volume/phase.h"\n')
        self.assert_finds("check_floors.py", "host/base/text.h:1", "reference/volume/phase.h")

    def test_floors_finds_reference_reading_the_renderer(self):
        self.write("host/render/film.h", "")
        self.write("host/reference/volume/more.h", '\n#include "../../render/film.h"\n')
        self.assert_finds("check_floors.py", "host/reference/volume/more.h:2", "render/film.h")

    def test_floors_finds_vulkan_outside_gpu(self):
        self.write("host/render/pass.cpp", "#include <vulkan/vulkan.h>\n")
        self.assert_finds("check_floors.py", "host/render/pass.cpp:1", "vulkan")

    def test_floors_finds_shader_code_in_the_reference(self):
        self.write("host/reference/volume/more.h", '#include "volume/phase.glsl"\n')
        self.assert_finds("check_floors.py", "only shaders/shared")

    def test_mirror_finds_a_missing_twin(self):
        self.write("shaders/light/sky.glsl", "float sky() { return 1.0; }\n")
        self.assert_finds("check_mirror.py", "shaders/light/sky.glsl", "no twin")

    def test_mirror_finds_functions_in_another_order(self):
        swapped = TWIN.replace("evalPhase", "?").replace("samplePhase", "evalPhase").replace("?", "samplePhase")
        self.write("host/reference/volume/phase.h", swapped)
        self.assert_finds("check_mirror.py", "the shader has evalPhase where the reference has samplePhase")

    def test_mirror_finds_a_function_that_lost_its_mark(self):
        self.write("shaders/volume/phase.glsl", SHADER.replace("// Shader only: lanes.\n", ""))
        self.assert_finds("check_mirror.py", "the shader has lane")

    def test_mirror_exempts_a_marked_file(self):
        self.write("shaders/light/state.glsl", "// Path state.\n// Shader only: lanes.\n\nuint s() { return 0u; }\n")
        self.assertEqual(self.run_check("check_mirror.py").returncode, 0)

    def test_sizes_finds_a_long_function(self):
        self.write("host/base/long.cpp", "int f() {\n" + "    ;\n" * 39 + "}\n")
        self.assert_finds("check_sizes.py", "host/base/long.cpp:1: f has 41 lines")

    def test_sizes_finds_a_long_method(self):
        self.write("host/base/long.h", "class C : public B {\npublic:\n    int f() const {\n" + "    ;\n" * 39 + "    }\n};\n")
        self.assert_finds("check_sizes.py", "host/base/long.h:3: f has 41 lines")

    def test_sizes_finds_long_files(self):
        self.write("shaders/light/sky.glsl", "\n" * 151)
        self.write("shaders/kernels/path.comp", "\n" * 41)
        self.write("host/base/long.cpp", "\n" * 301)
        self.assert_finds("check_sizes.py", "sky.glsl: 151", "path.comp: 41", "long.cpp: 301")

    def test_programs_are_those_that_hold_the_chosen_tests(self):
        def programs(*options):
            command = [sys.executable, TOOLS / "programs_of.py", *options]
            return subprocess.run(command, capture_output=True, text=True, check=True).stdout.split()
        self.assertEqual(programs("-R", "^VdbWriter"), ["parhelion", "unit_tests"])
        self.assertEqual(programs("--tests-regex", "OnTheDevice/Slabs.Absorb"), ["parhelion", "statistical_tests"])
        self.assertEqual(programs("-L", "parity"), ["parhelion", "parity_tests"])
        self.assertEqual(programs("-R", "Structure"), ["parhelion"])
        self.assertIn("robustness_tests", programs("-R", "PointStars"))  # by the name of a parameter
        self.assertEqual(programs("--label-exclude", "nightly", "-R", "SlabTable"), [])
        self.assertEqual(programs("--label-exclude", "nightly"), [])  # everything

    def test_dearest_tests_come_with_what_they_prove(self):
        times = self.root / "times.xml"
        times.write_text("""<testsuite><testcase name="Validation.PassesWhatIsRight" time="2.5"/>
            <testcase name="OnTheDevice/Slabs.AbsorbByBeersLaw/Vulkan" time="3.25"/></testsuite>""")
        command = [sys.executable, TOOLS / "dearest_tests.py", times]
        lines = subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip().split("\n")
        self.assertIn("2 tests, which took 6 s", lines[0])
        self.assertIn("3.2 s  OnTheDevice/Slabs.AbsorbByBeersLaw/Vulkan: absorb by beers law", lines[1])
        self.assertIn("passes what is right", lines[2])

    def test_functions_are_told_from_what_looks_like_them(self):
        text = """
            int values[] = {1, 2};
            const auto lambda = [](int x) { return x; };
            enum class Kind { A, B };
            Film::Film(int size) : size_(size), pixels_{size}, more_{} {
                grow();
            }
            bool Film::operator==(const Film& o) const { return true; }
            static std::vector<std::pair<int, int>> pairs(std::function<void(int)> f) noexcept { while (f) { } }
            TEST(Suite, Property) { EXPECT_EQ(R"({)", "}"); }
        """
        self.assertEqual([(f.name, f.lines) for f in functions(text)],
                         [("Film", 3), ("operator==", 1), ("pairs", 1), ("TEST", 1)])


if __name__ == "__main__":
    unittest.main()
