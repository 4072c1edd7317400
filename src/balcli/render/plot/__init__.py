"""Pictures by matplotlib, and the names of the pages that an engine has."""

OF_GAS = ("pressure", "p-v", "torque", "pin", "main")
OF_TORSION = ("modes", "campbell", "response", "waterfall")
PAGES = (
    *("overview", "all", "polar", "orders", "spectrum", "curves", "factor", "bank", "inner"),
    *OF_GAS,
    *OF_TORSION,
)
