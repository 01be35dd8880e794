"""Every special relay and register of appendices 1 and 2 does what the manual says, or stands among those with nothing to simulate."""

import json
import re
from pathlib import Path

import pytest

import ecsim

from . import special_checks, special_ports

TESTS = Path(__file__).parent.parent
FACTS = json.loads((TESTS / "facts" / "system.json").read_text(encoding="utf-8"))
CHECKS = special_checks.CHECKS | special_ports.CHECKS
TITLE = "## Special devices with nothing to simulate"


def listed():
    """The addresses in the table of docs/decisions.md, whose first column reads SM140 to SM171 or SD88, SD89."""
    section = (TESTS.parent / "docs" / "decisions.md").read_text(encoding="utf-8").partition(f"{TITLE}\n")[2].partition("\n## ")[0]
    found = set()
    for row in re.findall(r"^\| ((?:SM|SD)\d[^|]*)\|", section, re.MULTILINE):
        for part in row.split(","):
            kind, first, last = re.fullmatch(r"\s*(S[MD])(\d+)(?: to S[MD](\d+))?\s*", part).groups()
            found |= {f"{kind}{number}" for number in range(int(first), int(last or first) + 1)}
    return found


ROWS = [(row["address"], model, row["access"]) for kind in ("sm", "sd") for row in FACTS[kind] for model in row["models"]]
LISTED = listed()


def test_every_row_of_the_appendices_is_checked_or_listed_and_none_is_both():
    addresses = {address for address, _, _ in ROWS}
    assert addresses - CHECKS.keys() - LISTED == set()
    assert (CHECKS.keys() | LISTED) - addresses == set()
    assert CHECKS.keys() & LISTED == set()


@pytest.mark.parametrize(("address", "model"), [(address, model) for address, model, _ in ROWS if address in CHECKS])
def test_it_behaves(address, model):
    CHECKS[address](model, int(address[2:]))


def is_word(address):
    return address.startswith("SD")


@pytest.mark.parametrize(("address", "model", "access"), ROWS)
def test_what_is_read_only_keeps_its_value_whoever_writes_it(address, model, access):
    plc = ecsim.Plc(model)
    before = plc[address]
    other = before + 1 if is_word(address) else 1 - before
    write = f"LD M0\nMOV {other} {address}" if is_word(address) else f"LD M0\n{'SET' if other else 'RST'} {address}"
    received = other if is_word(address) else bool(other)
    if access == "R":
        with pytest.raises(ecsim.ProgramError, match="only read"):
            ecsim.compile(write, model)
        with pytest.raises(ecsim.EcsimError, match="the system writes it"):
            plc[address] = other
        plc.memory.receive(address[:2], int(address[2:]), [received])
        assert plc[address] == before
    else:
        ecsim.compile(write, model)
        plc.memory.receive(address[:2], int(address[2:]), [received])
        assert plc[address] == other
        plc[address] = before
        assert plc[address] == before


@pytest.mark.parametrize("model", ["EC10", "EC20"])
def test_reserved_ones_are_read_only_and_0(model):
    plc = ecsim.Plc(model)
    known = {address for address, of, _ in ROWS if of == model}
    for address in ({f"{kind}{number}" for kind in ("SM", "SD") for number in range(256)}) - known:
        assert plc[address] == 0
        with pytest.raises(ecsim.EcsimError, match="the system writes it"):
            plc[address] = 1


# Appendix 2 where it prints a value to begin with; SD84 to SD87 are those of 6.17.6, SD34 that of 2.2.1
BEGIN = {
    **dict.fromkeys(("SD3", "SD20", "SD21", "SD22", "SD23", "SD24", "SD33", "SD113", "SD114", "SD123", "SD124", "SD139"), 0),
    **dict.fromkeys(("SD80", "SD81", "SD82", "SD83"), 0), "SD25": 255, "SD26": 255, "SD34": 200,
    "SD84": 5000, "SD85": 1, "SD86": 34_464 - 65_536, "SD87": 1000, "SD88": 100, "SD89": 100,
}  # fmt: skip


@pytest.mark.parametrize(("model", "more"), [("EC10", {"SD0": 10, "SD35": 8, "SD173": 8, "SD175": 8}), ("EC20", {"SD0": 20, "SD35": 10})])
def test_registers_begin_with_what_the_appendix_prints(model, more):
    plc = ecsim.Plc(model)
    expected = BEGIN | more
    assert {address: plc[address] for address in expected} == expected
    plc.load("LD SM1\nMOV 7 SD84\nMOV 7 SD88\nMOV 7 SD113")
    plc.run()
    plc.scan()
    assert [plc[address] for address in ("SD84", "SD88", "SD113")] == [7, 7, 7]
    plc.stop()
    plc.run()
    assert {address: plc[address] for address in expected} == expected
