"""What commands say of a volume that was read, and the words that change its values."""
import json
import math
import os
import struct
import unittest

from support import CommandLineTest, nrrd_header


class Offsets(CommandLineTest):
    """Volumes are floats: of small differences on a large offset little is left."""

    def setUp(self):
        super().setUp()
        self.values = [101325 + 0.05 * math.sin(i / 10) for i in range(64)]
        self.write("p_4x4x4_float64.raw", struct.pack("<64d", *self.values))

    def test_that_leave_few_values_are_told_of(self):
        for command in (("info", "p_4x4x4_float64.raw"), ("extract", "p_4x4x4_float64.raw", "--iso", 101325.02, "-o", "m.ply"),
                        ("convert", "p_4x4x4_float64.raw", "q.nrrd"),
                        ("bake", "p_4x4x4_float64.raw", "-o", "l.nrrd", "--rays", 4)):
            said = self.succeed(*command, "--quiet").stderr
            self.assertEqual(said.count("isolux: warning: "), 1, said)
            self.assertIn("rounded to float32, which has only about 13 from", said)
            self.assertIn("--subtract 101325 ", said)

    def test_that_were_taken_off_are_part_of_the_advice(self):
        self.write("o_2x2x2_float64.raw", struct.pack("<8d", *(1e9 + 1e-3 * i for i in range(8))))
        said = self.succeed("info", "o_2x2x2_float64.raw", "--subtract", 999000000).stderr
        self.assertIn("--subtract 1e+09 ", said)
        self.fail(1, "info", "gen:sphere:8", "--subtract", "1e39", says=("gen:sphere:8", "float32"))

    def test_that_are_taken_off_lose_nothing(self):
        said = self.succeed("convert", "p_4x4x4_float64.raw", "q.nrrd", "--subtract", 101325).stderr
        self.assertEqual(said, "")
        fields, _, data = nrrd_header(self.path("q.nrrd"))
        self.assertEqual(fields["type"], "float")
        for value, read in zip(self.values, struct.unpack("<64f", data)):
            self.assertAlmostEqual(value - 101325, read, delta=1e-8)  # half a unit in the last place of .05 and less

    def test_small_beside_the_range_are_not_told_of(self):
        self.write("r_4x4x4_float64.raw", struct.pack("<64d", *(0.1 * i for i in range(64))))
        self.assertEqual(self.succeed("info", "r_4x4x4_float64.raw").stderr, "")

    def test_that_make_a_volume_constant_are_named(self):
        self.write("c_4x4x4_float64.raw", struct.pack("<64d", *(1e6 + 1e-4 * i for i in range(64))))
        self.fail(1, "bake", "c_4x4x4_float64.raw", "-o", "l.nrrd", says=("every voxel is 1000000", "rounded to float32"))


class MissingValues(CommandLineTest):
    def convert(self, *more):
        self.write("n_2x2x2_int16.raw", struct.pack("<8h", 1, 2, 3, 4, 5, 6, 7, -9999))
        self.succeed("convert", "n_2x2x2_int16.raw", "o.nrrd", "--nodata", -9999, *more)
        fields, _, data = nrrd_header(self.path("o.nrrd"))
        return fields["type"], struct.unpack("<8" + {"int16": "h", "float": "f"}[fields["type"]], data)

    def test_are_no_numbers(self):
        kind, values = self.convert()
        self.assertEqual(kind, "float")
        self.assertEqual(values[:7], (1, 2, 3, 4, 5, 6, 7))
        self.assertTrue(math.isnan(values[7]))
        self.assertTrue(math.isnan(self.convert("--subtract", 0.5)[1][7]))

    def test_are_replaced_as_others_that_are_no_numbers(self):
        self.assertEqual(self.convert("--replace-nonfinite", 0), ("int16", (1, 2, 3, 4, 5, 6, 7, 0)))
        self.assertEqual(self.convert("--replace-nonfinite", 0.5), ("float", (1, 2, 3, 4, 5, 6, 7, 0.5)))

    def test_are_compared_before_they_are_rounded(self):
        wide = [2 ** 24, 2 ** 24 + 1, 2 ** 24 + 2, 0, 1, 2, 3, 4]
        for kind, code in (("int32", "i"), ("int64", "q"), ("float64", "d")):
            self.write(f"w_2x2x2_{kind}.raw", struct.pack(f"<8{code}", *wide))
            for more in ((), ("--subtract", 2 ** 24)):
                self.succeed("convert", f"w_2x2x2_{kind}.raw", "o.nrrd", "--nodata", 2 ** 24 + 1, *more)
                fields, _, data = nrrd_header(self.path("o.nrrd"))
                values = struct.unpack("<8" + {"float": "f", "double": "d"}[fields["type"]], data)
                self.assertEqual([math.isnan(value) for value in values], [False, True] + 6 * [False])
        self.assertIn("2^24", self.succeed("convert", "w_2x2x2_int32.raw", "o.nrrd", "--nodata", -1).stderr)

    def test_are_those_of_the_files_own_precision(self):
        self.write("f_2x2x2_float32.raw", struct.pack("<8f", 1, 2, 3, 4, 5, 6, 7, -9999.9))
        self.succeed("convert", "f_2x2x2_float32.raw", "o.nrrd", "--nodata", -9999.9, "--replace-nonfinite", 0)
        self.assertEqual(struct.unpack("<8f", nrrd_header(self.path("o.nrrd"))[2])[7], 0)

    def test_that_no_voxel_has_are_remarked(self):
        for value, lines in ((-9999, 0), (-999, 1)):
            self.write("n_2x2x2_int16.raw", struct.pack("<8h", 1, 2, 3, 4, 5, 6, 7, -9999))
            told = self.succeed("info", "n_2x2x2_int16.raw", "--nodata", value).stderr.splitlines()
            self.assertEqual(len(told), lines)
            for line in told:
                self.assertRegex(line, "^isolux: warning: n_2x2x2_int16.raw: .* -999 ")


