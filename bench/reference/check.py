"""Compares numbers.json with those of an earlier independent integration and with published values, as it names them; exit code 1 if one is out of tolerance."""

import json
import sys
from pathlib import Path

bad = 0
for case in json.loads((Path(__file__).parent / "numbers.json").read_text()):
    for row in case["results"]:
        if "compare" not in row:
            continue
        known = row["compare"]
        off = abs(row["value"] - known["value"]) / (abs(known["value"]) or 1.0)
        fine = off <= known["relative_tolerance"]
        bad += not fine
        print("ok " if fine else "BAD", f"{case['case']:40} {row['quantity']:45} {off:.1e} of {known['relative_tolerance']:.0e}")
sys.exit(bad > 0)
