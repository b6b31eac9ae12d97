# SPDX-FileCopyrightText: The Vicinity authors
# SPDX-License-Identifier: Apache-2.0
"""The type stubs say what the compiled module has: the same names, members and parameters."""

import ast
import pathlib
import re
import types
import unittest

import vicinity

STUBS = pathlib.Path(vicinity.__file__).parent
IN_EVERY_ENUMERATION = {"__members__", "name", "value"}


def parameters_by_stub(function):
    a = function.args
    return [arg.arg for arg in a.posonlyargs + a.args + a.kwonlyargs]


def parameters_by_module(function):
    """One list of names for each overload, from the signatures that pybind11 puts first."""
    name = function.__name__
    lists = []
    for line in function.__doc__.splitlines():
        found = re.match(rf"(?:\d+\. )?{re.escape(name)}\((.*)\) ->", line)
        if not found or ("*args" in line and "**kwargs" in line):
            continue
        text, depth, parts = found.group(1), 0, [""]
        for letter in text:
            depth += (letter in "([{<") - (letter in ")]}>")
            if letter == "," and depth == 0:
                parts.append("")
            else:
                parts[-1] += letter
        lists.append([p.split(":")[0].strip() for p in parts if ":" in p])
    return lists


def members_by_stub(node):
    """name -> its definitions, of a module or a class."""
    members = {}
    for item in node.body:
        if isinstance(item, (ast.ClassDef, ast.FunctionDef)):
            members.setdefault(item.name, []).append(item)
        elif isinstance(item, ast.AnnAssign):
            members.setdefault(item.target.id, []).append(item)
    return {name: items for name, items in members.items() if is_public(name)}


def is_public(name):
    return not name.startswith("_") or name in ("__init__", "__version__")


def members_by_module(thing):
    own = vars(thing)
    names = {n for n in own if is_public(n)}
    if isinstance(thing, type):
        if "__members__" in own:
            names -= IN_EVERY_ENUMERATION | {"__init__"}
        elif "__init__" in own and "(self: " not in (own["__init__"].__doc__ or ""):
            names.discard("__init__")  # pybind11's own, which only refuses
    return {n for n in names if not isinstance(own[n], types.ModuleType)}


class Stubs(unittest.TestCase):
    def compare(self, node, thing, path):
        stub, own = members_by_stub(node), members_by_module(thing)
        if path == "vicinity.Error":
            own.discard("__init__")
        self.assertEqual(set(stub), own, path)
        for name, items in stub.items():
            member = vars(thing)[name]
            where = f"{path}.{name}"
            if isinstance(items[0], ast.ClassDef):
                self.compare(items[0], member, where)
            elif isinstance(items[0], ast.FunctionDef) and not isinstance(member, property):
                self.assertCountEqual(
                    [parameters_by_stub(item) for item in items],
                    parameters_by_module(member),
                    where,
                )
            elif isinstance(member, property) and isinstance(items[0], ast.FunctionDef):
                self.assertEqual(member.fset is not None, len(items) == 2, where)
            elif isinstance(member, property):
                self.assertIsNotNone(member.fset, where)

    def test_names_members_and_parameters_are_those_of_the_module(self):
        for file, module in [("__init__.pyi", vicinity), ("primitive.pyi", vicinity.primitive)]:
            tree = ast.parse((STUBS / file).read_text())
            self.compare(tree, module, module.__name__)

    def test_every_public_function_says_what_it_does(self):
        silent = []
        for name, member in vars(vicinity).items():
            if name.startswith("_") or not callable(member) or isinstance(member, type):
                continue
            lines = (member.__doc__ or "").splitlines()
            said = [line for line in lines if line and not re.match(rf"(\d+\. )?{name}\(", line)]
            if not said:
                silent.append(name)
        self.assertEqual(silent, [])


if __name__ == "__main__":
    unittest.main()
