#!/usr/bin/env python3
"""checkerboard_texture.py FILE.exr: writes the texture of scenes/checkerboard.xml.

64 x 64 texels, 2 x 2 squares of 32 texels, light ones reddish at the top left, so that a picture shows which way round
rows and columns are taken. Run it with a Python that has Mitsuba 3, which writes the EXR (half floats).
"""

import sys

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")


def main():
    row, column = np.mgrid[0:64, 0:64] // 32
    light = np.where(row == 0, 1.0, 0.75)[..., None] * np.array([0.9, 0.75, 0.6])
    dark = np.full((64, 64, 3), 0.15) * np.array([0.8, 1.0, 1.2])
    texels = np.where((row == column)[..., None], light, dark)
    mi.Bitmap(texels.astype(np.float16)).write(sys.argv[1])


if __name__ == "__main__":
    main()
