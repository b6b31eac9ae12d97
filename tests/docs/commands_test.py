# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
"""The commands that README and docs show are run as they stand, in a workplace made for them.

    commands_test.py PROGRAM

What is not run is said, with the reason; of that, and of commands within sentences, at least every
option is one that the program has. Real data is looked for in VICINITY_DATA.
"""

import concurrent.futures
import functools
import json
import os
import pathlib
import re
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import unittest
import urllib.request

import workplace
from workplace import BUILT, REPOSITORY

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
DATA = pathlib.Path(os.environ.get("VICINITY_DATA", "")).resolve()
DOCUMENTS = [REPOSITORY / "README.md", *sorted((REPOSITORY / "docs").glob("*.md"))]


@functools.cache
def options_of(*words):
    done = subprocess.run([PROGRAM, *words, "--help"], capture_output=True, text=True)
    return re.findall(r"-{1,2}[a-z][\w-]*", done.stdout) if done.returncode == 0 else None


def has_bridge():
    return options_of("bridge") is not None


@functools.cache
def may_make_machines():
    """A container's root may have the device and not the right to use it: tried, not asked."""
    if os.geteuid() != 0 or not shutil.which("ip"):
        return False
    name = f"vicinity_trial_{os.getpid()}"
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    if subprocess.run(["ip", "netns", "add", name], **quiet).returncode != 0:
        return False
    inside = ["ip", "netns", "exec", name, "ip", "tuntap", "add", "dev", "trial", "mode", "tun"]
    made = subprocess.run(inside, **quiet).returncode == 0
    subprocess.run(["ip", "netns", "delete", name], **quiet)
    return made


# How a command that is not run begins, and why; and what others need, to be run.
NOT_RUN = [
    (r"scripts/test\.sh", "CI is that itself"),
    (r"scripts/bench\.sh", "builds the libraries beside it and measures for minutes"),
    (r"scripts/try_packages\.sh", "installs a Debian: ten minutes; tests/package does it in small"),
    (r"cmake --preset", "builds all of it anew"),
    (r"pip wheel |python3 -m venv |venv/bin/pip ", "tests/python/wheel_test.py does just that"),
    (r"VICINITY_STORM=", "takes minutes; viewer_test runs it shorter"),
    (r"\(cd apps/viewer/page ", "measures in a browser"),
]
NEEDS = [
    (r"vicinity serve ", lambda: options_of("serve") is not None, "this build has no viewer"),
    (r"vicinity serve .* --shot ", lambda: shutil.which("chromium"), "there is no chromium on PATH"),
    (r"vicinity bridge |scripts/dds_|scripts/two_", has_bridge, "this build has no bridge"),
    (r"scripts/two_machines", may_make_machines, "it needs root, network namespaces, TUN and iproute2"),
]
# What takes minutes as it stands, and how it is made short.
SHORTER = [
    ("vicinity simulate --demo -o study", "vicinity simulate --demo --trials 1 --method none -o study"),
    ("--trials 50 --method none,closing,rising", "--trials 1 --method none"),
    ("--voxel-size 0.01 ", "--voxel-size 0.02 "),
    ("scripts/two_machines.sh 10 7", "scripts/two_machines.sh 0.1 1"),
    ("--shot ", "--port 0 --shot "),
]
# What still takes half a minute, most of which it waits: beside the others.
SLOW = r"scripts/two_machines|vicinity serve .*--shot"
# These run until Ctrl-C as they stand: here at once with those of their block, and not for long.
LASTS = r"vicinity (serve (?!.*--shot)|bridge )"
LASTING_S = 5
DOMAIN = 70 + os.getpid() % 30  # other tests have others
NEEDS_DATA = "$DATA"


def blocks(document, language):
    text = document.read_text(encoding="utf-8")
    return re.findall(rf"^```{language}\n(.*?)^```", text, re.DOTALL | re.MULTILINE)


def commands(block):
    """Whole commands: lines that are continued, and loops to their end, are one."""
    whole, depth = "", 0
    for line in block.splitlines():
        whole += line + "\n"
        depth += len(re.findall(r"^\s*for ", line)) - len(re.findall(r"\bdone\b", line))
        if line.rstrip().endswith("\\") or depth > 0:
            continue
        if whole.strip() and not whole.lstrip().startswith("#"):
            yield whole
        whole = ""
    assert not whole.strip(), f"not a whole command: {whole}"


