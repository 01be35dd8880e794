"""What each special relay and register does, as small programs: `check(model, number)` makes it change and back, or fails.

`machine(model, il, **settings)` is a running PLC with ideal inputs.
"""

from datetime import datetime

import ecsim
from ecsim import SystemBlock


def machine(model, il="LD SM0\nNOP", **settings):
    """A PLC in RUN with this program; inputs without filter."""
    system = settings.pop("system", None) or SystemBlock()
    plc = ecsim.Plc(model, input_filter_ms=0, system=system, **settings)
    plc.load(il)
    plc.run()
    return plc


def values(plc, *names):
    return [plc[name] for name in names]


def ints(event):
    """An interrupt program that counts in D0."""
    return f"\nINTERRUPT I0 EVENT {event}\nLD SM0\nINC D0\nEND_INTERRUPT"


def main(il):
    return f"PROGRAM MAIN\n{il}\nEND_PROGRAM"


# -- state of the PLC ---------------------------------------------------------------------------------------------


def running(model, number):
    plc = machine(model)
    assert plc["SM0"] == 1
    plc.stop()
    assert plc["SM0"] == 0


def first_scan(model, number):
    plc = machine(model, "LD SM1\nINC D0\nLD SM0\nINC D1")
    assert plc["SM1"] == 1
    plc.scan(3)
    assert values(plc, "D0", "D1", "SM1") == [1, 3, 0]
    plc.stop()
    plc.run()
    plc.scan(2)
    assert plc["D0"] == 1


def power_up(model, number):
    plc = machine(model, "LD SM2\nINC D0")
    plc.scan(3)
    assert values(plc, "D0", "SM2") == [1, 0]
    plc.stop()
    plc.run()
    plc.scan(3)
    assert plc["D0"] == 0
    plc.power_cycle()
    plc.scan(3)
    assert plc["D0"] == 1


def system_error(model, number):
    plc = machine(model, io=[(24, 16), "4AD"])
    assert values(plc, "SM3", "SD3") == [0, 0]
    plc.modules[0].remove()
    assert values(plc, "SM3", "SD3") == [1, 22]
    plc.modules[0].insert()
    assert values(plc, "SM3", "SD3") == [0, 0]


def battery(model, number):
    plc = machine(model)
    good = plc["SD4"]
    assert plc["SM4"] == 0
    assert good > 24
    plc.battery = "failing"
    assert plc["SM4"] == 1
    assert 0 < plc["SD4"] <= 24
    plc.battery = "absent"
    assert values(plc, "SM4", "SD4") == [1, 0]
    plc.battery = "present"
    assert values(plc, "SM4", "SD4") == [0, good]


def mains(model, number):
    plc = machine(model)
    assert plc["SM5"] == 0
    plc.power_off()
    assert plc["SM5"] == 1
    plc.power_on()
    assert plc["SM5"] == 0


def dc24(model, number):
    plc = machine(model)
    plc.dc24 = False
    assert plc["SM6"] == 1
    plc.advance(ms=200)
    assert plc["SM6"] == 1
    plc.dc24 = True
    assert plc["SM6"] == 1  # looked at again 50 ms after
    plc.advance(ms=60)
    assert plc["SM6"] == 0


def no_battery(model, number):
    assert machine(model)["SM7"] == 0
    assert machine(model, system=SystemBlock(no_battery=True))["SM7"] == 1


def detection_time(model, number):
    for asked, taken in ((0, 10), (10, 10), (57, 57), (100, 100)):
        assert machine(model, system=SystemBlock(power_loss_ms=asked))["SD5"] == taken


def constant_scan(model, number):
    assert values(machine(model), "SM8", "SD33") == [0, 0]
    plc = machine(model, scan_ms=None, system=SystemBlock(constant_scan_ms=25))
    plc.scan(2)
    assert values(plc, "SM8", "SD33", "SD30") == [1, 25, 25]


