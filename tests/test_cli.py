"""The command line: exit statuses, messages, formats, files, pipes, terminals, and what is imported."""

import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest
import typer
from support.cases import cases, slow
from support.commands import ask, ask_csv, ask_json, refusal, run_command, run_in_terminal, run_python
from support.engines import GOOD, changed
from support.paths import ENGINES, ROOT, write

from balcli import __version__
from balcli.cli import COMMANDS
from balcli.files import replacing
from balcli.show.formats import Format

I4 = str(ENGINES / "i4.toml")
V8 = str(ENGINES / "v8_crossplane.toml")
POUND_FORCE = 0.45359237 * 9.80665
FOOT = 0.3048  # N, m by definition
unix = pytest.mark.skipif(sys.platform == "win32", reason="needs a shell and signals")
ESCAPE = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]")


@pytest.fixture
def good(tmp_path):
    return write(tmp_path / "good.toml", GOOD)


@pytest.fixture
def bad(tmp_path):
    return write(tmp_path / "bad.toml", changed(("stroke = 90", "strok = 90")))


# ------------------------------------------------------------------ exit statuses and messages
def test_version(balcli):
    assert balcli("--version") == (0, f"balcli {__version__}\n", "")


def test_help_lists_every_command_once_and_in_order(balcli):
    for flag in ("--help", "-h"):
        status, out, err = balcli(flag)
        assert (status, err) == (0, "")
        listed = re.findall(r"(?m)^  ([a-z]+) +\S", out.partition("Analyse:")[2])
        assert listed == list(COMMANDS)


@cases("cli", "wrong_usage_shows_how_a_command_is_used", I4=I4, V8=V8)
def test_wrong_usage_shows_how_a_command_is_used(balcli, args, command, message):
    forms = {"": "COMMAND [ARGS]...", "analyze": "{FILE...}...", "check": "{PATH...}...", "balance": "{FILE}"}
    name = f"balcli {command}".strip()
    usage = f"Usage: {name} [OPTIONS] {forms[command]}\nTry '{name} -h' for help.\n\nError: {message}\n"
    status, out, err = balcli(*args)
    assert (status, out) == (2, "")
    assert re.sub(r"\{?(FILE|PATH)\.\.\.\}?(\.\.\.)?", r"{\1...}...", err) == usage


def test_an_option_given_twice_is_told_so(balcli, good):
    """Its last value counts, as ever; options that take several say nothing."""
    once = ask("analyze", good, "--only", "moment")
    told = "warning: --{} is given 2 times; the last one is used\n"
    twice = ("analyze", good, "--only", "force", "--only", "moment")
    assert balcli(*twice) == (0, once, told.format("only"))
    assert ask(*twice, "-q") == once
    forms = ("analyze", good, "--format", "marine", "-f", "csv")
    assert ask(*forms)
    assert balcli(*forms, "-f", "json").err == told.format("format")
    assert ask("sweep", good, "--vary", "rod.length=150", "--vary", "crank.stroke=90")
    assert ask("analyze", good, "-q", "-q")


@cases("cli", "bad_usage_that_the_parser_words", V8=V8)
def test_bad_usage_that_the_parser_words(balcli, args, told):
    """Its text changes with its version; what is needed to mend it stands in the last line."""
    status, out, err = balcli(*args)
    assert (status, out) == (2, "")
    *_, last = err.splitlines()
    assert last.startswith("Error: ")
    assert told in last
    assert "Traceback" not in err


@cases("cli", "bad_input_is_told_in_one_line", ENGINES=ENGINES, ROOT=ROOT, V8=V8)
def test_bad_input_is_told_in_one_line(args, message):
    assert refusal(*args) == message


@cases("cli", "bad_options_are_told_in_one_line", ROOT=ROOT)
def test_bad_options_are_told_in_one_line(options, message):
    assert refusal("analyze", V8, *options) == message


def test_a_warning_does_not_stop_the_analysis(balcli, tmp_path):
    file = write(tmp_path / "heavy.toml", changed(("mass = 0.5", "mass = 65")))
    status, out, err = balcli("analyze", file, "--format", "json")
    assert status == 0
    assert json.loads(out)["engine"]["cylinders"] == 4
    assert err.startswith(f"warning: {file}: piston.mass: 65 kg in a bore of 86 mm, where ")


# ------------------------------------------------------------------ formats


HEAD = ("format", "version", "engine", "speed_rpm", "reference_mm", "orders")


