"""Nothing of a program's text reaches the generated Python but resolved numbers and names of ours, and every text ends as a
program or as a ProgramError: hostile names, comments and constants, real programs broken in many ways, noise, and programs at
the limits of the machine and of CPython.
"""

import ast
import builtins
import inspect
import json
import random
import re
import sys
from pathlib import Path

import pytest

import ecsim.instructions
from ecsim.assembler import assemble
from ecsim.engines import compiled, stepping
from ecsim.errors import ProgramError
from ecsim.instructions import TABLE
from ecsim.plc import Plc

CONFORMANCE = Path(__file__).parent / "conformance"
SENTINEL = "ecsim_fuzz_sentinel"
MODELS = ("EC10", "EC20")

# -- what generated code may hold ---------------------------------------------------------------------------------

OWN_WORDS = set(
    """a_ c f f_ g p v w op_ unit_ part_ unit__parts turn_ place_ flow first turns left place error word wide number
    STACK KEPT LOOPS HALF REAL SINGLES real_of halves range int float Fault""".split()
)
OWN_ATTRIBUTES = {"append", "pop", "code", "scans"}
OWN_STRINGS = {"T", "C"}
FORBIDDEN = (
    ast.Import,
    ast.ImportFrom,
    ast.Lambda,
    ast.ClassDef,
    ast.AsyncFunctionDef,
    ast.Global,
    ast.Nonlocal,
    ast.With,
    ast.JoinedStr,
    ast.Delete,
)


def words_of_table():
    """The names that the functions of TABLE bring along, their parameters, variables and module's names."""
    words, attributes = set(), set()
    for row in TABLE.values():
        code = row.function.__code__
        variables = set(code.co_varnames) | {row.function.__name__}
        words |= variables | {f"a_{name}" for name in variables} | {f"f_{name}" for name in (*row.flags, *row.given)}
        words |= {name for name in code.co_names if hasattr(builtins, name)}
        attributes |= set(code.co_names)
        module = inspect.getmodule(row.function)
        words |= {f"{module.__name__.rpartition('.')[2]}_{name}" for name in (*vars(module), row.function.__name__)}
    return words, attributes


def stem(name):
    """A name without the numbers that our own count gives it."""
    return re.sub(r"\d+", "", name).rstrip("_")


TABLE_WORDS, TABLE_ATTRIBUTES = words_of_table()


def allowed_names():
    """All names that generated code may hold; none comes from a program."""
    plc = Plc("EC20")
    names = OWN_WORDS | TABLE_WORDS | set(plc._services) | set(plc.memory.lists)
    return {stem(name) for name in names}


NAMES = allowed_names()
ATTRIBUTES = OWN_ATTRIBUTES | TABLE_ATTRIBUTES


def foreign(source):
    """What stands in generated Python that is neither a number nor a name of ours."""
    found = [line for line in source.split("\n") if "#" in line and not re.fullmatch(r"\s*# line \d+", line)]
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Name) and stem(node.id) not in NAMES:
            found.append(node.id)
        elif isinstance(node, (ast.FunctionDef, ast.arg)) and stem(getattr(node, "name", None) or node.arg) not in NAMES:
            found.append(ast.unparse(node))
        elif isinstance(node, ast.Attribute) and node.attr not in ATTRIBUTES:
            found.append(f".{node.attr}")
        elif isinstance(node, ast.Constant) and not isinstance(node.value, (int, float, type(None))) and node.value not in OWN_STRINGS:
            found.append(repr(node.value))
        elif isinstance(node, FORBIDDEN):
            found.append(ast.unparse(node))
    return found


@pytest.fixture
def guarded(monkeypatch):
    """Every piece of Python that the engines generate is looked at; a call of the sentinel, or what an intruder does, fails the test."""
    called, active = [], [True]
    monkeypatch.setattr(builtins, SENTINEL, lambda *_: called.append(1), raising=False)

    def look(source, filename, mode):
        assert foreign(source) == [], source
        return compile(source, filename, mode)

    monkeypatch.setattr(compiled, "compile", look, raising=False)
    monkeypatch.setattr(stepping, "compile", look, raising=False)

    def hook(event, arguments):
        if active and active[0] and event in ("os.system", "subprocess.Popen", "os.exec", "os.remove", "socket.connect", "shutil.rmtree"):
            called.append(event)

    sys.addaudithook(hook)
    yield
    active[0] = False
    assert called == []


