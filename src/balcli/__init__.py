"""Engine balance: free forces and moments of reciprocating engines, order by order, and devices
that cancel them.

    from balcli import load

    engine = load("v8.toml")
    print(engine.analyze().spectra["moment"].major)
    print(engine.balance("counterweights").after.peak.moment.value)
"""

from __future__ import annotations

from .names import PUBLIC, import_name
from .version import __version__

TYPE_CHECKING = False  # the import of typing is slow, and Ctrl-C during it prints a traceback
if TYPE_CHECKING:
    from .analysis.answer import Analysis, analyze
    from .analysis.comparison import Comparison, compare
    from .analysis.curves import Curves, curves
    from .analysis.piston import Pistons, piston
    from .analysis.two_engines import Combined, sum  # noqa: A004
    from .api import Engine, load, load_example
    from .balancing.all_schemes import SchemeComparison, compare_schemes
    from .balancing.answer import Balance, balance, fit_webs
    from .books.answer import tables
    from .books.recomputed import Table
    from .crank_torque.answer import torque
    from .crank_torque.records import TorqueAnalysis
    from .errors import BalcliError, InputError, NotComputedError
    from .field_balancing.answer import FieldBalance, field
    from .locomotives.answer import LocomotiveBalance, locomotive
    from .mounting.answer import mounts
    from .mounting.records import MountReport
    from .report.plot import plot
    from .show.result import Result
    from .sizing.options import SchemeOptions
    from .sizing.workshop import Shapes, Tools
    from .studies.scatter import Scatter, scatter
    from .studies.search.answer import Search, search
    from .studies.sweep import Swept, sweep
    from .torsional_vibration.answer import TorsionAnalysis, torsion

__all__ = [
    "Analysis",
    "Balance",
    "BalcliError",
    "Combined",
    "Comparison",
    "Curves",
    "Engine",
    "FieldBalance",
    "InputError",
    "LocomotiveBalance",
    "MountReport",
    "NotComputedError",
    "Pistons",
    "Result",
    "Scatter",
    "SchemeComparison",
    "SchemeOptions",
    "Search",
    "Shapes",
    "Swept",
    "Table",
    "Tools",
    "TorqueAnalysis",
    "TorsionAnalysis",
    "__version__",
    "analyze",
    "balance",
    "compare",
    "compare_schemes",
    "curves",
    "field",
    "fit_webs",
    "load",
    "load_example",
    "locomotive",
    "mounts",
    "piston",
    "plot",
    "scatter",
    "search",
    "sum",
    "sweep",
    "tables",
    "torque",
    "torsion",
]


def __dir__() -> list[str]:
    """Return the public names of the library, for completion."""
    return __all__


if not TYPE_CHECKING:  # a type checker that sees __getattr__ accepts any name

    def __getattr__(name: str) -> object:
        """Return the object of a public name; its module is imported at the first use."""
        if name not in PUBLIC:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        return import_name(f"{PUBLIC[name]}:{name}")