def test_json_of_analyze_has_the_keys_of_the_contract():
    document = ask_json("analyze", V8, "--orders", "1-4")
    vector = {"forward", "backward", "major", "minor", "axis_deg", "balanced", "x", "y"}
    scalar = {"cos", "sin", "amplitude", "peak_deg", "balanced"}
    assert [*document] == [*HEAD, "assumed", "verdict", "peak", "sizing", "ladder"]
    assert set(document["engine"]) == {"name", "cylinders", "displacement_m3"}
    assert [entry["order"] for entry in document["orders"]] == [1, 2, 3, 4]
    figures = dict.fromkeys(("force_N", "moment_Nm"), vector)
    figures |= dict.fromkeys(("couple_Nm", "inertia_torque_Nm", "roll_Nm"), scalar)
    for entry in document["orders"]:
        assert {key: set(entry[key]) for key in entry if key != "order"} == figures
        assert set(entry["force_N"]["x"]) == set(entry["force_N"]["y"]) == {"amplitude", "phase_deg"}
    assert set(document["peak"]) == {"force_N", "force_deg", "moment_Nm", "moment_deg"}
    assert set(document["sizing"]) == {"scheme", "steps", "counterweights", "shafts", "sliders", "after"}
    assert set(document["sizing"]["counterweights"][0]) == {"unbalance_kg_m", "angle_deg", "position_mm"}


@cases("cli", "what_is_left_out_is_no_key")
def test_what_is_left_out_is_no_key(only, keys, whole):
    document = ask_json("analyze", V8, "--only", only)
    assert [*document["orders"][0]] == ["order", *keys]
    assert [*document] == [*HEAD, *whole]


def test_imperial_figures_are_the_metric_ones_in_other_units(balcli, good):
    def values(*more):
        rows = ask_csv("analyze", good, *more)
        return {
            (r["quantity"], r["order"], r["figure"]): (float(r["value"]), r["unit"])
            for r in rows
            if r["unit"] not in ("deg", "")
        }

    metric = values()
    imperial = values("--units", "imperial")
    assert metric.keys() == imperial.keys()
    for key, (value, unit) in metric.items():
        size, name = {"N": (POUND_FORCE, "lbf"), "N·m": (POUND_FORCE * FOOT, "lbf·ft")}[unit]
        assert imperial[key] == (pytest.approx(value / size, rel=1e-14), name)
    for form in ("table", "markdown"):
        text = balcli("analyze", V8, "--format", form, "--units", "imperial")[1]
        assert all(unit in text for unit in ("lbf", "lbf·ft", "lb"))
        computed = re.sub(r"^.*assumed.*\n", "", text, flags=re.MULTILINE)  # these are in units of the file
        assert not re.search(r"\bN\b|N·m|g·mm|\bkg\b|\bmm\b", computed)
    assert balcli("analyze", good, "--format", "json", "--units", "imperial") == balcli(
        "analyze", good, "--format", "json"
    )


# ------------------------------------------------------------------ files in, files out
def test_standard_input(balcli, good):
    assert balcli("analyze", "-", "--format", "json", stdin=GOOD) == balcli("analyze", good, "--format", "json")
    assert refusal("analyze", "-", stdin="[crank]\nstroke = 90\n").startswith("standard input: ")


@unix
@pytest.mark.parametrize("key", ["name", "source"])
def test_no_text_of_a_file_and_no_name_of_one_turns_or_colours_what_is_shown(balcli, key, tmp_path):
    for code in (0x1B, 0x9B, 0x061C, 0x200E, 0x200F, 0x2028, 0x2029, *range(0x202A, 0x202F), *range(0x2066, 0x206A)):
        engine = f'{key} = "four\\u{code:04x}enil-ni"\n' + changed(('name = "in-line four"\n', ""))
        assert refusal("analyze", "-", stdin=engine) == (
            f"standard input: {key}: has the control character U+{code:04X}; leave it out"
        )
    assert balcli("analyze", tmp_path / "a\u202elmot.\u2028").err.endswith("a?lmot.?: no such file\n")


LOCKED = changed(("length = 160", "length = 40"), ("cg = 45", "cg = 15"))


@cases("cli", "what_cannot_be_an_engine_goes_by_its_file")
def test_what_cannot_be_an_engine_goes_by_its_file(tmp_path, command):
    file = write(tmp_path / "locked.toml", LOCKED)
    for name, called in ((file, file), ("-", "standard input")):
        told = refusal(command[0], name, *command[1:], stdin=LOCKED)
        variant = "rod.cg = 0: " if command[0] == "sweep" else ""
        assert told.startswith(f"{called}: {variant}rod.length: the crank cannot turn")


