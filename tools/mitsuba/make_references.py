#!/usr/bin/env python3
"""Renders the reference images of tests/references with Mitsuba 3, an independent renderer.

Each image is the mean of K renders with independent seeds. The channels R, G, B hold the mean and
variance.R, variance.G, variance.B the variance of that mean, estimated over the K renders: a
comparison has K - 1 degrees of freedom. The header keeps `seeds` (K) and `samplesPerPixel` (over all
seeds), and what rendered it. Every scene has its number of seeds fixed beforehand: stopping when the error that the
samples themselves show is small enough would bias the mean. A run that was interrupted is continued by the next.

Needs `pip install mitsuba` and a libLLVM (Debian: libllvm19) named by DRJIT_LIBLLVM_PATH.

    tools/mitsuba/make_references.py                     # every scene
    tools/mitsuba/make_references.py furnace --minutes 5 # one scene; after five minutes, what there is so far
"""

import argparse
import math
import os
import pathlib
import sys
import time
import typing

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))
from command import Refusal, mitsuba_in, needs, number_in, run  # noqa: E402

(np,) = needs("numpy")

ROOT = pathlib.Path(__file__).resolve().parents[2]
REFERENCES = ROOT / "tests" / "references"
BENCHMARK = ROOT.parent / "shared" / "benchmark"
MITSUBA_TESTS = ROOT.parent / "shared" / "data" / "mitsuba" / "tests" / "scenes" / "participating_media"

SCENES_FOLDER = ROOT / "scenes"
MAPS = ROOT.parent / "shared" / "data" / "environments"


class Scene(typing.NamedTuple):
    file: pathlib.Path
    samples: int  # per pixel of one seed: its wavefront, size^2 * samples paths, has to fit in memory
    seeds: int  # fixed beforehand; 70 and 226 are what the files hold, which were stopped by their error, as the first 54
    # of cornell_cloud were
    parameters: dict = {}
    sampler: str = "independent"


SCENES = {
    "wdas_sun_sky": Scene(BENCHMARK / "wdas_sun_sky.xml", 64, 70),
    "cornell_cloud": Scene(BENCHMARK / "cornell_cloud.xml", 64, 154),
    "fog_small_light": Scene(BENCHMARK / "fog_small_light.xml", 256, 226),
    "hdr_sky_only": Scene(BENCHMARK / "hdr_sky_only.xml", 1024, 32),
    "bunny_hdr_sky": Scene(BENCHMARK / "bunny_hdr_sky.xml", 512, 32),
    "furnace": Scene(BENCHMARK / "furnace.xml", 64, 32),
    "hetero_sigmat": Scene(REFERENCES / "hetero_sigmat.xml", 64, 32),
    "homo_null": Scene(REFERENCES / "homo_null.xml", 64, 32),
    "cornell_hg_cloud": Scene(SCENES_FOLDER / "cornell_cloud.xml", 64, 40),
    # Independent samples would take a day for the edges of the squares.
    "checkerboard": Scene(SCENES_FOLDER / "checkerboard.xml", 1024, 32, sampler="multijitter"),
    "empty_environment": Scene(SCENES_FOLDER / "empty_environment.xml", 1024, 32),
    "empty_noon_grass": Scene(SCENES_FOLDER / "empty_environment.xml", 1024, 32,
                              {"map": str(MAPS / "noon_grass_1k.hdr")}),
    "bunny_under_sky": Scene(SCENES_FOLDER / "bunny_under_sky.xml", 512, 32),
    "environment_floor": Scene(REFERENCES / "environment_floor.xml", 256, 32),
    "homo_null_envmap": Scene(MITSUBA_TESTS / "test_homo_null_envmap_volpath.xml", 64, 32),
    "hetero_sigmat_envmap": Scene(MITSUBA_TESTS / "test_hetero_sigmat_volpath.xml", 64, 32),
    "color_density": Scene(REFERENCES / "color_density.xml", 64, 32),
}


class Moments:
    """Per-pixel mean and sum of squared deviations over seeds (Welford)."""

    def __init__(self, count=0, mean=0.0, squares=0.0):
        self.count, self.mean, self.squares = count, mean, squares

    def add(self, image):
        self.count += 1
        delta = image - self.mean
        self.mean = self.mean + delta / self.count
        self.squares = self.squares + delta * (image - self.mean)

    def variance_of_mean(self):
        return self.squares / ((self.count - 1) * self.count)

    def image_mean(self):
        return self.mean.mean(axis=(0, 1))

    def image_error(self):
        """Standard error of the image mean, per channel: pixels are independent."""
        variance = self.variance_of_mean()
        return np.sqrt(variance.sum(axis=(0, 1))) / (variance.shape[0] * variance.shape[1])


