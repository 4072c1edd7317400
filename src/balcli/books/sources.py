"""The five books and papers whose tables balcli recomputes, and the names under which people look
for them.
"""

from __future__ import annotations

from typing import NamedTuple


class Source(NamedTuple):
    """A book or paper.

    Attributes:
        key: Short name; the names of its tables begin with it.
        authors: Authors.
        citation: Authors, title, publisher and year.
        names: Other names of the source: its authors in their own script, and translations.
    """

    key: str
    authors: str
    citation: str
    names: tuple[str, ...]


SOURCES = (
    Source(
        "tsinghua",
        "Lu Jiqing and Meng Sizong",
        "Lu Jiqing, Meng Sizong: Automobile Engine Design, vol. 1 (in Chinese), Tsinghua "
        "University Press, 1990",
        ("lu", "lu jiqing", "meng", "meng sizong", "陆际清", "孟嗣宗", "清华", "汽车发动机设计"),
    ),
    Source(
        "liu",
        "Liu Xianzhi",
        "Liu Xianzhi: Two-shaft balance of the second-order inertia force of flat-plane V8 engines "
        "(in Chinese), 1979",
        ("liu xianzhi", "刘先志", "劉先志"),
    ),
    Source(
        "wang",
        "Wang Yongding",
        "Wang Yongding: Methods of balancing single-cylinder engines (in Chinese), Shanghai "
        "Fisheries University, undated",
        ("wang yongding", "王永鼎", "单缸内燃机的平衡方法"),
    ),
    Source(
        "kvasnikov",
        "A. V. Kvasnikov",
        "Kvasnikov, A. V.: Determination of the unbalance of piston engines (in Russian), Tomsk, "
        "1920",
        ("kvasnikow", "kwasnikow", "квасников"),
    ),
    Source(
        "liang",
        "Liang Shoupan",
        "Liang Shoupan: Engine Dynamics (in Chinese), Commercial Press, 1948",
        ("liang shoupan", "梁守槃", "發動機動力學", "发动机动力学"),
    ),
)


def find_source(name: str) -> Source | None:
    """Return the source with this name, or with this name among its other names; None if there is
    no such source. Capital letters do not matter.
    """
    wanted = name.strip().casefold()
    for source in SOURCES:
        if wanted == source.key or wanted in source.names:
            return source
    return None


def find_origin(table: str) -> Source | None:
    """Return the source of a table, by the table's name; None if the table has several sources or
    none.
    """
    key, _, _ = table.partition("-")
    return next((source for source in SOURCES if source.key == key), None)
