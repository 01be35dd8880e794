"""Do the conformance cases notice a wrong instruction? Each instruction module is spoilt in one place at a time and its cases run.

`python bench/mutants.py` prints the table and the survivors, `python bench/mutants.py shifts clock` those of some modules,
`--write` puts all of it into docs/mutation.md.

A mutant is a module with one operator exchanged, one constant off by one, one condition turned round, one statement or one
column of a decorator taken away, and so on (`changes`). The cases of the mnemonics that reach the changed place run on the
compiled engine in a process of their own, those of the program's structure on the stepping engine too; a case that fails, an
exception or a run without end kills the mutant. What cannot even be imported is no mutant. Survivors that no program can tell
from the original stand in EQUIVALENT with the reason.

Step counts, sections, areas and types are left alone: tests/instructions/test_table.py holds them against the manual.
"""

import argparse
import ast
import copy
import linecache
import multiprocessing
import re
import resource
import sys
import types
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache
from itertools import product
from multiprocessing.connection import wait
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from ecsim.instructions import TABLE  # noqa: E402
from ecsim.instructions.signature import parse_signature  # noqa: E402
from ecsim.models import MODELS, By  # noqa: E402
from ecsim.scenario import load_cases, run_case  # noqa: E402

SOURCES = ROOT / "ecsim" / "instructions"
PAGE = ROOT / "docs" / "mutation.md"
NO_CHAPTER = {"__init__", "define", "signature", "spelling"}
WORKERS = 2
LIMIT_S = 60  # of the processor for all cases of a mutant; a run without end is noticed, too

