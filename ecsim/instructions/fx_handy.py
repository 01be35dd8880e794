"""FNC 60 to 69 of H1U and H2U: machines' habits as one instruction each (initial state, search, drums, timers, ramp, rotary table, sort)."""

from ..errors import OPERAND, Fault
from .define import FX, H2U, command, value

_WORDS = "KnX KnY KnM KnS T C D"
TENTH_US = 100_000

# IST: what stands from S on.
MANUAL, RETURN, STEP, CYCLE, CONTINUOUS, RETURN_START, START, STOP = range(8)


def _ascending(switches, first, last):
    return None if first.number < last.number else f"D1 = {first} is not below D2 = {last}"


@command(
    "FX:IST", "S:BOOL[X Y M S]*8 D1:POINT[S]=20..899 D2:POINT[S]=20..899 machine state -> state",
    steps=7, section="FNC 60", models=FX, check=_ascending,
)  # fmt: skip
def ist(s, d1, d2, machine, state):
    """Lead a chart by eight switches: by hand (S0), return to the origin (S1), automatic in steps, one cycle or many (S2).

    From S on stand: by hand, return, step, one cycle, continuous, start of the return, start, stop; the first mode that is ON
    counts. M8040 holds the transitions, M8041 lets a cycle begin, M8042 is the start in one scan, M8047 is ON. A change between by hand,
    return and automatic ends all steps and, unless M8045 is ON, turns all outputs OFF. D1 and D2 tell which steps are automatic.
    """
    mode = next((place for place in range(MANUAL, RETURN_START) if s[place]), None)
    lists, model = machine.memory.lists, machine.model
    relays = lists[model.special_bits]
    inhibit, begin, pulse, keep, monitor = (
        model.relays[meaning] for meaning in ("hold transitions", "transfer start", "start pulse", "outputs kept", "monitor steps")
    )
    relays[monitor] = True
    before, started = state or (None, True)
    rises = s[START] and not started
    if mode is None:
        return ((before, s[START]),)
    group = min(mode, STEP)
    steps = model.annunciators.start  # the states behind are no steps
    resumes = before is None and any(lists["S"][:steps])  # steps that have kept their state without power go on
    if not resumes and (before is None or group != min(before, STEP)):
        lists["S"][:steps] = [False] * steps
        lists["S"][group] = True
        if not relays[keep] and before is not None:
            lists["Y"][:] = [False] * len(lists["Y"])
    if mode != before:
        relays[inhibit], relays[begin] = mode in (MANUAL, STEP, CONTINUOUS), False
    relays[pulse] = rises
    if mode == STEP:
        relays[inhibit] = not rises
    elif mode != MANUAL:
        if s[STOP]:
            relays[inhibit] = relays[inhibit] or mode != CONTINUOUS
        elif rises or (mode == RETURN and s[RETURN_START]):
            relays[inhibit] = False
    if mode in (STEP, CYCLE):
        relays[begin] = s[START]
    elif mode == CONTINUOUS:
        relays[begin] = not s[STOP] and (relays[begin] or rises)
    return ((mode, s[START]),)


@value("FX:SER", f"S1:INT[{_WORDS}]*N S2:INT >D:INT[KnY KnM KnS T C D]*5 N:INT[const D]=1..256", steps=9, section="FNC 61", models=H2U)
@value("FX:DSER", f"S1:DINT[{_WORDS}]*N S2:DINT >D:DINT[KnY KnM KnS C D]*5 N:DINT[const D]=1..128", steps=17, section="FNC 61", models=H2U)
def ser(s1, s2, n):
    """From D on: how many of the N values from S1 on equal S2, the places of the first and the last of them, of the least and of the greatest value.

    Places count from 0. Without an equal value the first three are 0; of several least or greatest values the last one counts.
    """
    equal = [place for place, number in enumerate(s1) if number == s2]
    last = {number: place for place, number in enumerate(s1)}
    return [len(equal), *((equal[0], equal[-1]) if equal else (0, 0)), last[min(s1)], last[max(s1)]]


@value(
    "FX:ABSD", f"S1:INT[{_WORDS}]*{{2*N}} S2:INT[C] >D:BOOL[Y M S]*N N:INT[const]=1..64", steps=9, section="FNC 62", models=FX, pulsed=False
)
@value(
    "FX:DABSD",
    f"S1:DINT[{_WORDS}]*{{2*N}} S2:DINT[C] >D:BOOL[Y M S]*N N:DINT[const]=1..64",
    steps=17,
    section="FNC 62",
    models=FX,
    pulsed=False,
)
def absd(s1, s2, n):
    """A cam drum: each of the N bits from D on is ON while the counter S2 stands from its first value of the table at S1 to below its second one.

    A cam whose second value is the smaller one goes over the zero of the drum.
    """
    cams = list(zip(s1[::2], s1[1::2], strict=True))
    return [on <= s2 < off if on <= off else s2 >= on or s2 < off for on, off in cams]


@command(
    "FX:INCD", f"S1:INT[{_WORDS}]*N S2:INT[C]*2 >D:BOOL[Y M S]*N N:INT[const]=1..64 -> S2 complete", steps=9, section="FNC 63", models=FX
)
def incd(flow, s1, s2, n):
    """A drum that steps: one of the N bits from D on is ON until the counter S2 has reached its value of the table at S1.

    Then S2 begins again at 0 and the counter behind it, which holds the place, goes on; M8029 is ON in the scan after the last place.
    Without flow both counters are cleared and the bits OFF.
    """
    if not flow:
        return [0, 0], [False] * n, False
    count, place = s2[0], s2[1] % n
    done = False
    if count >= s1[place]:
        count, place = 0, place + 1
        done = place == n
        place %= n
    return [count, place], [each == place for each in range(n)], done


