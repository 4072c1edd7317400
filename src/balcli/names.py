"""Modules by name: the one place where modules stand in strings.

It lists objects that modules below them import on demand: the package's public names, renderers of
results, types of documents, tables of chapters in an engine file, and their quantities. It loads no
library.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

# What `import balcli` offers: the names of each module.
_ROOMS = {
    "analysis.answer": "Analysis analyze",
    "analysis.comparison": "Comparison compare",
    "analysis.curves": "Curves curves",
    "analysis.piston": "Pistons analyze_pistons",
    "analysis.two_engines": "Combined combine",
    "balancing.answer": "Balance balance",
    "books.answer": "tables",
    "books.recomputed": "Table",
    "engine.engine": "Engine",
    "engine.load": "load load_example",
    "errors": "BalcliError InputError",
    "field.answer": "FieldBalance balance_rotor",
    "mounts.answer": "analyze_mounts",
    "mounts.records": "MountReport",
    "report.plot": "plot",
    "show.result": "Result",
    "sizing.options": "SchemeOptions",
    "sizing.workshop": "Tools",
    "studies.scatter": "Scatter scatter",
    "studies.search.answer": "Search search",
    "studies.sweep": "Swept sweep",
    "torque.answer": "analyze_torque",
    "torque.records": "TorqueAnalysis",
    "torsion.answer": "TorsionAnalysis analyze_torsion",
}
PUBLIC = {name: module for module, names in _ROOMS.items() for name in names.split()}

# What shows a kind of result: the module with its RENDERER.
RENDERERS = {
    "Analysis": "analysis.show",
    "Balance": "balancing.show",
    "Combined": "analysis.two_engines",
    "Comparison": "analysis.comparison",
    "Curves": "analysis.curves",
    "FieldBalance": "field.show",
    "MountReport": "mounts.show",
    "Pistons": "analysis.piston",
    "Scatter": "studies.scatter_command",
    "Search": "studies.search.command",
    "Swept": "studies.sweep_show",
    "Table": "books.show",
    "TorqueAnalysis": "torque.show",
    "TorsionAnalysis": "torsion.show",
}

# JSON documents, by the name that stands in `format`: the class that declares each.
DOCUMENTS = {
    "analysis": "analysis.answer:Analysis",
    "balance": "balancing.show:BalanceDocument",
    "bench": "bench:Bench",
    "check": "regression:Check",
    "compare": "analysis.comparison:Comparison",
    "curves": "analysis.curves:Curves",
    "field": "field.answer:FieldBalance",
    "marine": "analysis.speeds:MarineSheet",
    "mounts": "mounts.records:MountReport",
    "numbers": "studies.quantities:NamedNumbers",
    "piston": "analysis.piston:Pistons",
    "scatter": "studies.scatter:Scatter",
    "search": "studies.search.answer:Search",
    "speeds": "analysis.speeds:SpeedSeries",
    "sum": "analysis.two_engines:Combined",
    "sweep": "studies.sweep_show:SweepDocument",
    "table": "books.recomputed:Table",
    "torque": "torque.records:TorqueAnalysis",
    "torsion": "torsion.answer:TorsionAnalysis",
}

# Tables of chapters in an engine file; the class of each is called like the key.
CHAPTERS = {
    "articulation": "file.model",
    "gas": "file.gas_tables",
    "flywheel": "file.gas_tables",
    "bearing": "file.gas_tables",
    "torsion": "file.torsion_tables",
    "body": "file.mount_tables",
}
# Those that may stand several times in a file.
CHAPTER_LISTS = {
    "engine": "file.engine_tables",
    "mount": "file.mount_tables",
    "point": "file.mount_tables",
}
# What computes the quantities of a chapter for sweep, search and scatter.
QUANTITIES = {
    "guide": "forces.guide",
    "cycle": "torque.quantity",
    "mounts": "mounts.quantity",
    "torsion": "torsion.quantity",
}
NOTEBOOK = "show.notebook:show_engine"
VARY = "engine.load:vary_engine"
READ_GEARED = "engine.placed:read_engines"
GEARED = "engine.placed:build_geared"
CRANKS = "engine.placed:share_state"
EXPLORE = "report.page:explore"


def import_name(place: str) -> Any:
    """Return a module of the package, or an object of it.

    Args:
        place: Module below `balcli`, or `module:name`.
    """
    module, _, name = place.partition(":")
    found = import_module(f"balcli.{module}")
    return getattr(found, name) if name else found
