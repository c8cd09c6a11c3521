"""The paper's optimiser in place of ours, everything else alike."""

from __future__ import annotations

from naod.bench.peers import ours


def make(size: tuple[int, int]) -> ours.Ours:
    """ICM from the singletons' minimum."""
    return ours.make(size, "icm")
