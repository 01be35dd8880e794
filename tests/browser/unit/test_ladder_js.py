"""The ladder panel with a real PLC behind it: chosen, written, forced, and gone from place to place by keys and by the pointer."""

import pytest
from playwright.sync_api import expect

pytestmark = pytest.mark.browser

PROGRAM = "\n".join(["LD X0", "OUT M0", *(f"LD M{number}\nOUT Y{number:o}" for number in range(1, 9)), "LD M0", "MOV 5 D0"])


@pytest.fixture
def still(make_lab):
    return make_lab(PROGRAM)


@pytest.fixture
def ladder(bench, still):
    """The ladder of a PLC that stands still."""
    bench.connect(still.panel("ladder"))
    return bench


def element(ladder, position):
    return ladder["ladder"].locator(f'[data-position="{position}"]')


def focused(ladder):
    return ladder.js("() => document.activeElement.dataset?.position")


def test_a_click_chooses_and_frames_the_element(ladder):
    element(ladder, 1).click()
    expect(ladder["ladder"].locator("rect.selected")).to_have_count(1)
    frame = ladder["ladder"].locator("rect.selected").bounding_box()
    symbol = element(ladder, 1).bounding_box()
    assert frame["x"] <= symbol["x"]
    assert frame["y"] <= symbol["y"]
    assert frame["x"] + frame["width"] >= symbol["x"] + symbol["width"]
    element(ladder, 0).click()
    expect(ladder["ladder"].locator("rect.selected")).to_have_count(1)


def test_a_double_click_opens_the_plate_and_forces(ladder, still):
    element(ladder, 0).dblclick()
    ladder.settle()
    ladder["force-on"].click()
    ladder.settle()
    still.session.scan(2)
    ladder.settle()
    assert still.plc.forced == {"X0": 1}
    expect(element(ladder, 1)).to_have_class("coil flow")
    expect(element(ladder, 0).locator(".forced-badge, .forced-text").last).to_be_visible()
    ladder.page.keyboard.press("Escape")
    expect(ladder["plate"]).to_have_count(0)


def test_enter_writes_a_word_that_a_box_writes(ladder, still):
    position = len(still.plc.program.instructions) - 1
    element(ladder, position).focus()
    ladder.page.keyboard.press("Enter")
    ladder.settle()
    ladder["plate-value"].fill("1234")
    ladder.page.keyboard.press("Enter")
    ladder.settle()
    assert still.plc["D0"] == 1234


def test_u_lists_the_places_of_use_and_goes_there(ladder):
    element(ladder, 1).focus()
    ladder.page.keyboard.press("u")
    ladder.settle()
    expect(ladder["uses"].locator("button")).to_have_count(2)
    expect(ladder["uses"]).to_contain_text("used in 2 places")
    ladder.page.keyboard.press("Enter")  # the other place has the focus
    assert focused(ladder) == "18"
    expect(ladder["uses"]).to_have_count(0)
    assert ladder.js(
        "() => { const box = document.activeElement.getBoundingClientRect(); return box.top >= 0 && box.bottom <= innerHeight; }"
    )


def test_arrows_go_along_a_network_and_between_networks(ladder):
    element(ladder, 0).focus()
    seen = []
    for name in ("ArrowRight", "ArrowDown", "ArrowLeft", "ArrowUp"):
        ladder.page.keyboard.press(name)
        seen.append(focused(ladder))
    assert seen == ["1", "3", "2", "0"]


def test_escape_leaves_the_list_and_returns_to_the_element(ladder):
    element(ladder, 1).focus()
    ladder.page.keyboard.press("U")
    ladder.settle()
    ladder.page.keyboard.press("Escape")
    assert focused(ladder) == "1"


def test_the_chosen_element_stays_chosen_when_the_width_changes(ladder):
    element(ladder, 1).click()
    ladder.page.set_viewport_size({"width": 700, "height": 900})
    ladder.frame()
    ladder.settle()
    expect(ladder["ladder"].locator("rect.selected")).to_have_count(1)


# -- a large program: only what is looked at is drawn --------------------------------------------------------------

RUNGS = 2000
LARGE = "\n".join(f"LD X{n % 8}\nANI X7\nOUT M{n % 1990}" for n in range(RUNGS))


@pytest.fixture
def large(bench, make_lab):
    bench.lab = make_lab(LARGE)
    bench.connect(bench.lab.panel("ladder"))
    return bench


def drawn(ladder):
    return ladder.js("() => [...document.querySelectorAll('.net')].map((net) => Number(net.dataset.network))")


def visible(ladder):
    return ladder.js("""() => {
      const outer = document.querySelector('.ladder-scroll').getBoundingClientRect();
      return [...document.querySelectorAll('.net')].filter((net) => {
        const box = net.getBoundingClientRect();
        return box.bottom > outer.top + 1 && box.top < outer.bottom - 1;
      }).map((net) => Number(net.dataset.network));
    }""")


def scroll(ladder, height):
    ladder.js("(height) => { document.querySelector('.ladder-scroll').scrollTop = height; }", height)
    ladder.frame()
    ladder.settle()


