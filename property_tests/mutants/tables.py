"""What killed what, in Markdown, and the counterexamples."""

import json

from runner import KILLED, NOT_RUN, ORDER, TIME

VERDICTS = (*ORDER, "survived", "not reached", "not run")


class Results:
    """Cells by mutant and program, one for each program that reaches it, kept in a file to which later runs add."""

    def __init__(self, out, mutants):
        self.out, self.mutants = out, mutants
        self.file = out / "results.json"
        self.cells = json.loads(self.file.read_text()) if self.file.exists() else {}
        out.mkdir(parents=True, exist_ok=True)

    def add(self, mutant, cells):
        known = self.cells.setdefault(mutant["name"], {})
        # What was not run now may have been run before.
        known.update({program: cell for program, cell in cells.items() if cell["outcome"] != NOT_RUN or program not in known})
        self.file.write_text(json.dumps(self.cells, indent=1))

    def mutants_of(self, room):
        return [mutant["name"] for mutant in self.mutants if mutant["room"] == room and mutant["name"] in self.cells]

    def write(self):
        """The tables; what they say in a line."""
        rows = [(mutant, self.cells[mutant["name"]]) for mutant in self.mutants if mutant["name"] in self.cells]
        (self.out / "matrix.md").write_text(f"{rooms(rows)}\n{page(rows)}")
        (self.out / "counterexamples.txt").write_text(counterexamples(rows))
        return summary(rows)


def kills(cells, kind):
    """The programs of a kind that noticed, those that ran out of time last."""
    noticed = [(cell["outcome"] == TIME, cell["seconds"], program) for program, cell in cells.items()
               if cell["kind"] == kind and cell["outcome"] in (KILLED, TIME)]
    return [program for _, _, program in sorted(noticed)]


def verdict(cells):
    """The first kind of test that killed: a mutant with the verdict golden is known from golden texts alone."""
    if not cells:
        return "not reached"
    by = next((kind for kind in ORDER if kills(cells, kind)), None)
    return by or ("not run" if any(cell["outcome"] == NOT_RUN for cell in cells.values()) else "survived")


def first_kill(cells, kind):
    """What noticed first; a point if nothing did, a dash if not all was run, and nothing if nothing could."""
    programs = kills(cells, kind)
    if programs:
        title = "out of time" if cells[programs[0]]["outcome"] == TIME else cells[programs[0]]["title"]
        return f"{programs[0].removeprefix('property.')}: {title}"
    outcomes = [cell["outcome"] for cell in cells.values() if cell["kind"] == kind]
    return "-" if NOT_RUN in outcomes else "." if outcomes else ""


def smallest_case(cells):
    sizes = [(cell["size"]["robots"], cell["size"]["cells"]) for cell in cells.values() if cell.get("size")]
    return "{} robots, {} cells".format(*min(sizes)) if sizes else ""


def summary(rows):
    verdicts = [verdict(cells) for _, cells in rows]
    return f"{len(rows)} mutants: " + ", ".join(f"{verdicts.count(kind)} {kind}" for kind in VERDICTS)


def rooms(rows):
    """How many of each room fell to a law, to an example only, to golden texts only, and to nothing."""
    lines = [f"| room | mutants | {' | '.join(VERDICTS)} |", "|---" + "|---:" * (len(VERDICTS) + 1) + "|"]
    names = list(dict.fromkeys(mutant["room"] for mutant, _ in rows))
    for name in [*names, "all"]:
        found = [verdict(cells) for mutant, cells in rows if name in (mutant["room"], "all")]
        lines.append(f"| {name} | {len(found)} | " + " | ".join(str(found.count(kind)) for kind in VERDICTS) + " |")
    return "\n".join([*lines, ""])


def page(rows):
    lines = [f"| room | mutant | {' | '.join(ORDER)} | smallest case |", "|---" * (len(ORDER) + 3) + "|"]
    for mutant, cells in rows:
        found = " | ".join(first_kill(cells, kind).replace("|", "\\|") for kind in ORDER)
        lines.append(f"| {mutant['room']} | {mutant['name']} | {found} | {smallest_case(cells)} |")
    return "\n".join([*lines, ""])


def counterexamples(rows):
    return "".join(f"==== {mutant['name']} / {program}: {cell['title']}\n" + "\n".join(cell["lines"]) + "\n\n"
                   for mutant, cells in rows for program, cell in cells.items()
                   if cell["outcome"] == KILLED and cell["kind"] == "law")
