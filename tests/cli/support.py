"""Runs the isolux program as a user's script would. ISOLUX_BIN names it."""
import json
import os
import struct
import subprocess
import tempfile
import unittest

ISOLUX = os.environ["ISOLUX_BIN"]


class CommandLineTest(unittest.TestCase):
    """Each test works in a folder of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, content):
        with open(self.path(name), "wb") as file:
            file.write(content.encode() if isinstance(content, str) else content)
        return self.path(name)

    def read(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def isolux(self, *arguments):
        return subprocess.run([ISOLUX, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True, timeout=300)

    def succeed(self, *arguments):
        done = self.isolux(*arguments)
        self.assertEqual(done.returncode, 0, f"{arguments}: {done.stderr}")
        return done

    def fail(self, status, *arguments, says=()):
        """The command must end with `status`, one line on stderr holding all of `says`, and no new file in the folder."""
        before = sorted(os.listdir(self.folder))
        done = self.isolux(*arguments)
        self.assertEqual(done.returncode, status, f"{arguments}: {done.stderr}")
        lines = [line for line in done.stderr.splitlines() if not line.startswith("isolux: warning: ")]
        self.assertEqual(len(lines), 1, f"{arguments}: one line wanted: {done.stderr!r}")
        self.assertTrue(lines[0].startswith("isolux: error: "), done.stderr)
        for word in [says] if isinstance(says, str) else says:
            self.assertIn(word, lines[0])
        self.assertEqual(sorted(os.listdir(self.folder)), before, f"{arguments}: files were left")
        return done

    def report(self, name="report.json"):
        return json.loads(self.read(name))


def nrrd_header(path):
    """The fields and key/value pairs of a NRRD file, and its data."""
    with open(path, "rb") as file:
        content = file.read()
    head, data = content.split(b"\n\n", 1)
    fields = {}
    order = []
    for line in head.decode().splitlines()[1:]:
        if line.startswith("#"):
            continue
        key, value = line.split(":=", 1) if ":=" in line else line.split(": ", 1)
        fields[key] = value
        order.append(key)
    return fields, order, data


def ply(path):
    """(header lines, vertices as tuples, faces as tuples) of a binary little-endian PLY of floats and uchars."""
    with open(path, "rb") as file:
        content = file.read()
    head, data = content.split(b"end_header\n", 1)
    lines = head.decode().splitlines()
    codes = {"float": "f", "uchar": "B", "uint8": "B", "float32": "f"}
    vertices = faces = 0
    layout = "<"
    for line in lines:
        words = line.split()
        if words[:2] == ["element", "vertex"]:
            vertices = int(words[2])
        elif words[:2] == ["element", "face"]:
            faces = int(words[2])
        elif words[0] == "property" and words[1] != "list":
            layout += codes[words[1]]
    size = struct.calcsize(layout)
    points = [struct.unpack_from(layout, data, i * size) for i in range(vertices)]
    triangles = [struct.unpack_from("<B3i", data, vertices * size + i * 13)[1:] for i in range(faces)]
    return lines, points, triangles
