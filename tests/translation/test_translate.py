"""Programs of one family as programs of the other: what is written, what is told, what is refused, and that both do the same."""

import random
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import ecsim
from ecsim.translation import translate

EXERCISES = Path(__file__).parents[2] / "exercises"


def lines(text):
    """The instructions of a text, each with single blanks."""
    code = (" ".join(line.partition("//")[0].split()) for line in text.splitlines())
    return [line for line in code if line]


def to_h2u(text):
    return lines(translate(text, "H2U").text)


def to_ec20(text):
    return lines(translate(text, "EC20", "H2U").text)


def refusals(text, to="H2U", model="EC20"):
    with pytest.raises(ecsim.ProgramError) as refused:
        translate(text, to, model)
    return [(problem.line, problem.message, problem.hint) for problem in refused.value.problems]


# -- what is written --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("ec", "fx"),
    [
        ("LD SM0\nMOV 5 D0", ["LD M8000", "MOV K5 D0"]),
        ("LD SM1\nMOV 16#1F K4M0", ["LD M8002", "MOV H1F K4M0"]),
        ("LD X0\nEU\nOUT Y0", ["LDP X0", "OUT Y0"]),
        ("LDI X0\nEU\nOUT Y0", ["LDI X0", "PLS M499", "AND M499", "OUT Y0"]),
        ("LD X0\nED\nOUT Y0", ["LDF X0", "OUT Y0"]),
        ("LD X0\nAND X1\nEU\nOUT Y0", ["LD X0", "AND X1", "PLS M499", "AND M499", "OUT Y0"]),
        ("LD X0\nAND X1\nED\nOUT Y0", ["LD X0", "AND X1", "PLF M499", "LD M499", "OUT Y0"]),
        ("LD X0\nTON T5 30\nLD T5\nOUT Y0", ["LD X0", "OUT T5 K30", "LD T5", "OUT Y0"]),
        ("LD X0\nTONR T5 30\nLD T5\nOUT Y0", ["LD X0", "OUT T250 K30", "LD T250", "OUT Y0"]),
        ("LD X0\nTON T205 30", ["LD X0", "OUT T0 K30"]),
        ("LD X0\nTON T210 30", ["LD X0", "OUT T210 K30"]),
        ("LD X0\nCTU C3 4\nLD C3\nOUT Y0", ["LD X0", "OUT C3 K4", "LD C3", "OUT Y0"]),
        ("LD X0\nDCNT C200 -5", ["LD X0", "OUT C200 K-5"]),
        ("LD X0\nROR D0 D1 3", ["LD X0", "MOV D0 D1", "ROR D1 K3"]),
        ("LD X0\nDROL D0 D0 3", ["LD X0", "DROL D0 K3"]),
        ("LD X0\nNEG D0 D0", ["LD X0", "NEG D0"]),
        ("LD X0\nZRST Y10 9", ["LD X0", "ZRST Y10 Y20"]),
        ("LD X0\nZRST M10 3", ["LD X0", "ZRST M10 M12"]),
        ("LD X0\nBITS D0 D1", ["LD X0", "SUM D0 D1"]),
        ("LD X0\nSQT D0 D1", ["LD X0", "SQR D0 D1"]),
        ("LD X0\nWINV D0 D1", ["LD X0", "CML D0 D1"]),
        ("LD X0\nMC 0\nLD X1\nOUT Y0\nMCR 0", ["LD X0", "MC N0 M499", "LD X1", "OUT Y0", "MCR N0"]),
        ("LD SM0\nFOR 3\nLD SM0\nINC D0\nNEXT", ["FOR K3", "LD M8000", "INC D0", "NEXT"]),
        ("LD X0\nCJ 5\nLD SM0\nINC D0\nLBL 5\nLD X1\nOUT Y1", ["LD X0", "CJ P5", "LD M8000", "INC D0", "P5", "LD X1", "OUT Y1"]),
        ("LD X0\nCFEND\nLD X1\nOUT Y1", ["LD X0", "CJ P63", "LD X1", "OUT Y1"]),
        ("LD X0\nMOV D0Z3 D10Z9", ["LD X0", "MOV D0Z3 D10V1"]),
        ("LD SM80\nOUT SM200", None),
    ],
)
def test_ec_as_fx(ec, fx):
    if fx is None:
        assert "OUT M8200" in " ".join(to_h2u("LD X0\nOUT SM200\nLD X1\nDCNT C200 5"))
    else:
        assert to_h2u(ec) == fx


