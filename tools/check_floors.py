#!/usr/bin/env python3
"""check_floors.py [ROOT]: a folder of host/ includes only folders below it; Vulkan only in host/gpu.

Each line of a violation: file:line: what is included, what is allowed.
"""

import sys

from command import run
from source_text import files, includes, report, repository

# Folder -> what it may include besides itself and shaders/shared.
FLOORS = {
    "base": [],
    "image": ["base"],
    "volume": ["base"],
    "gpu": ["base"],
    "scene": ["base", "image", "volume"],
    "compile": ["base", "image", "volume", "scene"],
    "reference": ["base", "compile/compiled_scene.h", "compile/render_settings.h"],
    "render": ["base", "image", "gpu", "compile"],
    "analysis": ["base", "image"],
    "app": ["base", "image", "volume", "gpu", "scene", "compile", "reference", "render", "analysis"],
}
VULKAN = ("vulkan/", "volk", "glslang/", "SPIRV/", "spirv-tools/")


def target_of(root, file, path):
    """The repository's file that an include means, or None."""
    for base in (file.parent, root / "host", root / "shaders"):
        if (base / path).is_file():
            return (base / path).resolve()
    return None


def problem(root, file, quoted, path):
    """Why `file` may not include `path`, or None."""
    folder = file.relative_to(root / "host").parts[0]
    if path.startswith(VULKAN):
        return None if folder == "gpu" else f"includes {path}; only host/gpu may include Vulkan or glslang"
    target = target_of(root, file, path) if quoted else None
    if target is None:
        return f"includes {path}, which no file has; paths are relative to host/ or shaders/" if quoted else None
    if target.is_relative_to(root / "shaders" / "shared"):
        return None
    if not target.is_relative_to(root / "host"):
        return f"includes {path}; of shaders/ only shaders/shared may be included"
    name = target.relative_to(root / "host").as_posix()
    allowed = FLOORS[folder]
    if name.split("/")[0] == folder or name in allowed or name.split("/")[0] in allowed:
        return None
    return f"includes {name}; host/{folder} may include {', '.join(allowed) or 'nothing of host/'}"


def main():
    root = repository(sys.argv)
    problems = []
    for file in files(root / "host", ".h", ".cpp"):
        folder = file.relative_to(root / "host").parts[0]
        if folder not in FLOORS:
            problems.append(f"{file.relative_to(root)}:1: host/{folder} is on no floor of tools/check_floors.py")
            continue
        for line, quoted, path in includes(file.read_text()):
            if why := problem(root, file, quoted, path):
                problems.append(f"{file.relative_to(root)}:{line}: {why}")
    return report(problems)


if __name__ == "__main__":
    run(main)
