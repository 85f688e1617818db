"""What the program says of itself, and what it is linked with."""
import json
import os
import resource
import shutil
import subprocess
import unittest

from support import ISOLUX, CommandLineTest


class Program(CommandLineTest):
    def test_version_and_help(self):
        self.assertRegex(self.succeed("--version").stdout, r"^isolux \d+\.\d+\.\d+\n$")
        for command in ("info", "backends", "extract", "bake", "render", "probe", "convert"):
            self.assertIn(command, self.succeed("--help").stdout)
            self.assertIn("--", self.succeed(command, "--help").stdout)
            self.assertEqual(self.succeed(command, "--version").stdout, self.succeed("--version").stdout)

    def test_the_window_is_found_in_a_folder_of_any_name(self):
        window = os.path.join(os.path.dirname(ISOLUX), "../viewer/isolux-view")
        if not os.path.exists(window):
            self.skipTest("no window in this build")
        os.mkdir(self.path("it's"))
        for program in (ISOLUX, window):
            shutil.copy(program, self.path("it's"))
        moved = subprocess.run([self.path("it's/isolux"), "backends", "--json"], capture_output=True, text=True, check=True).stdout
        uploaders = [[stage for stage in json.loads(text) if stage["stage"] == "uploader"]
                     for text in (moved, self.succeed("backends", "--json").stdout)]
        self.assertEqual(*uploaders)
        self.assertTrue(uploaders[0])

    def test_uses_memory_again(self):
        """A bake takes the same arrays for each of 64 parts of the isovalues. Brought anew each time, these are some 20
        times the pages that it has at its peak."""
        if b"__asan_init" in open(ISOLUX, "rb").read():
            self.skipTest("AddressSanitizer has an allocator of its own")
        words = ("bake", "gen:gyroid:192", "-o", self.path("l.nrrd"), "--rays", "1", "--bounces", "0", "--quiet", "--threads", "2")
        _, status, usage = os.wait4(os.posix_spawn(ISOLUX, (ISOLUX, *words), os.environ), 0)
        self.assertEqual(status, 0)
        self.assertLess(usage.ru_minflt * resource.getpagesize(), 2 * usage.ru_maxrss * 1024)

    def test_links_no_gl(self):
        linked = subprocess.run(["ldd", ISOLUX], capture_output=True, text=True, check=True).stdout.lower()
        for library in ("libgl.", "libglx", "libegl", "libopengl", "libglfw", "libepoxy", "libx11"):
            self.assertNotIn(library, linked)


if __name__ == "__main__":
    unittest.main()
