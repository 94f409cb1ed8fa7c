"""tools/validate: compares renders with references, case by case, and writes a page about it.

Exit code 0 if every case that could run passed, 1 if one failed, 2 for wrong usage.
"""

import argparse
import os
import pathlib
import sys
import time

import page
from cases import ROOT, TestCase
from program import Program
from run import Settings, run_case
from table import CASES

MARKS = {"pass": "passed", "fail": "FAILED", "skipped": "skipped", "error": "ERROR"}


def parse(arguments):
    parser = argparse.ArgumentParser(prog="tools/validate", description=__doc__.split("\n\n")[0],
                                     formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("--only", metavar="CASE", action="append", help="this case only; may be repeated")
    parser.add_argument("--list", action="store_true", help="print the names of the cases")
    parser.add_argument("--backend", default="vulkan", choices=("vulkan", "reference", "reference-double"))
    parser.add_argument("--spp-scale", metavar="X", type=float, default=1.0,
                        help="multiplies the sample counts; below 1, limits that need the full count are left out")
    parser.add_argument("--reference", metavar="FILE", type=pathlib.Path,
                        help="measure the one case given by --only against this image instead")
    parser.add_argument("--out", metavar="DIR", type=pathlib.Path, default=ROOT / "validation",
                        help="folder for the results")
    parser.add_argument("--build", metavar="DIR", type=pathlib.Path, default=ROOT / "build", help="the build folder")
    parser.add_argument("--test-programs", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    names = [case.name for case in CASES]
    unknown = set(options.only or ()) - set(names)
    if unknown:
        parser.error(f"no case {', '.join(sorted(unknown))}; there are {', '.join(names)}")
    if not options.spp_scale > 0:
        parser.error(f"--spp-scale must be above 0; got {options.spp_scale:g}")
    if options.reference and len(options.only or ()) != 1:
        parser.error("--reference needs exactly one --only")
    if options.reference and not options.reference.exists():
        parser.error(f"--reference: {options.reference} is missing")
    return options


def test_programs():
    """Those of the test programs that cases run and that exist."""
    return sorted({case.program for case in CASES if isinstance(case, TestCase) and case.source()})


def estimate(seconds):
    return f"{seconds:.0f} s" if seconds < 90 else f"{seconds / 60:.0f} min"


def headline(result):
    """What a line on the terminal has room for."""
    if result.reason:
        return result.reason.splitlines()[0]
    failed = [check for check in result.checks if not check.passed]
    if failed or not result.figures:
        return "; ".join(f"{check.text}: {check.value}" for check in failed or result.checks)
    figures = result.figures
    errors = ", ".join(f"{name} {figures[name.lower()]:.2e}" for name in ("MSE", "MAE", "max"))
    return f"{errors}, mean {page.mean_text(figures)}"


def run_all(cases, settings):
    left, results = sum(case.seconds for case in cases) * max(1.0, settings.sample_scale), []
    print(f"{len(cases)} cases, about {estimate(left)} on two cores")
    start, done = time.monotonic(), 0.0
    for number, case in enumerate(cases, 1):
        print(f"{number:2}/{len(cases)} {case.name:24}", end=" ", flush=True)
        result = run_case(case, settings)
        results.append(result)
        done += case.seconds
        pace = (time.monotonic() - start) / done
        rest = sum(c.seconds for c in cases[number:])
        ahead = f", {estimate(pace * rest)} left" if rest else ""
        print(f"{MARKS[result.status]:8} {headline(result)}  ({result.seconds:.0f} s{ahead})", flush=True)
    return results


def main():
    options = parse(sys.argv[1:])
    if options.list or options.test_programs:
        for name in test_programs() if options.test_programs else [case.name for case in CASES]:
            print(name)
        return 0
    cases = [case for case in CASES if not options.only or case.name in options.only]
    options.out.mkdir(parents=True, exist_ok=True)
    images = options.out.resolve() / "images"
    images.mkdir(exist_ok=True)
    reference = options.reference.resolve() if options.reference else None
    program = Program(options.build.resolve(), ROOT, options.backend)
    start = time.monotonic()
    results = run_all(cases, Settings(program, images, options.spp_scale, reference))
    file = options.out / "index.html"
    unfinished = file.with_suffix(".unfinished")
    unfinished.write_text(page.render(results, time.monotonic() - start, options), encoding="utf-8")
    os.replace(unfinished, file)
    count = {status: sum(result.status == status for result in results) for status in MARKS}
    print(", ".join(f"{count[status]} {word}" for status, word in MARKS.items() if count[status]) + f"; {file}")
    return 1 if count["fail"] or count["error"] else 0


if __name__ == "__main__":
    sys.exit(main())
