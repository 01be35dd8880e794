"""What the special relays and registers of the two serial ports do: checks as in special_checks.py."""

import ecsim
from ecsim import SystemBlock
from ecsim.hardware.serial import PortSettings
from ecsim.hardware.wire import Framing, Wire
from ecsim.network import Network

from .special_checks import ints, machine, main, run, values


class Silent:
    """An instrument that keeps what it hears."""

    def __init__(self):
        self.heard = []

    def hear(self, message):
        self.heard.append(message)


def on_port(model, number, il, protocol="freeport", instrument=None, **settings):
    """A PLC in RUN with a protocol on one port and an instrument there."""
    plc = machine(model, il, system=SystemBlock(**{f"port{number}": PortSettings(protocol, **settings)}))
    plc.ports[number].connect(instrument or Silent())
    return plc


def heard(plc, number):
    return b"".join(plc.ports[number].wire.stations[0].instrument.heard)


def say(plc, number, text):
    """The instrument begins to send."""
    plc.ports[number].wire.stations[0].send(text, plc.time_us)
    plc.ports[number].stirred()


def crc16(frame):
    """The checksum of Modbus RTU, low byte first."""
    crc = 0xFFFF
    for byte in frame:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0xA001 if crc & 1 else 0)
    return frame + crc.to_bytes(2, "little")


def port_of(number, first):
    """Appendices 1 and 2 give port 1 the numbers of port 0 plus ten."""
    return (number - first) // 10


# -- interrupts (EC10) --------------------------------------------------------------------------------------------


def serial_interrupt(model, number):
    """SM48 to SM55: character sent, character received, frame sent, frame received, of port 0 and of port 1."""
    port, event = (number - 48) // 4, number - 18
    il = f"LD SM1\nEI\nLD M5\nOUT SM{number}\nLD M0\nEU\nXMT {port} D100 3\nLD M1\nEU\nRCV {port} D200 2"
    for enabled in (0, 1):
        plc = on_port(model, port, main(il) + ints(event))
        plc.set({"M5": enabled, "M0": 1})
        plc.scan(3)
        assert plc["D0"] == enabled * (3, 0, 1, 0)[(number - 48) % 4]
        plc["M1"] = 1
        plc.scan()
        say(plc, port, b"ab")
        plc.scan(3)
        assert plc["D0"] == enabled * (3, 2, 1, 1)[(number - 48) % 4]


# -- freeport: relays ---------------------------------------------------------------------------------------------

SEND = "LD M0\nEU\nXMT {0} D100 D0"
RECEIVE = "LD M1\nEU\nRCV {0} D200 D1"


def sending(model, number):
    """SM110 and SM120: ON from XMT to the last character; the program turns it OFF to break it off."""
    port = port_of(number, 110)
    plc = on_port(model, port, SEND.format(port) + f"\nLD M5\nRST SM{number}")
    plc.set({"M0": 1, "D0": 12})  # 12.5 ms
    assert plc[f"SM{number}"] == 0
    plc.scan()
    assert plc[f"SM{number}"] == 1
    plc.scan()
    assert (plc[f"SM{number}"], len(heard(plc, port))) == (0, 12)
    plc["M0"] = 0
    plc.scan()
    plc["M0"] = 1
    plc.scan()
    plc["M5"] = 1
    plc.scan(2)
    assert (plc[f"SM{number}"], len(heard(plc, port))) == (0, 12 + 9)  # 9 characters end in 10 ms


def receiving(model, number):
    """SM111 and SM121: ON from RCV to the end of the reception; OFF breaks it off."""
    port = port_of(number, 111)
    plc = on_port(model, port, RECEIVE.format(port) + f"\nLD M5\nRST SM{number}")
    plc.set({"M1": 1, "D1": 2})
    plc.scan()
    assert plc[f"SM{number}"] == 1
    say(plc, port, b"ab")
    plc.scan(2)
    assert plc[f"SM{number}"] == 0
    plc["M1"] = 0
    plc.scan()
    plc["M1"] = 1
    plc.scan()
    plc["M5"] = 1
    plc.scan(2)
    say(plc, port, b"cd")
    plc.scan(2)
    assert values(plc, f"SM{number}", "D200", f"SD{115 + 10 * port}") == [0, ord("a"), 1]


