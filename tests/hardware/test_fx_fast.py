"""High-speed counters, interrupts by label, pulse catch and the filter of H1U and H2U (manual 3.6, 3.8)."""

import pytest

import ecsim
from ecsim.hardware.counters import Comparison
from ecsim.models import get_model

both_models = pytest.mark.parametrize("model", ["H1U", "H2U"])


def machine(text, model="H2U", **settings):
    """A PLC in RUN with a program, inputs without filter."""
    plc = ecsim.Plc(model, **{"input_filter_ms": 0} | settings)
    plc.load(text)
    plc.run()
    return plc


def values(plc, *names):
    return [plc[name] for name in names]


# -- counters -----------------------------------------------------------------------------------------------------------------

# counter -> inputs that count, reset, start
TABLE = {
    235: ((0,), None, None), 236: ((1,), None, None), 237: ((2,), None, None), 238: ((3,), None, None), 239: ((4,), None, None),
    240: ((5,), None, None), 241: ((0,), 1, None), 242: ((2,), 3, None), 243: ((4,), 5, None), 244: ((0,), 1, 6), 245: ((2,), 3, 7),
    246: ((0, 1), None, None), 247: ((0, 1), 2, None), 248: ((3, 4), 5, None), 249: ((0, 1), 2, 6), 250: ((3, 4), 5, 7),
    251: ((0, 1), None, None), 252: ((0, 1), 2, None), 253: ((3, 4), 5, None), 254: ((0, 1), 2, 6), 255: ((3, 4), 5, 7),
}  # fmt: skip


def test_the_inputs_of_the_counters_are_those_of_the_table():
    counters = get_model("H2U").fast_counters
    assert {number: (each.inputs, each.reset, each.start) for number, each in counters.items()} == TABLE


@both_models
@pytest.mark.parametrize("number", [number for number in TABLE if number < 246])
def test_a_counter_of_one_phase_counts_as_its_direction_relay_says(model, number):
    (source,), reset, start = TABLE[number]
    plc = machine(f"LD M8000\nOUT C{number} K5\nLD X20\nOUT M{8000 + number}", model)
    plc.scan()
    if start is not None:
        plc.pulse(f"X{source}", 4, ms=10)
        plc.scan(2)
        assert plc[f"C{number}"] == 0
        plc[f"X{start}"] = 1
    plc.pulse(f"X{source}", 7, ms=10)
    plc.scan(2)
    assert values(plc, f"C{number}", f"C{number}:BOOL") == [7, 1]
    plc["X20"] = 1
    plc.scan()
    plc.pulse(f"X{source}", 3, ms=10)
    plc.scan(2)
    assert values(plc, f"C{number}", f"C{number}:BOOL") == [4, 0]
    if reset is not None:
        plc[f"X{reset}"] = 1
        assert plc[f"C{number}"] == 0


@pytest.mark.parametrize("number", range(246, 251))
def test_a_counter_with_two_inputs_shows_its_direction(number):
    (up, down), reset, start = TABLE[number]
    plc = machine(f"LD M8000\nOUT C{number} K-100")
    plc.scan()
    if start is not None:
        plc[f"X{start}"] = 1
    plc.pulse(f"X{up}", 5, ms=10)
    plc.scan(2)
    assert values(plc, f"C{number}", f"M{8000 + number}") == [5, 0]
    plc.pulse(f"X{down}", 8, ms=10)
    plc.scan(2)
    assert values(plc, f"C{number}", f"M{8000 + number}") == [-3, 1]
    if reset is not None:
        plc[f"X{reset}"] = 1
        assert plc[f"C{number}"] == 0


@pytest.mark.parametrize("number", range(251, 256))
def test_phases_count_once_a_cycle_or_with_each_edge(number):
    (a, b), _, start = TABLE[number]
    plc = machine(f"LD M8000\nOUT C{number} K1000\nLD X20\nOUT M{8195 + number - 251}")
    plc.scan()
    if start is not None:
        plc[f"X{start}"] = 1
    plc.quadrature(f"X{a}", f"X{b}", 10, 1, ms=10)
    plc.scan(2)
    assert values(plc, f"C{number}", f"M{8000 + number}") == [10, 0]
    plc["X20"] = 1
    plc.scan()
    plc.quadrature(f"X{a}", f"X{b}", 10, 1, ms=10)
    plc.scan(2)
    assert plc[f"C{number}"] == 50
    plc.quadrature(f"X{a}", f"X{b}", 5, -1, ms=10)
    plc.scan(2)
    assert values(plc, f"C{number}", f"M{8000 + number}") == [30, 1]


