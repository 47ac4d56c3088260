#!/usr/bin/env python3
"""Prints a software bill of materials (CycloneDX 1.5) of what is linked into the program and the wheel."""

import json
import subprocess
from typing import Any


def metadata() -> dict[str, Any]:
    words = ["cargo", "metadata", "--locked", "--format-version", "1"]
    return json.loads(subprocess.run(words, check=True, capture_output=True, text=True).stdout)


def linked(found: dict[str, Any], roots: set[str]) -> set[str]:
    """Packages that the roots reach by dependencies that are neither for tests nor for builds."""
    nodes = {node["id"]: node["deps"] for node in found["resolve"]["nodes"]}
    seen, open_ = set(), [key for key in nodes if key in roots]
    while open_:
        key = open_.pop()
        if key not in seen:
            seen.add(key)
            open_ += [dep["pkg"] for dep in nodes[key] if any(kind["kind"] is None for kind in dep["dep_kinds"])]
    return seen


def main() -> None:
    found = metadata()
    packages = {package["id"]: package for package in found["packages"]}
    roots = {key for key, package in packages.items() if package["name"] in ("hertzchain", "hertzchain-py")}
    components = [
        {
            "type": "library",
            "name": package["name"],
            "version": package["version"],
            "purl": f"pkg:cargo/{package['name']}@{package['version']}",
            "licenses": [{"expression": package["license"]}] if package["license"] else [],
        }
        for package in sorted((packages[key] for key in linked(found, roots)), key=lambda each: each["name"])
    ]
    print(json.dumps({"bomFormat": "CycloneDX", "specVersion": "1.5", "version": 1, "components": components}, indent=1))


if __name__ == "__main__":
    main()
