"""The environment of the tests and of the commands that they start; imported before anything large is."""

import os
import sys
import tempfile
from pathlib import Path


def _keep_byte_code() -> None:
    """Where nothing may be written beside the source (PYTHONDONTWRITEBYTECODE), byte code is kept in a temporary
    folder of this user, from one run of the tests to the next: compiling takes longer than most tests run.
    """
    if not sys.dont_write_bytecode:
        return
    folder = str(_make_folder())
    sys.pycache_prefix = folder
    sys.dont_write_bytecode = False
    os.environ["PYTHONPYCACHEPREFIX"] = folder
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)


def _make_folder() -> Path:
    """A folder to which only this user can write."""
    user = os.getuid() if hasattr(os, "getuid") else "user"  # on Windows all temporary files are a user's own
    folder = Path(tempfile.gettempdir(), f"balcli-byte-code-{user}")
    folder.mkdir(mode=0o700, exist_ok=True)
    if hasattr(os, "getuid") and (folder.is_symlink() or folder.stat().st_uid != user):
        return Path(tempfile.mkdtemp(prefix="balcli-byte-code-"))
    return folder


_keep_byte_code()
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # the workers share the processors already
for variable in [name for name in os.environ if name.startswith("BALCLI_")]:
    del os.environ[variable]  # what whoever runs the tests finds usual
