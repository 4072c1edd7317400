"""Practical figures of sized devices."""

import math

import pytest

import balcli


@pytest.mark.parametrize(
    ("example", "scheme", "order", "rpm"), [("i3", "couple-shaft", 1, 6000), ("i4", "two-shaft", 2, 7000)]
)
def test_the_mass_at_its_radius_has_the_unbalance_and_makes_the_force(example, scheme, order, rpm):
    """Of balancer shafts, both as the device itself says it; they turn at `order` times crank speed."""
    found = balcli.balance(balcli.load_example(example), scheme)
    omega = order * rpm * math.pi / 30
    assert found.practical
    for device, figures in zip(found.remedy.devices, found.practical, strict=True):
        assert figures.mass_kg * figures.radius_mm / 1e3 == pytest.approx(device.unbalance / 1e6)
        assert figures.force_N == pytest.approx(device.unbalance / 1e6 * omega**2)