@command("FX:TTMR", "D:INT[D]*2 N:INT[const]=0..2 now state -> D state", steps=5, section="FNC 64", models=H2U)
def ttmr(flow, d, n, now, state):
    """D becomes the time for which the flow was ON: seconds for N = 0, tenths for 1, hundredths for 2; D+1 shows tenths meanwhile."""
    if not flow:
        return [d[0], 0], False
    since = state[0] if state else now
    passed = now - since
    return [min(passed * 10**n // 1_000_000, 32767), min(passed // TENTH_US, 32767)], (since,)


def _tenths(timer, preset, target):
    return f"S = {timer} does not count tenths of a second; T0 to T199 do" if timer.number > 199 else None


@command(
    "FX:STMR", "S:INT[T]! M:INT[const]=1..32767 >D:BOOL[Y M S]*4 now state -> S state", steps=7, section="FNC 65", models=H2U, check=_tenths
)
def stmr(flow, s, m, now, state):
    """Four bits from the flow, with M tenths of a second: off-delay, pulse after OFF, pulse after ON, ON-and-off-delay.

    D is ON with the flow and for M longer, D+1 for M after it has gone OFF, D+2 for M after it has come ON; D+3 comes M after
    the flow and goes M after it. The timer S shows the tenths since the last change.
    """
    was, since, late = state or (False, now, False)
    if flow is not was:
        since = now
    tenths = min((now - since) // TENTH_US, m)
    running = tenths < m
    if flow:
        late = not running if flow is was else False
        return tenths, [True, False, running, late], (True, since, late)
    late = late and running
    return tenths if running else 0, [running, running, False, late], (False, since, late) if running else False


@value("FX:ALT", "D:BOOL[Y M S] -> D", steps=3, section="FNC 66", models=FX)
def alt(d):
    """Turn D over in each scan with flow, so that ALTP turns it over at each rise."""
    return not d


@command(
    "FX:RAMP", "S1:INT[D] S2:INT[D] D:INT[D]*2 N:INT[const]=1..32767 hold state -> D complete state", steps=9, section="FNC 67", models=FX
)  # fmt: skip
def ramp(flow, s1, s2, d, n, hold, state):
    """D goes from S1 to S2 in N scans, which D+1 counts; M8029 tells of the end. Then it begins again, or stays while M8026 is ON."""
    if not flow:
        return d, False, False
    scan = (state or 0) + 1
    if scan > n:
        scan = n if hold else 1
    return [s1 + (2 * (s2 - s1) * scan + n) // (2 * n), scan], scan == n, scan


@command(
    "FX:ROTC", "S:INT[D]*3 M1:INT[const]=2..32767 M2:INT[const]=0..32767 D:BOOL[Y M S]*8 state -> S D state",
    steps=9, section="FNC 68", models=H2U, check=lambda s, m1, m2, d: f"M2 = {m2} is greater than M1 = {m1}" if m2 > m1 else None,
)  # fmt: skip
def rotc(flow, s, m1, m2, d, state):
    """Turn a table of M1 places the shorter way until the item S+2 stands at the window S+1; within M2 places of it slowly.

    S counts the places from phases A (D) and B (D+1), up while A is ON and B rises; D+2 is its zero. Behind them D+3 to D+7
    are: forward fast, forward slowly, stop, backward slowly, backward fast. Item 0 stands at window 0 while S is 0.
    """
    place, window, item = s
    a, b, zero = d[:3]
    if not flow:
        return s, [*d[:3], *[False] * 5], False
    if not (0 <= window < m1 and 0 <= item < m1):
        raise Fault(OPERAND)
    before = state[0] if state else b
    if a and b is not before:
        place = (place + (1 if b else -1)) % m1
    if zero:
        place = 0
    ahead = (item - window - place) % m1
    behind = m1 - ahead
    motor = 2 if not ahead else (0 if ahead > m2 else 1) if ahead <= behind else (4 if behind > m2 else 3)
    return [place, window, item], [a, b, zero, *(each == motor for each in range(5))], (b,)


@command(
    "FX:SORT", "S:INT[D]*{M1*M2} M1:INT[const]=1..32 M2:INT[const]=1..6 D:INT[D]*{M1*M2} N:INT[const D]=1..6 state -> D complete state",
    steps=11, section="FNC 69", models=H2U,
)  # fmt: skip
def sort(flow, s, m1, m2, d, n, state):
    """The table from D on becomes the one from S on, its M1 rows in the order of column N; M2 columns stand one after the other.

    That takes M1 scans with flow; M8029 tells of the end. Rows that are equal keep their order.
    """
    if not flow:
        return d, False, False
    if n > m2:
        raise Fault(OPERAND)
    scan = (state or 0) + 1
    if scan < m1:
        return d, False, scan
    if scan == m1:
        rows = sorted((s[row::m1] for row in range(m1)), key=lambda row: row[n - 1])
        d = [row[column] for column in range(m2) for row in rows]
    return d, True, m1
