#!/usr/bin/env python3
"""check_parity_coverage.py [ROOT]: every function that a shader module shares with its twin has a parity record.

A record is `Parity name("module", "function ...", ...)` in tests/parity/*_test.cpp. That the twins define the same
functions is what check_mirror.py says; functions that only the shader has need no record. The modules that act on
whole paths are compared path by path instead, in tests/parity/image_parity_test.cpp.
"""

import re
import sys

from check_mirror import SHADER_ONLY, modules, names
from command import run
from source_text import files, report, repository

WHOLE_PATHS = {"integrator/path_tracer", "integrator/vertex", "integrator/emission"}
# `Parity a("module", "functions"` and what follows in the same declaration, `, b("module", "functions"`. The functions
# may be a choice, `condition ? "these" : "those"`.
RECORD = re.compile(r'(?:\bParity\s+\w+|,\s*\w+)\(\s*"([\w/]+)",\s*([^",;]*"[^,;]*"),')
STRING = re.compile(r'"([^"]*)"')


def records(folder):
    """{(module, function)} of every record."""
    found = set()
    for file in files(folder, ".cpp"):
        for module, choice in RECORD.findall(file.read_text()):
            found |= {(module, function) for functions in STRING.findall(choice) for function in functions.split()}
    return found


def main():
    root = repository(sys.argv)
    shaders = modules(root / "shaders", ".glsl", SHADER_ONLY)
    recorded = records(root / "tests" / "parity")
    problems = [f"shaders/{module}.glsl: no parity record in tests/parity for {function}"
                for module, text in shaders.items() if not module.startswith("kernels/") and module not in WHOLE_PATHS
                for function in dict.fromkeys(names(text, SHADER_ONLY)) if (module, function) not in recorded]
    return report(sorted(problems))


if __name__ == "__main__":
    run(main)
