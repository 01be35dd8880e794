"""Mutated frames: no exception escapes, no answer is wrong, whichever line they come by."""

import importlib.util
import random
import socket
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ecsim.comms.frames import MODES, BadFrame, Receiver, ascii_decode, rtu_decode, rtu_encode
from ecsim.comms.slave import Slave
from ecsim.memory import Memory
from ecsim.models import MODELS

PATH = Path(__file__).parent.parent.parent / "bench" / "fuzz_modbus.py"
_spec = importlib.util.spec_from_file_location("fuzz_modbus", PATH)
fuzz = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(fuzz)

MESSAGES = st.binary(max_size=253) | st.builds(
    lambda function, rest: bytes((function,)) + rest, st.sampled_from([1, 2, 3, 5, 6, 8, 15, 16]), st.binary()
)


@pytest.mark.parametrize("model", MODELS)
def test_mutated_frames_are_answered_as_the_manual_says(model):
    outcomes, faults = fuzz.attack(2500, seed=7, model=model)
    assert faults == []
    assert min(outcomes[what] for what in ("answer", "exception", "silence")) > 400


def test_the_oracle_notices_a_wrong_answer():
    read = rtu_encode(1, bytes.fromhex("0300000001"))
    assert fuzz.wrong(read, rtu_encode(1, b"\3\2\0\0"), False) == ""
    assert fuzz.wrong(read, rtu_encode(1, b"\3\3\0\0\0"), False)
    assert fuzz.wrong(read, rtu_encode(1, b"\x83\2"), False)
    assert fuzz.wrong(read, None, False)
    assert fuzz.wrong(read, rtu_encode(1, b"\3\2\0\0"), True)
    assert fuzz.wrong(read[:-1], rtu_encode(1, b"\3\2\0\0"), False)


@pytest.mark.parametrize(
    ("model", "message", "code"),
    [  # reading a step, 32-bit counters in a middle, the last M of each model, inputs by function 2
        ("H2U", "01 E000 0001", 0), ("EC20", "01 E000 0001", 2), ("H2U", "03 F701 0002", 2), ("H2U", "03 F702 0002", 0),
        ("H2U", "01 0BFF 0001", 0), ("H2U", "01 0C00 0001", 2), ("H1U", "01 0600 0001", 2), ("H1U", "01 05FF 0001", 0),
        ("H2U", "02 F800 0008", 0), ("EC20", "02 0000 0008", 0), ("H2U", "06 F700 0001", 2), ("H2U", "01 FD00 0001", 2),
    ],
)  # fmt: skip
def test_the_oracle_knows_the_addresses_of_each_model(model, message, code):
    message = bytes.fromhex(message)
    assert fuzz.exception(message, model) == code
    assert (Slave(Memory(MODELS[model])).answer(message)[0] >= 0x80) == bool(code)


@pytest.mark.parametrize("model", ["EC20", "H2U"])
@given(message=MESSAGES)
def test_any_message_has_an_answer_of_its_function(message, model):
    slave = Slave(Memory(MODELS[model]))
    answer = slave.answer(message)
    if slave.listening:
        assert answer is None
    else:
        assert answer[0] & 0x7F == (message[0] if message else 0) & 0x7F
        assert len(answer) <= 253


@given(octets=st.binary(max_size=600))
def test_any_characters_are_a_frame_or_a_bad_one(octets):
    for decode in (rtu_decode, ascii_decode):
        try:
            station, message = decode(octets)
        except BadFrame:
            continue
        assert 0 <= station <= 255
        assert message


@pytest.mark.parametrize("mode", list(MODES))
def test_any_characters_at_any_time_keep_a_receiver_whole(mode):
    chance = random.Random(3)
    receiver, slave, now = Receiver(MODES[mode], 500), Slave(Memory(MODELS["EC20"])), 0.0
    alphabet = b":0123456789ABCDEF\r\n\xff\x00"
    for _ in range(20_000):
        now += 500 * chance.choice([1, 1, 1, 1, 2, 3, 6])
        ended = [receiver.end()] if receiver.due is not None and now >= receiver.due else []
        for heard in [*ended, receiver.hear(chance.choice(alphabet), now, garbled=chance.random() < 0.01)]:
            if heard is not None:
                slave.hear(heard, mode)
        assert len(receiver.octets) <= MODES[mode].longest
    assert slave.counts["garbled"] > 50


def test_mutated_frames_over_tcp_leave_the_server_alive(server):
    chance = random.Random(5)
    for _ in range(100):
        with socket.create_connection(("127.0.0.1", server.port), timeout=10) as peer:
            frame = bytearray(b"\0\1\0\0\0\6\1" + fuzz.sound(chance))
            for _ in range(chance.randrange(4)):
                frame[chance.randrange(len(frame))] = chance.randrange(256)
            if frame[7:10] != b"\x08\0\4":  # listen-only mode would be no sign of life
                peer.sendall(bytes(frame))
    with socket.create_connection(("127.0.0.1", server.port), timeout=10) as peer:
        echo = bytes.fromhex("0008 0000 0006 01 08 0000 1234")
        peer.sendall(echo)
        answer = b""
        while len(answer) < len(echo):
            answer += peer.recv(100)
    assert answer == echo
