"""Exceptions, with the same reports as on the command line."""

from __future__ import annotations

import errno
import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

__all__ = ["ExperimentError", "ExperimentWarning", "Finding", "HertzchainError", "InternalError", "MissingFileError", "OptionError"]

_KEY = re.compile(r"`([^`]+)`")


@dataclass(frozen=True)
class Finding:
    """One mistake in an experiment file, or a warning about it.

    Attributes
    ----------
    file, line : str, int
        Name of the file or of the experiment, and the line in it, from 1.
    key : str or None
        The key that it is about, where it is about one.
    text : str
        The offending text.
    message, expected : str
        What is wrong, and what was expected in its place.
    help : str or None
        What to do.
    report : str
        All of it with the offending text underlined, as the program prints it.
    """

    file: str
    line: int
    key: str | None
    text: str
    message: str
    expected: str
    help: str | None
    report: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: {self.message}: {self.expected}"


def findings(raw: Sequence[Mapping[str, Any]]) -> tuple[Finding, ...]:
    """Findings of the extension, each with the key that its message names."""
    keys = [_KEY.search(one["message"]) for one in raw]
    return tuple(Finding(key=key.group(1) if key else None, **one) for key, one in zip(keys, raw, strict=True))


_OPTION = re.compile(r"--([a-z][a-z-]*)")
# Control characters but line ends and tabs, as they are printed: those of a file's title could steer a terminal.
CONTROLS = {code: f"\\u{code:04x}" for code in (*range(9), *range(11, 32), *range(127, 160))}


def in_python(text: str) -> str:
    """A message that names arguments of Python in place of options of the command line."""
    return _OPTION.sub(lambda option: {"set": "fixed"}.get(option[1], option[1].replace("-", "_")), text)


class HertzchainError(Exception):
    """Any failure of hertzchain: the base of `ExperimentError`, `OptionError` and `InternalError`."""


class ExperimentError(HertzchainError, ValueError):
    """Mistakes in an experiment; the text is the program's report.

    Attributes
    ----------
    findings : tuple of Finding
        Every mistake, with its file, line and key.
    """

    findings: tuple[Finding, ...]

    def __init__(self, report: str, raw: Sequence[Mapping[str, Any]]) -> None:
        super().__init__(report)
        self.findings = findings(raw)
        self._raw = list(raw)

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), (str(self), self._raw))


class OptionError(HertzchainError, ValueError):
    """A number or a name that a function does not accept; the text lists what it accepts."""

    def __init__(self, text: str) -> None:
        super().__init__(in_python(text))


class MissingFileError(OptionError, FileNotFoundError):
    """A file or folder that is not there.

    Parameters
    ----------
    path : path
        Its path.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        super().__init__(os.fspath(path))
        self.errno, self.filename = errno.ENOENT, os.fspath(path)

    def __str__(self) -> str:
        return f"{self.filename} can't be read: there is no such file or folder".translate(CONTROLS)

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), (self.filename,))


def existing(path: str | os.PathLike[str]) -> str:
    """A path of something that is there; ``-`` is standard input."""
    if not isinstance(path, (str, os.PathLike)):
        raise OptionError(f"{type(path).__name__}: expected a path, or one array of volts")
    if os.fspath(path) != "-" and not os.path.exists(path):
        raise MissingFileError(path)
    return os.fspath(path)


class InternalError(HertzchainError, RuntimeError):
    """Not the user's mistake: a full disk, a lack of threads, or a defect of hertzchain."""


class ExperimentWarning(UserWarning):
    """A warning about an experiment, such as a law outside its range of validity."""
