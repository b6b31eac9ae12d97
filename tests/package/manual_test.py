# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
"""The manual page and the completions have every command and option that the program has.

    manual_test.py PROGRAM SHARE
"""

import pathlib
import re
import subprocess
import sys
import unittest

PROGRAM, SHARE = sys.argv[1], pathlib.Path(sys.argv[2])
BASH = SHARE / "bash-completion/completions/vicinity"


def help_of(*words):
    done = subprocess.run([PROGRAM, *words, "--help"], capture_output=True, text=True)
    if words == ("bridge",) and done.returncode == 2 and "vicinity-bridge" in done.stderr:
        return ""  # a program of its own, which was not built
    done.check_returncode()
    return done.stdout


def commands_of(*words):
    found = re.search(r"^Subcommands:\n((?:  .*\n)+)", help_of(*words), re.MULTILINE)
    return re.findall(r"^  (\S+)", found.group(1), re.MULTILINE) if found else []


def completed(*line):
    script = 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _vicinity'
    command = ["bash", "-c", script + '; printf "%s\\n" "${COMPREPLY[@]}"', "bash", BASH, *line]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.split()


class Manual(unittest.TestCase):
    def test_every_command_and_option_is_in_all_of_them(self):
        texts = {p.name: p.read_text(encoding="utf-8") for p in SHARE.rglob("*") if p.is_file()}
        self.assertEqual(set(texts), {"vicinity.1", "vicinity", "_vicinity", "vicinity.fish"})
        commands = [[name] for name in commands_of()]
        commands += [["bench", name] for name in commands_of("bench")]
        self.assertGreater(len(commands), 10)
        for words in commands:
            heads = re.findall(r"^  (-\S+)", help_of(*words), re.MULTILINE)
            for option in re.findall(r"--[a-z][\w-]+", "\n".join(heads)):
                if option == "--help":
                    continue
                self.assertIn(option.replace("-", "\\-"), texts["vicinity.1"])
                self.assertIn(option, texts["vicinity"])
                self.assertIn(f"'{option}[", texts["_vicinity"])
                self.assertIn(f"-l {option[2:]} ", texts["vicinity.fish"])

    def test_zsh_is_told_of_each_option_of_a_command_once(self):
        text = (SHARE / "zsh/site-functions/_vicinity").read_text(encoding="utf-8")
        for function in text.split("\n}\n"):
            spellings = re.findall(r"^    '(-[^[]*)\[", function, re.MULTILINE)
            self.assertEqual(sorted(spellings), sorted(set(spellings)))

    def test_bash_completes_commands_then_their_own_options(self):
        self.assertEqual(set(completed("vicinity", "")) & set(commands_of()), set(commands_of()))
        self.assertEqual(completed("vicinity", "build", "--voxel"), ["--voxel-size"])
        self.assertEqual(completed("vicinity", "query", "--voxel"), [])
        self.assertIn("--points", completed("vicinity", "bench", "tick", "--p"))
        self.assertEqual(completed("vicinity", "brid"), ["bridge"])
        bridge = ["--follow-field"] if help_of("bridge") else []
        self.assertEqual(completed("vicinity", "bridge", "--follow"), bridge)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