@pytest.mark.parametrize(
    ("edges", "once", "fourfold"),
    [
        ("A1", 0, 1), ("A1 B1", 1, 2), ("A1 B1 A0", 1, 3), ("A1 B1 A0 B0", 1, 4), ("A1 B1 B0", 0, 1), ("A1 A0 A1 A0", 0, 0),
        ("B1", 0, -1), ("B1 A1", 0, -2), ("B1 A1 B0", -1, -3), ("B1 A1 B0 A0", -1, -4), ("B1 B0", 0, 0),
    ],
)  # fmt: skip
@pytest.mark.parametrize("by_signal", [False, True])
def test_each_edge_of_two_phases(edges, once, fourfold, by_signal):
    for relay, expected in ((0, once), (1, fourfold)):
        plc = machine("LD M8000\nOUT C251 K1000\nLD X20\nOUT M8195")
        plc["X20"] = relay
        plc.scan(2)
        if by_signal:
            changes = {"A": [], "B": []}
            for place, edge in enumerate(edges.split()):
                changes[edge[0]].append((place + 1, int(edge[1])))
            plc.signal("X0", changes["A"])
            plc.signal("X1", changes["B"])
        else:
            for edge in edges.split():
                plc["X0" if edge[0] == "A" else "X1"] = int(edge[1])
        plc.scan(2)
        assert plc["C251"] == expected


@pytest.mark.parametrize(
    "other",
    ["OUT C241 K1", "OUT C244 K1", "OUT C246 K1", "OUT C247 K1", "OUT C249 K1", "OUT C251 K1", "OUT C252 K1", "OUT C254 K1", "OUT M8170"],
)
def test_what_shares_an_input_with_c235_is_refused(other):
    with pytest.raises(ecsim.ProgramError, match="X0 serves OUT C235"):
        ecsim.compile(f"LD M8000\nOUT C235 K1\n{other}", "H2U")


@pytest.mark.parametrize("label", ["I0", "I1"])
def test_an_interrupt_shares_no_input_with_a_counter(label):
    with pytest.raises(ecsim.ProgramError, match="X0 serves OUT C235"):
        ecsim.compile(f"LD M8000\nEI\nOUT C235 K1\nFEND\n{label}\nLD M8000\nINC D0\nIRET", "H2U")


def test_an_input_takes_one_of_its_two_labels():
    with pytest.raises(ecsim.ProgramError, match="X1 serves the interrupt event 100"):
        ecsim.compile("EI\nFEND\nI100\nLD M8000\nINC D0\nIRET\nI101\nLD M8000\nINC D1\nIRET", "H2U")


# -- interrupts -----------------------------------------------------------------------------------------------------------------


def routine(label, main="LD M8000\nEI"):
    return f"{main}\nFEND\n{label}\nLD M8000\nINC D0\nIRET"


@both_models
@pytest.mark.parametrize("number", range(6))
@pytest.mark.parametrize("rising", [0, 1])
def test_the_edges_of_x0_to_x5_have_labels_and_masks_that_forbid(model, number, rising):
    plc = machine(routine(f"I{number}0{rising}", f"LD M8000\nEI\nLD X20\nOUT M{8050 + number}"), model)
    plc.scan()
    plc[f"X{number}"] = 1
    plc.scan()
    assert plc["D0"] == rising
    plc[f"X{number}"] = 0
    plc.scan()
    assert plc["D0"] == 1
    plc["X20"] = 1
    plc.scan()
    plc[f"X{number}"] = 1
    plc.scan()
    plc[f"X{number}"] = 0
    plc.scan()
    assert plc["D0"] == 1


def test_nothing_interrupts_before_ei_and_after_di():
    plc = machine("LD X20\nEI\nLDI X20\nDI\nFEND\nI001\nLD M8000\nINC D0\nIRET")
    for allowed, expected in ((0, 0), (1, 1), (0, 1)):
        plc["X20"] = allowed
        plc.scan()
        plc["X0"] = 1
        plc.scan()
        plc["X0"] = 0
        plc.scan()
        assert plc["D0"] == expected


@pytest.mark.parametrize(("label", "mask"), [("I610", 8056), ("I725", 8057), ("I899", 8058), ("I601", 8056)])
def test_a_timer_interrupt_comes_every_xx_ms(label, mask):
    plc = machine(routine(label, f"LD M8000\nEI\nLD X20\nOUT M{mask}"))
    period = int(label[2:])
    plc.advance(ms=990)
    assert plc["D0"] == 990 // period
    plc["X20"] = 1
    plc.scan()
    counted = plc["D0"]
    plc.advance(ms=500)
    assert plc["D0"] == counted


