"""Experiments of Python as text, so that mistakes in them have a line."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence

from .errors import OptionError

Scalar = str | float | int | bool


def text(tables: Mapping[str, object]) -> str:
    """TOML of plain values, tables and lists of tables."""
    plain = {key: value for key, value in tables.items() if not _is_table(value)}
    lines = [f"{_key(key)} = {_inline(value)}" for key, value in plain.items()]
    for key, value in tables.items():
        if isinstance(value, Mapping):
            lines += _table(_key(key), value)
        elif _is_table(value):
            for member in value:  # type: ignore[attr-defined]
                lines += ["", f"[[{_key(key)}]]", *_fields(member)]
    return "\n".join(lines).strip() + "\n"


def _is_table(value: object) -> bool:
    if isinstance(value, Mapping):
        return True
    if isinstance(value, str) or not isinstance(value, Sequence):
        return False
    return len(value) > 0 and all(isinstance(member, Mapping) for member in value)


def _table(name: str, fields: Mapping[str, object]) -> list[str]:
    nested = {key: value for key, value in fields.items() if isinstance(value, Mapping)}
    if nested and len(nested) == len(fields):
        tables = [_table(f"{name}.{_key(key)}", value) for key, value in nested.items()]
        return [line for table in tables for line in table]
    return ["", f"[{name}]", *_fields(fields)]


def _fields(fields: Mapping[str, object]) -> list[str]:
    return [f"{_key(key)} = {_inline(value)}" for key, value in fields.items()]


def _key(key: str) -> str:
    bare = key.isascii() and key.replace("-", "").replace("_", "").isalnum()
    return key if bare else json.dumps(key)


def _inline(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        # JSON's strings are TOML's, but for what JSON writes as two halves.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, int):
        return str(value)
    if isinstance(value, Mapping):
        members = ", ".join(f"{_key(key)} = {_inline(member)}" for key, member in value.items())
        return f"{{ {members} }}"
    if isinstance(value, Sequence):
        return f"[{', '.join(_inline(member) for member in value)}]"
    try:
        return repr(float(value))  # type: ignore[arg-type]
    except (TypeError, ValueError):
        kind = type(value).__name__
        raise OptionError(f"an experiment holds no {kind}; expected texts, numbers, lists, dicts") from None
