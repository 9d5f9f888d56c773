#!/usr/bin/env python3
"""A program with switches does with each mutant what the program does in which the mutant is planted,
and without one what it does as it is.

    switches_test.py COMPILER CMAKE
"""

import sys

sys.dont_write_bytecode = True

import os
import subprocess
import tempfile
from pathlib import Path

from builder import NAMES, names_header
from mutants import ROOT, find_errors, of_file, read_mutants
from switches import EMBEDDING, SwitchError, planted, switched

SWITCH = NAMES.replace("_names", "")
HEADERS = "#include <array>\n#include <cstdio>\n#include <cstdlib>\n#include <string>\n#include <string_view>\n"
SAMPLE = r'''
#define BRACE {
namespace sample {
namespace {
constexpr double kScale = 2.5;  // a constant's "text"
constexpr std::array<int, 3> kTable = {{1, 2, 3}};
constexpr int kLimits[] = {7, 8};
const char kQuote = '"', kBrace = '}';
}  // namespace
enum class Kind : int { kOne, kTwo };
template <class T>
struct Pair {
  Pair(T first, T second = T{4}) : first_{first + 1}, second_(second) { sum_ = first_ + second_; }
  friend bool operator<(const Pair& a, const Pair& b) { return a.sum_ < b.sum_; }
  T operator()(T add) const { return sum_ + add; }
  static constexpr int kWidth = 3;
  T first_, second_, sum_ = 0;
};
struct Base {
  Base(int size, bool is_even) : size_(size), is_even_(is_even && (size % 2) == 0) {
    for (int i = 0; i < size; ++i) size_ += i;
  }
  int size_;
  bool is_even_;
};
constexpr int squared(int x) { return x * x; }
auto halve(int x) -> int { return x / 2; }
int unused(int x) { return x; }
void note(int& x) {
  if (x > 3) return;
  x = 1'000;  // '{'
}
}  // namespace sample
void run() {
  using namespace sample;
  const double scaled = 4 * kScale;
  int low = 2, high = 5;
  note(low), note(high);
  std::printf("%g %d %d %d %c%c %s\n", scaled, kTable[1], kLimits[0], Pair<int>::kWidth, kQuote, kBrace, R"(}")");
  std::printf("%d %d %d\n", Pair<int>(1)(5), Pair<int>(1) < Pair<int>(2), squared(low) + halve(high));
  std::printf("%d %d %d\n", Base(3, true).size_, Base(4, true).is_even_, squared(Pair<int>::kWidth));
}
'''
MAIN = r'''
#include "sample.cpp"
#include "db/migrate.hpp"
int main() {
  run();
  for (const auto& step : sipplab::db::migration_files()) std::printf("%s", std::string(step.text).c_str());
  std::printf("%s", std::string(sipplab::db::pages()[0].text).c_str());
}
'''
SQL = "CREATE TABLE one (a INTEGER);\nCREATE VIEW v AS SELECT max(a) FROM one\nWHERE a > 0;\n"
PAGE = "<p>\n\n<b>;[x</b>\n"
# Files, texts and what is planted, where 'unused' is never reached.
MUTANTS = [(f"{number}", "sample.cpp", before, after) for number, (before, after) in enumerate([
    ("kScale = 2.5;", "kScale = 3.5;"), ("{{1, 2, 3}}", "{{1, 9, 3}}"), ("kLimits[] = {7, 8}", "kLimits[] = {8, 8}"),
    ("kWidth = 3;", "kWidth = 4;"), ("first + 1", "first - 1"), ("T{4}", "T{5}"), ("sum_ = first_ + second_;", ""),
    ("a.sum_ < b.sum_", "a.sum_ > b.sum_"), ("sum_ + add", "sum_ - add"), ("x * x", "x + x"), ("x / 2", "x / 3"),
    ("x / 2;", "x * 2;"), ("if (x > 3) return;\n", "if (x > 5) return;\n  if (x < 0) return;\n"), ("1'000", "'{'"),
    ("4 * kScale", "4 + kScale"), ("int low = 2, high", "int low = 9, high"), ("i < size;", "i <= size;"),
    ("(size % 2) == 0", "(size % 3) == 0"), ("int x) { return x; }", "int x) { return -x; }")])]
