"""What a README shows as a whole program is an example that is compiled, word by word."""
import glob
import os
import re
import unittest

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


def text(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


class Readme(unittest.TestCase):
    def test_shows_examples_as_they_are(self):
        programs = 0
        for readme in glob.glob(os.path.join(ROOT, "modules", "*", "README.md")):
            examples = [text(path) for path in glob.glob(os.path.join(os.path.dirname(readme), "examples", "*.cpp"))]
            for block in re.findall(r"```cpp\n(.*?)```", text(readme), re.DOTALL):
                if "int main(" not in block:
                    continue
                programs += 1
                self.assertIn(block, examples, readme)
        self.assertGreater(programs, 0)


if __name__ == "__main__":
    unittest.main()
