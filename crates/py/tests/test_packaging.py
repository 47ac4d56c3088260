"""Files of a release: the version stands in all of them."""

import re
import shutil
import subprocess
import sys

from conftest import ROOT

SCRIPT = ROOT / "packaging/set-version"


def test_set_version_leaves_no_other_version(tmp_path):
    names = set(re.findall(r'^        \("([\w./-]+)"', SCRIPT.read_text(encoding="utf-8"), re.MULTILINE))
    assert {"Cargo.toml", "CITATION.cff", "codemeta.json", "CHANGELOG.md"} <= names
    for name in [*names, "packaging/set-version"]:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    # Twice: a file of a first release has no date yet.
    for version, date in (("98.1.2", "2097-01-31"), ("98.7.6", "2098-02-28")):
        subprocess.run([sys.executable, tmp_path / "packaging/set-version", version, date], check=True)
    for name in names:
        text = (tmp_path / name).read_text(encoding="utf-8")
        assert "98.7.6" in text, name
        if name != "CHANGELOG.md":
            assert "98.1.2" not in text, name
    assert "\ndate-released: 2098-02-28\n" in (tmp_path / "CITATION.cff").read_text(encoding="utf-8")
