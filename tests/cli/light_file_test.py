"""A light file is read as docs/file-formats.md and docs/resampling.md say, by a program that shares no code with isolux."""
import csv
import itertools
import json
import math
import random
import struct
import unittest

from support import CommandLineTest, nrrd_header

SIZE = (14, 12, 11)
POINTS = 150


def field(x, y, z):
    return math.sin(0.9 * x) * math.cos(0.7 * y) + math.sin(0.8 * y) * math.cos(0.6 * z) + 0.3 * math.sin(0.9 * z)


def inverse(rows):
    (a, b, c), (d, e, f), (g, h, i) = rows
    det = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    return [[(e * i - f * h) / det, (c * h - b * i) / det, (b * f - c * e) / det],
            [(f * g - d * i) / det, (a * i - c * g) / det, (c * d - a * f) / det],
            [(d * h - e * g) / det, (b * g - a * h) / det, (a * e - b * d) / det]]


def product(rows, v):
    return [sum(r * x for r, x in zip(row, v)) for row in rows]


def length(v):
    return math.sqrt(sum(x * x for x in v))


class Array:
    """Numbers at the points of a lattice, read trilinearly and from the nearest points outside of it."""

    def __init__(self, size, at):
        self.size, self.at = size, at

    def read(self, index):
        place = [min(max(x, 0.0), n - 1.0) for x, n in zip(index, self.size)]
        low = [min(int(x), max(n - 2, 0)) for x, n in zip(place, self.size)]
        total = None
        for corner in itertools.product((0, 1), repeat=3):
            weight = math.prod(x - l if c else 1 - (x - l) for x, l, c in zip(place, low, corner))
            if weight == 0.0:
                continue
            part = [weight * v for v in self.at(*(l + c for l, c in zip(low, corner)))]
            total = part if total is None else [t + p for t, p in zip(total, part)]
        return total


class Scan:
    def __init__(self, axes, values):
        self.axes, self.to_index = axes, inverse(axes)
        self.spacing = math.prod(length([row[a] for row in axes]) for a in range(3)) ** (1 / 3)
        self.values = Array(SIZE, lambda i, j, k: [values[i + SIZE[0] * (j + SIZE[1] * k)]])
        self.gradients = Array(SIZE, self.gradient_at)

    def gradient_at(self, *index):
        """Central differences, of one side on the faces; in world space."""
        gradient = []
        for a in range(3):
            low, high = list(index), list(index)
            low[a], high[a] = max(index[a] - 1, 0), min(index[a] + 1, SIZE[a] - 1)
            gradient.append((self.values.at(*high)[0] - self.values.at(*low)[0]) / (high[a] - low[a]))
        return [sum(self.to_index[r][c] * gradient[r] for r in range(3)) for c in range(3)]

    def value(self, index):
        return self.values.read(index)[0]

    def normal(self, index):
        gradient = self.gradients.read(index)
        return [-g / length(gradient) for g in gradient]

    def openness(self, index, step):
        gradient = self.gradients.read(index)
        way = product(self.to_index, [n * step * self.spacing for n in self.normal(index)])
        fallen = self.value(index) - self.value([i + w for i, w in zip(index, way)])
        return min(max(fallen / (length(gradient) * self.spacing * step), -1.0), 1.0)