@pytest.mark.parametrize(
    ("fx", "ec"),
    [
        ("LD M8000\nMOV K5 D0", ["LD SM0", "MOV 5 D0"]),
        ("LDP X0\nOUT Y0", ["LD X0", "EU", "OUT Y0"]),
        ("LD X0\nANDP X1\nOUT Y0", ["LD X0", "LD X1", "EU", "ANB", "OUT Y0"]),
        ("LD X0\nORF X1\nOUT Y0", ["LD X0", "LD X1", "ED", "ORB", "OUT Y0"]),
        ("LD X0\nPLS M0", ["LD X0", "EU", "OUT M0"]),
        ("LD X0\nPLF M0\nOUT Y0", ["LD X0", "MPS", "ED", "OUT M0", "MPP", "OUT Y0"]),
        ("LD X0\nINCP D0", ["LD X0", "EU", "INC D0"]),
        ("LD X0\nINCP D0\nOUT Y0", ["LD X0", "MPS", "EU", "INC D0", "MPP", "OUT Y0"]),
        ("LD X0\nOUT T0 K5\nOUT T250 K5", ["LD X0", "TON T0 5", "TONR T1 5"]),
        ("LD X0\nOUT T200 K5", ["LD X0", "TON T210 5"]),
        ("LD X0\nROR D0 K3", ["LD X0", "ROR D0 D0 3"]),
        ("LD X0\nZRST D0 D9", ["LD X0", "FMOV 0 D0 10"]),
        ("LD X0\nRST D5", ["LD X0", "MOV 0 D5"]),
        ("LD X0\nMC N0 M100\nLD X1\nMC N1 M101\nLD X2\nOUT Y0\nMCR N0", [
            "LD X0", "OUT M100", "MC 0", "LD X1", "OUT M101", "MC 1", "LD X2", "OUT Y0", "MCR 1", "MCR 0",
        ]),
    ],
)  # fmt: skip
def test_fx_as_ec(fx, ec):
    assert [line for line in to_ec20(fx) if line not in ("PROGRAM MAIN", "END_PROGRAM")] == ec


def test_subroutines_become_labels_and_back():
    text = "PROGRAM MAIN\nLD X0\nCALL WASH\nLD X1\nOUT Y1\nEND_PROGRAM\nSUBROUTINE WASH\nLD SM0\nINC D0\nLD X2\nCSRET\nLD SM0\nINC D1\nEND_SUBROUTINE"
    fx = to_h2u(text)
    assert fx == [
        "LD X0",
        "CALL P0",
        "LD X1",
        "OUT Y1",
        "FEND",
        "P0",
        "LD M8000",
        "INC D0",
        "LD X2",
        "CJ P1",
        "LD M8000",
        "INC D1",
        "P1",
        "SRET",
    ]
    assert "SUBROUTINE SBR_P0" in to_ec20("\n".join(fx))


def test_ei_on_the_bus_gets_a_contact():
    ec = to_ec20("LD X0\nOUT Y0\nEI\nFEND\nI001\nLD M8000\nINC D0\nIRET\nEND")
    assert ec[ec.index("OUT Y0") :][:3] == ["OUT Y0", "LD SM0", "EI"]


def test_decimal_constants_beyond_their_sign_are_written_in_hexadecimal():
    fx = to_h2u("LD SM0\nMOV 40000 D0\nMOV 32767 D1\nMOV -32768 D2\nWAND 65535 D3 D4")
    assert fx[1:] == ["MOV H9C40 D0", "MOV K32767 D1", "MOV K-32768 D2", "WAND HFFFF D3 D4"]


def test_interrupts_of_inputs_and_timers():
    text = (
        "PROGRAM MAIN\nLD SM1\nSET SM42\nMOV 50 SD66\nSET SM66\nEI\nEND_PROGRAM\n"
        "INTERRUPT A EVENT 2\nLD SM0\nINC D0\nEND_INTERRUPT\nINTERRUPT B EVENT 26\nLD SM0\nINC D1\nEND_INTERRUPT"
    )
    fx = to_h2u(text)
    assert fx[:5] == ["LD M8002", "RST M8052", "RST M8056", "AND M8000", "EI"]
    assert {"I201", "I650", "IRET"} <= set(fx)
    back = to_ec20("\n".join(fx))
    assert {"SET SM42", "SET SM66", "MOV 50 SD66", "INTERRUPT INT_I201 EVENT 2", "INTERRUPT INT_I650 EVENT 26"} <= set(back)


