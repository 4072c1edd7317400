"""Every limit that a user can reach, with its reason.

All limits are far beyond any engine. They ensure that balcli answers every input soon and in
little memory, with a result or with a message that names the limit. Parameters of a numerical
method (such as samples or block sizes) are defined with the method.
"""

from __future__ import annotations

# Text of an engine file ----------------------------------------------------------------------
LARGEST_FILE_BYTES = 6_000_000  # reading stops here, even from an endless device
MOST_TOML_MARKS = 180_000  # number of "[", "{", ".", ",", "=": each takes up to 1 kB in tomllib
DEEPEST_KEY = 32  # parts of a dotted key; memory in tomllib grows with their number squared
LONGEST_NAME = 200  # characters; every line of a CSV repeats the name
LONGEST_FILE_NAME = 255  # name of a file in an engine file; the limit of file systems
MOST_ROWS = 20_000  # rows of a CSV file: a diagram of 720 deg in steps of 0.05 has 14 400
LONGEST_ROW = 10_000  # characters of a row in a CSV file: hundreds of columns
LARGEST_IN_COLUMNS = 1e30  # figure in a CSV file: products of such figures do not overflow
LONGEST_FIGURE = 100  # characters of a number with its unit, which a regular expression parses
LONGEST_SHOWN = 60  # characters of a value that a message quotes
MOST_MISTAKES_SHOWN = 20  # listed mistakes of one file: as many as fit on the screen
WRITTEN_DIGITS = 12  # of a number that a command writes into a file: no scales show as many

# What an engine may have ---------------------------------------------------------------------
MOST_PARTS = 1000  # cylinders, or devices of one kind
MOST_ENGINES = 12  # engines geared together; the largest built have three or four cranks
MOST_LIST_VALUES = 10_000  # length of a list; highest bank number, cylinder number or order
MOST_KEY_VALUES = 2 * MOST_LIST_VALUES  # values of a key, inner lists included
HIGHEST_RIPPLE_ORDER = 256  # order of the uneven speed; raises the orders of forces by as much
MOST_RIPPLES = 256  # number of orders of the uneven speed
HIGHEST_SHAFT_ORDER = 1000  # order of a balancer shaft; orders are computed up to it
SMALLEST_POSITIVE = 1e-12  # least figure above 0: its square and cube do not underflow
# Two figures must be below 1 by at least this difference: (crank radius + |offset|) / rod length,
# and the sine of an articulated rod's angle. At 1 the mechanism locks; just below, it has too many
# orders.
NEAREST_TO_LOCK = 1e-6
# Samples of a revolution, summed over all different mechanisms; so many take seconds. A mechanism
# far from locking needs 64 to 256.
MOST_SAMPLES = 1 << 19

# Orders --------------------------------------------------------------------------------------
HIGHEST_ORDER = 4096  # order that a user may choose: closed forms are accurate up to here
HIGHEST_ORDER_UNASKED = 512  # order shown by default: only a mechanism close to locking has more
HIGHEST_GAS_ORDER_UNASKED = 12  # order of gas torque shown by default: amplitudes fall slowly
MOST_HARMONICS_UNASKED = 512  # harmonics of a torque curve of many turns, shown by default
HIGHEST_HARMONIC = 1 << 16  # harmonic of a torque curve's period; so many take seconds
HIGHEST_TABLE_ORDER = 100  # order in a table of tangential pressure: printed ones end at 12 to 24
HIGHEST_ORDER_SOUGHT = 8  # order up to which a scheme looks for an unbalanced order
MOST_RESULTS_BY_CYLINDER = 1 << 14  # cylinders x orders that are listed singly
MOST_RESULTS_ALONG_CRANK = 1 << 15  # loads x orders whose peaks along the crank are computed
MOST_FORCES_OVER_CYCLE = 1 << 23  # forces along the crank x angles of a cycle: half a minute
MOST_DIFFERENT_GAS = 200  # gas cycles of one engine: each takes 10 to 40 ms
MOST_LOADS_APART = 1_100_000  # loads of single cylinders x orders; half as many at uneven speed

