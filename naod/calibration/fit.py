"""One least-squares fit over all views: correction, lens, and the rectangle's place.

Unknown beside these are how far each view's head was off its encoders, and how much wider the
camera shows everything. Each has an expectation, so that what the views do not tell stays where it
was expected, and its covariance says so. The correction has none.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from naod.calibration.lens import CX, CY, FX, FY, K1
from naod.calibration.rig import HEADS, LENS, WIDER, Estimate, Rig, columns_of
from naod.calibration.view import EDGE_SIGMA_PX, View, corners_in_object, on_edges, point_sigma
from naod.errors import InputError
from naod.pose.objects import Rectangle

HEAD_SIGMA_RAD = 0.003
"""Encoder steps, backlash and sag: as much as `naod.localisation.looks` allows for, until the
views themselves say how much it is."""

HEAD_SIGMA_MIN_RAD, HEAD_SIGMA_MAX_RAD = 0.0006, 0.02
"""One encoder step is 0.0015 rad, which leaves 0.0004; and the sensors' own noise."""

ABSORBED = 8
"""How many of the heads' offsets, roughly, the other unknowns explain away: correction, lens, and
the bearing of the rectangle."""

WIDER_SIGMA_PX = 0.2
HUBER = 3.0
ROUNDS = 60
SETTLED = 1e-7
FIRM = 1e-9
"""An angle whose share of the information is less than this is not seen at all."""


@dataclass(frozen=True, slots=True)
class Expected:
    """What is known of the lens beforehand: (5,) and sigmas (5,); 0 keeps it as it is."""

    lens: NDArray[np.float64]
    sigma: NDArray[np.float64]
    aspect_sigma: float

    @staticmethod
    def of(lens: NDArray[np.float64], width: int, known: bool) -> Expected:
        """3 % of focal length (`nao_cameras.yaml`), 15 pixels of 640 of centre, 0.1 of k1.

        `known`: the lens is not to be fitted.
        """
        if known:
            return Expected(lens, np.zeros(5), 0.0)
        centre = 15.0 * width / 640.0
        sigma = np.array([0.03 * lens[FX], 0.03 * lens[FY], centre, centre, 0.1])
        return Expected(lens, sigma, 0.005)


@dataclass(frozen=True, slots=True)
class Fitted:
    """`covariance` over all columns of `rig`; `residuals_px` per view, across the edges (n,).

    `misfit`: root of the mean square of what is left over its sigma; 1 when all is as expected.
    """

    estimate: Estimate
    covariance: NDArray[np.float64]
    residuals_px: tuple[NDArray[np.float64], ...]
    misfit: float

    @property
    def rms_px(self) -> float:
        """Root mean square of all residuals."""
        return float(np.sqrt(np.mean(np.concatenate(self.residuals_px) ** 2)))


