"""docs/command-line.md against the program: its tables of options, and its examples."""
import os
import re
import shlex
import unittest

from support import CommandLineTest

PAGE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../docs/command-line.md")
COMPANIONS = ("view", "bench")  # programs beside isolux, which a build may leave out


def sections():
    """The text of each section of the page by its title."""
    with open(PAGE, encoding="utf-8") as file:
        parts = re.split(r"^## (.*)\n", file.read(), flags=re.MULTILINE)
    return dict(zip(parts[1::2], parts[2::2]))


def documented(section):
    """The row of each option that the tables of a section have."""
    rows = {}
    for row in re.findall(r"^\| `-.*", section, re.MULTILINE):
        for option in re.findall(r"--[a-z-]+", row.split("|")[1]):
            rows[option] = row
    return rows


def helped(text):
    """The words that --help allows for each option; none where it does not list them."""
    options = {}
    for names, rest in re.findall(r"^  (-\S+)(.*)", text, re.MULTILINE):
        words = re.match(r" \w+:\{(.*?)\}", rest)
        for option in re.findall(r"--[a-z-]+", names):
            options[option] = words.group(1).split(",") if words else []
    return options


class Documentation(CommandLineTest):
    def help_of(self, command):
        """None of a program that this build has not."""
        done = self.isolux(command, "--help")
        if command in COMPANIONS and done.returncode != 0:
            self.assertIn("isolux-" + command, done.stderr)
            return None
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_tables_have_the_options_of_help(self):
        page = sections()
        commands = re.findall(r"^  ([a-z]+) ", self.succeed("--help").stdout.split("Subcommands:")[1], re.MULTILINE)
        self.assertGreater(len(commands), 8)
        for command in commands:
            text = self.help_of(command)
            if text is None:
                continue
            rows = documented(page[command]) | documented(page["Every command"])
            if "VOLUME" in text.splitlines()[1]:
                rows |= documented(page["Volumes"])
            options = helped(text)
            self.assertEqual(sorted(rows), sorted(options), command)
            for option, words in options.items():
                for word in words:
                    self.assertIn(f"`{word}`", rows[option], f"{command} {option}")

    def test_examples_run(self):
        self.write("points.csv", "x,y,z,name\n.5,.5,.5,middle\n.1,.2,.3,corner\n")
        for name in ("ct_8x8x8_uint8.raw", "ct.bin"):
            self.write(name, bytes(range(256)) * 2)
        run = 0
        for title, section in sections().items():
            for example in re.findall(r"^    isolux (.*)", section, re.MULTILINE):
                if title in COMPANIONS:
                    continue
                self.succeed(*shlex.split(example))
                run += 1
        self.assertGreater(run, 12)


if __name__ == "__main__":
    unittest.main()
