"""The simulated robot as a peer: it speaks a real robot's protocol to whoever connects.

One room for each protocol, by name in `hal.backends.PEERS`.
"""
