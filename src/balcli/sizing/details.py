"""Figures that any scheme may add to its devices, each with its label; those of single schemes are
in `scheme_figures`.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

Dimension = Literal["", "force", "moment", "unbalance", "length", "angle", "share", "grams"]


class Range(NamedTuple):
    """The least and the largest of several figures."""

    least: float
    largest: float


class Detail(NamedTuple):
    """A figure, or words, with its label.

    Attributes:
        label: what it is, in words.
        dimension: of the value: "force" (N), "moment" (N m), "unbalance" (kg m), "length" (m),
            "angle" (degrees), "share" (of 1, shown in per cent), "grams" (kg, shown in g, as on
            the scales of a shop), or "" for plain numbers and words.
        group: what it belongs to, such as "order 2"; empty if to the whole scheme.
        what: said after the figure where people read it.
    """

    label: str
    dimension: Dimension
    value: float | str | Range | tuple[float, ...]
    group: str = ""
    what: str = ""
