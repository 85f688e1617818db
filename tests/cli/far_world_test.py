"""Volumes so far from the world's origin that floats, which meshes are made of, tell their voxels apart badly."""
import unittest

from support import CommandLineTest, ply


class FarWorld(CommandLineTest):
    def test_probe_takes_the_rim_of_a_mesh(self):
        # A float's steps are an eighth along x, of voxels of .3, and nothing along y and z.
        n, far = 8, 2.0**20
        head = ("NRRD0005\ntype: uchar\ndimension: 3\nspace dimension: 3\nsizes: 8 8 8\nencoding: raw\n"
                f"space directions: (.3,0,0) (0,1,0) (0,0,2)\nspace origin: ({far + 0.07},0,0)\n\n")
        self.write("far.nrrd", head.encode() + bytes(12 * (i + j + k) for k in range(n) for j in range(n) for i in range(n)))
        self.succeed("bake", "far.nrrd", "-o", "light.nrrd", "--bounces", 0, "--rays", 1, "--quiet")
        done = self.succeed("extract", "far.nrrd", "--iso", 125, "-o", "mesh.ply")
        self.assertRegex(done.stderr, "warning: .* tell 2.4 places a voxel apart")
        vertices = ply(self.path("mesh.ply"))[1]
        self.assertTrue(any(v[0] > far + 0.07 + 0.3 * (n - 1) or v[0] < far + 0.07 for v in vertices), "no rim beyond the box")
        far_off = f"{far + 0.07 - 2},1,1\n{far + 1},-.001,1\n{far + 1},1,14.001\n"
        self.write("points.csv", "".join(f"{v[0]!r},{v[1]!r},{v[2]!r}\n" for v in vertices) + far_off)
        done = self.succeed("probe", "far.nrrd", "--light", "light.nrrd", "--points", "points.csv", "-o", "out.csv")
        rows = self.read("out.csv").decode().splitlines()[1:]
        self.assertEqual(len(rows), len(vertices) + 3)
        self.assertEqual(sum(row.endswith("nan") for row in rows[:-3]), 0)
        self.assertTrue(all(row.endswith("nan") for row in rows[-3:]))
        self.assertIn("3 of", done.stderr)


if __name__ == "__main__":
    unittest.main()
