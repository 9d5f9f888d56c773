"""Runs test programs, each until its first failure or until its time is up."""

import json
import os
import re
import resource
import shutil
import subprocess
import tempfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from mutants import EXAMPLES

# Processor time that a program may take, as a multiple of its time without a mutant,
# and at least so many seconds: shrinking a counterexample takes some of it.
TIME_FACTOR = 4
LEAST_TIME_LIMIT_S = 20
LONGEST_TIME_LIMIT_S = 900
# A program that sleeps for so long waits for something that never comes. One that waits
# for a processor on a busy machine does not sleep.
LONGEST_SLEEP_S = 60
COUNTEREXAMPLE_LINES = 80

KILLED, TIME, SURVIVED, UNREACHED, NOT_RUN = "killed", "time", "survived", "unreached", "not run"


class Runner:
    def __init__(self, builder, parameters, jobs):
        self.builder, self.parameters, self.jobs = builder, parameters, jobs
        self.left_out = {}  # example tests that fail without any mutant, by program
        self.limits = {}  # processor time of each program

    def leave_out_failing_examples(self, programs):
        for name in sorted(set(programs) & set(EXAMPLES)):
            done = subprocess.run([str(self.builder.program(name)), "--gtest_brief=1", "--gtest_filter=-Mutants.*"],
                                  stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, errors="replace")
            failing = re.findall(r"^\[  FAILED  \] ([^ ,]+)", done.stdout, re.MULTILINE)
            self.left_out[name] = sorted(set(failing))

    def limit_times(self, baseline):
        self.limits = {name: max(LEAST_TIME_LIMIT_S, TIME_FACTOR * cell["seconds"])
                       for name, cell in baseline.items()}

    def run(self, programs, log=None):
        """A cell for each program; what their properties log is appended to a file."""

        def one(program):
            run = Run(self.builder.program(program), program, self.parameters,
                      self.limits.get(program, LONGEST_TIME_LIMIT_S), self.left_out.get(program, []))
            return program, run

        with ThreadPoolExecutor(self.jobs) as pool:
            runs = dict(pool.map(one, programs))
        if log:
            with open(log, "a") as file:
                file.write("".join(run.logged for run in runs.values()))
        return {program: run.cell() for program, run in runs.items()}


class Run:
    def __init__(self, path, program, parameters, time_limit_s, left_out):
        self.program = program
        self.title = None
        self.lines = []  # of the first failure
        self.stopped = False  # after its first failure
        scratch = Path(tempfile.mkdtemp(prefix="kill-"))
        log = scratch / "properties.jsonl"
        command = [str(path)]
        if program in EXAMPLES:
            # Mutants.* sees that mutants still apply, and would see that one is planted.
            tests = ":".join(["Mutants.*", *left_out])
            command += ["--gtest_brief=1", "--gtest_fail_fast", f"--gtest_filter=-{tests}"]
        self.process = subprocess.Popen(command, cwd=scratch, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                        text=True, errors="replace", preexec_fn=without_core_file,
                                        env=dict(os.environ, RC_PARAMS=parameters, SIPPLAB_PROPERTY_LOG=str(log)))
        reader = threading.Thread(target=self._read)
        reader.start()
        out_of_time = self._watch(reader, time_limit_s)
        code = self.process.wait()
        self.logged = self._ended_runs(log)
        shutil.rmtree(scratch, ignore_errors=True)
        if self.title is not None and self.lines:
            self.outcome = KILLED
        elif out_of_time:
            self.outcome = TIME
        elif code != 0:
            self.outcome = KILLED
            self.title = f"{self.title or program} (ended with {code})"
        else:
            self.outcome = SURVIVED

    def cell(self):
        return {"outcome": self.outcome, "title": self.title, "seconds": round(self.seconds, 2),
                "lines": self.lines, "size": size_of_counterexample(self.lines)}

    def _watch(self, reader, time_limit_s):
        """Waits for the end; true if the program had to be killed for its time."""
        self.seconds, asleep_since = 0.0, time.monotonic()
        while reader.is_alive():
            reader.join(0.1)
            state, seconds = processor_use(self.process.pid)
            if seconds > self.seconds or state not in "SD":
                asleep_since = time.monotonic()
            self.seconds = max(self.seconds, seconds)
            if self.seconds > time_limit_s or time.monotonic() - asleep_since > LONGEST_SLEEP_S:
                self.process.kill()
                reader.join()
                return True
        return False

    def _read(self):
        title = None
        for line in self.process.stdout:
            line = line.rstrip("\n")
            heading = line.startswith("- ") or line.startswith("OK,")
            if self.lines and (heading or len(self.lines) > COUNTEREXAMPLE_LINES):
                return self._stop()
            if self.lines:
                self.lines.append(line)
            elif line.startswith("- "):
                self.title = title = line[2:]
            elif line.startswith("Falsifiable after"):
                self.title, self.lines = title or self.program, [line]
            elif "[  FAILED  ]" in line and self.program in EXAMPLES:
                self.title, self.lines = line.split("]", 1)[1].split(" (")[0].split(", where")[0].strip(), [line]
                return self._stop()
        return None

    def _stop(self):
        self.stopped = True
        self.process.kill()

    def _ended_runs(self, log):
        """What was logged. A property that had only begun when its program was stopped for
        a failure of another one did not crash."""
        lines = log.read_text(errors="replace").splitlines(keepends=True) if log.exists() else []
        if self.stopped:
            lines = [line for line in lines if line.endswith("\n") and json.loads(line)["status"] != "started"]
        return "".join(lines)


def without_core_file():
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def processor_use(pid):
    """State of a process (R: runs or wants to) and its seconds of processor time."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    except OSError:
        return "X", 0.0
    return fields[0], (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def size_of_counterexample(lines):
    """Robots and cells of the case that is printed, if one is: of the planned one rather
    than of what was drawn."""
    planned = [number for number, line in enumerate(lines) if line.startswith("the case that was planned")]
    lines = lines[planned[-1]:] if planned else lines
    rows = [line.strip() for line in lines if re.fullmatch(r"\s*[.@]+", line)]
    robots = sum(1 for line in lines if re.match(r"\s*robot \d", line))
    if not rows or not robots:
        return None
    return {"robots": robots, "cells": sum(len(row) for row in rows)}
