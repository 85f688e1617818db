"""What `extract` writes of light: on caps, beyond white, as numbers, and in formats without colours."""
import json
import re
import unittest

from support import CommandLineTest, ply

HALF_SKY = {"type": "sky", "up": [1, 0, 0], "zenith": [1, 1, 1], "horizon": [1, 1, 1], "ground": [0, 0, 0]}


class Caps(CommandLineTest):
    def setUp(self):
        super().setUp()
        self.write("scene.json", json.dumps({"environment": HALF_SKY}))

    def cap(self, *light):
        """e and normals of the vertices on the box's faces that are grid points, and what was said."""
        done = self.succeed("extract", "gen:gyroid:17", "--iso", 0.2, "--cap", "-o", "m.ply", "--light-values", *light, "--report", "report.json", "--quiet")
        lines, points, _ = ply(self.path("m.ply"))
        self.assertIn("property float quality", lines)
        grid = [p for p in points if all(abs(16 * x - round(16 * x)) < 1e-4 for x in p[:3])]
        self.assertGreater(len(grid), 200)
        self.assertEqual(self.report()["boundary_edges"], 0)
        return [(p[3:6], p[9]) for p in grid], done.stderr

    def test_have_the_light_of_the_boxs_faces(self):
        """Nothing stands before them: under the half sky e = (1 + n.up)/2."""
        self.succeed("bake", "gen:gyroid:17", "-o", "light.nrrd", "--rays", 4, "--scene", "scene.json", "--quiet")
        for light in (("--light", "light.nrrd"), ("--exact-light", "--rays", 4, "--scene", "scene.json"), ("--exact-light", "--rays", 4, "--light", "light.nrrd")):
            cap, said = self.cap(*light)
            self.assertEqual(said, "", light)
            for (nx, ny, nz), e in cap:
                self.assertAlmostEqual(e, (1 + nx) / 2, delta=2e-3, msg=light)  # of 16384 rays

    def test_are_told_whose_light_they_have(self):
        """A light under a picture does not tell its scene."""
        self.write("sky.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n" + bytes([128, 128, 128, 130]) * 8)  # 2 everywhere
        self.write("picture.json", json.dumps({"environment": {"type": "image", "file": "sky.hdr"}}))
        self.succeed("bake", "gen:gyroid:17", "-o", "light.nrrd", "--rays", 1, "--bounces", 0, "--scene", "picture.json", "--quiet")
        cap, said = self.cap("--light", "light.nrrd")
        self.assertIn("isolux: warning: --cap: the light does not tell its whole scene", said)
        self.assertTrue(all(abs(e - 1) < 1e-5 for _, e in cap))
        cap, said = self.cap("--light", "light.nrrd", "--scene", "picture.json")
        self.assertNotIn("--scene", said)
        self.assertNotIn("no effect", self.cap("--light", "light.nrrd", "--rays", 16)[1])
        self.assertTrue(all(abs(e - 2) < 0.01 for _, e in cap))


class Bright(CommandLineTest):
    def setUp(self):
        super().setUp()
        self.write("scene.json", '{"environment": {"type": "uniform", "radiance": [4, 4, 4]}}')
        self.extract = ("extract", "gen:sphere:12", "--iso", -0.3, "--exact-light", "--rays", 64, "--bounces", 0, "--scene", "scene.json")

    def test_is_told_and_shown_by_exposure(self):
        """White light of 4 and albedo .8 are 3.2: 1.7 stops too much."""
        for exposure in (), ("--exposure", 2), ("--exposure", 1000):
            done = self.succeed(*self.extract, "-o", "m.ply", *exposure)
            self.assertRegex(done.stderr, r"isolux: warning: isovalue -0\.3: (\d+) of \1 vertices are brighter than white: --exposure -1\.7 would show them")
        done = self.succeed(*self.extract, "-o", "m.ply", "--exposure", -1.7, "--report", "report.json", "--light-values")
        self.assertNotIn("warning", done.stderr)
        self.assertEqual(self.report()["settings"]["exposure"], -1.7)
        said = self.succeed("extract", "gen:sphere:12", "--iso=-0.2,-0.3", "-o", "m%d.ply", *self.extract[4:]).stderr
        self.assertEqual(re.findall(r"isovalue (.*): .* are brighter than white", said), ["-0.2", "-0.3"])
        lines, points, _ = ply(self.path("m.ply"))
        self.assertIn("comment exposure=-1.7", lines)
        for p in points:
            self.assertIn(p[6], range(250, 255))  # .985
            self.assertAlmostEqual(p[9], 4, delta=0.1)  # a faint crease may catch one of 64 rays

    def test_colour_has_three_numbers(self):
        self.write("scene.json", '{"environment": {"type": "uniform", "radiance": [1, 0.5, 0.25]}}')
        self.succeed(*self.extract, "-o", "m.ply", "--light-values")
        lines, points, _ = ply(self.path("m.ply"))
        self.assertEqual([line for line in lines if "float e_" in line], [f"property float e_{c}" for c in "rgb"])
        for p in points:
            self.assertAlmostEqual(p[10] / p[9], 0.5, delta=1e-6)


