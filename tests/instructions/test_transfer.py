"""Moves, blocks, stacks and word strings against Python's lists."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, rule

import ecsim

INTS = st.integers(-0x8000, 0x7FFF)
WORDS = st.integers(0, 0xFFFF)
DWORDS = st.integers(0, 0xFFFF_FFFF)


def put(plc, first, values):
    plc.set({f"D{first + place}": value for place, value in enumerate(values)})


def block(plc, first, count):
    return [plc[f"D{first + place}"] for place in range(count)]


@given(word=WORDS, double=DWORDS)
def test_moves_keep_every_bit_between_registers_and_bits(running, word, double):
    plc = running("LD SM0\nMOV D0 K4M0\nMOV K4M0 D10\nDMOV D2 K8Y0\nDMOV K8Y0 D12\nRMOV D12 D14\nDMOV D14 C200\nDMOV C200 D16")
    plc.set({"D0:WORD": word, "D2:DWORD": double})
    plc.scan()
    assert plc["D10:WORD"] == word
    assert plc["D12:DWORD"] == plc["D14:DWORD"] == plc["D16:DWORD"] == double


@given(nibbles=st.integers(1, 4), word=WORDS)
def test_a_short_kn_string_takes_the_low_bits_and_is_filled_up_with_zeros(running, nibbles, word):
    plc = running(f"LD SM0\nMOV D0 K{nibbles}M0\nMOV K{nibbles}M0 D10")
    plc.set({"D0:WORD": word, f"M{4 * nibbles}": 1})
    plc.scan()
    low = word % 16**nibbles
    assert plc["D10:WORD"] == low
    assert plc[f"M{4 * nibbles}"] == 1


@given(values=st.lists(INTS, min_size=1, max_size=40), shift=st.integers(-40, 40))
def test_a_block_is_read_before_it_is_written(running, values, shift):
    plc = running("LD SM0\nBMOV D1000 D1000Z0 D0")
    plc.set({"D0": len(values), "Z0": shift})
    put(plc, 1000, values)
    plc.scan()
    assert block(plc, 1000 + shift, len(values)) == values


@given(count=st.integers(0, 300), value=INTS, double=DWORDS)
def test_a_fill_writes_its_elements_and_no_more(running, count, value, double):
    plc = running("LD SM0\nFMOV -1 D999 700\nFMOV D0 D1000 D1\nDFMOV D2 D1300 D1")
    plc.set({"D0": value, "D1": min(count, 190), "D2:DWORD": double})
    plc.scan()
    count = min(count, 190)
    assert block(plc, 999, count + 2) == [-1, *[value] * count, -1]
    assert [plc[f"D{1300 + 2 * place}:DWORD"] for place in range(count)] == [double] * count
    assert plc[f"D{1300 + 2 * count}"] == -1


@given(text=st.binary(min_size=6, max_size=6))
def test_swap_and_exchange_move_bytes_and_words(running, text):
    plc = running("LD SM0\nSWAP D0\nXCH D1 D2\nDXCH D10 K8M0")
    first, second, third = (int.from_bytes(text[place : place + 2], "big") for place in (0, 2, 4))
    plc.set({"D0:WORD": first, "D1:WORD": second, "D2:WORD": third, "D10:WORD": third, "D11:WORD": first, "K8M0:DWORD": second})
    plc.scan()
    assert plc["D0:WORD"] == int.from_bytes(text[:2], "little")
    assert (plc["D1:WORD"], plc["D2:WORD"]) == (third, second)
    assert (plc["D10:DWORD"], plc["K8M0:DWORD"]) == (second, third << 16 | first)


@given(string=st.lists(INTS, min_size=1, max_size=20), new=st.lists(INTS, min_size=25, max_size=25), by=st.integers(-2, 25))
def test_word_strings_move_and_take_new_words_in(running, string, new, by):
    for name, moved in (("WSFR", string[by:] + new[:by]), ("WSFL", new[:by] + string[: len(string) - by])):
        plc = running(f"LD SM0\n{name} D100 D1000 D0 D1")
        plc.set({"D0": len(string), "D1": by})
        put(plc, 100, new)
        put(plc, 1000, string)
        plc.scan()
        legal = 0 <= by <= len(string)
        assert block(plc, 1000, len(string)) == (moved if legal else string)
        assert (plc["SM20"], legal or plc["SD20"] == 64) == (not legal, True)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("FMOV K1M0 K2Y0 3", "same n in Kn"),
        ("DXCH K8M0 K5M100", "same n in Kn"),
        ("FMOV 5 D0 -1", "goes from 0 to 32767"),
        ("BMOV D0 D7998 3", "'D7998' reaches beyond D7999"),
        ("BMOV C198 D0 3", "'C198' reaches beyond C199"),
        ("PUSH D0 D7997 3", "'D7997' reaches beyond D7999"),
        ("DMOV T0 D0", "cannot be S"),
        ("BMOV Z0 D0 1", "cannot be S1"),
    ],
)
def test_what_cannot_be_is_refused_with_the_operand_and_the_reason(line, message):
    with pytest.raises(ecsim.ProgramError, match=message):
        ecsim.compile(f"LD X0\n{line}", "EC20")


class Stack(RuleBasedStateMachine):
    """PUSH, FIFO and LIFO on one block of registers beside a list."""

    engine = "compiled"

    @initialize(size=st.integers(1, 6))
    def begin(self, size):
        self.plc = ecsim.Plc("EC20")
        self.plc.tracing = self.engine == "stepping"
        self.plc.load("LD M0\nPUSH D0 D100 D1\nLD M1\nFIFO D100 D2 D1\nLD M2\nLIFO D100 D2 D1")
        self.plc.run()
        self.size, self.cells, self.count = size, [0] * size, 0
        self.plc["D1"] = size

    def act(self, relay):
        self.plc.set({"M0": 0, "M1": 0, "M2": 0, relay: 1})
        self.plc.scan()
        self.plc[relay] = 0

    @rule(value=INTS)
    def push(self, value):
        self.plc["D0"] = value
        self.act("M0")
        full = self.count == self.size
        if not full:
            self.cells[self.count] = value
            self.count += 1
        assert self.plc["SM181"] == full

    @rule(relay=st.sampled_from(["M1", "M2"]))
    def take(self, relay):
        self.plc["D2"] = -77
        self.act(relay)
        if self.count == 0:
            assert self.plc["D2"] == -77
        elif relay == "M1":
            assert self.plc["D2"] == self.cells[0]
            self.cells = [*self.cells[1:], 0]
            self.count -= 1
        else:
            assert self.plc["D2"] == self.cells[self.count - 1]
            self.count -= 1
        assert self.plc["SM180"] == (self.count == 0)

    @rule(count=st.sampled_from([-1, 1]))
    def spoil(self, count):
        """A count outside 0 to the size is error 70, and nothing is written."""
        wrong = -5 if count < 0 else self.size + 1
        self.plc["D100"] = wrong
        self.act("M0")
        assert (self.plc["SM20"], self.plc["SD20"], self.plc["D100"]) == (1, 70, wrong)
        self.plc["D100"] = self.count

    @invariant()
    def the_registers_are_as_the_list(self):
        if hasattr(self, "plc"):
            assert [self.plc["D100"], *(self.plc[f"D{101 + place}"] for place in range(self.size))] == [self.count, *self.cells]
            assert self.plc[f"D{101 + self.size}"] == 0


class SteppingStack(Stack):
    engine = "stepping"


TestStack = Stack.TestCase
TestSteppingStack = SteppingStack.TestCase
TestStack.settings = TestSteppingStack.settings = settings(max_examples=30, stateful_step_count=30)
