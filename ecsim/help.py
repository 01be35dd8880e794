"""Help on instructions: what TABLE, the models and one example tell, as text, Markdown and HTML."""

import html
import json
import sys
from collections.abc import Iterable
from dataclasses import dataclass, replace
from difflib import get_close_matches
from functools import cache, cached_property
from pathlib import Path
from textwrap import wrap
from types import FunctionType
from typing import Any

from . import errors
from .devices import Device
from .errors import OPERAND, RANGE, EcsimError
from .hardware.faults import MEANINGS
from .instructions import TABLE, Definition
from .instructions.signature import OperandSpec
from .models import MODELS, Model, get_model

OWN = {name: row for name, row in TABLE.items() if not name.startswith("FX:")}  # the instructions of EC
EXAMPLES = Path(__file__).with_name("help_examples.json")
WIDTH = 100

JOINS = {"LD": "a contact that begins a block", "AND": "a contact in series", "OR": "a contact in parallel"}
FORMS = {
    "value": "executed in every scan in which the flow is ON",
    "command": "executed in every scan in which the flow is ON",
    "always": "executed in every scan, with the flow ON or OFF",
    "emitted": "works on the flow of its rung",
}
BUS = "stands on the left bus, without a contact before it"
USES = {(True, False): "read", (False, True): "written", (True, True): "read and written"}
_ERROR_NAMES = {name for name, code in vars(errors).items() if isinstance(code, int)}


# -- what is told ---------------------------------------------------------------------------------------------------


def fault_codes(definition: Definition) -> dict[int, str]:
    """The execution errors that an instruction can end with -> where they come from, as far as its row and its function tell."""
    codes = dict.fromkeys(definition.faults, "")
    codes |= dict.fromkeys(_raised(definition.function, set()), "")
    if any(spec.range and spec.plain and spec.read and spec.areas != {"const"} for spec in definition.operands):
        codes.setdefault(OPERAND, "a value outside its range")
    if any(spec.span in {other.name for other in definition.operands if other.areas != {"const"}} for spec in definition.operands):
        codes.setdefault(OPERAND, "a number of elements below zero")
    if any(spec.span for spec in definition.operands):
        codes.setdefault(RANGE, "elements beyond the last device")
    if any(spec.indexed for spec in definition.operands):
        codes.setdefault(RANGE, "an index that leads beyond the devices")
    return dict(sorted(codes.items()))


def _raised(function: FunctionType, seen: set) -> set[int]:
    """The error codes that a function, and what it calls of the chapter's own functions, speaks of."""
    seen.add(function)
    found: set[int] = set()
    for name in function.__code__.co_names:
        what = function.__globals__.get(name)
        if name in _ERROR_NAMES and isinstance(what, int):
            found.add(what)
        elif isinstance(what, FunctionType) and what not in seen and ".instructions." in what.__module__:
            found |= _raised(what, seen)
    return found


def section_of(definition: Definition) -> str:
    """The section of the manual that holds an instruction: "6.3" for one of 6.3.1."""
    return ".".join(definition.section.split(".")[:2])


def section_title(section: str) -> str:
    """What a section is about, from the first line of its module."""
    heads = {
        (sys.modules[row.function.__module__].__doc__ or "").strip().split("\n")[0] for row in OWN.values() if section_of(row) == section
    }
    head = next((head for head in sorted(heads) if head.startswith(f"{section}:")), f"{section}: instructions")
    return head.removeprefix(f"{section}:").strip().split(". ")[0].split(": ")[0].rstrip(".")


def sections() -> dict[str, list[str]]:
    """Section -> its mnemonics, both in the manual's order."""

    def order(text: str) -> list[int]:
        return [int(part) for part in text.split(".")]

    found: dict[str, list[str]] = {}
    for row in sorted(OWN.values(), key=lambda row: order(row.section)):
        found.setdefault(section_of(row), []).append(row.mnemonic)
    return found


@cache
def examples() -> dict[str, dict[str, Any]]:
    """One conformance case a mnemonic."""
    return json.loads(EXAMPLES.read_text(encoding="utf-8"))


# -- the parts of a page, in three writings ---------------------------------------------------------------------------


