"""The names of the schemes, and the functions behind them."""

import subprocess
import sys

from balcli.sizing.options import SCHEMES
from balcli.sizing.sizing import SIZE


def test_every_scheme_has_its_function():
    assert SIZE.keys() == SCHEMES.keys()
    assert len(set(SIZE.values())) == len(SIZE)


def test_names_and_options_are_known_without_numpy():
    """For help and completion, which are to answer at once."""
    code = (
        "import sys; from balcli.sizing.options import SchemeOptions; "
        "from balcli.sizing.options import NAMES; SchemeOptions(order=2).check('two-shaft'); "
        "print('numpy' in sys.modules, 'pydantic' in sys.modules, NAMES[0])"
    )
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.split() == ["False", "False", "auto"]
