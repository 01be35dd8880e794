"""Help on the instructions of a family that spells TABLE's rows in its own way: H1U and H2U."""

from dataclasses import dataclass, replace
from functools import cache, cached_property
from typing import Any

from .assembler.operands import Resolver
from .help import (
    BUS,
    FORMS,
    JOINS,
    USES,
    Code,
    Heading,
    Items,
    Part,
    Rows,
    Shown,
    Words,
    device_words,
    error_words,
    example_parts,
    examples,
    fault_codes,
    remark,
)
from .instructions import TABLE, Definition
from .instructions.spelling import pulse_forms_of, section_of, told
from .models import MODELS, By, Model
from .models.fx_spelling import ALL_KNOWN, LOOKED_UP, REFERENCE, STATED, plain

_GROUPS = {"3.8": "4.1", "4.1.1": "4.1"}


def names_of(model: Model) -> dict[str, list[str]]:
    """The name by which the manual lists an instruction -> all that the model calls its forms, without the pulse suffix."""
    return _names(model.name)


@cache
def _names(model: str) -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for spelled in MODELS[model].spelling:
        found.setdefault(plain(spelled), []).append(spelled)
    return found


@cache
def _forms(model: str) -> dict[str, list[str]]:
    """The same with the forms that have the pulse suffix."""
    pulses, suffix = pulse_forms_of(MODELS[model]), MODELS[model].pulse_suffix
    return {
        name: [form for spelled in own for form in (spelled, spelled + suffix) if form == spelled or form in pulses]
        for name, own in _names(model).items()
    }


@cache
def _listed(model: str) -> dict[str, str]:
    return {form: name for name, forms in _forms(model).items() for form in (*forms, name)}


def named(word: str, model: Model) -> str:
    """The name by which the manual lists what a word of a program spells, in any form, or as a pointer: P of P10; "" for other words."""
    known = _listed(model.name)
    return known.get(word) or known.get(word.rstrip("0123456789"), "")


def groups(model: Model) -> dict[str, list[str]]:
    """The instructions in tens of their function numbers, the basic ones first: "4.1", "FNC 00", "FNC 10" ..."""
    found: dict[str, list[str]] = {}
    for name, forms in names_of(model).items():
        section = section_of(model, forms[0], _rows(model, forms[0])[0])
        group = f"{section[:-1]}0" if section.startswith("FNC") else _GROUPS.get(section, section)
        found.setdefault(group, []).append(name)
    return dict(sorted(found.items(), key=lambda group: (group[0][:3] == "FNC", len(group[0]), group[0])))


def group_title(group: str) -> str:
    """A group in words."""
    return f"FNC {group[4:]} to {int(group[4:]) + 9:02d}" if group.startswith("FNC") else "Basic instructions"


def _rows(model: Model, spelled: str) -> list[Definition]:
    meant = model.spelling[spelled]
    return [TABLE[key] for key in dict.fromkeys(meant.keys if isinstance(meant, By) else (meant,))]


def _said(model: Model, row: Definition) -> list[str]:
    """What an instruction does, a paragraph each."""
    paragraphs = (row.function.__doc__ or "").strip().split("\n\n")
    return [told(model, row, " ".join(paragraph.split())) for paragraph in paragraphs]


def how_sure(name: str) -> str:
    """Where it is known from that there is an instruction, and what it does."""
    named = "the references of the family alone name it" if name in REFERENCE else "the manual names it"
    known = [
        *(["the manual"] if name in STATED else []),
        *(["references of the family"] if name in LOOKED_UP else []),
        *([] if name in ALL_KNOWN else ["general knowledge of the family"]),
    ]
    return f"how sure: {named}; what it does is known from {' and '.join(known)}"


