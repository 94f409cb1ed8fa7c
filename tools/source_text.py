"""Reads C++ and GLSL just well enough for the structure checks: files, includes, function definitions."""

import pathlib
import re
from dataclasses import dataclass

from command import Refusal


@dataclass
class Function:
    name: str
    line: int  # of the first line of its signature, from 1
    lines: int  # from there to its closing brace
    comment: list  # lines of the comment that ends right above it


def repository(arguments):
    """The folder to check: the script's first argument, or the checkout that holds this file."""
    return pathlib.Path(arguments[1] if len(arguments) > 1 else pathlib.Path(__file__).parents[1]).resolve()


def files(folder, *suffixes):
    """Of that kind below a folder, which must exist: a check that finds nothing to look at has not checked."""
    if not folder.is_dir():
        raise Refusal(f"{folder}: missing")
    return sorted(path for path in folder.rglob("*") if path.suffix in suffixes and path.is_file())


def report(problems):
    """Prints the problems; the exit code."""
    print("\n".join(problems) if problems else "no violations")
    return 1 if problems else 0


TOKENS = re.compile(
    r'R"(?P<tag>[^\s()\\]{0,16})\((?:.|\n)*?\)(?P=tag)"'  # raw string
    r"|//[^\n]*|/\*(?:.|\n)*?\*/"
    r'|"(?:\\.|[^"\\\n])*"'
    r"|(?<![0-9A-Fa-f])'(?:\\.|[^'\\\n])+'"  # after a digit the quote separates digits
    r"|^[ \t]*#(?:\\\n|[^\n])*",
    re.MULTILINE,
)


def code_only(text):
    """The text with comments, literals and preprocessor lines blanked; every character keeps its place."""

    def blank(match):
        kept = re.sub(r"[^\n]", " ", match.group())
        return '"' + kept[1:-1] + '"' if match.group()[0] == '"' else kept

    return TOKENS.sub(blank, text)


NOT_FUNCTIONS = {"if", "for", "while", "switch", "catch", "return", "sizeof", "alignas", "decltype", "noexcept",
                 "layout", "requires", "SHARED_CONST", "SHARED_LAYOUT"}
ATTRIBUTES = re.compile(r"\[\[.*?\]\]|\b(?:layout|alignas)\s*\([^()]*\)")
TEMPLATE = re.compile(r"^\s*template\s*<")


def without_template(head):
    while match := TEMPLATE.match(head):
        depth, end = 1, match.end()
        while depth and end < len(head):
            depth += {"<": 1, ">": -1}.get(head[end], 0)
            end += 1
        head = head[end:]
    return re.sub(r"^\s*requires\s+[\w:<>, ]+?(?=\s\w)", "", head)


def function_name(head):
    """The name of the function whose signature `head` is, or None: `head` is all that stands before a brace."""
    head = without_template(ATTRIBUTES.sub("", head))
    match = re.search(r"([~\w:]+|operator\s*\S+)\s*\(", head)
    if not match or "=" in head[: match.start()]:
        return None
    name = match.group(1).split("::")[-1]
    return None if name in NOT_FUNCTIONS or not name else name


def is_scope(head):
    """Whether definitions may stand inside the brace that follows `head`."""
    return bool(re.match(r"\s*(inline\s+)?namespace\b|\s*extern\s*\"", head)) or bool(
        re.match(r"\s*(struct|class|union)\b", without_template(head)) and function_name(head) is None)


def comment_above(lines, line):
    comment = []
    while line >= 2 and lines[line - 2].lstrip().startswith("//"):
        line -= 1
        comment.insert(0, lines[line - 1].strip())
    return comment


def opening_comment(text):
    """The comment that the file starts with, above or below its guard; not one that belongs to a definition."""
    comment = []
    for line in (line.strip() for line in text.split("\n")):
        if line.startswith("//"):
            comment.append(line)
        elif comment:
            return comment if not line or line.startswith("#") else []
        elif not re.match(r"$|#ifndef|#define|#pragma once", line):
            return []
    return comment


# `: member_` before a brace, in a constructor: the brace holds an initialiser, the body is still to come.
INITIALISER = re.compile(r"\)\s*(?:noexcept\s*)?:[^:](?:.|\n)*[\w>]$")


def functions(text):
    """Functions defined in namespaces, structs and at file scope, in order."""
    code, lines, found = code_only(text), text.split("\n"), []
    stack = []  # of (kind of brace: scope, initialiser or other; function name or None; start of signature)
    start = 0  # of the current statement
    for match in re.finditer(r"[{};]", code):
        kind = "scope"
        if match.group() == "{":
            head = re.sub(r"^\s*(public|private|protected)\s*:(?!:)", lambda m: " " * len(m.group()), code[start:match.start()])
            in_scope = all(open_kind == "scope" for open_kind, _, _ in stack)
            name = function_name(head) if in_scope else None
            kind = "scope" if in_scope and is_scope(head) else "other"
            if name and INITIALISER.search(head):
                kind, name = "initialiser", None
            stack.append((kind, name, start + len(head) - len(head.lstrip())))
        elif match.group() == "}" and stack:
            kind, name, begin = stack.pop()
            if name:
                first, last = code.count("\n", 0, begin) + 1, code.count("\n", 0, match.start()) + 1
                found.append(Function(name, first, last - first + 1, comment_above(lines, first)))
        if kind != "initialiser" and all(open_kind == "scope" for open_kind, _, _ in stack):
            start = match.end()
    return found


INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', re.MULTILINE)


def includes(text):
    """(line, quoted, path) of every include."""
    return [(text.count("\n", 0, match.start()) + 1, match.group(1) == '"', match.group(2))
            for match in INCLUDE.finditer(text)]
