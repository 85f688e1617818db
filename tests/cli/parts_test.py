"""What of a surface `render` shows: closed at the box, and without its small parts, as `extract` writes it."""
import json
import unittest

from support import CommandLineTest, ply, png

GYROID = "gen:gyroid:17"
FRONT = ("--view", "0,0", "--projection", "orthographic", "--size", "41x41", "--quiet")
HALF_SKY = {"type": "sky", "up": [0, -1, 0], "zenith": [1, 1, 1], "horizon": [1, 1, 1], "ground": [0, 0, 0]}


def boxes(*boxes):
    """16^3 bytes: 200 in each box of whole voxels from .. to, 0 elsewhere. Faces lie in planes of grid points."""
    inside = lambda p: any(all(low <= x <= high for x in p) for low, high in boxes)
    return bytes(200 if inside((i, j, k)) else 0 for k in range(16) for j in range(16) for i in range(16))


class Caps(CommandLineTest):
    def test_have_the_light_of_the_boxs_faces_as_meshes_have(self):
        """Seen from the front under half a sky towards it: e = 1, albedo .8, unless a lamp adds to it."""
        for lights in ([], [{"type": "sphere", "center": [0.5, -3, 0.5], "radius": 1, "radiance": [1, 1, 1]}]):
            self.write("scene.json", json.dumps({"environment": HALF_SKY, "lights": lights}))
            self.succeed("bake", GYROID, "-o", "light.nrrd", "--rays", 2, "--bounces", 0, "--scene", "scene.json", "--quiet")
            words = (GYROID, "--iso", 0.2, "--light", "light.nrrd", "--exposure", -0.1 if lights else 0, "--cap", "--quiet")
            self.succeed("render", *words, "-o", "i.png", *FRONT, "--report", "report.json")
            self.assertGreater(self.report()["rays"], 0)
            self.assertIs(self.report()["settings"]["cap"], True)
            self.succeed("extract", *words, "-o", "m.ply")
            rows = png(self.path("i.png"))
            compared = 0
            for x, y, z, nx, ny, nz, *colour in ply(self.path("m.ply"))[1]:
                if ny > -0.999 or y > 1e-6 or not (0.05 < x < 0.95 and 0.05 < z < 0.95):
                    continue
                column, row = int(41 * x), int(41 * (1 - z))
                around = [rows[row + v][column + u] for u in (-1, 0, 1) for v in (-1, 0, 1)]
                if any(abs(pixel[0] - around[4][0]) > 10 for pixel in around):
                    continue  # an edge of the cap
                self.assertLessEqual(abs(around[4][0] - colour[0]), 6 if lights else 1)  # lamps take 64 rays a place
                compared += 1
            self.assertGreater(compared, 20)

    def test_are_told_whose_light_they_have(self):
        self.write("sky.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n" + bytes([128, 128, 128, 128]) * 8)  # 1/2 everywhere
        self.write("picture.json", json.dumps({"environment": {"type": "image", "file": "sky.hdr"}}))
        self.succeed("bake", GYROID, "-o", "light.nrrd", "--rays", 1, "--bounces", 0, "--scene", "picture.json", "--quiet")
        render = ("render", GYROID, "--iso", 0.2, "-o", "i.png", *FRONT, "--light", "light.nrrd")
        brightest = lambda: max(pixel[0] for row in png(self.path("i.png")) for pixel in row)
        self.assertIn("isolux: warning: --cap: the light does not tell its whole scene", self.succeed(*render, "--cap").stderr)
        self.assertEqual(brightest(), 231)  # .8 of a white sky
        self.assertEqual(self.succeed(*render, "--cap", "--scene", "picture.json").stderr, "")
        self.assertLess(brightest(), 180)
        self.assertIn("--scene has no effect", self.succeed(*render, "--scene", "picture.json").stderr)
        self.assertIn("--scene has no effect", self.succeed(*render, "--cap", "--mode", "local", "--scene", "picture.json").stderr)
        self.fail(1, *render, "--cap", "--scene", "gone.json", says="gone.json")

    def test_have_the_lights_own_scene_where_its_file_tells_it(self):
        self.write("own.json", json.dumps({"environment": {"type": "uniform", "radiance": [0.5, 0.5, 0.5]}}))
        self.write("other.json", json.dumps({"environment": {"type": "uniform", "radiance": [0.9, 0.1, 0.1]}}))
        self.succeed("bake", GYROID, "-o", "light.nrrd", "--rays", 1, "--bounces", 0, "--scene", "own.json", "--quiet")
        for command, output in (("render", "i.png"), ("extract", "i.ply")):
            words = (command, GYROID, "--iso", 0.2, "-o", output, "--light", "light.nrrd", "--cap", "--quiet")
            self.succeed(*words)
            without = self.read(output)
            self.assertIn("--scene has no effect", self.succeed(*words, "--scene", "other.json").stderr)
            self.assertEqual(self.read(output), without)

    def test_close_the_side_that_is_inside(self):
        """All of a box that is inside is a box, for either side; what is outside of it is nothing."""
        for outer, side, full in (("lower", "outer", True), ("lower", "inner", False), ("higher", "outer", False), ("higher", "inner", True)):
            said = self.succeed("render", "gen:sphere:8", "--iso", -5, "-o", "i.png", "--cap", "--outer", outer, "--side", side, "--background", "0,0,0", *FRONT).stderr
            rows = png(self.path("i.png"))
            self.assertEqual(rows[20][20] != (0, 0, 0), full, (outer, side))
            self.assertEqual("there is no surface" in said, not full)

    def test_are_the_same_whichever_way_a_side_is_named(self):
        self.write("both.json", '{"sides": "both"}')
        self.succeed("bake", GYROID, "-o", "both.nrrd", "--scene", "both.json", "--rays", 2, "--quiet")
        pictures = []
        for outer, side in (("lower", "outer"), ("higher", "inner"), ("lower", "inner"), ("higher", "outer")):
            self.succeed("render", GYROID, "--iso", 0.2, "-o", "i.png", "--light", "both.nrrd", "--cap", "--outer", outer, "--side", side, *FRONT)
            pictures.append(self.read("i.png"))
        self.assertEqual(pictures[0], pictures[1])
        self.assertEqual(pictures[2], pictures[3])
        self.assertNotEqual(pictures[0], pictures[2])


