"""`balcli.balance`"""

from __future__ import annotations

from ..results.balance import balance as balance_engine
from ..sizing.options import SchemeOptions
from ..sizing.workshop import Tools
from .arguments import tell_arguments

# Options of the command line are fields of the two arguments here.
balance = tell_arguments(**{name: name for name in (*SchemeOptions._fields, *Tools._fields)})(
    balance_engine
)
balance.__module__ = __name__  # where pickle finds it
