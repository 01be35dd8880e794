"""The system block's settings of the special modules of EC10 (2.2.1): they hold from STOP to RUN on and link channels to D registers."""

import pytest

import ecsim
from ecsim import SystemBlock

SETTINGS = {
    0: {
        "kind": "4AD",
        "channels": [{"mode": 3, "zero": 0, "full_scale": 500, "samples": 2, "mean": "D100", "present": "D101"}, {"mode": -1}],
    },
    1: {"kind": "4DA", "channels": [{}, {"mode": 2, "zero": -100, "full_scale": 100, "value": "D110"}]},
}
IO = [(24, 16), "4AD", "4DA"]


@pytest.fixture
def plc():
    """An EC10 with a 4AD and a 4DA that its system block sets up, in RUN."""
    plc = ecsim.Plc("EC10", io=IO, system=SystemBlock(modules=SETTINGS))
    plc.load("LD SM0\nMOV D100 D0")
    plc.run()
    return plc


def test_a_linked_register_holds_the_mean_and_the_present_value(plc):
    plc.modules[0].milliamperes[0] = 4
    plc.scan(5)
    plc.modules[0].milliamperes[0] = 20
    plc.scan()
    assert (plc["D100"], plc["D101"]) == (250, 500)
    plc.scan()
    assert (plc["D100"], plc["D101"], plc["D0"]) == (500, 500, 250)


def test_an_output_follows_its_register(plc):
    plc["D110"] = 0  # half of 4 to 20 mA
    plc.scan()
    assert plc.modules[1].output_milliamperes[1] == 12
    plc["D110"] = 100
    plc.scan()
    assert plc.modules[1].output_milliamperes[1] == 20


def test_the_settings_hold_from_run_on():
    plc = ecsim.Plc("EC10", io=IO, system=SystemBlock(modules=SETTINGS))
    assert plc.modules[0].read(12, 2) == [0, 0]
    plc.load("LD SM0\nNOP")
    plc.run()
    assert plc.modules[0].read(12, 2) == [3, -1]
    assert (plc.modules[0].read(8, 1), plc.modules[0].read(20, 1)) == ([2], [500])
    plc.modules[0].write(20, [1000])
    plc.stop()
    assert plc.modules[0].read(20, 1) == [1000]
    plc.run()
    assert plc.modules[0].read(20, 1) == [500]


def test_another_module_than_the_one_set_is_misplaced_and_left_alone():
    plc = ecsim.Plc("EC10", io=[(24, 16), "4DA", "4DA"], system=SystemBlock(modules=SETTINGS))
    plc.load("LD SM0\nNOP")
    plc.run()
    assert plc.modules.misplaced == [0]
    assert ([error.code for error in plc.errors], plc["SD3"], plc.running) == ([26], 26, True)
    plc.modules[1].remove()
    assert plc.modules.misplaced == [0, 1]
    plc["D110"] = 100
    plc.scan()  # nothing is linked to a module that does not answer
    assert plc.modules.misplaced == [0, 1]
    plc.modules[1].insert()
    plc.scan()
    assert plc.modules[1].output_milliamperes[1] == 20


def test_the_right_module_ends_the_error():
    plc = ecsim.Plc("EC10", io=[(24, 16), "4DA", "4DA"], system=SystemBlock(modules=SETTINGS))
    plc.run()
    assert plc["SD3"] == 26
    plc.modules[0] = "4AD"
    assert (plc["SD3"], plc.errors) == (0, [])


def test_a_snapshot_knows_the_links(plc):
    before = plc.snapshot()
    del plc.modules[1]
    plc.restore(before)
    plc["D110"] = 100
    plc.scan()
    assert plc.modules[1].output_milliamperes[1] == 20


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({}, "kind None"),
        ({"kind": "8AD"}, "EC10 knows 4AD, 4DA, 4PT, 4TC"),
        ({"kind": "4AD", "channel": []}, "no setting 'channel'"),
        ({"kind": "4AD", "channels": [{}] * 5}, "up to 4"),
        ({"kind": "4AD", "channels": [5]}, "list of up to 4 tables"),
        ({"kind": "4AD", "channels": [{"value": "D0"}]}, "channel 0 has no setting 'value'"),
        ({"kind": "4DA", "channels": [{}, {"samples": 8}]}, "channel 1 has no setting 'samples'"),
        ({"kind": "4AD", "channels": [{"mode": 9}]}, "there is no mode 9; a 4AD has -1 (off) and 0, 1, 2, 3"),
        ({"kind": "4AD", "channels": [{"samples": 0}]}, "samples is 0"),
        ({"kind": "4AD", "channels": [{"zero": 10000}]}, "must differ"),
        ({"kind": "4AD", "channels": [{"full_scale": 40000}]}, "16 bits"),
        ({"kind": "4AD", "channels": [{"mean": "M0"}]}, "'M0' is no register; write one of D0 to D7999"),
        ({"kind": "4AD", "channels": [{"mean": "D8000"}]}, "'D8000' is no register"),
        ({"kind": "4AD", "channels": [{"mean": "D0Z0"}]}, "'D0Z0' is no register"),
    ],
)
def test_settings_that_cannot_be_are_refused(settings, words):
    with pytest.raises(ecsim.EcsimError) as error:
        ecsim.Plc("EC10", system=SystemBlock(modules={2: settings}))
    assert words in str(error.value)
    assert "place 2" in str(error.value)