class Light:
    def __init__(self, path, scan, inner):
        fields, _, data = nrrd_header(path)
        self.scan = scan
        sizes = [int(n) for n in fields["sizes"].split()]
        numbers = sizes.pop(0) if len(sizes) == 4 else 1
        self.size = sizes
        values = struct.unpack(f"<{len(data) // 4}f", data)
        both = fields.get("isolux.sides") == "both"
        of_side = numbers // 2 if both else numbers
        first = of_side if inner else 0
        kinds = fields["isolux.texel_numbers"].split() if "isolux.texel_numbers" in fields else []
        self.slope = 1 if "slope" in kinds else None
        self.turn = of_side - 3 if "normal" in kinds else None
        self.raw = lambda i, j, k: values[numbers * (i + sizes[0] * (j + sizes[1] * k)) + first:][:of_side]
        name = "isolux.inner." if inner else "isolux."
        terms = {key: [tuple(map(float, term.split())) for term in fields.get(name + key, "").split(";") if term] for key in
                 ("near_field", "own_near_field")}
        self.own, self.terms = terms["own_near_field"], terms["near_field"] + terms["own_near_field"]
        self.ceiling = float(fields.get(name + "light_ceiling", "inf"))
        self.kept = {}

    def texel(self, *texel):
        """V - S h_i - B . n_i, S and B: what a texel adds is linear in them."""
        if texel not in self.kept:
            centre = [(t + 0.5) / n * (m - 1) for t, n, m in zip(texel, self.size, SIZE)]
            raw = self.raw(*texel)
            value = raw[0] - sum(term[2] * (self.scan.openness(centre, term[0]) - term[1]) for term in self.own)
            slope = raw[self.slope] if self.slope is not None else 0.0
            turn = raw[self.turn:] if self.turn is not None else (0.0, 0.0, 0.0)
            value -= slope * self.scan.value(centre) + sum(b * n for b, n in zip(turn, self.scan.normal(centre)))
            self.kept[texel] = (value, slope, *turn)
        return self.kept[texel]

    def read(self, index):
        value, slope, *turn = Array(self.size, self.texel).read([i / (m - 1) * n - 0.5 for i, n, m in zip(index, self.size, SIZE)])
        e = value + slope * self.scan.value(index) + sum(b * n for b, n in zip(turn, self.scan.normal(index)))
        e += sum(term[2] * (self.scan.openness(index, term[0]) - term[1]) for term in self.terms)
        return min(max(e, 0.0), self.ceiling)


class LightFile(CommandLineTest):
    def scan(self, axes):
        values = struct.pack(f"<{math.prod(SIZE)}f", *(field(i, j, k) for k in range(SIZE[2]) for j in range(SIZE[1]) for i in range(SIZE[0])))
        directions = " ".join("(" + ",".join(str(row[a]) for row in axes) + ")" for a in range(3))
        self.write("scan.nrrd", ("NRRD0004\ntype: float\ndimension: 3\nsizes: %d %d %d\nencoding: raw\nendian: little\nspace dimension: 3\n" % SIZE
                                 + f"space directions: {directions}\nspace origin: (0,0,0)\n\n").encode() + values)
        return Scan(axes, struct.unpack(f"<{math.prod(SIZE)}f", values))

    def test_is_read_as_is_written_of_it(self):
        draw = random.Random(7)
        plain, oblique = [[1, 0, 0], [0, 1, 0], [0, 0, 1]], [[1, 0.3, 0], [-0.2, 2, 0.5], [0.1, 0, 3.5]]
        fit = ("--resampler", "fit")
        for axes, scene, words in ((plain, {}, ()), (oblique, {}, ()), (oblique, {"outer": "higher"}, ()), (plain, {"sides": "both"}, ()),
                                   (oblique, {}, fit), (plain, {"outer": "higher"}, fit), (oblique, {"sides": "both"}, fit),
                                   (plain, {"sides": "both"}, (*fit, "--set", "resampler.slopes=false"))):
            scan = self.scan(axes)
            self.write("scene.json", json.dumps(scene))
            self.succeed("bake", "scan.nrrd", "-o", "light.nrrd", "--scene", "scene.json", "--rays", 8, "--quiet", *words)
            points = [[draw.uniform(0, n - 1) for n in SIZE] for _ in range(POINTS)]
            self.write("points.csv", "x,y,z\n" + "".join("%.17g,%.17g,%.17g\n" % tuple(product(axes, p)) for p in points))
            for side in ("outer", "inner") if "sides" in scene else ("outer",):
                self.succeed("probe", "scan.nrrd", "--light", "light.nrrd", "--points", "points.csv", "-o", "out.csv", "--side", side, "--quiet")
                light = Light(self.path("light.nrrd"), scan, side == "inner")
                self.assertTrue(light.terms)
                with open(self.path("out.csv"), encoding="utf-8") as file:
                    told = [float(row["e"]) for row in csv.DictReader(file)]
                wrong = [abs(light.read(point) - e) for point, e in zip(points, told)]
                # Floats on either side; with the wrong sign of a step or another spacing it is .02 and more.
                self.assertLess(max(wrong), 2e-4, (scene, words, side))


if __name__ == "__main__":
    unittest.main()
