"""How the tools end: a mistake of the user's is one line and exit code 2, Ctrl-C exit code 130, neither a traceback."""

import argparse
import importlib
import math
import os
import pathlib
import signal
import sys


class Refusal(Exception):
    """A mistake of the user's; the text says what is wrong, what is expected and what was given."""


# What the system says when a path was wrong; anything else (a full disk, say) is no mistake of the user's.
WRONG_PATHS = (FileNotFoundError, FileExistsError, IsADirectoryError, NotADirectoryError, PermissionError)


def name_of_tool():
    """As one calls it; tools/validation by way of tools/validate."""
    script = pathlib.Path(sys.argv[0])
    return "tools/validate" if script.parent.name == "validation" else script.name


def fail(message, code=2):
    """Ends the tool with a line on standard error."""
    print(f"{name_of_tool()}: error: {message}", file=sys.stderr)
    sys.exit(code)


def run(main):
    """Exits with what main() returns: 0 fine, 1 what the tool is to find, 2 bad input, 3 the system, 130 Ctrl-C."""
    sys.stdout.reconfigure(errors="replace")  # a terminal that lacks a sign must not end a tool
    sys.stderr.reconfigure(errors="replace")
    try:
        code = main()
        sys.stdout.flush()
    except Refusal as refusal:
        fail(refusal)
    except KeyboardInterrupt:
        fail("interrupted", 128 + signal.SIGINT)
    except BrokenPipeError:
        # Who read our output has gone (`| head`): nothing more to say, at exit neither.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        code = 128 + signal.SIGPIPE
    except UnicodeDecodeError as error:
        fail(f"a file is not UTF-8 text: {error}")
    except OSError as error:
        fail(f"{error.filename or 'system'}: {error.strerror or error}", 2 if isinstance(error, WRONG_PATHS) else 3)
    sys.exit(code)


def needs(*names):
    """The modules of these names, which are not part of Python; where one is missing the tool ends."""
    try:
        modules = [importlib.import_module(name) for name in names]
    except ImportError as error:
        fail(f"needs {' and '.join(names)} (pip install {' '.join(names)}): {error}")
    for name, module in zip(names, modules):
        # Python takes any folder of that name on its path for a module, this one's tools/mitsuba as well.
        if module.__spec__.origin is None:
            fail(f"needs {' and '.join(names)} (pip install {' '.join(names)}): no module named {name}")
    return modules


def mitsuba_in(variant):
    """Mitsuba 3, set to a variant; where that cannot be had the tool ends."""
    (mitsuba,) = needs("mitsuba")
    if variant not in mitsuba.variants():
        fail(f"Mitsuba has no variant {variant}; there are {', '.join(mitsuba.variants())}")
    try:
        mitsuba.set_variant(variant)
    except ImportError as error:
        fail(f"Mitsuba cannot run its variant {variant}: {error}")
    return mitsuba


def number_in(least, most, kind=float):
    """A type for argparse: a finite number, or a whole one, in [least, most]."""
    words = "a whole number" if kind is int else "a number"

    def parse(text):
        try:
            value = kind(text)
        except ValueError:
            value = math.nan
        if not least <= value <= most:
            raise argparse.ArgumentTypeError(f"expected {words} from {least:g} to {most:g}; got {text}")
        return value

    return parse