def test_a_file_is_taken_for_the_model_that_its_name_tells(tmp_path):
    path = tmp_path / "lamp.h2u.il"
    path.write_text("LDP X0\nOUT Y0\n", encoding="utf-8")
    assert "EU" in lines(translate(path, "EC20").text)
    with pytest.raises(ecsim.EcsimError, match="not int"):
        translate(5)


def test_names_and_comments_stay():
    text = "VAR_GLOBAL\n  Start AT X0 // the start switch\n  Slow AT T205\nEND_VAR\n\n// How it begins\nLD Start // pressed\nTON Slow 5\nLD Slow\nOUT Y0"
    done = translate(text, "H2U")
    assert "Start AT X0" in done.text
    assert "// the start switch" in done.text
    assert "Slow  AT T0" in done.text
    assert "// How it begins" in done.text
    assert "// pressed" in done.text
    assert "OUT Slow K5" in lines(done.text)
    assert "T205 becomes T0" in done.report()


def test_the_report_names_what_differs_with_its_first_line():
    done = translate("LD X0\nADD D0 D1 D2\nADD D2 D1 D3\nDMOV D10 D12\nCTU C0 3", "H2U")
    told = [(difference.line, difference.what) for difference in done.differences]
    assert [line for line, _ in told] == [2, 4, 5]
    assert "beyond the range" in told[0][1]
    assert told[1][1] == "32-bit numbers lie in two registers with the low word first"
    assert "stop at their preset" in told[2][1]
    assert translate("LD X0\nOUT Y0", "H2U").report() == "no differences"


def test_the_report_names_what_one_of_the_models_alone_keeps_without_power():
    there = translate("LD X0\nMOV 5 D199\nMOV 5 D600\nSET M500\nTONR T5 30", "H2U").report()
    assert "line 3: kept there without power, unless told otherwise: D600, M500, T5" in there.splitlines()
    back = translate("LD X0\nMOV K5 D200\nMOV K5 D199", "EC20", "H2U").report()
    assert back == "line 2: not kept there without power, unless told otherwise: D200"


# -- what is refused --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("LD X0\nTOF T0 5", 2, "TOF T0 5: H2U has nothing that does the same"),
        ("LD X0\nENCO D0 D1", 2, "ENCO D0 D1: H2U has nothing"),
        ("LD X0\nDMOV D0 D10\nMOV D1 D20", 3, "D1 is a 16-bit number in line 3 and part of a 32-bit one in line 2"),
        ("LD X0\nCTU C0 5\nLD X0\nMOV C0 D0", 2, "counts on beyond its preset, and line 4 looks at its value"),
        ("LD X0\nCTU C2 5\nLD X0\nBMOV C0 D0 3", 2, "counts on beyond its preset, and line 4 looks at its value"),
        ("LD X0\nCTU C2 5\nLD X0\nTON T0 C2", 2, "counts on beyond its preset, and line 4 looks at its value"),
        ("LD X0\nCTU C2 5\nLD X0\nBMOV C0 D0 D9", 2, "counts on beyond its preset, and line 4 looks at its value"),
        ("LD X0\nCTU C0 5\nLD X1\nCTU C0 16#6", 2, "C0 has another preset in line 4"),
        ("LD X0\nCTU C0 0", 2, "with a preset below 1 the contact of C0 comes at once in EC"),
        ("LD X0\nOUT SM110", 2, "SM110 has no counterpart"),
        ("LD SM0\nMOV 3 SD111", 2, "SD111 has no counterpart"),
        ("LD X0\nTON T252 5", 2, "no free timer of 1 ms for T252"),
        ("LD X0\nHCNT C244 5", 2, "C244"),
        ("LD X0\nLD X1\nAND X2\nEU\nANB\nOUT Y0", 4, "the edge of a part of a rung"),
        ("LD X0\nPLSR D0 D2 D4 Y0", 2, "D0 is a number of 16 bits here and of 32 bits there"),
        ("LD X0\nBLD D0 3\nANB\nOUT Y0", 2, "nothing that does the same"),
    ],
)
def test_what_cannot_be_kept_is_refused(text, line, words):
    found = refusals(text)
    assert [(place, message) for place, message, _ in found if words in message and place == line], found


