"""Repairs: edits of one place that may mend a program."""

from ecsim.grading.repairs import Parts, additions, branches, everywhere, exchanges, omissions, orders


def news(found):
    return {edit.new for edit in found}


def texts(found):
    return [edit.text for edit in found]


def test_a_contact_and_a_coil_give_way_to_another_one():
    parts = Parts(contacts=["X1"], latches=["Y1"], steps=["S3"])
    found = list(exchanges("LD X0\nANI X2\nOUT Y0", parts))
    assert news(found) == {"LD X1", "LDI X1", "AND X1", "ANI X1", "OUT Y1", "OUT S3"}
    assert "LD X0\nANI X1\nOUT Y0" in texts(found)


def test_a_number_gives_way_to_numbers_and_words_and_a_word_to_words_alone():
    parts = Parts(words=["D0", "D1"], numbers=["7", "9"])
    assert news(exchanges("LD= D0 7\nOUT Y1", parts)) == {"LD= D0 9", "LD= D0 D0", "LD= D0 D1", "LD= D1 7"}
    assert news(exchanges("LD X0\nTON T0 7", parts)) == {"TON T0 9", "TON T0 D0", "TON T0 D1"}


def test_a_way_by_so_much_gives_way_to_one_up_to_there():
    assert news(exchanges("LD X0\nDRVI 100 10 Y0 Y1", Parts())) == {"DRVA 100 10 Y0 Y1"}


def test_additions_are_conditions_and_coils_more():
    parts = Parts(contacts=["X0"], clocks=["SM12"], latches=["Y1"], steps=["S1", "S2"], words=["D0"], numbers=["7"])
    found = news(additions("LD X0\nAND X1\nOUT Y0\nLD= D0 7\nSET S1", parts))
    assert {"AND X1\nANI X0", "AND X1\nORI X0", "AND X1\nED", "AND X1\nAND SM12", "AND X1\nAND> D0 7", "LD X0\nAND= D0 0"} <= found
    assert {"OUT Y0\nRST Y1", "OUT Y0\nSET Y1", "SET S1\nSET S2", "OUT Y0\nRST S1\nRST S2"} <= found
    assert "OUT Y0\nSET S2" not in found


def test_the_same_slip_is_taken_back_in_each_place():
    text = "LD X0\nANI X1\nOUT Y0\nLD X2\nANI X1\nOUT Y1"
    found = list(everywhere(text, Parts()))
    assert texts(found) == [text.replace("ANI X1", "AND X1")] * 2
    assert [edit.line for edit in found] == [2, 5]
    compared = "LD= D0 1\nOUT Y0\nLD<> D0 1\nOUT Y1"
    assert "LD= D2 1\nOUT Y0\nLD<> D2 1\nOUT Y1" in texts(everywhere(compared, Parts(words=["D2"])))
    assert "LD= D0 5\nOUT Y0\nLD<> D0 5\nOUT Y1" in texts(everywhere(compared, Parts(numbers=["5"])))
    assert texts(everywhere("LD X0\nOUT Y0\nOUT Y1", Parts())) == ["LD X0\nSET Y0\nSET Y1"] * 2


def test_a_network_is_added_behind_another_one():
    found = texts(omissions("LD X0\nSET Y0\nEND", [2], Parts(contacts=["X1"], latches=["Y0"], steps=["S5"])))
    assert len(found) == 3 * 3  # always, with and without the contact; each a step, an RST and a SET
    assert "LD X0\nSET Y0\nLD X1\nRST Y0\nEND" in found
    assert "LD X0\nSET Y0\nLDI X1\nOUT S5\nEND" in found


def test_networks_change_places():
    text = "A 1\nA 2\nB 1\nC 1\nC 2"
    found = [" ".join(one.split()) for one in texts(orders(text, [[(1, 2), (3, 3), (4, 5)]]))]
    assert sorted(found) == ["A 1 A 2 C 1 C 2 B 1", "B 1 A 1 A 2 C 1 C 2", "B 1 C 1 C 2 A 1 A 2", "C 1 C 2 A 1 A 2 B 1"]


def test_a_step_is_left_two_ways():
    text = "STL S20\nLD SM0\nSET S21\nSTL S21\nOUT Y0"
    found = texts(branches(text, Parts(contacts=["X1"], steps=["S21", "S30"])))
    assert len(found) == 4
    assert "STL S20\nLD X1\nSET S21\nLDI X1\nOUT S30\nSTL S21\nOUT Y0" in found
    assert "STL S20\nLDI X1\nSET S21\nLD X1\nOUT S30\nSTL S21\nOUT Y0" in found
