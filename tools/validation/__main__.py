"""tools/validate: compares renders with references, case by case, and writes a page about it.

Exit code 0 if every case that could run passed, 1 if one failed, 2 for wrong usage, 130 for Ctrl-C.
"""

import argparse
import os
import pathlib
import sys
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))

import page  # noqa: E402
from cases import ROOT, TestCase  # noqa: E402
from command import Refusal, number_in, run  # noqa: E402
from program import Program  # noqa: E402
from run import Settings, run_case  # noqa: E402
from table import CASES  # noqa: E402

MARKS = {"pass": "passed", "fail": "FAILED", "skipped": "skipped", "error": "ERROR"}


def parse(arguments):
    parser = argparse.ArgumentParser(prog="tools/validate", description=__doc__.split("\n\n")[0],
                                     formatter_class=argparse.ArgumentDefaultsHelpFormatter)
    parser.add_argument("--only", metavar="CASE", action="append", help="this case only; may be repeated")
    parser.add_argument("--list", action="store_true", help="print the names of the cases")
    parser.add_argument("--backend", default="vulkan", choices=("vulkan", "reference", "reference-double"))
    parser.add_argument("--spp-scale", metavar="X", type=number_in(1e-6, 1e6), default=1.0,
                        help="multiplies the sample counts; below 1, limits that need the full count are left out")
    parser.add_argument("--reference", metavar="FILE", type=pathlib.Path,
                        help="measure the one case given by --only against this image instead")
    parser.add_argument("--out", metavar="DIR", type=pathlib.Path, default=ROOT / "validation",
                        help="folder for the results")
    parser.add_argument("--build", metavar="DIR", type=pathlib.Path, default=ROOT / "build",
                        help="a build folder that is used as it is; the default one is brought up to date first")
    parser.add_argument("--targets", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    names = [case.name for case in CASES]
    unknown = set(options.only or ()) - set(names)
    if unknown:
        parser.error(f"no case {', '.join(sorted(unknown))}; there are {', '.join(names)}")
    if options.reference and len(options.only or ()) != 1:
        parser.error("--reference needs exactly one --only")
    if options.reference and not options.reference.is_file():
        parser.error(f"--reference: expected an image; {options.reference} is no file")
    return options


def chosen(options):
    return [case for case in CASES if not options.only or case.name in options.only]


def targets(cases):
    """What has to be built for them: the program, and those of the tests."""
    return ["parhelion", *sorted({case.program for case in cases if isinstance(case, TestCase)})]


def prepare_folder(folder):
    """Makes the folder of the results and that of their images, which it returns."""
    images = folder.resolve() / "images"
    try:
        images.mkdir(parents=True, exist_ok=True)
        unfinished(folder).touch()
        unfinished(folder).unlink()
    except OSError as error:
        raise Refusal(f"--out: expected a folder to write into; got {folder}: {error.strerror}") from error
    return images


def unfinished(folder):
    return folder / "index.unfinished"


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
    cases = chosen(options)
    if options.list or options.targets:
        print("\n".join(targets(cases) if options.targets else [case.name for case in CASES]))
        return 0
    program = Program(options.build.resolve(), ROOT, options.backend)
    if not program.is_there():
        raise Refusal(f"--build: expected a build folder with the program parhelion in it; got {options.build}")
    images = prepare_folder(options.out)
    reference = options.reference.resolve() if options.reference else None
    start = time.monotonic()
    results = run_all(cases, Settings(program, images, options.spp_scale, reference))
    file = options.out / "index.html"
    unfinished(options.out).write_text(page.render(results, time.monotonic() - start, options), encoding="utf-8")
    os.replace(unfinished(options.out), file)
    count = {status: sum(result.status == status for result in results) for status in MARKS}
    print(", ".join(f"{count[status]} {word}" for status, word in MARKS.items() if count[status]) + f"; {file}")
    return 1 if count["fail"] or count["error"] else 0


if __name__ == "__main__":
    run(main)
