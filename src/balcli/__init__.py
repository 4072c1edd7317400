"""Engine balance: free forces and moments of reciprocating engines, order by order, and devices
that cancel them.

    from balcli import load, analyze, balance

    engine = load("v8.toml")
    print(analyze(engine).spectra.moment.major)
"""

from __future__ import annotations

from .names import PUBLIC, import_name
from .version import __version__ as __version__

TYPE_CHECKING = False  # the import of typing is slow, and Ctrl-C during it prints a traceback
if TYPE_CHECKING:
    from .analysis.answer import Analysis as Analysis, analyze as analyze
    from .analysis.comparison import Comparison as Comparison, compare as compare
    from .analysis.curves import Curves as Curves, curves as curves
    from .analysis.piston import Pistons as Pistons, piston as piston
    from .analysis.two_engines import Combined as Combined, sum as sum  # noqa: A004
    from .balancing.answer import Balance as Balance, balance as balance
    from .books.answer import tables as tables
    from .books.recomputed import Table as Table
    from .crank_torque.answer import torque as torque
    from .crank_torque.records import TorqueAnalysis as TorqueAnalysis
    from .engine.engine import Engine as Engine
    from .engine.load import load as load, load_example as load_example
    from .errors import BalcliError as BalcliError, InputError as InputError
    from .field_balancing.answer import FieldBalance as FieldBalance, field as field
    from .locomotives.answer import (
        LocomotiveBalance as LocomotiveBalance,
        locomotive as locomotive,
    )
    from .mounting.answer import mounts as mounts
    from .mounting.records import MountReport as MountReport
    from .report.plot import plot as plot
    from .show.result import Result as Result
    from .sizing.options import SchemeOptions as SchemeOptions
    from .sizing.workshop import Shapes as Shapes, Tools as Tools
    from .studies.scatter import Scatter as Scatter, scatter as scatter
    from .studies.search.answer import Search as Search, search as search
    from .studies.sweep import Swept as Swept, sweep as sweep
    from .torsional_vibration.answer import (
        TorsionAnalysis as TorsionAnalysis,
        torsion as torsion,
    )

__all__ = sorted(["__version__", *PUBLIC])


def __dir__() -> list[str]:
    """Return the public names of the library, for completion."""
    return __all__


if not TYPE_CHECKING:  # a type checker that sees __getattr__ accepts any name

    def __getattr__(name: str) -> object:
        """Return the object of a public name; its module is imported at the first use."""
        if name not in PUBLIC:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        return import_name(f"{PUBLIC[name]}:{name}")