def test_several_files_and_a_bad_one_among_them(balcli, good, bad):
    """One JSON document a line, in order; the bad one is named, the rest is reported, and the status is 2."""
    status, out, err = balcli("analyze", good, bad, V8, "--format", "json")
    assert status == 2
    assert [json.loads(line)["engine"]["cylinders"] for line in out.splitlines()] == [4, 8]
    assert err == f"balcli: {bad}: crank.strok: unknown key in [crank]; did you mean stroke?\n"
    out = ask("analyze", good, V8, "--format", "table")
    assert out.index("in-line four") < out.index("90-degree cross-plane V8")


def test_rows_of_several_engines_can_be_told_apart(good, tmp_path):
    """By name, or by file where a name is missing or stands for several."""
    again = write(tmp_path / "again.toml", GOOD)
    nameless = write(tmp_path / "nameless.toml", changed(('name = "in-line four"', "")))

    def engines(*files, stdin=""):
        return list(dict.fromkeys(row["engine"] for row in ask_csv("analyze", *files, "--only", "peak", stdin=stdin)))

    assert engines(good) == ["in-line four"]
    assert engines(good, again, V8, nameless) == [str(good), str(again), "90-degree cross-plane V8", str(nameless)]
    assert engines("-", stdin=nameless.read_text()) == ["standard input"]


@pytest.mark.parametrize("files", [["bad"], ["good", "bad"]])
def test_a_file_is_written_whole_or_not_at_all(balcli, good, bad, tmp_path, files):
    target = write(tmp_path / "out.json", "what was there before")
    assert balcli("analyze", *({"good": good, "bad": bad}[f] for f in files), "-o", target)[0] == 2
    assert target.read_text() == "what was there before"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["bad.toml", "good.toml", "out.json"]


def test_nobody_else_reads_the_new_content_of_a_private_file_before_it_is_in_place(tmp_path):
    """The temporary file is private from the start, whatever the umask, not only when it is whole."""
    target = write(tmp_path / "out.txt", "old")
    target.chmod(0o600)
    before = os.umask(0)
    try:
        with replacing(target) as place:
            assert place.stat().st_mode & 0o777 == 0o600
    finally:
        os.umask(before)


def test_a_replaced_file_keeps_its_permissions(balcli, good, tmp_path):
    target = write(tmp_path / "out.txt", "old")
    target.chmod(0o640)
    assert balcli("analyze", good, "-o", target)[0] == 0
    assert target.stat().st_mode & 0o777 == 0o640


def test_new_never_overwrites_without_force(balcli, tmp_path):
    target = tmp_path / "x.toml"
    assert balcli("new", "single", target) == (0, "", "")
    written = target.read_text()
    assert refusal("new", "vee", target) == f"{target}: already exists; choose another name, or --force"
    assert target.read_text() == written
    assert balcli("new", "vee", target, "--force") == (0, "", "")
    assert target.read_text() == balcli("new", "vee")[1] != written
    assert balcli("analyze", target)[0] == 0


# ------------------------------------------------------------------ pipes and terminals
def test_a_pipe_gets_no_escape_codes_and_no_width(balcli, monkeypatch):
    monkeypatch.setenv("COLUMNS", "40")
    for form in Format:
        out = balcli("analyze", V8, "--format", form, "--by", "cylinder")[1]
        assert "\x1b" not in out
    table = balcli("analyze", V8)[1]
    assert max(map(len, table.splitlines())) == 80
    assert not any(line != line.rstrip() for line in table.splitlines())


@pytest.mark.slow
@pytest.mark.parametrize("columns", [80, 140])
@pytest.mark.parametrize("name", ["vr6", "w12", "car/tsinghua_12v135q"])
def test_a_terminal_gets_lines_of_its_width(balcli, monkeypatch, name, columns):
    """No line is wider, and no figure that stands in it without a width is broken."""
    from rich.cells import cell_len

    args = "analyze", ENGINES / f"{name}.toml", "--by", "cylinder"
    figures = set(re.findall(r"\S*\d\S*", balcli(*args).out))
    monkeypatch.setenv("COLUMNS", str(columns))
    monkeypatch.setenv("TERM", "xterm-256color")
    out = balcli(*args, terminal=True).out
    assert "\x1b[1m" in out
    plain = ESCAPE.sub("", out)
    assert max(map(cell_len, plain.splitlines())) <= columns
    assert figures - set(plain.split()) == set()


@pytest.mark.skipif(sys.platform == "win32", reason="needs a pseudo-terminal")
def test_a_real_terminal_gets_colours_and_lines_of_its_width(monkeypatch):
    monkeypatch.delenv("COLUMNS", raising=False)
    monkeypatch.delenv("NO_COLOR", raising=False)
    status, text, _ = run_in_terminal("analyze", V8, columns=80, env={"TERM": "xterm-256color"})
    assert status == 0
    assert "\x1b[1m" in text
    assert max(len(line) for line in ESCAPE.sub("", text).splitlines()) <= 80


