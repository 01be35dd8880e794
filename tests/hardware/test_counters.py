"""High-speed counters against an independent model that steps every single edge, and the frequencies that they can follow."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ecsim import Plc
from ecsim.hardware.signals import Edges, Train

SCAN_US = (1_000, 3_700, 10_000)
WIRING = {  # 8.1.1, written down once more: counter -> mode, counting inputs, reset, start
    236: ("single", (0,), None, None), 244: ("single", (0,), 2, 6), 245: ("single", (3,), 5, 7),
    246: ("up/down", (0, 1), None, None), 249: ("up/down", (0, 1), 2, 6), 250: ("up/down", (3, 4), 5, 7),
    251: ("phases", (0, 1), None, None), 254: ("phases", (0, 1), 2, 6), 255: ("phases", (3, 4), 5, 7),
}  # fmt: skip


def edges_of(signal, until):
    """Every edge of a signal up to a time, found by asking for its level at each microsecond's neighbour."""
    if isinstance(signal, Edges):
        level, found = signal.first, []
        for moment in signal.times:
            level = not level
            found.append((moment, level))
        return [edge for edge in found if edge[0] <= until]
    found = []
    for place in range(signal.total if signal.total is not None else until):
        for phase, level in ((signal.rise, True), (signal.fall, False)):
            moment = signal.start + (1000 * place + phase) * signal.span // (1000 * signal.pulses)
            if moment > until:
                return found
            found.append((moment, level))
    return found


class BruteForce:
    """One counter that is told of single edges, in order of time and, within a microsecond, of input."""

    def __init__(self, number, levels, preset, down):
        self.mode, self.counting, self.reset, self.start = WIRING[number]
        self.levels, self.preset, self.down = dict(levels), preset, down
        self.value, self.contact = 0, False
        self.hits = []
        self._clear()

    def _clear(self):
        if self.reset is not None and self.levels[self.reset]:
            self.value, self.contact = 0, False

    def edge(self, moment, number, level, wanted):
        self.levels[number] = level
        open_ = not (self.reset is not None and self.levels[self.reset]) and (self.start is None or self.levels[self.start])
        delta = 0
        if self.mode == "single" and number == self.counting[0] and level:
            delta = -1 if self.down else 1
        elif self.mode == "up/down" and number in self.counting and level:
            delta = 1 if number == self.counting[0] else -1
        elif self.mode == "phases" and number == self.counting[1] and self.levels[self.counting[0]]:
            delta = 1 if level else -1
        if delta and open_:
            self.value += delta
            if delta > 0 and self.value >= self.preset:
                self.contact = True
            if delta < 0 and self.value <= self.preset:
                self.contact = False
            if self.value == wanted:
                self.hits.append(moment)
        self._clear()