# Survivors that say the same as the original: a pattern of their names -> why no program can tell.
EQUIVALENT = {
    r".*: machine\.clock\[0\] -> machine\.clock\[-1\].*": "the clock is a list of one element",
    r"bits\.enco: s & -s -> s \| -s": "s | -s is the negative number of the same lowest bit, and as long",
    r"clock\.(trd|twr): faults=.*": "what a span of registers raises is caught anyway; the column then serves the help page alone",
    r"clock\.run_on: \(None, 0, 0\) -> \(None, -?1, 0\)": "the scan is looked at only when there is a time to count from",
    r"clock\._comparing: .*__doc__.*": "the words of the help page",
    r"communication.*: 7 \+ 255 -> (8 \+ 255|7 \+ 256)": "no request is longer than 262 bytes",
    r"communication\.modbus: words\[.* -> words\[source\.number:\]": "what is behind the request is left out when its length is known",
    r"communication\.modbus: octets\.ljust\(7, .* -> octets\.ljust\(8, .*": "the length is told by the first seven bytes",
    r"communication\.(xmt|rcv): faults=.*": "what a span of devices raises is caught anyway; the column then serves the help page alone",
    r"contacts\.rst: resets=True -> nothing": "RST clears in its own way; the column serves the chart and spans of devices",
    r"(flow\.next_|sfc\.ret|master_control\.mcr|fx_basic\.mcr): code\.close\(\) -> nothing": "no engine writes anything there, the program's structure tells where it ends",
    r"sfc\.stl: code\.step\(\) -> nothing": "no engine writes anything there, the program's structure tells where it begins",
    r"transfer\.check: strings\[-?[01]\] -> .*\(2\)": "the words of the message",
    r"conversion\.truncated: s > high -> s >= high": "a number at the limit has been dealt with before",
    r"conversion\.hold: len\(words\) > 1 -> len\(words\) > 2": "with a count above 256 a device gives 64 words, a constant one",
    r"conversion\.one_to_256: 65535 if .* -> 65536 if .*": "no constant of 16 bits is larger than 65535",
    r"floating_point\.power: s1 < 0 -> s1 <= 0 \(2\)": "no power of 0 overflows",
    r"peripherals\.ref: faults=.*": "the compiler has refused what lies beyond the end",
    r"peripherals\.ref: (raise Fault\(RANGE\) -> nothing|device\.number \+ count -> device\.number - count)": "the compiler has refused what lies beyond the end",
    r"peripherals\.ref: .* -> .*S:INT\[const\]=(7\.\.256|8\.\.257)": "7 and 257 are no multiples of 8",
    r"positioning\._limits: .* -> registers\[place\] \* 10 > top > 0": "a tenth exactly is set to itself",
    r"positioning\.zrn: plan\[0\] -> plan\[-1\]": "the plan has one segment there",
    r"positioning\.plsv: hertz > 0 -> hertz (>= 0|> 1|> -1).*": "0 has been dealt with, and 1 to 9 Hz have been refused",
    r"positioning\._move: pulses > 0 -> pulses (>= 0|> -1).*": "a move of 0 pulses has been left out",
    r"positioning\.read_position: faults=.*": "what a span of devices raises is caught anyway; the column then serves the help page alone",
    r"fx_data\.(enco|enco_of_bits): faults=.*": "what a span of devices raises is caught anyway; the column then serves the help page alone",
    r"fx_data\.ans: .* -> S:TIMER\[T\]=-1\.\.199 .*": "there is no T-1",
    r"fx_move\._from_the_left: min\(m1, n\) -> max\(m1, n\) \(2\)": "the words of the message",
    r"fx_(move|shifts)\.: as_stored=True -> as_stored=False": "what comes out of registers fits into them",
    r"fx_shifts\.: (enumerate\(|\(5, 9\) -> |strict=).*": "sections and lengths; there are as many functions as widths",
    r"fx_basic\._preset: .* -> 0 <= preset <= 32768": "no constant of 16 bits is larger than 32767",
    r"fx_handy\.ist: .* -> .*D2:POINT\[S\]=(19|21)\.\.899 .*": "D2 is above D1, which is 20 at least",
    r"fx_handy\.ist: \(STEP, CYCLE\) -> .*": "the order in which a mode is looked for",
    r"fx_handy\.absd: strict=True -> strict=False": "the table has two values for each bit",
    r"fx_handy\.(ttmr|rotc): state\[0\] -> state\[-1\]": "the state is a tuple of one element",
    r"fx_handy\.stmr: \(False, now, False\) -> \((True, now, False|False, now, True)\)": "it begins with flow, now, and nothing is late then",
    r"fx_external\.(dsw|segl|arws): faults=.*": "what a span of devices raises is caught anyway; the column then serves the help page alone",
    r"fx_external\.(mtr|dsw): \(0, now, .*False\) -> \(0, now, .*True\)": "no time has gone by then",
    r"fx_external\.dsw: 4 \* each -> 5 \* each \(2\)": "of the second set the slice ends with the last input",
    r"fx_external\.(dsw|arws): strict=True -> strict=False": "there are as many numbers as sets, as many keys as before",
    r"fx_external\.vrsc: .*pots\.read\(s\).*": "no model that has it has a potentiometer; tests/instructions/test_fx_values.py turns one",
    r"fx_ascii\._round_numbers: \(source, target\) -> \(target, source\)": "the words of the message, where both are wrong",
    r"highspeed\.(spd|dhsz): faults=.*": "what a span of devices raises is caught anyway; the column then serves the help page alone",
    r"highspeed\.pls: 0 <= first <= (.*) -> -1 <= first <= .*": "the number is read without sign",
    r"highspeed\.pls: first \+ 4 \* steps \+ 2 -> first \+ 4 \* steps \+ 1": "steps of two end at the same place",
    r"highspeed\.pls: pairs\[:-1:2\] -> pairs\[:-2:2\]": "every other one of an odd number ends at the same place",
    r"highspeed\.pwm: axis\.segments\[0\] -> axis\.segments\[-1\]": "a width has one segment, its wave",
    r"highspeed\.pls: strict=True -> strict=False": "there are as many frequencies as numbers of pulses",
}

OPERATORS = {
    ast.Add: [ast.Sub], ast.Sub: [ast.Add], ast.Mult: [ast.Div], ast.Div: [ast.Mult], ast.FloorDiv: [ast.Mult], ast.Mod: [ast.FloorDiv],
    ast.Pow: [ast.Mult], ast.LShift: [ast.RShift], ast.RShift: [ast.LShift], ast.BitAnd: [ast.BitOr], ast.BitOr: [ast.BitAnd],
    ast.BitXor: [ast.BitOr],
}  # fmt: skip
COMPARISONS = {
    ast.Lt: [ast.LtE, ast.GtE], ast.LtE: [ast.Lt, ast.Gt], ast.Gt: [ast.GtE, ast.LtE], ast.GtE: [ast.Gt, ast.Lt], ast.Eq: [ast.NotEq],
    ast.NotEq: [ast.Eq], ast.Is: [ast.IsNot], ast.IsNot: [ast.Is], ast.In: [ast.NotIn], ast.NotIn: [ast.In],
}  # fmt: skip
CALLS = {"min": "max", "max": "min", "floor": "ceil", "sin": "cos", "cos": "sin", "tan": "sin", "log": "exp", "exp": "log"}
WORDS = {"and": "or", "or": "and", "set": "reset", "reset": "set", "outputs": "data", "data": "outputs"}
BEHAVIOUR = {"cleared", "released", "resets", "rising", "check", "counted", "occupies", "bus"}  # columns whose loss a program may feel


