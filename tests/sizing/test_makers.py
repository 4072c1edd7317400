"""The table of makers in docs/ladders.md: its figures, and what the document says about them."""

import makers
import pytest

ALONE = {"Ford Model T, in-line four", "Pratt & Whitney R-2800 (one row)"}  # no other maker chose the opposite


@pytest.fixture(scope="module")
def engines():
    return makers.read_makers()


@pytest.fixture(scope="module")
def choices(engines):
    return makers.list_choices(engines)


@pytest.fixture(scope="module")
def document():
    return makers.DOCUMENT.read_text(encoding="utf-8")


def test_the_document_has_the_table_of_today(document, choices):
    assert document == makers.make_document(choices), "python tools/makers.py writes it anew"
    assert document.count(" | fitted | ") > 20


def test_the_document_counts_right(engines, choices, document):
    text = " ".join(document.split())
    right = sum(choice.agrees for choice in choices)
    with_one_limit = len(choices) - makers.count_wrong(choices, 0.3)
    assert f"the shafts of {len(engines)} engines" in text
    assert f"agrees with the makers for {right} of {len(choices)} shafts" in text
    assert f"one limit of 30 % for all shafts agrees for {with_one_limit}" in text
    wrong = [choice for choice in choices if not choice.agrees]
    assert len(wrong) == 12
    assert sum(bool(choice.maker.rival) for choice in wrong) == 10


def test_no_limit_can_have_both_of_two_makers_that_differ(choices):
    """Within a sixth, because rods are assumed."""
    by_engine = {(choice.maker.name, choice.order): choice for choice in choices}
    for choice in choices:
        if choice.agrees:
            continue
        if not choice.maker.rival:
            assert choice.maker.name in ALONE
            continue
        rival = by_engine[choice.maker.rival, choice.order]
        assert rival.fitted != choice.fitted
        fitted, other = (choice, rival) if choice.fitted else (rival, choice)
        assert fitted.share < 7 / 6 * other.share, choice.maker.name


def test_the_limits_lie_in_gaps(choices):
    """Shares of order 2 are divided by the number of cylinders, counted as at least three."""
    for order, below, above in ((1, 16.7, 18.5), (2, 11.2, 12.5)):
        sizes = {True: [], False: []}
        for choice in choices:
            if choice.agrees and choice.order == order:
                counted = 1 if order == 1 else max(len(choice.maker.engine.numbers), 3)
                sizes[choice.fitted].append(100 * choice.share / counted)
        assert max(sizes[False]) == pytest.approx(below, abs=0.05)
        assert min(sizes[True]) == pytest.approx(above, abs=0.05)


@pytest.mark.parametrize(("name", "order", "share"), [("Mitsubishi Silent Shaft four", 2, 0.3), ("KTM 690", 1, 0.5)])
def test_shares_by_hand(choices, name, order, share):
    """Order 2 of a four: twice the crank radius over the rod length, and a little more; order 1 of a single: half."""
    (choice,) = (one for one in choices if one.maker.name == name and one.order == order)
    radius_over_length = 0.3
    expected = share if order == 1 else 2 * (radius_over_length + radius_over_length**3 / 4)
    assert choice.share == pytest.approx(expected, rel=0.002)
