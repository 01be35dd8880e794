"""What a traced scan tells: flows, contacts, and every write with who wrote it."""

import random

import pytest

from ecsim import Plc, SystemBlock

from .random_programs import random_program


def traced(text, **devices):
    """A PLC in RUN that records its scans."""
    plc = Plc("EC20", input_filter_ms=0)
    plc.load(text)
    plc.tracing = True
    plc.run()
    plc.set(devices)
    return plc


def writes(plc):
    """The writes of the last scan: line of the instruction, device, old, new."""
    lines = [instruction.line for instruction in plc.program.instructions]
    return [(lines[write.position], write.device, write.old, write.new) for write in plc.trace.writes]


def test_the_flow_after_each_instruction_is_told():
    plc = traced("LD X0\nOR X1\nLD X2\nINV\nANB\nMPS\nAND X3\nOUT Y0\nMPP\nOUT Y1", X1=1)
    plc.scan()
    assert plc.trace.flow == [False, True, False, True, True, True, False, False, True, True]
    assert plc.trace.closed == [False, True, False, None, None, None, False, None, None, None]


@pytest.mark.parametrize(
    ("text", "skipped"),
    [
        ("LD X0\nMC 0\nLD SM0\nOUT Y0\nMCR 0", {2, 3}),
        ("STL S0\nLD SM0\nOUT Y0\nRET", {1, 2}),
        ("LD X0\nFOR 3\nLD SM0\nOUT Y0\nNEXT", {2, 3}),
        ("LD SM0\nCJ 1\nLD SM0\nOUT Y0\nLBL 1", {2, 3}),
        ("LD SM0\nCFEND\nLD SM0\nOUT Y0", {2, 3}),
    ],
)
def test_what_was_not_executed_has_no_flow(text, skipped):
    plc = traced(text)
    plc.scan()
    assert [(plc.trace.flow[n], plc.trace.closed[n]) for n in sorted(skipped)] == [(None, None)] * len(skipped)
    assert plc.trace.flow[0] is not None


def test_a_pulse_of_one_scan_is_seen():
    plc = traced("LD X0\nEU\nOUT Y0", X0=1)
    plc.scan()
    assert plc.trace.flow == [True, True, True]
    plc.scan()
    assert plc.trace.flow == [True, False, False]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("LD SM0\nOUT Y10", [(2, "Y10", 0, 1)]),
        ("LD SM0\nMOV 5 D0\nMOV 5 D0\nINC D0", [(2, "D0", 0, 5), (4, "D0", 5, 6)]),
        ("LD SM0\nDMOV -1 D2", [(2, "D2", 0, -1), (2, "D3", 0, -1)]),
        ("LD SM0\nMOV 5 K1M0", [(2, "M0", 0, 1), (2, "M2", 0, 1)]),
        ("LD SM0\nMOV 7 D0Z0", [(2, "D3", 0, 7)]),
        ("LD SM0\nCTU C0 1", [(2, "C0", 0, 1), (2, "C0:BOOL", 0, 1)]),
        ("LD SM0\nSUB 1 1 D5", [(2, "SM180", 0, 1)]),
        ("LD SM0\nSET S0\nSTL S0\nLD SM0\nSET S20\nSTL S20\nLD X7\nOUT S0\nRET", [(2, "S0", 0, 1), (5, "S20", 0, 1), (5, "S0", 1, 0)]),
    ],
)  # fmt: skip
def test_a_write_is_told_with_its_instruction_and_both_values(text, expected):
    plc = traced(text, Z0=3)
    plc.scan()
    assert sorted(writes(plc)) == sorted(expected)


def test_what_a_step_clears_when_it_has_been_left_is_told_of_its_stl():
    plc = traced("LD SM1\nSET S0\nSTL S0\nOUT Y0\nTON T0 1\nLD X0\nSET S20\nSTL S20\nRET", X0=1)
    plc.scan()
    plc.scan()
    assert writes(plc) == [(3, "Y0", 1, 0)]


