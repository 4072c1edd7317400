"""Which documents there are, without what it takes to describe them."""

# By name, which stands in `format` too: module of the package, and the class that declares it.
DOCUMENTS = {
    "analysis": "documents.analysis:Analysis",
    "balance": "documents.analysis:Balance",
    "bench": "bench:Bench",
    "check": "regression:Check",
    "compare": "results.comparison:Comparison",
    "curves": "documents.studies:Curves",
    "field": "field_balancing.balance:FieldBalance",
    "marine": "documents.analysis:Marine",
    "mounts": "mounting.records:MountReport",
    "numbers": "studies.numbers:NamedNumbers",
    "scatter": "studies.scatter:Scatter",
    "search": "documents.studies:Search",
    "speeds": "documents.analysis:Speeds",
    "sum": "documents.analysis:Sum",
    "sweep": "documents.studies:Sweep",
    "table": "documents.studies:Table",
    "torque": "torque.answer:TorqueAnalysis",
    "torsion": "torsion.analysis:TorsionAnalysis",
}
