"""Bad input: one line on stderr, the right exit status, no output file left."""
import math
import os
import re
import struct
import unittest

from support import CommandLineTest


class HeaderlessFiles(CommandLineTest):
    def test_need_to_be_told_their_size_and_type(self):
        self.write("x.raw", bytes(64))
        for command in (("info", "x.raw"), ("bake", "x.raw", "-o", "l.nrrd"), ("convert", "x.raw", "v.nrrd"),
                        ("extract", "x.raw", "--iso", 1, "-o", "m.ply")):
            self.fail(2, *command, says=("x.raw", "--dims", "--type"))
        self.fail(1, "info", "none.raw", says="none.raw: no such file")
        self.succeed("info", "x.raw", "--dims", "4x4x4", "--type", "uint8")


class BadCommandLine(CommandLineTest):
    def test_is_status_2_and_named(self):
        cases = [
            ((), "subcommand"),
            (("frobnicate",), "frobnicate"),
            (("bake",), "VOLUME"),
            (("bake", "gen:sphere:8"), "--output"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--bonces", "1"), "--bounces"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--bounces", "-1"), "--bounces"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--bounces", "many"), "many"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--rays", "0"), "--rays"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--rays", "ten"), "ten"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--texels", "4x4"), "NXxNYxNZ"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--texels", "4x0x4"), "4x0x4"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--texels", "aut"), "auto"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--texels", "4x4x4", "--texels-a-cell", "2"), "--texels excludes"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--error-grid", "e.nrrd", "--rays", "1"), "--error-grid"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--sites", "need"), "--rmse"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--iso-range", "5:1"), "5:1"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--iso-range", "nan:1"), "nan"),
            (("info", "gen:sphere:8", "--set-reader", "nrd.key=1"), "nrrd"),
            (("info", "gen:sphere:8", "--set-reader", "nrrd.key=1"), "key"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--lattice", "edges"), "edges"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--quality", "best"), "best"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--rmse", "0"), "--rmse"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--resampler", "cel_grid"), "did you mean 'cell_grid'"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--sampler", "poisson"), "stratified"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--tracer", "embree"), "scalar"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--resampler", "cell_grid", "--set", "resampler.kk=3"), "kk"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--resampler", "cell_grid", "--set", "resampler.k=-2"), "k = '-2'"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--set", "oven.k=3"), "resampler"),
            (("extract", "gen:sphere:8", "-o", "m.fbx", "--iso", "-0.3"), "m.fbx: meshes are written as .ply"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--set", "k"), "key=value"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--threads", "0"), "--threads"),
            (("bake", "x.raw", "-o", "l.nrrd", "--dims", "4x4x4"), "--type"),
            (("bake", "x.raw", "-o", "l.nrrd", "--dims", "4x4x4", "--type", "uint7"), "uint7"),
            (("bake", "x.raw", "-o", "l.nrrd", "--spacing", "1,2"), "--spacing"),
            (("convert", "gen:sphere:8", "x.raw"), "x_8x8x8_float32.raw"),
            (("convert", "gen:sphere:8", "x_8x8x9_uint8.raw"), ": x_8x8x8_uint8.raw"),
            (("extract", "gen:sphere:8", "-o", "m.ply"), "--iso"),
            (("extract", "gen:sphere:8", "-o", "m.ply", "--iso", "high"), "high"),
            (("extract", "gen:sphere:8", "-o", "m.ply", "--iso", "nan"), "nan"),
            (("render", "gen:sphere:8", "-o", "i.png", "--iso", "inf"), "inf"),
            (("extract", "gen:sphere:8", "-o", "m.ply", "--iso", "-.3", "--min-component", "-3"), "--min-component"),
            (("extract", "gen:sphere:8", "-o", "m.ply", "--iso", "-.3", "--backend", "flying"), "marching_cubes"),
            (("extract", "gen:sphere:8", "-o", "m.ply", "--iso", "-.3", "--normals", "exact"), "accurate"),
            (("render", "gen:sphere:8", "-o", "i.png", "--iso", "-.3", "--size", "0x5"), "0x5"),
            (("render", "gen:sphere:8", "-o", "i.png", "--iso", "-.3", "--view", "30"), "--view"),
            (("render", "gen:sphere:8", "-o", "i.png", "--iso", "-.3", "--mode", "global"), "--light"),
            (("render", "gen:sphere:8", "-o", "i.png", "--iso", "-.3", "--side", "both"), "--side"),
            (("render", "gen:sphere:8", "-o", "i.png", "--iso", "-.3", "--eye", "1,2"), "--eye"),
            (("probe", "gen:sphere:8", "-o", "o.csv", "--points", "p.csv"), "--light"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--rmse", "nan"), "a number above 0"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--time", "nan"), "a number above 0"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--texels-a-cell", "nan"), "a number from 0.125 to 8"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--bounces", "99999999999"), "from 0 to 2147483647"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--seed", "-1"), "--seed: '-1'"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--seed", "99999999999999999999"), "whole number"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--iso-range", "0:1e300"), "--iso-range"),
            # What a script's unset variable leaves is not a default.
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--scene", ""), "--scene"),
            (("bake", "gen:sphere:8", "-o", "l.nrrd", "--iso-range", ""), "--iso-range"),
            (("bake", "gen:sphere:8", "-o", ""), "--output"),
            (("bake", "", "-o", "l.nrrd"), "VOLUME"),
            (("render", "gen:sphere:8", "-o", "i.png", "--iso", "-.3", "--exposure", "nan"), "--exposure"),
            (("render", "gen:sphere:8", "-o", "i.jpg", "--iso", "-.3"), "i.jpg: pictures are written as .png"),
            (("render", "gen:sphere:8", "-o", "i.png", "--iso", "-.3", "--size", "30000x30000"), "--size"),
            (("render", "gen:sphere:8", "-o", "i.png", "--iso", "-.3", "--size", "2147483647x2147483647"), "--size"),
            (("convert", "gen:sphere:8", "v.nrrd", "--replace-nonfinite", "none"), "--replace-nonfinite"),
            (("extract", "--iso", "-.3", "--set", "k=1", "gen:sphere:8", "-o", "m.ply"), "--set: 'gen:sphere:8'"),
            (("extract", "gen:sphere:8", "-o", "m.ply", "--isso", "-.3"), "did you mean --iso"),
        ]
        for arguments, said in cases:
            with self.subTest(arguments=arguments):
                self.fail(2, *arguments, says=said)


