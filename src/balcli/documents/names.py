"""Which documents there are, without what it takes to describe them."""

# By name, which stands in `format` too: the module here with the TypedDict that is called so, or
# the module of the package and the class of records that `to_document` writes.
DOCUMENTS = {
    "analysis": "analysis",
    "balance": "analysis",
    "bench": "bench:Bench",
    "check": "regression:Check",
    "compare": "results.comparison:Comparison",
    "curves": "studies",
    "field": "field_balancing.balance:FieldBalance",
    "marine": "analysis",
    "mounts": "mounting.records:MountReport",
    "numbers": "studies.numbers:NamedNumbers",
    "scatter": "studies.scatter:Scatter",
    "search": "studies",
    "speeds": "analysis",
    "sum": "analysis",
    "sweep": "studies",
    "table": "studies",
    "torque": "torque.answer:TorqueAnalysis",
    "torsion": "torsion.analysis:TorsionAnalysis",
}