def test_timer_interrupts_are_h2u_s_alone():
    with pytest.raises(ecsim.ProgramError, match="H1U has no interrupt event 610"):
        ecsim.compile(routine("I610"), "H1U")


@pytest.mark.parametrize("label", ["I600", "I900", "I507", "I530"])
def test_labels_without_a_known_relay_are_refused(label):
    with pytest.raises(ecsim.ProgramError, match=f"H2U has no interrupt event {label[1:]}"):
        ecsim.compile(routine(label), "H2U")


@both_models
@pytest.mark.parametrize("label", ["I010", "I020", "I030", "I040", "I050", "I060"])
def test_a_match_of_a_counter_asks_for_its_label_unless_m8059_forbids(model, label):
    plc = machine(routine(label, "LD M8000\nEI\nOUT C235 K1000\nLD X20\nOUT M8059"), model)
    plc.scan()
    plc.counters.compare(-1, Comparison("event", 235, 3, event=int(label[1:])))
    plc.pulse("X0", 5, ms=10)
    plc.scan(2)
    assert plc["D0"] == 1
    plc.memory.lists["C"][235] = 0
    plc["X20"] = 1
    plc.scan()
    plc.pulse("X0", 5, ms=10)
    plc.scan(2)
    assert plc["D0"] == 1


@pytest.mark.parametrize("output", range(5))
def test_the_end_of_pulses_asks_for_its_label_while_its_relay_is_on(output):
    plc = machine(routine(f"I{502 + output}", f"LD M8000\nEI\nLD X20\nOUT M{8090 + output}\nLD X21\nPLSY K1000 K3 Y{output}"))
    plc["X21"] = 1
    plc.scan(3)
    assert plc["D0"] == 0
    plc.set({"X20": 1, "X21": 0})
    plc.scan()
    plc["X21"] = 1
    plc.scan(3)
    assert plc["D0"] == 1


# -- pulse catch and filter -------------------------------------------------------------------------------------------------------


@both_models
@pytest.mark.parametrize("number", range(6))
def test_after_ei_a_short_pulse_is_caught_whatever_the_masks_say(model, number):
    plc = machine(f"LD X20\nEI\nLD M8000\nOUT M{8050 + number}\nLD M{8170 + number}\nINC D0\nLD X21\nRST M{8170 + number}", model)
    plc.scan()
    plc.pulse(f"X{number}", 1, ms=2)
    plc.scan(2)
    assert values(plc, f"M{8170 + number}", "D0") == [0, 0]
    plc["X20"] = 1
    plc.scan()
    plc.pulse(f"X{number}", 1, ms=2)
    plc.scan(2)
    assert plc[f"M{8170 + number}"] == 1
    plc["X21"] = 1
    plc.scan()
    assert plc[f"M{8170 + number}"] == 0


def test_x6_and_x7_catch_nothing():
    plc = machine("LD M8000\nEI")
    plc.scan()
    for name in ("X6", "X7"):
        plc.pulse(name, 1, ms=2)
    plc.scan(2)
    assert values(plc, "M8176", "M8177") == [0, 0]


def test_the_filter_is_10_ms_and_used_inputs_go_without_it():
    plc = machine("LD M8000\nOUT C235 K1\nLD X7\nOUT Y7", input_filter_ms=None, scan_ms=1)
    plc.scan()
    plc.pulse("X0", 20, ms=2)
    plc["X7"] = 1
    plc.scan(9)
    assert values(plc, "C235", "X7") == [20, 0]
    plc.scan(2)
    assert plc["X7"] == 1
    assert plc["D8020"] == 10


def test_an_extension_goes_on_with_the_next_ten():
    plc = ecsim.Plc("H2U", io=[(24, 16), (8, 8)])
    plc["X30"] = 1
    assert plc.modules.digital[0].first == {"X": 0o30, "Y": 0o20}
    with pytest.raises(ecsim.EcsimError):
        plc["X40"] = 1
    small = ecsim.Plc("H2U", io=[(36, 24), (8, 8)])
    assert small.modules.digital[0].first == {"X": 0o50, "Y": 0o30}  # 36 inputs end at X43


def test_x_and_y_are_256_together():
    plc = ecsim.Plc("H2U", io=(64, 64))
    plc.modules.add((64, 64))
    with pytest.raises(ecsim.EcsimError, match="H2U has at most 256 points"):
        plc.modules.add((8, 8))
