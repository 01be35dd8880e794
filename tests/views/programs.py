"""Random programs that the assembler accepts, built from the grammar of rungs and charts: for the ways there and back.

They are drawn from a seed in one go: Hypothesis could make a failing one smaller if it chose each word, but would take
twenty times as long for each program.
"""

from hypothesis import strategies as st

BITS = ["X0", "X7", "X10", "Y1", "M0", "M12", "S20", "SM1", "T0", "C3", "Start", "Late"]
VARIABLES = "VAR_GLOBAL\n  Start AT X1 // the green one\n  Late AT T5\n  Count AT D10\n  Motor AT Y0 // main drive\nEND_VAR\n"
COMPARED = ["D0", "Count", "K2M0", "D5Z1", "12", "-7", "16#1F"]
OUTPUTS = [
    "OUT Y1", "OUT Motor", "SET M3", "RST M3", "RST C3", "TON T7 10", "TON Late Count", "CTU C3 5", "MOV 3 D20", "MOV Count D5Z1",
    "ADD D0 Count D21", "INC D7", "DMOV 100000 D30", "ZRST M20 4", "NOP",
]  # fmt: skip
REMARKS = ["", "", "", "", "why", "see // below", "(* not a block", "Überlauf 液位"]
TITLES = ["", "", "", "Title", "Two\nlines", "/* odd", "\nlate"]


class Text:
    """Lines of a program under construction."""

    def __init__(self, chance):
        self.chance, self.lines = chance, []
        self.pick, self.many = chance.choice, chance.randint

    def odds(self, n):
        """True once in about n times."""
        return self.many(1, n) == n

    def add(self, code, titled=False):
        title = self.pick(TITLES) if titled or self.odds(12) else ""
        if title:
            self.lines += ["", *(f"// {line}".rstrip() for line in title.split("\n"))]
        remark = self.pick(REMARKS) if self.odds(3) else ""
        self.lines.append(f"{code}  // {remark}" if remark else code)

    # -- contacts -----------------------------------------------------------------------------------------------

    def contact(self, join, titled=False):
        if self.odds(4):
            sign = self.pick(["=", ">", "<=", "<>"])
            self.add(f"{join}{sign} {self.pick(COMPARED[:4])} {self.pick(COMPARED)}", titled)
        else:
            closed = {"LD": "LDI", "AND": "ANI", "OR": "ORI"}[join]
            self.add(f"{self.pick([join, join, closed])} {self.pick(BITS)}", titled)

    def block(self, depth, titled=False):
        """Contacts from a load on."""
        self.contact("LD", titled)
        for _ in range(self.many(0, 3)):
            way = self.pick(["AND", "AND", "OR", "gate", "ANB", "ORB"])
            if way == "gate":
                self.add(self.pick(["EU", "ED", "INV"]))
            elif way in ("AND", "OR"):
                self.contact(way)
            elif depth:
                self.block(depth - 1)
                self.add(way)

    # -- outputs ------------------------------------------------------------------------------------------------

    def tail(self, forks, last=True):
        """What hangs behind a flow: outputs, cascades, branches. A branch that is not the last may be anything, also nothing."""
        used = False
        for _ in range(self.many(0, 3)):
            way = self.pick(["OUT", "OUT", "AND", "gate", "ANB"])
            if way == "OUT":
                self.add(self.pick(OUTPUTS))
                used = True
            elif way == "ANB" and not used:
                self.block(1)
                self.add("ANB")
            elif way == "AND":
                self.contact("AND")
                used = False
            elif way == "gate":
                self.add(self.pick(["EU", "ED", "INV"]))
                used = False
        if forks and self.odds(3):
            self.fork(forks - 1)
        elif last and not used:
            self.add(self.pick(OUTPUTS))

    def fork(self, forks):
        self.add("MPS")
        self.tail(forks, last=False)
        for _ in range(self.many(0, 2)):
            self.add("MRD")
            self.tail(forks, last=False)
        self.add("MPP")
        self.tail(forks)

    def rung(self, on_bus=False):
        if on_bus:
            self.add(self.pick(OUTPUTS[:-1]), titled=True)
            for _ in range(self.many(0, 2)):
                self.add(self.pick(OUTPUTS[:-1]))
        else:
            self.block(2, titled=True)
            self.tail(2)

    def rungs(self, least=0, most=2):
        for _ in range(self.many(least, most)):
            self.rung()


