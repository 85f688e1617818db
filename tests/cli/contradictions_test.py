"""Command lines that contradict themselves: status 2 before any work; and those of which a part has no effect."""
import unittest

from support import CommandLineTest

BAKE = ("bake", "gone.nrrd", "-o", "l.nrrd")  # nobody may look for the volume: it is not there
RENDER = ("render", "gone.nrrd", "-o", "i.png", "--iso", "-.3")
NEED = (*BAKE, "--sites", "need")


class Contradictions(CommandLineTest):
    def test_are_found_before_the_work(self):
        cases = [
            ((*BAKE, "--sampler", "texels", "--samples", "20"), ("--samples", "texels")),
            ((*BAKE, "--samples", "100", "--resampler", "direct"), ("--samples", "--resampler direct")),
            ((*BAKE, "--sampler", "random", "--resampler", "direct"), ("--resampler direct", "sampler random")),
            ((*BAKE, "--lattice", "voxels", "--texels-a-cell", "2"), ("--lattice voxels", "--texels-a-cell")),
            ((*BAKE, "--lattice", "voxels", "--texels", "auto"), ("--lattice voxels", "--texels auto")),
            ((*BAKE, "--bounce-method", "iterated", "--tracer", "scalar"), ("--bounce-method iterated", "scalar")),
            ((*BAKE, "--set", "resampler.k=3", "resampler.k=5", "--resampler", "cell_grid"), ("--set", "resampler.k is given twice")),
            ((*NEED, "--rmse", ".1", "--time", "1"), ("--sites need", "--time")),
            ((*NEED, "--rmse", ".1", "--tracer", "scalar"), ("--sites need", "--tracer scalar", "wide")),
            ((*NEED, "--rmse", ".1", "--tracer", "wide"), ("--sites need", "--bounce-method iterated")),
            ((*NEED, "--rmse", ".1", "--bounce-method", "paths"), ("--sites need", "--bounce-method paths")),
            ((*NEED, "--rmse", ".1", "--resampler", "cell_grid"), ("--sites need", "--resampler cell_grid")),
            ((*NEED, "--rmse", ".1", "--sampler", "random"), ("--sites need", "sampler random", "not --rmse")),
            ((*NEED, "--rmse", ".1", "--resampler", "fit"), ("--sites need", "resampler fit", "not --rmse")),
            ((*NEED, "--samples", "100", "--time", "1"), ("--sites need", "not --time")),
            ((*NEED, "--resampler", "fit", "--bounce-method", "iterated"), ("--sites need", "--bounce-method paths")),
        ]
        for arguments, said in cases:
            with self.subTest(arguments=arguments):
                self.fail(2, *arguments, says=said)

    def test_are_none_where_the_words_agree(self):
        for more in (("--bounce-method", "iterated", "--tracer", "wide"), ("--lattice", "voxels"), ("--sites", "need", "--rmse", ".1"),
                     ("--sites", "need", "--rmse", ".1", "--tracer", "wide", "--bounce-method", "iterated"),
                     ("--sites", "need", "--rmse", ".1", "--bounces", "0", "--bounce-method", "paths"),
                     ("--sites", "need", "--resampler", "fit"), ("--sites", "need", "--samples", "50"),
                     ("--bounces", "0", "--bounce-method", "iterated", "--tracer", "scalar")):
            with self.subTest(more=more):
                self.fail(1, *BAKE, *more, says="gone.nrrd: no such file")


class WholeNumbers(CommandLineTest):
    def test_are_decimal(self):
        self.succeed("bake", "gen:sphere:8", "-o", "a.nrrd", "--rays", "+010", "--seed", "010", "--threads", "010", "--quiet",
                     "--report", "report.json")
        settings = self.report()["settings"]
        self.assertEqual((settings["rays"], settings["seed"], settings["threads"]), (10, 10, 10))
        self.succeed("bake", "gen:sphere:8", "-o", "b.nrrd", "--rays", "10", "--seed", "10", "--quiet")
        self.assertEqual(self.read("a.nrrd"), self.read("b.nrrd"))

    def test_are_nothing_else(self):
        for option in ("--rays", "--seed", "--threads", "--samples"):
            for text in ("0x10", "0b1", "0o7", "1e3", "1'000", " 5", "-1", "++1", "+", "1.0"):
                with self.subTest(option=option, text=text):
                    self.fail(2, *BAKE, option, text, says=(option, f"'{text}'", "whole number from"))
        self.fail(2, "extract", "gone.nrrd", "--iso", "0", "-o", "m.ply", "--min-component", "0x1", says="--min-component")
        self.fail(2, *RENDER, "--samples", "0x1", says="--samples")


