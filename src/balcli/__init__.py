"""Engine balance: free forces and moments of reciprocating engines, order by order, and what
cancels them.

    from balcli import load, analyze, balance

    engine = load("v8.toml")
    print(analyze(engine).spectra.moment.major)
"""

from __future__ import annotations

from .version import __version__

TYPE_CHECKING = (
    False  # typing takes longer than all else here, and until then Ctrl-C is a traceback
)
if TYPE_CHECKING:
    from .engine.build import Engine
    from .engine.load import load
    from .errors import BalcliError, InputError
    from .field_balancing.balance import FieldBalance
    from .forces.curves import Curves
    from .library.balance import balance
    from .library.combine import combine
    from .library.compare import compare
    from .library.curves import curves
    from .library.examples import load_example
    from .library.mounts import analyze_mounts
    from .library.plot import plot
    from .library.rotor import balance_rotor
    from .library.scatter import scatter
    from .library.search import search
    from .library.sweep import sweep
    from .library.tables import tables
    from .library.torque import analyze_torque
    from .library.torsion import analyze_torsion
    from .mounting.records import MountReport
    from .printed_tables.recomputed import Table
    from .result import Result
    from .results.analysis import Analysis, analyze
    from .results.balance import Balance
    from .results.comparison import Comparison
    from .results.two_engines import Combined
    from .sizing.options import SchemeOptions
    from .sizing.workshop import Tools
    from .studies.scatter import Scatter
    from .studies.search.search import Search
    from .studies.sweep import Swept
    from .torque.answer import TorqueAnalysis
    from .torsion.analysis import TorsionAnalysis

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

_ROOMS = {
    "Analysis": "results.analysis",
    "analyze": "results.analysis",
    "Balance": "results.balance",
    "balance": "library.balance",
    "BalcliError": "errors",
    "InputError": "errors",
    "Combined": "results.two_engines",
    "combine": "library.combine",
    "Comparison": "results.comparison",
    "compare": "library.compare",
    "Curves": "forces.curves",
    "curves": "library.curves",
    "Engine": "engine.build",
    "load": "engine.load",
    "load_example": "library.examples",
    "FieldBalance": "field_balancing.balance",
    "balance_rotor": "library.rotor",
    "MountReport": "mounting.records",
    "plot": "library.plot",
    "analyze_mounts": "library.mounts",
    "Result": "result",
    "Scatter": "studies.scatter",
    "scatter": "library.scatter",
    "SchemeOptions": "sizing.options",
    "Search": "studies.search.search",
    "search": "library.search",
    "Swept": "studies.sweep",
    "sweep": "library.sweep",
    "Table": "printed_tables.recomputed",
    "tables": "library.tables",
    "Tools": "sizing.workshop",
    "TorqueAnalysis": "torque.answer",
    "analyze_torque": "library.torque",
    "TorsionAnalysis": "torsion.analysis",
    "analyze_torsion": "library.torsion",
}


def __dir__() -> list[str]:
    """What the library promises, for completion."""
    return __all__


if not TYPE_CHECKING:  # which would else believe in any name

    def __getattr__(name: str) -> object:
        """The library's door: what is behind it is imported when it is first asked for."""
        if name not in _ROOMS:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        from importlib import import_module

        return getattr(import_module(f".{_ROOMS[name]}", __name__), name)
