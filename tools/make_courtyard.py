#!/usr/bin/env python3
"""Writes what scenes/final_cloud.xml is made of: arcade.obj, ashlar.png and paving.png, into FOLDER (default scenes/).

    tools/make_courtyard.py [FOLDER]

The arcade is a wall of round arches on square piers along x, five bays of 2.4 units, with plinths, imposts and a cornice;
its texture coordinates are lengths, one repeat every 1.2 units. The same files every time.
"""
import argparse
import math
import pathlib
import struct
import zlib

from command import run

BAYS, BAY, OPENING, SPRING, HEIGHT, DEPTH = 5, 2.4, 1.64, 2.05, 3.7, 0.56
SEGMENTS = 20
REPEAT = 1.2


class Obj:
    """Quads with normals and texture coordinates; equal vectors are written once."""

    def __init__(self):
        self.lines, self.tables, self.faces = [], {"v": {}, "vt": {}, "vn": {}}, []

    def index(self, kind, vector):
        text = " ".join(f"{x:.5g}" for x in vector)
        table = self.tables[kind]
        if text not in table:
            table[text] = len(table) + 1
            self.lines.append(f"{kind} {text}")
        return table[text]

    def quad(self, corners, uvs, normals):
        triples = zip(corners, uvs, normals)
        self.faces.append("f " + " ".join("/".join(str(self.index(kind, vector)) for kind, vector in zip(("v", "vt", "vn"), triple))
                                          for triple in triples))

    def flat(self, corners, uvs):
        a, b, c = corners[0], corners[1], corners[2]
        u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
        n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        length = math.sqrt(sum(x * x for x in n))
        self.quad(corners, uvs, [[x / length for x in n]] * 4)

    def box(self, low, high):
        (x0, y0, z0), (x1, y1, z1) = low, high
        for corners, axes in (
            ([(x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)], (0, 1)),
            ([(x1, y0, z0), (x0, y0, z0), (x0, y1, z0), (x1, y1, z0)], (0, 1)),
            ([(x1, y0, z1), (x1, y0, z0), (x1, y1, z0), (x1, y1, z1)], (2, 1)),
            ([(x0, y0, z0), (x0, y0, z1), (x0, y1, z1), (x0, y1, z0)], (2, 1)),
            ([(x0, y1, z1), (x1, y1, z1), (x1, y1, z0), (x0, y1, z0)], (0, 2)),
            ([(x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1)], (0, 2)),
        ):
            self.flat(corners, [(c[axes[0]] / REPEAT, c[axes[1]] / REPEAT) for c in corners])

    def write(self, path):
        path.write_text("# Five bays of an arcade; written by tools/make_courtyard.py.\n" + "\n".join(self.lines + self.faces) + "\n")


def arch(obj, center):
    """The wall above an opening, on both faces, and the arch's underside."""
    radius, half = OPENING / 2, DEPTH / 2
    angles = [math.pi * i / SEGMENTS for i in range(SEGMENTS + 1)]
    points = [(center - radius * math.cos(a), SPRING + radius * math.sin(a)) for a in angles]
    for (x0, y0), (x1, y1), a0, a1 in zip(points, points[1:], angles, angles[1:]):
        front = [(x0, y0, half), (x1, y1, half), (x1, HEIGHT, half), (x0, HEIGHT, half)]
        obj.flat(front, [(x / REPEAT, y / REPEAT) for x, y, _ in front])
        back = [(x, y, -half) for x, y, _ in (front[1], front[0], front[3], front[2])]
        obj.flat(back, [(x / REPEAT, y / REPEAT) for x, y, _ in back])
        under = [(x0, y0, -half), (x1, y1, -half), (x1, y1, half), (x0, y0, half)]
        along = [a * radius / REPEAT for a in (a0, a1, a1, a0)]
        normals = [(math.cos(a), -math.sin(a), 0.0) for a in (a0, a1, a1, a0)]
        obj.quad(under, [(z / REPEAT, s) for (_, _, z), s in zip(under, along)], normals)


