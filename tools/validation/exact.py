"""Pictures whose every pixel is known: evaluated in double, from the formulas in scenes/README.md, with no code of the
renderer."""

import math
import xml.etree.ElementTree

import exr

# Gauss-Legendre, four nodes on [0, 1]: a pixel of a smooth gradient is exact to far below a float.
_INNER, _OUTER = math.sqrt(3 / 7 - 2 / 7 * math.sqrt(6 / 5)), math.sqrt(3 / 7 + 2 / 7 * math.sqrt(6 / 5))
_HEAVY, _LIGHT = (18 + math.sqrt(30)) / 72, (18 - math.sqrt(30)) / 72
GAUSS = [(0.5 + s * node / 2, weight) for node, weight in ((_INNER, _HEAVY), (_OUTER, _LIGHT)) for s in (-1, 1)]
SUBDIVISION = 12  # per axis, of pixels that the edge of the gradient crosses


def constant(value):
    """A picture of one value."""
    def write(file, size, scene, defines):
        exr.write(file, size, size, lambda x, y: (value,) * 3)
    return write


def _numbers(text):
    return [float(number) for number in text.replace(",", " ").split()]


def _cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def _unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return [x / length for x in v]


class Camera:
    """Looks along +z of its frame, with +x to the left in the picture; the field of view is horizontal."""

    def __init__(self, sensor):
        look = sensor.find("transform/lookat")
        origin, target, up = (_numbers(look.get(name)) for name in ("origin", "target", "up"))
        self.forward = _unit([t - o for t, o in zip(target, origin)])
        self.left = _unit(_cross(up, self.forward))
        self.up = _cross(self.forward, self.left)
        self.reach = math.tan(math.radians(float(sensor.find("float[@name='fov']").get("value"))) / 2)

    def direction(self, x, y):
        """Through (x, y) of a square film, both in [0, 1], y downwards."""
        left, up = self.reach * (1 - 2 * x), self.reach * (1 - 2 * y)
        return _unit([f + left * l + up * u for f, l, u in zip(self.forward, self.left, self.up)])


class Sky:
    """(1 - t) bottom + t top, t = clamp((d.axis / 2 + offset) / width + 1/2, 0, 1)^power."""

    def __init__(self, emitter):
        axis = emitter.find("vector[@name='axis']")
        self.axis = _unit([float(axis.get(name)) for name in "xyz"])
        self.offset, self.width, self.power = (
            float(emitter.find(f"float[@name='{name}']").get("value")) for name in ("offset", "width", "power"))
        self.bottom, self.top = (
            _numbers(emitter.find(f"rgb[@name='{name}']").get("value")) for name in ("bottom", "top"))

    def position(self, direction):
        """t before it is clamped."""
        height = sum(d * a for d, a in zip(direction, self.axis))
        return (height / 2 + self.offset) / self.width + 0.5

    def mixture(self, direction):
        return min(max(self.position(direction), 0.0), 1.0) ** self.power


def gradient_sky(file, size, scene, defines):
    """The sky of `scene` without its stars: each pixel the integral of the formula over its square."""
    root = xml.etree.ElementTree.parse(scene).getroot()
    camera, sky = Camera(root.find("sensor")), Sky(root.find("emitter[@type='sky']"))

    def integral(x, y, edge):
        return sum(wx * wy * sky.mixture(camera.direction(x + gx * edge, y + gy * edge))
                   for gx, wx in GAUSS for gy, wy in GAUSS)

    def pixel(x, y):
        corners = [sky.position(camera.direction((x + i) / size, (y + j) / size)) for i in (0, 1) for j in (0, 1)]
        low, high = min(corners), max(corners)
        spread = high - low
        crossed = any(low - spread < edge < high + spread for edge in (0.0, 1.0))
        parts = SUBDIVISION if crossed else 1
        edge = 1 / (size * parts)
        t = sum(integral(x / size + i * edge, y / size + j * edge, edge)
                for i in range(parts) for j in range(parts)) / parts**2
        return [(1 - t) * b + t * a for b, a in zip(sky.bottom, sky.top)]

    exr.write(file, size, size, pixel)
