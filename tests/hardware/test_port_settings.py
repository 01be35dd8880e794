"""The settings of the serial ports (2.2.1, 10.3.2, 10.4.13): what is usual, what is refused."""

import pytest

from ecsim.errors import EcsimError
from ecsim.hardware.serial import Framing, PortSettings
from ecsim.models import EC10, EC20

FREE, SLAVE, MASTER = (PortSettings(protocol) for protocol in ("freeport", "modbus slave", "modbus master"))


@pytest.mark.parametrize(
    ("settings", "framing"),
    [
        (FREE, Framing(9600, 8, "none", 1)),  # 10.3.2
        (SLAVE, Framing(19200, 8, "even", 1)),  # appendix 7, 1
        (PortSettings("modbus master", parity="none"), Framing(19200, 8, "none", 2)),  # 10.4.13: two stop bits without parity
        (PortSettings("modbus slave", mode="ascii"), Framing(19200, 7, "even", 1)),  # 10.4.2: seven bits in ASCII mode
        (PortSettings("freeport", baud=1200, data_bits=7, parity="odd", stop_bits=2), Framing(1200, 7, "odd", 2)),
    ],
)
def test_what_is_left_out_is_the_protocols_usual_setting(settings, framing):
    assert settings.framing == framing
    settings.check(EC20, 1)


def test_a_character_takes_its_bits_at_the_baud_rate():
    # 10.4.3: eleven bits at 19200 baud; 3.5 characters are 2 ms, so seven half characters of 11 / 19200 s
    assert Framing(19200, 8, "even", 1).bits == 11
    assert Framing(19200, 8, "even", 1).after(1000) == 572_916
    assert Framing(9600, 8, "none", 1).after(960) == 1_000_000


@pytest.mark.parametrize(
    ("settings", "number", "words"),
    [
        (MASTER, 0, "the protocol of port 0 is 'modbus master'; choose programming or freeport or modbus slave"),
        (PortSettings("programming"), 1, "the protocol of port 1 is 'programming'"),
        (PortSettings("ecbus"), 1, "the protocol of port 1 is 'ecbus'"),
        (PortSettings("freeport", baud=115200), 1, "the baud rate of port 1 is 115200"),
        (PortSettings("freeport", data_bits=9), 1, "the data bits of port 1 is 9; choose 7 or 8"),
        (PortSettings("modbus slave", data_bits=7), 1, "the data bits of port 1 is 7; choose 8"),
        (PortSettings("modbus slave", stop_bits=2), 1, "the stop bits of port 1 is 2; choose 1"),
        (PortSettings("freeport", parity="mark"), 1, "the parity of port 1 is 'mark'; choose none or odd or even"),
        (PortSettings("modbus slave", mode="tcp"), 1, "the mode of port 1 is 'tcp'; choose rtu or ascii"),
        (PortSettings("modbus slave", station=0), 1, "the station of port 1 is 0; it is a whole number from 1 to 31"),
        (PortSettings("modbus master", station=32), 1, "the station of port 1 is 32"),
        (PortSettings("freeport", start_char=256), 1, "start_char of port 1 is 256"),
        (PortSettings("freeport", gap_timeout_ms=-1), 1, "gap_timeout_ms of port 1 is -1"),
        (PortSettings("modbus master", retries=True), 1, "retries of port 1 is True"),
        (FREE, 2, "EC20 has no port 2; it has 2 serial ports"),
    ],
)
def test_a_setting_that_the_port_does_not_have_is_refused_in_words(settings, number, words):
    with pytest.raises(EcsimError) as refusal:
        settings.check(EC20, number)
    assert words in str(refusal.value)


def test_only_the_ec10_has_ecbus_on_both_ports():
    for number in (0, 1):
        PortSettings("ecbus", station=0, baud=115200).check(EC10, number)


def test_port_1_alone_can_be_the_master():
    MASTER.check(EC20, 1)
    MASTER.check(EC10, 1)
