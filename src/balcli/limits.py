"""Every "at most" that a user can run into, with its reason.

All are far beyond any engine. They are there so that whatever is fed to balcli ends soon, in little
memory, as a result or as a message that names the limit. Parameters of a method (samples of a
search, results computed at a time) are defined with the method.
"""

from __future__ import annotations

# Text of an engine file ----------------------------------------------------------------------
LARGEST_FILE_BYTES = 6_000_000  # no more is ever read, from a device without end either
MOST_TOML_MARKS = 180_000  # of "[", "{", ".", ",", "=": each stands for up to 1 kB in tomllib
DEEPEST_KEY = 32  # parts of a dotted key: the memory of tomllib grows with their square
LONGEST_NAME = 200  # characters; the name stands in every line of a CSV
LONGEST_FILE_NAME = 255  # of a file that an engine file names: file systems have no longer ones
MOST_ROWS = 20_000  # of such a file: a diagram of 720 deg in steps of 0.05 has 14 400
LONGEST_ROW = 10_000  # characters: hundreds of columns
LARGEST_IN_COLUMNS = 1e30  # of a figure in such a file, either way: its products are no overflow
LONGEST_FIGURE = 100  # characters of a number with its unit: no regular expression sees more
LONGEST_SHOWN = 60  # characters of a value that a message repeats: it stays one line
MOST_MISTAKES_SHOWN = 20  # of one file: they stay on the screen

# What an engine may have ---------------------------------------------------------------------
MOST_PARTS = 1000  # cylinders, devices of a kind: still quick to analyse
MOST_ENGINES = 12  # geared together; the largest built have three or four cranks
MOST_LIST_VALUES = 10_000  # of a list, and the largest number of a bank, a cylinder, an order
MOST_KEY_VALUES = 2 * MOST_LIST_VALUES  # inner lists included: millions would be refused one by one
HIGHEST_RIPPLE_ORDER = 256  # every order of the engine reaches that much further
MOST_RIPPLES = 256  # orders of the uneven speed: as many as there are
HIGHEST_SHAFT_ORDER = 1000  # of a balancer shaft: the orders computed reach up to it
SMALLEST_POSITIVE = 1e-12  # where a figure must be above 0: its square and cube are no underflow
# How far lambda + |offset| / rod length, and the sine of an articulated rod's angle, must stay
# below 1: nearer to its lock a mechanism has orders beyond number.
NEAREST_TO_LOCK = 1e-6
# Samples of a revolution, of all mechanisms that differ: seconds. Far from their lock mechanisms
# take 64 to 256 each.
MOST_SAMPLES = 1 << 19

# Orders --------------------------------------------------------------------------------------
HIGHEST_ORDER = 4096  # that may be asked for: closed forms are good to here
HIGHEST_ORDER_UNASKED = 512  # that is shown otherwise: only a mechanism near its lock has more
HIGHEST_GAS_ORDER_UNASKED = 12  # of gas torque: it falls off slowly
MOST_HARMONICS_UNASKED = 512  # of a torque curve of many turns: more lines nobody reads
HIGHEST_HARMONIC = 1 << 16  # of such a curve's period: seconds
HIGHEST_TABLE_ORDER = 100  # of tangential pressure: builders' tables end at 12 to 24
HIGHEST_ORDER_SOUGHT = 8  # where a scheme looks for something to balance: engines have it below
MOST_RESULTS_BY_CYLINDER = 1 << 14  # cylinders x orders that are told one by one
MOST_RESULTS_ALONG_CRANK = 1 << 15  # loads x orders, whose peaks are looked for place by place
MOST_FORCES_OVER_CYCLE = 1 << 23  # forces along the crank x angles of a cycle: half a minute
MOST_DIFFERENT_GAS = 200  # cycles that are computed or read one by one: 10 to 40 ms each
MOST_LOADS_APART = 1_100_000  # loads x orders kept one by one, and half as many at uneven speed

