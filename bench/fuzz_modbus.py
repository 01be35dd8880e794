"""Mutated Modbus frames against the slave: nothing escapes, no answer is wrong, memory stays flat.

`python bench/fuzz_modbus.py` tries 100,000 on each model and prints figures; tests/modbus/test_fuzz.py tries 2,500. What is right is
told by an oracle of its own, written from the tables of addresses without a line of the slave.
"""

import argparse
import random
import resource
import struct
import time
import tracemalloc
from collections import Counter

import ecsim
from ecsim.comms.frames import Heard
from ecsim.comms.slave import Slave

# (functions, first address, last address, registers of a device): 10.4.6 of the manual of EC10 and EC20
_EC = [
    ((1, 5, 15), 0, 255, 1), ((1, 5, 15), 1200, 1455, 1), ((2,), 0, 255, 1), ((1, 5, 15), 2000, 3999, 1), ((1, 5, 15), 4400, 4655, 1),
    ((1, 5, 15), 6000, 6991, 1), ((1, 5, 15), 8000, 8255, 1), ((1, 5, 15), 9200, 9455, 1),
    ((3, 6, 16), 0, 7999, 1), ((3, 6, 16), 8000, 8255, 1), ((3, 6, 16), 8500, 8515, 1), ((3, 6, 16), 9000, 9255, 1),
    ((3, 6, 16), 9500, 9699, 1), ((3, 16), 9700, 9811, 2),
]  # fmt: skip
# H1U and H2U, which differ in their M alone: special M, S, T, C, X and Y; D with the special ones behind it, T, C, C200 on.
_BITS, _WORDS = (1, 2, 5, 15), (3, 6, 16)
_FX = [
    (_BITS, 8000, 8255, 1), (_BITS, 0xE000, 0xE3E7, 1), (_BITS, 0xF000, 0xF0FF, 1), (_BITS, 0xF400, 0xF4FF, 1),
    (_BITS, 0xF800, 0xF8FF, 1), (_BITS, 0xFC00, 0xFCFF, 1),
    (_WORDS, 0, 8255, 1), (_WORDS, 0xF000, 0xF0FF, 1), (_WORDS, 0xF400, 0xF4C7, 1), ((3, 16), 0xF700, 0xF76F, 2),
]  # fmt: skip
MAPS = {"EC10": _EC, "EC20": _EC, "H1U": [(_BITS, 0, 1535, 1), *_FX], "H2U": [(_BITS, 0, 3071, 1), *_FX]}
_MOST = {1: 2000, 2: 2000, 3: 125, 5: 1, 6: 1, 15: 1968}
MOST = {"EC10": _MOST | {16: 120}, "EC20": _MOST | {16: 120}, "H1U": _MOST | {16: 123}, "H2U": _MOST | {16: 123}}
DATA = {0: None, 1: (0, 0xFF00), 4: (0,), 10: (0,), **dict.fromkeys((11, 12, 13, 14, 15, 18), (0,))}  # sub-functions of 8 and their data


def crc(octets):
    """The CRC bit by bit."""
    register = 0xFFFF
    for octet in octets:
        register ^= octet
        for _ in range(8):
            register = register >> 1 ^ (0xA001 if register & 1 else 0)
    return struct.pack("<H", register)


