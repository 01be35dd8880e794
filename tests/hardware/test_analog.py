"""Analog channels: of EC10's base unit by relays and registers, and of the analog modules by their buffers (docs/modules.md).

Expected numbers are straight lines through two points, worked out by hand.
"""

import pytest

import ecsim
from ecsim.hardware.analog import Mean

SAMPLE_MS = 10


def refused(call, *words):
    """The message of an EcsimError that names all these words."""
    with pytest.raises(ecsim.EcsimError) as error:
        call()
    for word in words:
        assert word in str(error.value)


# -- EC10's own channels ------------------------------------------------------------------------------------------


@pytest.fixture
def unit():
    """An EC10 with analog channels in RUN; SM172 ... follow M0 ..."""
    plc = ecsim.Plc("EC10", io=(16, 14))
    plc.load(
        "LD M0\nOUT SM172\nLD M1\nOUT SM173\nLD M4\nOUT SM174\nLD M5\nOUT SM175\nLD M8\nOUT SM178\nLD M9\nMOV D0 SD173\nLD M9\nMOV D1 SD178"
    )
    plc.run()
    return plc


@pytest.mark.parametrize(
    ("volts", "number"), [(10, 10000), (-10, -10000), (0, 0), (2.5, 2500), (-0.0005, 0), (0.0005, 1), (11, 10000), (-30, -10000)]
)
def test_volts_become_a_number(unit, volts, number):
    unit["M0"] = 1
    unit.analog.volts[0] = volts
    unit.scan(2)
    assert unit["SD172"] == number


@pytest.mark.parametrize(("milliamperes", "number"), [(20, 10000), (-20, -10000), (4, 2000), (12, 6000), (25, 10000)])
def test_milliamperes_become_a_number(unit, milliamperes, number):
    unit.set({"M1": 1, "M5": 1})
    unit.analog.milliamperes[1] = milliamperes
    unit.scan(2)
    assert unit["SD174"] == number


def test_a_channel_takes_samples_only_while_it_is_enabled(unit):
    unit.analog.volts[0] = 5
    unit.scan(3)
    assert unit["SD172"] == 0
    unit["M0"] = 1
    unit.scan(2)
    assert unit["SD172"] == 5000
    unit["M0"] = 0
    unit.analog.volts[0] = 1
    unit.scan(20)
    assert unit["SD172"] == 5000
    unit["M0"] = 1  # the mean begins anew
    unit.scan()
    assert unit["SD172"] == 1000


def test_the_mean_is_taken_of_eight_samples_unless_a_register_says_otherwise(unit):
    assert (unit["SD173"], unit["SD175"]) == (8, 8)
    unit["M0"] = 1
    unit.analog.volts[0] = 0
    unit.scan(10)
    unit.analog.volts[0] = 8
    means = []
    for _ in range(9):
        unit.scan()
        means.append(unit["SD172"])
    assert means == [1000, 2000, 3000, 4000, 5000, 6000, 7000, 8000, 8000]
    unit.set({"M9": 1, "D0": 2})
    unit.analog.volts[0] = 0
    unit.scan()
    assert unit["SD172"] == 4000
    unit.scan()
    assert unit["SD172"] == 0


@pytest.mark.parametrize(("asked", "taken"), [(0, 1), (-5, 1), (1, 1), (4, 4), (2000, 1000)])
def test_the_number_of_samples_lies_between_1_and_1000(unit, asked, taken):
    unit.set({"M0": 1, "M9": 1, "D0": asked})
    unit.analog.volts[0] = 0
    unit.advance(ms=10_010)
    unit.analog.volts[0] = 10
    unit.scan()
    assert unit["SD172"] == 10000 // taken


def test_samples_are_taken_by_time_and_not_by_scans():
    plc = ecsim.Plc("EC10", scan_ms=1)
    plc.load("LD SM0\nSET SM172")
    plc.run()
    plc.analog.volts[0] = 0
    plc.advance(ms=100)
    plc.analog.volts[0] = 8
    plc.advance(ms=2 * SAMPLE_MS)
    assert plc["SD172"] == 2000


