"""Names of the pages of pictures that an engine has; loads no library."""

OF_GAS = ("pressure", "p-v", "torque", "pin", "main")
OF_TORSION = ("modes", "campbell", "response", "waterfall")
PAGES = (
    *("overview", "all", "polar", "orders", "spectrum", "curves", "factor", "bank", "inner"),
    *OF_GAS,
    *OF_TORSION,
)
