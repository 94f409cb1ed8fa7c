#!/usr/bin/env python3
"""check_mirror.py [ROOT]: every shaders/X/Y.glsl has its twin host/reference/X/Y.h, and the other way round.

Twins define the same function names in the same order (overloads next to each other count once). What only
one side can have is exempt when its comment says why: a function by a line `// Shader only: why` or
`/// Reference only: why` right above it, a whole file by such a line in the comment that opens it.
"""

import itertools
import sys

from command import run
from source_text import files, functions, opening_comment, report, repository


SHADER_ONLY = "// Shader only:"
REFERENCE_ONLY = "/// Reference only:"


def is_exempt(comment, marker):
    return any(line.startswith(marker) for line in comment)


def modules(folder, suffix, marker):
    """Path below `folder` without suffix -> text, for the files in its subfolders that must have a twin."""
    found = {file.relative_to(folder).with_suffix("").as_posix(): file.read_text()
             for file in files(folder, suffix) if file.parent != folder}
    return {name: text for name, text in found.items() if not is_exempt(opening_comment(text), marker)}


def names(text, marker):
    mirrored = [function.name for function in functions(text) if not is_exempt(function.comment, marker)]
    return [name for name, _ in itertools.groupby(mirrored)]


def first_difference(shader, reference):
    for ours, theirs in itertools.zip_longest(shader, reference):
        if ours != theirs:
            return f"the shader has {ours or 'nothing more'} where the reference has {theirs or 'nothing more'}"
    return None


def main():
    root = repository(sys.argv)
    shaders = modules(root / "shaders", ".glsl", SHADER_ONLY)
    shaders = {name: text for name, text in shaders.items() if not name.startswith("kernels/")}
    twins = modules(root / "host" / "reference", ".h", REFERENCE_ONLY)
    problems = [f"shaders/{name}.glsl: no twin host/reference/{name}.h" for name in shaders.keys() - twins.keys()]
    problems += [f"host/reference/{name}.h: no twin shaders/{name}.glsl" for name in twins.keys() - shaders.keys()]
    for name in shaders.keys() & twins.keys():
        difference = first_difference(names(shaders[name], SHADER_ONLY), names(twins[name], REFERENCE_ONLY))
        if difference:
            problems.append(f"shaders/{name}.glsl, host/reference/{name}.h: {difference}")
    return report(sorted(problems))


if __name__ == "__main__":
    run(main)
