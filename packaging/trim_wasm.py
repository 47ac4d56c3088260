"""Makes a WebAssembly module smaller: drops its custom sections, and bodies of functions that never run.

A call of such a function traps. What only they call is unused then, and `wasm-opt` removes it.
"""
import re
from collections.abc import Iterator

CUSTOM, IMPORT, CODE = 0, 2, 10
FUNCTION_NAMES = 1
# Kind of an import.
FUNCTION = 0
# No locals, `unreachable`, `end`.
TRAP = b"\x00\x00\x0b"


def number(data: bytes, at: int) -> tuple[int, int]:
    """Returns an unsigned LEB128 number and where it ends."""
    value = shift = 0
    while True:
        byte = data[at]
        at += 1
        value |= (byte & 127) << shift
        shift += 7
        if byte < 128:
            return value, at


def encoded(value: int) -> bytes:
    """Returns a number as unsigned LEB128."""
    parts = bytearray()
    while value > 127:
        parts.append(value & 127 | 128)
        value >>= 7
    return bytes([*parts, value])


def counted(data: bytes, at: int) -> tuple[bytes, int]:
    """Returns bytes that their number precedes, and where they end."""
    size, at = number(data, at)
    return data[at : at + size], at + size


def sections(module: bytes) -> Iterator[tuple[int, bytes]]:
    at = 8
    while at < len(module):
        kind = module[at]
        body, at = counted(module, at + 1)
        yield kind, body


def names(module: bytes) -> dict[int, str]:
    """Returns functions' names by their index, from the section `name`."""
    found = {}
    for kind, body in sections(module):
        if kind != CUSTOM:
            continue
        title, at = counted(body, 0)
        while title == b"name" and at < len(body):
            part = body[at]
            content, at = counted(body, at + 1)
            if part == FUNCTION_NAMES:
                count, place = number(content, 0)
                for _ in range(count):
                    index, place = number(content, place)
                    name, place = counted(content, place)
                    found[index] = name.decode()
    return found


def imports(body: bytes) -> int:
    """Returns how many functions a section of imports has."""
    count, at = number(body, 0)
    for _ in range(count):
        _, at = counted(body, at)
        _, at = counted(body, at)
        if body[at] != FUNCTION:
            raise ValueError(f"an import of kind {body[at]}: expected functions alone")
        _, at = number(body, at + 1)
    return count


def trimmed(module: bytes, unused: str) -> bytes:
    """Returns a module without custom sections and without the functions whose names match a pattern."""
    found, first, out = names(module), 0, bytearray(module[:8])
    for kind, body in sections(module):
        if kind == IMPORT:
            first = imports(body)
        elif kind == CODE:
            count, at = number(body, 0)
            code = bytearray(encoded(count))
            for index in range(first, first + count):
                function, at = counted(body, at)
                function = TRAP if re.search(unused, found.get(index, "")) else function
                code += encoded(len(function)) + function
            body = bytes(code)
        if kind != CUSTOM:
            out += bytes([kind]) + encoded(len(body)) + body
    return bytes(out)
