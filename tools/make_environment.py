#!/usr/bin/env python3
"""make_environment.py [FILE]: paints scenes/environments/afternoon.hdr, an afternoon sky with a sun, for scenes that need one.

The columns are centred on (i + 1/2) / WIDTH of a turn, the rows lie at j / (HEIGHT - 1) of the way from the zenith to the
nadir: the convention of scenes/README.md. Radiance (.hdr) format, run-length encoded; the same bytes every time.
"""

import argparse
import math
import pathlib

from command import run

WIDTH, HEIGHT = 192, 97
SUN_AZIMUTH, SUN_HEIGHT = math.radians(118), math.radians(34)
SUN_RADIUS = math.radians(2.2)  # a little more than a texel: the painted sun must not flicker between texels
SUN_RADIANCE = (9000.0, 7800.0, 6000.0)


def mix(a, b, t):
    return tuple((1 - t) * x + t * y for x, y in zip(a, b))


def smooth(edge0, edge1, x):
    t = min(max((x - edge0) / (edge1 - edge0), 0.0), 1.0)
    return t * t * (3 - 2 * t)


def lattice(ix, iy, iz):
    """A value in [0, 1) at an integer point."""
    h = (ix * 374761393 + iy * 668265263 + iz * 2147483647) & 0xFFFFFFFF
    h = ((h ^ (h >> 13)) * 1274126177) & 0xFFFFFFFF
    return ((h ^ (h >> 16)) & 0xFFFFFF) / 0x1000000


def noise(x, y, z):
    ix, iy, iz = math.floor(x), math.floor(y), math.floor(z)
    fx, fy, fz = (t * t * (3 - 2 * t) for t in (x - ix, y - iy, z - iz))
    value = 0.0
    for corner in range(8):
        cx, cy, cz = corner & 1, corner >> 1 & 1, corner >> 2
        weight = (fx if cx else 1 - fx) * (fy if cy else 1 - fy) * (fz if cz else 1 - fz)
        value += weight * lattice(ix + cx, iy + cy, iz + cz)
    return value


def clouds(d):
    """How much cloud covers a direction above the horizon: fractal noise on a flat layer."""
    if d[1] <= 0.02:
        return 0.0
    x, z = 1.6 * d[0] / (d[1] + 0.12), 1.6 * d[2] / (d[1] + 0.12)
    value = sum(noise(2**k * x + 7 * k, 2**k * z, 3.7 * k) / 2 ** (k + 1) for k in range(5))
    return smooth(0.50, 0.72, value) * smooth(0.02, 0.18, d[1])


def radiance(d, sun):
    cosine = sum(a * b for a, b in zip(d, sun))
    angle = math.acos(min(max(cosine, -1.0), 1.0))
    zenith, horizon, ground = (0.16, 0.33, 0.78), (0.86, 0.92, 1.0), (0.16, 0.14, 0.11)
    sky = mix(horizon, zenith, max(d[1], 0.0) ** 0.45)
    glow = 0.9 * math.exp(-angle / 0.22) + 6.0 * math.exp(-angle / 0.05)
    sky = tuple(s + glow * g for s, g in zip(sky, (1.0, 0.86, 0.62)))
    lit = 0.75 + 0.5 * max(cosine, 0.0) ** 4
    sky = mix(sky, (1.25 * lit, 1.22 * lit, 1.18 * lit), 0.85 * clouds(d))
    disc = smooth(SUN_RADIUS * 1.3, SUN_RADIUS * 0.7, angle)
    sky = tuple(s + disc * r for s, r in zip(sky, SUN_RADIANCE))
    return mix(ground, sky, smooth(-0.03, 0.03, d[1]))


def rgbe(colour):
    largest = max(colour)
    if largest < 1e-32:
        return (0, 0, 0, 0)
    mantissa, exponent = math.frexp(largest)
    scale = mantissa * 256.0 / largest
    return tuple(int(c * scale) for c in colour) + (exponent + 128,)


def encode(channel):
    """Runs of four and more as (128 + length, value), the rest as (length, values)."""
    out, literal, i = bytearray(), bytearray(), 0
    while i < len(channel):
        run = 1
        while i + run < len(channel) and run < 127 and channel[i + run] == channel[i]:
            run += 1
        if run < 4:
            literal += channel[i:i + run]
        if literal and (run >= 4 or len(literal) > 120 or i + run >= len(channel)):
            out += bytes([len(literal)]) + literal
            literal = bytearray()
        if run >= 4:
            out += bytes([128 + run, channel[i]])
        i += run
    return out


def main():
    folder = pathlib.Path(__file__).resolve().parents[1] / "scenes" / "environments"
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("file", nargs="?", type=pathlib.Path, help="to write", default=folder / "afternoon.hdr")
    output = parser.parse_args().file
    output.parent.mkdir(exist_ok=True)
    sun = (math.cos(SUN_HEIGHT) * math.sin(SUN_AZIMUTH), math.sin(SUN_HEIGHT),
           -math.cos(SUN_HEIGHT) * math.cos(SUN_AZIMUTH))
    content = bytearray(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (HEIGHT, WIDTH))
    for j in range(HEIGHT):
        angle = math.pi * j / (HEIGHT - 1)
        row = []
        for i in range(WIDTH):
            turn = 2 * math.pi * (i + 0.5) / WIDTH
            direction = (math.sin(turn) * math.sin(angle), math.cos(angle), -math.cos(turn) * math.sin(angle))
            row.append(rgbe(radiance(direction, sun)))
        content += bytes([2, 2, WIDTH >> 8, WIDTH & 255])
        for channel in range(4):
            content += encode(bytes(texel[channel] for texel in row))
    output.write_bytes(content)


if __name__ == "__main__":
    run(main)