# Figures asked for on the command line -------------------------------------------------------
FINEST_STEP_DEG = 1e-3  # of the crank angle: 360 000 angles
FARTHEST_DEG = 1e6  # phase and turn of a second engine, torque curves: angles keep 10 digits
FARTHEST_M = 1e6  # place of a second engine
SMALLEST_FLUCTUATION = 1e-9  # of the speed, asked for: less is lost in rounding
FLUCTUATION = "give (highest - lowest)/mean speed, such as 1/200 or 0.5%"
FARTHEST_DEVICE_M = 50.0  # place of a shaft or plane: the longest engines have 30
SMALL = 0.05  # of one cylinder's first order: what turns one way in an order is left if below
MOST_SMALL = 0.5  # that may be asked for instead
WORTH_A_SHAFT = 0.3  # of one cylinder's first order: fitted unless something else is asked for
LARGEST_FACTOR = 2  # share of the reciprocating mass, either way: shops take 0 to 1
MOST_DIGITS = 15  # of figures in tables: what a floating-point number has
MOST_FACTORS = 1000  # steps of a range of balance factors
MOST_TABLE_VALUES = 100_000  # steps of a range of a printed table, and figures of its body
LARGEST_TABLE_VALUE = 10**9  # in such a range
HIGHEST_POWER = 200  # of lambda in a table of series: exact fractions, a second or two

# Variants ------------------------------------------------------------------------------------
MOST_PARAMETERS = 16  # that vary at once: each is an axis of arrays, which have up to 32
MOST_PARAMETER_VALUES = 10_000_000  # of one parameter: all are kept, 80 MB; grids may have more
MOST_THREADS = 64  # of a sweep: each computes a few boxes ahead, of some 10 MB each
MOST_KEPT_FIGURES = 100_000_000  # of a sweep in Python: all are kept, 0.8 GB
MOST_ROWS_READ = 50  # of the table of a sweep: of more the first and the last are shown
MOST_PICTURE_VARIANTS = 4_000_000  # of a sweep: a picture keeps all of them in memory
MOST_TOLERANCE_SAMPLES = 2_000_000  # of random variants as arrays, all of which are kept
MOST_SINGLE_SAMPLES = 20_000  # of random variants computed one by one: 2 to 100 ms each
MOST_FOUND = 1000  # designs that a search lists: nobody reads more
MOST_ARRANGEMENTS = 10**10  # of given throws: branch and bound tries few of them
MOST_DESIGNS_ONE_BY_ONE = 2000  # of gas, mounts or torsion: each takes 10 to 50 ms
MOST_EVEN_CRANKS = 200_000  # with an even firing order: each of them is tried
MOST_CYLINDERS_FIRED = 64  # whose firing orders are looked for

# Field balancing -----------------------------------------------------------------------------
MOST_BALANCING_PLANES = 50  # weights that influence one another: solved together, 1 s at most
MOST_SENSORS = 200  # readings of one run
MOST_RUNS = 500  # nobody starts a machine more often
MOST_PLACES = 720  # blades or holes of a plane: every pair of them may be looked at

# Ranges of speeds ---------------------------------------------------------------------------
HIGHEST_GUIDE_M = 1e3  # from the crankshaft to the middle of the guides
MOST_SPEEDS = 20_000  # of mounts and torsion: all figures of each are kept
MOST_ANALYSED_SPEEDS = 1_000  # of analyze: an analysis each, milliseconds of the largest engines

# Engine mounts -------------------------------------------------------------------------------
MOST_MOUNTS = 100  # and points: each has a curve for every speed
MOST_MOUNT_RESULTS = 4_000_000  # orders x speeds x mounts and points: 300 MB

# Torsion -------------------------------------------------------------------------------------
MOST_TORSION_NODES = 200  # of a chain: modes of all of them take a second
LARGEST_INERTIA = 1e18  # kg m2, of a damper or flywheel: its square is no overflow
HIGHEST_TORSION_ORDER = 256  # a cycle is sampled 16 times as often
MOST_TORSION_TORQUES = 10_000_000  # orders x speeds x shafts: all are kept, 8 bytes each
HIGHEST_TORSION_ORDER_UNASKED = 32  # of cylinders, besides their firing order and its double