MUTANTS += [("view", "migrations/0001_one.sql", "max(a)", "min(a)"), ("table", "migrations/0001_one.sql", "a INTEGER", "a TEXT"),
            ("page", "page.html", "[x", "[y")]
FILES = {
    "sample.cpp": HEADERS + SAMPLE, "main.cpp": MAIN, "migrations/0001_one.sql": SQL, "page.html": PAGE,
    "db/migrate.hpp": "#pragma once\n#include <span>\n#include <string>\n#include <string_view>\nnamespace sipplab::db {\n"
                      "struct EmbeddedText { std::string_view name, text; };\n"
                      "std::span<const EmbeddedText> migration_files(), pages();\n}\n",
    EMBEDDING: (ROOT / EMBEDDING).read_text()}


def run(folder, *command, **environment):
    return subprocess.run(command, cwd=folder, env=dict(os.environ, **environment), stdout=subprocess.PIPE, text=True, check=True).stdout


def build_switched(folder, mutants, compiler, cmake):
    files = {file: switched(file, text, of_file(mutants, file))
             for file, text in FILES.items()}
    for name, text in {**files, NAMES: names_header(mutants), SWITCH: (ROOT / SWITCH).read_text()}.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)
    for symbol, file in (("migration_files", "migrations/0001_one.sql"), ("pages", "page.html")):
        run(folder, cmake, f"-DFILES={file}", f"-DOUTPUT={symbol}.cpp", f"-DSYMBOL=db::{symbol}", "-DHEADER=db/migrate.hpp", "-P", EMBEDDING)
    run(folder, compiler, "-std=c++20", "-w", "-I.", "main.cpp", "migration_files.cpp", "pages.cpp", "-o", "switched")


def expected_outputs(folder, mutants, compiler):
    """What programs print in which each mutant is planted, and at last none. One program holds them all."""
    texts = [planted(SAMPLE, mutant) for mutant in mutants] + [SAMPLE]
    spaces = "".join(f"namespace planted_{number} {{\n{text}}}\n" for number, text in enumerate(texts))
    calls = "".join(f"    case {number}: planted_{number}::run(); break;\n" for number in range(len(texts)))
    (folder / "planted.cpp").write_text(f"{HEADERS}{spaces}int main(int, char** argv) {{\n  switch (std::atoi(argv[1])) {{\n{calls}  }}\n}}\n")
    run(folder, compiler, "-std=c++20", "-w", "planted.cpp", "-o", "planted")
    return [run(folder, "./planted", str(number)) + "".join(planted(text, mutant) for text in (SQL, PAGE))
            for number, mutant in enumerate([*mutants, {"before": "none", "after": "none"}])]


def main():
    compiler, cmake = sys.argv[1:]
    errors = find_errors(read_mutants())
    mutants = [{"name": name, "file": file, "before": before, "after": after} for name, file, before, after in MUTANTS]
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        build_switched(folder, mutants, compiler, cmake)
        *expected, plain = expected_outputs(folder, mutants, compiler)
        (folder / "reached").write_bytes(bytes(len(mutants)))
        said = run(folder, "./switched", SIPPLAB_MUTANTS_REACHED="reached")
        if said != plain:
            errors.append(f"without a mutant:\n{said}, expected\n{plain}")
        for mutant, wanted, byte in zip(mutants, expected, (folder / "reached").read_bytes()):
            said = run(folder, "./switched", SIPPLAB_MUTANT=mutant["name"])
            if said != wanted:
                errors.append(f"with '{mutant['after']}':\n{said}, expected\n{wanted}")
            if (byte == 1) != (wanted != plain):
                errors.append(f"'{mutant['after']}' is {'' if byte else 'not '}said to be reached")
    overlap = [("T first, T", "T, T"), ("first, T second = T", "x")]
    try:
        switched("sample.cpp", SAMPLE, list(enumerate({"before": before, "after": after} for before, after in overlap)))
        errors.append("texts that overlap in a list of parameters are not refused")
    except SwitchError:
        pass
    sys.exit("\n".join(errors) or 0)


if __name__ == "__main__":
    main()