class Problem:
    """The views and what is expected; `system` is what the fit minimises."""

    def __init__(
        self,
        rig: Rig,
        shape: Rectangle,
        views: Sequence[View],
        expected: Expected,
        head_sigma_rad: float = HEAD_SIGMA_RAD,
    ) -> None:
        self.rig, self.views, self.expected = rig, tuple(views), expected
        self.head_sigma_rad = head_sigma_rad
        self._corners = corners_in_object(shape)
        self._sigmas = [point_sigma(view.edges) for view in views]
        self._along = [view.edges.along.copy() for view in views]
        free = np.ones(HEADS + 2 * len(self.views), dtype=np.bool_)
        free[LENS] = expected.sigma > 0.0
        self.free = free

    def residuals(
        self, at: Estimate, number: int
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Of one view: (n,) pixels across its edges, and (n, its columns) how they change."""
        view = self.views[number]
        edges = view.edges
        points = on_edges(self._corners, edges.edge, self._along[number])
        pixels, J = self.rig.pixels(at, view.head, number, points)
        out = np.einsum("ni,ni->n", edges.normals, edges.points_px - pixels) - at.wider_px
        by = -(edges.normals[:, 0, None] * J[:, 0] + edges.normals[:, 1, None] * J[:, 1])
        by[:, WIDER] -= 1.0
        return out, by

    def slide(self, at: Estimate) -> None:
        """Move each point along its edge to where it lies beside what was measured."""
        for number, view in enumerate(self.views):
            edges, along = view.edges, self._along[number]
            tangents = np.column_stack([-edges.normals[:, 1], edges.normals[:, 0]])
            here, _ = self._seen(at, number, along)
            ahead, _ = self._seen(at, number, along + 1e-4)
            speed = np.einsum("ni,ni->n", tangents, ahead - here) / 1e-4
            short = np.einsum("ni,ni->n", tangents, edges.points_px - here)
            safe = np.where(np.abs(speed) > 1e-3, speed, np.inf)
            self._along[number] = np.clip(along + short / safe, -0.5, 1.5)

    def _seen(
        self, at: Estimate, number: int, along: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        points = on_edges(self._corners, self.views[number].edges.edge, along)
        return self.rig.pixels(at, self.views[number].head, number, points)

    def system(self, at: Estimate) -> tuple[float, NDArray[np.float64], NDArray[np.float64]]:
        """Cost (Huber), half its gradient (columns,), and J^T W J (columns, columns)."""
        size = len(self.free)
        cost, g, H = 0.0, np.zeros(size), np.zeros((size, size))
        for number, sigma in enumerate(self._sigmas):
            out, by = self.residuals(at, number)
            ratio = out / sigma
            far = np.abs(ratio) > HUBER
            weight = np.where(far, HUBER / np.maximum(np.abs(ratio), HUBER), 1.0) / sigma**2
            cost += float(np.where(far, 2.0 * HUBER * np.abs(ratio) - HUBER**2, ratio**2).sum())
            own = columns_of(number)
            g[own] += by.T @ (weight * out)
            H[np.ix_(own, own)] += by.T @ (weight[:, None] * by)
        for residual, row in self._expectations(at):
            cost += residual**2
            g += residual * row
            H += np.outer(row, row)
        return cost, g, H

    def _expectations(self, at: Estimate) -> list[tuple[float, NDArray[np.float64]]]:
        rows: list[tuple[float, NDArray[np.float64]]] = []

        def expect(off: float, column: int, sigma: float) -> None:
            row = np.zeros(len(self.free))
            row[column] = 1.0 / sigma
            rows.append((off / sigma, row))

        expect(at.wider_px, WIDER, WIDER_SIGMA_PX)
        for k, off in enumerate(at.heads_rad.reshape(-1)):
            expect(float(off), HEADS + k, self.head_sigma_rad)
        off_lens = at.lens - self.expected.lens
        for k in (FX, FY, CX, CY, K1):
            if self.expected.sigma[k] > 0.0:
                expect(float(off_lens[k]), LENS.start + k, float(self.expected.sigma[k]))
        if self.expected.aspect_sigma > 0.0:
            # fx and fy of one sensor go together
            lens = self.expected.lens
            row = np.zeros(len(self.free))
            row[LENS.start + FX] = 1.0 / (lens[FX] * self.expected.aspect_sigma)
            row[LENS.start + FY] = -1.0 / (lens[FY] * self.expected.aspect_sigma)
            gap = off_lens[FX] / lens[FX] - off_lens[FY] / lens[FY]
            rows.append((float(gap) / self.expected.aspect_sigma, row))
        return rows


def first_estimate(
    rig: Rig, views: Sequence[View], correction_rad: NDArray[np.float64], lens: NDArray[np.float64]
) -> Estimate:
    """Start from the view whose rectangle is nearest to the middle of all."""
    places = [
        rig.T_torso_camera(view.head, correction_rad) @ view.T_camera_object for view in views
    ]
    centres = np.array([T[:3, 3] for T in places])
    gaps = np.linalg.norm(centres - np.median(centres, axis=0), axis=1)
    return Estimate(
        correction_rad, lens, 0.0, places[int(np.argmin(gaps))], np.zeros((len(views), 2))
    )


def fit(problem: Problem, start: Estimate) -> Fitted:
    """Levenberg's way down. Raises InputError where the views say nothing of an unknown."""
    at, damping = start, 1e-3
    free = problem.free
    cost, g, H = problem.system(at)
    for _ in range(ROUNDS):
        step = np.zeros(len(free))
        core = H[np.ix_(free, free)]
        step[free] = np.linalg.solve(core + damping * np.diag(np.diag(core)), -g[free])
        tried = at.moved(step)
        tried_cost = problem.system(tried)[0]
        if not tried_cost <= cost:
            damping = min(damping * 10.0, 1e9)
            if damping >= 1e9:
                break
            continue
        gain, damping = cost - tried_cost, max(damping * 0.2, 1e-12)
        at = tried
        problem.slide(at)
        cost, g, H = problem.system(at)
        if gain <= SETTLED * cost + 1e-12 and float(np.abs(step).max()) < 1e-6:
            break
    return _described(problem, at, H)


def _described(problem: Problem, at: Estimate, H: NDArray[np.float64]) -> Fitted:
    free = problem.free
    core = H[np.ix_(free, free)]
    scale = np.sqrt(np.diag(core))
    values = np.linalg.eigvalsh(core / np.outer(scale, scale)) if scale.all() else np.zeros(1)
    if not np.isfinite(values).all() or values[0] < FIRM:
        raise InputError(
            "the views are too alike to say how the camera sits: turn the head further"
        )
    covariance = np.zeros_like(H)
    covariance[np.ix_(free, free)] = np.linalg.inv(core)
    residuals = tuple(problem.residuals(at, n)[0] for n in range(len(problem.views)))
    ratios = np.concatenate(
        [
            out / np.sqrt(view.edges.sigma_px**2 + EDGE_SIGMA_PX**2)
            for out, view in zip(residuals, problem.views, strict=True)
        ]
    )
    misfit = float(np.sqrt(np.mean(np.clip(ratios, -9.0, 9.0) ** 2)))
    return Fitted(at, covariance * max(1.0, misfit**2), residuals, misfit)


def sigma_deg(fitted: Fitted) -> NDArray[np.float64]:
    """(3,) standard deviations of the correction's roll, pitch and yaw, degrees."""
    return np.degrees(np.sqrt(np.diag(fitted.covariance)[:3]))


def without_odd_views(
    rig: Rig, shape: Rectangle, views: Sequence[View], expected: Expected, start: Estimate
) -> tuple[Fitted, list[View]]:
    """Fit, leave out views that do not go with the others, fit again. Raises InputError.

    At the end once more with how far the heads were off the encoders, as the views show it.
    """
    kept = list(views)
    while True:
        fitted = fit(Problem(rig, shape, kept, expected), start)
        spreads = np.array([math.sqrt(float(np.mean(r**2))) for r in fitted.residuals_px])
        limit = max(4.0 * float(np.median(spreads)), 1.0)
        worst = int(np.argmax(spreads))
        start = fitted.estimate
        if spreads[worst] <= limit or len(kept) <= 3:
            break
        del kept[worst]
        start = replace(start, heads_rad=np.zeros((len(kept), 2)))
    sigma = head_sigma(fitted.estimate)
    return fit(Problem(rig, shape, kept, expected, sigma), fitted.estimate), kept


def head_sigma(at: Estimate) -> float:
    """How far the head is off its encoders, rad, by its offsets in all views."""
    count = at.heads_rad.size
    if count < 2 * ABSORBED:
        return HEAD_SIGMA_RAD
    seen = math.sqrt(float((at.heads_rad**2).sum()) / (count - ABSORBED))
    return min(max(seen, HEAD_SIGMA_MIN_RAD), HEAD_SIGMA_MAX_RAD)
