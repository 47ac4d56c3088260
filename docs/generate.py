"""Pages of the site that come from declarations: keys, contact laws, the command line; and citations.

The program `hertzchain` must be on the path: it prints what it has declared.
"""

import json
import re
import subprocess
import tempfile
import tomllib
from collections.abc import Iterator
from pathlib import Path
from shutil import copyfile
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
BIBLIOGRAPHY = (ROOT / "references.bib").read_text(encoding="utf-8")
# Links that leave docs/.
OUTSIDE = re.compile(r"\[([^\]]+)\]\((?:\.\./)+((?:crates|experiments|bench)[^)#]*|[A-Z]+\.md)[^)]*\)")
PAGE = re.compile(r"\bdocs/((?:tutorials|how-to|reference|explanation)/[\w-]+)\.md(?:#[\w-]+)?")
# What docs/build puts beside the pages.
EXTRA = ROOT / "target/docs/extra"
FILM = '<iframe class="film" src="../_static/first-chain.html" title="Film of the shot" loading="lazy"></iframe>'
EXPLORER = """<iframe class="explorer" src="../explorer.html" title="The explorer" loading="lazy"></iframe>
<p><a href="../explorer.html">The explorer in a page of its own</a></p>"""
KEYS = set(re.findall(r"^@\w+\{(\w+),", BIBLIOGRAPHY, re.MULTILINE))


def version() -> str:
    """The workspace's version."""
    return tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))["workspace"]["package"]["version"]


def program(*arguments: str) -> str:
    """What the program prints, wrapped as on a wide terminal."""
    return subprocess.run(["hertzchain", *arguments], check=True, capture_output=True, text=True).stdout


def write(folder: Path) -> None:
    """Writes the generated pages of the reference; an unchanged one keeps its time."""
    pages = {"keys": keys(), "laws": laws(), "command-line": command_line()}
    notebooks = folder / "notebooks"
    notebooks.mkdir(exist_ok=True)
    for notebook in (ROOT / "crates/py/examples").glob("*.ipynb"):
        copyfile(notebook, notebooks / notebook.name)
    film(folder)
    for name, text in pages.items():
        page = folder / "reference" / f"{name}.md"
        if not page.exists() or page.read_text(encoding="utf-8") != text:
            page.write_text(text, encoding="utf-8")


def film(folder: Path) -> None:
    """The first tutorial's shot as a film, which its page shows in a frame on the site."""
    page = (folder / "tutorials/my-first-chain.md").read_text(encoding="utf-8")
    with tempfile.TemporaryDirectory() as name:
        row = Path(name) / "my-row.toml"
        row.write_text(re.search(r"```toml\n(# my-row\.toml\n.*?)```", page, re.DOTALL)[1], encoding="utf-8")
        program("shot", str(row), "--out", f"{name}/shot", "--animate")
        copyfile(f"{name}/shot/animation.html", folder / "static/first-chain.html")


def complete(_app: Any, page: str, source: list[str]) -> None:
    """Turns a key in brackets into a citation, and links that leave docs/ into names of files."""
    parts = re.split(r"(^```.*?^```$)", source[0], flags=re.MULTILINE | re.DOTALL)
    source[0] = "".join(text if text.startswith("```") else completed(text) for text in parts)


def completed(text: str) -> str:
    text = text.replace("<!-- film -->", raw(FILM))
    if (EXTRA / "explorer.html").exists():
        text = re.sub(r"<!-- explorer -->.*?<!-- end -->", raw(EXPLORER), text, flags=re.DOTALL)
    if (EXTRA / "rust").exists():
        text = re.sub(r"^\| `(hertzchain[\w-]*)` \|", crate, text, flags=re.MULTILINE)
    text = re.sub(r"(?<![\]`\w])\[(\w+\d{4})\](?!\()", lambda found: cited(found, "{cite:p}"), text)
    return OUTSIDE.sub(r"\1 (`\2`)", text)


def crate(found: re.Match[str]) -> str:
    """A crate's name in a table, as a link to its first page."""
    return f'| <a href="../rust/{found[1].replace("-", "_")}/index.html"><code>{found[1]}</code></a> |'


def raw(html: str) -> str:
    return f"```{{raw}} html\n{html}\n```"


def cited(found: re.Match[str], role: str) -> str:
    return f"{role}`{found[1]}`" if found[1] in KEYS else found[0]


