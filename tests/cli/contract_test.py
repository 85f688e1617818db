"""The commands, files and reports that users' scripts rely on."""
import json
import math
import os
import struct
import unittest

from support import CommandLineTest, nrrd_header, ply


class Info(CommandLineTest):
    def test_json_describes_the_volume(self):
        info = json.loads(self.succeed("info", "gen:sphere:9", "--json").stdout)
        self.assertEqual(info["dims"], [9, 9, 9])
        self.assertEqual(info["type"], "float32")
        self.assertEqual(info["spacing"], [0.125, 0.125, 0.125])
        self.assertAlmostEqual(info["range"][0], -math.sqrt(0.75), places=6)
        self.assertEqual(info["range"][1], 0.0)
        self.assertEqual(sum(info["histogram"]["counts"]), 729)

    def test_counts_what_is_not_finite(self):
        self.write("bad_2x2x2_float32.raw", struct.pack("<8f", 1, 2, 3, math.nan, 5, 6, math.inf, 8))
        info = json.loads(self.succeed("info", "bad_2x2x2_float32.raw", "--json").stdout)
        self.assertEqual(info["not_finite"], 2)
        self.assertEqual(info["range"], [1, 8])


class Backends(CommandLineTest):
    def test_json_lists_stages_backends_and_options(self):
        stages = {s["stage"]: {b["name"]: b for b in s["backends"]} for s in json.loads(self.succeed("backends", "--json").stdout)}
        self.assertTrue({"reader", "extractor", "sampler", "tracer", "resampler"} <= stages.keys())
        self.assertTrue({"brute_force", "cell_grid", "cgal_kdtree", "direct"} <= stages["resampler"].keys())
        self.assertTrue({"random", "stratified", "low_discrepancy", "texels"} <= stages["sampler"].keys())
        k = {o["name"]: o for o in stages["resampler"]["brute_force"]["options"]}["k"]
        self.assertEqual(k["type"], "int")
        self.assertTrue(k["help"] and k["default"] and k["allowed"])
        self.assertEqual(sum(b["default"] for b in stages["tracer"].values()), 1)


