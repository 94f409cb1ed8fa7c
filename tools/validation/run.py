"""Runs one case: renders, measures, judges."""

import dataclasses
import math
import os
import pathlib
import time
import xml.etree.ElementTree
from typing import Optional

from cases import ROOT, ImageCase, SweepCase, TestCase
from program import Failure, Program


@dataclasses.dataclass
class Check:
    """One criterion and how it went."""
    text: str
    value: str
    passed: bool


@dataclasses.dataclass
class Result:
    case: object
    status: str = "pass"  # pass, fail, skipped, error
    reason: str = ""
    checks: list = dataclasses.field(default_factory=list)
    figures: Optional[dict] = None
    report: Optional[dict] = None
    pictures: list = dataclasses.field(default_factory=list)  # (file, caption)
    commands: list = dataclasses.field(default_factory=list)
    lines: list = dataclasses.field(default_factory=list)
    seconds: float = 0.0

    def judge(self):
        if not all(check.passed for check in self.checks):
            self.status = "fail"


@dataclasses.dataclass(frozen=True)
class Settings:
    program: Program
    out: pathlib.Path
    sample_scale: float = 1.0
    reference: Optional[pathlib.Path] = None  # instead of the case's own


def one_digit(value):
    """Rounded up to 1, 2 or 5 times a power of ten."""
    if not value > 0:
        return 1e-6
    unit = 10.0 ** math.floor(math.log10(value))
    return next(step * unit for step in (1, 2, 5, 10) if value <= step * unit * (1 + 1e-9))


def number_text(value, form):
    """A figure of `parhelion compare --json`, where null stands for what is not finite."""
    return "not finite" if value is None else form.format(value).replace("-", "−")


def family_text(family):
    place = f" in {family['channel']} at ({family['pixel'][0]}, {family['pixel'][1]})" if family["channel"] else ""
    return f"z {number_text(family['z'], '{:.2f}')}{place}, limit {family['threshold']:.2f}"


def agreement_checks(figures):
    names = (("means", "image means by z"), ("tiles", "8 × 8 tiles by z"), ("pixels", "pixels by z"))
    return [Check(name, family_text(figures[key]), figures[key]["passed"]) for key, name in names if figures[key]]


def percent(share):
    """Signed, with three decimals; what rounds to nothing has no sign."""
    text = f"{100 * share:+.3f}"
    return text[1:] if float(text) == 0 else text.replace("-", "−")


def mean_text(figures):
    intervals = [c["ratioConfidence"] or [c["ratio"], c["ratio"]] for c in figures["channels"] if c["ratio"]]
    if not intervals:
        return "–"
    low, high = min(i[0] for i in intervals), max(i[1] for i in intervals)
    return f"{percent(low - 1)} … {percent(high - 1)} %"


def noise_text(figures):
    budget = figures["budget"]
    if not budget:
        return "no noise"
    low, high = budget["ratioConfidence"]
    test = f"z {number_text(budget['z'], '{:.2f}')}, limit {budget['threshold']:.2f}"
    return f"ratio {budget['ratio']:.3f} [{low:.3f}, {high:.3f}], {test}"


def checks_of(criteria, figures):
    """One check a criterion, with what the comparison measured for it."""
    key = {"--max-mse": "maxMse", "--max-mae": "maxMae", "--max-error": "maxError",
           "--mean-within": "meanWithin", "--independent-noise": "independentNoise"}
    described = {"--mean-within": mean_text, "--independent-noise": noise_text}
    measured = {r["id"]: r for r in figures["requirements"]}
    checks = []
    for criterion in criteria:
        option = criterion.option[0]
        if option == "--agree":
            checks += agreement_checks(figures)
            continue
        verdict = measured[key[option]]
        value = described[option](figures) if option in described else number_text(verdict["value"], "{:.3g}")
        checks.append(Check(criterion.text, value, verdict["passed"]))
    if figures["nonFinite"]:
        checks.append(Check("every value finite", f"{figures['nonFinite']} are not", False))
    return checks


def named(file):
    """Relative to the project, whose neighbour the shared data is."""
    return os.path.relpath(file, ROOT)


def missing_file(case, settings):
    for file in case.needs():
        if not file.exists() and not (settings.reference and file == case.reference):
            return file
    return None


