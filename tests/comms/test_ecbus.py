"""ECbus: shared areas in all modes, error flags, stations that leave and come back, two layers (10.5)."""

import json
from pathlib import Path

import pytest

from ecsim.errors import EcsimError
from ecsim.hardware.serial import PortSettings
from ecsim.models import EC10
from ecsim.network import Network
from ecsim.plc import Plc
from ecsim.system import SystemBlock

FACTS = json.loads((Path(__file__).parent.parent / "facts" / "ecbus.json").read_text(encoding="utf-8"))


def station(number, program="", mode=3, stations=5, port=1, **settings):
    """A running station of a bus."""
    on_bus = PortSettings("ecbus", station=number, refresh_mode=mode, stations=stations, **settings)
    plc = Plc("EC10", input_filter_ms=0, system=SystemBlock(**{f"port{port}": on_bus}))
    plc.load(program)
    plc.run()
    return plc


# 10.5.5: D100 of station 0 and D305 of station 2 are added up in D500 of station 4
EXAMPLE = {0: "LD SM0\nMOV D100 D7700", 2: "LD SM0\nMOV D305 D7716", 4: "LD SM0\nADD D7700 D7716 D500"}


def example(count=5, **settings):
    """The bus of 10.5.5."""
    network = Network(**{f"s{number}": station(number, EXAMPLE.get(number, ""), **settings) for number in range(count)})
    network.wire(*(f"s{number}.1" for number in range(count)), name="bus")
    return network


def flags(plc, count=5, first=140):
    """The error flags that are ON, by station."""
    return [number for number in range(count) if plc[f"SM{first + number}"]]


def started(network):
    """The network after station 0 has begun and everybody has spoken."""
    network.advance(ms=600)
    return network


def test_the_example_of_the_manual():
    network = example()
    network["s0"]["D100"], network["s2"]["D305"] = 1200, 34
    started(network)
    assert network["s4"]["D500"] == 1234
    network["s0"]["D100"] = -1
    network.advance(ms=200)
    assert network["s4"]["D500"] == 33
    assert all(flags(network[name]) == [] for name in network.members)


@pytest.mark.parametrize("mode", range(1, 14))
def test_each_mode_divides_the_areas_as_its_table_does(mode):
    area, rows = EC10.shared[mode], FACTS[str(mode)]
    assert area.stations == rows["stations"]
    for first, last, number in rows["d"]:
        assert (f"D{area.first_word + number * area.words}", f"D{area.first_word + (number + 1) * area.words - 1}") == (first, last)
    for first, last, number in rows["m"]:
        assert (f"M{area.first_bit + number * area.bits}", f"M{area.first_bit + (number + 1) * area.bits - 1}") == (first, last)


@pytest.mark.parametrize("mode", range(1, 14))
def test_words_and_bits_reach_everybody_in_every_mode(mode):
    rows = FACTS[str(mode)]
    network = Network(a=station(0, mode=mode, stations=2), b=station(1, mode=mode, stations=2))
    network.wire("a.1", "b.1")
    for name, number in (("a", 0), ("b", 1)):
        (first_d, last_d, _), (first_m, last_m, _) = rows["d"][number], rows["m"][number]
        network[name].set({first_d: 11 + number, last_d: -7 - number, first_m: 1, last_m: 1})
    started(network)
    for name in "ab":
        for number in (0, 1):
            (first_d, last_d, _), (first_m, last_m, _) = rows["d"][number], rows["m"][number]
            values = [network[name][device] for device in (first_d, last_d, first_m, last_m)]
            assert values == [11 + number, -7 - number, 1, 1]


def test_what_a_program_writes_into_anothers_area_is_refreshed():
    network = example()
    network["s0"]["D100"] = 5
    started(network)
    network["s3"]["D7700"] = 99
    network.advance(ms=200)
    assert [network[name]["D7700"] for name in sorted(network.members)] == [5] * 5


def test_a_station_that_fails_is_flagged_everywhere_and_the_others_go_on():
    network = started(example())
    network["s3"].power_off()
    network.advance(ms=300)
    assert [flags(network[name]) for name in ("s0", "s1", "s2", "s4")] == [[3]] * 4
    network["s2"]["D305"] = 77
    network.advance(ms=200)
    assert network["s4"]["D7716"] == 77


def test_a_station_that_comes_back_is_found_within_a_second():
    network = started(example())
    network["s3"].power_off()
    network.advance(ms=500)
    network["s3"].power_on()
    network["s0"]["D100"] = 8
    network.advance(ms=1000)
    assert [flags(network[name]) for name in sorted(network.members)] == [[]] * 5
    assert network["s3"]["D7700"] == 8


