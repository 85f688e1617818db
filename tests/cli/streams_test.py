"""What a program does beside its work: full disks, closed streams, files in its way, interrupts."""
import os
import resource
import signal
import struct
import subprocess
import time
import unittest

from support import ISOLUX, CommandLineTest


def small_disk():
    """Writing beyond 1000 bytes fails, as on a full disk; programs that do not see to it would be killed for it."""
    signal.signal(signal.SIGXFSZ, signal.SIG_DFL)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))


def small_memory():
    resource.setrlimit(resource.RLIMIT_AS, (1 << 30, 1 << 30))


class SmallMemory(CommandLineTest):
    def test_is_said_before_the_work(self):
        def run(*arguments):
            return subprocess.run([ISOLUX, *arguments], cwd=self.folder, capture_output=True, text=True, preexec_fn=small_memory)
        if run("info", "gen:sphere:9").returncode != 0:
            self.skipTest("the program, as it is built, takes more addresses than that for itself")
        done = run("bake", "gen:noise:120", "-o", "light.nrrd", "--quiet", "--resampler", "fit", "--rays", "1", "--threads", "2")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertRegex(done.stderr, r"^isolux: warning: this takes about \d\.\d GB of memory beside the volume, and [01]\.\d GB are free: "
                                      r"--resampler direct, --bounce-method paths or an --iso-range take less\n"
                                      r"isolux: error: bake: not enough memory for [^\n]*\n$")
        self.assertEqual(os.listdir(self.folder), [])
        done = run("bake", "gen:noise:120", "-o", "light.nrrd", "--quiet", "--rays", "1", "--threads", "2", "--bounces", "0", "--report", "r.json")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        report = self.report("r.json")
        self.assertTrue(0.5 < report["memory_bytes_foreseen"] / report["peak_memory_bytes"] < 1.5, report)

    def test_ends_every_extraction_in_one_line(self):
        """Wherever memory ends: a mesh is made of many arrays."""
        def run(megabytes):
            limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (megabytes << 20, megabytes << 20))
            command = [ISOLUX, "extract", "gen:noise:40", "--iso", "0.5", "-o", "mesh.ply", "--quiet"]
            return subprocess.run(command, cwd=self.folder, capture_output=True, text=True, preexec_fn=limit)
        if run(1 << 10).returncode != 0:
            self.skipTest("the program, as it is built, takes more addresses than that for itself")
        os.remove(self.path("mesh.ply"))
        least, enough = 20, 1 << 10
        while enough - least > 1:
            middle = (least + enough) // 2
            least, enough = (least, middle) if run(middle).returncode == 0 else (middle, enough)
        os.remove(self.path("mesh.ply"))
        for megabytes in range(enough - 16, enough, 2):
            done = run(megabytes)
            if done.returncode != 0:
                self.assertEqual(done.returncode, 1, f"{megabytes} MB: {done.stderr}")
                self.assertRegex(done.stderr, r"^isolux: error: extract: [^\n]*\n$")
                self.assertEqual(os.listdir(self.folder), [])


class FewThreads(CommandLineTest):
    """What a system does not let a program start it has to do without."""

    def test_by_memory_for_their_stacks_do_the_work_of_many(self):
        def run(output, threads):
            command = [ISOLUX, "bake", "gen:noise:40", "-o", output, "--rays", "1", "--quiet", "--threads", str(threads)]
            limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (400 << 20, 400 << 20))
            return subprocess.run(command, cwd=self.folder, capture_output=True, text=True, preexec_fn=limit)
        if run("few.nrrd", 2).returncode != 0:
            self.skipTest("the program, as it is built, takes more addresses than that for itself")
        done = run("many.nrrd", 2000)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(self.read("many.nrrd"), self.read("few.nrrd"))

    def test_of_one_are_said_in_one_line(self):
        def one_process():
            if os.getuid() == 0:  # whom this limit does not hold
                os.setgid(65534)
                os.setuid(65534)
            resource.setrlimit(resource.RLIMIT_NPROC, (1, 1))
        try:
            done = subprocess.run([ISOLUX, "info", "gen:sphere:4"], capture_output=True, text=True, preexec_fn=one_process)
        except PermissionError:
            self.skipTest("the program is where others may not run it")
        if done.returncode != 0:  # no thread at all; elsewhere a user may have one
            self.assertEqual(done.returncode, 1, done.stderr)
            self.assertRegex(done.stderr, r"^isolux: error: [\w ]+: no thread can be started: [^\n]*\n$")


