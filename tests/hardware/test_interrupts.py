"""Interrupts: exact moments, order, the queue, what a snapshot keeps."""

import pytest

from ecsim import Plc

HEAD = "PROGRAM MAIN\nLD SM1\nEI\n{}\nEND_PROGRAM\n"


def machine(main, routines, model="EC20", scan_ms=10):
    plc = Plc(model, scan_ms=scan_ms, input_filter_ms=0)
    text = HEAD.format(main)
    for event, body in routines.items():
        text += f"INTERRUPT I{event} EVENT {event}\n{body}\nEND_INTERRUPT\n"
    plc.load(text)
    plc.run()
    return plc


def stamp(first):
    """A routine that notes a free-running count of 10 kHz, of which the first 0.1 ms after the signal's begin is count 1."""
    return f"LD SM0\nDMOV C236 D{first}Z0\nADD Z0 2 Z0"


def test_periods_are_exact_and_three_timed_interrupts_keep_apart():
    main = "SET SM66\nSET SM67\nSET SM68\nMOV 3 SD66\nMOV 7 SD67\nMOV 11 SD68"
    plc = machine(main, {26: "LD SM0\nINC D0", 27: "LD SM0\nINC D1", 28: "LD SM0\nINC D2"}, scan_ms=7.3)
    plc.scan(1000)  # the periods count from the end of the first program, at 0
    assert [plc[f"D{n}"] for n in range(3)] == [7300 // 3, 7300 // 7, 7300 // 11]


def test_events_act_in_order_of_time():
    # edges of X1 at 2.5 ms + 10 k, the timed interrupt at 4 ms + 4 k: the log shows who came when
    log = "MUL D0 10 D10\nMOV D11 D0\nADD D0 {} D0"
    plc = machine("SET SM41\nSET SM66\nMOV 4 SD66", {1: f"LD SM0\n{log.format(1)}", 26: f"LD SM0\n{log.format(2)}"})
    plc.pulse("X1", count=1, ms=10)
    plc.scan()
    assert plc["D0"] == 122


def test_the_moment_of_an_edge_is_exact():
    plc = machine("LD SM0\nHCNT C236 0\nSET SM43", {3: stamp(100)})
    plc.scan()
    plc.square("X0", hz=100_000)
    plc.signal("X3", [(1.234, 1), (2, 0), (7.777, 1)])
    plc.scan()
    # 100 kHz from a quarter period on: by 1.234 ms rises at 2, 12 ... 1232 us
    assert [plc["D100:DINT"], plc["D102:DINT"]] == [124, 778]


def test_what_a_routine_switches_on_is_heeded_at_once():
    plc = machine("SET SM41", {1: "LD SM0\nSET SM66\nMOV 2 SD66", 26: "LD SM0\nINC D0"})
    plc.scan()
    plc.signal("X1", [(1, 1)])
    plc.scan()  # edge at 1 ms, then 3, 5, 7, 9 ms
    assert plc["D0"] == 4


@pytest.mark.parametrize("engine", ["compiled", "stepping"])
def test_a_step_back_restores_what_waits(engine):
    plc = machine("SET SM66\nMOV 9 SD66\nSET SM40", {26: "LD SM0\nINC D0", 0: "LD SM0\nINC D1"})
    plc.engine = engine
    plc.scan(3)
    plc["X0"] = 1
    kept = plc.snapshot()
    plc.scan(50)
    first = plc.memory.snapshot()
    plc.restore(kept)
    plc.scan(50)
    assert plc.memory.snapshot() == first
    assert tuple(first["D"][:2]) == (530 // 9, 1)


def test_stop_in_a_routine_ends_the_time_of_events():
    plc = machine("SET SM66\nMOV 2 SD66", {26: "LD SM0\nINC D0\nLD= D0 3\nSTOP"})
    plc.scan(5)
    assert plc["D0"] == 3
    assert not plc.running


def test_idle_units_are_not_asked():
    plc = Plc("EC20")
    plc.load("LD X0\nOUT Y0")
    plc.run()
    assert plc._awake == []