def test_another_kind_of_signal_reads_as_none(unit):
    unit.set({"M0": 1, "M4": 1})
    unit.analog.volts[0] = 5
    unit.scan(2)
    assert unit["SD172"] == 0
    assert (unit.analog.volts[0], unit.analog.milliamperes[0]) == (5, None)
    unit["M4"] = 0
    unit.scan()
    assert unit["SD172"] == 5000


@pytest.mark.parametrize(("number", "volts"), [(10000, 10), (-10000, -10), (0, 0), (1234, 1.234), (32767, 10), (-32768, -10)])
def test_a_number_becomes_volts_while_the_output_is_enabled(unit, number, volts):
    unit.set({"M8": 1, "M9": 1, "D1": number})
    unit.scan()
    assert unit.analog.output_volts == [pytest.approx(volts)]
    unit["M8"] = 0
    unit.scan()
    assert unit.analog.output_volts == [0]


def test_run_begins_with_the_channels_disabled(unit):
    unit.set({"M0": 1, "M8": 1, "M9": 1, "D0": 100, "D1": 5000})
    unit.analog.volts[0] = 3
    unit.scan(2)
    unit.stop()
    assert unit["SD172"] == 3000
    unit.run()
    assert [unit[name] for name in ("SM172", "SM178", "SD172", "SD173", "SD178")] == [0, 0, 0, 8, 0]
    assert unit.analog.volts[0] == 3  # the wiring stays
    assert unit.analog.output_volts == [0]


@pytest.mark.parametrize("plc", [ecsim.Plc("EC20"), ecsim.Plc("EC10", io=(24, 16))], ids=["EC20", "EC10 24/16"])
def test_other_units_have_no_analog_channels(plc):
    refused(lambda: plc.analog.volts, "no analog channels", "16 inputs and 14 outputs")
    refused(lambda: plc.analog.output_volts, "no analog channels")


@pytest.mark.parametrize("value", ["5", float("nan"), float("inf"), True])
def test_a_signal_is_a_number(unit, value):
    refused(lambda: unit.analog.volts.__setitem__(0, value), "a number of volts")


@pytest.mark.parametrize("channel", [2, -1, "0", True])
def test_a_channel_is_one_that_is_there(unit, channel):
    refused(lambda: unit.analog.volts.__setitem__(channel, 1), "no channel", "there are 2, counted from 0")


def test_a_snapshot_holds_signals_and_samples(unit):
    unit["M0"] = 1
    unit.analog.volts[0] = 8
    unit.scan(4)
    before = unit.snapshot()

    def on():
        unit.analog.volts[0] = 0
        found = []
        for _ in range(9):
            unit.scan()
            found.append(unit["SD172"])
        return found

    first = on()
    unit.restore(before)
    assert unit.analog.volts[0] == 8
    assert on() == first


def test_the_mean_rounds_halves_up():
    mean = Mean()
    assert mean.value == 0
    for number in (1, 2):
        mean.take(number, 1, 1000)
    assert mean.value == 2
    mean.take(-6, 1, 2)  # -6 and 2
    assert mean.value == -2
    mean.take(-5, 1, 2)  # -5.5
    assert mean.value == -5


# -- modules ------------------------------------------------------------------------------------------------------

MEAN, PRESENT, SAMPLES, MODE, ZERO, FULL, STATUS, CODE = 0, 4, 8, 12, 16, 20, 24, 25


def moved(kind, **signals):
    """A module of a PLC in STOP, after one sample of the given signals on channel 0."""
    plc = ecsim.Plc("EC20")
    module = plc.modules.add(kind)
    for face, value in signals.items():
        getattr(module, face)[0] = value
    plc.advance(ms=SAMPLE_MS)
    return module