@dataclass
class Mutant:
    """One change of one module: where, what, and the mnemonics that can feel it."""

    module: str
    line: int
    where: str  # the function
    old: str
    new: str  # "" when nothing stays in its place
    source: str
    mnemonics: tuple[str, ...]
    verdict: str = ""  # what noticed it, "" for a survivor, "no import" for none
    name: str = ""  # how EQUIVALENT calls it


# -- making them --------------------------------------------------------------------------------------------------


def changes(node: ast.AST, inside: bool) -> Iterator[Callable[[ast.AST], ast.AST | None]]:
    """The ways to spoil one node: functions that give the new one, or None where nothing stays in its place."""

    def exchanged(attribute: str, new: object) -> Callable[[ast.AST], ast.AST]:
        def apply(node: ast.AST) -> ast.AST:
            setattr(node, attribute, new)
            return node

        return apply

    match node:
        case ast.BinOp():
            for new in OPERATORS.get(type(node.op), []):
                yield exchanged("op", new())
        case ast.AugAssign():
            for new in OPERATORS.get(type(node.op), []):
                yield exchanged("op", new())
        case ast.Compare():
            for place, operator in enumerate(node.ops):
                for new in COMPARISONS[type(operator)]:
                    yield exchanged("ops", [*node.ops[:place], new(), *node.ops[place + 1 :]])
        case ast.BoolOp():
            yield exchanged("op", ast.Or() if isinstance(node.op, ast.And) else ast.And())
        case ast.UnaryOp():
            yield lambda node: node.operand
        case ast.IfExp():
            yield lambda node: ast.IfExp(node.test, node.orelse, node.body)
        case ast.Constant(value=bool()):
            yield exchanged("value", not node.value)
        case ast.Constant(value=int() | float()):
            yield exchanged("value", node.value + 1)
            yield exchanged("value", node.value - 1)
        case ast.Constant(value=str()) if node.value in WORDS:
            yield exchanged("value", WORDS[node.value])
        case ast.Slice():
            for bound in ("lower", "upper", "step"):
                if getattr(node, bound) is not None:
                    yield exchanged(bound, None)
        case ast.Tuple(ctx=ast.Load()) if inside and len(node.elts) == 2 and all(isinstance(part, ast.Name) for part in node.elts):
            yield exchanged("elts", node.elts[::-1])
        case ast.Call(func=ast.Name(id=name)) if name in CALLS and (name in ("min", "max", "floor")):
            yield exchanged("func", ast.Name(CALLS[name], ast.Load()))
        case ast.Call(func=ast.Attribute(attr=name)) if name in CALLS:
            yield exchanged("func", ast.Attribute(node.func.value, CALLS[name], ast.Load()))
        case ast.Call(func=ast.Name(id="abs" | "rounded" | "single"), args=[_]):
            yield lambda node: node.args[0]
    if isinstance(node, (ast.If, ast.While)):
        yield exchanged("test", ast.UnaryOp(ast.Not(), node.test))
    if inside and isinstance(node, (ast.Assign, ast.AugAssign, ast.Raise, ast.Break)):
        yield lambda node: None
    if inside and isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
        yield lambda node: None


