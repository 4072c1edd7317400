"""The textbooks' two-term forms of the centred slider-crank (in crank radii, by lambda = r/l), and
how far they are out.
"""

import numpy as np

from balcli.core.mechanisms import slidercrank

PSI = np.radians(np.arange(0.5, 180.0, 0.01))  # travel and velocity vanish at both ends


def displacement(psi, lam):
    return (1 - np.cos(psi)) + lam / 4 * (1 - np.cos(2 * psi))


def velocity(psi, lam):
    return np.sin(psi) + lam / 2 * np.sin(2 * psi)


def acceleration(psi, lam):
    return np.cos(psi) + lam * np.cos(2 * psi)


def errors(form, lam):
    """Two-term form less exact one, at all PSI."""
    return form(PSI, lam) - getattr(slidercrank, form.__name__)(PSI, lam)


def largest_error(form, lam):
    return np.abs(errors(form, lam)).max()