def sent(model, number):
    port = port_of(number, 112)
    plc = on_port(model, port, SEND.format(port) + f"\nLD M5\nRST SM{number}")
    plc.set({"M0": 1, "D0": 12})
    plc.scan()
    assert plc[f"SM{number}"] == 0
    plc.scan()
    assert plc[f"SM{number}"] == 1
    plc["M5"] = 1
    plc.scan()
    assert plc[f"SM{number}"] == 0


def received(model, number):
    port = port_of(number, 113)
    plc = on_port(model, port, RECEIVE.format(port) + f"\nLD M5\nRST SM{number}")
    plc.set({"M1": 1, "D1": 2})
    plc.scan()
    say(plc, port, b"a")
    plc.scan(2)
    assert plc[f"SM{number}"] == 0
    say(plc, port, b"b")
    plc.scan(2)
    assert plc[f"SM{number}"] == 1
    plc["M5"] = 1
    plc.scan()
    assert plc[f"SM{number}"] == 0


def idle(model, number):
    port = port_of(number, 114)
    plc = on_port(model, port, SEND.format(port) + "\n" + RECEIVE.format(port))
    plc.scan()
    assert plc[f"SM{number}"] == 1
    plc.set({"M0": 1, "D0": 12})
    plc.scan()
    assert plc[f"SM{number}"] == 0
    plc.scan()
    assert plc[f"SM{number}"] == 1
    plc.set({"M1": 1, "D1": 1})
    plc.scan()
    assert plc[f"SM{number}"] == 0
    say(plc, port, b"a")
    plc.scan(2)
    assert plc[f"SM{number}"] == 1


# -- freeport: registers ------------------------------------------------------------------------------------------


def mode_word(model, number):
    """SD110 and SD120: baud rate in bits 0 to 2, then two stop bits, odd, parity, seven data bits, characters and times that are used."""
    port = port_of(number, 110)
    rows = (
        ({"baud": 38_400}, 0), ({"baud": 19_200}, 1), ({"baud": 9600}, 2), ({"baud": 4800}, 3), ({"baud": 2400}, 4), ({"baud": 1200}, 5),
        ({"stop_bits": 2}, 2 + 8), ({"parity": "odd"}, 2 + 16 + 32), ({"parity": "even"}, 2 + 32), ({"data_bits": 7}, 2 + 64),
        ({"start_char": 2}, 2 + 128), ({"end_char": 3}, 2 + 256), ({"gap_timeout_ms": 5}, 2 + 512), ({"frame_timeout_ms": 50}, 2 + 1024),
    )  # fmt: skip
    for settings, word in rows:
        assert on_port(model, port, "LD SM0\nNOP", **settings)[f"SD{number}"] == word


def heard_by(model, port, change, text, waits=3, most=10, **settings):
    """A PLC that receives `text`, with the instructions `change` before its RCV."""
    plc = on_port(model, port, f"LD SM1\n{change}\n" + RECEIVE.format(port), **settings)
    plc.set({"M1": 1, "D1": most})
    plc.scan()
    say(plc, port, text)
    plc.scan(waits)
    return plc


def start_character(model, number):
    port = port_of(number, 111)
    assert heard_by(model, port, "NOP", b"", start_char=2)[f"SD{number}"] == 2
    for change, first in (("NOP", 2), (f"MOV 65 SD{number}", 65)):
        plc = heard_by(model, port, change, b"x\x02yAz", most=2, start_char=2)
        assert plc["D200"] == first


def end_character(model, number):
    port = port_of(number, 112)
    assert heard_by(model, port, "NOP", b"", end_char=3)[f"SD{number}"] == 3
    for change, count in (("NOP", 3), (f"MOV 66 SD{number}", 2)):
        plc = heard_by(model, port, change, b"AB\x03C", end_char=3)
        assert plc[f"SD{117 + 10 * port}"] == count


def gap_timeout(model, number):
    port = port_of(number, 113)
    assert on_port(model, port, "LD SM0\nNOP")[f"SD{number}"] == 0
    for change, code in (("NOP", 8), (f"MOV 500 SD{number}", 0)):
        plc = heard_by(model, port, change, b"AB", waits=6, gap_timeout_ms=20)
        assert plc[f"SD{115 + 10 * port}"] == code