def arcade():
    obj = Obj()
    half, length = DEPTH / 2, BAYS * BAY
    for bay in range(BAYS):
        arch(obj, -length / 2 + (bay + 0.5) * BAY)
    for pier in range(BAYS + 1):
        center, width = -length / 2 + pier * BAY, (BAY - OPENING) / 2
        low, high = max(center - width, -length / 2), min(center + width, length / 2)
        obj.box((low, 0, -half), (high, SPRING, half))
        obj.box((low, SPRING, -half), (high, HEIGHT, half))
        obj.box((low - 0.06, 0, -half - 0.06), (high + 0.06, 0.3, half + 0.06))
        obj.box((low - 0.05, SPRING - 0.16, -half - 0.05), (high + 0.05, SPRING, half + 0.05))
    for rise, out in ((0.0, 0.06), (0.1, 0.13)):
        obj.box((-length / 2 - out, HEIGHT + rise, -half - out), (length / 2 + out, HEIGHT + rise + 0.1, half + out))
    return obj


def noise(x, y, seed):
    """A number in [0, 1) for a pair of integers."""
    h = (x * 0x8DA6B343 ^ y * 0xD8163841 ^ seed * 0xCB1AB31F) & 0xFFFFFFFF
    h = (h ^ h >> 15) * 0x2C1B3C6D & 0xFFFFFFFF
    h = (h ^ h >> 12) * 0x297A2D39 & 0xFFFFFFFF
    return (h ^ h >> 15) / 2**32


def smooth_noise(x, y, cells, seed):
    """Value noise of period 1 in x and y."""
    x, y = x * cells, y * cells
    i, j = int(x), int(y)
    f, g = x - i, y - j
    f, g = f * f * (3 - 2 * f), g * g * (3 - 2 * g)
    corner = [noise((i + a) % cells, (j + b) % cells, seed) for b in (0, 1) for a in (0, 1)]
    return (corner[0] * (1 - f) + corner[1] * f) * (1 - g) + (corner[2] * (1 - f) + corner[3] * f) * g


def grain(x, y, seed):
    return sum(smooth_noise(x, y, cells, seed + k) * w for k, (cells, w) in enumerate(((5, 0.4), (13, 0.35), (37, 0.25))))


def ashlar(x, y):
    """Courses of pale limestone with thin joints."""
    course = int(y * 4)
    s = x * 2 + 0.5 * (course % 2)
    block, edge = int(s) % 2, min(s % 1, 1 - s % 1) / 2
    joint = min(edge, min(y * 4 % 1, 1 - y * 4 % 1) / 4)
    tone = 0.86 + 0.12 * (noise(block, course, 7) - 0.5) + 0.2 * (grain(x, y, 11) - 0.5)
    tone *= 0.72 + 0.28 * min(1.0, joint / 0.012)
    return tone * 0.93, tone * 0.87, tone * 0.78


def paving(x, y):
    """Squares of light and dark stone set in narrow bands, two by two."""
    u, v = x * 2 % 1, y * 2 % 1
    edge = min(u, 1 - u, v, 1 - v)
    dark = (int(x * 2) + int(y * 2)) % 2 == 1
    tone = 1.0 + 0.34 * (grain(x, y, 23 if dark else 31) - 0.5)
    color = (0.37, 0.30, 0.28) if dark else (0.80, 0.74, 0.66)
    if edge < 0.07:
        color = (0.62, 0.50, 0.40)
    if edge < 0.012 or abs(edge - 0.07) < 0.006:
        color = (0.22, 0.19, 0.17)
    return tuple(tone * c for c in color)


def write_png(path, size, color):
    """An sRGB-coded PNG; levels are multiples of 4, which keeps the file small."""
    rows = bytearray()
    for j in range(size):
        rows.append(0)
        for i in range(size):
            rows += bytes(min(255, max(0, round(255 * c / 4) * 4)) for c in color((i + 0.5) / size, (j + 0.5) / size))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", size, size, 8, 2, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(rows), 9)) + chunk(b"IEND", b""))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("folder", nargs="?", type=pathlib.Path, help="to write into",
                        default=pathlib.Path(__file__).resolve().parent.parent / "scenes")
    folder = parser.parse_args().folder
    arcade().write(folder / "arcade.obj")
    write_png(folder / "ashlar.png", 256, ashlar)
    write_png(folder / "paving.png", 256, paving)


if __name__ == "__main__":
    run(main)
