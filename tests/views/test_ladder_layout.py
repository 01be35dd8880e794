"""Where things lie in a ladder: nothing overlaps, nothing leaves its rails, and power reaches what the scan says it reached."""

import re

from hypothesis import HealthCheck, given, settings

from ecsim import Plc
from ecsim.assembler import assemble
from ecsim.views.labels import Labels
from ecsim.views.ladder import DEEPEST, Lengths, is_drawn, ladder
from ecsim.views.ladder_text import Cells
from ecsim.views.layout import Layout
from ecsim.views.rungs import Contact, Output, depth, rungs

from .programs import charts, ladders

SOME = settings(max_examples=40, suppress_health_check=list(HealthCheck))
LENGTHS = {"px": Lengths, "cells": Cells}


def laid_out(program, kind):
    """Every drawn rung of a program with its size and its places."""
    for unit in program.units:
        layout = Layout(LENGTHS[kind](Labels(unit, program)))
        for rung in rungs(unit):
            if is_drawn(rung):
                size = layout.size(rung)
                yield rung, size, layout.place(rung, size.width)


def boxes(placed):
    """What each symbol covers: from its first to its last sign, and all that stands above and below."""
    return [(s.x, s.y - s.size.up, s.x + s.size.width, s.y + s.size.down) for s in placed.symbols]


def overlap(a, b):
    return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]


@SOME
@given(ladders() | charts())
def test_no_two_symbols_overlap(text):
    for rung, _, placed in laid_out(assemble(text, "EC20"), "px"):
        found = boxes(placed)
        assert not [(a, b) for n, a in enumerate(found) for b in found[:n] if overlap(a, b)], rung.words


@SOME
@given(ladders() | charts())
def test_every_symbol_lies_between_the_rails_and_in_the_room_of_its_rung(text):
    for kind in LENGTHS:
        for _, size, placed in laid_out(assemble(text, "EC20"), kind):
            for left, top, right, bottom in boxes(placed):
                assert left >= 0
                assert right <= size.width
                assert top >= -size.up
                assert bottom <= size.down


@SOME
@given(ladders() | charts())
def test_no_wire_crosses_a_symbol(text):
    for _, _, placed in laid_out(assemble(text, "EC20"), "px"):
        bodies = [(s.x + s.size.enter, s.y - 8, s.x + s.size.leave, s.y + 8) for s in placed.symbols]
        for x1, y1, x2, y2, _ in placed.wires:
            wire = (min(x1, x2), min(y1, y2), max(x1, x2), max(y1, y2))
            crossed = [b for b in bodies if wire[0] < b[2] and b[0] < wire[2] and wire[1] < b[3] and b[1] < wire[3]]
            assert not crossed


@SOME
@given(ladders() | charts())
def test_every_symbol_is_wired_at_both_ends(text):
    for _, _, placed in laid_out(assemble(text, "EC20"), "px"):
        ends = {(x, y, net) for x1, y1, x2, y2, net in placed.wires for x, y in ((x1, y1), (x2, y2))}
        for s in placed.symbols:
            assert (s.x + s.size.enter, s.y, s.before) in ends
            # A branch that ends without an output may end at its last contact.
            if isinstance(s.item, Output) or any(wire[4] == s.after for wire in placed.wires):
                assert (s.x + s.size.leave, s.y, s.after) in ends


@SOME
@given(ladders() | charts())
def test_power_reaches_what_the_scan_says_it_reached(text):
    plc = Plc("EC20", input_filter_ms=0)
    plc.load(text)
    plc.tracing = True
    plc.run()
    plc.set({"X0": 1, "X10": 1, "M12": 1, "D0": 3, "S20": 1})
    for scan in range(4):
        plc["X1"] = plc["X7"] = scan % 2
        plc.scan()
        trace = plc.trace
        for rung, _, placed in laid_out(plc.program, "px"):
            first = rung.words[0].position
            power = placed.power.solve(trace.flow[first] is not None, trace.flow, trace.closed)
            for symbol in placed.symbols:
                position = symbol.item.word.position
                if isinstance(symbol.item, Output) and trace.flow[position] is not None:
                    assert power[symbol.before] == trace.flow[position], str(symbol.item.word)
                if isinstance(symbol.item, Contact) and trace.flow[first] is None:
                    assert not power[symbol.after]


def test_outputs_stand_against_the_right_rail():
    program = assemble("LD X0\nOUT Y0\nTON T0 5\nAND X1\nOUT Y1", "EC20")
    (placed,) = [placed for _, _, placed in laid_out(program, "px")]
    ends = [s.x + s.size.width for s in placed.symbols if isinstance(s.item, Output)]
    assert len(set(ends)) == 1


def test_a_cascade_and_branches_are_drawn_alike():
    cascade = assemble("LD X0\nOUT Y0\nAND X1\nOUT Y1", "EC20")
    branches = assemble("LD X0\nMPS\nOUT Y0\nMPP\nAND X1\nOUT Y1", "EC20")
    first, second = ([(s.x, s.y) for s in next(laid_out(p, "px"))[2].symbols] for p in (cascade, branches))
    assert first == second
    assert str(ladder(cascade)) == str(ladder(branches))


def test_what_is_nested_too_deep_is_listed():
    program = assemble("LD X0\n" * 60 + "ANB\n" * 59 + "OUT Y0", "EC20")
    (rung,) = ladder(program).rungs
    assert depth(rung.flow) > DEEPEST
    assert "LD X0" in str(ladder(program))


def test_a_long_title_ends_before_the_right_rail_and_tells_the_rest_as_its_tip():
    words = "the conveyor brings the next bottle below the filling head and waits there"
    shown = ladder(assemble(f"PROGRAM MAIN\n// {words}\nLD X0\nOUT Y0\nEND_PROGRAM", "EC20"))
    title = re.compile(r'class="net-title"[^>]*>([^<]*)(?:<title>([^<]*)</title>)?</text>')
    cut, tip = title.search(shown.svg("", 340)).groups()
    assert (cut[-1], tip) == ("…", words)
    assert words.startswith(cut[:-1])
    assert len(cut) * 13 * 0.5 < 340  # half of its height is what a letter takes, roughly
    assert title.search(shown.svg("", 1280)).groups() == (words, None)