# -- material -----------------------------------------------------------------------------------------------------

INTRUDERS = [
    f"{SENTINEL}()",
    f"__import__('builtins').{SENTINEL}()",
    f"');{SENTINEL}();('",
    f'"+{SENTINEL}()+"',
    f"M0]={SENTINEL}();X[0",
    f"0 if {SENTINEL}() else 1",
    f"\\n{SENTINEL}()",
    f"{{{SENTINEL}()}}",
    f"D0\u2028{SENTINEL}()",
    f"\x0c{SENTINEL}()",
    "__builtins__", "import", "lambda", "None", "True", "class", "yield", "exec", "eval", "self", "flow", "M", "SM", "unit_0", "part_1",
    "@label_1@", "%s", "{flow}", "__flow__", "{0}", "@1@", "\\", "'", '"', '"""', "'''", "#", "`", "\0", "\x1b[2J", "\u202e", "é", "数", "𝔐0", "Ｍ０", "м0", "X٣",
]  # fmt: skip
NUMBERS = [
    "0", "-0", "+1", "00", "1e400", "-1E+400", "1E-400", "nan", "inf", "-inf", "9" * 30, "-" + "9" * 400, "16#" + "F" * 50, "2#", "16#", "8#9", "0x1F",
    "1_000", "1.5.2", ".", "-.", "1e", "٣", "²", "16#G", "3.14E+3", "1.", ".5", "--1", "2147483648", "-2147483649", "65536", "16#FFFFFFFFF", "1" * 5000,
]  # fmt: skip
DEVICES = [
    "X0", "X8", "X400", "Y377", "M0", "M1999", "M2000", "S0", "S991", "SM255", "T255", "T256", "C199", "C200", "C236", "D7999", "D8000", "SD255", "V63", "V64",
    "Z15", "Z16", "LM63", "K4M0", "K9M0", "K0M0", "K1D0", "K8X370", "D0Z0", "D0Z99", "D0V0", "K4M0Z1", "#A", "#", "##A", "X-1", "D99999999999", "K99999999999M0", "x0", "k4m0z1",
]  # fmt: skip
HEADERS = ["VAR_GLOBAL", "END_VAR", "PROGRAM MAIN", "END_PROGRAM", "SUBROUTINE", "SUBROUTINE A", "END_SUBROUTINE", "INTERRUPT A EVENT 0", "INTERRUPT", "END_INTERRUPT", "VAR_INPUT A : INT", "VAR_TEMP", "/*", "*/", "(*", "*)", "//", "\ufeff", "\r", "\r\n", "\t", "\v", "\f", "\x85", "\u2028", ";", ",", "="]  # fmt: skip
MNEMONICS = sorted(TABLE)
SOUND = "LD X0\nOUT Y0"


def real_programs():
    """Programs of the conformance cases, the short ones, as material to break."""
    texts = {case["il"] for path in sorted(CONFORMANCE.glob("*.json")) for case in json.loads(path.read_text(encoding="utf-8"))}
    return sorted(text for text in texts if len(text) < 240)


REAL_PROGRAMS = real_programs()


def broken(chance):
    """A real program with a few changes: characters, words and lines taken away, doubled, exchanged, put in."""
    text = chance.choice(REAL_PROGRAMS)
    for _ in range(chance.randint(1, 4)):
        kind, place = chance.random(), chance.randint(0, len(text))
        if kind < 0.2:
            text = text[:place] + text[place + chance.randint(1, 3) :]
        elif kind < 0.4:
            text = text[:place] + chance.choice(chance.choice((INTRUDERS, NUMBERS, DEVICES, HEADERS))) + text[place:]
        elif kind < 0.5:
            text = text[:place] + chr(chance.choice((chance.randint(0, 127), chance.randint(128, 0x2FFF), 0x1F600))) + text[place:]
        else:
            lines = text.split("\n")
            number = chance.randint(0, len(lines) - 1)
            words = lines[number].split(" ")
            if kind < 0.6:
                lines.insert(number, chance.choice(lines))
            elif kind < 0.7:
                del lines[number]
            elif kind < 0.9:
                words[chance.randint(0, len(words) - 1)] = chance.choice(chance.choice((NUMBERS, DEVICES, MNEMONICS, INTRUDERS)))
                lines[number] = " ".join(words)
            else:
                lines.insert(number, chance.choice(HEADERS))
            text = "\n".join(lines)
    return text


