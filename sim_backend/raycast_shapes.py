"""A ray against one primitive, in the primitive's own frame. numba kernels.

A ray is o + t d; `t` of the nearest hit in front of it is returned, or infinity. Sizes: rectangle
(hx, hy, 0) in its plane z = 0; box (hx, hy, hz); cylinder (r, hz, 0) about z with caps; sphere
(r, 0, 0); capsule (r, hz, 0) about z, hz between the middle and a cap's centre.
"""

from __future__ import annotations

import math

from numba import njit

from sim_backend.raycast_types import BOX, CAPSULE, CYLINDER, RECTANGLE

FAR = math.inf
_NEAR = 1e-6


@njit(cache=True, nogil=True, error_model="numpy")
def _slab(o, d, h):  # type: ignore[no-untyped-def]
    # a ray along the slab divides by zero: infinities of the right sign, inside as well as outside
    a, b = (-h - o) / d, (h - o) / d
    return (a, b) if a < b else (b, a)


@njit(cache=True, nogil=True, error_model="numpy")
def hit_box(ox, oy, oz, dx, dy, dz, hx, hy, hz):  # type: ignore[no-untyped-def]
    """Slabs; from inside, the far wall."""
    ax, bx = _slab(ox, dx, hx)
    ay, by = _slab(oy, dy, hy)
    az, bz = _slab(oz, dz, hz)
    near = ax if ax > ay else ay
    near = near if near > az else az
    far = bx if bx < by else by
    far = far if far < bz else bz
    t = near if near > _NEAR else far
    return t if (near <= far) & (t > _NEAR) else FAR


@njit(cache=True, nogil=True, error_model="numpy")
def hit_sphere(ox, oy, oz, dx, dy, dz, r):  # type: ignore[no-untyped-def]
    """From outside."""
    a = dx * dx + dy * dy + dz * dz
    b = ox * dx + oy * dy + oz * dz
    c = ox * ox + oy * oy + oz * oz - r * r
    root = b * b - a * c
    if root < 0.0:
        return FAR
    t = (-b - math.sqrt(root)) / a
    return t if t > _NEAR else FAR


@njit(cache=True, nogil=True, error_model="numpy")
def hit_tube(ox, oy, oz, dx, dy, dz, r, hz):  # type: ignore[no-untyped-def]
    """The mantle of a cylinder, seen from outside."""
    a = dx * dx + dy * dy
    if a == 0.0:
        return FAR
    b = ox * dx + oy * dy
    root = b * b - a * (ox * ox + oy * oy - r * r)
    if root < 0.0:
        return FAR
    t = (-b - math.sqrt(root)) / a
    return t if t > _NEAR and abs(oz + t * dz) <= hz else FAR


@njit(cache=True, nogil=True, error_model="numpy")
def hit_cylinder(ox, oy, oz, dx, dy, dz, r, hz):  # type: ignore[no-untyped-def]
    """Mantle and the cap on the ray's side."""
    best = hit_tube(ox, oy, oz, dx, dy, dz, r, hz)
    if dz != 0.0:
        t = ((hz if dz < 0.0 else -hz) - oz) / dz
        x, y = ox + t * dx, oy + t * dy
        if _NEAR < t < best and x * x + y * y <= r * r:
            best = t
    return best


@njit(cache=True, nogil=True, error_model="numpy")
def hit_capsule(ox, oy, oz, dx, dy, dz, r, hz):  # type: ignore[no-untyped-def]
    """Mantle and two balls."""
    best = hit_tube(ox, oy, oz, dx, dy, dz, r, hz)
    top = hit_sphere(ox, oy, oz - hz, dx, dy, dz, r)
    low = hit_sphere(ox, oy, oz + hz, dx, dy, dz, r)
    return min(best, top, low)


@njit(cache=True, nogil=True, error_model="numpy")
def _box_side(x, y, z, a, b, c):  # type: ignore[no-untyped-def]
    px, py, pz = abs(x) / a, abs(y) / b, abs(z) / c
    if pz >= px and pz >= py:
        return 0.0, 0.0, math.copysign(1.0, z), 0.5 + 0.5 * x / a, 0.5 - 0.5 * y / b
    if px >= py:
        return math.copysign(1.0, x), 0.0, 0.0, 0.5 + 0.5 * y / b, 0.5 - 0.5 * z / c
    return 0.0, math.copysign(1.0, y), 0.0, 0.5 + 0.5 * x / a, 0.5 - 0.5 * z / c


@njit(cache=True, nogil=True, error_model="numpy")
def _cylinder_side(x, y, z, r, hz, wants_uv):  # type: ignore[no-untyped-def]
    out = math.sqrt(x * x + y * y)
    if abs(z) >= hz * (1.0 - 1e-9) and out < r * (1.0 - 1e-9):
        # the caps take the flat colour: u below 0 says that there is no texture here
        return 0.0, 0.0, math.copysign(1.0, z), -1.0, 0.0
    u = 0.5 + math.atan2(y, x) / (2.0 * math.pi) if wants_uv else 0.0
    return x / out, y / out, 0.0, u, 0.5 - 0.5 * z / hz


@njit(cache=True, nogil=True, error_model="numpy")
def surface(kind, x, y, z, a, b, c, wants_uv):  # type: ignore[no-untyped-def]
    """Outward normal and texture place (u to the right, v down, 0 to 1) at a point of the skin."""
    if kind == RECTANGLE:
        return 0.0, 0.0, 1.0, 0.5 + 0.5 * x / a, 0.5 - 0.5 * y / b
    if kind == BOX:
        return _box_side(x, y, z, a, b, c)
    if kind == CYLINDER:
        return _cylinder_side(x, y, z, a, b, wants_uv)
    level = 0.0
    if kind == CAPSULE:
        level = min(max(z, -b), b)
    return x / a, y / a, (z - level) / a, 0.0, 0.0
