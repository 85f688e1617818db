"""No command replaces a file that it reads, or one that nobody named."""
import os
import re
import struct
import unittest

from support import CommandLineTest

# Every option that names a file, by command: {option: file}. What is read is there; what is written may be anything.
READ = {"VOLUME": "scan.nhdr", "--light": "light.nrrd", "--scene": "scene.json", "--points": "points.csv"}
COMMANDS = {
    "info": ((), ("VOLUME",), ("--report",)),
    "extract": (("--iso", -0.3), ("VOLUME", "--light", "--scene"), ("--output", "--report")),
    "bake": (("--rays", 1), ("VOLUME", "--scene"), ("--output", "--error-grid", "--report")),
    "render": (("--iso", -0.3), ("VOLUME", "--light", "--scene"), ("--output", "--report")),
    "probe": ((), ("VOLUME", "--light", "--points"), ("--output", "--report")),
    "convert": ((), ("VOLUME",), ("--report", "OUT")),
}
ENDINGS = {"extract": ".ply", "render": ".png", "probe": ".csv"}


class FilesThatAreRead(CommandLineTest):
    def setUp(self):
        super().setUp()
        self.succeed("convert", "gen:sphere:8", "scan.nhdr")
        self.succeed("bake", "scan.nhdr", "-o", "light.nrrd", "--rays", 1, "--quiet")
        self.write("sky.hdr", b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 4\n" + bytes([128, 128, 128, 129]) * 16)
        self.write("scene.json", '{"environment": {"type": "image", "file": "sky.hdr"}}')
        self.write("points.csv", "0.5,0.5,0.8\n")
        self.precious = {name: self.read(name) for name in sorted(os.listdir(self.folder))}

    def arguments(self, command, outputs):
        """The command with all that it reads; `outputs` are those that it has to have, at other places."""
        more, read, written = COMMANDS[command]
        words = [command, READ["VOLUME"], *more]
        for option in read[1:]:
            words += [option, READ[option]]
        for option in ("OUT", "--output"):
            if option in written and option not in outputs:
                words += [option, "out" + ENDINGS.get(command, ".nrrd")] if option != "OUT" else ["out.nrrd"]
        for option, path in outputs.items():
            words += [option, path] if option != "OUT" else [path]
        return words

    def test_are_all_that_the_help_tells_of(self):
        """A new option that names a file belongs into the table above, so that the next test sees it."""
        for command, (_, read, written) in COMMANDS.items():
            told = re.findall(r"^ +(?:-\w,)?(--[\w-]+) \w+\.(?:csv|json|nrrd|ply|png)\b", self.succeed(command, "--help").stdout, re.MULTILINE)
            self.assertEqual(set(told), {option for option in read + written if option.startswith("--")}, command)

    def test_are_never_replaced(self):
        for command, (_, read, written) in COMMANDS.items():
            for output in written:
                for option in read:
                    paths = {READ[option], "./" + READ[option]}
                    if option == "VOLUME":
                        paths.add("scan.raw")  # a header's data are read too
                    if option == "--scene":
                        paths.add("sky.hdr")
                    for path in sorted(paths):
                        if output == "OUT":
                            continue  # in place: see below
                        if command in ("extract", "render") and output == "--output":
                            path = self.link(path, ENDINGS[command])
                        with self.subTest(command=command, output=output, path=path):
                            self.fail(2, *self.arguments(command, {output: path}), says=(output, "would replace " + option))
        for name, content in self.precious.items():
            self.assertEqual(self.read(name), content, name)

    def link(self, path, ending):
        """A name with the ending that the command wants, for the same file."""
        name = os.path.basename(path) + ending
        if not os.path.lexists(self.path(name)):
            os.symlink(path, self.path(name))
        return name

    def test_are_converted_in_place_alone(self):
        self.succeed("convert", "scan.nhdr", "scan.nhdr", "--replace-nonfinite", 0)
        self.assertEqual(self.read("scan.raw"), self.precious["scan.raw"])
        self.succeed("convert", "scan.nhdr", "b_8x8x8_float32.raw")
        self.write("other.nhdr", self.read("scan.nhdr").replace(b"scan.raw", b"b_8x8x8_float32.raw"))
        self.fail(2, "convert", "other.nhdr", "b_8x8x8_float32.raw", says=("OUT", "would replace VOLUME"))
        self.fail(2, "convert", "scan.nhdr", "new.nhdr", "--report", "new.raw", says=("--report", "OUT is written there"))


class DataFiles(CommandLineTest):
    """`convert v.nrrd d.nhdr` writes d.raw, which nobody has named."""

    def test_of_others_are_not_replaced(self):
        self.write("b_2x2x2_uint8.raw", bytes(range(8)))
        self.fail(1, "convert", "b_2x2x2_uint8.raw", "b_2x2x2_uint8.nhdr", says="b_2x2x2_uint8.raw is there already")
        self.succeed("convert", "b_2x2x2_uint8.raw", "d.nhdr")
        self.succeed("convert", "gen:sphere:4", "d.nhdr")
        os.remove(self.path("d.nhdr"))
        self.fail(1, "convert", "gen:sphere:4", "d.nhdr", says=("d.nhdr", "d.raw is there already"))

    def test_have_names_that_headers_can_give(self):
        for name in (" a.nhdr", "a\nb.nhdr"):
            self.fail(2, "convert", "gen:sphere:4", name, says="cannot name its data file")

    def test_of_a_header_that_is_replaced_stay_and_are_told_of(self):
        self.succeed("convert", "gen:sphere:4", "d.nhdr")
        told = self.succeed("convert", "gen:sphere:4", "d.nhdr", "--compress").stderr
        self.assertIn("d.raw: the data of the header that was replaced", told)
        self.assertTrue(os.path.exists(self.path("d.raw")))
        self.assertNotIn("replaced", self.succeed("convert", "gen:sphere:4", "d.nhdr", "--compress").stderr)


class DanglingLinks(CommandLineTest):
    def test_stay_and_lead_to_the_file(self):
        os.symlink("there.nrrd", self.path("link.nrrd"))
        self.succeed("convert", "gen:sphere:4", "link.nrrd")
        self.assertTrue(os.path.islink(self.path("link.nrrd")))
        self.assertTrue(self.read("there.nrrd").startswith(b"NRRD"))
        os.symlink("content", self.path("mesh.ply"))  # whose name has no ending: that of the link says the format
        self.succeed("extract", "gen:sphere:8", "--iso", -0.3, "-o", "mesh.ply")
        self.assertTrue(self.read("content").startswith(b"ply\n"))
        self.fail(2, "bake", "gen:sphere:4", "-o", "new.nrrd", "--report", self.link_to("new.nrrd"), says="--output is written there")

    def link_to(self, name):
        os.symlink(name, self.path("to-" + name))
        return "to-" + name


class Rounding(CommandLineTest):
    """Volumes are floats; what a wider type loses by that is told."""

    def test_of_wide_types_is_told_by_convert(self):
        def warned(kind, code, values):
            file = f"v_2x2x2_{kind}.raw"
            self.write(file, struct.pack("<8" + code, *values))
            done = self.succeed("convert", file, f"w_2x2x2_{kind}.raw", "--quiet")
            return done.stderr.count("isolux: warning: " + file)

        self.assertEqual(warned("int32", "i", range(-4, 4)), 0)
        self.assertEqual(warned("int32", "i", [0] * 7 + [2**24 + 1]), 1)
        self.assertEqual(warned("int64", "q", [0] * 7 + [-(2**53)]), 1)
        self.assertEqual(warned("float64", "d", [0.1] * 8), 1)
        self.assertEqual(warned("float32", "f", [1e30] * 8), 0)
        self.assertEqual(warned("uint16", "H", [65535] * 8), 0)


if __name__ == "__main__":
    unittest.main()
