"""Turning the head so that the object stays centred."""
