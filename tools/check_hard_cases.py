#!/usr/bin/env python3
"""check_hard_cases.py [ROOT]: every hard case that is named in the tree is explained in tests/HARD_CASES.md.

There, an entry `- **H17** text` names the test files that show the case (`numerics/majorant_bound_test`), and single
tests of them (`MajorantBounds.HoldTheInterpolantEverywhere`): all of them exist. An entry without a test says `not
applicable yet`, or refers to another one by `The tests of H1`.
"""

import re
import sys

from command import Refusal, run
from source_text import files, report, repository

PAGE = "tests/HARD_CASES.md"
FOLDERS = ("host", "shaders", "tests", "tools", "scenes")
SUFFIXES = (".cpp", ".h", ".glsl", ".comp", ".md", ".py", ".sh", ".cmake", ".txt", ".xml", "")
# Also at the end of a test's name (SampleAgreesH1H2). Not a part of a word in capitals, nor of a longer number.
CASE = re.compile(r"(?<![A-Z_])H([1-9]\d?)(?![\da-z])")
ENTRY = re.compile(r"^- \*\*H(\d+)\*\*((?:.|\n)*?)(?=^- |^#|^\Z)", re.MULTILINE)
TEST_FILE = re.compile(r"`([a-z]+/\w+_test)`")
TEST_NAME = re.compile(r"`(\w+)\.(\w+)`")
WITHOUT_TEST = re.compile(r"not\s+applicable\s+yet|The\s+tests\s+of\s+H\d")


def text_files(root):
    for folder in FOLDERS:
        yield from (file for file in files(root / folder, *SUFFIXES) if "__pycache__" not in file.parts)
    yield from (root / name for name in ("README.md", "CHANGELOG.md", "CMakeLists.txt") if (root / name).is_file())


def defines(text, suite, name):
    return re.search(rf"\bTEST(?:_F|_P)?\(\s*{suite},\s*{name}\s*\)", text)


def problems_of_entry(root, number, text):
    """What an entry promises and is not there."""
    named = TEST_FILE.findall(text)
    sources = {}
    for name in named:
        file = root / "tests" / f"{name}.cpp"
        if file.is_file():
            sources[name] = file.read_text()
        else:
            yield f"{PAGE}: H{number} names {name}, but there is no tests/{name}.cpp"
    for suite, name in TEST_NAME.findall(text):
        if not any(defines(source, suite, name) for source in sources.values()):
            yield f"{PAGE}: H{number} names {suite}.{name}, which none of its test files has"
    if not named and not WITHOUT_TEST.search(text):
        yield f"{PAGE}: H{number} names no test"


def main():
    root = repository(sys.argv)
    page = root / PAGE
    if not page.is_file():
        raise Refusal(f"{page}: missing")
    entries = ENTRY.findall(page.read_text())
    numbers = [int(number) for number, _ in entries]
    problems = [f"{PAGE}: H{number} has two entries" for number in sorted(set(numbers)) if numbers.count(number) > 1]
    for number, text in entries:
        problems += problems_of_entry(root, number, text)
    for file in text_files(root):
        text = file.read_text()
        problems += [f"{file.relative_to(root)}:{text.count(chr(10), 0, match.start()) + 1}: H{match.group(1)} has no "
                     f"entry in {PAGE}" for match in CASE.finditer(text) if int(match.group(1)) not in numbers]
    return report(problems)


if __name__ == "__main__":
    run(main)
