"""Force laws written in Python."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _hertzchain as _native

__all__ = ["ForceLaw"]

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class ForceLaw:
    """A contact force as a function of overlap and overlap rate, for exploration.

    Python computes it step by step in one thread, some hundred times as slow as
    a law of the registry; `hertzchain.shot` takes it.

    Parameters
    ----------
    force : function of (overlap_m, rate_m_s)
        Force in N, positive where it pushes beads apart, from two arrays of
        shape (contacts,): overlaps δ > 0 in m and rates δ̇ in m/s, positive
        while approaching. Must return an array of that shape.
    energy : function of (overlap_m,), optional
        Energy in J that a contact gives back, of which ``force`` at δ̇ = 0 is
        the derivative. Without it shots have no energy budget; with it what
        ``force`` takes beyond is booked as lost.
    name : str
        What budgets and messages call it.
    equation : str
        In plain text, for messages.
    first, last : int, optional
        Contacts on which it acts; contact 0 is the striker's, ``last=None`` the wall's.
    beside : bool
        Whether it acts beside the experiment's laws there, not in their place.

    Examples
    --------
    >>> import numpy as np, hertzchain as hc
    >>> K = 8.79e9
    >>> hertz = ForceLaw(lambda overlap, rate: K * overlap**1.5, energy=lambda overlap: 0.4 * K * overlap**2.5)
    >>> shot = hc.shot(hc.preset("hertz"), 1.0, forces=hertz)

    References
    ----------
    Gates and signs: docs/conventions.md; laws of the registry, each with its source:
    `hertzchain.laws`.
    """

    force: Callable[[Floats, Floats], Any]
    energy: Callable[[Floats], Any] | None = None
    name: str = "python"
    equation: str = "F(δ, δ̇)"
    first: int = 0
    last: int | None = None
    beside: bool = False

    def native(self) -> _native.Force:
        """As the extension takes it.

        Returns
        -------
        Force
            The extension's own.
        """
        return _native.Force(self.name, self.equation, self.force, self.energy, self.first, self.last, self.beside)