@pytest.fixture
def unread():
    """The end of a pipe from which nobody reads."""
    reading, writing = os.pipe()
    os.close(reading)
    yield writing
    os.close(writing)


@cases("cli", "a_closed_pipe_ends_quietly", ENGINES=ENGINES, V8=V8)
def test_a_closed_pipe_ends_quietly(args, unread):
    done = run_command(*args, stdout=unread, stderr=subprocess.PIPE)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.slow
@cases("cli", "others_end_as_quietly")
def test_others_end_as_quietly(args, unread):
    test_a_closed_pipe_ends_quietly(args, unread)


def test_mistakes_that_nobody_reads_have_their_status(unread):
    assert run_command("analyze", "nowhere.toml", stdout=unread, stderr=unread).returncode == 2


@pytest.mark.parametrize("encoding", ["ascii", *slow("cp1252", "cp437")])
def test_any_locale_and_code_page_gets_utf_8(encoding):
    """No symbol of ours (− · ° ω²) is missing there, or ends the program."""
    plain = {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0", "PYTHONIOENCODING": encoding}
    done = run_command("analyze", V8, "--all", env=plain)
    assert (done.returncode, done.stderr, done.stdout) == (0, "", ask("analyze", V8, "--all"))
    assert "F1 = m r ω² = " in done.stdout


# ------------------------------------------------------------------ what is imported
HEAVY = {"numpy", "pydantic", "rich", "matplotlib", "tomli_w", "tomlkit", "jinja2", "scipy"}
PROBE = """
import json
import os
import sys
from balcli.cli import main
told = sys.stderr
sys.stdout = open(os.devnull, "w")
for command in json.loads(sys.argv[1]):
    sys.argv = ["balcli", *command]
    try:
        main()
    except SystemExit as end:
        print(json.dumps([end.code or 0, list(sys.modules)]), file=told)
"""


def list_modules(commands: list[list[str]]) -> list[set[str]]:
    """The modules that are there after each of these commands, which one process runs one after the other."""
    lines = run_python("-c", PROBE, json.dumps(commands)).stderr.splitlines()
    ends = [json.loads(line) for line in lines]
    assert [status for status, _ in ends] == [0] * len(commands)
    return [{*modules} for _, modules in ends]


def name_packages(modules: set[str]) -> set[str]:
    """The packages of these modules."""
    return {name.partition(".")[0] for name in modules}


NEEDED = [  # what a command may load beside what those before it may
    (["--help"], set()),
    (["new", "single"], {"pydantic"}),  # typer itself checks arguments with it
    (["analyze", V8, "--format", "json"], {"numpy", "pydantic"}),
    (["analyze", V8], {"numpy", "pydantic"}),
    (["check", I4], {"numpy", "pydantic"}),
]


OF_GAS = {  # an engine without gas, uneven speed and bearings loads none of these
    "balcli.core.piecewise",
    "balcli.core.shaft_speed",
    "balcli.engine.gas",
    "balcli.file.csv_columns",
    "balcli.file.gas_tables",
    "balcli.forces.curves",
    "balcli.forces.loads_with_gas",
    "balcli.forces.rod_forces",
    "numpy.polynomial",
}
UNASKED = {"balcli.file.engine_tables", "balcli.forces.quantity", "balcli.show.notebook", "html"}


def test_only_what_is_needed_is_imported():
    after = list_modules([command for command, _ in NEEDED])
    for (command, allowed), modules in zip(NEEDED, after, strict=True):
        assert name_packages(modules) & HEAVY <= allowed, command
        assert "balcli" in modules
        if "analyze" in command:
            assert modules.isdisjoint(OF_GAS | UNASKED), command


def test_the_help_of_a_command_needs_no_library():
    for command, modules in zip(COMMANDS, list_modules([[name, "--help"] for name in COMMANDS]), strict=True):
        assert not name_packages(modules) & (HEAVY - {"pydantic"}), command
        assert "balcli" in modules


# ------------------------------------------------------------------ the end of the process
def test_an_interruption_has_its_own_status(balcli, monkeypatch, good):
    def interrupted(**_):
        raise typer.Abort

    monkeypatch.setattr("balcli.cli.app", interrupted)
    assert balcli("analyze", good) == (130, "", "")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
@pytest.mark.parametrize("args", [["--version"], ["--help"], ["analyze", "--help"]], ids=" ".join)
def test_help_that_cannot_be_written_is_no_success(args):
    with Path("/dev/full").open("wb") as full:
        done = run_command(*args, stdout=full, stderr=subprocess.PIPE)
    assert (done.returncode, done.stderr) == (2, "balcli: standard output: No space left on device\n")


@unix
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=str)
def test_signals_end_it_without_a_word_even_while_modules_are_imported(number):
    """The signal comes while numpy is being imported, from within that import."""
    code = f"""
import os, signal, sys
signal.signal({int(number)}, signal.default_int_handler)
class Import:
    def find_spec(self, name, path=None, target=None):
        if name == "numpy":
            os.kill(os.getpid(), {int(number)})
            print("still here")
sys.meta_path.insert(0, Import())
from balcli.__main__ import main
main()
"""
    done = run_python("-c", code, "analyze", I4)
    assert (done.returncode, done.stdout, done.stderr) == (128 + number, "", "")