def test_numbers_beside_a_counter_leave_it_alone():
    text = "LD X0\nCTU C2 5\nLD X0\nBMOV C0 D0 2\nMOV C3 D9\nZRST C0 4\nRST C2"
    assert "OUT C2 K5" in " ".join(translate(text, "H2U").text.split())
    assert "CTU C2 5" in " ".join(translate("LD X0\nOUT C2 K5\nLD X1\nZRST C0 C4", "EC20", "H2U").text.split())


def test_counters_of_fx_with_two_presets_are_refused_too():
    assert [line for line, _, _ in refusals("LD X0\nOUT C0 K5\nLD X1\nOUT C0 K6", "EC20", "H2U")] == [2, 4]
    assert translate("LD X0\nOUT C0 K5\nLD X1\nOUT C0 H5", "EC20", "H2U").model == "EC20"
    assert "a preset that changes" in translate("LD X0\nCTU C0 D5", "H2U").report()


@pytest.mark.parametrize(
    ("to", "model", "text", "word"),
    [
        ("H2U", "EC20", "LD X7\nMC 0\nLD SM0\nHCNT C236 9\nMCR 0", "HCNT: where MC goes OFF or a step is left, its result stays there"),
        (
            "EC20",
            "H2U",
            "LD X7\nMC N0 M9\nLD M8000\nSPD X0 K100 D0\nMCR N0",
            "SPD: where MC goes OFF or a step is left, its result is cleared",
        ),
        ("EC20", "H2U", "LD M8002\nSET S0\nSTL S0\nFOR K2\nLD X7\nOUT C235 K9\nNEXT\nRET", "OUT: where MC goes OFF or a step is left"),
        ("H2U", "EC20", "LD SM0\nHCNT C236 9", ""),
        ("EC20", "H2U", "LD X7\nMC N0 M9\nLD M8000\nPLSY K100 K5 Y0\nMCR N0", ""),
    ],
)
def test_what_leaving_does_to_high_speed_results_is_told(to, model, text, word):
    told = [str(difference.what) for difference in translate(text, to, model).differences if "is left, its result" in difference.what]
    assert len(told) == bool(word)
    assert not word or word in told[0]


@pytest.mark.parametrize(
    ("to", "model", "coil", "direction"), [("H2U", "EC20", "DCNT C200 2", "SM200"), ("EC20", "H2U", "OUT C200 K2", "M8200")]
)
def test_the_contact_of_a_counter_that_counts_down_goes_off_one_count_apart(to, model, coil, direction):
    machines, done = twins(f"LD X0\n{coil}\nLD X1\nOUT {direction}\nLD C200\nOUT Y0", to, model)
    assert "counting down, the contact goes OFF on reaching the preset" in done.report()
    ends = {}
    for plc in machines:
        for down, counts in ((0, 3), (1, 2)):
            plc["X1"] = down
            for _ in range(counts):
                for level in (0, 1):
                    plc["X0"] = level
                    plc.scan(2)
                if down and not plc["Y0"]:
                    ends.setdefault(plc.model.family, plc["C200"])
    assert ends == {"EC": 2, "FX": 1}


@pytest.mark.parametrize(
    "text",
    [
        "LD X0\nDCNT C200 0\nLD C200\nOUT Y0",  # a preset below the first count
        "LD X1\nDMOV 7 C200\nLD X0\nDCNT C200 3\nLD C200\nOUT Y0",  # a value that was written
        "LD X0\nDCNT C200 4\nLD X1\nDCNT C200 0\nLD C200\nOUT Y0",  # another preset
    ],
)
def test_the_contact_of_a_counter_that_counts_up_above_its_preset_is_told(text):
    machines, done = twins(text, "H2U", "EC20")
    assert "a count upward from the preset or above puts it ON here and leaves it there" in done.report()
    for plc in machines:
        for terminal in ("X1", "X0"):
            for level in (1, 0):
                plc[terminal] = level
                plc.scan(2)
    assert [plc["Y0"] for plc in machines] == [1, 0]