class BadVolume(CommandLineTest):
    def bake(self, volume, *more, says):
        with self.subTest(volume=volume):
            self.fail(1, "bake", volume, "-o", "light.nrrd", "--rays", 1, "--quiet", *more, says=says)
            self.fail(1, "extract", volume, "-o", "mesh.ply", "--iso", 1, *more, says=says)

    def nrrd(self, name, header, data=b""):
        return self.write(name, ("NRRD0004\n" + header + "\n\n").encode() + data)

    def test_missing_empty_and_unknown_files(self):
        self.bake("nowhere.nrrd", says="nowhere.nrrd")
        self.write("empty.nrrd", b"")
        self.bake("empty.nrrd", says="empty.nrrd")
        self.write("letter.txt", b"Dear reader")
        self.bake("letter.txt", says="letter.txt")
        os.mkdir(self.path("folder"))
        self.bake("folder", says="folder")

    def test_broken_headers(self):
        good = "type: float\ndimension: 3\nsizes: 4 4 4\nencoding: raw\nendian: little"
        data = struct.pack("<64f", *range(64))
        self.nrrd("short.nrrd", good, data[:-1])
        self.bake("short.nrrd", says=("short.nrrd", "256", "255"))
        self.nrrd("type.nrrd", good.replace("float", "quaternion"), data)
        self.bake("type.nrrd", says=("type.nrrd", "quaternion"))
        self.nrrd("overflow.nrrd", good.replace("4 4 4", "4294967296 4294967296 4294967296"), data)
        self.bake("overflow.nrrd", says="overflow.nrrd")
        self.nrrd("negative.nrrd", good.replace("4 4 4", "4 -4 4"), data)
        self.bake("negative.nrrd", says=("negative.nrrd", "-4"))
        self.nrrd("gzip.nrrd", good.replace("raw", "gzip"), data)
        self.bake("gzip.nrrd", says="gzip.nrrd")
        self.nrrd("outside.nhdr", good + "\ndata file: /etc/passwd")
        self.bake("outside.nhdr", says=("/etc/passwd", "--allow-external-data"))
        self.write("name_4x4x4_float32.raw", data[:-4])
        self.bake("name_4x4x4_float32.raw", says=("256", "252"))

    def test_useless_values(self):
        def raw(name, dims, values):
            self.write(name, struct.pack(f"<{len(values)}f", *values))

        raw("nan_2x2x2_float32.raw", 2, [0, 1, 2, 3, math.nan, 5, 6, 7])
        self.bake("nan_2x2x2_float32.raw", says=("nan_2x2x2", "not finite", "0,0,1"))
        raw("inf_2x2x2_float32.raw", 2, [0, 1, 2, 3, -math.inf, 5, 6, 7])
        self.bake("inf_2x2x2_float32.raw", says=("inf_2x2x2", "not finite"))
        self.succeed("bake", "nan_2x2x2_float32.raw", "-o", "fixed.nrrd", "--rays", 1, "--replace-nonfinite", 0, "--quiet")
        os.remove(self.path("fixed.nrrd"))
        raw("flat_2x1x4_float32.raw", 2, list(range(8)))
        self.bake("flat_2x1x4_float32.raw", says=("2x1x4", "at least 2"))
        raw("constant_2x2x2_float32.raw", 2, [7] * 8)
        self.fail(1, "bake", "constant_2x2x2_float32.raw", "-o", "light.nrrd", says=("every voxel is 7", "constant"))
        self.fail(1, "bake", "gen:sphere:8", "-o", "light.nrrd", "--iso-range", "5:6", says="5:6")

    def test_generated_volumes_are_checked_too(self):
        self.bake("gen:spere:16", says=("spere", "sphere"))
        self.bake("gen:sphere:1", says="1")
        self.bake("gen:sphere:-5", says="-5")
        self.bake("gen:sphere:1e9", says="1e9")
        self.bake("gen:sphere:99999", says="99999")

    def test_spacings_beyond_a_fit_are_told_in_words(self):
        self.fail(1, "bake", "gen:gyroid:8", "--spacing", "1e-37,1,1", "-o", "light.nrrd", "--resampler", "fit", "--bounces", 0, "--rays", 4, "--quiet",
                  says=("spacings", "orders of magnitude"))


