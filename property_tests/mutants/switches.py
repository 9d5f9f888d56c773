"""Turns planted bugs into switches: sources that hold every bug, of which SIPPLAB_MUTANT picks one.

Doubled is the smallest thing that can be, whatever the bug is: the body of a function, a
constant, a file of SQL or HTML. So bugs may share a line, and need be no expressions. What
lies elsewhere, as in the list of a constructor's members, is doubled as an expression.
"""

import re
from itertools import pairwise

# Not code: raw strings, strings, characters (no ' between digits), comments, lines of the preprocessor.
NO_CODE = re.compile(r'R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|(?<!\w)\'(?:\\.|[^\'\\\n])+\''
                     r"|//[^\n]*|/\*.*?\*/|^[ \t]*#(?:\\\n|[^\n])*", re.DOTALL | re.MULTILINE)
INCLUDE = '#include "property_tests/mutants/switch.hpp"\n'
# Files that EMBEDDING puts into raw strings with this delimiter.
EMBEDDED = (".sql", ".html")
EMBEDDING = "db/cmake/embed.cmake"
DELIMITER = "embedded"
PARENTHESES = "\0"  # stands for a pair and what is in it


class SwitchError(Exception):
    pass


def switched(file, text, mutants):
    """The text of a file with these pairs of number and mutant as switches in it."""
    if file == EMBEDDING:
        return text.replace("#include", INCLUDE.replace('"', '\\"') + "#include", 1)
    if not mutants:
        return text
    if file.endswith(EMBEDDED):
        begin, end = f'R"{DELIMITER}(', f'){DELIMITER}"'
        chosen = "".join(f"{is_chosen(number)} ? {begin}{planted(text, mutant)}{end} : " for number, mutant in mutants)
        return f'{end}[0] == 0 && {chosen}{begin}{text}'  # the build writes begin before this and end behind it
    places = {}
    code = NO_CODE.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)
    for number, mutant in mutants:
        begin, end, kind = place(code, text, mutant)
        changed = planted(text, mutant)
        version = changed[begin:len(changed) - (len(text) - end)]
        places.setdefault((begin, end, kind), []).append((number, version))
    for (_, end, _), (begin, _, _) in pairwise(sorted(places)):
        if begin < end:
            raise SwitchError(f"{file}: mutants overlap near '{text[begin:end]}'")
    result = text
    for (begin, end, kind), versions in sorted(places.items(), reverse=True):
        result = result[:begin] + KINDS[kind](text[begin:end], versions) + result[end:]
    return INCLUDE + result


def planted(text, mutant):
    return text.replace(mutant["before"], mutant["after"])


def is_on(number):
    return f"::sipplab_mutants::is_on({number})"


def is_chosen(number):
    return f"::sipplab_mutants::is_chosen({number})"


def place(code, text, mutant):
    """What is doubled for a mutant: begin, end and kind."""
    begin = text.index(mutant["before"])
    end = begin + len(mutant["before"])
    # Where texts begin and end alike, nothing changes.
    before, after = mutant["before"], mutant["after"]
    same = next((i for i, (a, b) in enumerate(zip(before, after)) if a != b), min(len(before), len(after)))
    rest = min(len(before), len(after)) - same
    tail = next((i for i, (a, b) in enumerate(zip(before[::-1], after[::-1])) if a != b or i == rest), rest)
    for unit_begin, unit_end, kind in units(code):
        if unit_begin <= begin + same and end - tail <= unit_end:
            return unit_begin, unit_end, kind
    return begin, end, "expression"


def units(code):
    """Bodies of functions, without their braces, and constants outside of functions."""
    head = at = 0
    while match := re.compile(r"[{};]").search(code, at):
        at = match.end()
        words = plain(code[head:match.start()])
        if match[0] == ";":
            declaration = code[head:at]
            if re.match(r"[^=]*\bconst(expr)?\b", words) and re.search(r"[={]", declaration) and \
                    PARENTHESES not in words.split("=")[0]:
                yield at - len(declaration.lstrip()), at, "constant"
        elif match[0] == "{" and not is_scope(words):
            close = end_of_block(code, at)
            if is_initializer(words, code[match.start() - 1]):
                at = close + 1
                continue  # of the same declaration
            yield at, close, "body"
            at = close + 1
        head = at


def plain(head):
    """The words before a brace or semicolon, without what is in parentheses and angle brackets."""
    head = re.sub(r"\boperator\s*(\(\s*\)|[^\w\s(]+)|\balignas\([^)]*\)|\b(public|private|protected)\s*:", " ", head)
    before = None
    while before != head:
        before, head = head, re.sub(r"\([^()]*\)", PARENTHESES, re.sub(r"<[^<>;]*>", "", head))
    return head


def is_scope(words):
    return bool(re.search(r"\b(namespace|extern)\b", words)
                or re.search(r"\b(class|struct|union|enum)\b", words) and PARENTHESES not in words)


def is_initializer(words, before):
    """Of a variable, or of a member in the list of a constructor: its brace follows a name at once."""
    is_member = re.search(PARENTHESES + r".*(?<!:):(?!:)", words, re.DOTALL) and re.match(r"[\w>]", before)
    return "=" in words or PARENTHESES not in words or bool(is_member)


def end_of_block(code, at):
    depth = 1
    for match in re.compile(r"[{}]").finditer(code, at):
        depth += 1 if match[0] == "{" else -1
        if depth == 0:
            return match.start()
    raise SwitchError("a brace is not closed")


def double_body(body, versions):
    return "".join(f" if ({is_on(number)}) [[unlikely]] {{{version}}} else" for number, version in versions) + f" {{{body}}} "


def double_constant(declaration, versions):
    """name_plain as it is, name_N with mutant N, and name, one of them."""
    code = NO_CODE.sub(lambda match: " " * len(match[0]), declaration)
    name = re.search(r"(\w+)\s*(\[[^\]]*\]\s*)*[={]", code)[1]
    renamed = lambda text, number: re.sub(rf"\b{name}\b", f"{name}_{number}", text, count=1)
    chosen = "".join(f"{is_chosen(number)} ? {name}_{number} : " for number, _ in versions)
    return "\n".join([renamed(declaration, "plain"), *(renamed(version, number) for number, version in versions),
                      f"static inline const auto& {name} = {chosen}{name}_plain;"])


def double_expression(expression, versions):
    return "(" + "".join(f"{is_on(number)} ? ({version}) : " for number, version in versions) + f"({expression}))"


KINDS = {"body": double_body, "constant": double_constant, "expression": double_expression}
