"""The device monitor (2.4.6): what its rows say, in every format, and that they say it of now."""

import pytest

import ecsim
from ecsim import EcsimError, Plc
from ecsim.monitor import Monitor

PROGRAM = "VAR_GLOBAL\n  Start AT X0 // the green button\n  Speed AT D10\nEND_VAR\nPROGRAM MAIN\nLD Start\nTON T0 5\nOUT Y0\nEND_PROGRAM"


@pytest.fixture
def plc():
    plc = Plc(input_filter_ms=0)
    plc.load(PROGRAM)
    plc.run()
    return plc


def test_a_row_tells_device_name_type_format_value_and_comment(plc):
    plc["X0"] = 1
    plc.scan()
    table = plc.monitor("Start", "T0", "T0:BOOL", "Speed", "K2Y0", "C200")
    assert [row.cells for row in table] == [
        ("X0", "Start", "BOOL", "binary", "1", "", "the green button"),
        ("T0", "", "INT", "decimal", "0", "", ""),
        ("T0", "", "BOOL", "binary", "0", "", ""),
        ("D10", "Speed", "INT", "decimal", "0", "", ""),
        ("K2Y0", "", "INT", "decimal", "1", "", ""),
        ("C200", "", "DINT", "decimal", "0", "", ""),
    ]


def test_the_table_tells_of_now_whenever_it_is_looked_at(plc):
    table = plc.monitor("D0")
    row = table["D0"]
    assert (row.value, row.text) == (0, "0")
    plc["D0"] = -5
    assert (row.value, row.text) == (-5, "-5")
    assert repr(table).splitlines()[1].split() == ["D0", "INT", "decimal", "-5"]


@pytest.mark.parametrize(
    ("name", "value", "fmt", "text"),
    [
        ("D0", -1, "decimal", "-1"),
        ("D0", -1, "hex", "16#FFFF"),
        ("D0", 31, "hex", "16#001F"),
        ("D0", 5, "binary", "2#0000000000000101"),
        ("D0", -32768, "octal", "8#100000"),
        ("D0:WORD", 65535, "decimal", "65535"),
        ("D0:DINT", -2, "hex", "16#FFFFFFFE"),
        ("D0:DINT", 8, "octal", "8#00000000010"),
        ("D0:DWORD", 0x3FC00000, "float", "1.5"),
        ("D0:REAL", 1.5, "float", "1.5"),
        ("D0:REAL", 3.14159265, None, "3.141593"),
        ("D0", 0x4241, "text", "'AB'"),
        ("D0", 0x0741, "text", "'A.'"),
        ("D0:DWORD", 0x42414443, "text", "'ABCD'"),
        ("M0", 1, "decimal", "1"),
        ("M0", 1, "hex", "1"),
    ],
)
def test_every_format(plc, name, value, fmt, text):
    plc[name] = value
    assert plc.monitor(name, fmt=fmt)[name].text == text


@pytest.mark.parametrize(
    ("name", "fmt", "choose"),
    [
        ("D0:REAL", "hex", "float"),
        ("D0:REAL", "decimal", "float"),
        ("D0", "float", "decimal, hex, binary, octal, text"),
        ("M0", "text", "decimal, hex, binary, octal"),
        ("D0", "roman", "decimal, hex, binary, octal, text"),
    ],
)
def test_a_format_that_does_not_suit_is_refused(plc, name, fmt, choose):
    table = plc.monitor(name)
    with pytest.raises(EcsimError, match=rf"cannot be shown as '{fmt}'; choose {choose}$"):
        table[name].fmt = fmt
    with pytest.raises(EcsimError, match="cannot be shown"):
        plc.monitor(name, fmt=fmt)


def test_formats_by_name_and_rows_that_come_later(plc):
    table = plc.monitor("D0", "D1", fmt={"D1": "hex"})
    table.add("M3")
    table["D0"].fmt = "octal"
    assert [(row.asked, row.fmt) for row in table] == [("D0", "octal"), ("D1", "hex"), ("M3", "binary")]
    assert len(table) == 3
    with pytest.raises(EcsimError, match="fmt names 'D9', which is not in the table; it has D0"):
        plc.monitor("D0", fmt={"D9": "hex"})
    with pytest.raises(EcsimError, match="'D9' is not in the table; it has D0, D1, M3"):
        table["D9"]


def test_a_name_that_there_is_not_is_refused(plc):
    with pytest.raises(EcsimError, match="'Stop' is no device of EC20"):
        plc.monitor("D0", "Stop")


@pytest.mark.parametrize(
    ("forced", "name", "marked"),
    [
        ("D1", "D0:DINT", True),
        ("D2", "D0:DINT", False),
        ("D0", "D0:REAL", True),
        ("M7", "K2M0", True),
        ("M8", "K2M0", False),
        ("T0:BOOL", "T0:BOOL", True),
        ("T0:BOOL", "T0", False),
        ("T0", "T0", True),
        ("T1", "T0", False),
        ("X0", "Start", True),
    ],
)
def test_a_row_is_marked_when_a_part_of_it_is_forced(plc, forced, name, marked):
    plc.force(forced, 1)
    row = plc.monitor(name)[name]
    assert (row.forced, row.cells[5]) == (marked, "forced" if marked else "")
    plc.unforce()
    assert not row.forced


def test_a_notebook_shows_a_table(plc):
    plc.force("Y3", 1)
    html = plc.monitor("Start", "Y3")._repr_html_()
    assert html.count("<tr>") == 3
    assert '<td class="value forced on">1</td><td class="forced">forced</td>' in html
    assert "<td>the green button</td>" in html
    assert ".ec.monitor" in html


def test_without_a_view_a_notebook_falls_back_on_the_text(plc, monkeypatch):
    monkeypatch.setattr(Monitor, "face", None)
    assert plc.monitor("D0")._repr_html_() is None


def test_what_a_program_says_is_not_taken_for_html():
    plc = Plc()
    plc.load("VAR_GLOBAL\nA AT D0 // <b>&\nEND_VAR\nLD X0\nOUT Y0")
    assert "<td>&lt;b&gt;&amp;</td>" in plc.monitor("A")._repr_html_()


def test_a_closed_unit_is_shown_closed():
    from ecsim.views.ladder import ladder
    from ecsim.views.listing import listing
    from ecsim.views.sfc import chart

    project = ecsim.Project({"a.il": "PROGRAM MAIN\nLD SM1\nSET S0\nSTL S0\nLD X0\nOUT Y0\nRET\nEND_PROGRAM\n"})
    program = project.compile()
    assert (len(ladder(program)), len(chart(program).steps), "OUT   Y0" in str(listing(program))) == (4, 1, True)
    project.protected["MAIN"] = "x1"
    plc = Plc()
    plc.load(project)
    assert (len(ladder(plc.program)), chart(plc.program).steps) == (0, [])
    assert "Y0" not in ladder(plc.program).svg() + chart(plc.program).svg()
    assert "// closed by a password" in str(listing(plc.program))
    assert "OUT" not in str(listing(plc.program))
    plc.unlock("MAIN", "x1")
    assert (len(ladder(plc.program)), "OUT   Y0" in str(listing(plc.program))) == (4, True)
