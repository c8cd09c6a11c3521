"""The object's colour: one Gaussian in YUV, learnt from regions a person marks (paper 3.1, 5.1)."""

from __future__ import annotations

import msgspec

Triple = tuple[float, float, float]


class ColourModel(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """`mean` of Y, U, V in 8-bit levels; `covariance` in levels squared, 3x3, full rank."""

    mean: Triple
    covariance: tuple[Triple, Triple, Triple]