def within_sentences(document):
    """Scripts, and what serves or bridges; other commands within sentences may be half ones."""
    text = document.read_text(encoding="utf-8")
    text = re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE)
    return re.findall(r"`(scripts/[^`]*|vicinity (?:serve|bridge) [^`]*)`", text)


def in_short(command):
    """Without what only a reader needs: comments, line breaks and where the program was built."""
    words = re.sub(r"\\\n|\s#.*", " ", command).split()
    return " ".join(words).removeprefix(BUILT)


def why_not_run(command):
    for start, why in NOT_RUN:
        if re.match(start, command):
            return why
    return next((why for start, met, why in NEEDS if re.match(start, command) and not met()), None)


def to_be_run():
    """By block: the document, and commands that can be run here, each once and made short."""
    seen = set()
    for document in DOCUMENTS:
        shown = [list(commands(block)) for block in blocks(document, "sh")]
        shown += [[command + "\n"] for command in within_sentences(document)]
        for block in shown:
            if NEEDS_DATA in "".join(block) and not (DATA / "scenes/ariac_workcell").is_dir():
                print(f"{document.name}: not run (no real data in VICINITY_DATA): {block[0]}")
                continue
            todo = []
            for command in block:
                for usual, short in SHORTER:
                    command = command.replace(usual, short)
                words = in_short(command)
                if words in seen:
                    continue
                seen.add(words)
                if why := why_not_run(words):
                    print(f"{document.name}: not run ({why}): {words}")
                else:
                    todo.append(command)
            if todo:
                yield document, todo


