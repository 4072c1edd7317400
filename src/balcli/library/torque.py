"""`balcli.analyze_torque`"""

from __future__ import annotations

from ..torque.analysis import analyze_torque as analyze_torque_of_engine
from .arguments import tell_arguments

analyze_torque = tell_arguments()(analyze_torque_of_engine)
analyze_torque.__module__ = __name__  # where pickle finds it
