"""Finds an object by its colour, keeps it in view, and walks a NAO to a pose it was shown."""

__version__ = "0.1.0"
