"""extract and render agree about sides; exposure is of the surface; a light is read on its own level set."""
import struct
import unittest

from support import CommandLineTest, ply, png


class Sides(CommandLineTest):
    def test_are_those_of_outer_and_side_together(self):
        """The inner side of what is outside at higher values is the side of lower values."""
        volume = ("gen:gyroid:12", "--iso", 0.1)
        self.write("both.json", '{"sides": "both"}')
        self.succeed("bake", "gen:gyroid:12", "-o", "both.nrrd", "--scene", "both.json", "--rays", 4, "--quiet")
        self.succeed("bake", "gen:gyroid:12", "-o", "lower.nrrd", "--rays", 4, "--quiet")
        for command, end, more in (("extract", ".ply", ()), ("render", ".png", ("--size", "40x30"))):
            pictures = {}
            for light in ("both.nrrd", "lower.nrrd"):
                for outer, side in (("lower", "outer"), ("higher", "inner"), ("lower", "inner"), ("higher", "outer")):
                    words = (command, *volume, "-o", "out" + end, "--light", light, "--outer", outer, "--side", side, *more)
                    if light == "lower.nrrd" and (outer == "lower") != (side == "outer"):
                        self.assertEqual(self.isolux(*words).returncode, 1)  # that side has no light
                        continue
                    self.succeed(*words)
                    pictures[light, outer, side] = self.read("out" + end)
            for light in ("both.nrrd", "lower.nrrd"):
                self.assertEqual(pictures[light, "lower", "outer"], pictures[light, "higher", "inner"], (command, light))
            self.assertEqual(pictures["both.nrrd", "lower", "inner"], pictures["both.nrrd", "higher", "outer"], command)
            self.assertNotEqual(pictures["both.nrrd", "lower", "inner"], pictures["both.nrrd", "lower", "outer"], command)

    def test_turn_the_normals_of_exact_light(self):
        for outer, side, sign in (("lower", "outer", 1), ("lower", "inner", -1), ("higher", "outer", -1), ("higher", "inner", 1)):
            self.succeed("extract", "gen:sphere:8", "--iso", -0.3, "-o", "m.ply", "--exact-light", "--rays", 1, "--outer", outer, "--side", side)
            _, points, _ = ply(self.path("m.ply"))
            for x, y, z, nx, ny, nz, *_ in points:
                self.assertGreater(sign * (nx * (x - 0.5) + ny * (y - 0.5) + nz * (z - 0.5)), 0, (outer, side))


class Exposure(CommandLineTest):
    def test_is_of_the_surface_alone(self):
        self.succeed("bake", "gen:sphere:16", "-o", "light.nrrd", "--rays", 4, "--bounces", 0, "--quiet")
        render = ("render", "gen:sphere:16", "--light", "light.nrrd", "--iso", -0.3, "--size", "40x30")
        pictures = []
        for stops in (0, -2):
            self.succeed(*render, "-o", "i.png", "--exposure", stops)
            pictures.append(png(self.path("i.png")))
        self.assertEqual(pictures[0][0][0], pictures[1][0][0])
        self.assertGreater(pictures[0][15][20][0], pictures[1][15][20][0] + 50)
        self.succeed(*render, "-o", "i.png", "--exposure", -2, "--mode", "both")
        both = png(self.path("i.png"))
        self.assertEqual(both[0][0], both[0][-1])


class LightOfOneLevelSet(CommandLineTest):
    def probe(self, points):
        self.write("points.csv", "".join(f"{x!r},{y!r},{z!r}\n" for x, y, z in points))
        return self.succeed("probe", self.volume, "--light", "light.nrrd", "--points", "points.csv", "-o", "out.csv", "--report",
                            "report.json").stderr

    def test_has_the_points_of_its_own_surface(self):
        """Coordinates are floats, and vertices keep away from grid points: isovalues there differ a little from the level set's."""
        whole = self.whole_numbers("near.nrrd", 0)
        far = self.whole_numbers("far.nrrd", 400)
        for self.volume, isovalue in (("gen:sphere:16", -0.3), ("gen:gyroid:20", 0.7), (whole, 40), (far, 40), (far, 40.25)):
            self.succeed("bake", self.volume, "-o", "light.nrrd", "--rays", 1, "--quiet", "--iso-range", f"{isovalue}:{isovalue}")
            done = self.succeed("extract", self.volume, "--iso", isovalue, "-o", "m.ply", "--light", "light.nrrd")
            self.assertNotIn("warning", done.stderr)
            _, points, _ = ply(self.path("m.ply"))
            self.assertEqual(self.probe([p[:3] for p in points]), "", self.volume)
            self.assertEqual(self.report()["points_outside_iso_range"], 0)

    def test_has_no_others(self):
        self.volume = "gen:sphere:16"
        self.succeed("bake", self.volume, "-o", "light.nrrd", "--rays", 1, "--quiet", "--iso-range", "-.3:-.3")
        self.assertIn("1 of 1 points lie on level sets outside the range", self.probe([(0.5, 0.5, 0.801)]))

    def whole_numbers(self, name, origin):
        """Many voxels have the isovalue. Of voxels of .01 a float at 400 tells 1/330 apart."""
        values = [(7 * x * y + 11 * y * z + 5 * z * x) % 100 for z in range(8) for y in range(8) for x in range(8)]
        self.write(name, "NRRD0004\ntype: float\ndimension: 3\nsizes: 8 8 8\nencoding: raw\nendian: little\nspace dimension: 3\n"
                   "space directions: (.01,0,0) (0,.01,0) (0,0,.01)\n".encode()
                   + f"space origin: ({origin},{origin},{origin})\n\n".encode() + struct.pack("<512f", *values))
        return name


if __name__ == "__main__":
    unittest.main()
