"""A copy of the sources with all planted bugs as switches, built once with assertions."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

from mutants import ROOT, of_file
from switches import switched

# What is no source. A copy is made from a checkout that may be in use.
LEFT_OUT = (".git", "build", "build-*", "*.db", "*.db-wal", "*.db-shm", "kill-matrix", "__pycache__")
NAMES = "property_tests/mutants/switch_names.hpp"


def build(work, mutants, compiler, jobs):
    """The folder in which programs were built that obey SIPPLAB_MUTANT."""
    source, build = work / "source", work / "build"

    def copy(file, to):
        """Keeps what is the same, with its time, so that a second run builds little."""
        name = str(Path(file).relative_to(ROOT))
        content = Path(file).read_bytes()
        changed = switched(name, content.decode(errors="surrogateescape"), of_file(mutants, name))
        write_if_other(to, changed.encode(errors="surrogateescape"))
        shutil.copymode(file, to)
        return to

    shutil.copytree(ROOT, source, ignore=shutil.ignore_patterns(*LEFT_OUT), dirs_exist_ok=True, copy_function=copy)
    write_if_other(source / NAMES, names_header(mutants).encode())

    os.environ.pop("CCACHE_BASEDIR", None)  # golden.property asks for paths in programs as they are
    launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
    run_or_exit(["cmake", "-S", str(source), "-B", str(build), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=None",
                 f"-DCMAKE_CXX_COMPILER={compiler}", "-DCMAKE_CXX_FLAGS=-O1 -w", "-DSIPPLAB_ASSERTIONS=ON",
                 "-DSIPPLAB_BUILD_FUZZ=OFF", *launcher])
    run_or_exit(["ninja", "-C", str(build), f"-j{jobs}"])
    return build


def names_header(mutants):
    """What switch.hpp includes."""
    names = "".join(f'    "{mutant["name"]}",\n' for mutant in mutants)
    return f"#pragma once\ninline constexpr const char* kNames[] = {{\n{names}}};\n"


def write_if_other(file, content):
    if not os.path.exists(file) or content != Path(file).read_bytes():
        Path(file).write_bytes(content)


def run_or_exit(command):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace")
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)} failed:\n{done.stdout[-4000:]}")
    return done.stdout
