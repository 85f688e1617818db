"""Runs the isolux program as a user's script would. ISOLUX_BIN names it."""
import json
import os
import struct
import subprocess
import tempfile
import unittest
import zlib

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


def png(path):
    """Rows of (red, green, blue) bytes of a PNG of 8-bit RGB."""
    with open(path, "rb") as file:
        content = file.read()
    width, height, depth, kind = struct.unpack(">2I2B", content[16:26])
    assert (depth, kind) == (8, 2), "8-bit RGB is wanted"
    packed = b""
    at = 8
    while at < len(content):
        size, name = struct.unpack_from(">I4s", content, at)
        if name == b"IDAT":
            packed += content[at + 8:at + 8 + size]
        at += 12 + size
    data = zlib.decompress(packed)
    rows = []
    above = bytearray(3 * width)
    for y in range(height):
        start = y * (3 * width + 1)
        row = bytearray(data[start + 1:start + 1 + 3 * width])
        unfilter(data[start], row, above)
        rows.append([tuple(row[x:x + 3]) for x in range(0, 3 * width, 3)])
        above = row
    return rows


def unfilter(kind, row, above):
    """Undoes a PNG row's filter: the bytes are differences from what is left (a), above (b) and left above (c)."""
    for i, value in enumerate(row):
        a = row[i - 3] if i >= 3 else 0
        b = above[i]
        c = above[i - 3] if i >= 3 else 0
        nearest = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]  # Paeth's
        row[i] = (value + (0, a, b, (a + b) // 2, nearest)[kind]) % 256