def test_about_three_screens_are_drawn_and_all_can_be_scrolled_to(large):
    body = large["ladder"].locator(".ladder-scroll")
    assert body.evaluate("(body) => body.scrollHeight") > 150_000
    assert 10 < len(drawn(large)) < 40
    scroll(large, 10**6)
    assert visible(large)[-1] == RUNGS - 1
    assert len(drawn(large)) < 40
    assert large["where"].inner_text() == f"Network {visible(large)[0] + 1:,} of 2,000"
    scroll(large, 80_000)
    numbers = drawn(large)
    assert numbers == sorted(numbers)
    assert visible(large)[0] == int((80_000 - 8) / 84)  # each network is 84 px high


def test_what_is_scrolled_to_is_alive(large):
    scroll(large, 100_000)
    number = visible(large)[1]
    large.lab.plc[f"X{number % 8}"] = 1
    large.lab.session.scan(2)
    large.settle()
    expect(element(large, 3 * number + 2)).to_have_class("coil flow" if number % 8 != 7 else "coil open")


def test_what_was_seen_before_is_there_at_once_and_as_it_is_now(large):
    scroll(large, 100_000)
    there = visible(large)
    number = next(n for n in there if n % 8 == 3)
    scroll(large, 0)
    large.lab.plc["X3"] = 1
    large.lab.session.scan(2)
    large.settle()
    assert drawn(large)[-1] < 40  # what is far away is no element of the page
    large.js("() => { document.querySelector('.ladder-scroll').scrollTop = 100_000; }")
    large.frame()  # the kernel has not been asked yet
    assert visible(large) == there
    expect(element(large, 3 * number + 2)).to_have_class("coil flow")


def test_a_place_that_is_not_drawn_yet_is_gone_to(large):
    large["find"].fill("m1500")
    large.settle()
    large.page.keyboard.press("Enter")
    large.settle()
    assert focused(large) == str(3 * 1500 + 2)
    assert 1500 in visible(large)
    expect(large["ladder"].locator("rect.selected")).to_have_count(1)
    large.page.keyboard.press("u")
    large.settle()
    expect(large["uses"]).to_contain_text("network 1501")


def test_what_is_not_there_is_said_and_the_field_keeps_it(large):
    large["find"].fill("M9999x")
    large.settle()
    expect(large["uses"]).to_contain_text("nothing in this program")
    large.page.keyboard.press("Escape")
    expect(large["uses"]).to_have_count(0)
    expect(large["find"]).to_have_value("M9999x")


def test_the_arrows_go_on_into_networks_that_come_while_they_go(large):
    element(large, 0).focus()
    for number in range(1, 60):
        large.page.keyboard.press("ArrowDown")
        large.settle()
        assert focused(large) == str(3 * number)


def test_there_is_one_stop_of_tab_wherever_one_looks(large):
    stops = "() => document.querySelectorAll('.ladder-scroll [tabindex=\"0\"]').length"
    assert large.js(stops) == 1
    scroll(large, 90_000)
    assert large.js(stops) == 1


def test_what_has_the_focus_stays_though_it_is_scrolled_away(large):
    element(large, 3).focus()
    scroll(large, 90_000)
    assert focused(large) == "3"
    scroll(large, 0)
    assert focused(large) == "3"
    assert drawn(large)[:3] == [0, 1, 2]


def test_a_laid_out_anew_ladder_stands_where_it_was(large):
    scroll(large, 70_000)
    before = visible(large)[0]
    large.page.set_viewport_size({"width": 800, "height": 900})
    large.frame()
    large.settle()
    assert visible(large)[0] == before


def test_opened_again_without_a_kernel_the_networks_seen_last_are_shown(large):
    scroll(large, 70_000)
    before = visible(large)
    saved = large.js("() => ({ face: model.values.face, last: structuredClone(model.values.last) })")
    large.js("(values) => { show(values); model.gone = true; model.handlers['comm_live_update'](); }", saved)
    large.frame()
    assert set(visible(large)) & set(before)
    expect(large["ladder"].locator(".stamp")).to_contain_text("last state")


def test_a_view_that_goes_says_so(large):
    large.js("() => ends[0]()")
    assert [verb for verb, _ in large.asked("ladder")][-1] == "unsee"


# -- breakpoints ---------------------------------------------------------------------------------------------------


def test_b_sets_a_breakpoint_and_the_stop_is_shown_there(large):
    element(large, 3).focus()
    large.page.keyboard.press("b")
    large.settle()
    assert [point.text for point in large.lab.session.breakpoints] == ["X1"]
    marks = large["ladder"].locator(".break-mark.on")
    assert marks.count() == len([n for n in drawn(large) if n % 8 == 1])  # wherever the same is asked
    expect(large["ladder-break"]).to_have_attribute("aria-pressed", "true")
    scroll(large, 90_000)
    large.lab.plc["X1"] = 1
    large.lab.session.scan()
    large.settle()
    large.settle()
    assert 1 in visible(large)  # it has gone there by itself
    expect(large["ladder"].locator(".panel-head .sub").first).to_have_text("stopped at X1")
    expect(element(large, 3)).to_have_attribute("aria-label", "X1, normally open, power flows, the run stopped here")
    large["ladder-break"].click()
    large.settle()
    assert len(large.lab.session.breakpoints) == 0
    expect(large["ladder"].locator(".break-mark")).to_have_count(0)


def test_where_none_can_be_set_it_is_said(bench, make_lab):
    lab = make_lab("LD X0\nEU\nINC D0")
    bench.connect(lab.panel("ladder"))
    element(bench, 1).focus()
    bench.page.keyboard.press("b")
    bench.settle()
    expect(bench["ladder"].locator(".panel-head [role=alert]")).to_contain_text("nothing can be asked of it")