def test_what_a_master_control_clears_is_told_of_its_mc():
    plc = traced("LD X0\nMC 0\nLD SM0\nOUT Y0\nTON T210 1\nMCR 0", X0=1)
    plc.scan(2)
    plc["X0"] = 0
    plc.scan()
    assert sorted(writes(plc)) == [(2, "T210", 1, 0), (2, "T210:BOOL", 1, 0), (2, "Y0", 1, 0)]


def test_what_a_call_brings_back_is_told_of_the_call():
    plc = traced(
        "PROGRAM MAIN\nLD SM0\nCALL S 4 D0 M0\nEND_PROGRAM\nSUBROUTINE S\nVAR_INPUT A : INT\nVAR_OUTPUT B : DINT\nVAR_IN_OUT C : BOOL\nLD SM0\nMOV #A D9\nDMOV -2 #B\nSET #C\nEND_SUBROUTINE"
    )
    plc.scan()
    of_call = [write for write in writes(plc) if write[0] == 3]
    assert of_call == [(3, "D0", 0, -1), (3, "D1", 0, -2), (3, "M0", 0, 1)]
    assert (10, "D9", 0, 4) in writes(plc)


def test_what_an_interrupt_writes_before_the_main_program_belongs_to_the_same_scan():
    plc = traced("PROGRAM MAIN\nLD SM1\nEI\nSET SM40\nEND_PROGRAM\nINTERRUPT EDGE EVENT 0\nLD SM0\nINC D0\nEND_INTERRUPT")
    plc.scan()
    plc["X0"] = 1  # asks for the interrupt program, which runs as the next scan begins
    plc.scan()
    assert writes(plc) == [(8, "D0", 0, 1)]
    plc.scan()
    assert writes(plc) == []


@pytest.mark.parametrize("seed", range(12))
def test_every_change_of_a_scan_is_told(seed):
    """Random programs: whatever a scan has changed, a write with that last value tells of it."""
    chance = random.Random(seed)
    plc = Plc("EC20", input_filter_ms=0, system=SystemBlock(watchdog_ms=2))
    plc.load(random_program(chance, 4))
    plc.tracing = True
    plc.run()
    watched = {"Y": "{:o}", "M": "{}", "S": "{}", "D": "{}", "Z": "{}", "C": "{}"}
    for _ in range(8):
        plc.set({f"X{n}": chance.randint(0, 1) for n in range(8)})
        before = {area: list(plc.memory.lists[area]) for area in watched}
        execute = plc._run_program
        after = {}

        def look(execute=execute, after=after):
            halted = execute()
            after |= {area: list(plc.memory.lists[area]) for area in watched}
            return halted

        plc._run_program = look  # what interrupts and hardware write later is not the scan's
        plc.scan()
        plc._run_program = execute
        told = {write.device: write.new for write in plc.trace.writes}
        for area, form in watched.items() if after else ():  # an interrupt may have stopped the PLC before
            for number, (old, new) in enumerate(zip(before[area], after[area], strict=True)):
                assert old == new or told.get(area + form.format(number)) == new
        plc.run()


def test_each_execution_is_told_in_turn_with_its_flow_and_its_writes():
    plc = traced("LD X0\nFOR 2\nLD M0\nINV\nOUT M0\nNEXT\nLD M0\nOUT Y0", X0=1)
    plc.scan()
    lines = [instruction.line for instruction in plc.program.instructions]
    told = [(lines[position], flow, writes) for position, flow, writes in plc.trace.order]
    passes = [[(3, False), (4, True), (5, True)], [(3, True), (4, False), (5, False)]]
    assert [(line, flow) for line, flow, _ in told if line in (3, 4, 5)] == passes[0] + passes[1]
    assert [writes for line, _, writes in told if line == 5] == [1, 2]
    assert told[-2:] == [(7, False, 2), (8, False, 2)]
