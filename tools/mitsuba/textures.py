#!/usr/bin/env python3
"""Writes tests/references/surface_uvs.csv and texture_values.csv: Mitsuba's (u, v) on shapes, and its texture lookups.

A row of the first is a shape as scene text, a ray, and (u, v) where it meets the shape; meshes name the files that
OBJ below holds, which the test writes too. A row of the second is a texture as scene text, (u, v), and the colour that
a surface of that reflectance has there; "$bitmap" is a bitmap of 3 x 2 texels whose channels are BITMAP.

    tools/mitsuba/textures.py
"""

import csv
import pathlib
import random
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))
from command import mitsuba_in, needs, run  # noqa: E402

(numpy,) = needs("numpy")
mitsuba = mitsuba_in("scalar_rgb")

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "tests" / "references"
PLACED = ('<transform name="to_world"><rotate x="0.48" y="0.6" z="-0.64" angle="50"/><scale value="0.7"/>'
          '<translate x="0.3" y="-0.2" z="0.1"/></transform>')
FLIPPED = '<boolean name="flip_normals" value="true"/>'
OBJ = {
    "with_uvs.obj": "v -2 -2 0.2\nv 2 -2 0\nv 0 3 -0.1\nvt 0.1 0.2\nvt 0.9 0.3\nvt 0.4 1.7\nf 1/1 2/2 3/3\n",
    "without_uvs.obj": "v -2 -2 0.2\nv 2 -2 0\nv 0 3 -0.1\nf 1 2 3\n",
}


def obj(name, more=""):
    return f'<shape type="obj"><string name="filename" value="{name}"/>{more}</shape>'


SHAPES = [f'<shape type="{plugin}">{more}</shape>' for plugin in ("rectangle", "cube", "sphere")
          for more in ("", PLACED, FLIPPED)] + [
    '<shape type="sphere"><point name="center" x="0.2" y="-0.1" z="0.3"/><float name="radius" value="0.6"/></shape>',
    obj("with_uvs.obj"), obj("with_uvs.obj", FLIPPED), obj("without_uvs.obj"), obj("without_uvs.obj", FLIPPED),
    obj("with_uvs.obj", '<boolean name="flip_tex_coords" value="false"/>')]
RAYS = 10

BITMAP = numpy.array([[[1, 0, 0.5], [0, 1, 0.25], [0.25, 0.5, 0]], [[0.5, 0.25, 1], [0.125, 0, 0], [0, 0.75, 0.5]]],
                     dtype=numpy.float32)
NEAREST = '<string name="filter_type" value="nearest"/>'


def bitmap(more):
    return f'<texture type="bitmap" name="reflectance"><string name="filename" value="$bitmap"/>{more}</texture>'


def wrap(mode):
    return f'<string name="wrap_mode" value="{mode}"/>'


def to_uv(steps):
    return f'<transform name="to_uv">{steps}</transform>'


CHECKER = ('<texture type="checkerboard" name="reflectance"><rgb name="color0" value="0.8, 0.6, 0.4"/>'
           '<rgb name="color1" value="0.1, 0.2, 0.3"/>{}</texture>')
TEXTURES = [bitmap(filters + wrap(mode)) for filters in ("", NEAREST) for mode in ("repeat", "mirror", "clamp")] + [
    bitmap(to_uv('<scale x="4" y="2"/>')),
    bitmap(to_uv('<scale x="3" y="2"/><rotate z="1" angle="30"/><translate x="0.25" y="0.5"/>')),
    bitmap(NEAREST + to_uv('<translate x="0.25" y="0.4"/><scale value="2"/>')),
    bitmap(to_uv('<matrix value="1 0.5 0.25 7.125 0.1 1 0.5 9.5 0.3 0.2 1 0 0 0 0 1"/>')),
    bitmap(to_uv('<matrix value="1 0.5 0.25 0.1 1 0.5 0 0 1"/>')),
    bitmap(to_uv('<rotate x="1" angle="60"/>')),
    bitmap(to_uv('<scale x="0" y="1"/>')),
    '<texture type="checkerboard" name="reflectance"/>', CHECKER.format(""), CHECKER.format(to_uv('<scale x="3" y="5"/>')),
    CHECKER.format(to_uv('<rotate z="1" angle="45"/><translate x="-0.3"/>'))]
POINTS = [(0.0, 0.0), (1.0, 1.0), (0.5, 0.5), (0.25, 0.75), (-0.1, 1.1), (1.9, -0.6), (2.1, 3.3), (0.01, 0.99),
          (-1.3, 2.6), (0.17, 0.51), (0.62, 0.26), (0.84, 0.93)]


def scene(text):
    return mitsuba.load_string(f'<scene version="3.0.0">{text}</scene>')


def uv_rows(folder):
    generator = random.Random(1)
    for text in SHAPES:
        placed = text
        for name, content in OBJ.items():
            (folder / name).write_text(content)
            placed = placed.replace(f'"{name}"', f'"{folder / name}"')
        shape = scene(placed)
        count = 0
        while count < RAYS:
            origin = [round(generator.uniform(-3, 3), 3) for _ in range(3)]
            direction = [round(generator.uniform(-0.5, 0.5) - o, 3) for o in origin]
            length = numpy.linalg.norm(direction)
            hit = shape.ray_intersect(mitsuba.Ray3f(origin, [d / length for d in direction]))
            if hit.is_valid() and hit.t < 1e4:
                yield [text, *origin, *direction, hit.uv.x, hit.uv.y]
                count += 1


def texture_rows(folder):
    mitsuba.Bitmap(BITMAP).write(str(folder / "bitmap.exr"))
    for text in TEXTURES:
        placed = text.replace("$bitmap", str(folder / "bitmap.exr"))
        bsdf = scene(f'<shape type="rectangle"><bsdf type="diffuse">{placed}</bsdf></shape>').shapes()[0].bsdf()
        for u, v in POINTS:
            hit = mitsuba.SurfaceInteraction3f()
            hit.uv = [u, v]
            hit.wi = [0, 0, 1]
            yield [text, u, v, *numpy.array(bsdf.eval_diffuse_reflectance(hit), dtype=float).tolist()]


def write(name, header, rows):
    with open(FOLDER / name, "w", newline="") as file:
        writer = csv.writer(file, delimiter="|", lineterminator="\n", quotechar="'")
        writer.writerow(header)
        writer.writerows(rows)


def main():
    with tempfile.TemporaryDirectory() as folder:
        write("surface_uvs.csv", ["shape", "ox", "oy", "oz", "dx", "dy", "dz", "u", "v"], uv_rows(pathlib.Path(folder)))
        write("texture_values.csv", ["texture", "u", "v", "r", "g", "b"], texture_rows(pathlib.Path(folder)))


if __name__ == "__main__":
    run(main)
