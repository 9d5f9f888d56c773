"""A copy of the sources that is built with assertions, where bugs can be planted."""

import os
import shutil
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

from mutants import ROOT

# What is no source. A copy is made from a checkout that may be in use.
LEFT_OUT = (".git", "build", "build-*", "*.db", "*.db-wal", "*.db-shm", "kill-matrix")

# One link of a shared library for each mutant, not one of every program.
SHARED = {"planner/CMakeLists.txt": "sipplab_planner", "db/CMakeLists.txt": "sipplab_db"}


class Builder:
    def __init__(self, work, compiler, jobs):
        self.source, self.build = work / "source", work / "build"
        self.jobs = jobs
        self._copy_sources()
        self._configure(compiler)

    def targets(self, names):
        """What the compiler says if it fails, else nothing."""
        done = subprocess.run(["ninja", "-C", str(self.build), f"-j{self.jobs}", *names],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        return "" if done.returncode == 0 else done.stdout[-3000:]

    def program(self, name):
        folder = "db/tests" if name == "db_tests" else "property_tests"
        return self.build / folder / name

    @contextmanager
    def planted(self, mutant):
        """The sources with this bug; as before afterwards."""
        file = self.source / mutant["file"]
        original = file.read_text()
        file.write_text(original.replace(mutant["before"], mutant["after"]))
        try:
            yield
        finally:
            file.write_text(original)

    def _copy_sources(self):
        shutil.copytree(ROOT, self.source, ignore=shutil.ignore_patterns(*LEFT_OUT), dirs_exist_ok=True,
                        copy_function=copy_if_other)

    def _configure(self, compiler):
        launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
        run_or_exit(
            ["cmake", "-S", str(self.source), "-B", str(self.build), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=None",
             f"-DCMAKE_CXX_COMPILER={compiler}", "-DCMAKE_CXX_FLAGS=-O1", "-DSIPPLAB_ASSERTIONS=ON",
             "-DSIPPLAB_BUILD_BENCH=OFF", "-DSIPPLAB_BUILD_FUZZ=OFF", "-DCMAKE_LINK_DEPENDS_NO_SHARED=ON",
             # Tests that lean on what a static planner brings along find it behind the shared one, too.
             "-DCMAKE_EXE_LINKER_FLAGS=-Wl,--copy-dt-needed-entries", *launcher])


def copy_if_other(source, to):
    """Keeps what is the same, with its time, so that a second run builds little."""
    content = Path(source).read_bytes()
    library = SHARED.get(str(Path(source).relative_to(ROOT)))
    if library:
        static = f"add_library({library} STATIC ".encode()
        if content.count(static) != 1:
            sys.exit(f"{source}: '{static.decode()}' not found once, expected the library of the room")
        content = content.replace(static, static.replace(b"STATIC", b"SHARED"))
    if not os.path.exists(to) or content != Path(to).read_bytes():
        Path(to).write_bytes(content)
        shutil.copymode(source, to)
    return to


def run_or_exit(command):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)} failed:\n{done.stdout[-4000:]}")
