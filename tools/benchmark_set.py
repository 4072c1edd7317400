"""Write the folders of `benchmark/` from the list of cases in `tests/support/benchmark_set.py`.

Usage: python tools/benchmark_set.py
"""

import csv
import json
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests"))

from support.benchmark_set import CASES, FOLDER, HEADS, Case  # noqa: E402


def write_case(case: Case) -> None:
    """Write data, plain description and answers of a case."""
    folder = FOLDER / case.folder
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in case.read_files().items():
        (folder / name).write_text(text, encoding="utf-8")
    plain = json.dumps(case.describe(), indent=1, ensure_ascii=False)
    (folder / case.plain_name).write_text(plain + "\n", encoding="utf-8")
    with (folder / "answers.csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(HEADS)
        for answer in case.list_answers():
            *words, value, tolerance = answer
            writer.writerow([*words, f"{value:.12g}", f"{tolerance:.3g}"])


if __name__ == "__main__":
    for case in CASES:
        write_case(case)
    print(f"{len(CASES)} cases in {FOLDER.relative_to(ROOT)}")