@pytest.mark.parametrize(
    ("mode", "face", "signal", "number", "beyond"),
    [
        (0, "volts", 10, 10000, 0), (0, "volts", -10, -10000, 0), (0, "volts", 10.01, 10000, 1), (0, "volts", 1, 1000, 0),
        (1, "volts", 5, 10000, 0), (1, "volts", -2.5, -5000, 0), (1, "volts", -6, -10000, 1),
        (2, "milliamperes", 20, 10000, 0), (2, "milliamperes", -10, -5000, 0),
        (3, "milliamperes", 4, 0, 0), (3, "milliamperes", 12, 5000, 0), (3, "milliamperes", 3.9, 0, 1), (3, "milliamperes", None, 0, 1),
        (0, "volts", None, 0, 0), (0, "milliamperes", 5, 0, 1),
    ],
)  # fmt: skip
def test_the_modes_of_an_analog_input(mode, face, signal, number, beyond):
    plc = ecsim.Plc("EC20")
    module = plc.modules.add("4AD")
    module.write(MODE, [mode])
    getattr(module, face)[0] = signal
    plc.advance(ms=SAMPLE_MS)
    assert module.read(MEAN, 1) + module.read(PRESENT, 1) == [number, number]
    assert module.read(STATUS, 1) == [beyond]


@pytest.mark.parametrize(
    ("kind", "mode", "degrees", "number", "beyond"),
    [
        ("4PT", 0, 25.04, 250, 0), ("4PT", 0, -150, -1500, 0), ("4PT", 0, 700, 6000, 1), ("4PT", 1, 120, 1200, 0), ("4PT", 0, None, 6000, 1),
        ("4TC", 0, 1200, 12000, 0), ("4TC", 0, -100, -1000, 0), ("4TC", 4, 400, 4000, 0), ("4TC", 4, 401, 4000, 1), ("4TC", 5, 1600, 16000, 0),
        ("4TC", 0, None, 12000, 1),
    ],
)  # fmt: skip
def test_temperatures_are_read_in_tenths_of_a_degree(kind, mode, degrees, number, beyond):
    plc = ecsim.Plc("EC20")
    module = plc.modules.add(kind)
    module.write(MODE, [mode])
    module.degrees[0] = degrees
    plc.advance(ms=SAMPLE_MS)
    assert (module.read(MEAN, 1), module.read(STATUS, 1)[0] & 1) == ([number], beyond)


def test_zero_and_full_scale_are_the_numbers_of_the_origin_and_the_end():
    plc = ecsim.Plc("EC20")
    module = plc.modules.add("4AD")
    module.write(MODE, [3, 3])
    module.write(ZERO, [100])
    module.write(FULL, [500])
    module.milliamperes[0] = 12  # half of 4 to 20 mA
    module.milliamperes[1] = 12
    plc.advance(ms=SAMPLE_MS)
    assert module.read(MEAN, 2) == [300, 5000]


def test_another_mode_brings_its_own_zero_and_full_scale():
    module = moved("4TC", degrees=20)
    module.write(ZERO, [5])
    module.write(FULL, [6])
    module.write(MODE, [5])
    assert module.read(ZERO, 1) + module.read(FULL, 1) == [0, 16000]


def test_the_mean_of_the_asked_number_of_samples():
    plc = ecsim.Plc("EC20")
    module = plc.modules.add("4AD")
    assert module.read(SAMPLES, 4) == [8] * 4
    module.write(SAMPLES, [4])
    module.volts[0] = 0
    plc.advance(ms=100)
    module.volts[0] = 4
    found = []
    for _ in range(5):
        plc.advance(ms=SAMPLE_MS)
        found.append((module.read(MEAN, 1)[0], module.read(PRESENT, 1)[0]))
    assert found == [(1000, 4000), (2000, 4000), (3000, 4000), (4000, 4000), (4000, 4000)]


@pytest.mark.parametrize(("buffer", "value"), [(SAMPLES, 0), (SAMPLES, 1001), (MODE, 4), (MODE, -2), (FULL, 0)])
def test_a_channel_whose_settings_make_no_sense_rests_and_the_status_tells_of_it(buffer, value):
    plc = ecsim.Plc("EC20")
    module = plc.modules.add("4AD")
    module.volts[0] = module.volts[1] = 1
    plc.advance(ms=SAMPLE_MS)
    good = module.read(buffer, 1)
    module.write(buffer, [value])
    module.volts[0] = module.volts[1] = 2
    plc.advance(ms=20 * SAMPLE_MS)
    assert module.read(MEAN, 2) == [1000, 2000]
    assert (module.read(buffer, 1), module.read(STATUS, 1)) == ([value], [1 << 8])
    module.write(buffer, good)
    plc.advance(ms=SAMPLE_MS)
    assert (module.read(MEAN, 1), module.read(STATUS, 1)) == ([2000], [0])