def complete_docstring(_app: Any, _what: str, _name: str, _thing: Any, _options: Any, lines: list[str]) -> None:
    """The same for docstrings, which are reStructuredText: there a name that ends in `_` would be a link.

    Files of docs/ become links to their pages.
    """
    named = (re.sub(r"\b(?:options\.)?Path_(?!\w)", "path", line) for line in lines)
    named = (PAGE.sub(r":doc:`\1 </\1>`", line) for line in named)
    lines[:] = [re.sub(r"\[(\w+\d{4})\]", lambda found: cited(found, ":cite:p:"), line) for line in named]


def laws() -> str:
    """Contact laws from the registry."""
    parts = ["# Contact laws", "", "From the program's registry, as `hertzchain laws` prints them.", ""]
    for law in json.loads(program("laws", "--json")):
        parts += [f"## {law['name']}", "", f"> {cell(law['equation'])}", ""]
        acts = "while the contact is closed" if law["gated"] else "always, also across gaps"
        parts += [f"A law that is {law['nature']} and acts {acts}. Valid for {cell(law['validity'])} [{law['reference']}].", ""]
        parts += ["| parameter | unit | meaning | default |", "|---|---|---|---|"]
        parts += [f"| `{row['name']}` | {row['unit']} | {row['meaning']} | {default(row)} |" for row in law["parameters"]]
        parts.append("")
    return "\n".join(parts)


def default(row: dict[str, Any]) -> str:
    if row["required"]:
        return "required"
    if row["from_materials"]:
        return "from the materials"
    return "the section's `elastic_hertz`" if row["from_elastic_hertz"] else f"{row['default']}"


def command_line() -> str:
    """Help of every verb."""
    overview = program("--help").rstrip()
    parts = ["# Command line", "", "```text", overview, "```", ""]
    for verb in re.findall(r"^  (?!help )([a-z-]+)  ", overview, re.MULTILINE):
        parts += [f"## hertzchain {verb}", "", "```text", program(verb, "--help").rstrip(), "```", ""]
    return "\n".join(parts)


def keys() -> str:
    """Every key of the experiment file, from the schema."""
    schema = json.loads(program("schema"))["else"]
    parts = ["# Keys of the experiment file", "", "From the program's declarations, as `hertzchain schema` prints them.", ""]
    for title, table in tables("", schema):
        parts += [f"## {title}", "", "| key | value | meaning |", "|---|---|---|"]
        required = set(table.get("required", []))
        for name, value in table["properties"].items():
            always = ", required" if name in required else ""
            parts.append(f"| `{name}` | {kind(value)}{always} | {cell(value.get('description', ''))} |")
        parts.append("")
    return "\n".join(parts)


def tables(path: str, schema: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Tables of a file with their headings, outer ones first."""
    yield (f"`[{path}]`" if path else "At the top"), schema
    for name, value in schema["properties"].items():
        inner = f"{path}.{name}" if path else name
        yield from of_value(inner, value)


def of_value(path: str, value: dict[str, Any]) -> Iterator[tuple[str, dict[str, Any]]]:
    """Tables within a value: of itself, of its items, of its variants."""
    if path.endswith("laws"):
        return
    if "properties" in value:
        yield from tables(path, value)
    elif isinstance(value.get("additionalProperties"), dict):
        yield from tables(f"{path}.NAME", value["additionalProperties"])
    elif "properties" in value.get("items", {}):
        for title, table in tables(path, value["items"]):
            yield (title if title != f"`[{path}]`" else f"`[[{path}]]`"), table
    for variant in value.get("oneOf", []):
        tags = [f'{key} = "{known["const"]}"' for key, known in variant.get("properties", {}).items() if "const" in known]
        if tags:
            yield f"`[{path}]` with `{tags[0]}`", variant


def kind(value: dict[str, Any]) -> str:
    """What a value is, in a word or two."""
    if "const" in value:
        return f'`"{value["const"]}"`'
    if "enum" in value:
        return " or ".join(f'`"{option}"`' for option in value["enum"])
    if "anyOf" in value:
        return "quantity or power law"
    if "oneOf" in value or "properties" in value:
        return "table"
    if "additionalProperties" in value and isinstance(value["additionalProperties"], dict):
        return "tables by name"
    match value.get("type"):
        case "array":
            return "list"
        case "integer":
            return "whole number"
        case "boolean":
            return "true or false"
        case "string":
            return "quantity" if "pattern" in value else "text"
        case _:
            return "number"


def cell(text: str) -> str:
    return text.replace("|", "\\|").replace("*", "\\*")
