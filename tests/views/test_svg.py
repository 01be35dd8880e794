"""Writing SVG: quoting, the style a picture carries, plain values for export, and a state put into a picture."""

import re

import pytest

from ecsim.views import svg


def test_an_element_is_quoted():
    made = svg.element("text", svg.escape('a < b & "c"'), class_="x", data_name='say "hi" & <go>', x=1.5, y=2.0, z=None)
    assert made == '<text class="x" data-name="say &quot;hi&quot; &amp; &lt;go&gt;" x="1.5" y="2">a &lt; b &amp; "c"</text>'


@pytest.mark.parametrize(("value", "expected"), [(3, "3"), (3.0, "3"), (0.1 + 0.2, "0.3"), (-1.25, "-1.25"), (1 / 3, "0.33")])
def test_numbers_are_short(value, expected):
    assert svg.number(value) == expected


def test_every_token_has_a_plain_value_in_both_themes():
    light, dark = svg.tokens("light"), svg.tokens("dark")
    assert light.keys() == dark.keys()
    assert light["--ec-on"] == "#008060"
    assert dark["--ec-on"] == "#43dd9a"
    assert (light["--ec-paper"], dark["--ec-paper"]) == ("#ffffff", "#111111")
    assert not [name for name, value in {**light, **dark}.items() if "var(" in value]
    with pytest.raises(ValueError, match="light and dark"):
        svg.tokens("blue")


def test_no_rule_has_a_colour_of_its_own():
    sheet = re.sub(r"/\*.*?\*/", "", svg.look("drawing.css"), flags=re.DOTALL)
    assert not re.findall(r"#[0-9a-fA-F]{3,8}\b|rgba?\(", sheet)


def test_every_value_of_a_token_has_a_literal_to_fall_back_to():
    used = re.findall(r"var\((--[\w-]+)(, [^)]+\)?)?\)", svg.style())
    assert used
    assert all(fallback for _, fallback in used)


def test_a_picture_carries_the_rules_that_it_needs_and_no_others():
    alone = svg.standalone('<svg class="ec"><path class="wire" d="M0 0H8"/></svg>')
    assert "svg.ec .wire {" in alone
    assert ".wire.on" not in alone
    assert "forced" not in alone
    assert alone.endswith('<rect class="paper" width="100%" height="100%"/><path class="wire" d="M0 0H8"/></svg>')


def test_plain_values_replace_tokens():
    assert svg.plain("stroke: var(--ec-dead, #868c93)", "dark") == "stroke: #767b81"
    assert svg.plain("font: var(--ec-font)", "light").startswith("font: system-ui")


def test_a_state_is_put_into_a_picture():
    picture = '<svg><g id="p-a" class="off"><text id="p-t" x="1"></text><path id="p-d" d="M0 0" data-d="keep"/></g></svg>'
    state = {"a:class": "on & lit", "t:text": "3 < 5", "d:d": "M1 1", "d:transform": "scale(2)", "gone:class": "x"}
    assert svg.applied(picture, state, "p-") == (
        '<svg><g id="p-a" class="on &amp; lit"><text id="p-t" x="1">3 &lt; 5</text>'
        '<path id="p-d" data-d="keep" d="M1 1" transform="scale(2)"/></g></svg>'
    )


def test_an_empty_element_takes_text():
    assert svg.applied('<text id="v"/>', {"v:text": "7"}) == '<text id="v">7</text>'
