#!/usr/bin/env python3
"""tools/make_knot.py FILE.obj: writes the mesh of tests/references/mesh_under_sky.xml.

A trefoil knot of a tube with a wavy section, which shades and lights itself. It stands in the box of the Stanford bunny
as that is usually published, so that either fits the scene. The same file every time.
"""

import argparse
import math

from command import run

ALONG, AROUND = 160, 18
LOWER, UPPER = (-0.0947, 0.0330, -0.0619), (0.0610, 0.1873, 0.0588)


def curve(t):
    """The trefoil, standing upright."""
    radius = 2 + math.cos(3 * t)
    return (radius * math.sin(2 * t), radius * math.cos(2 * t), math.sin(3 * t))


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return tuple(x / length for x in v)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def frame(t):
    """Normal and binormal of the curve; the trefoil has no inflection, so that they turn smoothly."""
    h = 1e-3
    before, here, after = curve(t - h), curve(t), curve(t + h)
    tangent = unit([a - b for a, b in zip(after, before)])
    binormal = unit(cross(tangent, [a - 2 * c + b for a, c, b in zip(after, here, before)]))
    return cross(binormal, tangent), binormal


def vertex(i, j):
    t, angle = 2 * math.pi * i / ALONG, 2 * math.pi * j / AROUND
    normal, binormal = frame(t)
    radius = 0.62 * (1 + 0.10 * math.cos(3 * angle + 6 * t) + 0.05 * math.cos(24 * t))
    return tuple(c + radius * (math.cos(angle) * n + math.sin(angle) * b)
                 for c, n, b in zip(curve(t), normal, binormal))


def fitted(vertices):
    """Scaled and moved into the box, its lowest point on the floor."""
    low, high = ([f(v[k] for v in vertices) for k in range(3)] for f in (min, max))
    scale = min((u - l) / (h - o) for u, l, h, o in zip(UPPER, LOWER, high, low))
    base = [(LOWER[0] + UPPER[0]) / 2 - scale * (low[0] + high[0]) / 2, LOWER[1] - scale * low[1],
            (LOWER[2] + UPPER[2]) / 2 - scale * (low[2] + high[2]) / 2]
    return [tuple(scale * x + b for x, b in zip(v, base)) for v in vertices]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("file", metavar="FILE.obj", help="to write")
    options = parser.parse_args()
    vertices = fitted([vertex(i, j) for i in range(ALONG) for j in range(AROUND)])
    index = lambda i, j: 1 + i % ALONG * AROUND + j % AROUND  # noqa: E731
    with open(options.file, "w", encoding="ascii") as file:
        for v in vertices:
            file.write("v " + " ".join(f"{1000 * x:.3f}".rstrip("0").rstrip(".") + "e-3" for x in v) + "\n")
        for i in range(ALONG):
            for j in range(AROUND):
                a, b, c, d = index(i, j), index(i + 1, j), index(i + 1, j + 1), index(i, j + 1)
                file.write(f"f {a} {c} {b}\nf {a} {d} {c}\n")


if __name__ == "__main__":
    run(main)
