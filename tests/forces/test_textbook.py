"""The units of textbooks, by hand, and the handbook's figures wherever balcli shows such."""

import json
import re
from functools import cache
from itertools import product

import numpy as np
import pytest
from support.cases import cases
from support.commands import ask_csv, run_here
from support.engines import engine

from balcli.core.mechanisms import closed_form
from balcli.file.examples import folder
from balcli.forces.kinds import FORCE, MOMENT
from balcli.forces.spectrum import compute_spectra
from balcli.forces.symmetry import find_textbook, find_textbook_units, with_reciprocating_only


@cases("forces/textbook", "column_reasons_and_table_of_layouts_are_the_handbooks")
def test_column_reasons_and_table_of_layouts_are_the_handbooks(name, sizes):
    """Sizes: forces of order 1 and 2 in F1 and F2, moments in F1 a and F2 a."""
    text = run_here("analyze", folder() / f"{name}.toml", "--all", "--why", "--orders", "1,2").out
    printed = dict(zip(product(("force", "moment"), (1, 2)), sizes, strict=True))
    columns = dict.fromkeys(printed, 0) | _columns(text)
    for found in (columns, _reasons(text), _layouts()[name]):
        assert found == pytest.approx(printed, abs=6e-4)


def _columns(text: str) -> dict[tuple[str, int], float]:
    """The first column of the textbook's tables, by kind and order."""
    found = {}
    for kind in ("force", "moment"):
        _, _, table = text.partition(f"Free {kind} in textbook units\n")
        for line in table.partition("\n\n")[0].splitlines():
            if match := re.match(r"([12]) +([0-9.]+)", line):
                found[kind, int(match[1])] = float(match[2])
    return found


def _reasons(text: str) -> dict[tuple[str, int], float]:
    """What `--why` says is left, by kind and order."""
    found = {}
    for orders, kind, told in re.findall(r"orders? ([\d, ]+) (force|moment): (.*)", text):
        left = re.match(r"unbalanced: ([0-9.]+) F\d(?!.* as built [(]0 )", told)
        nothing = re.match("balanced by|zero in every cylinder|unbalanced: .* as built [(]0 ", told)
        if kind == "moment" and "of one cylinder" in told:  # one throw has no distance a
            nothing = left
        assert bool(left) != bool(nothing) or "of one cylinder" in told, told
        for order in orders.split(", "):
            found[kind, int(order)] = float(left[1]) if left else 0.0
    return found


@cache
def _layouts() -> dict[str, dict[tuple[str, int], float]]:
    """Semi-major axes of `tables layouts`, by engine."""
    sizes = {(kind, n): f"{kind[0].upper()}{n}_major" for kind, n in product(("force", "moment"), (1, 2))}
    rows = {row["engine"]: row for row in ask_csv("tables", "layouts")}
    return {name: {key: float(row[column] or "nan") for key, column in sizes.items()} for name, row in rows.items()}


def test_textbook_units():
    e = engine(crank={"throws": [0, 240, 120], "positions": [0, 80, 200]}, operation={"speed": 600})
    units = find_textbook_units(e, np.array([1.0, 2.0, 3.0]))
    assert (units.force, units.arm, units.equal) == (pytest.approx(0.05 * (20 * np.pi) ** 2), pytest.approx(0.08), True)
    assert list(units.ratios) == list(closed_form.piston([1, 2, 3], 0.25))
    assert np.isnan(find_textbook_units(engine(), np.array([1.0])).arm)


def test_rotating_masses_stagger_and_devices_are_left_out():
    """A single throw of 1 kg beside a piston of 1 kg: 1 F1, and 2 F1 as built."""
    e = engine(
        crank={"throws": [0, 180], "spacing": 100, "throw_mass": 1.0},
        layout={"bank_angle": 90, "stagger": 20},
        counterweight=[{"unbalance": 12345, "angle": 10, "position": 50}],
    )
    book = find_textbook(e, np.array([1.0]), ["moment"])
    size = book.units.size(MOMENT, 1)
    assert abs(book.reciprocating.moment.forward[0]) / size == pytest.approx(1.0)
    assert abs(book.built.moment.forward[0]) / size == pytest.approx(2.0)