class BadScene(CommandLineTest):
    def test_is_named_with_its_key(self):
        cases = [
            ("{", "not JSON"),
            ("[]", "object"),
            ('{"albdeo": [1, 1, 1]}', "did you mean 'albedo'"),
            ('{"albedo": 0.5}', "albedo"),
            ('{"albedo": [1, 1]}', "albedo"),
            ('{"albedo": [1, 1, 1.5]}', "from 0 to 1"),
            ('{"albedo": [1, 1, -1]}', "albedo"),
            ('{"albedo": {"by_isovalue": []}}', "by_isovalue"),
            ('{"albedo": {"by_isovalue": [[2, 0, 0, 0], [1, 0, 0, 0]]}}', "rise"),
            ('{"environment": {"type": "sun"}}', "uniform, sky, image"),
            ('{"environment": {"type": "uniform", "radience": [1, 1, 1]}}', "did you mean 'radiance'"),
            ('{"environment": {"type": "sky", "up": [0, 0, 0]}}', "no direction"),
            ('{"lights": {}}', "array"),
            ('{"lights": [{"type": "lamp"}]}', "lights[0]"),
            ('{"lights": [{"type": "sphere", "center": [0, 0, 0], "radius": -1, "radiance": [1, 1, 1]}]}', "lights[0].radius"),
            ('{"lights": [{"type": "sun", "irradiance": [1, 1, 1]}]}', "'direction' is missing"),
            ('{"lights": [{"type": "sun", "direction": [0, 0, 1], "irradiance": [1, 1, 1], "angular_diameter_deg": 120}]}',
             "at most 90"),
            ('{"outer": "inner"}', "lower, higher"),
            ("", "empty"),
            ('{"albedo": [1e999, 0, 0]}', "too large"),
            ('{"lights": [{"type": "rectangle", "center": [0, 0, 2], "u": [1, 0, 0], "v": [2, 0, 0], "radiance": [1, 1, 1]}]}',
             "lights[0]: u and v are parallel"),
        ]
        for text, said in cases:
            with self.subTest(scene=text):
                self.write("scene.json", text)
                self.fail(1, "bake", "gen:sphere:8", "-o", "light.nrrd", "--scene", "scene.json", says=("scene.json", said))
        self.fail(1, "bake", "gen:sphere:8", "-o", "light.nrrd", "--scene", "gone.json", says="gone.json")
        self.write("scene.json", '{"environment": {"type": "image", "file": "gone.hdr"}}')
        self.fail(1, "bake", "gen:sphere:8", "-o", "light.nrrd", "--scene", "scene.json", says="gone.hdr")

    def test_light_beyond_floats_is_laid_to_the_scene(self):
        self.write("scene.json", '{"emission": [1e38, 1e38, 1e38]}')
        self.fail(1, "bake", "gen:gyroid:8", "-o", "light.nrrd", "--scene", "scene.json", "--rays", 4, "--quiet",
                  says=("radiance is infinite", "the scene's radiance, irradiance or emission"))

    def test_a_picture_that_ends_early_is_not_half_black(self):
        self.write("scene.json", '{"environment": {"type": "image", "file": "sky.hdr"}}')
        header = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 4\n"
        self.write("sky.hdr", header + bytes([128, 128, 128, 129]) * 16)
        self.succeed("bake", "gen:sphere:8", "-o", "whole.nrrd", "--scene", "scene.json", "--rays", 1, "--quiet")
        for pixels in (0, 1, 8, 15):
            self.write("sky.hdr", header + bytes([128, 128, 128, 129]) * pixels)
            self.fail(1, "bake", "gen:sphere:8", "-o", "light.nrrd", "--scene", "scene.json", says=("sky.hdr", "ends early"))
        # Runs: a scanline of 16 pixels is 2 2 0 16 and for each of four channels a run or a dump.
        header = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 16\n"
        line = bytes([2, 2, 0, 16] + [128 + 16, 128] * 3 + [16] + [129] * 16)
        self.write("sky.hdr", header + 2 * line)
        self.succeed("bake", "gen:sphere:8", "-o", "whole.nrrd", "--scene", "scene.json", "--rays", 1, "--quiet")
        for size in range(len(line), 2 * len(line)):
            self.write("sky.hdr", header + (2 * line)[:size])
            self.fail(1, "bake", "gen:sphere:8", "-o", "light.nrrd", "--scene", "scene.json", says=("sky.hdr", "ends early"))


