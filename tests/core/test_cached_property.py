"""Attributes that are computed once: by many threads at a time, for many objects."""

from concurrent.futures import ThreadPoolExecutor
from threading import Barrier

from balcli.core.cached_property import cached_property


def test_it_is_computed_once():
    class Counts:
        times = 0

        @cached_property
        def seen(self) -> int:
            """How often it was computed."""
            self.times += 1
            return self.times

    counts = Counts()
    assert [counts.seen, counts.seen, Counts().seen] == [1, 1, 1]
    assert Counts.seen.__doc__ == "How often it was computed."


def test_threads_do_not_wait_for_each_other():
    together = Barrier(2, timeout=20)  # opens when both compute it at the same time

    class Waits:
        @cached_property
        def place(self) -> int:
            return together.wait()

    with ThreadPoolExecutor(2) as pool:
        assert sorted(pool.map(lambda one: one.place, [Waits(), Waits()])) == [0, 1]
