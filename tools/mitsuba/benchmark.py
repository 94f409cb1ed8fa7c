#!/usr/bin/env python3
"""Time, variance and efficiency of Parhelion and of Mitsuba 3 on the same scene files, interleaved.

    tools/mitsuba/benchmark.py [--program build/parhelion] [--rounds 5] [-D name=value] SCENE.xml ...

Needs `pip install mitsuba numpy` and libllvm19 (DRJIT_LIBLLVM_PATH). Every round runs each renderer
once; times are medians over rounds. A pass is one sample per pixel; its time is the difference of
two renders with different sample counts, so that start-up cancels. Variance is that of images with
different seeds, times their samples per pixel, mean over pixels and channels: what a stratified
sampler gains counts. Parhelion's is measured once, on the first of its rows: they render the same paths.
"Trimmed" leaves out the 0.1 % of pixels with the largest variance; every
renderer has the same number of images, since fewer images trim more.
Efficiency is 1 / (variance * time), relative to Mitsuba. Scenes that Mitsuba cannot read (.grid
volumes) get no row for it, and efficiencies relative to the float reference.
"""
import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))
from command import Refusal, mitsuba_in, needs, number_in, run  # noqa: E402

os.environ.setdefault("DRJIT_LIBLLVM_PATH", "/usr/lib/x86_64-linux-gnu/libLLVM-19.so")
(np,) = needs("numpy")
mi = mitsuba_in("llvm_ad_rgb")
TRIM = 0.001
PASSES = {"vulkan": (8, 40), "reference": (2, 10)}
MITSUBA_PASSES = 4
VARIANCE_SEEDS = 12
VARIANCE_SAMPLES = 64  # of Parhelion's images; Mitsuba's samples are independent, whatever their number


def mean_variances(images, samples):
    """Mean over pixels and channels, and the same without the noisiest 0.1 % of pixels."""
    variance = np.var(images, axis=0, ddof=1) * samples
    pixels = np.sort(variance.mean(-1).ravel())
    return pixels.mean(), pixels[: int(len(pixels) * (1 - TRIM))].mean()


class Parhelion:
    def __init__(self, name, program, scene, size, options):
        self.name, self.scene, self.times = name, scene, []
        self.command = [program, "render", scene, "--size", f"{size}x{size}", "--feature-spp", "1", "--json", "--quiet"]
        self.command += options
        self.passes = PASSES["reference" if "reference" in options else "vulkan"]

    def render(self, samples, out, seed):
        done = subprocess.run(self.command + ["--spp", str(samples), "--seed", str(seed), "-o", out],
                              capture_output=True, text=True)
        if done.returncode != 0:
            raise Refusal(done.stderr.strip() or f"{self.command[0]}: exit code {done.returncode}")
        return json.loads(done.stdout)["seconds"]

    def round(self, seed):
        few, many = self.passes
        with tempfile.TemporaryDirectory() as folder:
            out = str(pathlib.Path(folder) / "a.exr")
            start = self.render(few, out, seed)
            end = self.render(many, out, seed)
            self.times.append((end - start) / (many - few))

    def variances(self):
        images = []
        with tempfile.TemporaryDirectory() as folder:
            out = str(pathlib.Path(folder) / "a.exr")
            for seed in range(VARIANCE_SEEDS):
                self.render(VARIANCE_SAMPLES, out, seed)
                bitmap = mi.Bitmap(out)
                names = [field.name for field in bitmap.struct_()]
                images.append(np.array(bitmap)[..., [names.index(c) for c in "RGB"]])
        return mean_variances(images, VARIANCE_SAMPLES)


class Mitsuba:
    def __init__(self, scene, size, defines):
        self.name, self.times = "Mitsuba 3.9.1 llvm_ad_rgb", []
        self.scene = mi.load_file(scene, size=size, **dict(define.split("=", 1) for define in defines))
        self.render(0)

    def render(self, seed):
        start = time.perf_counter()
        image = np.array(mi.render(self.scene, spp=MITSUBA_PASSES, seed=seed))
        return time.perf_counter() - start, image

    def round(self, seed):
        for repeat in range(3):
            seconds, _ = self.render(1 + 3 * seed + repeat)
            self.times.append(seconds / MITSUBA_PASSES)

    def variances(self):
        return mean_variances([self.render(1000 + seed)[1] for seed in range(VARIANCE_SEEDS)], MITSUBA_PASSES)


def benchmark(scene, program, rounds, size, defines):
    given = [word for define in defines for word in ("-D", define)]
    contenders = [Parhelion("Vulkan, 16 lanes", program, scene, size, ["--vector-bits", "512", *given]),
                  Parhelion("Vulkan, 8 lanes", program, scene, size, ["--vector-bits", "256", *given]),
                  Parhelion("float reference", program, scene, size, ["--backend", "reference", *given])]
    try:
        contenders.append(Mitsuba(scene, size, defines))
    except RuntimeError as error:
        print(f"{scene}: not read by Mitsuba: {str(error).splitlines()[0]}", file=sys.stderr)
    for seed in range(rounds):
        for contender in contenders:
            contender.round(seed)
    own = contenders[0].variances()
    rows = [(c.name, 1e3 * statistics.median(c.times), *(own if isinstance(c, Parhelion) else c.variances()))
            for c in contenders]
    unit = rows[-1]
    for name, ms, full, trimmed in rows:
        ratios = [f"{unit[1] * theirs / (ms * ours):.1f}" if ours > 1e-12 else "exact"
                  for theirs, ours in ((unit[2], full), (unit[3], trimmed))]
        print(f"| {pathlib.Path(scene).stem} | {name} | {ms:.1f} | {full:.3g} | {trimmed:.3g} | "
              f"{ratios[0]} | {ratios[1]} |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--program", default="build/parhelion")
    parser.add_argument("--rounds", type=number_in(1, 1e6, int), default=5)
    parser.add_argument("--size", type=number_in(1, 65536, int), default=256)
    parser.add_argument("-D", "--define", action="append", default=[], metavar="NAME=VALUE", help="as of `parhelion`")
    arguments = parser.parse_args()
    for wrong in (define for define in arguments.define if "=" not in define):
        parser.error(f"-D: expected NAME=VALUE; got {wrong}")
    print("| scene | renderer | ms a pass | variance | trimmed | efficiency | trimmed |\n|---|---|---|---|---|---|---|")
    for scene in arguments.scenes:
        benchmark(scene, arguments.program, arguments.rounds, arguments.size, arguments.define)


if __name__ == "__main__":
    run(main)
