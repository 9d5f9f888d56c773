"""The table of planted bugs, and which test programs can reach which of them."""

import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
TABLE = HERE / "mutants.txt"

# Programs that count as the second group: example tests, not properties.
EXAMPLES = ("unit_tests", "db_tests")


def read_mutants(path=TABLE):
    """mutants.txt says at its top what a mutant looks like."""
    mutants = []
    for number, line in enumerate(path.read_text().splitlines(), 1):
        entry = mutants[-1] if mutants else None
        if line.startswith("["):
            mutants.append({"name": line.strip("[]"), "before": [], "after": []})
        elif line.startswith("room "):
            _, entry["room"], _, entry["file"] = line.split()
        elif line.startswith("harm "):
            entry["harm"] = line[len("harm "):].strip()
        elif line.startswith("- "):
            entry["before"].append(line[2:])
        elif line.startswith("+ "):
            entry["after"].append(line[2:])
        elif line and not line.startswith("#"):
            sys.exit(f"{path}:{number}: '{line}', expected a line of a mutant")
    for mutant in mutants:
        mutant["before"] = "\n".join(mutant["before"])
        mutant["after"] = "\n".join(mutant["after"])
    return mutants


def find_errors(mutants, root=ROOT):
    errors = []
    names = [mutant["name"] for mutant in mutants]
    errors += [f"{name}: two mutants of this name" for name in sorted(set(names)) if names.count(name) > 1]
    for mutant in mutants:
        if not mutant["before"] or mutant["before"] == mutant["after"] or "harm" not in mutant:
            errors.append(f"{mutant['name']}: incomplete")
            continue
        file = root / mutant["file"]
        count = file.read_text().count(mutant["before"]) if file.exists() else 0
        if count != 1:
            errors.append(f"{mutant['name']}: its text occurs {count} times in {mutant['file']}, expected once")
    return errors


def wanted(mutants, only):
    """Those named, by mutant or by room; all if none is."""
    if not only:
        return mutants
    unknown = set(only) - {mutant["name"] for mutant in mutants} - {mutant["room"] for mutant in mutants}
    if unknown:
        sys.exit(f"no mutant or room {', '.join(sorted(unknown))}; --list shows all")
    return [mutant for mutant in mutants if mutant["name"] in only or mutant["room"] in only]


# ------------------------------------------------------------------ what reaches what


def find_programs(root):
    """Every test program and the files of the project that it may use."""
    programs = {}
    for source in sorted((root / "property_tests/properties").glob("*.cpp")):
        programs[f"property_{source.stem}"] = [source]
    programs["unit_tests"] = sorted((root / "property_tests/unit").glob("*.cpp"))
    programs["db_tests"] = sorted((root / "db/tests").glob("*.cpp"))
    return {
        name: reachable_files(root, [str(source.relative_to(root)) for source in sources])
        for name, sources in programs.items()
    }


def includes(file):
    return re.findall(r'^#include "([^"]+)"', file.read_text(), re.MULTILINE)


def reachable_files(root, sources):
    """The headers that the sources include, and the sources next to a header that include
    it, all the way down. Too many rather than too few."""
    users = {}
    for folder in ("planner", "db", "property_tests/support"):
        for source in (root / folder).rglob("*.cpp"):
            name = str(source.relative_to(root))
            for header in includes(source):
                if Path(header).parent == Path(name).parent:
                    users.setdefault(header, []).append(name)
    reached, ahead = set(), list(sources)
    while ahead:
        name = ahead.pop()
        if name in reached or not (root / name).exists():
            continue
        reached.add(name)
        ahead += includes(root / name) + users.get(name, [])
    return reached