class SmallParts(CommandLineTest):
    def test_are_left_out_as_if_they_were_not_there(self):
        self.write("all_16x16x16_uint8.raw", boxes((1, 2), (5, 12)))
        self.write("large_16x16x16_uint8.raw", boxes((5, 12)))
        for isovalue in (100, 200):
            for more in ((), ("--frame", "surface"), ("--cap",), ("--side", "inner")):
                if isovalue == 200 and more == ("--side", "inner"):
                    continue  # what is at most 200 is then all inside: there is no mesh
                pictures = []
                for name, parts in (("all", ()), ("all", ("--min-component", 200)), ("large", ())):
                    self.succeed("render", f"{name}_16x16x16_uint8.raw", "--iso", isovalue, "-o", "i.png", "--size", "60x50", "--quiet", "--report", "report.json", *parts, *more)
                    pictures.append(self.read("i.png"))
                    self.assertEqual(self.report()["settings"].get("min_component"), parts[1] if parts else None)
                self.assertEqual(pictures[1], pictures[2], (isovalue, more))
                self.assertNotEqual(pictures[0], pictures[2], (isovalue, more))

    def test_are_counted_with_their_caps(self):
        """A bar through the box: with its ends closed it has more triangles."""
        self.write("bar_16x16x16_uint8.raw", bytes(200 if 6 <= i <= 9 and 6 <= j <= 9 else 0 for k in range(16) for j in range(16) for i in range(16)))
        bar = ("bar_16x16x16_uint8.raw", "--iso", 100, "--report", "report.json", "--quiet")
        counts = []
        for cap in ((), ("--cap",)):
            self.succeed("extract", *bar, "-o", "m.ply", *cap)
            counts.append(self.report()["triangles"])
        self.assertGreater(counts[1], counts[0])
        for cap, least, shown in (((), counts[0], True), ((), counts[0] + 1, False), (("--cap",), counts[0] + 1, True), (("--cap",), counts[1] + 1, False)):
            self.succeed("render", *bar, "-o", "i.png", "--size", "40x30", "--background", "0,0,0", "--min-component", least, *cap)
            self.assertEqual(any(pixel != (0, 0, 0) for row in png(self.path("i.png")) for pixel in row), shown, (cap, least))

    def test_are_said_to_be_all_too_small(self):
        said = self.succeed("render", "gen:sphere:8", "--iso=-0.3", "-o", "i.png", "--min-component", 100000, *FRONT).stderr
        self.assertIn("no connected part has 100000 triangles", said)
        said = self.succeed("render", "gen:sphere:8", "--iso", 7, "-o", "i.png", "--min-component", 100000, *FRONT).stderr
        self.assertIn("there is no surface", said)
        self.assertNotIn("no connected part", said)
        self.assertEqual(self.succeed("render", "gen:sphere:8", "--iso=-0.3", "-o", "i.png", "--min-component", 10, *FRONT).stderr, "")

    def test_may_differ_from_isovalue_to_isovalue(self):
        self.write("all_16x16x16_uint8.raw", boxes((1, 2), (5, 12)))
        words = ("render", "all_16x16x16_uint8.raw", "--min-component", 30, "--size", "40x30", "--quiet")
        self.succeed(*words, "--iso", "20,100,199", "-o", "i%d.png")
        for i, isovalue in enumerate((20, 100, 199)):
            self.succeed(*words, "--iso", isovalue, "-o", "alone.png")
            self.assertEqual(self.read(f"i{i}.png"), self.read("alone.png"))


if __name__ == "__main__":
    unittest.main()