def exception(message, model):
    """The exception code that a message must have, 0 for none."""
    function, content = message[0], message[1:]
    if function == 8:
        if len(content) < 4:
            return 3
        sub, data = struct.unpack(">H", content[:2])[0], content[2:]
        if sub not in DATA:
            return 1
        return 0 if DATA[sub] is None or data in [struct.pack(">H", word) for word in DATA[sub]] else 3
    if function not in MOST[model]:
        return 1
    if function in (15, 16):
        if len(content) < 5 or len(content) != 5 + content[4]:
            return 3
        size = 2 * int.from_bytes(content[2:4]) if function == 16 else -(-int.from_bytes(content[2:4]) // 8)
    elif len(content) != 4:
        return 3
    address, count = struct.unpack(">HH", content[:4])
    if function in (5, 6):
        if function == 5 and count not in (0, 0xFF00):
            return 3
        count = 1
    if not 1 <= count <= MOST[model][function]:
        return 3
    for functions, first, last, width in MAPS[model]:
        if function in functions and first <= address <= last:
            if count > last - first + 1 or count % width:
                return 3
            if address + count - 1 > last or (address - first) % width:
                return 2
            return 3 if function in (15, 16) and size != content[4] else 0
    return 2


def expected(frame, station, listening, model):
    """None for silence, an exception's code, or 0 for a normal answer."""
    if not 4 <= len(frame) <= 256 or crc(frame[:-2]) != frame[-2:] or frame[0] != station or listening:
        return None
    message = frame[1:-2]
    code = exception(message, model)
    return None if message[:3] == b"\x08\x00\x04" and not code else code


def wrong(frame, answer, listening, model="EC20"):
    """What is wrong with an answer, "" when nothing is."""
    code = expected(frame, 1, listening, model)
    if code is None or answer is None:
        return "" if (code is None) is (answer is None) else f"answer {answer}, expected {code}"
    if answer[0] != 1 or crc(answer[:-2]) != answer[-2:] or len(answer) > 256:
        return "no sound frame"
    function, content, given = frame[1], frame[2:-2], answer[1:-2]
    if code:
        return "" if given == bytes((function | 0x80, code)) else f"{given.hex()} where exception {code} belongs"
    if given[0] != function:
        return "another function"
    if function in (1, 2, 3):
        count = int.from_bytes(content[2:4])
        size = 2 * count if function == 3 else -(-count // 8)
        padding = function != 3 and count % 8 and given[-1] >> count % 8
        return "" if given[1] == size == len(given) - 2 and not padding else "a wrong number of octets"
    if function == 8 and int.from_bytes(content[:2]) in (11, 12, 13, 14, 15, 18):
        return "" if len(given) == 5 and given[1:3] == content[:2] else "no count"
    echo = content[:4] if function in (15, 16) else content
    return "" if given[1:] == echo else "no echo"


def sound(chance, model="EC20"):
    """A message that a client might send."""
    function = chance.choice([1, 2, 3, 5, 6, 8, 15, 16])
    _, first, last, _ = chance.choice([row for row in MAPS[model] if function in row[0]] or MAPS[model])
    address = chance.choice([first, last, chance.randint(first, last)])
    count = chance.choice([1, 2, 8, last - address + 1, chance.randint(1, 2000)])
    if function == 8:
        sub = chance.choice([0, 1, 10, 11, 12, 13, 14, 15, 18, *([4] if chance.random() < 0.02 else [])])
        return struct.pack(">BHH", 8, sub, chance.choice([0, 0, 0xFF00, 1]))
    if function == 5:
        return struct.pack(">BHH", 5, address, chance.choice([0, 0xFF00]))
    if function == 6:
        return struct.pack(">BHH", 6, address, chance.randrange(0x10000))
    if function == 15:
        octets = chance.randbytes(min(246, -(-count // 8)))
        return struct.pack(">BHHB", 15, address, count, len(octets)) + octets
    if function == 16:
        count = min(count, 123)
        return struct.pack(">BHHB", 16, address, count, 2 * count) + chance.randbytes(2 * count)
    return struct.pack(">BHH", function, address, count)


def mutated(chance, model):
    """A frame, sound or spoilt in one or more ways; half of the spoilt ones get a right CRC again."""
    message = bytearray(b"\1" + sound(chance, model))
    for _ in range(chance.choice([0, 0, 1, 1, 2, 5])):
        place = chance.randrange(len(message))
        match chance.randrange(6):
            case 0:
                message[place] ^= 1 << chance.randrange(8)
            case 1:
                message[place] = chance.choice([0, 1, 0x7F, 0x80, 0xFF, chance.randrange(256)])
            case 2:
                del message[place + 1 :]
            case 3:
                message[place:place] = chance.randbytes(chance.choice([1, 2, 40]))
            case 4:
                message += message[: chance.randrange(300)]
            case 5 if len(message) > 1:
                del message[place]
    frame = bytes(message) + crc(message)
    return frame if chance.random() < 0.8 else frame[: -chance.choice([1, 2])] + chance.randbytes(chance.choice([0, 1, 2]))


def attack(count, seed=1, model="EC20"):
    """Try so many frames; returns what came out and the faults found."""
    chance = random.Random(seed)
    slave = Slave(ecsim.Plc(model).memory)
    outcomes, faults = Counter(), []
    for _ in range(count):
        frame = mutated(chance, model)
        listening = slave.listening
        answer = slave.hear(Heard(frame[:256], overrun=len(frame) > 256), "rtu")
        fault = wrong(frame, answer, listening, model)
        if fault:
            faults.append(f"{frame.hex(' ')}: {fault}")
        outcomes["silence" if answer is None else "exception" if answer[1] & 0x80 else "answer"] += 1
        if slave.listening and chance.random() < 0.1:
            slave.receive(1, b"\x08\0\1\0\0")
    return outcomes, faults


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--count", type=int, default=100_000)
    arguments.add_argument("--seed", type=int, default=1)
    arguments.add_argument("--model", choices=MAPS, help="this one alone")
    options = arguments.parse_args()
    return max(report(options.count, options.seed, model) for model in ([options.model] if options.model else MAPS))


def report(count, seed, model):
    """Attack one model and print what came of it; 1 when something was wrong."""
    attack(1000, seed, model)  # what is loaded once is loaded now
    tracemalloc.start()
    attack(1000, seed, model)
    settled = tracemalloc.get_traced_memory()[0]
    began = time.perf_counter()
    outcomes, faults = attack(count, seed, model)
    seconds = time.perf_counter() - began
    grown = tracemalloc.get_traced_memory()[0] - settled
    tracemalloc.stop()
    print(f"{model}: {count} frames in {seconds:.1f} s:", ", ".join(f"{count} {what}" for what, count in outcomes.most_common()))
    print(
        f"{len(faults)} wrong; memory grew by {grown / 1024:.0f} KiB, at most {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024} MiB"
    )
    for fault in faults[:10]:
        print("  ", fault)
    return 1 if faults else 0


if __name__ == "__main__":
    raise SystemExit(main())
