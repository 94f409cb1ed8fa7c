#!/usr/bin/env python3
"""programs_of.py [OPTIONS of ctest]: the targets that the tests chosen by -R and -L need, a line each.

Nothing where the options choose nothing that it knows: then everything must be built.
"""

import pathlib
import re
import sys

from command import Refusal, run

ROOT = pathlib.Path(__file__).parents[1]
TEST = re.compile(r"^\s*(TEST|TEST_F|TEST_P)\(\s*(\w+),\s*(\w+)\s*\)", re.MULTILINE)
INSTANCE = re.compile(r"INSTANTIATE_TEST_SUITE_P\(\s*(\w+),\s*(\w+)\s*,")
OTHERS = re.compile(r"add_test\(NAME ([\w.]+)|^structure_test\((\w+)", re.MULTILINE)  # of structure.cmake: scripts


def option(arguments, short, long):
    """The value of an option, or None."""
    for argument, following in zip(arguments, arguments[1:] + [None]):
        if argument in (short, long):
            return following
    return None


def names(file):
    """Those of the file's tests, as ctest knows them; a parameter's name follows the last slash."""
    text = file.read_text()
    prefixes = {}
    for prefix, suite in INSTANCE.findall(text):
        prefixes.setdefault(suite, []).append(prefix)
    for macro, suite, name in TEST.findall(text):
        if macro == "TEST_P":
            yield from (f"{prefix}/{suite}.{name}/" for prefix in prefixes.get(suite, []))
        else:
            yield f"{suite}.{name}"


def is_chosen(pattern, name):
    """Of tests with parameters the part before the parameter decides: which parameters there are is not known."""
    if not name.endswith("/"):
        return re.search(pattern, name) is not None
    stem = pattern.rsplit("/", 1)[0] if pattern.count("/") > 1 else pattern
    return re.search(stem, name) is not None


def may_name_a_parameter(pattern, file):
    """Whether a word in quotes, as parameters are named by, is matched: one program too many is no harm."""
    text = file.read_text()
    return INSTANCE.search(text) and any(re.search(pattern, word) for word in re.findall(r'"(\w+)"', text))


def chosen(pattern, label, excluded):
    targets = set()
    for file in sorted((ROOT / "tests").glob("*/*_test.cpp")):
        folder = file.parent.name
        if label and not re.search(label, folder) or excluded and re.search(excluded, folder):
            continue
        if not pattern or any(is_chosen(pattern, name) for name in names(file)) or may_name_a_parameter(pattern, file):
            targets |= {"parhelion", folder + "_tests"}
    for test, property in OTHERS.findall((ROOT / "tests" / "structure.cmake").read_text()):
        if pattern and re.search(pattern, test or "Structure." + property):
            targets.add("parhelion")
    return targets


def main():
    arguments = sys.argv[1:]
    pattern, label = option(arguments, "-R", "--tests-regex"), option(arguments, "-L", "--label-regex")
    excluded = option(arguments, "-LE", "--label-exclude")
    for given in filter(None, (pattern, label, excluded)):
        try:
            re.compile(given)
        except re.error as error:
            raise Refusal(f"expected a regular expression; got {given}: {error}") from error
    if pattern or label:
        print("\n".join(sorted(chosen(pattern, label, excluded))))


if __name__ == "__main__":
    run(main)