def test_a_new_station_joins_the_running_bus_within_a_second():
    network = started(example(count=4))
    assert flags(network["s0"]) == [4]
    late = station(4, EXAMPLE[4])
    network.add("s4", late)
    next(iter(network.wires.values())).join(late.ports[1])
    network["s0"]["D100"], network["s2"]["D305"] = 2, 3
    network.advance(ms=1000)
    assert (late["D500"], flags(network["s0"]), flags(late)) == (5, [], [])


def test_without_station_0_the_next_one_leads_until_it_comes_back():
    network = started(example())
    network["s0"].power_off()
    network.advance(ms=800)
    assert [flags(network[name]) for name in ("s1", "s2", "s3", "s4")] == [[0]] * 4
    network["s2"]["D305"] = 55
    network.advance(ms=200)
    assert network["s4"]["D7716"] == 55
    network["s0"].power_on()
    network.advance(ms=1000)
    assert [network[name].ports[1].protocol.leads for name in sorted(network.members)] == [True, False, False, False, False]
    assert [flags(network[name]) for name in sorted(network.members)] == [[]] * 5


def test_a_station_alone_flags_all_the_others():
    network = started(example())
    port = network["s2"].ports[1]
    port.wire.leave(port)
    network.advance(ms=1000)
    assert flags(network["s2"]) == [0, 1, 3, 4]
    assert flags(network["s0"]) == [2]


def test_station_0_may_change_the_mode_while_the_bus_runs():
    network = started(example())
    network["s0"].set({"SD138": 2})
    network.advance(ms=200)
    network["s1"]["D7704"] = 66  # in mode 2 station 1 has D7704 to D7707
    network.advance(ms=200)
    assert network["s4"]["D7704"] == 66
    assert network["s1"].ports[1].protocol.known == (2, 5)


def test_two_layers_meet_in_a_plc_with_both_ports():
    middle = Plc(
        "EC10",
        input_filter_ms=0,
        system=SystemBlock(
            port0=PortSettings("ecbus", station=1, refresh_mode=13, stations=2),
            port1=PortSettings("ecbus", station=1, refresh_mode=9, stations=2),
        ),
    )
    middle.load("LD SM0\nMOV D7700 D7748")  # what came from layer 0 goes on to layer 1
    middle.run()
    network = Network(low=station(0, mode=9, stations=2), middle=middle, high=station(0, mode=13, stations=3 - 1))
    network.wire("low.1", "middle.1", name="layer 0")
    network.wire("high.1", "middle.0", name="layer 1")
    network["low"]["D7700"] = 4321
    network.advance(ms=900)
    assert network["high"]["D7748"] == 4321
    network["high"].power_off()
    network.advance(ms=900)
    assert (flags(middle, 2), flags(middle, 2, 156)) == ([], [0])


def test_thirty_two_stations_on_one_bus():
    network = Network(**{f"s{number}": station(number, mode=1, stations=32, baud=115200) for number in range(32)})
    network.wire(*(f"s{number}.1" for number in range(32)))
    for number in range(32):
        network[f"s{number}"][f"D{7701 + 2 * number}"] = 100 + number
    network.advance(ms=500)
    assert [network["s31"][f"D{7701 + 2 * number}"] for number in range(32)] == [100 + number for number in range(32)]


def test_the_same_run_again_from_a_snapshot_and_in_another_order():
    network = started(example())
    snapshot = network.snapshot()
    network.advance(ms=333)
    first = network.log
    network.restore(snapshot)
    network.advance(ms=333)
    assert network.log == first
    other = Network(**{f"s{number}": station(number, EXAMPLE.get(number, "")) for number in (3, 1, 4, 0, 2)})
    other.wire(*(f"s{number}.1" for number in (2, 4, 0, 1, 3)), name="bus")
    started(other).advance(ms=333)
    assert other.log == first


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"refresh_mode": 14}, "refresh_mode of port 1 is 14"),
        ({"refresh_mode": 3, "stations": 9}, "stations of port 1 (refresh mode 3) is 9; it is a whole number from 2 to 8"),
        ({"refresh_mode": 3, "stations": 5, "delay_ms": 101}, "delay_ms of port 1 is 101"),
        ({"station": 32}, "the station of port 1 is 32"),
    ],
)
def test_settings_that_no_bus_has_are_refused(settings, words):
    with pytest.raises(EcsimError) as refusal:
        PortSettings("ecbus", **settings).check(EC10, 1)
    assert words in str(refusal.value)
