"""Instruction list -> ladder or chart -> instruction list is the same program; so is program -> text -> program."""

import json
from pathlib import Path
from xml.etree import ElementTree

from hypothesis import HealthCheck, given, settings

from ecsim.assembler import assemble
from ecsim.assembler.printer import print_instructions, print_program
from ecsim.errors import ProgramError
from ecsim.views.flows import Flow, part_list, parts
from ecsim.views.ladder import ladder
from ecsim.views.listing import listing
from ecsim.views.rungs import instruction_list, rungs
from ecsim.views.sfc import chart

from .programs import VARIABLES, charts, ladders

SOME = settings(max_examples=80, suppress_health_check=list(HealthCheck))


def as_written(program):
    """All instructions with operands as written, comments and titles."""
    return [(i.mnemonic, i.written, i.comment, unit.titles.get(n, "")) for unit in program.units for n, i in enumerate(unit.instructions)]


def words(tree):
    return [(word.mnemonic, word.written, word.comment, word.title) for word in tree]


def same(first, second):
    """Two programs agree in all but the lines they stand on."""
    assert [(u.kind, u.name, u.event) for u in first.units] == [(u.kind, u.name, u.event) for u in second.units]
    assert as_written(first) == as_written(second)
    for a, b in zip(first.units, second.units, strict=True):
        assert [i.operands for i in a.instructions] == [i.operands for i in b.instructions]
        assert [(n.start, n.end, n.title, n.region) for n in a.networks] == [(n.start, n.end, n.title, n.region) for n in b.networks]
        assert [(v.name, v.type, v.role, v.comment) for v in a.variables.values()] == [
            (v.name, v.type, v.role, v.comment) for v in b.variables.values()
        ]
    assert {(v.name, v.device, v.comment) for v in first.variables.values()} == {
        (v.name, v.device, v.comment) for v in second.variables.values()
    }
    assert first.steps == second.steps


@SOME
@given(ladders())
def test_a_ladder_gives_back_the_instruction_list_it_was_drawn_from(text):
    program = assemble(text, "EC20")
    assert words(ladder(program).instruction_list()) == as_written(program)


@SOME
@given(charts())
def test_a_chart_gives_back_the_instruction_list_it_was_drawn_from(text):
    program = assemble(text, "EC20")
    assert words(chart(program).instruction_list()) == as_written(program)
    assert words(ladder(program).instruction_list()) == as_written(program)


@SOME
@given(ladders() | charts())
def test_a_printed_program_is_the_same_program(text):
    program = assemble(text, "EC20")
    printed = print_program(program)
    again = assemble(printed, "EC20")
    same(program, again)
    assert print_program(again) == printed


@SOME
@given(charts())
def test_what_a_view_gives_back_assembles_to_the_same_program(text):
    program = assemble(text, "EC20")
    back = part_list(parts(program.main))
    titles = {place: word.title for place, word in enumerate(back) if word.title}
    again = assemble(f"{VARIABLES}PROGRAM MAIN\n{print_instructions(back, titles)}END_PROGRAM\n", "EC20")
    same(program, again)


@SOME
@given(charts())
def test_every_step_of_a_flow_is_in_the_chart_and_nothing_else(text):
    program = assemble(text, "EC20")
    drawn = [str(device) for part in parts(program.main) if isinstance(part, Flow) for step in part.steps for device in step.devices]
    assert drawn == [str(i.operands[0]) for i in program.main.instructions if i.mnemonic == "STL"]


def test_a_branch_on_the_bus_of_a_step_needs_no_anb():
    program = assemble("STL S20\nMPS\nLD X0\nOUT Y0\nMRD\nOUT Y1\nMPP\nOUT Y2\nRET\n", "EC20")
    assert words(instruction_list(rungs(program.main))) == as_written(program)


def test_a_tree_as_deep_as_a_program_is_long_comes_back():
    deep = "LD X0\n" * 400 + "ANB\n" * 399 + "OUT Y0\n" + "LD X1\n" + "OUT Y1\nAND X2\n" * 400 + "OUT Y2\n"
    program = assemble(deep, "EC20")
    picture = ladder(program)
    assert words(picture.instruction_list()) == as_written(program)
    assert "ANB" in picture.svg()
    assert "ANB" in str(picture)


def case_programs():
    """Every program of the conformance cases that compiles, once."""
    for file in sorted((Path(__file__).parent.parent / "conformance").glob("*.json")):
        for text in dict.fromkeys(case["il"] for case in json.loads(file.read_text(encoding="utf-8"))):
            try:
                yield assemble(text, "EC20")
            except ProgramError:
                continue


def test_every_program_of_the_cases_comes_back_and_one_of_each_instruction_is_drawn():
    drawn = set()
    for program in case_programs():
        picture = ladder(program)
        assert words(picture.instruction_list()) == as_written(program)
        assert words(chart(program).instruction_list()) == as_written(program)[: len(program.main.instructions)]
        fresh = {i.mnemonic for i in program.instructions} - drawn
        if fresh:
            drawn |= fresh
            same(program, assemble(print_program(program), "EC20"))
            for shown in (picture.svg(), chart(program).svg()):
                ElementTree.fromstring(shown)
            assert [line for line in str(picture).splitlines() if "│" in line or "├" in line]
            assert len(str(listing(program)).splitlines()) >= len(program.instructions)
    assert len(drawn) > 200