def run_input(model, number):
    assert values(machine(model), "SM9", "SD9") == [0, 0]
    plc = machine(model, system=SystemBlock(run_input="X13"))
    assert values(plc, "SM9", "SD9") == [1, 11]
    plc.stop()
    plc["X13"] = 1
    plc.scan(2)
    assert plc["SM0"] == 1


HALVES_MS = {10: 5, 11: 50, 12: 500, 13: 30_000, 14: 1_800_000}


def square_wave(model, number):
    half = HALVES_MS[number]
    step = min(half, 60_000)
    plc = machine(model, scan_ms=step)
    for scan in range(5 * half // step):
        plc.scan()
        assert plc[f"SM{number}"] == scan * step // half % 2


def scan_toggle(model, number):
    plc = machine(model)
    found = []
    for _ in range(5):
        plc.scan()
        found.append(plc["SM15"])
    assert found == [0, 1, 0, 1, 0]


def kind(model, number):
    assert machine(model)["SD0"] == {"EC10": 10, "EC20": 20}[model]


def version(model, number):
    assert machine(model)["SD1"] >= 100


def capacity(model, number):
    assert machine(model)["SD2"] == 12  # k steps (tables 2-1, 2-2)


def count_of_modules(model, number):
    plc = machine(model, io=[(24, 16), (8, 8), "4AD", "4DA", (16, 0)])
    assert values(plc, "SD7", "SD8") == [2, 2]
    assert values(machine(model), "SD7", "SD8") == [0, 0]


def count_of_points(model, number):
    plc = machine(model, io=[(24, 16), (8, 8), (16, 0)])
    assert values(plc, "SD10", "SD11") == [24 * 256 + 16, 24 * 256 + 8]
    assert values(machine(model, io=(10, 6)), "SD10", "SD11") == [10 * 256 + 6, 0]


def analog_points(model, number):
    assert machine(model)["SD12"] == {"EC10": 2 * 256 + 1, "EC20": 0}[model]


# -- errors -------------------------------------------------------------------------------------------------------

FAILING = "LD M0\nMOV D7999Z0 D10\nLD M1\nZRST M100 D1\nLD M2\nDIV D2 D3 D12\nLD M3\nPUSH D4 D20 D5\nLD M4\nTWR D30\nLD M9\nMOV 1 D99"
CODES = {"M0": 65, "M1": 64, "M2": 69, "M3": 70, "M4": 76}


def fail(plc, *relays):
    plc.set({relay: int(relay in relays) for relay in (*CODES, "M9")})
    plc.scan()


def failing(model):
    plc = machine(model, FAILING)
    plc.set({"Z0": 1, "D1": -1})
    return plc


def execution_error(model, number):
    plc = failing(model)
    assert plc["SM20"] == 0
    for relay in CODES:
        fail(plc, relay)
        assert plc["SM20"] == 1
        fail(plc, "M9")
        assert plc["SM20"] == 0


def out_of_range(model, number):
    plc = failing(model)
    fail(plc, "M1")
    assert plc["SM21"] == 0
    fail(plc, "M0")
    assert plc["SM21"] == 1
    plc.stop()
    plc.run()
    assert plc["SM21"] == 0


def illegal_parameter(model, number):
    plc = failing(model)
    fail(plc, "M0")
    assert plc["SM22"] == 0
    fail(plc, "M1")
    assert plc["SM22"] == 1
    fail(plc, "M9")
    assert plc["SM22"] == 0


def record(model, number):
    plc = failing(model)
    assert plc[f"SD{number}"] == 0
    expected = [0] * 5
    for relay in ("M0", "M1", "M1", "M2", "M3", "M3", "M3", "M4", "M0", "M2"):
        fail(plc, relay)
        if CODES[relay] != expected[0]:  # only another code moves the others on
            expected = [CODES[relay], *expected[:4]]
        assert plc[f"SD{number}"] == expected[number - 20]


def faulty_module(model, number):
    if model == "EC10":  # it has no FROM and TO
        assert machine(model)["SD25"] == 255
        return
    plc = machine(model, "LD M0\nFROM 3 0 D0 1")
    assert plc["SD25"] == 255
    plc["M0"] = 1
    plc.scan()
    assert plc["SD25"] == 3


def faulty_group(model, number):
    plc = machine(model, "LD M0\nREF X30 8", io=(24, 16))
    assert plc["SD26"] == 255
    plc["M0"] = 1
    plc.scan()
    assert values(plc, "SD26", "SD20") == [3, 75]


def scan_times(model, number):
    plc = machine(model, "LD M0\nFOR D0\nLD SM0\nINC D1\nNEXT", scan_ms=None)  # of FOR, INC and NEXT each turn takes time
    plc.scan(2)
    assert values(plc, "SD30", "SD31", "SD32") == [1, 1, 1]
    plc.set({"M0": 1, "D0": 20_000})
    plc.scan()
    long = plc["SD30"]
    assert long > 5
    assert values(plc, "SD31", "SD32") == [1, long]
    plc["M0"] = 0
    plc.scan(2)
    assert values(plc, "SD30", "SD31", "SD32") == [1, 1, long]


def watchdog(model, number):
    assert machine(model)["SD34"] == 200
    assert machine(model, system=SystemBlock(watchdog_ms=500))["SD34"] == 500


def filter_constant(model, number):
    assert machine(model)["SD35"] == 0
    plc = ecsim.Plc(model)
    assert plc["SD35"] == {"EC10": 8, "EC20": 10}[model]


# -- interrupts ---------------------------------------------------------------------------------------------------


def edge_interrupt(model, number):
    place = number - 40
    for event, change in ((place, (0, 1)), (place + 10, (1, 0))):
        plc = machine(model, main(f"LD SM1\nEI\nLD M0\nOUT SM{number}") + ints(event))
        plc.scan()
        for enabled, expected in ((1, 1), (0, 1), (1, 2)):
            plc["M0"] = enabled
            plc[f"X{place}"] = change[0]
            plc.scan(2)
            plc[f"X{place}"] = change[1]
            plc.scan(2)
            assert plc["D0"] == expected


def power_loss_interrupt(model, number):
    for enabled in (0, 1):
        plc = machine(model, main("LD SM1\nEI\nLD M0\nOUT SM56") + ints(29))
        plc["M0"] = enabled
        plc.scan(2)
        plc.power_off()
        assert plc["D0"] == enabled


def pulses_done_interrupt(model, number):
    axis = number - 63
    for enabled in (0, 1):
        plc = machine(model, main(f"LD SM1\nEI\nLD M1\nOUT SM{number}\nLD M0\nPLSY 1000 15 Y{axis}") + ints(18 + axis))
        plc.set({"M0": 1, "M1": enabled})
        plc.advance(ms=10)
        assert plc["D0"] == 0
        plc.advance(ms=20)
        assert plc["D0"] == enabled


def counter_interrupt(model, number):
    for event in range(20, 26):
        plc = machine(model, main(f"LD SM1\nEI\nLD M1\nOUT SM65\nLD SM0\nHCNT C236 100\nLD SM0\nDHSCI D10 C236 {event}") + ints(event))
        plc.set({"M1": 1, "D10:DINT": 3})
        plc.scan(2)
        plc.pulse("X0", 2, ms=10)
        plc.scan()
        assert plc["D0"] == 0
        plc.pulse("X0", 1, ms=10)
        plc.scan()
        assert plc["D0"] == 1
        plc.set({"M1": 0, "C236": 0})
        plc.scan()
        plc.pulse("X0", 5, ms=10)
        plc.scan()
        assert plc["D0"] == 1


def timed_interrupt(model, number):
    event, register = number - 40, f"SD{number}"
    plc = machine(model, main(f"LD SM1\nEI\nLD M1\nMOV D5 {register}\nLD M0\nOUT SM{number}") + ints(event))
    plc.set({"M0": 1, "M1": 1, "D5": 20})
    plc.advance(ms=110)
    assert plc["D0"] == 5
    plc["D5"] = 0
    plc.advance(ms=100)
    assert plc["D0"] == 5
    plc["D5"] = 5
    plc.advance(ms=10)  # the scan that enables it
    counted = plc["D0"]
    plc.advance(ms=50)
    assert plc["D0"] == counted + 10
    plc["M0"] = 0
    plc.scan()
    counted = plc["D0"]
    plc.advance(ms=100)
    assert plc["D0"] == counted


# -- pulses, capture, counters ------------------------------------------------------------------------------------


def pulse_stop(model, number):
    axis = number - 80
    plc = machine(model, f"LD M1\nOUT SM{number}\nLD M0\nPLSY 1000 0 Y{axis}")
    plc["M0"] = 1
    plc.advance(ms=100)
    sent = plc[f"SD{50 + 2 * axis}:DINT"]
    assert sent > 80
    plc["M1"] = 1
    plc.advance(ms=20)
    sent = plc[f"SD{50 + 2 * axis}:DINT"]
    plc.advance(ms=100)
    assert values(plc, f"SD{50 + 2 * axis}:DINT", f"SM{82 + axis}") == [sent, 0]
    plc["M1"] = 0
    plc.advance(ms=50)
    assert plc[f"SD{50 + 2 * axis}:DINT"] > sent


def pulse_busy(model, number):
    axis = number - 82
    plc = machine(model, f"LD M0\nPLSY 1000 50 Y{axis}")
    assert plc[f"SM{number}"] == 0
    plc["M0"] = 1
    plc.advance(ms=30)
    assert plc[f"SM{number}"] == 1
    plc.advance(ms=50)
    assert plc[f"SM{number}"] == 0


def clear_signal(model, number):
    parameters = "LD SM1\nDMOV 10000 SD85\nMOV 500 SD84\nMOV 950 SD87"
    for axis, output in ((0, "Y2"), (1, "Y3")):
        for enabled in (0, 1):
            plc = machine(model, f"LD M1\nOUT SM85\n{parameters}\nLD M0\nZRN 2000 500 X3 Y{axis}")
            plc.set({"M0": 1, "M1": enabled})
            plc.advance(ms=500)
            plc["X3"] = 1
            plc.advance(ms=300)
            plc["X3"] = 0
            plc.advance(ms=20)  # the signal lasts 20 ms and a scan
            assert plc[output] == enabled
            plc.advance(ms=20)
            assert plc[output] == 0


def pulse_capture(model, number):
    place = number - 90
    plc = machine(model, f"LD SM{number}\nOUT Y0\nLD M0\nRST SM{number}")
    plc.scan()
    plc.pulse(f"X{place}", 1, ms=2)
    plc.scan(2)
    assert values(plc, f"SM{number}", "Y0", f"X{place}") == [1, 1, 0]
    plc["M0"] = 1
    plc.scan(2)
    assert values(plc, f"SM{number}", "Y0") == [0, 0]
    plc["M0"] = 0
    plc.pulse(f"X{place}", 1, ms=2)
    plc.scan(2)
    assert plc[f"SM{number}"] == 1
    plc.stop()
    plc.run()
    assert plc[f"SM{number}"] == 0


def pulses_sent(model, number):
    """SD50 to SD55: three double words, the high word first; RUN leaves them, the program may write them."""
    plc = machine(model, "LD M0\nPLSY 50000 D0 Y0\nLD M1\nPLSY 50000 D0 Y1\nLD M2\nDMOV 0 SD50")
    plc.set({"M0": 1, "D0:DINT": 70_000})
    plc.advance(ms=1500)
    plc.set({"M1": 1, "D0:DINT": 3})
    plc.advance(ms=20)
    expected = {"SD50": 70_000, "SD52": 3, "SD54": 70_003}
    pair = f"SD{number - number % 2}"
    high, low = divmod(expected[pair], 65_536)
    wanted = (high, low)[number % 2]
    assert plc[f"SD{number}:WORD"] == wanted
    plc.stop()
    plc.run()
    assert plc[f"SD{number}:WORD"] == wanted
    plc["M2"] = 1
    plc.scan()
    assert plc["SD50:DINT"] == 0


def segment(model, number):
    axis = number - 56
    table = (
        "LD SM1\nDMOV 5000 D100\nDMOV 5000 D102\nDMOV 2000 D104\nDMOV 5000 D106\nDMOV 10000 D108\nMOV 1000 D110\nMOV 900 D111\nMOV 900 D112"
    )
    plc = machine(model, f"{table}\nLD M0\nPLS D100 2 Y{axis}")
    found = [plc[f"SD{number}"]]
    plc["M0"] = 1
    for ms in (1000, 500, 3000):
        plc.advance(ms=ms)
        found.append(plc[f"SD{number}"])
    assert found == [0, 1, 2, 0]


def position(model, number):
    """SD80 to SD83: DRVI moves the position by its pulses, the high word first; RUN begins with 0."""
    axis = (number - 80) // 2
    plc = machine(model, f"LD M0\nDRVI D0 20000 Y{axis} Y4")
    plc.set({"M0": 1, "D0:DINT": -70_000})
    assert plc[f"SD{number}"] == 0
    plc.advance(ms=6000)
    high, low = divmod(-70_000, 65_536)
    assert plc[f"SD{number}:WORD"] == ((high & 0xFFFF), low)[number % 2]
    plc.stop()
    plc.run()
    assert plc[f"SD{number}"] == 0


def base_frequency(model, number):
    """DRVI begins with SD84: in the first 100 ms it sends more pulses when that is higher."""
    assert machine(model)["SD84"] == 5000
    sent = []
    for frequency in (500, 1000):
        plc = machine(model, f"LD SM1\nDMOV 10000 SD85\nMOV {frequency} SD84\nMOV 2000 SD87\nLD M0\nDRVI 5000 5000 Y0 Y4")
        plc["M0"] = 1
        plc.advance(ms=100)
        sent.append(plc["SD50:DINT"])
    assert sent[1] > sent[0] + 20


def top_frequency(model, number):
    """SD85 and SD86: DRVI goes no faster."""
    assert machine(model)["SD85:DINT"] == 100_000
    sent = []
    for frequency in (1000, 70_000):
        plc = machine(model, f"LD SM1\nDMOV {frequency} SD85\nMOV 100 SD84\nMOV 100 SD87\nLD M0\nDRVI 900000 50000 Y0 Y4")
        plc["M0"] = 1
        plc.advance(ms=1000)
        sent.append(plc["SD50:DINT"])
    assert sent[0] <= 1000
    assert sent[1] > 40_000


def ramp_time(model, number):
    """SD87: the longer the ramp, the fewer pulses of DRVI in the same time."""
    assert machine(model)["SD87"] == 1000
    sent = []
    for ms in (100, 2000):
        plc = machine(model, f"LD SM1\nDMOV 10000 SD85\nMOV 500 SD84\nMOV {ms} SD87\nLD M0\nDRVI 90000 10000 Y0 Y4")
        plc["M0"] = 1
        plc.advance(ms=500)
        sent.append(plc["SD50:DINT"])
    assert sent[0] > sent[1] + 1000


def zero_flag(model, number):
    plc = machine(model, "LD M0\nSUB D0 5 D1\nLD M1\nRST SM180")
    plc.set({"M0": 1, "D0": 5})
    plc.scan()
    assert plc["SM180"] == 1
    plc["D0"] = 6
    plc.scan()
    assert plc["SM180"] == 0
    plc["D0"] = 5
    plc.scan()
    plc.set({"M0": 0, "M1": 1})
    plc.scan()
    assert plc["SM180"] == 0


def carry_flag(model, number):
    plc = machine(model, "LD M0\nADD D0 1 D1\nLD M1\nRST SM181")
    plc.set({"M0": 1, "D0": 32_767})
    plc.scan()
    assert values(plc, "D1", "SM181") == [-32_768, 1]
    plc["D0"] = 1
    plc.scan()
    assert plc["SM181"] == 0
    plc["D0"] = 32_767
    plc.scan()
    plc.set({"M0": 0, "M1": 1})
    plc.scan()
    assert plc["SM181"] == 0


def borrow_flag(model, number):
    plc = machine(model, "LD M0\nSUB D0 1 D1\nLD M1\nRST SM182\nLD M2\nSET SM182")
    plc.set({"M0": 1, "D0": -32_768})
    plc.scan()
    assert values(plc, "D1", "SM182") == [32_767, 1]
    plc["D0"] = 1
    plc.scan()
    assert plc["SM182"] == 0
    plc.set({"M0": 0, "M2": 1})
    plc.scan()
    assert plc["SM182"] == 1
    plc.set({"M2": 0, "M1": 1})
    plc.scan()
    assert plc["SM182"] == 0


# Records of DHST: value, output, state; and of DHSP: value, data for SD180 and SD181
STATES = "LD SM1\nDMOV 100 D100\nMOV 0 D102\nMOV 1 D103\nDMOV 70000 D104\nMOV 1 D106\nMOV 1 D107"
DATA = "LD SM1\nDMOV 100 D100\nDMOV 70000 D102\nDMOV 200 D104\nDMOV 140000 D106\nDMOV 300 D108\nDMOV 0 D110"


def table_of_states(model, number):
    plc = machine(model, f"{STATES}\nLD SM0\nHCNT C236 1000\nLD M1\nDHST D100 2 C236")
    plc["M1"] = 1
    plc.scan()
    assert values(plc, "SM185", "SD184", "SD182:DINT") == [0, 1, 100]
    plc.pulse("X0", 100, ms=10)
    plc.scan()
    assert values(plc, "SM185", "SD184", "SD182:DINT", "SD182", "SD183:WORD", "Y0") == [0, 2, 70_000, 1, 70_000 - 65_536, 1]
    plc["C236"] = 69_999
    plc.pulse("X0", 1, ms=10)
    plc.scan()
    assert values(plc, "SM185", "SD184", "SD182:DINT", "Y1") == [1, 1, 100, 1]
    plc["M1"] = 0
    plc.scan()
    plc["M1"] = 1
    plc.scan()
    assert plc["SM185"] == 0


def table_of_data(model, number):
    plc = machine(model, f"{DATA}\nLD SM0\nHCNT C236 1000\nLD M1\nDHSP D100 2 C236")
    plc["M1"] = 1
    plc.scan()
    assert plc["SD180:DINT"] == 0
    plc.pulse("X0", 100, ms=10)
    plc.scan()
    assert values(plc, "SD180", "SD181:WORD", "SD180:DINT") == [1, 70_000 - 65_536, 70_000]
    plc.pulse("X0", 100, ms=10)
    plc.scan()
    assert values(plc, "SD180", "SD181:WORD", "SD180:DINT") == [2, 140_000 - 131_072, 140_000]


def storage_of_asc(model, number):
    plc = machine(model, "LD M1\nOUT SM186\nLD M0\nASC 1234 D0")
    plc["M0"] = 1
    plc.scan()
    assert values(plc, "D0:WORD", "D1:WORD") == [ord("2") << 8 | ord("1"), ord("4") << 8 | ord("3")]
    plc["M1"] = 1
    plc.scan()
    assert values(plc, "D0:WORD", "D1:WORD", "D2:WORD", "D3:WORD") == [ord(each) for each in "1234"]


def counts_down(model, number):
    plc = machine(model, f"LD M1\nOUT SM{number}\nLD M0\nDCNT C{number} 5")
    for down, expected in ((0, 1), (0, 2), (1, 1), (1, 0), (1, -1), (0, 0)):
        plc.set({"M0": 0, "M1": down})
        plc.scan()
        plc["M0"] = 1
        plc.scan()
        assert plc[f"C{number}"] == expected


FIRST_INPUT = {236: 0, 237: 1, 238: 2, 239: 3, 240: 4, 241: 5, 242: 0, 243: 3, 244: 0, 245: 3}
START_INPUT = {244: "X6", 245: "X7"}
PAIRS = {246: (0, 1), 247: (0, 1), 248: (3, 4), 249: (0, 1), 250: (3, 4), 251: (0, 1), 252: (0, 1), 253: (3, 4), 254: (0, 1), 255: (3, 4)}
START_INPUT |= {249: "X6", 250: "X7", 254: "X6", 255: "X7"}


def fast_counts_down(model, number):
    plc = machine(model, f"LD M1\nOUT SM{number}\nLD SM0\nHCNT C{number} 100")
    if number in START_INPUT:
        plc[START_INPUT[number]] = 1
    value = 0
    for down in (0, 1, 0):
        plc["M1"] = down
        plc.scan(2)
        plc.pulse(f"X{FIRST_INPUT[number]}", 4, ms=10)
        plc.scan()
        value += -4 if down else 4
        assert plc[f"C{number}"] == value


def fast_direction(model, number):
    plc = machine(model, f"LD SM0\nHCNT C{number} 100")
    if number in START_INPUT:
        plc[START_INPUT[number]] = 1
    plc.scan()
    up, down = (f"X{place}" for place in PAIRS[number])
    for turn, state in ((1, 0), (-1, 1), (1, 0)):
        if number < 251:
            plc.pulse(up if turn > 0 else down, 3, ms=10)
        else:
            plc.quadrature(up, down, 3, turn, ms=10)
        plc.scan()
        assert plc[f"SM{number}"] == state


# -- clock, EEPROM, buses, analog ---------------------------------------------------------------------------------


def clock(model, number):
    plc = machine(model, "LD M0\nTWR D0")
    plc.clock_time = datetime(2024, 12, 31, 23, 59, 58)  # a Tuesday
    assert [plc[f"SD{100 + place}"] for place in range(7)] == [2024, 12, 31, 23, 59, 58, 2]
    plc.advance(ms=2010)
    assert plc[f"SD{number}"] == [2025, 1, 1, 0, 0, 0, 3][number - 100]
    plc.set({f"D{place}": value for place, value in enumerate((2031, 7, 4, 5, 6, 7, 5))} | {"M0": 1})
    plc.scan()
    assert plc[f"SD{number}"] == [2031, 7, 4, 5, 6, 7, 5][number - 100]


def clock_error(model, number):
    plc = machine(model)
    part = next(part for part in ("clock", "clock chip") if part in plc.health.parts)
    assert plc["SM193"] == 0
    plc.damage(part)
    assert plc["SM193"] == 1
    plc.repair(part)
    assert plc["SM193"] == 0


def eeprom_idle(model, number):
    plc = machine(model, "LD M0\nEROMWR D6000 3", scan_ms=2)
    assert plc["SM196"] == 1
    plc["M0"] = 1
    plc.scan()
    assert plc["SM196"] == 0
    plc.scan(3)
    assert plc["SM196"] == 1


def bus_error(model, number):
    plc = machine(model)
    assert plc["SM190"] == 0
    plc.damage("main unit I/O")
    assert values(plc, "SM190", "SM0") == [1, 0]
    plc.repair("main unit I/O")
    plc.run()
    assert values(plc, "SM190", "SM0") == [0, 1]


def module_error(model, number):
    plc = machine(model, io=[(24, 16), (8, 8), (8, 8)])
    assert plc["SM191"] == 0
    plc.modules.digital[1].remove()
    assert plc["SM191"] == 1
    if model == "EC10":
        assert plc["SD191"] == 1
    plc.modules.digital[1].insert()
    assert plc["SM191"] == 0


def special_module_error(model, number):
    plc = machine(model, io=[(24, 16), "4AD", "4AD"])
    assert plc["SM192"] == 0
    plc.modules[1].remove()
    assert plc["SM192"] == 1
    if model == "EC10":
        assert plc["SD192"] == 1
    plc.modules[1].insert()
    assert plc["SM192"] == 0


def analog_inputs(model, number):
    """SM172 to SM175, SD172 to SD175: enabled, the kind of signal, the mean, how many samples it is of."""
    for channel in range(2):
        enable, current, mean, samples = f"SM{172 + channel}", f"SM{174 + channel}", f"SD{172 + 2 * channel}", f"SD{173 + 2 * channel}"
        plc = machine(model, f"LD M0\nOUT {enable}\nLD M1\nOUT {current}\nLD M2\nMOV D0 {samples}")
        assert plc[samples] == 8
        plc.analog.volts[channel] = 3
        plc.scan(2)
        assert plc[mean] == 0
        plc["M0"] = 1
        plc.scan(10)
        assert plc[mean] == 3000
        plc.analog.milliamperes[channel] = 10
        plc["M1"] = 1
        plc.scan()
        assert plc[mean] == 5000
        plc.scan(10)
        plc.set({"M2": 1, "D0": 2})
        plc.analog.milliamperes[channel] = 0
        plc.scan()
        assert plc[mean] == 2500


def analog_output(model, number):
    plc = machine(model, "LD M0\nOUT SM178\nLD SM0\nMOV D0 SD178")
    plc["D0"] = -2500
    plc.scan()
    assert plc.analog.output_volts == [0]
    plc["M0"] = 1
    plc.scan()
    assert plc.analog.output_volts == [-2.5]


def run(kind, first, last, check):
    return {f"{kind}{number}": check for number in range(first, last + 1)}


CHECKS = {
    "SM0": running, "SM1": first_scan, "SM2": power_up, "SM3": system_error, "SM4": battery, "SM5": mains, "SM6": dc24, "SM7": no_battery,
    "SM8": constant_scan, "SM9": run_input, **run("SM", 10, 14, square_wave), "SM15": scan_toggle,
    "SM20": execution_error, "SM21": out_of_range, "SM22": illegal_parameter,
    **run("SM", 40, 47, edge_interrupt), "SM56": power_loss_interrupt, **run("SM", 63, 64, pulses_done_interrupt), "SM65": counter_interrupt,
    **run("SM", 66, 68, timed_interrupt), **run("SM", 80, 81, pulse_stop), **run("SM", 82, 83, pulse_busy), "SM85": clear_signal,
    **run("SM", 90, 97, pulse_capture), **run("SM", 172, 175, analog_inputs), "SM178": analog_output,
    "SM180": zero_flag, "SM181": carry_flag, "SM182": borrow_flag, "SM185": table_of_states, "SM186": storage_of_asc,
    "SM190": bus_error, "SM191": module_error, "SM192": special_module_error, "SM193": clock_error, "SM196": eeprom_idle,
    **run("SM", 200, 235, counts_down), **run("SM", 236, 245, fast_counts_down), **run("SM", 246, 255, fast_direction),
    "SD0": kind, "SD1": version, "SD2": capacity, "SD3": system_error, "SD4": battery, "SD5": detection_time,
    **run("SD", 7, 8, count_of_modules), "SD9": run_input, **run("SD", 10, 11, count_of_points), "SD12": analog_points,
    **run("SD", 20, 24, record), "SD25": faulty_module, "SD26": faulty_group, **run("SD", 30, 32, scan_times), "SD33": constant_scan,
    "SD34": watchdog, "SD35": filter_constant, **run("SD", 50, 55, pulses_sent), **run("SD", 56, 57, segment),
    **run("SD", 66, 68, timed_interrupt), **run("SD", 80, 83, position), "SD84": base_frequency, **run("SD", 85, 86, top_frequency),
    "SD87": ramp_time, **run("SD", 100, 106, clock), **run("SD", 172, 175, analog_inputs), "SD178": analog_output,
    **run("SD", 180, 181, table_of_data), **run("SD", 182, 184, table_of_states), "SD191": module_error, "SD192": special_module_error,
}  # fmt: skip