@dataclass(frozen=True)
class Heading:
    """A line above what follows; `level` 1 stands for the instruction."""

    words: str
    level: int = 2

    def text(self) -> str:
        return self.words if self.level == 1 else f"{self.words}:"

    def markdown(self) -> str:
        return f"{'#' * self.level} {self.words}"

    def html(self) -> str:
        return f"<h{self.level + 2}>{html.escape(self.words)}</h{self.level + 2}>"


@dataclass(frozen=True)
class Words:
    """A paragraph."""

    words: str

    def text(self) -> str:
        return "\n".join(wrap(self.words, WIDTH))

    def markdown(self) -> str:
        return self.words

    def html(self) -> str:
        return f"<p>{html.escape(self.words)}</p>"


@dataclass(frozen=True)
class Items:
    """Short lines one below the other."""

    lines: tuple[str, ...]

    def text(self) -> str:
        return "\n".join("\n".join(wrap(line, WIDTH, initial_indent="  ", subsequent_indent="    ")) for line in self.lines)

    def markdown(self) -> str:
        return "\n".join(f"- {line}" for line in self.lines)

    def html(self) -> str:
        return f"<ul>{''.join(f'<li>{html.escape(line)}</li>' for line in self.lines)}</ul>"


@dataclass(frozen=True)
class Rows:
    """A table with a line of titles."""

    titles: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]

    def text(self) -> str:
        rows = [self.titles, *self.rows]
        widths = [max(len(row[place]) for row in rows) for place in range(len(self.titles))]
        return "\n".join(("  " + "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True))).rstrip() for row in rows)

    def markdown(self) -> str:
        rows = [self.titles, ("---",) * len(self.titles), *self.rows]
        return "\n".join(f"| {' | '.join(row)} |" for row in rows)

    def html(self) -> str:
        def line(tag: str, cells: Iterable[str]) -> str:
            return "".join(["<tr>", *(f'<{tag} style="text-align:left">{html.escape(cell)}</{tag}>' for cell in cells), "</tr>"])

        return f"<table>{line('th', self.titles)}{''.join(line('td', row) for row in self.rows)}</table>"


@dataclass(frozen=True)
class Code:
    """A program."""

    program: str

    def text(self) -> str:
        return "\n".join(f"    {line}".rstrip() for line in self.program.split("\n"))

    def markdown(self) -> str:
        return f"```text\n{self.program}\n```"

    def html(self) -> str:
        return f"<pre>{html.escape(self.program)}</pre>"


Part = Heading | Words | Items | Rows | Code


class Shown:
    """A page made of parts: `str()` is its text, a notebook shows its HTML."""

    parts: tuple[Part, ...]

    def __str__(self) -> str:
        return "\n\n".join(part.text() for part in self.parts).replace(":\n\n", ":\n")

    def _repr_markdown_(self) -> str:
        return "\n\n".join(part.markdown() for part in self.parts) + "\n"

    def _repr_html_(self) -> str:
        return f"<div>{''.join(part.html() for part in self.parts)}</div>"


# -- one instruction ----------------------------------------------------------------------------------------------------


@dataclass(frozen=True, repr=False)
class Page(Shown):
    """All about one instruction."""

    definition: Definition

    def __repr__(self) -> str:
        return f"<help on {self.definition.mnemonic}: {self.definition.title}>"

    @property
    def example(self) -> dict[str, Any] | None:
        """The conformance case that serves as example, None where there is none."""
        return examples().get(self.definition.mnemonic)

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        row = self.definition
        first, *more = (row.function.__doc__ or "").strip().split("\n\n")
        found: list[Part] = [Heading(row.mnemonic, 1), Words(" ".join(first.split()))]
        found += [Words(" ".join(paragraph.split())) for paragraph in more]
        found += [Code(" ".join([row.mnemonic, *(spec.name for spec in row.operands)])), Items(self._facts())]
        if row.operands:
            found += [Heading("Operands"), Rows(("operand", "use", "type", "index", "devices", "remark"), self._operands())]
        if row.flags:
            found += [Heading("Flags"), Items(self._flags())]
        codes = fault_codes(row)
        if codes:
            found += [Heading("Errors"), Items(tuple(error_words(MODELS[row.models[0]], code, where) for code, where in codes.items()))]
        return (*found, *self._example())

    def _facts(self) -> tuple[str, ...]:
        row = self.definition
        form = JOINS[row.join] if row.join else BUS if row.bus else FORMS[row.form]
        steps = "3 and one for each operand" if row.steps is None else str(row.steps)
        if row.transition_steps:
            steps += f"; {row.transition_steps} for a step device inside a step"
        facts = [
            f"manual {row.section}, {section_title(section_of(row))}",
            f"models: {', '.join(row.models)}",
            f"steps: {steps}",
            form,
        ]
        if row.after:
            facts.append("executed once more when the flow has gone")
        if row.claims:
            facts.append("what it works on is its own until the flow has gone")
        if row.occupies:
            facts.append("needs inputs for itself (manual 8.5)")
        if row.cleared:
            facts.append("cleared when its master control is OFF and when its step has been left")
        if row.released:
            facts.append("without flow when its master control is OFF and when its step has been left")
        family = [other.mnemonic for other in OWN.values() if other.function is row.function and other is not row]
        return (*facts, *([f"relatives with the same meaning: {', '.join(family)}"] if family else []))

    def _operands(self) -> tuple[tuple[str, ...], ...]:
        return tuple(
            (
                spec.name,
                USES[spec.read, spec.written],
                spec.type.name,
                "yes" if spec.indexed else "no",
                device_words(spec.order),
                remark(spec),
            )
            for spec in self.definition.operands
        )

    def _flags(self) -> tuple[str, ...]:
        model = MODELS[self.definition.models[0]]
        flags = ("{} ({}{})".format(flag, *model.flag(flag)) for flag in self.definition.flags)
        return (f"{', '.join(flags)}: set or cleared by each execution",)

    def _example(self) -> list[Part]:
        return example_parts(self.example) if self.example else []


def example_parts(case: dict[str, Any]) -> list[Part]:
    """A conformance case as an example."""
    return [Heading("Example"), Words(_sentence(case["note"])), Code(case["il"].strip("\n")), Items(tuple(_story(case)))]


def error_words(model: Model, code: int, where: str) -> str:
    """An execution error with the number that the model has for it, and where it comes from."""
    return f"{model.fault_code(code)}: {MEANINGS.get(code, 'an error')}" + (f" ({where})" if where else "")


def device_words(areas: Iterable[str]) -> str:
    """Areas as a page names them."""
    names = {"const": "constant", "routine": "name of a subroutine"}
    return " ".join(names.get(area, area) for area in areas)


def remark(spec: OperandSpec, pointer: str = "") -> str:
    """What is particular about an operand: its range, with the letter of a pointer, and its span."""
    remarks = []
    if spec.range:
        area = pointer if "const" in spec.areas else spec.order[0]
        remarks.append(f"{area}{spec.range[0]} to {area}{spec.range[1]}")
    if spec.whole:
        remarks.append(f"a Kn string as K{spec.type.bits // 4}")
    if spec.kind == "TEXT":
        remarks.append(f"at most {spec.span}")
    elif spec.span:
        remarks.append("the first of several" if str(spec.span).startswith("{") else f"the first of {spec.span}")
    return ", ".join(remarks)


def _upper(text: str) -> str:
    return text[:1].upper() + text[1:]


def _sentence(text: str) -> str:
    return _upper(text).rstrip(".") + "."


_ACTIONS = {"run": "STOP to RUN", "stop": "RUN to STOP", "power_cycle": "power off and on"}


def _story(case: dict[str, Any]) -> Iterable[str]:
    """The steps of a case, a line each: what is set, how long it runs, what comes out."""
    model = MODELS[case["models"][0]]
    error = f"{model.special_words}{model.registers['faults']}"
    if case["models"] != [other.name for other in MODELS.values() if other.family == model.family]:
        yield f"on {' and '.join(case['models'])}"
    if case.get("scan_ms", 10) != 10:
        yield f"a scan takes {case['scan_ms']} ms"
    if "io" in case:
        yield f"the base unit and its modules: {', '.join(each if isinstance(each, str) else f'{each[0]} and {each[1]} points' for each in case['io'])}"
    for what in ("system_block", "data_block"):
        if what in case:
            yield f"{what.replace('_', ' ')}: {_settings(case[what])}"
    for step in case["steps"]:
        before = [_ACTIONS.get(step["action"], step["action"].replace("_", " "))] if "action" in step else []
        before += [_settings(step["set"])] if step.get("set") else []
        before += [f"{count} pulse{'s' if count != 1 else ''} on {name}" for name, count in step.get("pulses", {}).items()]
        before += [_phases(**step["quadrature"])] if "quadrature" in step else []
        time = f"after {step['ms']:g} ms" if "ms" in step else _scans(step.get("scans", 0))
        after = [_settings(step["expect"])] if step.get("expect") else []
        after += [f"{name} from {limits['min']} to {limits['max']}" for name, limits in step.get("expect_range", {}).items()]
        after += [f"error {step['error']} in {error}" if step["error"] else f"no error in {error}"] if "error" in step else []
        yield f"{'; '.join([*before, time])}: {', '.join(after)}" if after else "; ".join([*before, time])


def _phases(A: str, B: str, count: int, direction: int) -> str:
    return f"{count} cycle{'s' if count != 1 else ''} on {A} and {B}, {A if direction > 0 else B} first"


def _scans(count: int) -> str:
    return "at once" if count == 0 else "after 1 scan" if count == 1 else f"after {count} scans"


def _settings(values: dict[str, Any]) -> str:
    """Devices and their values; neighbours of one value as "M0 to M9 = 1"."""
    runs: list[tuple[str, str, int, Any]] = []  # first and last name, how many, their value
    following = ""
    for name, value in values.items():
        if runs and name == following and runs[-1][3] == value:
            runs[-1] = (runs[-1][0], name, runs[-1][2] + 1, value)
        else:
            runs.append((name, name, 1, value))
        following = _next_name(name)
    words = []
    for first, last, count, value in runs:
        names = first if count == 1 else f"{first} {'and' if count == 2 else 'to'} {last}"
        words.append(f"{names} = {value:.7g}" if isinstance(value, float) else f"{names} = {value}")
    return ", ".join(words)


def _next_name(name: str) -> str:
    """The name of a device's neighbour, empty where the text names no plain device."""
    device = MODELS["EC20"].syntax.parse(name)
    return str(replace(device, number=device.number + 1)) if isinstance(device, Device) else ""


# -- all of them --------------------------------------------------------------------------------------------------------


@dataclass(frozen=True, repr=False)
class Section(Shown):
    """The instructions of one section of the manual."""

    name: str

    def __repr__(self) -> str:
        return f"<help on {self.name}: {len(sections()[self.name])} instructions>"

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        rows = tuple((name, OWN[name].title) for name in sections()[self.name])
        return Heading(f"{self.name} {_upper(section_title(self.name))}", 1), Rows(("instruction", "what it does"), rows)


class Contents(Shown):
    """All instructions by section."""

    def __repr__(self) -> str:
        return f"<help on {len(OWN)} instructions in {len(sections())} sections>"

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        found: list[Part] = [Heading("Instructions", 1)]
        for section, names in sections().items():
            found += [Heading(f"{section} {_upper(section_title(section))}", 2), Words(" ".join(names))]
        return tuple(found)


def help(name: str = "", model: str = "") -> Shown:  # noqa: A001 - the public name of the act
    """The page of an instruction ("ADD"), the list of a section ("6.3"), or of all; raises EcsimError for what there is not.

    With a `model` it speaks of that one's instructions; without one of EC's, and of an instruction that only H2U has.
    """
    from .help_spelled import find

    wanted = name.strip().upper()
    chosen = get_model(model) if model else None
    if chosen and chosen.spelling:
        found = find(wanted, chosen)
        known, every = {*chosen.spelling}, f'ecsim.help(model="{chosen.name}")'
    else:
        found = Contents() if not wanted else Page(OWN[wanted]) if wanted in OWN else Section(wanted) if wanted in sections() else None
        found = found or (None if chosen else find(wanted, MODELS["H2U"]))
        known, every = {*OWN}, "ecsim.help()"
    if found:
        return found
    close = get_close_matches(wanted[:12], sorted(known), 3, 0.6)
    hint = f"did you mean {' or '.join(close)}?" if close else f"{every} lists all"
    raise EcsimError(f"there is no instruction {name[:40]!r}; {hint}")