def test_json_says_the_same_beside_what_it_said():
    told = run_here("analyze", folder() / "i5.toml", "--why", "--format", "json").out
    found = json.loads(told)["why"]
    first = next(r for r in found["reasons"] if (r["order"], r["quantity"]) == (1, "moment"))
    assert first["size"] == pytest.approx(0.449 / 2, abs=5e-4)
    assert (first["reciprocating"], first["unit"]) == (pytest.approx(0.449, abs=5e-4), "F1·a")
    assert first["built"] == pytest.approx(1.333, abs=5e-4)


def test_units_of_an_engine_whose_first_cylinder_is_articulated_are_its_masters():
    """Orders of an articulated piston are no multiples A_n of its first: the unit of order 2 is
    what cylinder 2, on the master rod, makes of it.
    """
    vee = engine(
        layout={"bank_angle": 60},
        articulation={"master": 2, "knuckle_radius": 30, "rod": {"length": 130, "mass": 0.4, "cg": 40}},
        cylinder={"2": {"piston_mass": 0.7}},
    )
    orders = np.array([1.0, 2.0, 4.0])
    units = find_textbook_units(vee, orders)
    alone = with_reciprocating_only(vee)
    each = compute_spectra(alone, orders, ["force"], by_cylinder=True)["force"]
    of_master = each.major[:, vee.numbers.index(2)]
    assert units.cylinder == 2
    assert [units.size(FORCE, n) for n in orders] == pytest.approx(list(of_master), rel=1e-12)


# ------------------------------------------------------------------ one cylinder
def read_one_cylinder(name: str) -> dict[str, list[str]]:
    """Cells of the table of one cylinder by order."""
    text = run_here("analyze", folder() / f"{name}.toml", "--only", "textbook").out
    rows = re.findall(r"^(\d+(?: \(\w+\))?)  +(\S.*)$", text.partition("Free force")[0], re.MULTILINE)
    return {order: re.split(r"  +", cells) for order, cells in rows}


def test_one_cylinder_has_the_exact_series_beside_the_textbooks_two_terms():
    """i4: crank radius over rod length 43/139, F1 = 15.479 kN."""
    rows = read_one_cylinder("i4")
    lam = 43 / 139
    assert rows["1 (primary)"] == ["1", "15.48", "15.48", "–"]
    second = lam + lam**3 / 4 + 15 * lam**5 / 128
    assert float(rows["2 (secondary)"][0]) == pytest.approx(second, abs=1e-4)
    assert float(rows["2 (secondary)"][2]) == pytest.approx(15.479 * lam, abs=1e-3)
    assert rows["2 (secondary)"][3] == "2.4 %"
    assert rows["4"][2:] == ["0", "100 %"]


def test_the_note_says_why_exact_figures_differ():
    text = " ".join(run_here("analyze", folder() / "i4.toml", "--only", "textbook").out.split())
    assert "Order 1 (once per revolution) is called primary, order 2 secondary." in text
    assert "F2 = m r ω² λ = 4789 N (λ = 0.3094); here it is exact." in text
    assert "offset" not in text
    offset = " ".join(run_here("analyze", folder() / "vr6.toml", "--only", "textbook").out.split())
    assert "The piston pin is offset, which changes all orders and adds odd ones." in offset
    assert float(read_one_cylinder("vr6")["1 (primary)"][0]) > 1


def test_harmonic_motion_has_a_primary_alone():
    """Without rods of finite length there is no series to end."""
    text = (folder() / "i4.toml").read_text().replace("length  = 139\n", 'motion = "harmonic"\n')
    text = text.replace("cg      = 39\n", "").replace("mass    = 0.57\n", "").replace("inertia = 2000\n", "")
    out = run_here("analyze", "-", "--only", "textbook", stdin=text).out
    assert "1 (primary)" in out
    assert "(secondary)" not in out
    assert "Textbooks end" not in out