def read(mi, file, size, spp):
    """What earlier runs left in `file`, or nothing when it is of another size or kind."""
    if not file.exists():
        return Moments()
    bitmap = mi.Bitmap(str(file))
    data, metadata = np.array(bitmap, dtype=np.float64), bitmap.metadata()
    count = int(metadata["seeds"])
    same = data.shape == (size, size, 6) and int(metadata["samplesPerPixel"]) == count * spp
    if not same or metadata["generatedBy"] != origin(mi):
        return Moments()
    return Moments(count, data[:, :, :3], data[:, :, 3:] * count * (count - 1))


def load(mi, scene, size):
    """The scene with its sampler replaced; files are found beside it."""
    if MITSUBA_TESTS in scene.file.parents:
        return mi.load_file(str(scene.file), res=size, spp=scene.samples)
    mi.file_resolver().prepend(str(scene.file.parent))
    text = scene.file.read_text().replace('<sampler type="independent">', f'<sampler type="{scene.sampler}">')
    return mi.load_string(text, size=size, spp=scene.samples, **scene.parameters)


def render(mi, description, size, minutes, moments):
    """Adds seeds up to the scene's number, or until the time is over; two at least, which a variance takes."""
    scene, spp = load(mi, description, size), description.samples
    end = time.monotonic() + 60 * minutes
    while moments.count < description.seeds and (moments.count < 2 or time.monotonic() < end):
        image = np.array(mi.render(scene, spp=spp, seed=1 + moments.count), dtype=np.float64)
        moments.add(image[:, :, :3])  # of the `moment` integrator, too: its first channels
    if moments.count < description.seeds:
        print(f"{moments.count} of {description.seeds} seeds: run it again", file=sys.stderr)


def origin(mi):
    return f"Mitsuba {mi.__version__} {mi.variant()}"


def write(mi, moments, spp, file):
    data = np.concatenate([moments.mean, moments.variance_of_mean()], axis=2).astype(np.float32)
    names = ["R", "G", "B", "variance.R", "variance.G", "variance.B"]
    bitmap = mi.Bitmap(data, mi.Bitmap.PixelFormat.MultiChannel, names)
    metadata = bitmap.metadata()
    metadata["seeds"] = moments.count
    metadata["samplesPerPixel"] = spp * moments.count
    metadata["generatedBy"] = origin(mi)
    unfinished = file.with_suffix(".unfinished.exr")
    bitmap.write(str(unfinished))
    unfinished.replace(file)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help="of " + ", ".join(SCENES))
    parser.add_argument("--size", type=number_in(1, 65536, int), default=64, help="width and height in pixels")
    parser.add_argument("--minutes", type=number_in(0, math.inf), default=math.inf, help="time after which a scene is left unfinished")
    parser.add_argument("--fresh", action="store_true", help="start anew instead of adding seeds to what is there")
    parser.add_argument("--variant", default="llvm_ad_rgb")
    arguments = parser.parse_args()
    unknown = set(arguments.scenes) - set(SCENES)
    if unknown:
        parser.error(f"no scene {', '.join(sorted(unknown))}; there are {', '.join(SCENES)}")

    os.environ.setdefault("DRJIT_LIBLLVM_PATH", "/usr/lib/x86_64-linux-gnu/libLLVM-19.so")
    mi = mitsuba_in(arguments.variant)
    for name in arguments.scenes or SCENES:
        scene = SCENES[name]
        spp = scene.samples
        if not scene.file.exists():
            raise Refusal(f"{scene.file}: missing")
        start = time.monotonic()
        output = REFERENCES / f"{name}.exr"
        moments = Moments() if arguments.fresh else read(mi, output, arguments.size, spp)
        render(mi, scene, arguments.size, arguments.minutes, moments)
        write(mi, moments, spp, output)
        means = zip(moments.image_mean(), moments.image_error())
        print(f"{name}: {moments.count} seeds of {spp} spp, {time.monotonic() - start:.0f} s; image mean",
              " ".join(f"{mean:.5f} +- {100 * error / mean:.2f} %" for mean, error in means), flush=True)


if __name__ == "__main__":
    run(main)
