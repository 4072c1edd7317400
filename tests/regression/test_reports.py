"""Annotations of GitHub and JUnit reports: one for each cause, escaped as their readers want it."""

import json
from xml.etree import ElementTree

from support.engines import GOOD, changed
from support.paths import write

from balcli.regression.records import BrokenLimit, ChangedInput, CheckedEngine, Difference, Mistake
from balcli.regression.reports import list_annotations, write_junit

CHANGED = CheckedEngine(
    engine="a,b:c%.toml",
    changed_inputs=(ChangedInput("crank.stroke", 86.0, 88.0, "mm", 7),),
    differences=(
        Difference("force", "order 2 force major", 100.0, 105.0, 0.05, "N", ("orders", "2", "force_N", "major")),
        Difference("roll", "order 2 roll cos", 10.0, 5.0, 0.5, "N·m", ("orders", "2", "roll_Nm", "cos")),
    ),
    broken_limits=(BrokenLimit("force.2.major", 105.0, "N", 104.0, None, 30),),
)


def test_annotations_are_escaped():
    """As GitHub documents it: in texts percent signs and line ends, in properties also commas and colons."""
    assert list(list_annotations([CHANGED])) == [
        "::error file=a%2Cb%3Ac%25.toml,line=7,title=not as recorded::crank.stroke: 86 -> 88 mm%0A2 figures of force, "
        "roll%0Amost: order 2 force major: 100 -> 105 N (+5 %25)",
        "::error file=a%2Cb%3Ac%25.toml,line=30,title=limit exceeded::force.2.major is 105 N; limit: below 104 N",
        "1 engine: 1 changed, 1 beyond a limit; check --update records what is wanted",
    ]


def test_mistakes_and_other_errors_are_annotated():
    """A mistake has its line; what has none is annotated at the file."""
    mistakes = (Mistake("rod.lenght", "unknown key", 7), Mistake("piston.mass", "is missing"))
    wrong = CheckedEngine(engine="x.toml", mistakes=mistakes, error="x.toml: 2 mistakes")
    unread = CheckedEngine(engine="y.toml", error="y.toml: cannot be read")
    title = "title=mistake in the engine file"
    assert list(list_annotations([wrong, unread])) == [
        f"::error file=x.toml,line=7,{title}::rod.lenght: unknown key",
        f"::error file=x.toml,{title}::piston.mass: is missing",
        "::error file=y.toml,title=engine file not read::y.toml: cannot be read",
        "0 engines: 2 not read",
    ]


def test_a_junit_report_has_every_figure_and_limit():
    good = CheckedEngine(engine="good & <well>.toml")
    broken = CheckedEngine(engine="broken.toml", error="broken.toml: first line\nsecond \x1b line \ufffe")
    suite = ElementTree.fromstring(write_junit([CHANGED, good, broken]).encode())
    assert (suite.get("tests"), suite.get("failures"), suite.get("errors")) == ("3", "1", "1")
    assert [case.get("name") for case in suite] == [CHANGED.engine, good.engine, broken.engine]
    (failure,), (), (error,) = suite
    assert failure.get("message") == "crank.stroke: 86 -> 88 mm"
    assert failure.text.splitlines() == [
        "crank.stroke: 86 -> 88 mm",
        "order 2 force major: 100 -> 105 N (+5 %)",
        "order 2 roll cos: 10 -> 5 N·m (-50 %)",
        "force.2.major is 105 N; limit: below 104 N",
    ]
    assert (error.get("message"), error.text) == (
        "broken.toml: first line",
        "broken.toml: first line\nsecond ? line ?",
    )


def test_differences_as_json(check, file, edit_record):
    write(file.parent / "good & well.toml", GOOD)
    check("--update", file.parent)
    edit_record(file, lambda document: document["peak"].update(force_N=1.0))
    status, out, _ = check(file.parent, "-f", "json")
    first, second = json.loads(out)["engines"]
    assert (status, first["engine"], second["differences"]) == (1, str(file), [])
    (difference,) = first["differences"]
    assert difference["now"] > 1000
    del difference["now"], difference["share"]
    assert difference == {"cause": "force", "figure": "peak force", "recorded": 1.0, "unit": "N"}
    assert first["changed_inputs"] == []
    file.write_text(changed(("stroke = 90", "stroke = 92")))
    (stroke,) = json.loads(check(file, "-f", "json")[1])["engines"][0]["changed_inputs"]
    assert stroke == {"key": "crank.stroke", "recorded": 90.0, "now": 92.0, "unit": "mm", "line": 3}