class Arrays(CommandLineTest):
    """A VTK XML file has several."""

    def setUp(self):
        super().setUp()
        arrays = "".join(f'<DataArray type="UInt8" Name="{name}" NumberOfComponents="{parts}" format="ascii">{values}</DataArray>'
                         for name, parts, values in (("u v", 1, "0 1 2 3 4 5 6 7"), ("p", 1, "9 1 2 3 4 5 6 7"), ("w", 3, "0 " * 24)))
        self.write("a.vti", '<VTKFile type="ImageData"><ImageData WholeExtent="0 1 0 1 0 1"><Piece Extent="0 1 0 1 0 1"><PointData Scalars="p">'
                   + arrays + "</PointData></Piece></ImageData></VTKFile>")

    def values(self, *more):
        told = self.succeed("convert", "a.vti", "o.nrrd", "--quiet", *more).stderr
        return told, list(nrrd_header(self.path("o.nrrd"))[2])

    def test_are_told_of_and_chosen_by_name(self):
        told, values = self.values()
        self.assertRegex(told, r"^isolux: warning: a.vti: the array 'p' is read, not 'u v', 'w' \(3 components\); --set-reader vti.array=NAME .*\n$")
        self.assertEqual(values, [9, 1, 2, 3, 4, 5, 6, 7])
        self.assertEqual(self.values("--set-reader", "vti.array=u v"), ("", list(range(8))))
        for name in ("w", "nobody"):
            self.fail(1, "convert", "a.vti", "n.nrrd", "--set-reader", f"vti.array={name}", says=("a.vti", name, "'u v', 'p', 'w' (3"))


class Names(CommandLineTest):
    def test_of_other_formats_are_no_lights(self):
        for name in ("x.vtk", "light.nii.gz", "light.nhdr"):
            self.fail(2, "bake", "gen:sphere:8", "-o", name, says=("--output", name, ".nrrd"))
            self.fail(2, "bake", "gen:sphere:8", "-o", "l.nrrd", "--error-grid", name, says=("--error-grid", name))
        for name in ("light.NRRD", "light"):
            self.succeed("bake", "gen:sphere:8", "-o", name, "--rays", 4, "--quiet")


class Reports(CommandLineTest):
    def test_say_what_was_read_and_written_by_which_program(self):
        self.succeed("extract", "gen:sphere:8", "--iso", "-.2", "-o", "m.ply", "--report", "report.json")
        report = self.report()
        self.assertEqual((report["input"], report["output"]), ("gen:sphere:8", "m.ply"))
        self.assertRegex(report["version"], r"^\d+\.\d+\.\d+$")
        self.assertGreaterEqual(report["settings"]["threads"], 1)
        self.assertEqual(report["settings"]["isovalue"], -0.2)
        self.succeed("bake", "gen:sphere:8", "-o", "l.nrrd", "--iso-range=-.3:-.2", "--rays", 4, "--report", "report.json")
        self.assertEqual(self.report()["settings"]["iso_range"], [-0.3, -0.2])


