"""The table of cases: what is rendered, what it is measured against, and what it must fulfil."""

import dataclasses
import pathlib
from typing import Callable, Optional, Union

import exact

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = ROOT / "scenes"
REFERENCES = ROOT / "tests" / "references"
SHARED = ROOT.parent / "shared"


@dataclasses.dataclass(frozen=True)
class Figures:
    """Errors over linear R, G and B."""
    mse: float
    mae: float
    max: float


@dataclasses.dataclass(frozen=True)
class Criterion:
    """An option of `parhelion compare` that fails it. `needs_samples`: holds at the default sample count or above."""
    text: str
    option: tuple
    needs_samples: bool = True


def at_most(mse=None, mae=None, largest=None, needs_samples=True):
    """Limits of errors."""
    limits = (("MSE", "--max-mse", mse), ("MAE", "--max-mae", mae), ("max", "--max-error", largest))
    return tuple(Criterion(f"{name} ≤ {value:g}", (option, f"{value:g}"), needs_samples)
                 for name, option, value in limits if value is not None)


def better_than(figures):
    """No error above the baseline's."""
    return at_most(figures.mse, figures.mae, figures.max)


def mean_within(share):
    return (Criterion(f"image mean: 95 % interval within ±{100 * share:g} %", ("--mean-within", f"{share:g}")),)


NOISE_ALONE = (Criterion("MSE = sum of both variances", ("--independent-noise",), False),)
AGREE = (Criterion("image means, 8 × 8 tiles and pixels agree by z", ("--agree",), False),)


@dataclasses.dataclass(frozen=True)
class ImageCase:
    """A render against a reference: an EXR with the variance of its mean, or a picture computed exactly."""
    name: str
    title: str
    text: str
    scene: pathlib.Path
    reference: Union[pathlib.Path, Callable]
    samples: int
    criteria: tuple
    seconds: float  # on two cores with AVX-512, as estimate for the terminal
    size: int = 64
    defines: tuple = ()
    options: tuple = ("--sampler", "independent")  # of which the variance layer is unbiased
    baseline: Optional[Figures] = None
    files: tuple = ()  # that the scene needs besides itself
    noisy: bool = True  # false: the variance layer says nothing about the error

    def needs(self):
        """Files without which the case cannot run."""
        given = [pathlib.Path(value) for _, value in self.defines if value.startswith("/")]
        return [self.scene, *self.files, *given] + ([self.reference] if isinstance(self.reference, pathlib.Path) else [])


@dataclasses.dataclass(frozen=True)
class TestCase:
    """Tests of the suite, run by name: they print what they measured."""
    name: str
    title: str
    text: str
    folder: str  # of tests/
    filter: str
    baseline: str
    seconds: float

    @property
    def program(self):
        """The folder's tests are one program."""
        return f"{self.folder}_tests"


@dataclasses.dataclass(frozen=True)
class SweepCase:
    """Scenes side by side: each further from the first than the one before, without a jump."""
    name: str
    title: str
    text: str
    scenes: tuple
    samples: int
    size: int
    seconds: float


def mitsuba(name):
    return REFERENCES / f"{name}.exr"


def benchmark(name, title, samples, tolerance, seconds, **more):
    text = more.pop("text", "")
    return ImageCase(f"benchmark-{name.replace('_', '-')}", title, text, SHARED / "benchmark" / f"{name}.xml",
                     mitsuba(name), samples, NOISE_ALONE + AGREE + mean_within(tolerance), seconds, **more)


def mitsuba_scene(name, file, text):
    """One of Mitsuba's own test scenes; their constant-light variants are in tests/references."""
    return ImageCase(f"mitsuba-{name.replace('_', '-')}-envmap", f"Mitsuba's test scene {name}, its own sky", text,
                     SHARED / "data" / "mitsuba" / "tests" / "scenes" / "participating_media" / file,
                     mitsuba(f"{name}_envmap"), 1536, NOISE_ALONE + AGREE + mean_within(0.003), 80)


CHECKERBOARD = Figures(5.03e-5, 4.32e-3, 6.34e-2)
FIRST_SKY = Figures(1.69e-5, 2.06e-3, 7.16e-1)
SECOND_SKY = Figures(2.66e-6, 7.42e-4, 3.17e-1)
LIT_MESH = Figures(4.64e-4, 6.82e-3, 4.29e-1)
GRADIENT = Figures(7.92e-10, 1.87e-5, 1.59e-4)
CORNELL = Figures(1.40e-1, 2.41e-2, 14.3)
