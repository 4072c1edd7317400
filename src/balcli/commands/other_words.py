"""What people call a command, and what they look for under a name that no command has."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from difflib import get_close_matches

_CARD = "balcli balance FILE --factor 51% --format card"
_EXAMPLES = "balcli engines"
_MASSES = "balcli scatter FILE"
_RECORDS = "balcli check FILE"
_TORSION = "balcli torsion FILE"
_SHAFTS = "balcli balance FILE --scheme NAME; balcli balance --schemes lists them"
_OTHER_FORMATS = "balcli analyze FILE -o X.csv (.json, .md, .txt), or balcli plot FILE X.pdf"
INSTEAD = {
    **dict.fromkeys(("bobweight", "bobweights", "card", "factor", "crank", "drill"), _CARD),
    **dict.fromkeys(("shaft", "shafts", "counterweight", "counterweights", "scheme"), _SHAFTS),
    **dict.fromkeys(("rotor", "machine", "unbalance", "trial", "iso21940"), "balcli field RUNS"),
    **dict.fromkeys(("damper", "holzer", "torsional", "critical"), _TORSION),
    **dict.fromkeys(("vibration", "modes", "mode"), f"balcli mounts FILE, or {_TORSION}"),
    **dict.fromkeys(("flywheel", "gas", "pressure", "power", "misfire"), "balcli torque FILE"),
    **dict.fromkeys(("examples", "example", "list", "show", "catalog"), _EXAMPLES),
    **dict.fromkeys(("validate", "lint", "test", "diff", "record", "regression"), _RECORDS),
    **dict.fromkeys(("export", "convert", "csv", "json", "pdf", "excel"), _OTHER_FORMATS),
    **dict.fromkeys(("optimise", "optimize", "firing", "firing-order"), "balcli search FILE"),
    **dict.fromkeys(("tolerance", "tolerances", "montecarlo"), _MASSES),
    **dict.fromkeys(("init", "create", "template", "start"), "balcli new KIND FILE"),
    **dict.fromkeys(("orders", "harmonics", "forces", "run", "calc", "why"), "balcli analyze FILE"),
    **dict.fromkeys(("parameters", "quantities", "info"), "balcli numbers FILE"),
    "units": "--units imperial, of most commands",
    "help": "balcli --help, or balcli COMMAND --help",
    "version": "balcli --version",
    "completion": "balcli --install-completion",
}

OPTIONS = {
    **{f"--{name}": f"--format {name}" for name in ("json", "csv", "markdown", "md")},
    **dict.fromkeys(("--imperial", "--inch", "--inches"), "--units imperial"),
    **dict.fromkeys(("--metric", "--si"), "--units si"),
    **dict.fromkeys(("--save", "--outfile", "--to"), "--output FILE"),
    **dict.fromkeys(("--silent", "--no-warnings"), "--quiet"),
    **dict.fromkeys(("--precision", "--decimals"), "--digits N"),
    **dict.fromkeys(("--revs", "--revolutions"), "--speed RPM"),
    **dict.fromkeys(("--overbalance", "--bobweight", "--bobweights"), "--factor 51%"),
    **dict.fromkeys(("--heavy-metal", "--mallory", "--tungsten"), "--slug tungsten, with --drill"),
}


def suggest_option(word: str, options: Collection[str]) -> str:
    """The option of a command (of those it has) that was probably meant by a word that is none, in
    a sentence that begins with a point; empty if there is none.
    """
    instead = OPTIONS.get(word, "")
    return f". That is {instead}." if instead.partition(" ")[0] in options else ""


def suggest_command(word: str, commands: Iterable[str]) -> str:
    """What was probably meant by a word that is no command, in a sentence that begins with a blank;
    empty if nothing comes to mind.
    """
    asked = word.lower()[:100]
    if instead := INSTEAD.get(asked.lstrip("-").replace("_", "-")):
        return f" That is {instead}."
    if near := get_close_matches(asked, commands, 1):
        return f" Did you mean {near[0]}?"
    if asked.endswith(".toml"):
        return f" Did you mean balcli analyze {word}?"
    return ""
