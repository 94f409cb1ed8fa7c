#!/usr/bin/env python3
"""check_sizes.py [ROOT]: files and functions stay small enough to be read at once."""

import sys

from command import run
from source_text import files, functions, report, repository

FOLDERS = ("host", "shaders", "tests", "tools")
FILE_LINES = {".cpp": 300, ".h": 300, ".glsl": 150, ".comp": 40}
FUNCTION_LINES = 40
PATH_LOOP_LINES = 80  # in integrator/path_tracer.*: the loop is one thought


def function_limit(file):
    return PATH_LOOP_LINES if file.stem == "path_tracer" else FUNCTION_LINES


def problems_of(file, name):
    text = file.read_text()
    lines = text.count("\n")
    if lines > FILE_LINES[file.suffix]:
        yield f"{name}: {lines} lines; at most {FILE_LINES[file.suffix]}"
    for function in functions(text):
        if function.lines > function_limit(file):
            yield f"{name}:{function.line}: {function.name} has {function.lines} lines; at most {function_limit(file)}"


def main():
    root = repository(sys.argv)
    problems = []
    for folder in FOLDERS:
        for file in files(root / folder, *FILE_LINES):
            problems += problems_of(file, file.relative_to(root))
    return report(problems)


if __name__ == "__main__":
    run(main)
