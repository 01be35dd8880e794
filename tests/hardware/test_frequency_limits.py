"""Every frequency limit of the manual (6.10.8, 8.1.4, 8.2, 9.4): silent at the limit, said in words above it."""

import pytest

from ecsim import Plc

# program, (input, Hz) with which nothing is said, (input, Hz) with which the words come
ROWS = {
    "hardware, single": ("HCNT C236 0", {"X0": 50_000}, {"X0": 50_001}, "C236 gets 50.001 kHz, it counts up to 50 kHz (manual 8.1.4)"),
    "hardware, up and down": ("HCNT C246 0", {"X1": 50_000}, {"X1": 50_500}, "C246 gets 50.5 kHz, it counts up to 50 kHz (manual 8.1.4)"),
    "software, single": ("HCNT C238 0", {"X2": 10_000}, {"X2": 10_001}, "C238 gets 10.001 kHz, it counts up to 10 kHz (manual 8.1.4)"),
    "software, up and down": ("HCNT C250 0", {"X4": 10_000}, {"X4": 11_000}, "C250 gets 11 kHz, it counts up to 10 kHz (manual 8.1.4)"),
    "compared, single": (
        "HCNT C236 0\nDHSCS 5 C236 M0", {"X0": 10_000}, {"X0": 10_500}, "C236 gets 10.5 kHz, it counts up to 10 kHz (manual 8.1.4)"),
    "DHSCR": ("HCNT C236 0\nDHSCR 5 C236 M0", {"X0": 10_000}, {"X0": 12_000}, "C236 gets 12 kHz, it counts up to 10 kHz (manual 8.1.4)"),
    "DHSCI": ("HCNT C236 0\nDHSCI 5 C236 20", {"X0": 10_000}, {"X0": 12_000}, "C236 gets 12 kHz, it counts up to 10 kHz (manual 8.1.4)"),
    "DHST": ("HCNT C236 0\nDHST D0 1 C236", {"X0": 10_000}, {"X0": 12_000}, "C236 gets 12 kHz, it counts up to 10 kHz (manual 8.1.4)"),
    "DHSP": ("HCNT C236 0\nDHSP D0 1 C236", {"X0": 10_000}, {"X0": 12_000}, "C236 gets 12 kHz, it counts up to 10 kHz (manual 8.1.4)"),
    "zone, single": (
        "HCNT C236 0\nDHSZ 1 2 C236 M0", {"X0": 5_000}, {"X0": 5_500}, "C236 gets 5.5 kHz, it counts up to 5 kHz (manual 8.1.4)"),
    "sum": (
        "HCNT C236 0\nHCNT C237 0", {"X0": 50_000, "X1": 30_000}, {"X1": 31_000},
        "the counters get 81 kHz together, 80 kHz are allowed (manual 8.1.4)"),
    "sum with a comparison": (
        "HCNT C236 0\nHCNT C237 0\nDHSCS 5 C237 M0", {"X0": 20_000, "X1": 10_000}, {"X0": 21_000},
        "the counters get 31 kHz together, 30 kHz are allowed (manual 8.1.4)"),
    "sum with a zone": (
        "HCNT C236 0\nHCNT C237 0\nDHSZ 1 2 C237 M0\nDHSCS 5 C236 M9", {"X0": 10_000, "X1": 5_000, "X2": 90_000}, {"X0": 18_000},
        "the counters get 23 kHz together, 20 kHz are allowed (manual 8.1.4)"),
    "sum with SPD": (
        "HCNT C236 0\nHCNT C237 0\nSPD X3 100 D0", {"X0": 50_000, "X1": 20_000, "X3": 10_000}, {"X1": 22_000},
        "the counters and SPD get 82 kHz together, 80 kHz are allowed (manual 8.1.4)"),
    "SPD": ("SPD X3 100 D0", {"X3": 10_000}, {"X3": 10_001}, "SPD gets 10.001 kHz on X3, it measures up to 10 kHz (manual 6.10.8)"),
    "pulse capture": (
        "AND SM97\nOUT Y0", {"X0": 40_000, "X7": 40_000}, {"X7": 41_000}, "X0 to X7 get 81 kHz together, pulse capture allows 80 kHz (manual 8.2)"),
}  # fmt: skip


def machine(program, routines=()):
    plc = Plc("EC20")
    text = f"PROGRAM MAIN\nLD SM0\n{program}\nEND_PROGRAM\n"
    plc.load(text + "\n".join(f"INTERRUPT I{event} EVENT {event}\nLD SM0\nINC D9\nEND_INTERRUPT" for event in routines))
    plc.run()
    plc.scan()
    return plc