class WithoutColours(CommandLineTest):
    def test_light_is_neither_traced_nor_silent(self):
        self.succeed("bake", "gen:sphere:8", "-o", "light.nrrd", "--rays", 1, "--quiet")
        for light in ("--exact-light",), ("--light", "light.nrrd"):
            done = self.succeed("extract", "gen:sphere:8", "--iso", -0.3, "-o", "m.stl", *light, "--report", "report.json", "--quiet")
            self.assertIn(f"isolux: warning: m.stl: .stl files have no colours: {light[0]} has no effect", done.stderr)
            self.assertNotIn("rays", self.report())
            self.assertNotIn("trace", self.report()["seconds"])

    def test_words_about_them_have_no_effect(self):
        extract = ("extract", "gen:sphere:8", "--iso", -0.3, "--quiet")
        self.assertIn("--exposure has no effect", self.succeed(*extract, "-o", "m.ply", "--exposure", 1).stderr)
        self.assertIn("--light-values has no effect", self.succeed(*extract, "-o", "m.obj", "--light-values", "--exact-light", "--rays", 1).stderr)

    def test_light_of_other_isovalues_is_no_guess(self):
        self.succeed("bake", "gen:sphere:8", "-o", "light.nrrd", "--rays", 1, "--quiet", "--iso-range", "-.2:-.1")
        extract = ("extract", "gen:sphere:8", "--iso", -0.3, "--light", "light.nrrd", "--quiet", "-o")
        self.assertIn("isovalue -0.3 lies outside the range", self.succeed(*extract, "m.ply").stderr)
        self.assertIn("no help to --exact-light", self.succeed(*extract, "a.ply", "--exact-light", "--rays", 1).stderr)

    def test_gives_exact_light_its_scene_and_bounces_as_the_help_says(self):
        usage = " ".join(self.succeed("extract", "--help").stdout.split())
        self.assertIn("(default: those of --light, else uniform white sky, albedo 0.8)", usage)
        self.assertIn("(default: those of --light, else all)", usage)
        usage = " ".join(self.succeed("bake", "--help").stdout.split())
        self.assertIn("(default: uniform white sky, albedo 0.8)", usage)
        self.assertIn("(default: all)", usage)


class Measures(CommandLineTest):
    def test_of_an_open_surface_have_no_volume(self):
        for cap in ((), ("--cap",)):
            self.succeed("extract", "gen:gyroid:12", "--iso", 0.2, "-o", "m.ply", *cap, "--report", "report.json")
            report = self.report()
            self.assertEqual(report["boundary_edges"] == 0, bool(cap))
            self.assertEqual(report["volume"] is None, not cap)


class Notes(CommandLineTest):
    def test_say_where_a_mesh_comes_from(self):
        header = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\nspace: {}\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n\n"
        for space, is_lps in (("left-posterior-superior", True), ("right-anterior-superior", True), ("scanner-xyz", False)):
            self.write("v.nrrd", header.format(space).encode() + bytes(range(8)))
            self.succeed("extract", "v.nrrd", "--iso", 3.5, "-o", "m.ply")
            lines, _, _ = ply(self.path("m.ply"))
            self.assertIn("comment volume=v.nrrd", lines)
            self.assertIn("comment isovalue=3.5", lines)
            self.assertEqual("comment SPACE=LPS" in lines, is_lps, space)
            self.assertFalse(any("albedo" in line for line in lines))


if __name__ == "__main__":
    unittest.main()
