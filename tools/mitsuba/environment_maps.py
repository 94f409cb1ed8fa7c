#!/usr/bin/env python3
"""Writes tests/references/environment_maps.csv, and shared_environment_maps.csv: Mitsuba's envmap by direction.

Each row is a map, a rotation (axis and degrees of `to_world`), a direction, and the colour that Mitsuba 3 evaluates in
single precision. A map "WIDTHxHEIGHT" is made by texel() here and by the test; other names, those of the second table,
are files in the data beside the project.

    tools/mitsuba/environment_maps.py
    tools/mitsuba/environment_maps.py --shared 2000 --output tests/references/shared_environment_maps.csv
    tools/mitsuba/environment_maps.py --shared 100000 --output /tmp/maps.csv  # for tests/nightly/environment_table_test
"""

import argparse
import os
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))
from command import mitsuba_in, needs, number_in, run  # noqa: E402

os.environ.setdefault("DRJIT_LIBLLVM_PATH", "/usr/lib/x86_64-linux-gnu/libLLVM-19.so")

(np,) = needs("numpy")
mitsuba = mitsuba_in("llvm_ad_rgb")

ROOT = pathlib.Path(__file__).resolve().parents[2]
SHARED = ROOT.parent / "shared" / "data" / "environments"
FILES = ["aristea_wreck_puresky_1k.hdr", "noon_grass_1k.hdr", "OrientationLatLong.exr"]
SIZES = [(1, 1), (5, 1), (1, 5), (2, 2), (3, 2), (7, 4), (32, 17), (64, 32)]
ROTATIONS = [(0, 1, 0, 0), (0, 1, 0, 77), (0.48, 0.64, -0.6, 140), (-0.36, 0.48, 0.8, -65)]  # axes of unit length


def texel(i, j, channel, width, height):
    """Exact in single precision; one texel is a million times as bright."""
    value = ((73 * i + 179 * j + 283 * channel + 31 * (i * j % 127)) % 1024 + 1) / 1024
    return value * (1e6 if (i, j) == (width // 3, height // 3) and width > 7 else 1)


def made_map(width, height):
    values = [[[texel(i, j, c, width, height) for c in range(3)] for i in range(width)] for j in range(height)]
    return mitsuba.Bitmap(np.array(values, dtype=np.float32))


def from_uv(u, v):
    """Directions in the map's space of shares of its width and of the way between the poles."""
    return np.stack([np.sin(2 * np.pi * u) * np.sin(np.pi * v), np.cos(np.pi * v),
                     -np.cos(2 * np.pi * u) * np.sin(np.pi * v)], axis=-1)


def directions(width, height, count, random):
    """Centres and edges of texels, the seam, the poles and what is next to them, and random ones."""
    share = count // 5
    column, row = random.integers(0, width, share), random.integers(0, height, share)
    down = max(height - 1, 1)
    centres = from_uv((column + 0.5) / width, row / down)
    edges = from_uv(column / width, np.clip((row + 0.5) / down, 0, 1))
    seam = from_uv(np.where(random.random(share) < 0.5, 1, -1) * 10.0 ** random.uniform(-9, -3, share),
                   random.random(share))
    polar = 10.0 ** random.uniform(-7, -1, share)
    poles = from_uv(random.random(share), np.where(random.random(share) < 0.5, polar, 1 - polar))
    rest = random.normal(size=(count - 4 * share, 3))
    result = np.concatenate([centres, edges, seam, poles, rest])
    result[:2] = [[0, 1, 0], [0, -1, 0]]
    return result / np.linalg.norm(result, axis=1, keepdims=True)


def evaluate(bitmap, rotation, world):
    transform = mitsuba.ScalarTransform4f().rotate(list(rotation[:3]), rotation[3])
    emitter = mitsuba.load_dict({"type": "envmap", "bitmap": bitmap, "to_world": transform})
    interaction = mitsuba.SurfaceInteraction3f()
    interaction.wi = mitsuba.Vector3f(*(-world).T)
    return np.array(emitter.eval(interaction)).T


def matrix(rotation):
    transform = mitsuba.ScalarTransform4f().rotate(list(rotation[:3]), rotation[3])
    return np.array(transform.matrix, dtype=np.float64)[:3, :3]


def rows(name, bitmap, count, random):
    width, height = bitmap.size()
    for rotation in ROTATIONS:
        local = directions(width, height, count // len(ROTATIONS), random)
        world = (local @ matrix(rotation).T).astype(np.float32)
        for direction, colour in zip(world, evaluate(bitmap, rotation, world)):
            yield [name, *(f"{x:.9g}" for x in (*rotation, *direction, *colour))]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--shared", type=number_in(0, 1e9, int), default=0, help="directions for each of the files, none by default")
    parser.add_argument("--output", default=ROOT / "tests" / "references" / "environment_maps.csv")
    arguments = parser.parse_args()
    random = np.random.default_rng(1)
    with open(arguments.output, "w", encoding="ascii") as file:
        print("map,axis x,axis y,axis z,degrees,direction x,direction y,direction z,r,g,b", file=file)
        maps = []
        if arguments.shared == 0:
            maps = [(f"{w}x{h}", made_map(w, h), 100) for w, h in SIZES]
        for name in FILES if arguments.shared else []:
            bitmap = mitsuba.Bitmap(str(SHARED / name))
            maps.append((name, bitmap, arguments.shared))
        for name, bitmap, count in maps:
            for row in rows(name, bitmap, count, random):
                print(",".join(row), file=file)


if __name__ == "__main__":
    run(main)