def frame_timeout(model, number):
    port = port_of(number, 114)
    assert on_port(model, port, "LD SM0\nNOP")[f"SD{number}"] == 0
    for change, code in (("NOP", 16), (f"MOV 500 SD{number}", 0)):
        plc = heard_by(model, port, change, b"AB", waits=6, frame_timeout_ms=20)
        assert plc[f"SD{115 + 10 * port}"] == code


def completion(model, number):
    """SD115 and SD125: 2 end character, 4 greatest count, 8 gap, 16 time, 32 parity; 1 stands in `receiving`."""
    port = port_of(number, 115)
    assert heard_by(model, port, "NOP", b"AB", most=2)[f"SD{number}"] == 4
    assert heard_by(model, port, "NOP", b"AB\x03", end_char=3)[f"SD{number}"] == 2
    assert heard_by(model, port, "NOP", b"AB", waits=6, gap_timeout_ms=10)[f"SD{number}"] == 8
    assert heard_by(model, port, "NOP", b"AB", waits=6, frame_timeout_ms=30)[f"SD{number}"] == 16
    plc = on_port(model, port, RECEIVE.format(port), parity="even")
    plc.ports[port].disconnect()
    wire_with_odd_parity(plc, port)
    plc.set({"M1": 1, "D1": 10})
    plc.scan()
    say(plc, port, b"A")
    plc.scan(2)
    assert plc[f"SD{number}"] == 32


def wire_with_odd_parity(plc, number):
    """Put the port on a wire with an instrument that sends odd parity."""
    wire = Wire()
    wire.join(plc.ports[number])
    wire.join(Silent(), Framing(9600, 8, "odd", 1))


def last_received(model, number):
    port = port_of(number, 116)
    plc = heard_by(model, port, "NOP", b"AB")
    assert plc[f"SD{number}"] == ord("B")
    say(plc, port, b"C")
    plc.scan(2)
    assert plc[f"SD{number}"] == ord("C")


def count_received(model, number):
    port = port_of(number, 117)
    plc = heard_by(model, port, "NOP", b"AB")
    assert plc[f"SD{number}"] == 2
    say(plc, port, b"C")
    plc.scan(2)
    assert plc[f"SD{number}"] == 3
    plc.stop()
    plc.run()
    assert plc[f"SD{number}"] == 0


def last_sent(model, number):
    port = port_of(number, 118)
    plc = on_port(model, port, SEND.format(port))
    plc.set({"M0": 1, "D0": 2, "D100": 65, "D101": 66})
    plc.scan(2)
    assert plc[f"SD{number}"] == 66


# -- Modbus -------------------------------------------------------------------------------------------------------


def station(model, number):
    """SD130 and SD135: the station that the slave answers as; the program may change it."""
    port = (number - 130) // 5
    plc = on_port(model, port, f"LD M0\nMOV 9 SD{number}", "modbus slave", station=7)
    assert plc[f"SD{number}"] == 7
    for asked, moved, answers in ((7, 0, 1), (9, 0, 0), (9, 1, 1), (7, 1, 0)):
        plc["M0"] = moved
        plc.scan()
        before = len(heard(plc, port))
        say(plc, port, crc16(bytes((asked, 3, 7, 0xD0, 0, 1))))  # one register
        plc.scan(8)
        assert (len(heard(plc, port)) > before) == bool(answers)


ASK = "LD M1\nMOV D0 SD{0}\nLD M0\nEU\nMODBUS 1 D10 D100"


def asking(model, number, **settings):
    """A master that is to read one register of station 5; nobody answers."""
    plc = on_port(model, 1, ASK.format(number), "modbus master", **settings)
    plc.set({f"D{10 + place}": value for place, value in enumerate((5, 3, 0, 0, 0, 1))} | {"M0": 1})
    return plc


def timeout(model, number):
    """SD131 and SD136: shown on both ports; the master of port 1 waits so long."""
    port = (number - 131) // 5
    assert on_port(model, port, "LD SM0\nNOP", timeout_ms=300)[f"SD{number}"] == 300
    if port == 1:
        for changed, failed in ((0, 1), (1, 0)):
            plc = asking(model, number, timeout_ms=100)
            plc.set({"D0": 1000, "M1": changed})
            plc.advance(ms=300)
            assert plc["SM136"] == failed