def test_a_channel_that_is_off_reads_0():
    plc = ecsim.Plc("EC20")
    module = plc.modules.add("4TC")
    plc.advance(ms=SAMPLE_MS)
    assert (module.read(MEAN, 1), module.read(STATUS, 1)) == ([12000], [0b1111])  # no sensor
    module.write(MODE, [-1])
    plc.advance(ms=SAMPLE_MS)
    assert (module.read(MEAN, 1), module.read(STATUS, 1)) == ([0], [0b1110])


def test_what_the_module_itself_writes_cannot_be_written():
    module = moved("4AD", volts=1)
    module.write(MEAN, [9] * 8)
    module.write(STATUS, [9, 9])
    assert (module.read(MEAN, 1), module.read(PRESENT, 1), module.read(STATUS, 2)) == ([1000], [1000], [0, 1])


@pytest.mark.parametrize(
    ("kind", "code", "buffers"), [("4AD", 1, 26), ("4DA", 2, 26), ("4PT", 3, 26), ("4TC", 4, 26), ("8AD", 5, 50), ("8TC", 6, 50)]
)
def test_each_kind_has_its_code_behind_its_channels(kind, code, buffers):
    module = moved(kind)
    assert (len(module.buffers), module.read(buffers - 1, 1)) == (buffers, [code])


@pytest.mark.parametrize(
    ("mode", "number", "volts", "milliamperes", "beyond"),
    [
        (0, 2500, 2.5, 0, 0), (0, -10000, -10, 0, 0), (0, 10001, 10, 0, 1),
        (1, 5000, 0, 10, 0), (1, -1, 0, 0, 1), (2, 0, 0, 4, 0), (2, 10000, 0, 20, 0), (2, 5000, 0, 12, 0), (-1, 5000, 0, 0, 0),
    ],
)  # fmt: skip
def test_the_modes_of_an_analog_output(mode, number, volts, milliamperes, beyond):
    module = ecsim.Plc("EC20").modules.add("4DA")
    module.write(MODE + 1, [mode])
    module.write(MEAN + 1, [number])
    assert module.output_volts == [0, volts, 0, 0]
    assert module.output_milliamperes == [0, milliamperes, 0, 0]
    assert module.read(STATUS, 1) == [beyond << 1]


def test_an_output_scales_by_zero_and_full_scale():
    module = ecsim.Plc("EC20").modules.add("4DA")
    module.write(ZERO, [0])
    module.write(FULL, [4000])
    module.write(MEAN, [1000])
    assert module.output_volts[0] == 2.5
    assert module.read(PRESENT, 1) == [1000]


def test_a_module_that_was_removed_gives_nothing_out():
    module = ecsim.Plc("EC20").modules.add("4DA")
    module.write(MEAN, [1000])
    module.remove()
    assert module.output_volts[0] == 0
    module.insert()
    assert module.output_volts[0] == 1


def test_without_power_nothing_is_given_out(unit):
    plc = ecsim.Plc("EC20")
    module = plc.modules.add("4DA")
    module.write(MEAN, [1000])
    plc.power_off()
    assert module.output_volts[0] == 0
    unit.set({"M8": 1, "M9": 1, "D1": 1000})
    unit.scan()
    unit.power_off()
    assert unit.analog.output_volts == [0]


def test_power_up_brings_the_factory_settings():
    plc = ecsim.Plc("EC20")
    module = plc.modules.add("4AD")
    module.write(MODE, [3, -1])
    module.write(SAMPLES, [100])
    module.volts[0] = 2
    plc.power_cycle()
    assert (module.read(MODE, 2), module.read(SAMPLES, 1), module.volts[0]) == ([0, 0], [8], 2)


def test_faces_that_a_module_has_not_are_refused():
    plc = ecsim.Plc("EC20")
    module, output, sensor = plc.modules.add("4AD"), plc.modules.add("4DA"), plc.modules.add("4PT")
    refused(lambda: module.degrees, "a 4AD has no input for degrees", "volts")
    refused(lambda: sensor.volts, "a 4PT has no input for volts", "degrees")
    refused(lambda: output.volts, "a 4DA has no input for volts")
    refused(lambda: module.output_volts, "a 4AD has no outputs")
    assert sensor.degrees[3] is None


