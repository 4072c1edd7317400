"""A. S. Mendes et al. (2008): six-cylinder Diesel engine of MWM, cylinder pressure digitised from the
figure; harmonics of the gas torque of one cylinder by convolution of the polyline's exact
coefficients with the closed form of the travel, an own recomputation.
"""

import numpy as np
import pytest
from support.diesel import DIAGRAM
from support.pistons import slider_crank_piston

from balcli.core.cylinder_pressure import press
from balcli.core.piecewise import polyline

# fmt: off
HALF_COEFFICIENTS = [  # c_n of `sum c_n e^{i n theta} + conjugate`, n = 0.5, 1, ...
    (-154.1132086, 151.6983083), (86.19616535, -333.2175935), (-15.00495315, 269.4838527), (-17.38460368, -250.6531301),
    (27.87551456, 201.611346), (-33.18259306, -168.1646024), (34.77835239, 137.0734194), (-34.52982594, -108.9316298),
    (30.69615139, 87.76392151), (-28.44238622, -69.48390554), (24.98419355, 54.44944695), (-20.83842379, -42.02770909),
    (16.8807727, 32.33577736), (-12.9447796, -25.00101077), (10.32697546, 19.77026346), (-8.247588277, -15.5279613),
    (6.804588831, 11.65655521), (-5.840184593, -9.110086945), (5.240350297, 6.402460447), (-4.887756938, -4.440611709),
    (4.219089458, 3.098755851), (-3.980437605, -2.206136502), (3.450876525, 1.496126879), (-2.847044066, -0.944471289),
]
# fmt: on


def test_harmonics_of_the_gas_torque():
    """The crankcase does no work."""
    angle, pressure = np.array(DIAGRAM).T * [[25 / 41], [2e6 / 517]]
    diagram = polyline(np.radians([*angle, 720]), [*pressure, pressure[0]])
    piston = slider_crank_piston(0.137 / 2, 0.207, 0.105)
    found = press(piston, diagram, diagram.breaks, crankcase=0.0)
    for one in (found, press(piston, diagram, diagram.breaks, 2e5)):
        assert one.imep == pytest.approx(1894412.561, rel=1e-9)
    coefficients = found.harmonics(np.arange(25)) / 2
    coefficients[0] *= 2
    assert coefficients[0] == pytest.approx(178.8355058, rel=1e-9)
    expected = [complex(cosine, sine) for cosine, sine in HALF_COEFFICIENTS]
    assert coefficients[1:] == pytest.approx(expected, rel=0, abs=2e-7)
