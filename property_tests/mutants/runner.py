"""Runs test programs, each until its first failure or until its time is up."""

import json
import os
import re
import resource
import shutil
import signal
import subprocess
import tempfile
import threading
import time
from pathlib import Path

from builder import run_or_exit

# What a test is, by the beginning of its name in ctest; others are left out. In this order a mutant meets them.
KINDS = {"property": "law", "unit": "example", "db": "example", "bench": "example", "golden": "golden"}
ORDER = ("law", "example", "golden")
# The first sees that mutants fit the sources, the second that released migrations are as they were.
NO_JUDGES = "-Mutants.*:Migrations.those_that_were_released_do_not_change"

# Processor time that a program may take, as a multiple of its time without a mutant,
# and at least so many seconds: shrinking a counterexample takes some of it.
TIME_FACTOR = 4
LEAST_TIME_LIMIT_S = 20
LONGEST_TIME_LIMIT_S = 900
# A program that sleeps for so long waits for something that never comes. One that waits
# for a processor on a busy machine does not sleep, but a golden test sleeps while its programs run.
LONGEST_SLEEP_S = {"law": 60, "example": 60, "golden": 600}
COUNTEREXAMPLE_LINES = 80
# Set when the matrix is to end: programs that run are killed.
ending = threading.Event()

KILLED, TIME, SURVIVED, NOT_RUN = "killed", "time", "survived", "not run"


class Program:
    def __init__(self, name, kind, command):
        self.name, self.kind, self.command = name, kind, command
        self.seconds, self.reached = LONGEST_TIME_LIMIT_S / TIME_FACTOR, set()

    def learn(self, run):
        """From a run without a mutant: its time and the numbers of the mutants that it reaches."""
        self.seconds, self.reached = run.seconds, run.reached


def find_programs(build):
    """The tests of ctest; the examples of one program are one."""
    programs = {}
    for test in json.loads(run_or_exit(["ctest", "--test-dir", str(build), "--show-only=json-v1"]))["tests"]:
        kind = KINDS.get(test["name"].split(".")[0])
        if kind == "example":
            name = Path(test["command"][0]).name
            programs[name] = Program(name, kind, [test["command"][0], "--gtest_fail_fast", f"--gtest_filter={NO_JUDGES}"])
        elif kind and "command" in test:
            programs[test["name"]] = Program(test["name"], kind, test["command"])
    return list(programs.values())


class Run:
    """One run of a program, with a mutant or without."""

    def __init__(self, program, mutant, parameters, mutants):
        self.program = program
        self.title = None
        self.lines = []  # of the first failure
        self.stopped = False  # after its first failure
        scratch = Path(tempfile.mkdtemp(prefix="kill-"))
        scratch.chmod(0o755)
        log, reached = scratch / "properties.jsonl", scratch / "reached"
        reached.write_bytes(bytes(mutants))
        self.process = subprocess.Popen(
            program.command, cwd=scratch, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            text=True, errors="replace", start_new_session=True, preexec_fn=without_core_file,
            env=dict(os.environ, RC_PARAMS=parameters, SIPPLAB_PROPERTY_LOG=str(log) if program.kind == "law" else "",
                     SIPPLAB_MUTANT=mutant, SIPPLAB_MUTANTS_REACHED=str(reached), TMPDIR=str(scratch)))
        reader = threading.Thread(target=self._read)
        reader.start()
        out_of_time = self._watch(reader, max(LEAST_TIME_LIMIT_S, TIME_FACTOR * program.seconds))
        code = self.process.wait()
        self._kill()  # what it left behind
        self.logged = self._ended_runs(log)
        self.reached = {number for number, byte in enumerate(reached.read_bytes()) if byte}
        shutil.rmtree(scratch, ignore_errors=True)
        if self.title is not None and self.lines:
            self.outcome = KILLED
        elif out_of_time:
            self.outcome = TIME
        elif code != 0:
            self.outcome = KILLED
            self.title = f"{self.title or program.name} (ended with {code})"
        else:
            self.outcome = SURVIVED

    def cell(self):
        return {"kind": self.program.kind, "outcome": self.outcome, "title": self.title,
                "seconds": round(self.seconds, 2), "lines": self.lines, "size": size_of_counterexample(self.lines)}

    def _watch(self, reader, time_limit_s):
        """Waits for the end; true if the program had to be killed for its time."""
        self.seconds, asleep_since = 0.0, time.monotonic()
        while reader.is_alive():
            reader.join(0.1)
            state, seconds = processor_use(self.process.pid)
            if seconds > self.seconds or state not in "SD":
                asleep_since = time.monotonic()
            self.seconds = max(self.seconds, seconds)
            if ending.is_set() or self.seconds > time_limit_s or time.monotonic() - asleep_since > LONGEST_SLEEP_S[self.program.kind]:
                self._kill()
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
            elif line.startswith(("- ", "[ RUN      ] ")):
                self.title = title = line.removeprefix("- ").removeprefix("[ RUN      ] ")
            elif line.startswith("Falsifiable after"):
                self.title, self.lines = title or self.program.name, [line]
            elif "[  FAILED  ]" in line and self.program.kind == "example":
                self.lines = [line]
                return self._stop()
            elif line.startswith("BROKEN: "):
                self.title, self.lines = line, [line]
                return self._stop()
        return None

    def _stop(self):
        self.stopped = True
        self._kill()

    def _kill(self):
        """The program and all that it started."""
        try:
            os.killpg(self.process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass

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
    """State of a process (R: runs or wants to) and seconds of processor time, its own and of children that ended."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    except OSError:
        return "X", 0.0
    return fields[0], sum(map(int, fields[11:15])) / os.sysconf("SC_CLK_TCK")


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
