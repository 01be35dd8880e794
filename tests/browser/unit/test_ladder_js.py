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
