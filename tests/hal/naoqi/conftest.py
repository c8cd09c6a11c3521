"""One peer for all tests that leave it as it was, and what they need of it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from naoqi_peer import Peer

from hal.naoqi.robot import NaoqiRobot


@pytest.fixture(scope="session")
def _shared() -> Iterator[Peer]:
    pytest.importorskip("qi", reason="the package qi is not installed")
    peer = Peer()
    yield peer
    peer.close()


@pytest.fixture
def peer(_shared: Peer) -> Peer:
    """The simulated robot, awake and at its start."""
    _shared.reset()
    return _shared


@pytest.fixture
def walker(peer: Peer) -> Iterator[NaoqiRobot]:
    """The backend on it."""
    found = peer.robot()
    yield found
    found.close()


@pytest.fixture
def robot(peer: Peer) -> Iterator[NaoqiRobot]:
    """The backend on it, the camera settled."""
    found = peer.robot()
    found.camera.unseen(20.0)
    yield found
    found.close()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Whatever is here connects by qi; test_qi_apart.py runs it in a process of its own."""
    for item in items:
        if Path(item.fspath).parent == Path(__file__).parent:
            item.add_marker(pytest.mark.qi)