def test_a_program_sets_a_module_up_and_reads_it():
    plc = ecsim.Plc("EC20", io=[(24, 16), "4AD", "4DA"])
    plc.load("LD SM1\nTO 0 12 D0 1\nLD SM0\nFROM 0 0 D10 1\nTO 1 0 D10 1")
    plc.run()
    plc["D0"] = 3
    plc.modules[0].milliamperes[0] = 20
    plc.scan(2)
    assert plc["D10"] == 10000
    assert plc.modules[1].output_volts[0] == 10


# -- by name ------------------------------------------------------------------------------------------------------


def test_terminals_have_names_like_devices(unit):
    unit.set({"AI0:V": 2.5, "AI1:mA": 4, "M0": 1})
    unit.scan(2)
    assert (unit["SD172"], unit["AI0:V"], unit["AI0:mA"], unit["AO0:V"]) == (2500, 2.5, None, 0)
    plc = ecsim.Plc("EC20", io=[(24, 16), "4AD", "4DA"])
    plc["AI0.3:mA"] = 12
    plc.modules[1].write(MEAN + 2, [1500])
    assert (plc.modules[0].milliamperes[3], plc["AO1.2:V"], plc["AO1.2:mA"]) == (12, 1.5, 0)


@pytest.mark.parametrize(
    ("name", "words"),
    [("AI0:V", "no analog channels"), ("AI1.4:V", "no channel 4"), ("AI0.0:V", "no special module in place 0"), ("AI1.0:C", "no input for degrees"),
     ("AO1.0:V", "has no outputs"), ("AO0:mA", "no output milliamperes"), ("AI1.0:A", "AI1.0")],
)  # fmt: skip
def test_a_name_of_no_terminal_is_refused_and_nothing_is_written(name, words):
    plc = ecsim.Plc("EC20")
    plc.modules[1] = "4AD"
    refused(lambda: plc.set({"D0": 5, name: 1}), words)
    assert plc["D0"] == 0


def test_an_output_cannot_be_written_from_outside(unit):
    refused(lambda: unit.set({"D0": 3, "AO0:V": 1}), "AO0:V is an output")
    refused(lambda: unit.__setitem__("AI0:V", "5"), "a number of volts")
    assert unit["D0"] == 0


class Tank:
    """A level that a pump's speed raises and that a sensor tells in volts: 1 V a second at full speed."""

    wiring = {"AI0.0:V": "level", "AO1.0:V": "speed", "Y0": "valve", "X0": "full"}

    def __init__(self):
        self.level = 0.0

    def step(self, seconds, outputs):
        self.level += seconds * outputs["AO1.0:V"] / 10
        return {"AI0.0:V": self.level, "X0": int(self.level > 1)}


def test_a_plant_is_driven_and_measured_in_volts():
    plc = ecsim.Plc("EC20", input_filter_ms=0, io=[(10, 6), "4AD", "4DA"])
    plc.load("LD SM1\nMOV 1 D9\nTO 0 8 D9 1\nLD SM0\nFROM 0 0 D0 1\nLD< D0 500\nMOV 10000 D1\nLD>= D0 500\nMOV 0 D1\nLD SM0\nTO 1 0 D1 1")
    plc.run()
    session = ecsim.Session(plc, Tank(), name="tank")
    session.scan(40)
    assert session.plant.level == pytest.approx(0.4, abs=0.03)
    assert plc["D0"] == pytest.approx(1000 * session.plant.level, abs=30)
    session.scan(60)
    assert 0.5 <= session.plant.level < 0.56
    before = session.plant.level, plc["D0"]
    session.back(60)
    assert session.plant.level < 0.45
    session.scan(60)
    assert (session.plant.level, plc["D0"]) == before


def test_a_plant_on_a_missing_terminal_is_refused():
    plc = ecsim.Plc("EC20", io=[(10, 6), "4AD"])
    tank = Tank()
    tank.wiring = {"X12": "full"}
    refused(lambda: ecsim.Session(plc, tank, name="tank"), "X12 has no terminal")