def random_ladder(chance):
    """A main program of rungs, some under master control, in a loop or jumped over, and a subroutine."""
    text = Text(chance)
    text.rungs(1, 3)
    for kind in chance.sample(["MC", "FOR", "CJ"], chance.randint(0, 2)):
        text.block(1, titled=True)
        text.add({"MC": "MC 0", "FOR": "FOR 3", "CJ": "CJ 5"}[kind])
        if kind == "MC" and text.odds(2):
            text.rung(on_bus=True)
        text.rungs(0, 2)
        text.add({"MC": "MCR 0", "FOR": "NEXT", "CJ": "LBL 5"}[kind], titled=True)
    text.rungs(0, 1)
    main, text.lines = text.lines, []
    if not text.odds(3):
        return VARIABLES + "PROGRAM MAIN\n" + "\n".join(main) + "\nEND_PROGRAM\n"
    text.rungs(0, 2)
    body = "\n".join(["LD SM0", "ADD #A Count #B // locals", *text.lines])
    call = "\nLD SM0\nCALL SBR_1 3 D40\n"
    routine = f"SUBROUTINE SBR_1\nVAR_INPUT A : INT // first\nVAR_OUTPUT B : INT\nVAR_TEMP C : BOOL\n{body}\nEND_SUBROUTINE\n"
    timed = "INTERRUPT INT_1 EVENT 26\nLD SM0\nINC Count\nEND_INTERRUPT\n"
    return VARIABLES + "PROGRAM MAIN\n" + "\n".join(main) + call + "END_PROGRAM\n" + routine + timed


# -- charts -----------------------------------------------------------------------------------------------------


class Steps:
    """A flow under construction: nested sequences, selections and parallel branches, then written out."""

    def __init__(self, chance, initial, first):
        self.text = Text(chance)
        self.many, self.initial, self.next = chance.randint, initial, first

    def fresh(self):
        self.next += 1
        return self.next - 1

    def sequence(self, depth):
        """Steps with branches between them; it begins and ends with a step."""
        found = [("step", self.fresh())]
        for _ in range(self.many(0, 2)):
            kind = self.text.pick(["step", "step", "select", "parallel"]) if depth else "step"
            if kind == "step":
                found.append(("step", self.fresh()))
                continue
            least = 1 if kind == "select" else 2
            ways = [self.sequence(depth - 1) for _ in range(self.many(least, 3))]
            if kind == "select":
                way_out = self.text.pick(["skip", "jump", "none"]) if len(ways) == 1 else "none"
                found.append(("select", ways, way_out))
            else:
                found.append(("parallel", ways))
            found.append(("step", self.fresh()))
        return found

    def write(self, sequence, after):
        """Write a sequence; `after` is the lines that lead on from its last step."""
        for place, part in enumerate(sequence):
            if part[0] == "step":
                self.step(part[1], self.onward(sequence, place, after))
            elif part[0] == "select":
                following = sequence[place + 1][1]
                for way in part[1]:
                    leave = [f"OUT S{self.initial}"] if self.text.odds(4) and len(part[1]) > 1 else [f"SET S{following}"]
                    self.write(way, [leave])
            else:
                self.parallel(part[1], sequence[place + 1][1])

    def onward(self, sequence, place, after):
        """The transitions of the step at a place of its sequence, each as its targets."""
        if place + 1 == len(sequence):
            return after
        following = sequence[place + 1]
        if following[0] == "step":
            return [[f"SET S{following[1]}"]]
        firsts = [way[0][1] for way in following[1]]
        if following[0] == "parallel":
            return [[f"SET S{first}" for first in firsts]]
        behind = sequence[place + 2][1]
        other = {"skip": [[f"OUT S{behind}"]], "jump": [[f"OUT S{self.initial}"]], "none": []}[following[2]]
        return [[f"SET S{first}"] for first in firsts] + other

    def parallel(self, ways, following):
        for way in ways:
            self.write(way, [])
        self.join([way[-1][1] for way in ways], following)

    def join(self, lasts, following):
        for number in lasts:
            self.text.add(f"STL S{number}")
        self.condition()
        self.text.add(f"SET S{following}")

    def step(self, number, transitions):
        self.text.add(f"STL S{number}", titled=True)
        empty = not transitions  # a step that is only joined must do something: two STL in a row are a join
        if empty or self.text.odds(2):
            self.text.rung(on_bus=True)
        self.text.rungs(0, 1)
        for targets in transitions:
            self.condition()
            for target in targets:
                self.text.add(target)
        if self.text.odds(8):
            self.condition()
            self.text.add(f"RST S{number}")

    def condition(self):
        self.text.block(1 if self.text.odds(3) else 0)


def random_chart(chance):
    """A main program with one or two flows between ladder blocks."""
    lines, first = ["LD SM1", "SET S0"], 20
    for initial in range(chance.randint(1, 2)):
        steps = Steps(chance, initial, first)
        sequence = [("step", initial), *steps.sequence(2)]
        steps.write(sequence, [[f"OUT S{initial}"]])
        lines += [*steps.text.lines, "RET"]
        first = steps.next
        between = Text(chance)
        between.rungs(0, 1)
        lines += between.lines
    return VARIABLES + "PROGRAM MAIN\n" + "\n".join(lines) + "\nEND_PROGRAM\n"


def ladders():
    """Random ladders for Hypothesis."""
    return st.randoms(use_true_random=True).map(random_ladder)


def charts():
    """Random charts for Hypothesis."""
    return st.randoms(use_true_random=True).map(random_chart)