@st.composite
def signals(draw, begin, busy):
    """A signal that begins at a moment: a pulse train, or edges at random."""
    if draw(st.booleans()) or not busy:
        pulses = draw(st.integers(1, 40))
        span = draw(st.integers(pulses * 8, 60_000))
        rise = draw(st.integers(130, 700))  # with periods of 8 us and more each level holds for a microsecond at least
        fall = draw(st.integers(rise + 130, 870))
        return Train(begin, span, pulses, draw(st.sampled_from((pulses, pulses // 2, None))), rise, fall)
    gaps = draw(st.lists(st.integers(1, 4_000), max_size=30))
    times = []
    for gap in gaps:
        begin += gap
        times.append(begin)
    return Edges(tuple(times))


@st.composite
def scenes(draw):
    number = draw(st.sampled_from(sorted(WIRING)))
    mode, counting, reset, start = WIRING[number]
    scan = draw(st.sampled_from(SCAN_US))
    inputs = {n: draw(signals(scan, True)) for n in counting if draw(st.integers(0, 5))}
    if mode == "phases" and draw(st.booleans()):
        cycles, span, total = draw(st.integers(1, 40)), draw(st.integers(400, 60_000)), draw(st.integers(0, 40))
        phases = [(125, 625), (375, 875)]
        if draw(st.booleans()):
            phases.reverse()
        inputs = {n: Train(scan, span, cycles, total, *phase) for n, phase in zip(counting, phases, strict=True)}
    held = {}
    for n in (reset, start):
        if n is not None:
            if draw(st.integers(0, 2)):
                held[n] = draw(st.booleans()) if n == reset else draw(st.integers(0, 3)) > 0
            else:
                inputs[n] = draw(signals(scan, True))
    return number, scan, inputs, held, draw(st.integers(-20, 30)), draw(st.integers(-20, 30)), draw(st.booleans())


@settings(max_examples=250)
@given(scenes(), st.integers(1, 8))
def test_counters_agree_with_a_model_that_steps_single_edges(scene, scans):
    number, scan, inputs, held, preset, wanted, down = scene
    direction = f"LD SM0\nOUT SM{number}\n" if down and number < 246 else ""
    plc = Plc("EC20", scan_ms=scan / 1000)
    plc.load(
        f"PROGRAM MAIN\nLD SM1\nEI\nSET SM65\n{direction}LD SM0\nHCNT C{number} {preset}\nDHSCI {wanted} C{number} 20\nDHSCS {wanted} C{number} M7\n"
        "END_PROGRAM\nINTERRUPT I EVENT 20\nLD SM0\nINC D0\nEND_INTERRUPT"
    )
    plc.run()
    plc.set({f"X{n}": level for n, level in held.items()})
    plc.scan()
    levels = {n: held.get(n, False) for n in range(8)}
    for n, signal in inputs.items():
        plc.inputs.drive(n, signal, plc.time_us)
        levels[n] = signal.level(plc.time_us)
    model = BruteForce(number, levels, preset, down)
    until = scan
    for _ in range(scans):
        since, until = until, until + scan
        stepped = sorted((moment, n, level) for n, signal in inputs.items() for moment, level in edges_of(signal, until) if moment > since)
        for moment, n, level in stepped:
            model.edge(moment, n, level, wanted)
        plc.scan()
        assert (plc[f"C{number}"], plc[f"C{number}:BOOL"]) == (model.value, int(model.contact))
        assert (plc["D0"], plc["M7"]) == (len(model.hits), int(bool(model.hits)))


@settings(max_examples=200)
@given(signals(500, True), st.integers(0, 70_000), st.integers(0, 70_000), st.integers(1, 9))
def test_a_signal_answers_as_its_edges_do(signal, one, other, n):
    after, until = min(one, other), max(one, other)
    edges = edges_of(signal, 4_000_000 if isinstance(signal, Edges) or signal.total is not None else 700_000)
    for rising in (True, False):
        inside = [moment for moment, level in edges if level is rising and after < moment <= until]
        assert signal.count(rising, after, until) == len(inside)
        later = [moment for moment, level in edges if level is rising and moment > after]
        if len(later) >= n:
            assert signal.time(rising, after, n) == later[n - 1]
        elif signal.end is not None:
            assert signal.time(rising, after, n) is None
    past = [edge for edge in edges if edge[0] <= until]
    rises = sum(level for _, level in past)
    assert signal.level(until) == (2 * rises > len(past))


def test_a_long_train_is_counted_without_its_edges_being_stepped(monkeypatch):
    plc = Plc("EC20")
    plc.load("LD SM0\nHCNT C236 0\nDHSCS 2000000 C236 M0")
    plc.run()
    plc.scan()
    plc.square("X0", hz=50_000)
    monkeypatch.setattr(Train, "edges", lambda *_: pytest.fail("an edge was stepped"))
    plc.advance(ms=60_000)
    assert plc["C236"] == 3_000_000
    assert plc["M0"] == 1


def test_frequencies_beyond_the_limits_are_reported():
    plc = Plc("EC20")
    plc.load("LD SM0\nHCNT C236 0\nHCNT C237 0")
    plc.run()
    plc.scan()
    plc.square("X0", hz=50_000)
    assert plc.warnings == []
    plc.square("X1", hz=50_000)
    assert plc.warnings == ["the counters get 100 kHz together, 80 kHz are allowed (manual 8.1.4)"]


@pytest.mark.parametrize(
    ("program", "hz", "limit"),
    [
        ("HCNT C236 0", 51_000, 50),
        ("HCNT C236 0\nDHSCS 5 C236 M0", 11_000, 10),
        ("HCNT C236 0\nDHSZ 1 2 C236 M0", 6_000, 5),
        ("HCNT C242 0", 11_000, 10),
    ],
)
def test_a_comparison_lowers_the_greatest_frequency(program, hz, limit):
    plc = Plc("EC20")
    plc.load(f"LD SM0\n{program}")
    plc.run()
    plc.scan()
    plc.square("X0", hz=limit * 1000)
    assert plc.warnings == []
    plc.square("X0", hz=hz)
    assert len(plc.warnings) == 1
    assert f"counts up to {limit} kHz" in plc.warnings[0]


def test_a_comparison_sets_its_output_at_the_edge_however_late_the_scan():
    plc = Plc("EC20", scan_ms=1000)
    plc.load(
        "PROGRAM MAIN\nLD SM1\nEI\nSET SM66\nMOV 1 SD66\nLD SM0\nHCNT C236 0\nDHSCS 5 C236 Y10\nEND_PROGRAM\nINTERRUPT I EVENT 26\nLDI Y10\nINC D0\nEND_INTERRUPT"
    )
    plc.run()
    plc.scan()
    plc.pulse("X0", count=10, ms=100)  # the fifth pulse rises at 40 + 2.5 ms
    plc.scan()
    assert plc["Y10"] == 1
    assert plc["D0"] == 1000 + 42  # the interrupt of every millisecond saw Y10 OFF up to there


def test_a_step_back_restores_counters_and_signals():
    plc = Plc("EC20")
    plc.load("LD SM0\nHCNT C236 50\nDHST D0 1 C236\nSPD X3 70 D10\nPLSY 1230 0 Y0\nDRVI 9000 7000 Y1 Y5")
    plc.run()
    plc["D1"] = 77
    plc.scan(2)
    plc.pulse("X0", count=100, ms=200)
    plc.square("X3", hz=333)
    plc.scan(3)
    kept = plc.snapshot()
    plc.scan(20)
    first = (plc.memory.snapshot(), plc.outputs.times(0, plc.time_us))
    plc.scan(7)
    plc.restore(kept)
    plc.scan(20)
    assert (plc.memory.snapshot(), plc.outputs.times(0, plc.time_us)) == first
