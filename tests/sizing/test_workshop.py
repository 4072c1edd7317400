"""Practical figures of sized devices."""

from __future__ import annotations

import math

import pytest

import balcli


def test_the_mass_at_its_radius_has_the_unbalance_and_makes_the_force():
    """Of balancer shafts of an in-line three: both as the device itself says it."""
    found = balcli.balance(balcli.load_example("i3"), "couple-shaft")
    omega = 6000 * math.pi / 30
    assert found.practical
    for device, figures in zip(found.remedy.devices, found.practical, strict=True):
        assert figures.mass * figures.radius == pytest.approx(device.unbalance / 1e6)
        assert figures.force == pytest.approx(device.unbalance / 1e6 * omega**2)
