"""Find out which engine a firing order means, or list the engines that fit the file.

A firing order describes an engine only if each number has a known place (bank and throw). Makers
number bank by bank (1-2-3, 4-5-6) or along the crank (1-3-5, 2-4-6), and begin with different
banks. So one order can mean several engines with different moments. A numbering *fits* if, with all
keys of the file, every cylinder is within 1 deg of its dead centre when it fires. A file without
`layout.numbering` is read by these rules (`rules`):

- If the file gives throws, numbering bank by bank is used if it fits.
- Otherwise the usual numberings (`usual`) are tried in up to three tiers, from the most usual on;
  the first tier with a numbering that fits decides. If the file gives no throws, and the numberings
  of tier 1 that fit describe only one engine (`candidates`), this engine is used. Otherwise the
  user has to choose among the engines of the tier.
- Two numberings describe the same engine if their firing angles differ by the same shift at all
  places (throw, bank).
- If the names in the firing order have letters for the banks, every way to give letters to banks is
  tried instead (`letters`).
- In a flat two-stroke without throws and intervals, cylinders may fire evenly or together in pairs,
  and the user has to choose (`together`).
- If nothing fits, the list has the uneven intervals of common crank pins (`common_pins`), then
  split pins.

A numbering in the file is never replaced; if it does not fit, the error proposes changes of single
keys (`hints`).
"""
