"""The backend for a NAO V6 with a RoboCup image: LoLA's socket, served by a process of its own.

The daemon's side is `robot`, the other process `process`; between them lie `shared` (what is
measured) and `channel` (what is wanted). What the process decides at each tick is pure: `core` and
what it calls. Facts: `lola_protocol.yaml`; what that file leaves open is marked as an assumption
where it is made.
"""
