"""Timers and counters in a bare page, on a real PLC that stands still."""

import pytest

pytestmark = pytest.mark.browser

PROGRAM = """
VAR_GLOBAL
  Settle AT T0
END_VAR
PROGRAM MAIN
LD X0
TON Settle 5
LD X1
TON T210 250
LD X2
CTU C0 3
LD X2
DCNT C200 -10
LD SM1
SET S0
STL S0
LD X7
SET S20
STL S20
OUT Y2
RET
END_PROGRAM
"""


@pytest.fixture
def timers(bench, make_lab):
    """The timers of a lab."""
    bench.lab = make_lab(PROGRAM)
    bench.connect(bench.lab.panel("timers"))
    return bench


def scan(bench, count=1):
    bench.lab.session.scan(count)
    bench.settle()


def test_a_timer_counts_to_its_preset_and_closes_its_contact(timers):
    row = timers["row-T0"]
    assert [row.locator(part).inner_text() for part in (".dev", ".nm", ".kind", ".preset", ".base")] == [
        "T0",
        "Settle",
        "TON",
        "5",
        "100 ms",
    ]
    timers.lab.plc["X0"] = 1
    scan(timers, 32)  # the first execution counts nothing: 310 ms
    assert timers["T0"].inner_text() == "3"
    assert row.locator(".say").inner_text() == "0.3 s, 0.2 s to go"
    assert float(row.locator(".fill rect").get_attribute("width")) == 180  # 3 of 5 of 300
    assert row.locator(".mini").get_attribute("aria-label") == "contact open"
    scan(timers, 25)
    assert (row.get_attribute("data-state"), row.locator(".mini").get_attribute("aria-label")) == ("done", "contact closed")


def test_values_can_be_read_in_seconds(timers):
    timers.lab.plc["X1"] = 1
    scan(timers, 42)
    row = timers["row-T210"]
    assert (row.locator(".val").inner_text(), row.locator(".preset").inner_text()) == ("41", "250")
    timers["seconds"].click()
    assert (row.locator(".val").inner_text(), row.locator(".preset").inner_text()) == ("0.41 s", "2.50 s")  # 10 ms each
    assert timers["row-C0"].locator(".preset").inner_text() == "3"
    scan(timers, 10)
    assert row.locator(".val").inner_text() == "0.51 s"
    timers["seconds"].click()
    assert row.locator(".val").inner_text() == "51"


def test_small_presets_are_counted_in_segments_and_up_down_counters_grow_from_zero(timers):
    for level in (1, 0, 1, 0):
        timers.lab.plc["X2"] = level
        scan(timers)
    assert timers["row-C0"].locator(".track rect").count() == 3
    assert timers["row-C0"].locator(".fill rect").count() == 2
    bar = timers["row-C200"].locator(".fill rect")
    assert (float(bar.get_attribute("x")), float(bar.get_attribute("width"))) == (150, 24)  # 2 of 10, and 10 are 120 wide
    assert timers["row-C200"].locator(".preset").inner_text() == "\N{MINUS SIGN}10"


def test_the_active_step_tells_its_time(timers):
    scan(timers, 31)
    steps = timers["timers"].locator(".steps tr[data-device]")
    assert steps.count() == 1
    assert steps.locator(".dev").inner_text() == "S0"
    assert steps.locator(".scans").inner_text() == "30 scans"
    assert steps.locator(".val").inner_text() == "0.30"
    timers.lab.plc["X7"] = 1
    scan(timers, 2)
    assert timers["timers"].locator(".steps .dev").inner_text() == "S20"


def test_many_rows_scroll_in_the_panel_below_their_heads_and_all_come_to_be_drawn(bench, make_lab):
    lab = make_lab("\n".join(f"LD SM0\nTON T{number} 900" for number in range(120)))
    bench.connect(lab.panel("timers"))
    body = bench["timers"].locator(".timers-scroll")
    assert body.evaluate("(body) => [body.clientHeight, body.scrollHeight > 3000, body.tabIndex]") == [1280, True, 0]
    lab.session.scan(101)  # the first execution counts nothing: 1 s
    bench.settle()
    values = bench["timers"].locator("tr[data-device] .val").all_inner_texts()
    assert values == ["10"] * 120
    body.evaluate("(body) => { body.scrollTop = 2000; }")
    tops = "(body) => [body, body.querySelector('thead')].map((node) => Math.round(node.getBoundingClientRect().top))"
    top, head = body.evaluate(tops)
    assert top == head
