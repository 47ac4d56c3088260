"""Files of a release: what stands in several of them agrees."""

import json
import re
import shutil
import subprocess
import sys
from importlib import metadata

import hertzchain
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


def test_files_that_describe_the_software_agree():
    citation = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    keywords = re.findall(r"^  - (\w+(?: \w+)+)$", citation.partition("keywords:")[2], re.MULTILINE)
    for name in ("codemeta.json", ".zenodo.json"):
        described = json.loads((ROOT / name).read_text(encoding="utf-8"))
        assert described["keywords"] == keywords, name
        assert described["description"].removeprefix("Simulates") in " ".join(citation.split()), name
    assert f"keywords = {json.dumps(keywords)}" in (ROOT / "pyproject.toml").read_text(encoding="utf-8")


def test_the_paper_has_the_length_and_the_sections_that_its_journal_asks_for():
    text = (ROOT / "docs/joss/paper.md").read_text(encoding="utf-8").split("---", 2)[2]
    assert 750 <= len(text.split()) <= 1750
    for title in ("Summary", "Statement of need", "State of the field", "Software design", "Research impact statement"):
        assert f"\n# {title}\n" in text, title
    keys = set(re.findall(r"^@\w+\{(\w+),", (ROOT / "references.bib").read_text(encoding="utf-8"), re.MULTILINE))
    assert set(re.findall(r"@(\w+\d{4})", text)) <= keys


def test_no_sentence_of_a_tutorial_is_longer_than_forty_words():
    for page in (ROOT / "docs/tutorials").glob("*.md"):
        text = page.read_text(encoding="utf-8")
        # Without code, comments, tables, headings and the addresses of links.
        for pattern in (r"^```.*?^```$", r"<!--.*?-->", r"^[|#].*?$", r"\]\([^)]*\)"):
            text = re.sub(pattern, "", text, flags=re.MULTILINE | re.DOTALL)
        for sentence in re.split(r"(?<=[.!?:])\s+|\n\s*\n|\n- ", text):
            assert len(sentence.split()) <= 40, f"{page.name}: {sentence}"


def test_the_package_knows_its_version():
    assert hertzchain.__version__ == metadata.version("hertzchain")