def decorations(call: ast.Call) -> Iterator[tuple[str, str, ast.Call]]:
    """The ways to spoil a decorator: a flag, a range, a span or a column less, a bound off by one."""
    for place, keyword in enumerate(call.keywords):
        command = isinstance(call.func, ast.Name) and call.func.id == "command"
        if keyword.arg in BEHAVIOUR or (keyword.arg == "faults" and command):  # of others it is for the help page alone
            yield ast.unparse(keyword), "", ast.Call(call.func, call.args, [*call.keywords[:place], *call.keywords[place + 1 :]])
        if keyword.arg == "flags" and isinstance(keyword.value, ast.Tuple) and len(keyword.value.elts) > 1:
            for out in keyword.value.elts:
                less = ast.keyword(keyword.arg, ast.Tuple([word for word in keyword.value.elts if word is not out], ast.Load()))
                new = [*call.keywords[:place], less, *call.keywords[place + 1 :]]
                yield ast.unparse(keyword), ast.unparse(less), ast.Call(call.func, call.args, new)
    signature = call.args[1] if len(call.args) > 1 else None
    if isinstance(signature, ast.Constant) and isinstance(signature.value, str):
        for new in signatures(signature.value):
            yield signature.value, new, ast.Call(call.func, [call.args[0], ast.Constant(new), *call.args[2:]], call.keywords)


def signatures(text: str) -> Iterator[str]:
    """A signature with a bound of a range off by one, a range, `^` or span less, or a span of another length."""
    words = re.findall(r"(?:\[[^]]*\]|\S)+", text)  # an area list has blanks of its own
    for place, word in enumerate(words):
        others = []
        bare, equals, bounds = word.partition("=")
        if equals and ".." in bounds:
            low, _, high = bounds.partition("..")
            kind = parse_signature(word)[0][0].type
            others = [bare]
            others += [f"{bare}={int(low) + step}..{high}" for step in (1, -1) if int(low) + step >= kind.low]
            others += [f"{bare}={low}..{int(high) + step}" for step in (1, -1) if int(high) + step <= kind.high]
        if "^" in word:
            others.append(word.replace("^", ""))
        _, star, span = bare.partition("*")
        digits = span.rstrip("^~!")
        if star and digits.isdigit():
            others += [word.replace(f"*{digits}", f"*{int(digits) + step}") for step in (1, -1) if int(digits) + step > 0]
        for other in others:
            yield " ".join([*words[:place], other, *words[place + 1 :]])


class _Replaced(ast.NodeTransformer):
    """A copy of a tree with one node changed."""

    def __init__(self, target: ast.AST, apply: Callable[[ast.AST], ast.AST | None]):
        self.target, self.apply, self.new = target, apply, None

    def visit(self, node: ast.AST) -> ast.AST:
        if node is not self.target:
            return self.generic_visit(node)
        self.new = self.apply(node)
        return ast.Pass() if self.new is None else self.new


def _spoilt(statement: ast.stmt, path: tuple, apply: Callable) -> tuple[str, str, str]:
    """The source of a statement whose node at a path is changed, and the words before and after, with a little around what is small."""
    statement = copy.deepcopy(statement)
    holders: list[ast.AST] = [statement]
    for attribute, place in path:
        holders.append(getattr(holders[-1], attribute) if place is None else getattr(holders[-1], attribute)[place])
    node = shown = holders.pop()
    while isinstance(shown, _SMALL) and holders and isinstance(holders[-1], ast.expr | ast.Return | ast.Assign | ast.keyword):
        shown = holders.pop()
    old = _words(shown)
    replacer = _Replaced(node, apply)
    statement = ast.fix_missing_locations(replacer.visit(statement))
    if replacer.new is None:
        return ast.unparse(statement), old, ""
    return ast.unparse(statement), old, _words(replacer.new if shown is node else shown)


_SMALL = (ast.Constant, ast.Name, ast.Slice, ast.UnaryOp)


def _words(node: ast.AST) -> str:
    return f"if {ast.unparse(node.test)}" if isinstance(node, (ast.If, ast.While)) else ast.unparse(node)


def _nodes(node: ast.AST, path: tuple = (), holders: tuple[ast.AST, ...] = ()) -> Iterator[tuple[ast.AST, tuple, tuple[ast.AST, ...]]]:
    """Every node below one with the way to it and all that hold it; docstrings, decorators and annotations left out."""
    for name, value in ast.iter_fields(node):
        if name in ("returns", "annotation", "decorator_list"):
            continue
        for place, child in enumerate(value) if isinstance(value, list) else [(None, value)]:
            if isinstance(child, ast.AST) and not _of_the_table(node, child):
                way, above = (*path, (name, place)), (*holders, node)
                yield child, way, above
                yield from _nodes(child, way, above)


