#!/usr/bin/env python3
"""checkerboard_texture.py FILE.exr: writes the texture of scenes/checkerboard.xml.

64 x 64 texels, 2 x 2 squares of 32 texels, light ones reddish at the top left, so that a picture shows which way round
rows and columns are taken. Run it with a Python that has Mitsuba 3, which writes the EXR (half floats).
"""

import argparse
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))
from command import mitsuba_in, needs, run  # noqa: E402

(np,) = needs("numpy")
mi = mitsuba_in("scalar_rgb")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("file", metavar="FILE.exr", type=pathlib.Path, help="to write")
    file = parser.parse_args().file
    file.touch()  # Mitsuba's own errors name no file
    row, column = np.mgrid[0:64, 0:64] // 32
    light = np.where(row == 0, 1.0, 0.75)[..., None] * np.array([0.9, 0.75, 0.6])
    dark = np.full((64, 64, 3), 0.15) * np.array([0.8, 1.0, 1.2])
    texels = np.where((row == column)[..., None], light, dark)
    mi.Bitmap(texels.astype(np.float16)).write(str(file))


if __name__ == "__main__":
    run(main)
