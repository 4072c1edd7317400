"""What the kernel of the live page computes, in a browser, and what differs from the analysis in Python."""

import json

import numpy as np

from balcli.analysis.answer import analyze
from balcli.limits import SMALL
from balcli.report.live import describe_limits

VECTORS = ("force_N", "moment_Nm")
SCALARS = ("couple_Nm", "inertia_torque_Nm", "roll_Nm")
WANTED = ("force", "moment", "couple", "torque", "roll", "peak", "ladder")


def compute(browser, engines, small=SMALL):
    """What the kernel makes of engines: pairs of the page's data and numbers."""
    limits = describe_limits(small)
    browser.run(f"window.asked = {json.dumps(engines)}, window.limits = {json.dumps(limits)}, 0")
    make = "const e = Kernel.assemble(d, n); return Kernel.describe(e, Kernel.findLadder(e, limits), limits, [...Array(13).keys()]);"
    return json.loads(browser.run(f"JSON.stringify(asked.map(([d, n]) => {{ {make} }}))"))


def find_findings(engine, small=SMALL):
    """What the verdict of the command has on each order, and on the couple."""
    verdict = analyze(engine, small=small).to_dict()["verdict"]
    return {"matter": verdict["matter"]} | {key: verdict[key] for key in ("couple",) if key in verdict}


def differences(wanted, found):
    """Figures of orders, peaks and ladder that differ by more than 1e-9 of the largest."""
    mine = {entry["order"]: entry for entry in found["orders"]}
    for key in VECTORS + SCALARS:
        parts = ("forward", "backward") if key in VECTORS else ("cos", "sin")
        pairs = [
            (e["order"], part, np.array(e[key][part]), np.array(mine[e["order"]][key][part]))
            for e in wanted["orders"]
            if key in e
            for part in parts
        ]
        for e in wanted["orders"]:
            for word in ("vertical", "horizontal", "yawing", "pitching"):
                size, other = (each.get(key, {}).get(word, {}).get("amplitude") for each in (e, mine[e["order"]]))
                if (size is None) != (other is None) or size is not None:
                    pairs.append((e["order"], word, np.array(size, float), np.array(other, float)))
        largest = max((np.abs(one).max() for *_, one, _ in pairs), default=0)
        yield from (
            (key, order, part, one, other)
            for order, part, one, other in pairs
            if abs(one - other).max() > 1e-9 * largest
        )
    yield from differences_of_ladder(wanted, found)


def differences_of_ladder(wanted, found):
    """Peaks, and figures of the ladder, that differ."""
    scale = wanted["ladder"]["scale"]
    for key in VECTORS:
        if key in wanted["peak"] and abs(wanted["peak"][key] - found["peak"][key]) > 1e-9 * scale[key]:
            yield key, wanted["peak"], found["peak"]
    for key in ("auto", "steps", "left_out"):
        of_command = wanted["ladder"][key]
        of_page = found["ladder"][key]
        if list_names(of_command) != list_names(of_page):
            yield key, of_command, of_page
        elif key != "auto":
            for own, step in zip(of_command, of_page, strict=True):
                yield from ((name, own, step) for name in differing(own, step, scale))


def differing(own, step, scale):
    """Names of figures of a step that differ."""
    for name in {*step, *own} - UNTOLD:
        largest = scale.get("moment_Nm" if name.endswith("Nm") else "force_N", 1)
        limit = 1e-9 * (own.get(name, 0) if name.endswith("kg") else largest)
        if name not in own or name not in step or abs(own[name] - step[name]) > limit:
            yield name


UNTOLD = {"step", "inner_moment_Nm", "pru_Nm_per_kW", "devices", "changes"}  # these are not figures of both


def list_names(steps):
    return [step if isinstance(step, str) else step["step"] for step in steps]


def answer(engine, orders=range(13)):
    return analyze(engine, orders, WANTED).to_dict()
