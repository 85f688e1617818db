"""What `render` does for a figure: backgrounds, framing, projections, the direction that is up."""
import struct
import unittest

from support import CommandLineTest, png


class Figures(CommandLineTest):
    def render(self, *more, volume="gen:two-spheres:24", iso=-0.1, size="60x40"):
        self.succeed("render", volume, "--iso", iso, "-o", "i.png", "--size", size, "--report", "report.json", "--quiet", *more)
        return self.path("i.png")

    def silhouette(self, *more, **subject):
        """Columns and rows from and to which something is seen, before black."""
        rows = png(self.render("--background", "0,0,0", "--mode", "normal", *more, **subject))
        xs = [x for row in rows for x, pixel in enumerate(row) if pixel != (0, 0, 0)]
        ys = [y for y, row in enumerate(rows) if any(pixel != (0, 0, 0) for pixel in row)]
        return min(xs), max(xs), min(ys), max(ys)

    def test_stand_before_the_colour_that_is_asked(self):
        self.assertEqual(png(self.render())[0][0], (124, 124, 124))
        self.assertEqual(png(self.render("--background", "255,3,77"))[0][0], (255, 3, 77))
        self.assertEqual(self.report()["settings"]["background"], "255,3,77")
        for wrong in ("white", "1,2", "256,0,0", "-1,0,0", "0.5,0,0", "1,2,nan"):
            self.fail(2, "render", "gen:sphere:8", "--iso", -0.3, "-o", "no.png", "--background=" + wrong, says=("--background", wrong, "transparent"))

    def test_may_be_transparent(self):
        for mode, width in (("local", 60), ("both", 124)):
            self.succeed("bake", "gen:two-spheres:24", "-o", "light.nrrd", "--rays", 1, "--bounces", 0, "--quiet")
            self.render("--background", "transparent", "--mode", mode, "--light", "light.nrrd")
            content = self.read("i.png")
            self.assertEqual(struct.unpack(">2I2B", content[16:26]), (width, 40, 8, 6))  # RGBA

    def test_are_filled_by_the_surface_where_that_is_asked(self):
        """Small balls far apart: in a frame of theirs they reach from side to side, in that of the box they do not."""
        for projection in ("perspective", "orthographic"):
            view = ("--view", "0,0", "--projection", projection)
            left, right, _, _ = self.silhouette(*view)
            self.assertGreater(left, 8)
            self.assertLess(right, 51)
            left, right, top, bottom = self.silhouette(*view, "--frame", "surface")
            self.assertLessEqual(left, 2)
            self.assertGreaterEqual(right, 57)
            self.assertLessEqual(abs(top + bottom - 39), 1)  # in the middle
        self.assertEqual(self.report()["settings"]["frame"], "surface")
        self.assertIn("frame", self.report()["seconds"])
        left, right, _, _ = self.silhouette(*view, "--frame", "surface", "--zoom", 0.5)
        self.assertLessEqual(abs((right - left) - 29), 2)

    def test_have_the_up_that_is_asked(self):
        """The two balls lie beside each other along x: with x up, one above the other."""
        left, right, top, bottom = self.silhouette("--view", "0,0", "--up", "1,0,0", size="50x50")
        self.assertGreater(bottom - top, 1.5 * (right - left))
        for long in ("1e200,0,0", "1e-320,0,0"):
            self.assertEqual(self.silhouette("--view", "0,0", "--up", long, size="50x50"), (left, right, top, bottom))
        self.fail(2, "render", "gen:sphere:8", "--iso", -0.3, "-o", "no.png", "--up", "0,0,0", says=("--up", "a direction"))

    def test_contradictions_are_told(self):
        sphere = ("render", "gen:sphere:8", "--iso", -0.3, "-o", "no.png", "--eye", ".5,.5,.5", "--quiet")
        self.fail(2, *sphere, "--projection", "orthographic", says="--projection orthographic")
        self.assertIn("--frame has no effect with --eye", self.succeed(*sphere, "--frame", "surface", "--size", "8x8").stderr)
        self.fail(2, *sphere[:6], "--zoom", 0, says="--zoom")
        # No surface, no frame of its own.
        self.assertIn("there is no surface", self.succeed("render", "gen:sphere:8", "--iso", 5, "-o", "no.png", "--frame", "surface", "--size", "8x8").stderr)


if __name__ == "__main__":
    unittest.main()