class BadOutput(CommandLineTest):
    def test_a_grid_or_a_name_that_cannot_be_is_found_before_the_work(self):
        self.fail(1, "bake", "gen:sphere:8", "-o", "l.nrrd", "--texels", "20000x20000x20000",
                  says=("--texels 20000x20000x20000: that takes 32000.0 GB", "this machine has"))
        said = self.fail(1, "bake", "gen:sphere:8", "-o", "x" * 300 + ".nrrd", says="File name too long").stderr
        self.assertNotIn("texels from", said)
        self.succeed("bake", "gen:sphere:8", "--rays", 1, "--quiet", "-o", "x" * 250 + ".nrrd")

    def test_a_folder_that_is_not_there(self):
        self.fail(1, "bake", "gen:sphere:8", "-o", "gone/light.nrrd", "--rays", 1, "--quiet", says="gone")
        self.fail(1, "extract", "gen:sphere:8", "--iso", -0.3, "-o", "gone/mesh.ply", says="gone")
        self.fail(1, "render", "gen:sphere:8", "--iso", -0.3, "-o", "gone/image.png", "--size", "8x8", says="gone")

    def test_an_old_file_survives_a_failed_run(self):
        self.write("light.nrrd", "precious")
        self.fail(1, "bake", "gone.nrrd", "-o", "light.nrrd", says="gone.nrrd")
        self.assertEqual(self.read("light.nrrd"), b"precious")


