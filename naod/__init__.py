"""Finds an object by its colour, keeps it in view, and walks a NAO to a pose it was shown."""

from hal.kernel_cache import use_own_cache

__version__ = "0.1.0"

use_own_cache()
