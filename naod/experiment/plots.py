"""The paper's figures 10, 11 and 12, as PNG."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import matplotlib as mpl
import numpy as np
from numpy.typing import NDArray

from hal.simulation import Truth
from naod.experiment.summary import EgoRow, LocalisationRow
from naod.pose.objects import Cylinder, ObjectShape

mpl.use("Agg")
from matplotlib import pyplot as plt
from matplotlib.axes import Axes

_TRUE, _EXACT, _PAPER, _INK = "#c0392b", "#1e8449", "#7d3c98", "#34495e"


def figure_10(
    path: Path,
    room_start: NDArray[np.uint8],
    room_end: NDArray[np.uint8],
    way: Sequence[Truth],
    shown: Truth,
    shape: ObjectShape,
) -> None:
    """The room before and after, and between them the way from above.

    Around a cylinder a circle shows all the poses that look like the one shown.
    """
    figure, axes = plt.subplots(1, 3, figsize=(15, 4.4), gridspec_kw={"width_ratios": [1, 1.1, 1]})
    for axis, picture, title in (
        (axes[0], room_start, "start"),
        (axes[2], room_end, "end"),
    ):
        axis.imshow(picture)
        axis.set_title(title)
        axis.axis("off")
    _way_from_above(axes[1], way, shown, shape)
    _save(figure, path)


def figure_11(path: Path, rows: Sequence[LocalisationRow]) -> None:
    """The object as perceived in B: truth red, estimates green, the ego-cylinder around B."""
    figure, axis = plt.subplots(figsize=(6, 6))
    if rows:
        radius = rows[-1].true.rho_m
        axis.add_patch(plt.Circle((0, 0), radius, fill=False, color=_INK, lw=1))
        axis.annotate(f"ego-cylinder, {radius:.2f} m", (0, -radius), ha="center", va="top")
        for name, colour, marker in (("true", _TRUE, "o"), ("estimated", _EXACT, "+")):
            egos = [getattr(row, name) for row in rows]
            x, y = [_x(e) for e in egos], [_y(e) for e in egos]
            axis.plot(x, y, marker, color=colour, ms=7, label=name, ls="-", lw=0.6, mfc="none")
    _robot(axis, 0.0, 0.0, 0.0, _INK)
    axis.set(
        xlabel="x in B, m", ylabel="y in B, m", aspect="equal", title="The object as seen in B"
    )
    axis.grid(alpha=0.3)
    axis.legend(loc="upper left")
    axis.margins(0.1)
    _save(figure, path)


def figure_12(path: Path, rows: Sequence[LocalisationRow]) -> None:
    """Error of localisation over the way: ours, and the printed estimator's."""
    figure, axes = plt.subplots(2, 2, figsize=(11, 6.5), sharex=True)
    panels = (
        ("rho_m", "distance error, mm", 1000.0),
        ("theta_rad", "azimuth error, degrees", math.degrees(1.0)),
        ("z_m", "height error, mm", 1000.0),
        ("phi_rad", "orientation error, degrees", math.degrees(1.0)),
    )
    for axis, (field, label, scale) in zip(axes.flat, panels, strict=True):
        for name, colour, title in (
            ("paper", _PAPER, "as printed"),
            ("estimated", _EXACT, "exact"),
        ):
            picked = [row for row in rows if getattr(row, name) is not None]
            error = [scale * _difference(getattr(r, name), r.true, field) for r in picked]
            axis.plot([r.t_s for r in picked], error, ".-", color=colour, lw=0.8, label=title)
        axis.axhline(0.0, color=_INK, lw=0.8)
        axis.set_ylabel(label)
        axis.grid(alpha=0.3)
    for axis in axes[1]:
        axis.set_xlabel("time, s")
    axes[0, 0].legend()
    figure.suptitle("Localisation error along the way")
    _save(figure, path)


def _way_from_above(axis: Axes, way: Sequence[Truth], shown: Truth, shape: ObjectShape) -> None:
    x, y = [t.base.x for t in way], [t.base.y for t in way]
    axis.plot(x, y, color=_EXACT, lw=1.5, label="way walked")
    place = shown.T_world_object[:3, 3]
    if isinstance(shape, Cylinder):
        axis.add_patch(plt.Circle(place[:2], shape.radius_m, color=_TRUE, label="object"))
        radius = math.hypot(shown.base.x - place[0], shown.base.y - place[1])
        label = "poses that look like it"
        axis.add_patch(
            plt.Circle(place[:2], radius, fill=False, color=_PAPER, ls=":", lw=1, label=label)
        )
    else:
        half = 0.5 * shape.width_m * shown.T_world_object[:2, 0]
        ends = np.array([place[:2] - half, place[:2] + half])
        axis.plot(ends[:, 0], ends[:, 1], color=_TRUE, lw=4, label="object")
    _robot(axis, shown.base.x, shown.base.y, shown.base.yaw, _PAPER, "pose shown", 11)
    if way:
        _robot(axis, x[0], y[0], way[0].base.yaw, _INK, "start")
        _robot(axis, x[-1], y[-1], way[-1].base.yaw, _EXACT, "end")
    axis.set(xlabel="x, m", ylabel="y, m", aspect="equal", title="from above")
    axis.grid(alpha=0.3)
    axis.margins(0.15)
    axis.legend(fontsize=8, loc="best")


def _robot(
    axis: Axes, x: float, y: float, yaw: float, colour: str, label: str = "", size: float = 6
) -> None:
    dx, dy = 0.1 * math.cos(yaw), 0.1 * math.sin(yaw)
    axis.plot([x], [y], "o", color=colour, ms=size, label=label or None, mfc="none", mew=1.6)
    axis.annotate(
        "", (x + dx, y + dy), (x, y), arrowprops={"arrowstyle": "-|>", "color": colour, "lw": 1.6}
    )


def _difference(estimate: EgoRow, true: EgoRow, field: str) -> float:
    error = float(getattr(estimate, field) - getattr(true, field))
    return math.remainder(error, 2.0 * math.pi) if field.endswith("_rad") else error


def _x(ego: EgoRow) -> float:
    return ego.rho_m * math.cos(ego.theta_rad)


def _y(ego: EgoRow) -> float:
    return ego.rho_m * math.sin(ego.theta_rad)


def _save(figure: plt.Figure, path: Path) -> None:
    figure.tight_layout()
    figure.savefig(path, dpi=110, bbox_inches="tight")
    plt.close(figure)