class Messages(CommandLineTest):
    def test_show_all_that_was_given(self):
        for option, text in (("--iso-range", "0:"), ("--iso-range", "nan:1"), ("--iso-range", "a:1")):
            self.fail(2, *BAKE, option, text, says=(f"{option} = '{text}'", "allowed is LO:HI"))
        self.fail(2, *RENDER, "--view", "nan,0", says=("--view = 'nan,0'", "allowed are 2 numbers"))
        self.fail(2, *RENDER, "--eye", "1,,2", says=("--eye = '1,,2'", "allowed are 3 numbers"))
        self.fail(2, "info", "gone.nrrd", "--spacing", "nan,1,1", says=("--spacing = 'nan,1,1'", "allowed are 3 numbers"))

    def test_guess_what_a_beginning_was_meant_to_be(self):
        self.fail(2, "bake", "gen:sphere:4", "--out", "l.nrrd", says="did you mean --output")
        self.fail(2, *BAKE, "--iso-rang", "0:1", says="did you mean --iso-range")

    def test_tell_where_options_go(self):
        for words in (("--quiet", "info", "gen:sphere:4"), ("--", "info", "gen:sphere:4"), ("--frob",)):
            self.fail(2, *words, says=(f"'{words[0]}' before the command", "behind it"))
        said = self.fail(2, "bake", "--", "gen:sphere:8", says="--output is required").stderr
        self.assertNotIn("not known", said)

    def test_name_the_option_that_is_given_nothing(self):
        """CLI11 takes the next word for the value: a report called --quiet, with progress."""
        for words in (("info", "gen:sphere:4", "--report=", "--quiet"), ("bake", "gen:sphere:4", "-o=", "l.nrrd"), (*BAKE, "--rays=", "4"),
                      ("bench", "intersect", "--output=", "results")):
            empty = next(word for word in words if word.endswith("="))
            self.fail(2, *words, says=(f"'{empty}'", "a value is missing"))

    def test_tell_what_a_float_holds(self):
        for words in (("render", "gone.nrrd", "-o", "i.png", "--iso", "1e40"), (*RENDER, "--exposure", "1e308"), (*RENDER, "--exposure", "nan")):
            self.fail(2, *words, says=(f"'{words[-1]}'", "a number from -3.4e38 to 3.4e38"))

    def test_name_what_no_memory_suffices_for(self):
        for words in (("--samples", 1 << 40), ("--texels", "2147483647x2147483647x1")):
            self.fail(1, *BAKE, *words, says=(f"{words[0]} {words[1]}", "GB of memory"))

    def test_refuse_endings_of_no_format_alike(self):
        for words in (("convert", "gone.nrrd", "a.mha"), ("extract", "gone.nrrd", "--iso", 0, "-o", "a.mha"),
                      ("render", "gone.nrrd", "--iso", 0, "-o", "a.mha")):
            self.fail(2, *words, says="a.mha")


class WithoutEffect(CommandLineTest):
    def test_are_words_of_headerless_files_for_others(self):
        layout = ("--dims", "8x8x8", "--type", "float32", "--endian", "little")
        self.succeed("convert", "gen:sphere:8", "s.nrrd")
        self.succeed("convert", "gen:sphere:8", "s_8x8x8_float32.raw")
        for command in (("info",), ("convert", "-", "c.nrrd"), ("bake", "-", "-o", "l.nrrd", "--rays", 1),
                        ("render", "-", "--iso", -0.3, "-o", "i.png", "--size", "20x10"), ("extract", "-", "--iso", -0.3, "-o", "m.ply")):
            for source, words, warned in (("gen:sphere:8", layout, "--dims, --type, --endian have"), ("gen:sphere:8", layout[:4], "--dims, --type have"),
                                          ("s.nrrd", layout[4:], "--endian has"), ("s_8x8x8_float32.raw", layout, None),
                                          ("s_8x8x8_float32.raw", layout[4:], None), ("s.nrrd", (), None)):
                said = self.succeed(command[0], source, *command[2:], *words, "--quiet").stderr
                told = f"isolux: warning: {warned} no effect: {source} is no headerless file\n" if warned else ""
                self.assertEqual(said, told, (command, source, words))

    def test_are_words_of_a_light_that_is_not_given_or_not_shown(self):
        self.succeed("bake", "gen:sphere:8", "-o", "light.nrrd", "--rays", 1, "--quiet")
        light = ("--light", "light.nrrd")
        for words, warned in ((("--exposure", 1), "--exposure"), ((*light, "--mode", "local", "--exposure", 0), "--exposure"),
                              (("--force",), "--force"), ((*light, "--mode", "normal"), "--light"),
                              ((*light, "--exposure", 1, "--force"), None), ((*light, "--mode", "both", "--exposure", 1), None),
                              ((*light, "--mode", "normal", "--side", "outer"), None)):
            said = self.succeed("render", "gen:sphere:8", "--iso", -0.3, "-o", "i.png", "--size", "20x10", *words).stderr
            self.assertEqual(said.startswith(f"isolux: warning: {warned} has no effect"), warned is not None, (words, said))
        said = self.succeed("extract", "gen:sphere:8", "--iso", -0.3, "-o", "m.ply", "--force", "--quiet").stderr
        self.assertIn("--force has no effect", said)

    def test_is_the_scene_of_a_light_that_is_not_traced(self):
        self.succeed("bake", "gen:sphere:8", "-o", "light.nrrd", "--rays", 1, "--quiet")
        self.write("scene.json", "{}")
        extract = ("extract", "gen:sphere:8", "--iso", -0.3, "-o", "m.ply", "--scene", "scene.json", "--quiet")
        said = "isolux: warning: --scene has no effect"
        self.assertIn(said, self.succeed(*extract, "--light", "light.nrrd").stderr)
        self.assertEqual(self.succeed(*extract, "--light", "light.nrrd", "--exact-light", "--rays", 1).stderr, "")
        self.assertIn(said, self.succeed(*extract).stderr)
        self.write("scene.json", '{"outer": "higher"}')
        self.assertEqual(self.succeed(*extract).stderr, "")  # its outer side is the mesh's


if __name__ == "__main__":
    unittest.main()
