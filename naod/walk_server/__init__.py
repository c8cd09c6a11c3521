"""The robot's side of `walk/command`: arbitration, limits, time to live."""
