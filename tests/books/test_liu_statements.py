"""Statements of Liu in words, against curves sampled over the bank angle."""

import math

import numpy as np
import pytest

from balcli import tables

GAMMA = np.linspace(0, np.pi, 2_000_001)
ROSE = -np.cos(1.5 * GAMMA)
CIRCLE = np.cos(GAMMA / 2)


def answers():
    table = tables("liu-statements")
    return {row[2]: row[-1] for row in table.exact}


def test_paths_and_speeds():
    found = answers()
    assert found["path of the shaft at b''"] == pytest.approx(np.abs(np.diff(ROSE)).sum(), abs=1e-9)
    assert found["path of the shaft at b'''"] == pytest.approx(np.abs(np.diff(CIRCLE)).sum(), abs=1e-9)
    ratio = np.diff(ROSE) / np.diff(CIRCLE)
    assert found["largest ratio of speeds"] == pytest.approx(ratio[np.abs(ratio).argmax()], abs=1e-3)


@pytest.mark.parametrize(("name", "sign"), [("Zx", -1), ("Zy", 1)])
def test_extremes_of_sliders(name, sign):
    """Both are the smallest values of cos 3 gamma/2 -+ cos gamma/2."""
    force = -ROSE + sign * CIRCLE
    found = answers()
    assert found[f"extreme of {name}"] == pytest.approx(force.min(), abs=1e-11)
    assert found[f"bank angle of the extreme of {name}"] == pytest.approx(np.degrees(GAMMA[force.argmin()]), abs=1e-3)


@pytest.mark.parametrize(("name", "far"), [("rose", 120), ("four leaves", 100)])
def test_curves_cross_the_circle(name, far):
    """The angle is that between chords of both curves at the crossing, drawn over the polar angle gamma/2."""
    inside = slice(1, int(len(GAMMA) * far / 180))
    radius = ROSE if name == "rose" else ROSE / np.where(CIRCLE > 1e-9, CIRCLE, 1)
    difference = (radius - CIRCLE)[inside]
    (place,) = np.flatnonzero(np.diff(np.sign(difference)))[:1] + 1
    points = [size[inside] * np.exp(0.5j * GAMMA[inside]) for size in (radius, CIRCLE)]
    chords = [np.angle(curve[place + 1] - curve[place - 1]) for curve in points]
    between = math.degrees(abs(chords[0] - chords[1])) % 180
    found = answers()
    assert found[f"bank angle, circle and {name}"] == pytest.approx(np.degrees(GAMMA[inside][place]), abs=1e-3)
    assert found[f"angle between circle and {name}"] == pytest.approx(min(between, 180 - between), abs=1e-3)


def test_what_is_printed():
    """The source prints these; the others follow from its formula (7.2)."""
    table = tables("liu-statements")
    printed = [words[-1] for words in table.printed]
    assert printed == ["90", "180", "3", "1", "-9", "109.47", "-1.5396", "131.8", "-0.544", *[None] * 4]
    assert not table.errata
