"""The modelled scan time (2.1.1, 2.1.3): every step that is gone through takes its time, in loops, calls and interrupt programs too.

Steps by the manual: LD 1, OUT 3 at most, INC 3, ADD 7, FOR 3, NEXT 1, CALL 4, LBL 3, CJ 3; EC20 takes 0.09 us for each, EC10 0.3 us.
"""

import pytest

from ecsim import Plc, SystemBlock

LOOP = "LD SM0\nFOR {}\nLD SM0\nADD D1 1 D1\nNEXT"  # 1 + 3 steps, and 1 + 7 + 1 for each turn


def running(text, model="EC20", engine="compiled", **system):
    plc = Plc(model, scan_ms=None, system=SystemBlock(**system))
    plc.load(text)
    plc.engine = engine
    plc.run()
    return plc


@pytest.fixture(params=["compiled", "stepping"])
def engine(request):
    return request.param


def scan_us(plc):
    before = plc.time_us
    plc.scan()
    return plc.time_us - before


@pytest.mark.parametrize(("model", "ns"), [("EC20", 90), ("EC10", 300)])
def test_a_loop_takes_its_turns(engine, model, ns):
    plc = running(LOOP.format(5000), model, engine)
    assert scan_us(plc) == -(-(4 + 5000 * 9) * ns // 1000)
    assert plc["SD30"] == round((4 + 5000 * 9) * ns / 1e6)


def test_a_loop_inside_a_loop_counts_once_for_each_of_its_turns(engine):
    plc = running(f"LD SM0\nFOR 100\n{LOOP.format(50)}\nNEXT", engine=engine)
    assert scan_us(plc) == -(-(4 + 100 * (4 + 50 * 9 + 1)) * 90 // 1000)


def test_what_a_loop_does_not_do_takes_no_time(engine):
    loops = "\n".join(LOOP.format("D0") for _ in range(500))
    plc = running(loops, engine=engine)
    plc["D0"] = 5
    assert scan_us(plc) == 500 * (4 + 5 * 9) * 90 // 1000
    plc["D0"] = 0
    assert scan_us(plc) == 1000  # 180 us, and no scan is shorter than 1 ms


@pytest.mark.parametrize("calls", [0, 1, 3])
def test_a_subroutine_takes_its_time_whenever_it_is_called(engine, calls):
    main = "\n".join(f"LD M{n}\nCALL WORK" for n in range(3))
    plc = running(f"PROGRAM MAIN\n{main}\nEND_PROGRAM\nSUBROUTINE WORK\n{LOOP.format(2000)}\nEND_SUBROUTINE", engine=engine)
    for n in range(calls):
        plc[f"M{n}"] = 1
    assert scan_us(plc) == max(1000, -(-(3 * 5 + calls * (4 + 2000 * 9)) * 90 // 1000))


def test_a_jump_back_takes_the_way_once_more(engine):
    # 1 + 3 | LBL 3, LD 1, INC 3, LD< 5 steps, CJ 3; the way back of 3 + 1 + 3 + 5 + 3 steps is gone 1999 times more
    plc = running("LD SM0\nMOV 0 D0\nLBL 1\nLD SM0\nINC D0\nLD< D0 2000\nCJ 1", engine=engine)
    steps = {i.mnemonic: i.steps for i in plc.program.instructions}
    way = sum(steps[name] for name in ("LBL", "LD", "INC", "LD<", "CJ"))
    assert scan_us(plc) == -(-(steps["LD"] + steps["MOV"] + 2000 * way) * 90 // 1000)


def test_interrupt_programs_count_for_the_scan_that_follows(engine):
    plc = running(
        f"PROGRAM MAIN\nLD SM1\nMOV 1 SD66\nSET SM66\nEI\nEND_PROGRAM\nINTERRUPT I EVENT 26\n{LOOP.format(2000)}\nEND_INTERRUPT",
        engine=engine,
    )
    routine = (4 + 2000 * 9) * 90  # ns, 1.62 ms
    assert scan_us(plc) == 1000  # one request, at its end
    second = scan_us(plc)
    assert second == -(-(plc.program.main.length() * 90 + routine) // 1000)
    assert scan_us(plc) == second  # again one, at 2 ms; the next one comes at 3 ms


def test_too_many_interrupt_programs_end_as_error_61(engine):
    plc = running(
        f"PROGRAM MAIN\nLD SM1\nMOV 1 SD66\nSET SM66\nEI\nEND_PROGRAM\nINTERRUPT I EVENT 26\n{LOOP.format(30000)}\nEND_INTERRUPT",
        engine=engine,
    )
    plc.scan(50)  # 2.7 ms of work every ms
    assert not plc.running
    assert plc.errors[0].code == 61


def test_the_watchdog_looks_at_a_program_without_loops_too(engine):
    main = "\n".join("LD SM0\nADD D0 1 D0" for _ in range(1400))  # 8 steps each: 1.008 ms
    plc = running(main, engine=engine, watchdog_ms=1)
    plc.scan()
    assert not plc.running
    plc = running(main.removesuffix("\nLD SM0\nADD D0 1 D0" * 20), engine=engine, watchdog_ms=1)  # 0.9936 ms
    plc.scan()
    assert plc.running


def test_called_subroutines_count_for_the_watchdog(engine):
    calls = "\n".join("LD M0\nCALL WORK" for _ in range(20))
    plc = running(
        f"PROGRAM MAIN\n{calls}\nEND_PROGRAM\nSUBROUTINE WORK\n{LOOP.format(1000)}\nEND_SUBROUTINE", engine=engine, watchdog_ms=10
    )
    plc.scan()
    assert plc.running
    plc["M0"] = 1
    plc.scan()  # 20 times 0.81 ms
    assert not plc.running
    assert plc["SD20"] == 61


def test_a_step_back_keeps_what_interrupts_have_taken(engine):
    plc = running(
        f"PROGRAM MAIN\nLD SM1\nMOV 1 SD66\nSET SM66\nEI\nEND_PROGRAM\nINTERRUPT I EVENT 26\n{LOOP.format(1500)}\nEND_INTERRUPT",
        engine=engine,
    )
    plc.scan(3)
    kept = plc.snapshot()
    first = [scan_us(plc) for _ in range(5)]
    plc.restore(kept)
    assert [scan_us(plc) for _ in range(5)] == first
