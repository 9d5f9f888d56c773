"""What killed what, as tables: text, Markdown and CSV, and the counterexamples."""

import csv
import json

from mutants import EXAMPLES
from runner import KILLED, NOT_RUN, SURVIVED, TIME, UNREACHED

SYMBOL = {KILLED: "K", TIME: "T", SURVIVED: ".", UNREACHED: " ", NOT_RUN: "-"}
LEGEND = "K killed, T killed by its time limit, . survived, - not run, blank: cannot reach the code"


class Results:
    """Cells by mutant and program, kept in a file to which later runs add."""

    def __init__(self, out):
        self.out = out
        self.file = out / "results.json"
        self.cells = json.loads(self.file.read_text()) if self.file.exists() else {}

    def add(self, mutant, cells):
        self.cells.setdefault(mutant["name"], {}).update(cells)
        self.file.write_text(json.dumps(self.cells, indent=1))

    def rows(self, mutants):
        return [(mutant, self.cells[mutant["name"]]) for mutant in mutants if mutant["name"] in self.cells]


def verdict(cells):
    if not cells:
        return "not run"
    properties = [cell for program, cell in cells.items() if program not in EXAMPLES]
    if any(cell["outcome"] in (KILLED, TIME) for cell in properties):
        return "killed"
    if any(cell["outcome"] in (KILLED, TIME) for cell in cells.values()):
        return "by examples only"
    return "SURVIVED"


def first_kill(cells):
    killed = [(program in EXAMPLES, cell["outcome"] == TIME, cell["seconds"], program, cell)
              for program, cell in cells.items() if cell["outcome"] in (KILLED, TIME)]
    if not killed:
        return "", ""
    _, _, _, program, cell = min(killed, key=lambda kill: kill[:4])
    title = cell["title"] if cell["outcome"] == KILLED else "out of time"
    size = cell.get("size")
    return (f"{program.removeprefix('property_')}: {title}",
            f"{size['robots']} robots, {size['cells']} cells" if size else "")


def summary(rows):
    verdicts = [verdict(cells) for _, cells in rows]
    return (f"{len(rows)} mutants: {verdicts.count('killed')} killed by a property, "
            f"{verdicts.count('by examples only')} by example tests only, {verdicts.count('SURVIVED')} survived.")


class Matrix:
    """One row for each mutant that was run, one column for each program."""

    def __init__(self, rows, programs):
        self.rows, self.programs = rows, programs
        self.columns = sorted(programs, key=lambda program: (program in EXAMPLES, program))
        self.heads = [column.removeprefix("property_") for column in self.columns]

    def write(self, out):
        (out / "matrix.txt").write_text(self.text())
        (out / "matrix.md").write_text(self.page())
        (out / "kills.md").write_text(self.kills())
        (out / "counterexamples.txt").write_text(self.counterexamples())
        with open(out / "matrix.csv", "w", newline="") as table:
            self.write_csv(csv.writer(table))

    def outcome(self, mutant, cells, column):
        missing = NOT_RUN if mutant["file"] in self.programs[column] else UNREACHED
        return cells.get(column, {}).get("outcome", missing)

    def marks(self, mutant, cells, separator):
        return separator.join(SYMBOL[self.outcome(mutant, cells, column)] for column in self.columns)

    def text(self):
        lines = [LEGEND, ""]
        lines += ["  " + "| " * position + head for position, head in enumerate(self.heads)]
        lines += [f"  {self.marks(mutant, cells, ' ')}  {verdict(cells):16}  {mutant['room']}: {mutant['name']}"
                  for mutant, cells in self.rows]
        return "\n".join([*lines, "", summary(self.rows), ""])

    def page(self):
        heads = " | ".join(head.replace("_", " ") for head in self.heads)
        lines = [f"| room | mutant | {heads} | first kill | smallest case |", "|---" * (len(self.heads) + 4) + "|"]
        for mutant, cells in self.rows:
            kill, size = first_kill(cells)
            kill = kill.replace("|", "\\|") or "**survived**"
            lines.append(f"| {mutant['room']} | {mutant['name']} | {self.marks(mutant, cells, ' | ')} "
                         f"| {kill} | {size} |")
        return "\n".join([*lines, "", summary(self.rows), ""])

    def kills(self):
        """The same without marks: what noticed first."""
        lines = ["| room | mutant | killed by | smallest case |", "|---|---|---|---|"]
        for mutant, cells in self.rows:
            kill, size = first_kill(cells)
            kill = kill.replace("|", "\\|") or "**survived**"
            lines.append(f"| {mutant['room']} | {mutant['name']} | {kill} | {size} |")
        return "\n".join([*lines, "", summary(self.rows), ""])

    def write_csv(self, writer):
        writer.writerow(["mutant", "room", "file", "program", "outcome", "property", "cpu_seconds", "robots", "cells"])
        for mutant, cells in self.rows:
            for column in self.columns:
                cell = cells.get(column, {"outcome": self.outcome(mutant, cells, column)})
                size = cell.get("size") or {}
                writer.writerow([mutant["name"], mutant["room"], mutant["file"], column, cell["outcome"],
                                 cell.get("title") if cell["outcome"] == KILLED else "", cell.get("seconds", ""),
                                 size.get("robots", ""), size.get("cells", "")])

    def counterexamples(self):
        return "".join(f"==== {mutant['name']} / {column}: {cell['title']}\n" + "\n".join(cell["lines"]) + "\n\n"
                       for mutant, cells in self.rows for column, cell in cells.items()
                       if cell["outcome"] == KILLED and column not in EXAMPLES)
