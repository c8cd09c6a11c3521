"""Compiling every kernel beforehand, for the processor of a robot."""