def named(chance):
    """A sound program whose names, comments, constants and texts are an intruder's."""
    intruder, other = chance.choice(INTRUDERS), chance.choice(INTRUDERS)
    word = re.sub(r"\W", "_", intruder)
    name = chance.choice((intruder, word, f"N{word}"))
    return chance.choice(
        (
            f"VAR_GLOBAL\n{name} AT M0 // {other}\nEND_VAR\nPROGRAM MAIN\nLD {name} // {intruder}\nOUT Y0\nEND_PROGRAM",
            f"PROGRAM MAIN\nLD X0\nCALL {name} 1 D0\nEND_PROGRAM\nSUBROUTINE {name}\nVAR_INPUT {word} : INT\nVAR_OUTPUT R : INT // {other}\nLD SM0\nMOV #{word} #R\nEND_SUBROUTINE",
            f"PROGRAM {name}\nLD X0\nOUT Y0\nEND_PROGRAM\nINTERRUPT {word} EVENT {chance.choice(('0', '26', intruder))}\nLD SM0\nINC D0\nEND_INTERRUPT",
            f"/* {intruder} */\n(* {other} *)\n// {intruder}\nLD X0 /* {other} */\nOUT Y0 // {intruder}",
            f"LD X0\nASC {intruder} D0\nMOV {other} D1",
            f"LD X0\nMOV {chance.choice(NUMBERS)} D0\nRMOV {chance.choice(NUMBERS)} D2\nDMOV {chance.choice(NUMBERS)} D4",
            f"LD {chance.choice(DEVICES)}\n{chance.choice(MNEMONICS)} {chance.choice(DEVICES)} {chance.choice(NUMBERS)} {chance.choice(DEVICES)}",
        )
    )


def noise(chance):
    """Words in no order."""
    words = [*MNEMONICS[:40], *DEVICES, *NUMBERS, *HEADERS, *INTRUDERS, "\n", "\n", "\n", "\n", "\n", " ", " "]
    return " ".join(chance.choice(words) for _ in range(chance.randint(1, 24)))


# -- 50,000 programs ----------------------------------------------------------------------------------------------


def unkind(error):
    """What a refusal lacks: a place and words in one line for every problem."""
    return [p for p in error.problems if not p.message or p.line < 0 or p.column < 0 or "\n" in str(p)] if error.problems else [error]


def outcome(text, model):
    """The program that a text spells, None when it is refused."""
    problems = []
    try:
        return assemble(text, model)
    except ProgramError as error:
        problems = unkind(error)
    assert problems == []
    return None


@pytest.mark.parametrize(("make", "count"), [(broken, 26_000), (named, 16_000), (noise, 8_000)], ids=["broken", "named", "noise"])
def test_any_text_is_a_program_or_a_program_error(make, count, guarded):
    chance = random.Random(make.__name__)
    plcs = {model: Plc(model) for model in MODELS}
    sound = looked_at = 0
    for number in range(count):
        model = MODELS[number % 2]
        program = outcome(make(chance), model)
        if program is None:
            continue
        sound += 1
        if sound % 12:
            assert foreign(compiled.Compiler(program).source()) == []
        else:  # in full: both engines, a scan each
            looked_at += 1
            plc = plcs[model]
            plc.load(program)
            for engine in ("compiled", "stepping"):
                plc.engine = engine
                plc.run()
                plc.scan()
    assert sound > count // 200  # the check has had something to look at
    assert looked_at > 0


def test_the_check_sees_a_foreign_name():
    assert foreign("def unit_0(M=M):\n    # line 1\n    M[0] = True\n") == []
    for text in (
        f"{SENTINEL}()",
        "M[0] = __import__('os')",
        "import os",
        "M.x = 1",
        "# line x",
        "M[0] = 'text'",
        "lambda: 1",
        "def stranger(): pass",
    ):
        assert foreign(text) != [], text


def test_the_guard_sees_the_sentinel(guarded):
    assert ecsim.instructions.TABLE is TABLE
    with pytest.raises(AssertionError):
        compiled.compile(f"{SENTINEL}()", "x", "exec")


