"""Which documents there are, without what it takes to describe them."""

# By name, which stands in `format` too, the module with the type that is called so.
DOCUMENTS = {
    "analysis": "analysis",
    "balance": "analysis",
    "bench": "studies",
    "check": "studies",
    "compare": "studies",
    "curves": "studies",
    "field": "field",
    "marine": "analysis",
    "mounts": "vibration",
    "numbers": "studies",
    "scatter": "studies",
    "search": "studies",
    "speeds": "analysis",
    "sum": "analysis",
    "sweep": "studies",
    "table": "studies",
    "torque": "torque",
    "torsion": "vibration",
}