class FullDisk(CommandLineTest):
    def test_leaves_an_error_that_names_the_file_and_no_half_file(self):
        self.succeed("bake", "gen:sphere:16", "-o", "light.nrrd", "--rays", 1, "--quiet")
        self.write("points.csv", "0.5,0.5,0.8\n" * 100)
        before = sorted(os.listdir(self.folder))
        surface = ("--iso", "-0.3")
        commands = [("extract", "gen:sphere:16", *surface, "-o", "out" + end) for end in (".ply", ".glb", ".obj", ".off", ".stl")]
        commands += [("render", "gen:noise:16", "--iso", "0.5", "-o", "out.png", "--size", "100x100"),
                     ("bake", "gen:sphere:16", "-o", "out.nrrd", "--rays", "1", "--quiet"),
                     ("convert", "gen:sphere:16", "out.nrrd"),
                     ("probe", "gen:sphere:16", "--light", "light.nrrd", "--points", "points.csv", "-o", "out.csv")]
        for command in commands:
            with self.subTest(command=command):
                done = subprocess.run([ISOLUX, *command], cwd=self.folder, capture_output=True, text=True, preexec_fn=small_disk)
                self.assertEqual(done.returncode, 1, done.stderr)
                self.assertRegex(done.stderr, r"^isolux: error: \w+: out\.\w+: [^\n]*\n$")
                self.assertEqual(sorted(os.listdir(self.folder)), before)

    @unittest.skipUnless(os.path.exists("/dev/full"), "there is no /dev/full here")
    def test_behind_standard_output_is_an_error(self):
        for command in (("info", "gen:sphere:4"), ("info", "gen:sphere:4", "--json"), ("backends",), ("backends", "--json"),
                        ("--version",), ("--help",), ("bake", "--help")):
            with open("/dev/full", "w") as full:
                done = subprocess.run([ISOLUX, *command], stdout=full, stderr=subprocess.PIPE, text=True)
            self.assertEqual(done.returncode, 1, command)
            self.assertRegex(done.stderr, r"^isolux: error: [\w ]+: standard output: writing failed: No space left on device\n$")