# Figures asked for on the command line -------------------------------------------------------
FINEST_STEP_DEG = 1e-3  # step of the crank angle: 360 000 angles
FARTHEST_DEG = 1e6  # phase and turn of a second engine, angles of torque curves: 10 digits remain
FARTHEST_M = 1e6  # position of a second engine
SMALLEST_FLUCTUATION = 1e-9  # wanted fluctuation of the speed: a smaller one is lost in rounding
FLUCTUATION = "(highest - lowest)/mean speed, such as 1/200 or 0.5%"
FARTHEST_DEVICE_M = 50.0  # position of a shaft or plane: the longest engines have 30
SMALL = 0.05  # default share of one cylinder's first order below which vectors are left unbalanced
MOST_SMALL = 0.5  # largest value of this share that a user may choose
# Shares of one cylinder's first order from which a shaft is fitted by default. In order 2, the
# share is multiplied by the number of cylinders, counted as at least three (docs/ladders.md).
WORTH_A_SHAFT_OF_ORDER_1 = 0.18
WORTH_A_SHAFT_OF_ORDER_2 = 0.12
FEWEST_CYLINDERS_COUNTED = 3
LARGEST_FACTOR = 2  # balance factor, of either sign: 0 to 1 is usual
MOST_DIGITS = 15  # digits of figures in tables: those of a floating-point number
MOST_FACTORS = 1000  # steps of a range of balance factors
MOST_TABLE_VALUES = 100_000  # values in a range of a printed table, and figures in its body
LARGEST_TABLE_VALUE = 10**9  # value in a range of a printed table
HIGHEST_POWER = 200  # power of lambda in a table of series: exact fractions take 1 to 2 s

# Variants ------------------------------------------------------------------------------------
MOST_PARAMETERS = 16  # parameters of a sweep: each is an axis of an array (numpy allows 32)
MOST_PARAMETER_VALUES = 10_000_000  # values of one parameter: all are kept (80 MB)
MOST_THREADS = 64  # threads of a sweep: each computes a few blocks of about 10 MB ahead
MOST_KEPT_FIGURES = 100_000_000  # figures of a sweep in Python: all are kept, 0.8 GB
MOST_ROWS_READ = 50  # rows in the table of a sweep; longer tables show the first ones
MOST_PICTURE_VARIANTS = 4_000_000  # variants in a picture, which keeps all of them in memory
MOST_TOLERANCE_SAMPLES = 2_000_000  # random variants computed as arrays, which are all kept
MOST_SLOW_SAMPLES = 20_000  # random variants of gas, mounts or torsion: 0.2 to 100 ms each
MOST_FOUND = 1000  # designs that a search lists
MOST_ARRANGEMENTS = 10**10  # arrangements of throws: branch and bound tries few of these
MOST_GAS_POINTS = 200  # speeds that have their own diagram or cycle
MOST_DESIGNS_ONE_BY_ONE = 2000  # designs in a search by gas, mounts or torsion: 10 to 50 ms each
MOST_EVEN_CRANKS = 200_000  # cranks with an even firing order: all are tried
MOST_CYLINDERS_FIRED = 64  # cylinders of an engine whose firing order is searched

# Field balancing -----------------------------------------------------------------------------
MOST_BALANCING_PLANES = 50  # planes of a rotor: all weights are computed together, in 1 s at most
MOST_SENSORS = 200  # readings of one run
MOST_RUNS = 500  # nobody starts a machine more often
MOST_PLACES = 720  # blades or holes of a plane: every pair of them may be looked at

# Ranges of speeds ---------------------------------------------------------------------------
HIGHEST_GUIDE_M = 1e3  # distance from the crankshaft to the middle of the guides
MOST_SPEEDS = 20_000  # speeds of mounts and torsion: all figures of every speed are kept
MOST_ANALYSED_SPEEDS = 1_000  # speeds of analyze: each is a full analysis

# Engine mounts -------------------------------------------------------------------------------
MOST_MOUNTS = 100  # mounts or points: each has figures at every speed
MOST_MOUNT_RESULTS = 4_000_000  # orders x speeds x mounts and points: 300 MB

# Torsion -------------------------------------------------------------------------------------
MOST_TORSION_NODES = 200  # nodes of a chain: all modes take a second
LARGEST_INERTIA = 1e18  # inertia of a damper or flywheel, kg m2: its square does not overflow
HIGHEST_TORSION_ORDER = 256  # order of an excitation: a cycle has 16 times as many samples
MOST_TORSION_TORQUES = 10_000_000  # orders x speeds x shafts: all are kept, 8 bytes each
HIGHEST_TORSION_ORDER_UNASKED = 32  # highest default order; `list_gas_orders` may add two