@pytest.mark.parametrize("row", ROWS)
def test_a_frequency_is_reported_when_it_exceeds_its_limit(row):
    program, fine, fast, words = ROWS[row]
    plc = machine(program)
    for name, hertz in fine.items():
        plc.square(name, hz=hertz)
    assert plc.warnings == []
    for name, hertz in fast.items():
        plc.square(name, hz=hertz)
    assert words in plc.warnings


@pytest.mark.parametrize(
    ("number", "program", "khz"),
    [(251, "", 30), (252, "", 5), (251, "DHSCS 5 C251 M0", 5), (251, "DHSZ 1 2 C251 M0", 4)],
)
def test_phases_have_limits_of_their_own(number, program, khz):
    plc = machine(f"HCNT C{number} 0\n{program}")
    plc.quadrature("X0", "X1", count=khz * 1000, ms=1000)
    assert plc.warnings == []
    plc.quadrature("X0", "X1", count=khz * 1000 + 500, ms=1000)
    assert plc.warnings == [f"C{number} gets {khz + 0.5:g} kHz, it counts up to {khz} kHz (manual 8.1.4)"]


def test_inputs_that_ask_for_interrupts_have_limits():
    plc = machine("EI\nSET SM40", routines=range(6))
    for number in range(5):
        plc.square(f"X{number}", hz=200)
    assert plc.warnings == []
    plc.square("X5", hz=10)
    assert plc.warnings == ["the inputs ask for interrupts with 1010 Hz together, up to 1000 Hz are allowed (manual 9.4)"]
    plc.square("X5", hz=250)
    assert "X5 asks for interrupts with 250 Hz, up to 200 Hz are allowed (manual 9.4)" in plc.warnings


def test_a_signal_is_held_against_what_begins_later():
    plc = Plc("EC20")
    plc.load("LD M0\nHCNT C238 0\nLD M1\nSPD X3 100 D0\nLD M2\nDHSZ 1 2 C238 M10")
    plc.run()
    plc.square("X2", hz=8_000)
    plc.square("X3", hz=12_000)
    plc.set({"M0": 1})
    plc.scan(2)
    assert plc.warnings == []
    plc.set({"M1": 1, "M2": 1})
    plc.scan()
    assert plc.warnings == [
        "SPD gets 12 kHz on X3, it measures up to 10 kHz (manual 6.10.8)",
        "C238 gets 8 kHz, it counts up to 5 kHz (manual 8.1.4)",
    ]


def test_a_wired_output_is_looked_at_when_its_pulses_begin_and_change():
    plc = Plc("EC20")
    plc.load("LD SM0\nHCNT C238 0\nLD M0\nPLSY D0 0 Y0")
    plc.run()
    plc.wire("Y0", "X2")
    plc.set({"D1": 9_000, "M0": 1})
    plc.scan(2)
    assert plc.warnings == []
    plc["D1"] = 11_000
    plc.scan(2)
    assert plc.warnings == ["C238 gets 11 kHz, it counts up to 10 kHz (manual 8.1.4)"]


def test_warnings_go_with_run_and_come_back_with_a_snapshot():
    plc = machine("HCNT C238 0")
    plc.square("X2", hz=12_000)
    kept = plc.snapshot()
    assert len(plc.warnings) == 1
    plc.stop()
    plc["X2"] = 0
    plc.run()
    plc.scan()
    assert plc.warnings == []
    plc.restore(kept)
    assert len(plc.warnings) == 1


def test_what_is_too_fast_is_counted_all_the_same():
    plc = machine("HCNT C238 0")
    plc.pulse("X2", count=500, ms=10)
    plc.scan()
    assert plc["C238"] == 500
    assert plc.warnings == ["C238 gets 50 kHz, it counts up to 10 kHz (manual 8.1.4)"]


def test_six_comparisons_work_at_one_time_and_one_table():
    six = "\n".join(f"DHSCS {n} C236 M{n}" for n in range(1, 8))
    plc = machine(f"HCNT C236 0\n{six}")
    plc.pulse("X0", count=10, ms=5)
    plc.scan()
    assert [plc[f"M{n}"] for n in range(1, 8)] == [1, 1, 1, 1, 1, 1, 0]
    plc = machine("HCNT C236 0\nDHST D0 1 C236\nDHST D4 1 C236")
    plc.set({"D0:DINT": 2, "D2": 2, "D3": 1, "D4:DINT": 2, "D6": 3, "D7": 1})
    plc.pulse("X0", count=3, ms=5)
    plc.scan()
    assert (plc["Y2"], plc["Y3"]) == (1, 0)
