"""The commands of `naod`, a module each."""