def test_a_loop_that_might_never_be_entered():
    """A count below 1 means once in FX and never in EC."""
    ec, fx = "LD SM0\nFOR {}\nLD SM0\nINC D0\nNEXT", "FOR {}\nLD M8000\nINC D0\nNEXT"
    for text, constant, count, to, model, words in (
        (ec, "0", "D5", "H2U", "EC20", "once there and never here"),
        (fx, "K0", "D5", "EC20", "H2U", "once here and never there"),
    ):
        (found,) = refusals(text.format(constant), to, model)
        assert words in found[1]
        assert words in translate(text.format(count), to, model).report()
    for count in (-1, 0, 1, 3):
        machines, _ = twins(ec.format("D5"), "H2U", "EC20")
        for plc in machines:
            plc["D5"] = count
            plc.scan()
        assert [plc["D0"] for plc in machines] == [max(count, 0), max(count, 1)]


def test_all_refusals_are_told_at_once():
    assert [line for line, _, _ in refusals("LD X0\nTOF T0 5\nLD X1\nTMON T1 5\nLD X2\nCTR C0 5")] == [2, 4, 6]


def test_models_of_one_family_are_no_translation_apart():
    with pytest.raises(ecsim.EcsimError, match="both belong to the family EC"):
        translate("LD X0\nOUT Y0", "EC10", "EC20")


def test_what_the_other_compiler_refuses_is_told_of_the_own_line():
    (found,) = refusals("LD X0\nOUT M0\nCMP D0 D1 M0", "EC20", "H2U")
    assert found[0] == 3
    assert "EC20 has nothing that does the same" in found[1]


# -- both do the same -------------------------------------------------------------------------------------------------------

BITS = [f"X{n}" for n in range(6)] + [f"M{n}" for n in range(8)] + ["Y3", "T0", "T210", "C0", "C1", "C2"]
WORDS = [f"D{n}" for n in range(6)]
PAIRS = ["D20", "D22", "D24"]
contact = st.tuples(st.sampled_from(("", "I")), st.sampled_from(BITS))
relation = st.sampled_from(("=", "<>", ">", "<", ">=", "<="))
word = st.sampled_from(WORDS)
number = st.integers(-300, 300).map(str)
output = st.one_of(
    st.sampled_from([f"OUT Y{n}" for n in range(8)] + [f"OUT M{n}" for n in range(8)]),
    st.sampled_from(["SET Y1", "RST Y1", "SET M3", "RST M3", "RST C0", "RST C1", "ZRST M0 4", "ZRST Y0 10"]),
    st.tuples(st.sampled_from(("TON T0", "TON T210", "TON T7")), st.integers(1, 12)).map(lambda each: f"{each[0]} {each[1]}"),
    st.sampled_from(("CTU C0 1", "CTU C1 2", "CTU C2 4")),  # a counter has one preset
    st.tuples(st.one_of(word, number), word).map(lambda each: f"MOV {each[0]} {each[1]}"),
    st.tuples(st.sampled_from(("WAND", "WOR", "WXOR")), word, word, word).map(" ".join),
    st.tuples(st.sampled_from(("INC", "DEC")), word).map(" ".join),
    st.tuples(st.sampled_from(("ROR", "ROL", "RCR", "RCL")), word, word, st.integers(0, 20).map(str)).map(" ".join),
    st.tuples(st.just("NEG"), word, word).map(" ".join),
    st.tuples(st.sampled_from(("BITS", "GRY", "WINV")), word, word).map(" ".join),
    st.tuples(st.sampled_from(("DMOV",)), st.sampled_from((*PAIRS, "123456", "-7")), st.sampled_from(PAIRS)).map(" ".join),
    st.tuples(st.sampled_from(("DWAND", "DWXOR")), *[st.sampled_from(PAIRS)] * 3).map(" ".join),
    st.tuples(st.sampled_from(("DINC", "DDEC")), st.sampled_from(PAIRS)).map(" ".join),
)  # fmt: skip
condition = st.one_of(
    st.lists(contact, min_size=1, max_size=3).map(
        lambda found: [f"LD{found[0][0]} {found[0][1]}", *(f"AN{'I' if c else 'D'} {d}" for c, d in found[1:])]
    ),
    st.tuples(contact, contact).map(lambda two: [f"LD{two[0][0]} {two[0][1]}", f"OR{two[1][0]} {two[1][1]}"]),
    st.tuples(contact, st.sampled_from(("EU", "ED"))).map(lambda each: [f"LD{each[0][0]} {each[0][1]}", each[1]]),
    st.tuples(contact, contact, st.sampled_from(("EU", "ED"))).map(
        lambda each: [f"LD{each[0][0]} {each[0][1]}", f"AND {each[1][1]}", each[2]]
    ),
    st.tuples(relation, word, number).map(lambda each: [f"LD{each[0]} {each[1]} {each[2]}"]),
)
rung = st.tuples(condition, output).map(lambda each: [*each[0], each[1]])
SEEN = [f"Y{n}" for n in range(8)] + [f"M{n}" for n in range(8)] + WORDS + [f"{pair}:DINT" for pair in PAIRS]


