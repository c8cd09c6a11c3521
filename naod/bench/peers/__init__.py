"""What a user could pick instead, each behind the same small interface.

A module here has `make(size) -> Peer`. It is imported only when its peer is asked for.
"""
