# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the manual page and the shells' completions from what the program says with --help.

    manual.py PROGRAM FOLDER

Leaves, below FOLDER, what belongs below a prefix's share/: man/man1/vicinity.1,
bash-completion/completions/vicinity, zsh/site-functions/_vicinity and
fish/vendor_completions.d/vicinity.fish.
"""

import dataclasses
import pathlib
import re
import subprocess
import sys


@dataclasses.dataclass
class Entry:
    """A line of help: "-o,--output TEXT REQUIRED   the field to write"."""

    head: str
    says: str

    @property
    def names(self):
        return [word for word in self.head.split(" ")[0].split(",") if word.startswith("-")]

    @property
    def takes_value(self):
        return " " in self.head

    @property
    def shown(self):
        """The head without what only a parser cares about: "--threads INT"."""
        without_check = re.sub(r":(\S+ in \[.*\]|POSITIVE|NONNEGATIVE)", "", self.head)
        return without_check.replace(" REQUIRED", "")


@dataclasses.dataclass
class Command:
    words: list
    does: str
    usage: str
    positionals: list
    options: list
    examples: list
    commands: list


def output_of(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def read_command(program, words, does=""):
    try:
        text = output_of(program, *words[1:], "--help")
    except subprocess.CalledProcessError as error:
        if error.returncode != 2:
            raise
        # A program of its own, as the bridge is, which is not here: known by its name alone.
        return Command(words, does, " ".join(words) + " ...", [], [], [], [])
    titles = r"^(Positionals|Options|Subcommands|Example):\n"
    head, *sections = re.split(titles, text, flags=re.MULTILINE)
    does, usage = re.match(r"(.*)\nUsage: (.*)\n", head).groups()
    entries = {"Positionals": [], "Options": [], "Subcommands": [], "Example": []}
    for name, body in zip(sections[::2], sections[1::2]):
        if name == "Example":
            entries[name] = [line.removeprefix("  ") for line in body.splitlines() if line.strip()]
            continue
        for line in body.splitlines():
            if line.startswith(" " * 10):
                entries[name][-1].says += line.strip()
            elif line.strip():
                label, _, says = line.strip().partition("  ")
                entries[name].append(Entry(label, says.strip()))
    commands = [read_command(program, words + [e.head], e.says) for e in entries["Subcommands"]]
    positionals, options, _, examples = entries.values()
    return Command(words, does, usage, positionals, options, examples, commands)


def and_below(command):
    yield command
    for below in command.commands:
        yield from and_below(below)


def path_of(command):
    return " ".join(command.words[1:])


def roff(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text.startswith((".", "'")) else text


def manual_page(root, version):
    lines = [f'.TH VICINITY 1 "" "vicinity {version}" "User Commands"']
    does = root.does[0].lower() + root.does[1:].rstrip(".")
    lines += [".SH NAME", f"vicinity \\- {roff(does)}"]
    lines += [".SH SYNOPSIS", ".B vicinity", roff(root.usage.removeprefix("vicinity "))]
    lines.append(".SH OPTIONS")
    for option in root.options:
        lines += [".TP", f".B {roff(option.shown)}", roff(option.says)]
    lines.append(".SH COMMANDS")
    for command in and_below(root):
        if command is root:
            continue
        lines += [f".SS {roff(path_of(command))}", roff(command.does) + "."]
        lines += [".PP", f".B {roff(command.usage)}"]
        for entry in command.positionals + [o for o in command.options if "--help" not in o.names]:
            lines += [".TP", f".B {roff(entry.shown)}", roff(entry.says)]
        if command.examples:
            lines += [".PP", "Example:", ".PP", ".nf", ".RS"]
            lines += [*map(roff, command.examples), ".RE", ".fi"]
    lines += [".SH EXIT STATUS", "0; 2 for input or options that cannot be used; 1 for a failure"]
    lines.append("of the program itself.")
    return "\n".join(lines) + "\n"


def bash(root):
    cases, values = [], set()
    for command in and_below(root):
        words = [below.words[-1] for below in command.commands]
        words += [name for option in command.options for name in option.names]
        cases.append(f'    "{path_of(command)}") words="{" ".join(words)}" ;;')
        for option in command.options:
            values |= set(option.names) if option.takes_value else set()
    commands = "|".join(f'"{path_of(c)}"' for c in and_below(root) if c is not root)
    return f"""# Completion of vicinity for bash, made from its --help.