class StandardStreams(CommandLineTest):
    def test_of_output_that_are_closed_are_an_error_where_something_is_said(self):
        for command in ("info gen:sphere:4", "info gen:sphere:4 --json --report info.json", "backends", "backends --json", "--version", "--help"):
            for closed in (">&-", "<&- >&-"):
                done = subprocess.run(f"'{ISOLUX}' {command} {closed}", shell=True, cwd=self.folder, stderr=subprocess.PIPE, text=True)
                self.assertEqual(done.returncode, 1, command)
                self.assertRegex(done.stderr, r"^isolux: error: [\w ]+: standard output: writing failed: Bad file descriptor\n$")
        self.assertIn("seconds", self.report("info.json"))  # and nothing else is in there

    def test_that_are_closed_or_full_lose_no_work(self):
        bake = f"'{ISOLUX}' bake gen:sphere:12 --rays 4 -o "
        subprocess.run(bake + "usual.nrrd", shell=True, cwd=self.folder, check=True, capture_output=True)
        subprocess.run(bake + "closed.nrrd <&- >&- 2>&-", shell=True, cwd=self.folder, check=True)
        self.assertEqual(self.read("closed.nrrd"), self.read("usual.nrrd"))
        if os.path.exists("/dev/full"):
            subprocess.run(bake + "full.nrrd 2> /dev/full", shell=True, cwd=self.folder, check=True)
            self.assertEqual(self.read("full.nrrd"), self.read("usual.nrrd"))

    def test_get_no_control_characters_of_a_broken_file(self):
        self.write("bell.nrrd", b"NRRD0004\ntype: \x1b[2J\x07" + b"x" * 5000 + b"\ndimension: 3\nsizes: 1 1 1\n\n")
        line = self.fail(1, "info", "bell.nrrd", says=("bell.nrrd", "type")).stderr
        self.assertFalse(any(ord(c) < 32 for c in line.rstrip("\n")), repr(line[:100]))
        self.assertLess(len(line), 1200)

    def test_get_whole_lines_of_text_with_zero_bytes(self):
        self.write("nul.json", '{"a\\u0000bcd": 1}')
        self.fail(1, "bake", "gen:sphere:8", "-o", "l.nrrd", "--scene", "nul.json", says=("unknown key 'a bcd'", "environment"))

    def test_take_names_that_are_not_unicode(self):
        name = os.path.join(os.fsencode(self.folder), b"caf\xe9_2x2x2_uint8.raw")
        with open(name, "wb") as file:
            file.write(bytes(range(8)))
        done = subprocess.run([os.fsencode(ISOLUX), b"info", name, b"--json"], capture_output=True)
        self.assertEqual(done.returncode, 0, done.stderr)


class Outputs(CommandLineTest):
    def test_without_a_place_are_told_before_the_work(self):
        # The volume is not there either, but nobody has looked yet.
        for option in ("--error-grid", "--report"):
            self.fail(1, "bake", "gone.nrrd", "-o", "light.nrrd", option, "nowhere/a", says="nowhere/a")
        self.fail(1, "bake", "gone.nrrd", "-o", "nowhere/light.nrrd", says="nowhere/light.nrrd")
        self.fail(1, "convert", "gone.nrrd", "nowhere/a.nrrd", says="nowhere/a.nrrd")

    def test_never_replace_what_is_read_or_one_another(self):
        self.succeed("convert", "gen:sphere:8", "scan.nrrd")
        scan = self.read("scan.nrrd")
        self.fail(2, "bake", "scan.nrrd", "-o", "./scan.nrrd", says=("--output", "VOLUME"))
        self.fail(2, "bake", "scan.nrrd", "-o", "light.nrrd", "--error-grid", "scan.nrrd", says=("--error-grid", "VOLUME"))
        self.fail(2, "bake", "scan.nrrd", "-o", "light.nrrd", "--error-grid", "light.nrrd", says=("--error-grid", "--output"))
        self.fail(2, "bake", "scan.nrrd", "-o", "light.nrrd", "--report", "light.nrrd", says=("--report", "--output"))
        self.assertEqual(self.read("scan.nrrd"), scan)
        self.succeed("bake", "scan.nrrd", "-o", "/dev/null", "--report", "/dev/null", "--rays", 1, "--quiet")
        self.succeed("convert", "scan.nrrd", "scan.nrrd", "--compress")  # in place: nothing is lost


