"""How the values of a volume spread, and isovalues told in that."""
import json
import unittest

from support import CommandLineTest


class Sigma(CommandLineTest):
    def setUp(self):
        super().setUp()
        self.write("v_2x2x2_uint8.raw", bytes([2, 4, 4, 4, 5, 5, 7, 9]))

    def test_says_how_values_spread(self):
        info = json.loads(self.succeed("info", "v_2x2x2_uint8.raw", "--json").stdout)
        self.assertEqual((info["mean"], info["standard_deviation"]), (5, 2))
        said = self.succeed("info", "v_2x2x2_uint8.raw").stdout
        self.assertIn("mean 5, standard deviation 2\n", said)
        self.assertIn("a bar of their logarithm\n", said)

    def test_isovalues_may_be_told_in_standard_deviations(self):
        """Mean 5, standard deviation 2."""
        for text, isovalue in (("0.5sigma", 6), ("-1sigma", 3), ("0sigma", 5), ("5", 5)):
            for command in (("extract", "-o", "m.ply"), ("render", "-o", "i.png", "--size", "8x8")):
                self.succeed(*command, "v_2x2x2_uint8.raw", "--iso=" + text, "--report", "report.json")
                self.assertEqual(self.report()["settings"]["isovalue"], isovalue)
        for wrong in ("sigma", "2 sigmas", "1e40sigma", "nansigma", "2.5rms"):
            self.fail(2, "extract", "v_2x2x2_uint8.raw", "--iso=" + wrong, "-o", "no.ply", says=("--iso", wrong, "a number from -3.4e38"))
        self.fail(2, "extract", "v_2x2x2_uint8.raw", "--iso=3e38sigma", "-o", "no.ply", says=("--iso", "mean of 5"))

    def test_ranges_to_light_may_be_told_so(self):
        for text, ends in (("-1sigma:0.5sigma", [3, 6]), ("4:1sigma", [4, 7]), ("0.5sigma:6", [6, 6]), ("1sigma:1sigma", [7, 7])):
            self.succeed("bake", "v_2x2x2_uint8.raw", f"--iso-range={text}", "-o", "l.nrrd", "--rays", 2, "--quiet", "--report", "report.json")
            self.assertEqual(self.report()["settings"]["iso_range"], ends)
        for wrong in ("1sigma", "1sigma:sigma", "1sigma:0sigma", "1sigma:2sigma:3", "1 sigma:2sigma"):
            self.fail(2, "bake", "gone.nrrd", f"--iso-range={wrong}", "-o", "no.nrrd", says=("--iso-range", wrong))
        self.fail(2, "bake", "v_2x2x2_uint8.raw", "--iso-range=8:1sigma", "-o", "no.nrrd", says="'8:1sigma': LO is above HI (8 and 7)")
        self.fail(2, "bake", "v_2x2x2_uint8.raw", "--iso-range=0:3e38sigma", "-o", "no.nrrd", says="4-byte float")


if __name__ == "__main__":
    unittest.main()