class BadLight(CommandLineTest):
    def test_is_refused(self):
        self.write("points.csv", "0.5,0.5,0.8\n")
        self.write("light.nrrd", "NRRD0005\n")
        self.fail(1, "probe", "gen:sphere:8", "--light", "light.nrrd", "--points", "points.csv", "-o", "o.csv", says="light.nrrd")
        self.fail(1, "probe", "gen:sphere:8", "--light", "gone.nrrd", "--points", "points.csv", "-o", "o.csv", says="gone.nrrd")
        self.succeed("convert", "gen:sphere:8", "light.nrrd")
        self.fail(1, "probe", "gen:sphere:8", "--light", "light.nrrd", "--points", "points.csv", "-o", "o.csv",
                  says=("light.nrrd", "isolux.volume_sha256"))

    def test_with_a_header_that_nobody_can_use_is_named_with_the_key(self):
        self.write("points.csv", "0.5,0.5,0.5\n")
        self.succeed("bake", "gen:gyroid:8", "-o", "light.nrrd", "--rays", 4, "--quiet", "--resampler", "fit")
        for key, value, word in (("light_ceiling", b"-1", "-1"), ("light_ceiling", b"1e39", "1e39"), ("near_field", b"0 .5 .1 .1 .1", "a step of 0"),
                                 ("near_field", b"1e-320 .5 .1 .1 .1", "negatives"), ("near_field", b"1 .5 nan .1 .1", "nan")):
            line = b"\nisolux." + key.encode() + b":="
            self.assertIn(line, self.read("light.nrrd"))
            self.write("bad.nrrd", re.sub(line + b"[^\n]*", line + value, self.read("light.nrrd")))
            for more in (("probe", "--points", "points.csv", "-o", "o.csv"), ("render", "--iso", 0, "-o", "o.png")):
                self.fail(1, more[0], "gen:gyroid:8", "--light", "bad.nrrd", *more[1:], says=("bad.nrrd", "isolux." + key, word, "wanted" if word == "nan" else "allowed"))
        self.write("bad.nrrd", self.read("light.nrrd").replace(b'"outer":"lower"', b'"outer":"lowex"'))
        self.fail(1, "render", "gen:gyroid:8", "--light", "bad.nrrd", "--iso", 0, "-o", "o.png", says=("bad.nrrd", "isolux.scene.outer", "lowex"))

    def test_of_errors_is_no_light(self):
        self.succeed("bake", "gen:sphere:8", "-o", "light.nrrd", "--error-grid", "error.nrrd", "--rays", 2, "--quiet")
        self.fail(1, "extract", "gen:sphere:8", "--light", "error.nrrd", "--iso", -0.3, "-o", "mesh.ply",
                  says=("error.nrrd", "standard error", "--force"))

    def test_bad_points_are_named_by_line(self):
        self.succeed("bake", "gen:sphere:8", "-o", "light.nrrd", "--rays", 1, "--quiet")
        self.write("points.csv", "x,y,z\n0.5,0.5,0.8\n0.5,half,0.8\n")
        self.fail(1, "probe", "gen:sphere:8", "--light", "light.nrrd", "--points", "points.csv", "-o", "o.csv",
                  says=("points.csv", "line 3", "half"))
        for line in ("0.5,0.5", "0.5,,0.5,0.5", "0,5;0,5;0,7"):  # too few, one empty, commas for points
            self.write("points.csv", line + "\n")
            self.fail(1, "probe", "gen:sphere:8", "--light", "light.nrrd", "--points", "points.csv", "-o", "o.csv",
                      says=("points.csv", "line 1", line))
        for table in ("", "# mine\n", "easting northing height\n"):
            self.write("points.csv", table)
            self.fail(1, "probe", "gen:sphere:8", "--light", "light.nrrd", "--points", "points.csv", "-o", "o.csv",
                      says=("points.csv", "no points", "x,y,z"))
        self.write("points.csv", "id,z,y,x\n")  # a table that happens to be empty
        self.succeed("probe", "gen:sphere:8", "--light", "light.nrrd", "--points", "points.csv", "-o", "empty.csv")
        self.assertEqual(self.read("empty.csv"), b"x,y,z,isovalue,e,id\n")
        self.fail(1, "probe", "gen:sphere:8", "--light", "light.nrrd", "--points", "gone.csv", "-o", "o.csv",
                  says="gone.csv: cannot open the points: No such file or directory")


if __name__ == "__main__":
    unittest.main()
