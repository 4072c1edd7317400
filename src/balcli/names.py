"""Hold the names of modules that are imported on demand. Only this module has such names.

They are the modules of the package's public names, the renderers of results, the types of JSON
documents, the optional tables of an engine file (such as [torsion]), and the less common quantities
of sweep, search and scatter. This module loads no library.
"""

from __future__ import annotations

from importlib import import_module

TYPE_CHECKING = False  # the import of typing is slow, and Ctrl-C during it prints a traceback
if TYPE_CHECKING:
    from typing import Any

# The public names that each module offers to `import balcli`; `balcli/__init__.py` lists them for
# type checkers.
_EXPORTS = {
    "analysis.answer": ("Analysis", "analyze"),
    "analysis.comparison": ("Comparison", "compare"),
    "analysis.curves": ("Curves", "curves"),
    "analysis.piston": ("Pistons", "piston"),
    "analysis.two_engines": ("Combined", "sum"),
    "api": ("Engine", "load", "load_example"),
    "balancing.all_schemes": ("SchemeComparison", "compare_schemes"),
    "balancing.answer": ("Balance", "balance", "fit_webs"),
    "books.answer": ("tables",),
    "books.recomputed": ("Table",),
    "errors": ("BalcliError", "InputError", "NotComputedError"),
    "field_balancing.answer": ("FieldBalance", "field"),
    "locomotives.answer": ("LocomotiveBalance", "locomotive"),
    "mounting.answer": ("mounts",),
    "mounting.records": ("MountReport",),
    "report.plot": ("plot",),
    "show.result": ("Result",),
    "sizing.options": ("SchemeOptions",),
    "sizing.workshop": ("Shapes", "Tools"),
    "studies.scatter": ("Scatter", "scatter"),
    "studies.search.answer": ("Search", "search"),
    "studies.sweep": ("Swept", "sweep"),
    "crank_torque.answer": ("torque",),
    "crank_torque.records": ("TorqueAnalysis",),
    "torsional_vibration.answer": ("TorsionAnalysis", "torsion"),
}
PUBLIC = {name: module for module, names in _EXPORTS.items() for name in names}

# The module whose RENDERER shows a class of results; it is in the folder of this class.
RENDERERS = {
    "Analysis": "analysis.show",
    "Balance": "balancing.show",
    "Combined": "analysis.two_engines",
    "Comparison": "analysis.comparison",
    "Curves": "analysis.curves",
    "FieldBalance": "field_balancing.show",
    "LocomotiveBalance": "locomotives.show",
    "MountReport": "mounting.show",
    "Pistons": "analysis.piston",
    "Scatter": "studies.scatter_command",
    "SchemeComparison": "balancing.all_schemes",
    "Search": "studies.search.command",
    "Swept": "studies.sweep_show",
    "Table": "books.show",
    "TorqueAnalysis": "crank_torque.show",
    "TorsionAnalysis": "torsional_vibration.show",
}

# The class that declares a JSON document, by the name in the document's `format`.
DOCUMENTS = {
    "analysis": "analysis.answer:Analysis",
    "balance": "balancing.answer:Balance",
    "bench": "bench.records:Bench",
    "check": "regression.records:Check",
    "compare": "analysis.comparison:Comparison",
    "curves": "analysis.curves:Curves",
    "field": "field_balancing.answer:FieldBalance",
    "locomotive": "locomotives.answer:LocomotiveBalance",
    "marine": "analysis.speeds:MarineSheet",
    "mounts": "mounting.records:MountReport",
    "numbers": "studies.quantities:NamedNumbers",
    "piston": "analysis.piston:Pistons",
    "record": "crank_torque.recorded_curve:RecordedCurve",
    "scatter": "studies.scatter:Scatter",
    "schemes": "balancing.all_schemes:SchemeComparison",
    "search": "studies.search.answer:Search",
    "speeds": "analysis.speeds:SpeedSeries",
    "sum": "analysis.two_engines:Combined",
    "sweep": "studies.sweep_show:SweepDocument",
    "table": "books.recomputed:Table",
    "torque": "crank_torque.records:TorqueAnalysis",
    "torsion": "torsional_vibration.answer:TorsionAnalysis",
}

# The module of each optional table of an engine file; the capitalized key is its class (Gas).
CHAPTERS = {
    "articulation": "file.model",
    "gas": "file.gas_tables",
    "flywheel": "file.gas_tables",
    "bearing": "file.gas_tables",
    "torsion": "file.torsion_tables",
    "body": "file.mount_tables",
    "locomotive": "file.locomotive_tables",
    "check": "file.check_table",
}
# Optional tables that a file may have several times.
CHAPTER_LISTS = {
    "engine": "file.engine_tables",
    "mount": "file.mount_tables",
    "point": "file.mount_tables",
    "axle": "file.locomotive_tables",
    "web": "file.web_tables",
}
# The module that computes each group of further quantities for sweep, search and scatter.
QUANTITIES = {
    "guide": "forces.guide_quantity",
    "cycle": "crank_torque.quantity",
    "piston": "analysis.piston",
    "journals": "analysis.crank_drive",
    "mounts": "mounting.quantity",
    "torsion": "torsional_vibration.quantity",
}


def import_name(place: str) -> Any:
    """Return a module of the package, or an object of it.

    Args:
        place: Module below `balcli`, or `module:name`.
    """
    module, _, name = place.partition(":")
    found = import_module(f"balcli.{module}")
    return getattr(found, name) if name else found
