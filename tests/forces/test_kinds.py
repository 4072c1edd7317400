"""The table of what shakes, against what the rest of the house makes of it."""

import pytest
from support.engines import engine

from balcli.errors import NotComputedError
from balcli.forces.kinds import EVERY_KIND, FORCE, KINDS, TORQUE
from balcli.forces.spectrum import Spectra, compute_spectra


def test_attributes_of_spectra_are_kinds():
    """Shorthands for kinds that have one: `spectra.force` is `spectra["force"]`, or None."""
    found = compute_spectra(engine(), [2.0])
    shorthands = {name for name, value in vars(Spectra).items() if isinstance(value, property)}
    assert shorthands <= {*EVERY_KIND}
    for name in shorthands.intersection(KINDS):
        assert getattr(found, name) is found[name]
    assert all(getattr(Spectra(found.orders), name) is None for name in shorthands)


@pytest.mark.parametrize("kind", EVERY_KIND.values(), ids=lambda kind: kind.name)
def test_names_say_the_unit(kind):
    ending = {"N": "_N", "N·m": "_Nm"}[kind.si_unit]
    assert kind.key.endswith(ending)
    assert kind.key_along("x") == kind.key.removesuffix(ending) + "_x" + ending


def test_only_what_was_asked_for_is_there():
    found = compute_spectra(engine(), [2.0], ["torque", "force"])
    assert found.items() == [(FORCE, found["force"]), (TORQUE, found["torque"])]
    assert found.vectors() == [(FORCE, found.force)]
    assert found.scalars() == [(TORQUE, found.torque)]
    assert found.only(["torque"]).items() == [(TORQUE, found.torque)]
    with pytest.raises(NotComputedError, match="roll was not computed"):
        found["roll"]