_vicinity() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} command= words= n
  for ((n = 1; n < COMP_CWORD; ++n)); do
    case "${{command:+$command }}${{COMP_WORDS[n]}}" in
    {commands}) command="${{command:+$command }}${{COMP_WORDS[n]}}" ;;
    *) break ;;
    esac
  done
  case "$before" in
  {"|".join(sorted(values))}) COMPREPLY=($(compgen -f -- "$word")); return ;;
  esac
  case "$command" in
{chr(10).join(cases)}
  esac
  COMPREPLY=($(compgen -W "$words" -- "$word"))
  [[ $word == -* || -z $command ]] || COMPREPLY+=($(compgen -f -- "$word"))
}}
complete -o filenames -F _vicinity vicinity
"""


def zsh_quoted(text):
    return text.replace("'", "'\\''").replace("[", "\\[").replace("]", "\\]").replace(":", "\\:")


def zsh_name(command):
    return "_" + "_".join(command.words)


def zsh(root):
    functions = []
    for command in and_below(root):
        lines = []
        for option in command.options:
            value = ":value:_files" if option.takes_value else ""
            for spelling in option.names:
                lines.append(f"    '{spelling}[{zsh_quoted(option.says)}]{value}'")
        if command.commands:
            words = [f'{c.words[-1]}\\:"{zsh_quoted(c.does)}"' for c in command.commands]
            lines.append(f"    '1:command:(({' '.join(words)}))'")
            lines.append("    '*::argument:->below'")
            cases = "\n".join(f"    {c.words[-1]}) {zsh_name(c)} ;;" for c in command.commands)
            after = f'\n  [[ $state == below ]] || return\n  case $words[1] in\n{cases}\n  esac'
        else:
            lines.append("    '*:file:_files'")
            after = ""
        body = " \\\n".join(lines)
        start = f"{zsh_name(command)}() {{\n  local state\n  _arguments -C \\\n"
        functions.append(f"{start}{body}{after}\n}}\n")
    title = "#compdef vicinity\n# Completion of vicinity for zsh, made from its --help.\n"
    return title + "".join(functions) + '_vicinity "$@"\n'


def fish_quoted(text):
    return "'" + text.replace("\\", "\\\\").replace("'", "\\'") + "'"


def fish(root):
    lines = ["# Completion of vicinity for fish, made from its --help."]
    for command in and_below(root):
        below = " ".join(c.words[-1] for c in command.commands)
        here = [f"__fish_seen_subcommand_from {word}" for word in command.words[1:]]
        if below:
            here.append(f"not __fish_seen_subcommand_from {below}")
        condition = fish_quoted("; and ".join(here))
        start = f"complete -c vicinity -n {condition}"
        for c in command.commands:
            lines.append(f"{start} -f -a {c.words[-1]} -d {fish_quoted(c.does)}")
        for option in command.options:
            names = [f"-l {n[2:]}" if n.startswith("--") else f"-s {n[1:]}" for n in option.names]
            names += ["-r"] if option.takes_value else []
            lines.append(f"{start} {' '.join(names)} -d {fish_quoted(option.says)}")
    return "\n".join(lines) + "\n"


def main(program, folder):
    root = read_command(program, ["vicinity"])
    version = output_of(program, "--version").split()[-1]
    for name, text in [
        ("man/man1/vicinity.1", manual_page(root, version)),
        ("bash-completion/completions/vicinity", bash(root)),
        ("zsh/site-functions/_vicinity", zsh(root)),
        ("fish/vendor_completions.d/vicinity.fish", fish(root)),
    ]:
        path = pathlib.Path(folder) / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