class Bake(CommandLineTest):
    def bake(self, *more, volume="gen:sphere:16", out="light.nrrd", rays=16):
        return self.succeed("bake", volume, "-o", out, "--rays", rays, "--quiet", *more)

    def test_light_file_is_laid_out_as_promised(self):
        self.bake("--report", "report.json")
        fields, order, data = nrrd_header(self.path("light.nrrd"))
        self.assertEqual(fields["type"], "float")
        self.assertEqual(fields["encoding"], "raw")
        self.assertEqual(fields["sizes"], "15 15 15")
        self.assertLess(order.index("sizes"), order.index("space"))
        self.assertEqual(len(data), 4 * 15**3)
        self.assertEqual(fields["isolux.quantity"], "irradiance/pi")
        for key in ("version", "scene", "settings", "volume_sha256", "iso_range"):
            self.assertIn("isolux." + key, fields)
        origin = [float(x) for x in fields["space origin"].strip("()").split(",")]
        for x in origin:
            self.assertAlmostEqual(x, 0.5 / 15, places=6)
        report = self.report()
        for key in ("seconds", "rays", "rays_per_second", "texels", "peak_memory_bytes", "rmse_estimate", "settings"):
            self.assertIn(key, report)
        self.assertTrue({"read", "sites", "trace", "resample", "write", "total"} <= report["seconds"].keys())
        self.assertEqual(report["texels"], 15**3)

    def test_peak_memory_is_the_programs_own(self):
        held = b"1" * (400 << 20)  # of whoever calls
        self.bake("--report", "report.json", "--bounces", 0)
        self.assertTrue(1 << 20 < self.report()["peak_memory_bytes"] < len(held) / 2)

    def test_coloured_light_has_three_channels_first(self):
        self.write("scene.json", '{"environment": {"type": "uniform", "radiance": [1, 0.5, 0.25]}}')
        self.bake("--scene", "scene.json", "--bounces", 0)
        fields, _, data = nrrd_header(self.path("light.nrrd"))
        self.assertEqual(fields["sizes"], "3 15 15 15")
        self.assertEqual(fields["kinds"], "vector domain domain domain")
        r, g, b = struct.unpack_from("<3f", data, 4 * 3 * (7 * 225 + 7 * 15 + 3))
        self.assertAlmostEqual(r, 2 * g, places=5)
        self.assertAlmostEqual(r, 4 * b, places=5)

    def test_same_seed_gives_the_same_bytes_for_any_threads(self):
        for method in ((), ("--samples", 500), ("--samples", 500, "--sampler", "random", "--resampler", "brute_force")):
            self.bake("--threads", 1, "--seed", 5, *method, out="one.nrrd", volume="gen:gyroid:12", rays=4)
            self.bake("--threads", 3, "--seed", 5, *method, out="three.nrrd", volume="gen:gyroid:12", rays=4)
            self.bake("--threads", 3, "--seed", 6, *method, out="other.nrrd", volume="gen:gyroid:12", rays=4)
            self.assertEqual(self.read("one.nrrd"), self.read("three.nrrd"))
            self.assertNotEqual(nrrd_header(self.path("one.nrrd"))[2], nrrd_header(self.path("other.nrrd"))[2])

    def test_more_threads_than_cores_are_no_matter(self):
        self.assertEqual(self.bake("--threads", 64).stderr, "")
        # Starting all of them for each of hundreds of small loops would take minutes; the test's limit is 300 s.
        self.assertEqual(self.bake("--threads", 4096, volume="gen:gyroid:12", rays=2).stderr, "")

    def test_texels_lattice_and_compression(self):
        self.bake("--texels", "5x6x7")
        self.assertEqual(nrrd_header(self.path("light.nrrd"))[0]["sizes"], "5 6 7")
        self.bake("--texels", "auto", "--bounces", 0, "--report", "report.json")
        self.assertEqual(nrrd_header(self.path("light.nrrd"))[0]["sizes"], "4 4 4")  # white: the fewest will do
        self.assertLess(self.report()["texel_error"], 0.05)
        # Nobody asked for an error: what is sought without a word is no matter for a warning.
        sought = self.succeed("bake", "gen:noise:6", "-o", "noise.nrrd", "--texels", "auto", "--bounces", 0)
        self.assertNotIn("warning", sought.stderr)
        self.assertRegex(sought.stderr, r"texels, wrong by about \S+ between them \(sought 0.05\)")
        self.bake("--lattice", "voxels")
        fields = nrrd_header(self.path("light.nrrd"))[0]
        self.assertEqual(fields["sizes"], "16 16 16")
        self.bake("--compress")
        self.assertEqual(nrrd_header(self.path("light.nrrd"))[0]["encoding"], "gzip")

    def test_an_error_target_is_met(self):
        self.bake("--rmse", 0.01, "--report", "report.json", volume="gen:two-spheres:12", rays=16)
        self.assertLess(self.report()["rmse_estimate"], 0.0115)
        # Whoever asked for an error hears that it is missed, as of a --time.
        missed = self.succeed("bake", "gen:noise:6", "-o", "noise.nrrd", "--samples", 20, "--rmse", 0.001, "--bounces", 0, "--quiet")
        self.assertRegex(missed.stderr, r"^isolux: warning: the error asked is not reached: about \S+ of 0.001[^\n]*\n$")
        fit = self.succeed("bake", "gen:gyroid:12", "-o", "fit.nrrd", "--resampler", "fit", "--rmse", 0.02, "--bounces", 0, "--quiet")
        self.assertRegex(fit.stderr, r"about \S+ of 0.02; more rays would hardly take any away, but more texels do \(--texels-a-cell\)\n$")
        self.write("white.json", '{"albedo": [1, 1, 1]}')
        white = self.succeed("bake", "gen:cavity:17", "-o", "white.nrrd", "--rays", 4, "--scene", "white.json", "--quiet")
        self.assertRegex(white.stderr, r"^isolux: warning: \d+ of the places that the error is judged by lie in pockets[^\n]*\n$")
        rough = self.succeed("bake", "gen:noise:6", "-o", "noise.nrrd", "--texels", "auto", "--rmse", 0.02, "--bounces", 0, "--quiet")
        self.assertRegex(rough.stderr, r"^isolux: warning: the error asked is not reached: light is wrong by about \S+ of 0.02 between \S+ texels[^\n]*\n$")
        self.bake("--rmse", 0.02, "--error-grid", "error.nrrd", "--report", "report.json", volume="gen:gyroid:17")
        fields, _, data = nrrd_header(self.path("error.nrrd"))
        self.assertEqual(fields["isolux.quantity"], "standard error of irradiance/pi")
        errors = struct.unpack("<%df" % 16**3, data)
        report = self.report()
        self.assertLess(report["rmse_estimate"], 0.02)
        self.assertEqual(report["skipped"]["sites_flat"] + report["sites"], 16**3)
        self.assertGreater(report["rays_a_site"]["most"], report["rays_a_site"]["least"])
        # Texels without a site repeat their neighbours' errors.
        self.assertAlmostEqual(math.sqrt(sum(e * e for e in errors) / len(errors)), report["rmse_estimate"], delta=0.004)

    def test_an_error_target_gives_the_same_bytes_for_any_threads(self):
        self.bake("--rmse", 0.03, "--threads", 1, out="one.nrrd", volume="gen:gyroid:12")
        self.bake("--rmse", 0.03, "--threads", 3, out="three.nrrd", volume="gen:gyroid:12")
        self.assertEqual(self.read("one.nrrd"), self.read("three.nrrd"))

    def test_a_time_is_kept(self):
        self.bake("--time", 0.5, "--report", "report.json", volume="gen:gyroid:16")
        # A busy machine may stretch the last round.
        self.assertLess(self.report()["seconds"]["total"], 5)

    def test_probe_reads_one_on_a_convex_level_set(self):
        self.bake("--bounces", 0)
        self.write("points.csv", "x,y,z\n0.5,0.5,0.8\n0.3,0.5,0.5\n9,9,9\n")
        done = self.succeed("probe", "gen:sphere:16", "--light", "light.nrrd", "--points", "points.csv", "-o", "out.csv")
        self.assertIn("1 of 3 points lie outside", done.stderr)
        rows = self.read("out.csv").decode().splitlines()
        self.assertEqual(rows[0], "x,y,z,isovalue,e")
        for row, isovalue in zip(rows[1:3], (-0.3, -0.2)):
            values = [float(v) for v in row.split(",")]
            self.assertAlmostEqual(values[3], isovalue, delta=0.01)  # trilinear f of 16^3
            self.assertAlmostEqual(values[4], 1.0, delta=1e-5)       # no ray of a convex level set meets it again
        self.assertTrue(rows[3].endswith("nan,nan"))

    def test_a_light_of_a_range_says_where_it_is_read_beyond(self):
        self.bake("--bounces", 0, "--iso-range", "-0.35:-0.25")
        self.write("points.csv", "0.5,0.5,0.8\n0.5,0.5,0.6\n9,9,9\n")
        done = self.succeed("probe", "gen:sphere:16", "--light", "light.nrrd", "--points", "points.csv", "-o", "out.csv")
        self.assertIn("1 of 3 points lie on level sets outside the range", done.stderr)
        for command in (("extract", "-o", "m.ply"), ("render", "-o", "i.png", "--size", "8x8")):
            for isovalue, words in ((-0.3, 0), (-0.1, 1)):
                done = self.succeed(command[0], "gen:sphere:16", "--light", "light.nrrd", "--iso", isovalue, *command[1:])
                self.assertEqual(done.stderr.count("outside the range -0.35 to -0.25"), words, done.stderr)

    def test_probe_reads_the_tables_that_others_write(self):
        self.bake("--bounces", 0)
        tables = {"plain": "0.5,0.5,0.8\n", "byte order mark": "\ufeff0.5,0.5,0.8\n", "signs": "+.5,+5e-1,.8\n",
                  "blanks": "  0.5\t0.5 0.8 \r\n", "semicolons": "0.5;0.5;0.8\r\n", "comment": "# mine\n\n0.5, 0.5, 0.8, 7\n",
                  "names": "\ufeffid,Z,Y,X\n1,0.8,0.5,0.5\n", "quotes": '"x","y","z"\n"0.5","0.5","0.8"\n',
                  "other names": "easting northing height\n0.5 0.5 0.8\n"}
        for name, table in tables.items():
            with self.subTest(table=name):
                self.write("points.csv", table)
                self.succeed("probe", "gen:sphere:16", "--light", "light.nrrd", "--points", "points.csv", "-o", "out.csv")
                rows = self.read("out.csv").decode().splitlines()[1:]
                self.assertEqual([row.split(",")[:3] for row in rows], [["0.5", "0.5", "0.8"]])


