#!/usr/bin/env python3
"""dearest_tests.py FILE: of a run that ctest wrote as JUnit file, the twenty tests that took longest.

Beside each stands what it proves: its name in words, and what the comment above it says.
"""

import pathlib
import re
import sys
import xml.etree.ElementTree

from command import Refusal, run
from source_text import comment_above

TESTS = pathlib.Path(__file__).parents[1] / "tests"
COUNT = 20


def comments():
    """The comment above each test, by the name that ctest knows it by (without prefix and parameter)."""
    found = {}
    for file in TESTS.glob("*/*_test.cpp"):
        text = file.read_text()
        for match in re.finditer(r"^TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\s*\)", text, re.MULTILINE):
            line = text.count("\n", 0, match.start()) + 1
            comment = " ".join(part.lstrip("/ ") for part in comment_above(text.split("\n"), line))
            found[f"{match[1]}.{match[2]}"] = comment
    return found


def in_words(name):
    """"Suite.StatesTheProperty" as "states the property"."""
    words = re.findall(r"[A-Z]+(?![a-z])|[A-Z][a-z]*|[a-z]+|[0-9]+", name.split(".")[-1])
    return " ".join(word if word.isupper() and len(word) > 1 else word.lower() for word in words)


def main():
    if len(sys.argv) != 2:
        raise Refusal("expected one argument, a JUnit file of ctest")
    try:
        cases = xml.etree.ElementTree.parse(sys.argv[1]).getroot().iter("testcase")
    except xml.etree.ElementTree.ParseError as error:
        raise Refusal(f"{sys.argv[1]}: expected a JUnit file of ctest: {error}") from error
    times = sorted(((float(case.get("time", 0)), case.get("name")) for case in cases), reverse=True)
    if not times:
        return
    comment_of = comments()
    print(f"\nThe dearest of {len(times)} tests, which took {sum(time for time, _ in times):.0f} s in all:")
    for time, name in times[:COUNT]:
        plain = "/".join(part for part in name.split("/") if "." in part)
        proves = ". ".join(filter(None, (in_words(plain), comment_of.get(plain, "").rstrip("."))))
        print(f"{time:7.1f} s  {name}: {proves}")


if __name__ == "__main__":
    run(main)