# -- the limits of the machine, and of CPython --------------------------------------------------------------------


@pytest.fixture
def run():
    """One scan of a program on both engines; the PLCs after it must agree."""

    def scan(text, model="EC20", **devices):
        plcs = []
        for engine in ("compiled", "stepping"):
            plc = Plc(model, input_filter_ms=0)
            plc.load(text)
            plc.engine = engine
            plc.run()
            plc.set(devices)
            plc.scan()
            plcs.append(plc)
        first, second = (plc.memory.lists for plc in plcs)
        assert {name for name in first if first[name] != second[name]} <= {"E"}
        return plcs[0]

    return scan


def test_twelve_thousand_steps_are_a_program(run):
    plc = run("\n".join(f"LD X{n % 256:o}\nOUT M{n % 2000}" for n in range(6000)), X0=1)
    assert plc.program.steps == 12_000
    assert plc["M1888"] == 1  # by the rung 5,888, which is 23 times 256 and so has X0
    assert plc["M1889"] == 0


def test_one_step_more_is_refused():
    with pytest.raises(ProgramError, match="the program has 12001 steps; EC20 holds 12000"):
        assemble("\n".join(["LD X0\nOUT M0"] * 5999 + ["LD X0\nAND X1\nOUT M0"]), "EC20")


@pytest.mark.parametrize("on", [0, 555, 999])
def test_a_thousand_parallel_contacts(run, on):
    text = "\n".join(["LD M0", *(f"OR M{n}" for n in range(1, 1000)), "OUT Y0"])
    assert run(text, **{f"M{on}": 1})["Y0"] == 1
    assert run(text, M1000=1)["Y0"] == 0


def test_a_thousand_contacts_in_series(run):
    text = "\n".join(["LDI M0", *(f"ANI M{n}" for n in range(1, 1000)), "OUT Y0"])
    assert run(text)["Y0"] == 1
    assert run(text, M777=1)["Y0"] == 0


def test_series_and_parallel_contacts_by_turns(run):
    # ((((M0 and M1) or M2) and M3) or M4) ...: an odd one that is OFF stops all that came before, an even one that is ON mends it.
    count = 3001
    text = "\n".join(["LD M0", *(f"{'AND' if n % 2 else 'OR'} M{n % 1999}" for n in range(1, count)), "OUT Y0"])
    on = {n for n in range(1999) if n % 3}
    state = 0 in on
    for n in range(1, count):
        state = (state and n % 1999 in on) if n % 2 else (state or n % 1999 in on)
    assert run(text, **{f"M{n}": 1 for n in on})["Y0"] == state


@pytest.mark.parametrize("join", ["ANB", "ORB"])
def test_hundreds_of_blocks_joined_at_the_end(run, join):
    count = 700
    text = "\n".join([f"LD M{n}\nOR M{n + 1000}" for n in range(count)] + [join] * (count - 1) + ["OUT Y0"])
    all_on = {f"M{n}": 1 for n in range(count)}
    assert run(text, **all_on)["Y0"] == 1
    assert run(text, **(all_on | {"M350": 0}))["Y0"] == (join == "ORB")
    assert run(text, M1350=1)["Y0"] == (join == "ORB")


def test_blocks_within_blocks(run):
    count = 700  # LD (LD (LD ... ANB or ORB) ANB or ORB)
    text = "\n".join([f"LD M{n}" for n in range(count)] + [("ANB", "ORB")[n % 2] for n in range(count - 1)] + ["OUT Y0"])
    state = True
    for n in range(count - 1):
        state = state if n % 2 == 0 else True
    assert run(text, **{f"M{n}": 1 for n in range(count)})["Y0"] == state


@pytest.mark.parametrize(("word", "count", "expected"), [("INV", 2000, 1), ("INV", 2001, 0), ("EU", 1000, 1), ("ED", 1000, 0)])
def test_thousands_of_turns_and_edges_in_a_row(run, word, count, expected):
    assert run("\n".join(["LD X0", *[word] * count, "OUT Y0"]), X0=1)["Y0"] == expected