class Tables(CommandLineTest):
    def probe(self, table):
        self.write("in.csv", table)
        self.told = self.succeed("probe", "gen:sphere:8", "--light", "l.nrrd", "--points", "in.csv", "-o", "out.csv").stderr
        return self.read("out.csv").decode().splitlines()

    def setUp(self):
        super().setUp()
        self.succeed("bake", "gen:sphere:8", "-o", "l.nrrd", "--rays", 4, "--quiet")

    def test_keep_their_other_columns(self):
        lines = self.probe('name,x,y,z,charge\n"C ""a""",.5,.25,.5,-1\nCB,.5,.25,.5\n')
        self.assertEqual(lines[0], "x,y,z,isovalue,e,name,charge")
        self.assertTrue(lines[1].startswith("0.5,0.25,0.5,") and lines[1].endswith(',"C ""a""",-1'), lines[1])
        self.assertTrue(lines[2].endswith(",CB,"), lines[2])
        self.assertEqual(self.probe("x;y;z;no,te\n.5;.25;.5;a\n")[0], 'x,y,z,isovalue,e,"no,te"')
        self.assertEqual(self.probe("a b c\n.5 .25 .5\n")[0], "x,y,z,isovalue,e")

    def test_have_each_name_once(self):
        lines = self.probe("x,y,z,isovalue,e,note,e_in\n.5,.25,.5,7,8,a,9\n")
        self.assertEqual(lines[0], "x,y,z,isovalue,e,isovalue_in,e_in_in,note,e_in")
        self.assertTrue(lines[1].endswith(",7,8,a,9"), lines[1])
        self.assertIn("'isovalue' is 'isovalue_in'", self.told)
        self.assertIn("'e' is 'e_in_in'", self.told)
        self.assertEqual(self.probe("X,y,z,x,e_r\n.5,.25,.5,3,4\n")[0], "x,y,z,isovalue,e,x_in,e_r")
        again = self.probe("\n".join(self.probe("x,y,z\n.5,.25,.5\n")) + "\n")
        self.assertEqual(again[0], "x,y,z,isovalue,e,isovalue_in,e_in")
        self.assertEqual(again[1].split(",")[3:5], again[1].split(",")[5:])

    def test_quote_what_parts_fields(self):
        lines = self.probe('label,x,y,z,"n,m"\n"a,.1,.2,.3,b",.5,.25,.5,"c;d"\n')
        self.assertEqual(lines[0], 'x,y,z,isovalue,e,label,"n,m"')
        self.assertTrue(lines[1].startswith("0.5,0.25,0.5,") and lines[1].endswith(',"a,.1,.2,.3,b",c;d'), lines[1])
        self.assertTrue(self.probe('x y z t\n.5 .25 .5 "a b"\n')[1].endswith(",a b"))
        self.assertTrue(self.probe("x\ty\tz\ta1\tb\r\n.5\t.25\t.5\t\tfoo bar\r\n")[1].endswith(",,foo bar"))
        again = self.probe("\n".join(lines).replace("isovalue,e", "h,e0") + "\n")
        self.assertTrue(again[1].endswith(',"a,.1,.2,.3,b",c;d'), again[1])

    def test_with_more_fields_than_names_or_open_quotes_are_refused(self):
        for table, why in (("x,y,z,a\n.5,.25,.5,1,2\n", "5 fields"), ('x,y,z,a\n.5,.25,.5,"1\n', "quote"),
                           ('x,y,z,a\n.5,.25,.5,"1"2\n', "quote")):
            self.write("in.csv", table)
            self.fail(1, "probe", "gen:sphere:8", "--light", "l.nrrd", "--points", "in.csv", "-o", "out.csv", says=("in.csv: line 2", why))

    def test_whose_names_do_not_tell_the_points_are_refused(self):
        self.write("in.csv", "id,px,py,pz\n1,.5,.25,.5\n")
        self.fail(1, "probe", "gen:sphere:8", "--light", "l.nrrd", "--points", "in.csv", "-o", "out.csv",
                  says=("in.csv: line 1", "'id', 'px', 'py', 'pz'", "x, y and z"))


class StoredTypes(CommandLineTest):
    """A file of 8 or 16 bits is the same volume as one of floats with its values."""

    def test_give_the_same_figures_surface_and_light(self):
        values = [(7 * x * y + 11 * y * z + 5 * z * x) % 100 for z in range(6) for y in range(7) for x in range(8)]
        self.write("f_8x7x6_float32.raw", struct.pack(f"<{len(values)}f", *values))
        self.succeed("bake", "f_8x7x6_float32.raw", "-o", "light.nrrd", "--rays", 4, "--bounces", 0, "--quiet")
        files = []
        for name, code in (("float32", "f"), ("uint8", "B"), ("int8", "b"), ("uint16", "H"), ("int16", "h")):
            file = self.write(f"f_8x7x6_{name}.raw", struct.pack(f"<{len(values)}{code}", *values))
            info = json.loads(self.succeed("info", file, "--json").stdout)
            self.assertEqual((info.pop("type"), info.pop("name")), (name, file))
            # Under one name, which meshes hold.
            os.replace(file, self.path("f.raw"))
            volume = ("f.raw", "--dims", "8x7x6", "--type", name, "--iso", 40.5)
            self.succeed("extract", *volume, "-o", "plain.ply", "--cap")
            # The light is that of the floats: hashes agree, whatever the type.
            self.succeed("extract", *volume, "-o", "lit.ply", "--light", "light.nrrd")
            files.append((info, self.read("plain.ply"), self.read("lit.ply")))
        for one in files[1:]:
            self.assertEqual(one, files[0])


if __name__ == "__main__":
    unittest.main()
