"""Compute forces and moments from engine.json alone, and compare them with answers.csv."""

import csv
import json
from pathlib import Path

import numpy as np

angle = np.arange(720) * np.pi / 360
for path in sorted(Path(__file__).parent.glob("*/engine.json")):
    engine = json.loads(path.read_text(encoding="utf-8"))
    if engine["chapter"] != "forces" or engine["grade"] != "A":
        continue
    force = moment = 0  # of order 1 at w = 1: mass times place x + iy, at every crank angle
    for c in engine["cylinders"]:
        axis = np.exp(1j * np.radians(c["axis_deg"]))
        pin = c["crank_radius_m"] * np.exp(1j * (angle + np.radians(c["pin_deg"]))) / axis
        rod = np.sqrt(c["rod_length_m"] ** 2 - (pin.imag - c["offset_m"]) ** 2)
        part = axis * (c["rotating_kg"] * pin + c["reciprocating_kg"] * (pin.real + rod))
        force = force + part
        moment = moment + 1j * (c["z_m"] - engine["reference_m"][2]) * part
    for d in engine["devices"]:
        wave = np.exp(1j * d["order"] * angle)
        part = complex(*d["forward_kg_m"]) * wave + complex(*d["backward_kg_m"]) / wave
        force = force + part
        moment = moment + 1j * (d["z_m"] - engine["reference_m"][2]) * part
    curves = {"force_x": force.real, "force_y": force.imag}
    curves |= {"moment_x": moment.real, "moment_y": moment.imag}
    waves = {"cos": np.cos, "sin": np.sin}
    right = 0
    answers = path.with_name("answers.csv").read_text(encoding="utf-8")
    for row in csv.DictReader(answers.splitlines()):
        if row["quantity"] in curves and row["part"] in waves:
            order = int(row["of"])
            mean = np.mean(curves[row["quantity"]] * waves[row["part"]](order * angle))
            computed = 2 * mean * (order * engine["speed_rad_per_s"]) ** 2
            assert abs(computed - float(row["value"])) <= float(row["tolerance"]), row
            right += 1
    print(path.parent.name, right, "right")
