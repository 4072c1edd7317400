"""Options that several commands share."""

import pytest
from support.cases import cases
from support.paths import ENGINES

from balcli.shell.options import parse_orders
from balcli.show.sheet import order_name
from balcli.torsion.answer import parse_half_orders


@cases("shell/options", "a_range_that_begins_or_ends_with_a_half_goes_in_halves")
def test_a_range_that_begins_or_ends_with_a_half_goes_in_halves(text, orders):
    assert parse_orders(text) == parse_half_orders(text).tolist() == orders


@pytest.mark.parametrize(("order", "name"), [(0, "0"), (0.5, "½"), (1, "1"), (1.5, "1½"), (12.5, "12½")])
def test_what_tables_call_an_order(order, name):
    assert order_name(order) == name


@pytest.mark.parametrize("name", ["md", "MD", "Markdown"])
def test_a_format_has_a_short_name_and_any_case(balcli, name):
    assert balcli("layouts", "-f", name) == balcli("layouts", "--format", "markdown")


@pytest.mark.parametrize("name", ["txt", "text", "Table"])
def test_a_table_is_a_text(balcli, name):
    assert balcli("balance", ENGINES / "i4.toml", "-f", name) == balcli("balance", ENGINES / "i4.toml")


@cases("shell/options", "what_is_no_format_is_told_with_those_that_are")
def test_what_is_no_format_is_told_with_those_that_are(balcli, command, known):
    status, out, err = balcli(command, ENGINES / "i4.toml", "-f", "xml")
    assert (status, out) == (2, "")
    assert f"'xml' is not one of {known}." in err