def test_the_flow_stack_is_eight_deep(run):
    def nested(depth):
        return "\n".join(["LD X0"] + [line for n in range(depth) for line in ("MPS", f"AND M{n}")] + ["OUT Y0"] + ["MPP\nOUT Y1"] * depth)

    plc = run(nested(8), X0=1, **{f"M{n}": 1 for n in range(8)})
    assert (plc["Y0"], plc["Y1"]) == (1, 1)
    with pytest.raises(ProgramError, match="more than 8 MPS without MPP"):
        assemble(nested(9), "EC20")


def test_the_deepest_structures_in_one_another(run):
    opened = [f"LD SM0\nMC {n}" for n in range(7)] + ["LD SM0\nFOR 2"] * 8
    inside = "LD SM0\nINC D0\nLD SM0\nMPS\nMOV D0Z0 D1\nMPP\nCALL S"
    closed = ["NEXT"] * 8 + [f"MCR {n}" for n in reversed(range(7))]
    body = "\n".join([*opened, inside, *closed])
    jump = "\nLD X7\nCJ 1\nLBL 1"
    for main in (body, body + jump):  # units with jumps are compiled in another way
        text = f"PROGRAM MAIN\n{main}\nEND_PROGRAM\nSUBROUTINE S\n{body.replace('CALL S', 'INC D2').replace('FOR 2', 'FOR 1').replace('D0', 'D3')}\nEND_SUBROUTINE"
        plc = run(text)
        assert (plc["D0"], plc["D3"]) == (256, 256)


def test_a_chart_of_all_steps(run):
    steps = range(20, 992)
    text = "\n".join(
        ["LD SM1", "SET S0", "STL S0", "LD SM0", "SET S20"]
        + [f"STL S{n}\nOUT M{n}\nLD SM0\n{'SET' if n < 991 else 'OUT'} S{n + 1 if n < 991 else 0}" for n in steps]
        + ["RET"]
    )
    assert run(text)["S0"] == 1  # the flow has gone through all steps in its first scan


def test_a_hundred_outputs_of_one_rung(run):
    text = "\n".join(["LD X0", *(f"AND M{n}\nOUT M{1000 + n}" for n in range(900))])
    assert run(text, X0=1, **{f"M{n}": 1 for n in range(900)})["M1899"] == 1


@pytest.mark.parametrize(
    "text",
    [
        "LD X0\nOUT Y0 // " + "x" * 1_000_000,
        "LD " + "X" * 1_000_000,
        "LD X0 " + "M0 " * 100_000,
        "(" * 100_000,
        "(*" * 50_000,
        "/* */ " * 5_000,
        "\n" * 200_000,
        "// a\n" * 50_000,
        "PROGRAM MAIN\n" * 2_000,
        "SUBROUTINE A\n" * 2_000,
        "VAR_GLOBAL\n" + "\n".join(f"N{n} AT M0" for n in range(3_000)) + "\nEND_VAR",
        "LD M0\n" * 5_000,
        "MPS\n" * 5_000,
        "LD X0\nMC 0\n" * 2_000,
        "LD X0\nFOR 2\n" * 2_000,
        "STL S0\n" * 5_000,
        "ANB\n" * 5_000,
        "LBL 1\n" * 2_000,
        "LD X0\nCJ 5\n" * 2_000,
        "VAR_TEMP A : INT\n" * 3_000,
        "\n".join(f"SUBROUTINE S{n}\nLD X0\nCALL S{n + 1}\nEND_SUBROUTINE" for n in range(2_000)),
        "\n".join(f"SUBROUTINE S{n}\nLD X0\nCALL S{n + 1}\nEND_SUBROUTINE" for n in range(1_500))
        + "\nSUBROUTINE S1500\nEND_SUBROUTINE\nPROGRAM MAIN\nEND_PROGRAM",
        "\0" * 10_000,
        "LD X0\nMOV 16#" + "F" * 100_000 + " D0",
        "LD X0\nMOV " + "9" * 100_000 + " D0",
    ],
    ids=lambda text: f"{text[:12]!r} {len(text)}",
)
def test_texts_of_any_size_end_in_time(text):
    outcome(text, "EC20")


def test_a_long_file_of_nonsense_is_told_line_by_line():
    with pytest.raises(ProgramError) as refused:
        assemble("\n".join(f"NONSENSE{n} X0" for n in range(2_000)), "EC20")
    assert len(refused.value.problems) >= 2_000
