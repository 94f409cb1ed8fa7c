"""Writes OpenEXR files: the pictures that are known exactly. Reading is left to the program."""

import struct


def attribute(name, kind, value):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value


def write(file, width, height, pixel):
    """Writes float32 channels R, G, B without compression; pixel(x, y) gives the three, y downwards."""
    channels = b"".join(name + b"\0" + struct.pack("<iiii", 2, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    box = struct.pack("<iiii", 0, 0, width - 1, height - 1)
    header = struct.pack("<ii", 20000630, 2)
    header += attribute("channels", "chlist", channels) + attribute("compression", "compression", b"\0")
    header += attribute("dataWindow", "box2i", box) + attribute("displayWindow", "box2i", box)
    header += attribute("lineOrder", "lineOrder", b"\0") + attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    header += attribute("screenWindowCenter", "v2f", struct.pack("<ff", 0, 0))
    header += attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"
    line = 8 + 12 * width
    first = len(header) + 8 * height
    with open(file, "wb") as out:
        out.write(header + b"".join(struct.pack("<Q", first + y * line) for y in range(height)))
        for y in range(height):
            row = [pixel(x, y) for x in range(width)]
            values = [colour[c] for c in (2, 1, 0) for colour in row]
            out.write(struct.pack("<ii", y, 12 * width) + struct.pack(f"<{3 * width}f", *values))