def prepare_reference(case, settings):
    if settings.reference:
        return settings.reference
    if isinstance(case.reference, pathlib.Path):
        return case.reference
    file = settings.out / f"{case.name}_exact.exr"
    try:
        case.reference(file, case.size, case.scene, dict(case.defines))
    except xml.etree.ElementTree.ParseError as error:
        raise Failure(f"{case.scene}: {error}") from error
    return file


def captions(case, figures, error_range):
    names = [("b", "reference"), ("a", "Parhelion"),
             ("error", f"signed error, mean of the channels: full red +{error_range:g}, full blue −{error_range:g}")]
    if case.noisy and figures["pixels"]:
        names.append(("z", "z of each pixel, the channel furthest out: full red +4, full blue −4 standard errors"))
    return names


def run_image(case: ImageCase, settings: Settings):
    result = Result(case)
    missing = missing_file(case, settings)
    if missing:
        result.status, result.reason = "skipped", f"{named(missing)} is missing"
        return result
    reference = prepare_reference(case, settings)
    samples = max(2, round(case.samples * settings.sample_scale))
    image = settings.out / f"{case.name}.exr"
    result.report, command = settings.program.render(case.scene, image, samples, case.size, case.defines, case.options)
    result.commands.append(command)
    criteria = [c for c in case.criteria if settings.sample_scale >= 1 or not c.needs_samples]
    figures, command = settings.program.compare(image, reference, [o for c in criteria for o in c.option])
    result.commands.append(command)
    error_range = one_digit(3 * math.sqrt(figures["mse"]))
    prefix = settings.out / case.name
    settings.program.compare(image, reference, (), prefix, error_range)
    result.pictures = [(pathlib.Path(f"{prefix}_{name}.png"), caption)
                       for name, caption in captions(case, figures, error_range)]
    result.figures, result.checks = figures, checks_of(criteria, figures)
    if not criteria:
        result.checks.append(Check("no criterion holds at so few samples", "", False))
    result.judge()
    return result


def run_test(case: TestCase, settings: Settings):
    result = Result(case)
    passed, result.lines, command = settings.program.run_test(case.program, case.filter)
    result.commands.append(command)
    # The first line is the test's figure; seeded defects and moments follow.
    result.checks = [Check("every assertion holds", result.lines[0] if result.lines else "", passed)]
    result.judge()
    return result


def distances(images, settings):
    """Root mean square difference of each picture from the first, and of neighbours."""
    rms = lambda a, b: math.sqrt(settings.program.compare(a, b)[0]["mse"])  # noqa: E731
    return [rms(image, images[0]) for image in images[1:]], [rms(b, a) for a, b in zip(images, images[1:])]


def bake_text(cloud):
    voxels = "×".join(map(str, cloud["resolution"]))
    return f"{voxels} voxels baked in {1000 * cloud['seconds']:.0f} ms, {100 * cloud['occupancy']:.0f} % occupied"


def run_sweep(case: SweepCase, settings: Settings):
    result, images = Result(case), []
    samples = max(2, round(case.samples * settings.sample_scale))
    for scene in case.scenes:
        images.append(settings.out / f"{scene.stem}.exr")
        report, command = settings.program.render(scene, images[-1], samples, case.size, (), ())
        result.report = report
        result.commands.append(command)
        result.pictures.append((images[-1].with_suffix(".png"), f"{scene.stem}: {bake_text(report['clouds'][0])}"))
    from_first, steps = distances(images, settings)
    text = ", ".join(f"{d:.3f}" for d in from_first)
    result.checks.append(Check("ever further from the cube (root mean square)", text,
                               all(a < b for a, b in zip(from_first, from_first[1:]))))
    result.checks.append(Check("no step above two thirds of the sum of steps", ", ".join(f"{s:.3f}" for s in steps),
                               max(steps) <= sum(steps) * 2 / 3))
    result.judge()
    return result


def run_case(case, settings):
    """The result, whatever happens."""
    start = time.monotonic()
    runner = {ImageCase: run_image, TestCase: run_test, SweepCase: run_sweep}[type(case)]
    try:
        result = runner(case, settings)
    except Failure as failure:
        result = Result(case, status="error", reason=str(failure))
    except OSError as error:
        result = Result(case, status="error", reason=f"{error.filename}: {error.strerror}")
    result.seconds = time.monotonic() - start
    return result
