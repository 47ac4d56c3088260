"""What is public is documented: every name walked, every section looked for."""

import doctest
import importlib
import inspect
import re
from collections.abc import Iterator
from typing import Any

import pytest
from conftest import ROOT

import hertzchain as hc
from hertzchain import distributed, plot

SECTION = re.compile(r"^([A-Z][A-Za-z]+)\n-+$", re.MULTILINE)
KEYS = set(re.findall(r"^@\w+\{(\w+),", (ROOT / "references.bib").read_text(encoding="utf-8"), re.MULTILINE))


def public() -> dict[str, Any]:
    """Functions and classes by the names under which users have them."""
    modules = {"hertzchain": hc, "hertzchain.plot": plot, "hertzchain.distributed": distributed}
    named = {f"{module}.{name}": getattr(owner, name) for module, owner in modules.items() for name in owner.__all__}
    return {name: thing for name, thing in named.items() if callable(thing)}


NAMES = public()
FUNCTIONS = {name: thing for name, thing in NAMES.items() if not inspect.isclass(thing)}
CLASSES = {name: thing for name, thing in NAMES.items() if inspect.isclass(thing)}


def sections(thing: Any) -> dict[str, str]:
    """Text by the sections of a NumPy-style docstring."""
    text = inspect.getdoc(thing) or ""
    parts = SECTION.split(text)
    return {"": parts[0], **dict(zip(parts[1::2], parts[2::2], strict=True))}


def described(text: str) -> set[str]:
    """Names that begin the lines of a section."""
    heads = re.sub(r"\\\n", "", text)
    found = (line.split(" :")[0] for line in heads.splitlines() if line and not line.startswith(" "))
    return {name.strip().lstrip("*").rstrip("_") for line in found for name in line.split(",")}


def parameters(thing: Any) -> set[str]:
    known = inspect.signature(thing).parameters
    return {name.rstrip("_") for name in known if name not in ("self", "cls")}


def members(of: type) -> Iterator[tuple[str, Any]]:
    """Public ones that are ours, not Python's."""
    for name, member in inspect.getmembers(of):
        ours = any(name in base.__dict__ for base in of.__mro__ if base.__module__.startswith("hertzchain"))
        if not name.startswith("_") and ours:
            yield name, member


def check_sources(name: str, thing: Any) -> None:
    """Keys and pages that are named are there."""
    text = inspect.getdoc(thing) or ""
    for key in re.findall(r"\[([A-Z]\w+\d{4})\]", text):
        assert key in KEYS, f"{name}: {key} is not in references.bib"
    for page in re.findall(r"docs/[\w/-]+\.md|experiments/(?=\W)", text):
        assert (ROOT / page).exists(), f"{name}: {page}"


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_function_documents_its_parameters_returns_and_errors(name):
    thing = FUNCTIONS[name]
    reported = sections(thing)
    assert reported[""].strip(), name
    wanted = parameters(thing)
    if wanted:
        assert wanted <= described(reported["Parameters"]), wanted - described(reported["Parameters"])
    assert reported["Returns"].strip()
    # What neither takes nor reads anything can't fail.
    assert "Raises" in reported or not wanted
    check_sources(name, thing)


@pytest.mark.parametrize("name", CLASSES)
def test_a_class_documents_its_fields(name):
    thing = CLASSES[name]
    reported = sections(thing)
    assert reported[""].strip()
    fields = {field for field in getattr(thing, "__dataclass_fields__", {}) if not field.startswith("_")}
    own = described(reported.get("Attributes", "") + "\n" + reported.get("Parameters", ""))
    assert {field.rstrip("_") for field in fields} <= own, fields - own
    check_sources(name, thing)


@pytest.mark.parametrize("name", CLASSES)
def test_a_method_documents_what_it_takes_and_returns(name):
    for of, member in members(CLASSES[name]):
        if not inspect.isroutine(member):
            continue
        reported = sections(member)
        assert reported[""].strip() and "Returns" in reported, f"{name}.{of}"
        if wanted := parameters(member):
            assert wanted <= described(reported["Parameters"]), f"{name}.{of}"


@pytest.mark.parametrize("name", CLASSES)
def test_a_property_is_documented(name):
    for of, member in members(CLASSES[name]):
        if isinstance(member, property) or inspect.isgetsetdescriptor(member):
            assert inspect.getdoc(member), f"{name}.{of}"


@pytest.mark.parametrize("module", ["", ".simulation", ".experiment"])
def test_examples_give_what_they_say(module):
    found = doctest.testmod(importlib.import_module(f"hertzchain{module}"), optionflags=doctest.ELLIPSIS)
    assert found.failed == 0 and found.attempted > 0
