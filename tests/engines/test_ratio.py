"""The compiled engine is the fast one. No absolute time: both engines run the same program in one process, by turns."""

import random
import time

from ecsim.plc import Plc


def latches(count):
    """Rungs of start, holding contact, stop and coil over all inputs, outputs and relays."""
    chance = random.Random(count)
    coils = [f"Y{n:o}" for n in range(256)] + [f"M{n}" for n in range(2000)]
    rungs = []
    for number in range(count):
        start, stop = chance.sample(range(256), 2)
        rungs.append(f"LD X{start:o}\nOR {coils[number]}\nANI X{stop:o}\nOUT {coils[number]}")
    return "\n".join(rungs)


def machine(engine):
    """A PLC in RUN with a thousand latches."""
    plc = Plc("EC20", input_filter_ms=0)
    plc.load(latches(1000))
    plc.engine = engine
    plc.run()
    return plc


def cpu_s(plc, scans):
    """The processor's time for some scans."""
    began = time.thread_time()
    plc.scan(scans)
    return time.thread_time() - began


def test_compiled_programs_run_at_least_three_times_as_fast_as_stepped_ones():
    compiled, stepping = machine("compiled"), machine("stepping")
    chance = random.Random(1)
    ratios = []
    for _ in range(7):
        levels = {f"X{n:o}": chance.randint(0, 1) for n in range(256)}
        for plc in (compiled, stepping):
            plc.set(levels)
            plc.scan()
        ratios.append(cpu_s(stepping, 20) / cpu_s(compiled, 20))
    assert compiled.memory.lists["M"] == stepping.memory.lists["M"]
    assert sorted(ratios)[3] > 3  # the median; it is about 8