class Documents(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        workplace.make(self.folder, PROGRAM)
        paths = [self.folder / "doubles", self.folder / BUILT, os.environ["PATH"]]
        self.environment = {
            **os.environ,
            "PATH": ":".join(map(str, paths)),
            "DATA": str(DATA),
        }

    def start(self, words):
        return subprocess.Popen(
            words,
            cwd=self.folder,
            env=self.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )

    def run_in_workplace(self, script):
        process = self.start(["bash", "-euc", script])
        out, err = process.communicate()
        return subprocess.CompletedProcess(script, process.returncode, out, err)

    def page_of(self, process):
        """What a browser gets at the address that a server says."""
        said = ""
        for line in process.stdout:
            said += line
            if address := re.search(r"Open (http://127\.0\.0\.1:\d+/)", said):
                with urllib.request.urlopen(address.group(1), timeout=5) as answer:
                    return answer.read().decode()
        return self.fail(f"no address: {said}{process.stderr.read()}")

    def run_for_a_while(self, command):
        words = shlex.split(command.replace("\\\n", " "), comments=True)
        serves = words[1] == "serve"
        words += ["--port", "0"] if serves else ["--domain", str(DOMAIN)]
        words += ["--seconds", str(LASTING_S)]
        copy = self.folder / words[2] if "--follow-field" in words else None
        if copy:
            copy.unlink(missing_ok=True)
        process = self.start(words)
        if serves:
            self.assertRegex(self.page_of(process), "<title>|built without its page", command)
        out, err = process.communicate()
        self.assertEqual(process.returncode, 0, f"{command}\n{out}\n{err}")
        if not serves:
            self.assertRegex(err, r"bridging \d joints of .* in domain", command)
        if copy:
            self.assertTrue(copy.exists(), f"{command}\n{err}")

    def test_every_command_that_is_shown_runs(self):
        todo = list(to_be_run())
        slow = [block for _, block in todo if re.match(SLOW, in_short(block[0]))]
        pool = concurrent.futures.ThreadPoolExecutor()
        self.addCleanup(pool.shutdown)
        beside = [(block, pool.submit(self.run_in_workplace, "".join(block))) for block in slow]
        for document, block in todo:
            if block not in slow:
                self.run_block(document, block, pool)
        for block, result in beside:
            done = result.result()
            self.assertEqual(done.returncode, 0, f"{block}\n{done.stdout}\n{done.stderr}")
        self.assertGreater(len(todo), 10)

    def run_block(self, document, block, pool):
        lasting = [command for command in block if re.match(LASTS, in_short(command))]
        script = "".join(command for command in block if command not in lasting)
        for command in commands(script):
            allowed = r"^(\S*/)?vicinity |^scripts/|^columns=|^for |^\n*$"
            self.assertRegex(command, allowed, document.name)
        if "cell.vicinity" in "".join(block) and not (self.folder / "cell.vicinity").exists():
            build = "vicinity build cell.yaml -o cell.vicinity\n"
            script = script if build.strip() in script else build + script
        done = self.run_in_workplace(script)
        would_install = self.folder / "would_install"
        if would_install.exists():
            print(f"{document.name}: not run (packages are missing): {script}")
            would_install.unlink()
        elif "built without the simulation" in done.stderr:
            print(f"{document.name}: not run (this build has no simulation): {script}")
        else:
            self.assertEqual(done.returncode, 0, f"{document.name}\n{script}\n{done.stderr}")
            list(pool.map(self.run_for_a_while, lasting))

    @unittest.skipUnless(options_of("serve"), "this build has no viewer")
    def test_the_demo_is_served_as_it_says(self):
        self.run_in_workplace("scripts/install_packages.sh --viewer")
        if (self.folder / "would_install").exists():
            self.skipTest("packages are missing")
        with socket.socket() as port:
            if port.connect_ex(("127.0.0.1", 8080)) == 0:
                self.skipTest("port 8080 is taken")
        process = self.start(["scripts/demo.sh", "--serve"])
        self.addCleanup(process.kill)
        self.assertRegex(self.page_of(process), "<title>|built without its page")
        self.assertTrue((self.folder / "vicinity-demo/index.html").exists())
        process.send_signal(signal.SIGINT)  # it has become vicinity serve
        out, err = process.communicate(timeout=20)
        self.assertEqual(process.returncode, 0, f"{out}\n{err}")

    def test_every_option_that_is_shown_is_there(self):
        shown = []
        for document in DOCUMENTS:
            text = document.read_text(encoding="utf-8")
            text = re.sub(r"^```(?!sh).*?^```", "", text, flags=re.DOTALL | re.MULTILINE)
            shown += re.findall(rf"`((?:{BUILT})?vicinity [a-z][^`]*)`", text)
            shown += [c for block in blocks(document, "sh") for c in commands(block)]
        asked = 0
        for command in shown:
            for call in re.findall(r"(?:^|[\s/])vicinity ((?:[^\n\\]|\\\n)+)", command):
                words = shlex.split(call.replace("\\\n", " "), comments=True)
                known = options_of(words[0])
                if known is None and words[0] in ("serve", "bridge"):
                    continue  # this build is without it
                self.assertIsNotNone(known, command)
                if words[0] == "bench":
                    known = options_of(*words[:2])
                for word in words:
                    if re.match(r"-{1,2}[a-z]", word):
                        self.assertIn(word.split("=")[0], known, command)
                asked += 1
        self.assertGreater(asked, 15)

    def test_every_line_of_cpp_is_one_of_an_example_that_is_compiled(self):
        examples = sorted((REPOSITORY / "examples").glob("*/main.cpp"))
        lines = {line.strip() for e in examples for line in e.read_text().splitlines()}
        for document in DOCUMENTS:
            for block in blocks(document, "cpp"):
                for line in block.splitlines():
                    if line.strip():
                        self.assertIn(line.strip(), lines, document.name)

    def test_every_json_is_json(self):
        for document in DOCUMENTS:
            for block in blocks(document, "json"):
                json.loads(block)

    def test_every_block_is_of_a_kind_that_is_looked_at(self):
        for document in DOCUMENTS:
            text = document.read_text(encoding="utf-8")
            kinds = re.findall(r"^```(\w*)\n.*?^```", text, re.DOTALL | re.MULTILINE)
            # Python is run by tests/python/examples_test.py; yaml and xml are other programs' own.
            self.assertLessEqual(set(kinds), {"sh", "cpp", "python", "json", "xml", "yaml", ""})


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
