"""Several isovalues in one call of `render` and `extract`."""
import os
import unittest

from support import CommandLineTest, png

SMALL = ("--size", "24x16", "--quiet")
SPHERE = "gen:sphere:16"


class Sweeps(CommandLineTest):
    def each_alone(self, command, isovalues, names, *more):
        """What was written for all must be what is written for each alone, and the report's entries what its report says."""
        surfaces = self.report("all.json")["surfaces"]
        self.assertEqual([surface["output"] for surface in surfaces], names)
        for isovalue, name, surface in zip(isovalues, names, surfaces):
            end = os.path.splitext(name)[1]
            self.succeed(command, SPHERE, f"--iso={isovalue}", "-o", "alone" + end, "--report", "alone.json", *more)
            self.assertEqual(self.read(name), self.read("alone" + end), name)
            alone = self.report("alone.json")
            self.assertNotIn("surfaces", alone)
            for entry, value in surface.items():
                if entry not in ("output", "seconds", "settings"):
                    self.assertEqual(value, alone[entry], entry)
            for entry, value in surface["settings"].items():
                self.assertEqual(value, alone["settings"][entry], entry)
            self.assertEqual(surface["settings"]["isovalue"], isovalue)

    def test_draw_what_single_calls_draw(self):
        self.succeed("bake", SPHERE, "-o", "light.nrrd", "--rays", 2, "--quiet")
        for more in ((), ("--light", "light.nrrd", "--mode", "both")):
            self.succeed("render", SPHERE, "--iso=-0.4:-0.2:3", "-o", "f%03d.png", *SMALL, "--report", "all.json", *more)
            self.each_alone("render", [-0.4, -0.3, -0.2], ["f000.png", "f001.png", "f002.png"], *SMALL, *more)
        report = self.report("all.json")
        self.assertEqual((report["output"], report["input"]), ("f%03d.png", SPHERE))
        self.assertGreaterEqual(report["seconds"]["render"], sum(surface["seconds"]["render"] for surface in report["surfaces"]))

    def test_extract_what_single_calls_extract(self):
        self.succeed("bake", SPHERE, "-o", "light.nrrd", "--rays", 2, "--quiet")
        for more in ((), ("--backend", "marching_tetrahedra"), ("--light", "light.nrrd"), ("--exact-light", "--rays", 2),
                     ("--cap", "--min-component", 20, "--light", "light.nrrd")):
            more = (*more, "--quiet")
            # Of falling and rising size, one that is cut by the box, and none at all.
            self.succeed("extract", SPHERE, "--iso=-0.4,-0.1,-0.6,-0.3,5", "-o", "m{iso}.ply", "--report", "all.json", *more)
            isovalues = [-0.4, -0.1, -0.6, -0.3, 5]
            self.each_alone("extract", isovalues, [f"m{isovalue}.ply" for isovalue in isovalues], *more)
        report = self.report("all.json")
        for counted in ("triangles", "vertices", "rays"):
            self.assertEqual(report[counted], sum(surface.get(counted, 0) for surface in report["surfaces"]))

    def test_may_be_told_in_standard_deviations(self):
        self.write("v_2x2x2_uint8.raw", bytes([2, 4, 4, 4, 5, 5, 7, 9]))  # mean 5, standard deviation 2
        self.succeed("extract", "v_2x2x2_uint8.raw", "--iso=-1sigma:1sigma:3,4.5", "-o", "m{iso}.stl", "--report", "all.json", "--quiet")
        said = [(surface["output"], surface["settings"]["isovalue"]) for surface in self.report("all.json")["surfaces"]]
        self.assertEqual(said, [("m-1sigma.stl", 3), ("m0sigma.stl", 5), ("m1sigma.stl", 7), ("m4.5.stl", 4.5)])

    def test_may_be_of_one(self):
        """As in a script that counts; a plain isovalue leaves names as they are."""
        for isovalues in ("-0.3:-0.3:1", "-0.3:5:1"):
            self.succeed("extract", SPHERE, f"--iso={isovalues}", "-o", "m%02d.stl", "--quiet")
            self.succeed("extract", SPHERE, "--iso=-0.3", "-o", "p%02d.stl", "--quiet")
            self.assertEqual(self.read("m00.stl"), self.read("p%02d.stl"))
        self.succeed("extract", SPHERE, "--iso=-0.3:5:1", "-o", "m.stl", "--quiet")
        self.assertEqual(self.read("m00.stl"), self.read("m.stl"))

    def test_are_limited(self):
        self.fail(2, "extract", SPHERE, "--iso=0:1:60000,0:1:60000", "-o", "m%d.stl", says="100000 isovalues at most")

    def test_are_warned_of_in_one_line(self):
        self.succeed("bake", SPHERE, "-o", "light.nrrd", "--rays", 1, "--iso-range=-0.4:-0.3", "--quiet")
        for command, end in (("render", "png"), ("extract", "ply")):
            said = self.succeed(command, SPHERE, "--iso=-0.35,-0.2,3,5,4,-0.25", "-o", f"f%d.{end}", "--light", "light.nrrd", "--quiet").stderr
            self.assertEqual(said.count("\n"), 2, said)
            self.assertIn(f"3 isovalues, 3 to 5, lie outside the values of {SPHERE}", said)
            self.assertIn("2 isovalues, -0.25 to -0.2, lie outside the range -0.4 to -0.3 that the light is of", said)
            said = self.succeed(command, SPHERE, "--iso=5", "-o", f"f.{end}", "--light", "light.nrrd", "--quiet").stderr
            self.assertEqual(said.count("isolux: warning: "), 1, said)  # what is not there has no light that could be missing
            self.assertIn("there is no surface", said)

    def test_share_one_camera(self):
        """In a frame of the surfaces the largest of all reaches from side to side."""
        more = ("--view", "0,0", "--projection", "orthographic", "--frame", "surface", "--background", "0,0,0", "--mode", "normal")
        self.succeed("render", SPHERE, "--iso=-0.2,-0.4,-0.3", "-o", "f%d.png", "--size", "80x80", "--quiet", *more)
        widths = [max(sum(pixel != (0, 0, 0) for pixel in row) for row in png(self.path(f"f{i}.png"))) for i in range(3)]
        for width, part in zip(widths, (1 / 2, 1, 3 / 4)):
            self.assertLessEqual(abs(width - 78 * part), 2, widths)

    def test_need_names_that_are_apart(self):
        for command, end in (("render", "png"), ("extract", "ply")):
            for isovalues, name, says in (("1,2", "f", "need a placeholder"), ("1:2:3", "f%d-{iso}", "one placeholder"), ("1,2", "f%20d", "need a placeholder"),
                                          ("1,2,1.0", "f{iso}", "isovalues number 0 and 2")):
                self.fail(2, command, "gone.nrrd", "--iso", isovalues, "-o", f"{name}.{end}", says=(f"'{name}.{end}'", says))
            for isovalues in ("1:2", "1:2:0", "1:2:3:4", "1:2sigma:3", "1,,2", ",1", "1,nan", "1:2:3.5", ":2:3"):
                self.fail(2, command, "gone.nrrd", "--iso", isovalues, "-o", f"f%d.{end}", says="--iso")
        # Of one isovalue the name is the name.
        self.succeed("render", SPHERE, "--iso", -0.3, "-o", "f%20d%d{iso}.png", *SMALL)
        self.assertTrue(os.path.exists(self.path("f%20d%d{iso}.png")))
        for wrong in ("f.%d", "{iso}"):
            self.fail(2, "render", "gone.nrrd", "--iso", "0.5,0.6", "-o", wrong, says="written as .png")

    def test_replace_no_file_that_is_read_or_written(self):
        self.succeed("bake", SPHERE, "-o", "light.nrrd", "--rays", 1, "--quiet")
        os.rename(self.path("light.nrrd"), self.path("1.ply"))
        self.fail(2, "extract", SPHERE, "--iso=-0.3,-0.4", "-o", "%d.ply", "--light", "1.ply", says="--light, which is read")
        self.fail(2, "extract", SPHERE, "--iso=-0.3,-0.4", "-o", "a%d.ply", "--report", "a1.ply", says="is written there")
        os.symlink("l1.ply", self.path("l0.ply"))
        self.fail(2, "extract", SPHERE, "--iso=-0.3,-0.4", "-o", "l%d.ply", says="another of its files")
        self.fail(1, "extract", SPHERE, "--iso=-0.3,-0.4", "-o", "gone%d/m.ply", says="there is no folder gone0")


if __name__ == "__main__":
    unittest.main()