def _of_the_table(node: ast.AST, child: ast.AST) -> bool:
    """Whether a part says what the table says: a docstring, steps, a section, a number in a row of names."""
    if isinstance(child, ast.keyword):
        return child.arg in ("steps", "section")
    if isinstance(child, ast.Expr):
        return isinstance(child.value, ast.Constant)
    named = isinstance(node, ast.Tuple) and any(isinstance(part, ast.Constant) and isinstance(part.value, str) for part in node.elts)
    return named and isinstance(child, ast.Constant) and isinstance(child.value, int)


def _names(node: ast.AST) -> set[str]:
    return {part.id for part in ast.walk(node) if isinstance(part, ast.Name)}


@cache
def rows_of(module: str) -> frozenset[str]:
    """The rows of TABLE that a module defines; the function of some may be another module's."""
    saved = dict(TABLE)
    TABLE.clear()
    exec(compile((SOURCES / f"{module}.py").read_text(encoding="utf-8"), module, "exec"), _blank(module).__dict__)
    names = frozenset(TABLE)
    TABLE.clear()
    TABLE.update(saved)
    return names


def _blank(module: str) -> types.ModuleType:
    """An empty module in the place of one of the instructions."""
    empty = types.ModuleType(f"ecsim.instructions.{module}")
    empty.__package__ = "ecsim.instructions"
    return empty


def reach(tree: ast.Module, module: str) -> Callable[[ast.stmt], tuple[str, ...]]:
    """A function that tells which mnemonics can feel a change in a statement of the module."""
    own = {name: TABLE[name] for name in rows_of(module)}
    functions = defaultdict(set)
    for name, row in TABLE.items():
        if row.function.__module__.endswith(f".{module}"):
            functions[row.function.__code__.co_firstlineno].add(name)
    elsewhere = {name for name, row in own.items() if not row.function.__module__.endswith(f".{module}")}
    mnemonics: dict[int, set[str]] = {}
    uses: dict[str, set[int]] = defaultdict(set)
    for place, statement in enumerate(tree.body):
        first = min([statement.lineno, *(d.lineno for d in getattr(statement, "decorator_list", []))])
        mnemonics[place] = {name for line, names in functions.items() if first <= line <= statement.end_lineno for name in names}
        if isinstance(statement, ast.For) and not mnemonics[place]:
            mnemonics[place] = set(own)
        if isinstance(statement, ast.Expr):
            mnemonics[place] = elsewhere
        for name in _names(statement):
            uses[name].add(place)

    def defined(statement: ast.stmt) -> set[str]:
        if isinstance(statement, (ast.FunctionDef, ast.ClassDef)):
            return {statement.name}
        return {part.id for part in ast.walk(statement) if isinstance(part, ast.Name) and isinstance(part.ctx, ast.Store)}

    def felt(statement: ast.stmt) -> tuple[str, ...]:
        seen, waiting, found = set(), [tree.body.index(statement)], set()
        while waiting:
            place = waiting.pop()
            if place in seen:
                continue
            seen.add(place)
            found |= mnemonics[place]
            waiting += [user for name in defined(tree.body[place]) for user in uses[name]]
        return tuple(sorted(found))

    return felt


def mutants(module: str) -> list[Mutant]:
    """All mutants of one instruction module."""
    source = (SOURCES / f"{module}.py").read_text(encoding="utf-8")
    tree = ast.parse(source)
    felt = reach(tree, module)
    texts = [ast.unparse(statement) for statement in tree.body]
    found: list[Mutant] = []
    seen: set[str] = set(texts)

    for place, statement in enumerate(tree.body):
        mnemonics = felt(statement)
        if not mnemonics or isinstance(statement, (ast.Import, ast.ImportFrom)):
            continue
        for node, path, holders in [(statement, (), []), *_nodes(statement)]:
            functions = [holder.name for holder in [*holders, node] if isinstance(holder, ast.FunctionDef)]
            spoilt = [(path, apply, None, mnemonics) for apply in changes(node, inside=bool(functions))]
            for at, call in enumerate(node.decorator_list if isinstance(node, ast.FunctionDef) else []):
                if isinstance(call, ast.Call):
                    own = (call.args[0].value,) if call.args and isinstance(call.args[0], ast.Constant) else mnemonics
                    way = (*path, ("decorator_list", at))
                    spoilt += [(way, lambda _, new=new: new, (old, shown), own) for old, shown, new in decorations(call)]
            for way, apply, told, felt_by in spoilt:
                text, old, new = _spoilt(statement, way, apply)
                if text in seen:
                    continue
                seen.add(text)
                whole = "\n\n".join([*texts[:place], text, *texts[place + 1 :]])
                line = getattr(node, "lineno", statement.lineno)
                found.append(Mutant(module, line, functions[-1] if functions else "", *(told or (old, new)), whole, felt_by))
    count: Counter[str] = Counter()
    for mutant in found:
        base = f"{module}.{mutant.where}: {mutant.old} -> {mutant.new or 'nothing'}"
        count[base] += 1
        mutant.name = base if count[base] == 1 else f"{base} ({count[base]})"
    return found


