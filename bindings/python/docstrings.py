# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
"""Turns the comments of the C++ headers into the docstrings of Python: each is written once.

    docstrings.py docstrings.h HEADER...

Of every `/// comment` before a declaration, and every `///< comment` behind one, it makes a
constant named after what is declared: vicinity::python::doc::ViscosityField_at. A second
declaration of the same name (an overload) is called ..._2. What a binding asks for and no header
says does not compile.
"""

import re
import sys

SCOPE = re.compile(r"^(?:struct|class|enum class|enum|union)\s+(?:\[\[\w+\]\]\s*)?(\w+)\b[^;]*\{")
FUNCTION = re.compile(r"(~?\w+)\s*\(")
MEMBER = re.compile(r"(\w+)\s*(?:[={].*)?[,;]?\s*$")
TEMPLATE_ARGUMENTS = re.compile(r"<[^<>]*>")
TEMPLATE = re.compile(r"^template\s*<.*>\s*$")


def name_of(declaration):
    """What a line declares; None where it declares nothing."""
    scope = SCOPE.match(declaration)
    if scope:
        return scope.group(1)
    head = declaration
    while TEMPLATE_ARGUMENTS.search(head):
        head = TEMPLATE_ARGUMENTS.sub("", head)
    head = head.split("=")[0]
    found = FUNCTION.search(head) if "(" in head else MEMBER.search(head.strip())
    return found.group(1) if found else None


def docstrings(text):
    """Yields (name, comment) for each comment, the name with its classes: "Scene_voxel_size"."""
    scopes = []  # (name, depth inside its braces)
    depth = 0
    before = []  # lines of the comment that stands before the next declaration
    behind = None  # [name, lines] of the comment that stands behind the last one
    for line in text.splitlines():
        stripped = line.strip()
        if stripped.startswith("///<"):
            if behind:
                behind[1].append(stripped[4:].strip())
            continue
        if behind:
            yield behind[0], "\n".join(behind[1])
            behind = None
        if stripped.startswith("///"):
            before.append(stripped[3:].removeprefix(" "))
            continue
        code, _, trailing = stripped.partition("///<")
        code = code.split("//")[0].strip()
        if not code:
            before = []
            continue
        if TEMPLATE.match(code):
            continue
        in_declarations = depth == (scopes[-1][1] if scopes else 1)  # 1: namespace vicinity
        name = name_of(code) if in_declarations else None
        if name and (before or trailing):
            full = "_".join([scope for scope, _ in scopes] + [name])
            if before:
                yield full, "\n".join(before)
            else:
                behind = [full, [trailing.strip()]]
        before = []
        opened = SCOPE.match(code) if in_declarations else None
        depth += code.count("{") - code.count("}")
        if opened and code.count("{") > code.count("}"):
            scopes.append((opened.group(1), depth))
        while scopes and depth < scopes[-1][1]:
            scopes.pop()
    if behind:
        yield behind[0], "\n".join(behind[1])


def main(target, *headers):
    lines = ["// Made by docstrings.py from the comments of the headers.\n#pragma once\n"]
    lines.append("namespace vicinity::python::doc {\n")
    seen = {}
    for header in headers:
        with open(header, encoding="utf-8") as file:
            for name, comment in docstrings(file.read()):
                seen[name] = seen.get(name, 0) + 1
                if seen[name] > 1:
                    name += f"_{seen[name]}"
                lines.append(f'inline constexpr const char* {name} = R"doc({comment})doc";')
    lines.append("\n}  // namespace vicinity::python::doc\n")
    with open(target, "w", encoding="utf-8") as file:
        file.write("\n".join(lines))


if __name__ == "__main__":
    main(*sys.argv[1:])
