"""Exceptions, with the same reports as on the command line."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypedDict

__all__ = [
    "ExperimentError",
    "ExperimentWarning",
    "Finding",
    "HertzchainError",
    "InternalError",
    "OptionError",
]


class RawFinding(TypedDict):
    """A finding as the extension tells it."""

    file: str
    line: int
    text: str
    message: str
    expected: str
    help: str | None
    report: str


_KEY = re.compile(r"`([^`]+)`")


@dataclass(frozen=True)
class Finding:
    """One thing to say about an experiment file: what, where, what was expected.

    Attributes
    ----------
    file : str
        Name of the file or of the experiment.
    line : int
        Line in it, from 1.
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

    @classmethod
    def of(cls, raw: RawFinding) -> Finding:
        """From the extension's own.

        Parameters
        ----------
        raw : dict
            As the extension tells it.

        Returns
        -------
        Finding
            With the key that its message names.
        """
        named = _KEY.search(raw["message"])
        return cls(key=named.group(1) if named else None, **raw)

    def __str__(self) -> str:
        return f"{self.file}:{self.line}: {self.message}: {self.expected}"


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

    def __init__(self, report: str, findings: Sequence[RawFinding]) -> None:
        super().__init__(report)
        self.findings = tuple(Finding.of(raw) for raw in findings)
        self._raw = list(findings)

    def __reduce__(self) -> tuple[type[ExperimentError], tuple[str, list[RawFinding]]]:
        return (type(self), (str(self), self._raw))


class OptionError(HertzchainError, ValueError):
    """A number or a name that a verb does not take; the text says what it takes."""


class InternalError(HertzchainError, RuntimeError):
    """Not the user's mistake: a full disk, a lack of threads, or a mistake of ours."""


class ExperimentWarning(UserWarning):
    """What is odd about an experiment, such as a law out of its range."""