# -- running them -------------------------------------------------------------------------------------------------


def install(mutant: Mutant) -> None:
    """Put the mutant's instructions in the place of the module's own."""
    lent = {name: row for name, row in TABLE.items() if row.function.__module__.endswith(f".{mutant.module}")}
    for mnemonic in rows_of(mutant.module):
        del TABLE[mnemonic]
        lent.pop(mnemonic, None)
    spoilt = _blank(mutant.module)
    place = f"<mutant of {mutant.module}>"
    spoilt.__file__ = place
    linecache.cache[place] = (len(mutant.source), None, mutant.source.splitlines(keepends=True), place)
    sys.modules[spoilt.__name__] = spoilt
    exec(compile(mutant.source, place, "exec"), spoilt.__dict__)
    for name, row in lent.items():  # rows of other modules with a function of this one
        TABLE[name] = replace(row, function=getattr(spoilt, row.function.__name__, row.function))


def noticed(mutant: Mutant, cases: list[dict]) -> str:
    """The first case that fails with the mutant, "" when none does."""
    try:
        install(mutant)
    except Exception:
        return "no import"
    engines = (False, True) if any(TABLE[name].form == "emitted" for name in mutant.mnemonics) else (False,)
    for tracing, case in product(engines, cases):
        for model in case["models"]:
            try:
                passed = run_case(case, model, tracing).passed
            except Exception as error:
                return f"{case['id']}: {type(error).__name__}"
            if not passed:
                return case["id"]
    return ""


def _work(mutant: Mutant, cases: list[dict], answer) -> None:
    resource.setrlimit(resource.RLIMIT_CPU, (LIMIT_S, LIMIT_S))
    answer.send(noticed(mutant, cases))
    answer.close()


def judge(all_mutants: list[Mutant], cases: dict[str, list[dict]]) -> None:
    """Fill in every mutant's verdict, each in a process of its own, two at a time."""
    fork = multiprocessing.get_context("fork")
    waiting, running = list(reversed(all_mutants)), {}
    while waiting or running:
        while waiting and len(running) < WORKERS:
            mutant = waiting.pop()
            here, there = fork.Pipe(duplex=False)
            own = [case for mnemonic in mutant.mnemonics for case in cases[mnemonic]]
            process = fork.Process(target=_work, args=(mutant, own, there))
            process.start()
            there.close()
            running[here] = mutant, process
        for answer in wait(list(running)):
            mutant, process = running.pop(answer)
            try:
                mutant.verdict = answer.recv()
            except EOFError:
                mutant.verdict = "a run without end"
            process.join()
            answer.close()


def conformance() -> dict[str, list[dict]]:
    """The cases of each row of TABLE."""
    found = defaultdict(list)
    spelling = MODELS["H2U"].spelling
    for path in sorted((ROOT / "tests" / "conformance").glob("*.json")):
        for case in load_cases(path):
            name = case["mnemonic"].partition(" ")[0]
            if case["models"][0] in ("EC10", "EC20"):
                found[name].append(case)
                continue
            meant = spelling.get(name) or spelling.get(f"D{name}") or name
            for key in meant.keys if isinstance(meant, By) else (meant,):
                found[key].append(case)
    return found


def original(module: str, mnemonics: list[str]) -> Mutant:
    """The module as it stands, but installed like a mutant; its cases must hold."""
    return Mutant(module, 0, "", "", "", (SOURCES / f"{module}.py").read_text(encoding="utf-8"), tuple(mnemonics))


# -- telling ------------------------------------------------------------------------------------------------------