class LightOfAnotherVolume(CommandLineTest):
    def test_is_refused_unless_forced(self):
        self.succeed("bake", "gen:sphere:12", "-o", "light.nrrd", "--rays", 1, "--quiet")
        self.write("points.csv", "0.5,0.5,0.8\n")
        commands = (("render", "gen:torus:12", "--iso", -0.1, "-o", "out.png", "--size", "20x20"),
                    ("extract", "gen:torus:12", "--iso", -0.1, "-o", "out.ply"),
                    ("probe", "gen:torus:12", "--points", "points.csv", "-o", "out.csv"))
        for command in commands:
            self.fail(1, *command, "--light", "light.nrrd", says=("light.nrrd", "another volume", "--force"))
            self.succeed(*command, "--light", "light.nrrd", "--force")


class Extract(CommandLineTest):
    def test_writes_binary_ply_with_normals(self):
        self.succeed("extract", "gen:sphere:24", "--iso", -0.3, "-o", "mesh.ply", "--report", "report.json")
        lines, points, triangles = ply(self.path("mesh.ply"))
        self.assertIn("format binary_little_endian 1.0", lines)
        self.assertFalse(any("red" in line for line in lines))
        self.assertEqual(len(points) - 3 * len(triangles) // 2 + len(triangles), 2)  # Euler number of a ball
        for x, y, z, nx, ny, nz in points:
            radius = math.dist((x, y, z), (0.5, 0.5, 0.5))
            self.assertAlmostEqual(radius, 0.3, delta=0.002)
            self.assertGreater((nx * (x - 0.5) + ny * (y - 0.5) + nz * (z - 0.5)) / radius, 0.99)
        self.assertEqual(self.report()["triangles"], len(triangles))
        self.assertEqual(self.report()["vertices"], len(points))

    def test_light_becomes_uchar_colours(self):
        self.succeed("bake", "gen:sphere:24", "-o", "light.nrrd", "--rays", 4, "--bounces", 0, "--quiet")
        for light in (("--light", "light.nrrd"), ("--exact-light", "--rays", 64, "--bounces", 0)):
            self.succeed("extract", "gen:sphere:24", "--iso", -0.3, "-o", "mesh.ply", *light)
            lines, points, _ = ply(self.path("mesh.ply"))
            for channel in ("red", "green", "blue"):
                self.assertIn(f"property uchar {channel}", lines)
            # e = 1 on a convex level set, and albedo .8 is sRGB code 231; the trilinear sphere has faint creases at the cells' faces,
            # where the vertices sit, that may catch 1 ray of 64 (code 229).
            self.assertTrue(all(229 <= code <= 231 for p in points for code in p[6:]))

    def test_what_shines_is_seen_to_shine(self):
        """In the dark a ball shows what it emits: .3, whose sRGB code is 149."""
        self.write("scene.json", '{"environment": {"type": "uniform", "radiance": [0, 0, 0]}, "emission": [0.3, 0.3, 0.3]}')
        scene = ("--scene", "scene.json")
        self.succeed("bake", "gen:sphere:16", "-o", "light.nrrd", "--rays", 4, "--bounces", 0, "--quiet", *scene)
        for name, how in (("baked", ("--light", "light.nrrd")), ("exact", ("--exact-light", "--rays", 64, "--bounces", 0, *scene))):
            self.succeed("extract", "gen:sphere:16", "--iso", -0.3, "-o", "mesh.ply", *how)
            _, points, _ = ply(self.path("mesh.ply"))
            self.assertTrue(all(149 <= code <= 151 for p in points for code in p[6:]), name)

    def test_isovalue_outside_the_range_is_an_empty_mesh_and_a_warning(self):
        done = self.succeed("extract", "gen:sphere:8", "--iso", 5, "-o", "mesh.ply")
        self.assertIn("isolux: warning: isovalue 5 lies outside", done.stderr)
        self.assertEqual(len(ply(self.path("mesh.ply"))[1]), 0)
        # All of the box is inside: its cap is a surface.
        done = self.succeed("extract", "gen:sphere:8", "--iso", -5, "-o", "mesh.ply", "--cap", "--quiet")
        self.assertEqual(done.stderr, "")
        self.assertGreater(len(ply(self.path("mesh.ply"))[1]), 0)

    def test_options_of_tracing_without_exact_light_are_told(self):
        done = self.succeed("extract", "gen:sphere:8", "--iso", -0.3, "-o", "mesh.ply", "--rays", 4)
        self.assertIn("isolux: warning: --bounces, --quality, --rays and --tracer have no effect without --exact-light", done.stderr)


class Render(CommandLineTest):
    def test_needs_no_display_and_shows_the_light(self):
        os.environ.pop("DISPLAY", None)
        self.succeed("bake", "gen:two-spheres:24", "-o", "light.nrrd", "--rays", 16, "--quiet")
        for mode in ("local", "global", "both", "normal"):
            self.succeed("render", "gen:two-spheres:24", "--light", "light.nrrd", "--iso", -0.15, "-o", mode + ".png", "--size", "64x48",
                         "--mode", mode)
            self.assertTrue(self.read(mode + ".png").startswith(b"\x89PNG"))
        self.assertNotEqual(self.read("local.png"), self.read("global.png"))
        width = struct.unpack(">I", self.read("both.png")[16:20])[0]
        self.assertEqual(width, 64 + 4 + 64)


class Reports(CommandLineTest):
    def test_say_what_was_asked_for(self):
        self.succeed("bake", "gen:sphere:8", "-o", "l.nrrd", "--rays", 1, "--quiet")
        shown = ("gen:sphere:8", "--iso", -0.25, "--light", "l.nrrd", "--outer", "higher", "--side", "inner", "--threads", 2, "--report", "report.json",
                 "--quiet")
        self.succeed("render", *shown, "-o", "i.png", "--size", "20x10", "--exposure", 1, "--eye", "0.5,-1,.5", "--samples", 2)
        common = {"isovalue": -0.25, "light": "l.nrrd", "outer": "higher", "side": "inner", "seed": 1, "threads": 2}
        self.assertEqual(self.report()["settings"], {**common, "exposure": 1, "eye": [0.5, -1, 0.5], "samples": 2, "size": [20, 10],
                                                     "view": [30, 20], "mode": "global"})
        self.succeed("extract", *shown, "-o", "m.ply", "--exact-light", "--rays", 3, "--min-component", 2)
        self.assertEqual(self.report()["settings"], {**common, "exact_light": True, "rays": 3, "cap": False, "min_component": 2,
                                                     "normals": "gradient", "backend": "marching_cubes"})


class Convert(CommandLineTest):
    def test_keeps_values_and_frame(self):
        self.succeed("convert", "gen:gyroid:9", "a.nrrd")
        self.succeed("convert", "a.nrrd", "b.nhdr", "--compress")
        one, two = (json.loads(self.succeed("info", f, "--json").stdout) for f in ("a.nrrd", "b.nhdr"))
        self.assertEqual(one["sha256"], two["sha256"])

    def test_replaces_what_is_not_finite(self):
        self.write("bad_2x2x2_float32.raw", struct.pack("<8f", 1, 2, 3, math.nan, 5, 6, math.inf, 8))
        self.succeed("convert", "bad_2x2x2_float32.raw", "good_2x2x2_float32.raw", "--replace-nonfinite", "-7")
        self.assertEqual(struct.unpack("<8f", self.read("good_2x2x2_float32.raw")), (1, 2, 3, -7, 5, 6, -7, 8))

    def test_reads_big_endian_files_whose_name_says_the_rest(self):
        self.write("big_2x2x2_uint16.raw", struct.pack(">8H", *range(8)))
        self.succeed("convert", "big_2x2x2_uint16.raw", "little_2x2x2_uint16.raw", "--endian", "big")
        self.assertEqual(struct.unpack("<8H", self.read("little_2x2x2_uint16.raw")), tuple(range(8)))


if __name__ == "__main__":
    unittest.main()
