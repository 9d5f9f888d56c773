"""The table of planted bugs."""

import sys
from pathlib import Path

from switches import SwitchError, switched

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
TABLE = HERE / "mutants.txt"


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


def of_file(mutants, file):
    """Those of a file with their numbers."""
    return [(number, mutant) for number, mutant in enumerate(mutants) if mutant["file"] == file]


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
    for file in sorted({mutant["file"] for mutant in mutants} if not errors else ()):
        try:
            switched(file, (root / file).read_text(), of_file(mutants, file))
        except SwitchError as error:
            errors.append(str(error))
    return errors


def wanted(mutants, only):
    """Those named, by mutant or by room; all if none is."""
    if not only:
        return mutants
    unknown = set(only) - {mutant["name"] for mutant in mutants} - {mutant["room"] for mutant in mutants}
    if unknown:
        sys.exit(f"no mutant or room {', '.join(sorted(unknown))}; --list shows all")
    return [mutant for mutant in mutants if mutant["name"] in only or mutant["room"] in only]
