#!/usr/bin/env python3
"""Writes tests/references/phase_functions.csv: Mitsuba's phase functions by angle.

Each row is a phase function as scene text, the cosine between the direction of travel before and after, and the value
per steradian that eval_pdf of Mitsuba 3 gives in single precision. The scene text is what both programs read.

    tools/mitsuba/phase_functions.py
"""

import csv
import math
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))
from command import mitsuba_in, run  # noqa: E402

mitsuba = mitsuba_in("scalar_rgb")

TABLE = pathlib.Path(__file__).resolve().parents[2] / "tests" / "references" / "phase_functions.csv"
ANGLES = 21

PHASES = [
    "<phase type='hg'><float name='g' value='0.8'/></phase>",
    "<phase type='rayleigh'/>",
    "<phase type='tabphase'><string name='values' value='0.5, 1, 2, 0.25, 3'/></phase>",
    "<phase type='blendphase'><float name='weight' value='0.3'/><phase type='hg'><float name='g' value='0.85'/></phase>"
    "<phase type='hg'><float name='g' value='-0.3'/></phase></phase>",
    "<phase type='blendphase'><float name='weight' value='0.25'/><phase type='isotropic'/>"
    "<phase type='hg'><float name='g' value='0.6'/></phase></phase>",
]


def value(phase, cosine):
    interaction = mitsuba.MediumInteraction3f()
    interaction.wi = mitsuba.Vector3f(0, 0, -1)  # back to where the light came from: it travels along +z
    interaction.sh_frame = mitsuba.Frame3f(interaction.wi)
    outgoing = mitsuba.Vector3f(math.sqrt(max(0.0, 1 - cosine * cosine)), 0, cosine)
    return float(phase.eval_pdf(mitsuba.PhaseFunctionContext(None), interaction, outgoing)[1])


def main():
    with TABLE.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n", delimiter=";")
        writer.writerow(["phase", "mu", "value"])
        for text in PHASES:
            phase = mitsuba.load_string(text.replace("<phase ", "<phase version='3.0.0' ", 1))
            for i in range(ANGLES):
                cosine = math.cos(math.pi * i / (ANGLES - 1))
                writer.writerow([text, f"{cosine:.12g}", f"{value(phase, cosine):.9g}"])


if __name__ == "__main__":
    run(main)