def twins(text, to, model):
    done = translate(text, to, model)
    machines = ecsim.Plc(model, scan_ms=10, input_filter_ms=0), ecsim.Plc(to, scan_ms=10, input_filter_ms=0)
    for plc, program in zip(machines, (text, done.text), strict=True):
        plc.load(program)
        plc.run()
    return machines, done


def run_both(machines, seed, scans):
    """The same random inputs and values for both; gives the first scan in which they differ, with what."""
    chance = random.Random(seed)
    for word_ in WORDS:
        value = chance.randint(-300, 300)
        for plc in machines:
            plc[word_] = value
    for scan in range(scans):
        levels = {f"X{n}": chance.randint(0, 1) for n in range(6) if chance.random() < 0.4}
        for plc in machines:
            plc.set(levels)
            plc.scan()
        first, second = ({name: plc[name] for name in SEEN} for plc in machines)
        if first != second:
            return scan, {name: (first[name], second[name]) for name in SEEN if first[name] != second[name]}
    return None


@settings(max_examples=60)
@given(st.lists(rung, min_size=1, max_size=12), st.integers(0, 10**6))
def test_a_random_program_and_its_translation_do_the_same(rungs, seed):
    machines, _ = twins("\n".join(line for each in rungs for line in each), "H2U", "EC20")
    assert run_both(machines, seed, 60) is None


@settings(max_examples=40)
@given(st.lists(rung, min_size=1, max_size=10), st.integers(0, 10**6))
def test_and_back_again(rungs, seed):
    original = "\n".join(line for each in rungs for line in each)
    there = translate(original, "H2U").text
    machines, _ = twins(there, "EC20", "H2U")
    assert run_both(machines, seed, 60) is None


CHART = "LD SM1\nSET S0\nSTL S0\nLD X0\nEU\nSET S20\nSTL S20\nOUT Y0\nTON T0 {time}\nLD T0\nSET S21\nLD X1\nOUT S0\nSTL S21\nOUT Y1\nLD X2\nOUT S0\nRET"


@settings(max_examples=15)
@given(st.integers(1, 5), st.integers(0, 10**6))
def test_a_chart_goes_the_same_way(time, seed):
    machines, _ = twins(CHART.format(time=time), "H2U", "EC20")
    chance = random.Random(seed)
    ways = ([], [])
    for _ in range(120):
        levels = {f"X{n}": chance.randint(0, 1) for n in range(3) if chance.random() < 0.1}
        for plc, way in zip(machines, ways, strict=True):
            plc.set(levels)
            plc.scan()
            active = [name for name in ("S0", "S20", "S21") if plc[name]]
            if not way or way[-1] != active:
                way.append(active)
    assert ways[0] == ways[1]


@pytest.mark.parametrize("edge", ["LD X1\nEU", "LD X1\nED", "LD X1\nAND X3\nEU", "LDI X1\nED"])
def test_edges_in_a_step_that_sleeps_count_alike(edge):
    text = f"LD SM1\nSET S0\nSTL S0\nLD X0\nSET S20\nSTL S20\n{edge}\nINC D0\nLD X2\nOUT S0\nRET"
    machines, done = twins(text, "H2U", "EC20")
    assert [what for what in map(str, done.differences) if "edge" in what] == []
    chance = random.Random(edge)
    for _ in range(300):
        levels = {f"X{n}": chance.randint(0, 1) for n in range(4) if chance.random() < 0.3}
        for plc in machines:
            plc.set(levels)
            plc.scan()
        assert machines[0]["D0"] == machines[1]["D0"]
    assert machines[0]["D0"] > 5


@pytest.mark.parametrize(
    "name", ["conveyor", "mixer", "bottles", "motor", "star_delta", "crossing", "garage", "tank", "car_park", "pick_and_place"]
)
def test_the_solutions_of_the_exercises_become_programs_of_h2u_and_back(name):
    there = translate((EXERCISES / name / "solution.il").read_text(encoding="utf-8"), "H2U")
    assert translate(there.text, "EC20", "H2U").model == "EC20"