@unix
def test_settings_of_matplotlib_in_the_working_folder_are_ignored(tmp_path):
    (tmp_path / "matplotlibrc").write_bytes(b"\xff\xfe")
    asked = ("plot", I4, "--what", "polar", "-o", "x.svg")
    done = run_command(*asked, cwd=tmp_path, env={"MPLBACKEND": "qt4agg"}, timeout=60)
    assert (done.returncode, done.stderr) == (0, "")
    assert (tmp_path / "x.svg").exists()


@unix
def test_a_pipe_in_a_folder_is_passed_over(tmp_path):
    os.mkfifo(tmp_path / "pipe.toml")
    done = run_command("check", tmp_path, timeout=60)
    assert (done.returncode, done.stderr) == (2, f"balcli: {tmp_path}: has no engine files (*.toml)\n")


FAULT = (
    "balcli: internal error (ZeroDivisionError: by nought); this is a fault of balcli, do not trust "
    "its figures: please report it with the command and its files (BALCLI_TRACEBACK=1 prints "
    "a traceback)\n"
)


@unix
def test_too_little_memory_is_no_fault_of_ours():
    """With 2 GB of addresses, for samples that need 8."""
    code = (
        "import resource; resource.setrlimit(resource.RLIMIT_AS, (2 << 30, 2 << 30));"
        "import balcli.cli; balcli.cli.app = lambda **_: __import__('numpy').empty(1 << 30);"
        "from balcli.__main__ import main; main()"
    )
    done = run_python("-c", code)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("balcli: there is not enough memory for this (Unable to allocate")


@pytest.mark.parametrize(
    ("options", "env", "whole"),
    [([], {}, True), (["-X", "dev"], {}, False), ([], {"BALCLI_TRACEBACK": "1"}, False)],
    ids=["plain", "dev", "traced"],
)
def test_an_internal_error_is_told_as_one(options, env, whole):
    code = (
        "import balcli.cli; from balcli.__main__ import main\n"
        "def fails(**_): raise ZeroDivisionError('by nought')\n"
        "balcli.cli.app = fails; main()"
    )
    done = run_python(*options, "-c", code, env=env)
    assert done.returncode == 70
    assert done.stderr.endswith(FAULT)
    assert (done.stderr == FAULT) is whole
    assert ("Traceback" in done.stderr) is not whole


@pytest.mark.parametrize(
    ("refusal", "coloured"), [({}, True), ({"NO_COLOR": "1"}, False), ({"TERM": "dumb"}, False), (None, False)]
)
def test_colours_are_for_terminals_and_change_no_word(balcli, monkeypatch, refusal, coloured):
    """Red: an order that is not small; green: balanced; bold: the steps that are fitted. None: no terminal."""
    monkeypatch.delenv("NO_COLOR", raising=False)
    monkeypatch.setenv("TERM", "xterm")
    for name, value in (refusal or {}).items():
        monkeypatch.setenv(name, value)
    args = "analyze", ENGINES / "i3.toml"
    out = balcli(*args, terminal=refusal is not None).out
    found = re.findall(r"\x1b\[(\d+)m *(.*?) *\x1b", out)
    assert ("\x1b" in out) == coloured
    if coloured:
        assert [text for code, text in found if code == "31"] == ["2734", "282.9"]
        assert {text for code, text in found if code == "32"} == {"balanced"}
        steps = [text for code, text in found if code == "1" and text[0].isdigit()]
        assert steps == ["2 counterweights at every throw", "3 shaft at -1"]
    assert ESCAPE.sub("", out).split() == balcli(*args).out.split()
    err = balcli("analyze", "none.toml", terminal=refusal is not None).err
    assert ESCAPE.sub("", err) == "balcli: none.toml: no such file\n"
    assert err.startswith("\x1b[31mbalcli:\x1b[0m ") == coloured