def retries(model, number):
    """SD132 and SD137: shown on both ports; the master of port 1 asks so often again."""
    port = (number - 132) // 5
    assert on_port(model, port, "LD SM0\nNOP", retries=3)[f"SD{number}"] == 3
    if port == 1:
        for changed, times in ((0, 1), (1, 3)):
            plc = asking(model, number, timeout_ms=50)
            plc.set({"D0": 2, "M1": changed})
            plc.advance(ms=1000)
            assert heard(plc, 1) == crc16(bytes((5, 3, 0, 0, 0, 1))) * times


class Register:
    """A slave with one register; or one that knows nothing."""

    def __init__(self, answer):
        self.answer = answer

    def hear(self, message):
        return crc16(self.answer)


def exchange(model, number):
    """SM135, SM136, SD139: an answer, an exception, silence."""
    rows = ((Register(bytes((5, 3, 2, 0, 42))), 0, 0), (Register(bytes((5, 0x83, 2))), 1, 2), (Silent(), 1, 0x10))
    for instrument, failed, code in rows:
        plc = on_port(model, 1, "LD M0\nEU\nMODBUS 1 D10 D100\nLD M1\nRST SM135\nRST SM136", "modbus master", instrument, timeout_ms=100)
        plc.set({f"D{10 + place}": value for place, value in enumerate((5, 3, 0, 0, 0, 1))})
        assert values(plc, "SM135", "SM136", "SD139") == [0, 0, 0]
        plc["M0"] = 1
        plc.advance(ms=300)
        assert values(plc, "SM135", "SM136", "SD139") == [1, failed, code]
        plc["M1"] = 1
        plc.scan()
        assert values(plc, "SM135", "SM136") == [0, 0]


# -- ECbus --------------------------------------------------------------------------------------------------------


def bus(model, port, stations, mode, most):
    """Running stations of a bus, wired at one port, by their numbers."""
    network = Network()
    for number in stations:
        settings = PortSettings("ecbus", station=number, refresh_mode=mode, stations=most)
        plc = ecsim.Plc(model, system=SystemBlock(**{f"port{port}": settings}))
        plc.run()
        network.add(f"s{number}", plc)
    network.wire(*(f"s{number}.{port}" for number in stations))
    network.advance(ms=2000)
    return network


def silent_station(model, number):
    """SM140 to SM171: ON while the station does not answer, on every other one."""
    station = number - 140
    other = 0 if station else 1
    network = bus(model, 1, (station, other), mode=1, most=max(2, station + 1))
    looking, failing = network[f"s{other}"], network[f"s{station}"]
    assert looking[f"SM{number}"] == 0
    failing.power_off()
    network.advance(ms=2000)
    assert looking[f"SM{number}"] == 1
    failing.power_on()
    network.advance(ms=2000)
    assert looking[f"SM{number}"] == 0


def refresh_mode(model, number):
    """SD133 and SD138: which table of 10.5 divides the areas; station 0 may change it. Station 1 has D7708 to D7715 in mode 3, D7704 to D7707 in mode 2."""
    network = bus(model, (number - 133) // 5, (0, 1), mode=3, most=2)
    leader, other = network["s0"], network["s1"]
    assert (leader[f"SD{number}"], other[f"SD{number}"]) == (3, 3)
    other.set({"D7704": 1, "D7708": 2})
    network.advance(ms=300)
    assert values(leader, "D7704", "D7708") == [0, 2]
    leader[f"SD{number}"] = 2
    other["D7704"] = 3
    network.advance(ms=2000)
    assert leader["D7704"] == 3


def both(kind, number, check):
    """The same device of either port."""
    return {f"{kind}{number}": check, f"{kind}{number + 10}": check}


CHECKS = {
    **run("SM", 48, 55, serial_interrupt),
    **both("SM", 110, sending), **both("SM", 111, receiving), **both("SM", 112, sent), **both("SM", 113, received), **both("SM", 114, idle),
    **both("SD", 110, mode_word), **both("SD", 111, start_character), **both("SD", 112, end_character), **both("SD", 113, gap_timeout),
    **both("SD", 114, frame_timeout), **both("SD", 115, completion), **both("SD", 116, last_received), **both("SD", 117, count_received),
    **both("SD", 118, last_sent), "SD130": station, "SD135": station, "SD131": timeout, "SD136": timeout, "SD132": retries, "SD137": retries,
    "SM135": exchange, "SM136": exchange, "SD139": exchange,
    **run("SM", 140, 171, silent_station), "SD133": refresh_mode, "SD138": refresh_mode,
}  # fmt: skip