class OpenFiles(CommandLineTest):
    def test_are_written_to_as_they_are(self):
        self.succeed("convert", "gen:sphere:8", "scan.nrrd")
        os.symlink("/dev/stdout", self.path("out.nrrd"))
        command = [ISOLUX, "convert", "gen:sphere:8", "out.nrrd", "--quiet"]
        through = subprocess.run(command, cwd=self.folder, capture_output=True)
        self.assertEqual((through.returncode, through.stdout), (0, self.read("scan.nrrd")), through.stderr)
        self.write("log", "first")
        with open(self.path("log"), "ab") as log:
            done = subprocess.run(command, cwd=self.folder, stdout=log, stderr=subprocess.PIPE)
            self.assertEqual(done.returncode, 0, done.stderr)
            log.write(b"last")
        self.assertEqual(self.read("log"), b"first" + self.read("scan.nrrd") + b"last")
        self.assertTrue(os.path.islink(self.path("out.nrrd")))

    def test_get_meshes_by_way_of_a_file_that_does_not_stay(self):
        os.symlink("/dev/stdout", self.path("mesh.ply"))
        os.mkdir(self.path("temporary"))
        command = f"TMPDIR=%s '{ISOLUX}' extract gen:noise:32 --iso 0.5 -o mesh.ply --quiet"
        went_away = subprocess.run((command % "temporary") + " | head -c 1", shell=True, cwd=self.folder, stdout=subprocess.PIPE, check=True)
        self.assertEqual(went_away.stdout, b"p")
        self.assertEqual(os.listdir(self.path("temporary")), [])
        nowhere = subprocess.run(command % "nowhere", shell=True, cwd=self.folder, capture_output=True, text=True)
        self.assertEqual((nowhere.returncode, nowhere.stdout), (1, ""))
        self.assertRegex(nowhere.stderr, r"^isolux: error: extract: mesh\.ply: [^\n]*TMPDIR[^\n]*\n$")

    def test_in_a_linked_folder_have_their_data_beside_them(self):
        os.mkdir(self.path("real"))
        os.mkdir(self.path("links"))
        os.symlink("../real/h.nhdr", self.path("links/l.nhdr"))
        self.succeed("convert", "gen:torus:8", "links/l.nhdr")
        self.assertEqual(sorted(os.listdir(self.path("real"))), ["h.nhdr", "h.raw"])
        self.assertEqual(os.listdir(self.path("links")), ["l.nhdr"])
        self.succeed("info", "real/h.nhdr")


class Signals(CommandLineTest):
    def test_stop_cleanly(self):
        commands = [("bake", "gen:gyroid:64", "-o", "light.nrrd", "--rays", "4096")]
        if self.isolux("bench", "--help").returncode == 0:  # a build may leave it out
            commands.append(("bench", "trace", "-o", "results"))
        for command in commands:
            for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
                with self.subTest(command=command[0], signal=number):
                    process = subprocess.Popen([ISOLUX, *command], cwd=self.folder, stderr=subprocess.PIPE, text=True)
                    time.sleep(1.0)
                    process.send_signal(number)
                    _, errors = process.communicate(timeout=60)
                    self.assertEqual(process.returncode, 130, errors)
                    self.assertIn(f"isolux: error: {command[0]}: interrupted", errors)
                    self.assertEqual(os.listdir(self.folder), [])

    def start(self, *command, **how):
        process = subprocess.Popen([ISOLUX, *command], cwd=self.folder, stderr=subprocess.PIPE, text=True, **how)
        time.sleep(0.5)
        return process

    def test_that_come_twice_leave_one_line_and_no_file(self):
        for numbers in ((signal.SIGINT, signal.SIGTERM), (signal.SIGTERM, signal.SIGHUP), (signal.SIGTERM, signal.SIGTERM)):
            with self.subTest(signals=numbers):
                process = self.start("bake", "gen:gyroid:64", "-o", "light.nrrd", "--rays", "4096")
                for number in numbers:  # as timeout does, to the program and to its group
                    process.send_signal(number)
                _, errors = process.communicate(timeout=60)
                self.assertEqual(process.returncode, 130, errors)
                self.assertRegex(errors, r"^isolux: error: (bake|signal): interrupted[^\n]*\n$")
                self.assertEqual(os.listdir(self.folder), [])

    def test_of_a_hang_up_are_ignored_under_nohup(self):
        ignore = lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN)
        process = self.start("bake", "gen:gyroid:32", "-o", "light.nrrd", "--rays", "256", preexec_fn=ignore)
        process.send_signal(signal.SIGHUP)
        _, errors = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 0, errors)
        self.assertEqual(os.listdir(self.folder), ["light.nrrd"])


if __name__ == "__main__":
    unittest.main()
