"""Runs the program and the tests, and keeps the commands that did."""

import json
import os
import pathlib
import shlex
import signal
import subprocess


class Failure(Exception):
    """A command that could not do its work; the text says why."""


def shown(command, root):
    """The command as one types it in the project's folder."""
    return " ".join(shlex.quote(str(part).replace(f"{root}/", "")) for part in command)


class Program:
    """`parhelion` in a build folder."""

    def __init__(self, build, root, backend):
        self.build, self.root, self.backend = pathlib.Path(build), root, backend
        self.path = self.build / "parhelion"

    def is_there(self):
        """Whether the program can be run."""
        return self.path.is_file() and os.access(self.path, os.X_OK)

    def _start(self, command):
        """Runs a command to its end, whatever that is."""
        try:
            return subprocess.run([str(part) for part in command], cwd=self.root, capture_output=True, text=True,
                                  errors="replace")
        except OSError as error:
            raise Failure(f"{command[0]}: {error.strerror}") from error

    def _run(self, command, accepted):
        """The standard output, as JSON, of a command that ends with one of the accepted codes."""
        run = self._start(command)
        if run.returncode not in accepted:
            end = signal.Signals(-run.returncode).name if run.returncode < 0 else f"exit code {run.returncode}"
            raise Failure((run.stderr or run.stdout).strip() or end)
        try:
            return json.loads(run.stdout)
        except json.JSONDecodeError as error:
            raise Failure(f"{command[0]} {command[1]} --json: {error}") from error

    def render(self, scene, out, samples, size, defines, options):
        """Renders an EXR; returns the program's report and the command as it is typed."""
        command = [self.path, "render", scene, "-o", out, "--spp", samples, "--size", f"{size}x{size}", "--seed", 1,
                   "--feature-spp", 0]
        command += [part for name, value in defines for part in ("-D", f"{name}={value}")]
        command += list(options) + (["--backend", self.backend] if self.backend != "vulkan" else [])
        report = self._run(command + ["--json", "--quiet"], (0,))
        return report, shown(command, self.root)

    def compare(self, image, reference, limits=(), pictures=None, error_range=None):
        """Measures; returns the figures and the command. What failed is in the figures' `requirements`."""
        command = [self.path, "compare", image, reference, *limits]
        drawn = ["--pictures", pictures] if pictures else []
        drawn += ["--error-range", f"{error_range:g}"] if error_range else []
        figures = self._run(command + drawn + ["--json"], (0, 1))
        return figures, shown(command, self.root)

    def run_test(self, name, filter_):
        """Runs tests by name; returns whether all passed, what they printed and the command."""
        command = [self.build / "tests" / name, f"--gtest_filter={filter_}"]
        if not command[0].exists():
            raise Failure(f"no test program {name}")
        run = self._start(command)
        chrome = ("[", "Note: Google Test", "Running main")
        lines = [line for line in run.stdout.splitlines() if line.strip() and not line.startswith(chrome)]
        if "[==========] Running 0 tests" in run.stdout:
            raise Failure(f"no test matches {filter_}")
        return run.returncode == 0, lines, shown(command, self.root)
