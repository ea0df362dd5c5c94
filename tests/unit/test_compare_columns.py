"""The table of errors is what its documentation says."""

import re
from pathlib import Path

from goniosim.compare.rows import COLUMNS

DOCUMENT = Path(__file__).resolve().parents[2] / "docs" / "compare.md"


def test_every_column_is_documented_with_its_unit_and_meaning():
    section = DOCUMENT.read_text(encoding="utf-8").split("## The columns of errors.csv\n")[1].split("\n## ")[0]
    rows = re.findall(r"^\| `(\w+)` \| (\S+) \| (.+) \|$", section, flags=re.MULTILINE)
    assert {name: ("" if unit == "-" else unit, meaning) for name, unit, meaning in rows} == COLUMNS
