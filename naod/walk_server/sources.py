"""Sequence numbers by source: each number is taken once, and only upwards."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from naod.walk_server.rules import Rules

Sources = Mapping[str, tuple[int, int]]
"""From a source to its last sequence number and when that came, in ns."""

NOBODY: Sources = MappingProxyType({})


def take(last: Sources, source: str, seq: int, now_ns: int, rules: Rules) -> Sources | str:
    """The numbers with this one taken, or why it is not: replayed, or too many sources."""
    known, _ = last.get(source, (-1, 0))
    if seq <= known:
        return f"replayed (seq {seq}, last was {known})"
    kept = dict(last)
    if source not in kept and len(kept) >= rules.sources_max:
        oldest = min(kept, key=lambda name: kept[name][1])
        if now_ns - kept[oldest][1] < rules.source_kept_s * 1e9:
            return f"more than {rules.sources_max} sources"
        del kept[oldest]
    kept[source] = (seq, now_ns)
    return MappingProxyType(kept)
