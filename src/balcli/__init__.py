"""Engine balance: free forces and moments of reciprocating engines, order by order, and devices
that cancel them.

    from balcli import load, analyze, balance

    engine = load("v8.toml")
    print(analyze(engine).spectra.moment.major)
"""

from __future__ import annotations

from .names import PUBLIC, import_name
from .version import __version__

TYPE_CHECKING = False  # importing typing is slow, and Ctrl-C shows a traceback meanwhile
if TYPE_CHECKING:
    from .analysis.answer import Analysis, analyze
    from .analysis.comparison import Comparison, compare
    from .analysis.curves import Curves, curves
    from .analysis.two_engines import Combined, combine
    from .balancing.answer import Balance, balance
    from .books.answer import tables
    from .books.recomputed import Table
    from .engine.engine import Engine
    from .engine.load import load, load_example
    from .errors import BalcliError, InputError
    from .field.answer import FieldBalance, balance_rotor
    from .locomotive.answer import LocomotiveBalance, analyze_locomotive
    from .mounts.answer import analyze_mounts
    from .mounts.records import MountReport
    from .report.plot import plot
    from .show.result import Result
    from .sizing.options import SchemeOptions
    from .sizing.workshop import Tools
    from .studies.scatter import Scatter, scatter
    from .studies.search.answer import Search, search
    from .studies.sweep import Swept, sweep
    from .torque.answer import analyze_torque
    from .torque.records import TorqueAnalysis
    from .torsion.answer import TorsionAnalysis, analyze_torsion

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
    "Result",
    "Scatter",
    "SchemeOptions",
    "Search",
    "Swept",
    "Table",
    "Tools",
    "TorqueAnalysis",
    "TorsionAnalysis",
    "__version__",
    "analyze",
    "analyze_locomotive",
    "analyze_mounts",
    "analyze_torque",
    "analyze_torsion",
    "balance",
    "balance_rotor",
    "combine",
    "compare",
    "curves",
    "load",
    "load_example",
    "plot",
    "scatter",
    "search",
    "sweep",
    "tables",
]


def __dir__() -> list[str]:
    """Return the public names of the library, for completion."""
    return __all__


if not TYPE_CHECKING:  # a type checker would accept any name

    def __getattr__(name: str) -> object:
        """Return a public name of the library; its module is imported at the first use."""
        if name not in PUBLIC:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        return import_name(f"{PUBLIC[name]}:{name}")