@dataclass(frozen=True, repr=False)
class SpelledPage(Shown):
    """All about one instruction of a model, its forms together."""

    name: str
    model: Model

    def __repr__(self) -> str:
        return f"<help on {self.name} of {self.model.name}: {self.title}>"

    @property
    def forms(self) -> list[str]:
        """The names of its forms, those with the pulse suffix too."""
        return _forms(self.model.name)[self.name]

    @property
    def title(self) -> str:
        """What it does, in a sentence."""
        return _said(self.model, self._first)[0]

    @property
    def _first(self) -> Definition:
        return _rows(self.model, names_of(self.model)[self.name][0])[0]

    @property
    def example(self) -> dict[str, Any] | None:
        """The conformance case that serves as example, None where there is none."""
        return examples().get(f"{self.model.family} {self.name}")

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        first = self._first
        models = [model.name for model in MODELS.values() if model.family == self.model.family and self.name in names_of(model)]
        found: list[Part] = [Heading(self.name, 1), *map(Words, _said(self.model, first))]
        found.append(
            Items(
                (
                    f"manual {section_of(self.model, self.forms[0], first)}",
                    f"models: {', '.join(models)}",
                    f"forms: {', '.join(self.forms)}",
                    JOINS[first.join] if first.join else BUS if first.bus else FORMS[first.form],
                    how_sure(self.name),
                )
            )
        )
        shown: list[Definition] = []
        for spelled in names_of(self.model)[self.name]:
            for row in _rows(self.model, spelled):
                if row not in shown:
                    found += self._row(spelled, row, alone=row is first)
                    shown.append(row)
        flags = sorted({flag for row in shown for flag in row.flags})
        if flags:
            numbers = ("{} ({}{})".format(flag, *self.model.flag(flag)) for flag in flags)
            found += [Heading("Flags"), Items((f"{', '.join(numbers)}: set or cleared by each execution",))]
        codes = {code: where for row in shown for code, where in fault_codes(row).items()}
        if codes:
            found += [Heading("Errors"), Items(tuple(error_words(self.model, code, where) for code, where in sorted(codes.items())))]
        return (*found, *(example_parts(self.example) if self.example else ()))

    def _row(self, spelled: str, row: Definition, alone: bool) -> list[Part]:
        """One way to write it: its operands, and what it does where that is not said yet."""
        said = [] if alone or row.function is self._first.function else [Words(_said(self.model, row)[0])]
        pointers = self.model.syntax.pointers
        label = spelled in pointers.values()  # is one word, P10
        names = ["n" if label else spec.name for spec in row.operands]
        parts: list[Part] = [Code(("" if label else " ").join([spelled, *names])), *said]
        if row.operands:
            resolver = Resolver(self.model, {})
            letters = pointers | {"ROUTINE": pointers["LABEL"]}
            rows = tuple(
                (
                    name,
                    USES[spec.read, spec.written],
                    spec.type.name,
                    "yes" if spec.indexed else "no",
                    letters.get(spec.kind) or device_words(resolver.areas(spec)),
                    remark(replace(spec, range=self.model.operand_ranges.get(spec.kind, spec.range)), letters.get(spec.kind, "")),
                )
                for name, spec in zip(names, row.operands, strict=True)
            )
            parts.append(Rows(("operand", "use", "type", "index", "devices", "remark"), rows))
        return parts


@dataclass(frozen=True, repr=False)
class Group(Shown):
    """The instructions of one group of a model."""

    name: str
    model: Model

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        rows = tuple((name, SpelledPage(name, self.model).title) for name in groups(self.model)[self.name])
        return Heading(f"{self.model.family}: {group_title(self.name)}", 1), Rows(("instruction", "what it does"), rows)


@dataclass(frozen=True, repr=False)
class SpelledContents(Shown):
    """All instructions of a model."""

    model: Model

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        found: list[Part] = [Heading(f"Instructions of {self.model.name}", 1)]
        for group, names in groups(self.model).items():
            found += [Heading(group_title(group), 2), Words(" ".join(names))]
        return tuple(found)


def find(name: str, model: Model) -> SpelledPage | Group | SpelledContents | None:
    """The page of an instruction in any of its forms, of a group, or of all; None for what the model has not."""
    if not name:
        return SpelledContents(model)
    if name in _listed(model.name):
        return SpelledPage(_listed(model.name)[name], model)
    return Group(name, model) if name in groups(model) else None