def table(judged: dict[str, list[Mutant]]) -> list[str]:
    """The shares, a line a module. An equivalent mutant cannot be noticed and does not count for the share."""
    lines = ["| module | mutants | killed | equivalent | survivors | share |", "|---|---:|---:|---:|---:|---:|"]
    total = Counter()
    for module, group in [*judged.items(), ("all", [])]:
        row = Counter(_state(mutant) for mutant in group) if group else total
        total += row if group else Counter()
        told = row["killed"] + row["survivor"]
        share = f"{100 * row['killed'] / told:.1f} %" if told else "-"
        lines.append(f"| {module} | {row.total()} | {row['killed']} | {row['equivalent']} | {row['survivor']} | {share} |")
    return lines


def _state(mutant: Mutant) -> str:
    if mutant.verdict:
        return "killed"
    return "equivalent" if reason(mutant) else "survivor"


def reason(mutant: Mutant) -> str:
    """Why no program can tell a mutant from the original, "" when one may."""
    return next((why for pattern, why in EQUIVALENT.items() if re.fullmatch(pattern, mutant.name)), "")


def survivors(judged: dict[str, list[Mutant]]) -> list[str]:
    """Each survivor with its place, equivalent ones with the reason."""
    left = [mutant for group in judged.values() for mutant in group if not mutant.verdict]
    lines = ["## Survivors", ""]
    lines += [f"- {_place(mutant)}" for mutant in left if not reason(mutant)] or ["None."]
    lines += ["", "## Equivalent to the original", ""]
    lines += [f"- {_place(mutant)}: {reason(mutant)}" for mutant in left if reason(mutant)] or ["None."]
    return lines


def _place(mutant: Mutant) -> str:
    change = f"becomes `{mutant.new}`" if mutant.new else "left out"
    return f"`{mutant.module}.py` line {mutant.line}, {mutant.where or 'module'}: `{mutant.old}` {change}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    modules = sorted(path.stem for path in SOURCES.glob("*.py") if path.stem not in NO_CHAPTER)
    parser.add_argument("modules", nargs="*", metavar="module", help=f"some of {', '.join(modules)}; all when none is named")
    parser.add_argument("--write", action="store_true", help="put the table of all modules into docs/mutation.md")
    parser.add_argument("--names", action="store_true", help="print the survivors by the names that EQUIVALENT knows")
    given = parser.parse_args()
    if unknown := set(given.modules) - set(modules):
        parser.error(f"there is no instruction module {', '.join(sorted(unknown))}")
    if given.write and given.modules:
        parser.error("the page is of all modules")
    cases = conformance()
    chosen = {module: mutants(module) for module in given.modules or modules}
    plain = [original(module, sorted({name for mutant in group for name in mutant.mnemonics})) for module, group in chosen.items()]
    judge(plain, cases)
    if broken := [f"{mutant.module}: {mutant.verdict}" for mutant in plain if mutant.verdict]:
        print("the cases do not hold without a change:", *broken, sep="\n  ")
        return 1
    judge([mutant for group in chosen.values() for mutant in group], cases)
    judged = {module: [m for m in group if m.verdict != "no import"] for module, group in chosen.items()}
    lines = [*table(judged), "", *survivors(judged)]
    print("\n".join(lines))
    if given.names:
        print(*(m.name for group in judged.values() for m in group if _state(m) == "survivor"), sep="\n")
    known = [mutant.name for group in judged.values() for mutant in group if not mutant.verdict]
    stale = [] if given.modules else [pattern for pattern in EQUIVALENT if not any(re.fullmatch(pattern, name) for name in known)]
    if stale:
        print("\nin EQUIVALENT, but no survivors:", *stale, sep="\n  ")
    if given.write:
        PAGE.write_text("\n".join([*HEAD, "", *lines, ""]), encoding="utf-8")
    return 1 if stale else 0


HEAD = """# Do the cases notice a wrong instruction?

`python bench/mutants.py --write` spoils each instruction module in one place at a time (operators and comparisons exchanged,
constants off by one, conditions turned round, statements, flags, ranges and columns taken away) and runs the conformance
cases of the mnemonics that can feel it on the compiled engine. The share is of the mutants that can be told from the original.
At least 90 % of each module must be noticed. Step counts, areas, types and sections are held against the manual by
`tests/instructions/test_table.py`.
""".splitlines()


if __name__ == "__main__":
    raise SystemExit(main())
