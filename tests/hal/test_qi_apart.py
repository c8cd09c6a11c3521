"""Everything that connects by qi, in processes of their own.

qi is compiled code with threads of its own, and it has crashed when a server went away at the wrong
moment; here that ends a process of ours, not the whole of the tests. On a robot systemd starts the
daemon again, and the walk is stopped by a process that has not crashed.
"""

import signal
import subprocess
import sys
from pathlib import Path

import pytest

TESTS = Path(__file__).parents[1]
CRASHES = {-signal.SIGSEGV, -signal.SIGABRT}
TRIES = 3


@pytest.mark.parametrize("place", ["hal/naoqi", "sim_backend/speak/test_naoqi_peer.py"])
def test_all_that_connects_by_qi(place):
    pytest.importorskip("qi", reason="the package qi is not installed")
    command = [sys.executable, "-m", "pytest", "-q", "-m", "qi and not slow", str(TESTS / place)]
    for _ in range(TRIES):
        done = subprocess.run(
            command, capture_output=True, text=True, check=False, cwd=TESTS.parent, timeout=900.0
        )
        if done.returncode not in CRASHES:
            break
    assert done.returncode == 0, done.stdout[-4000:] + done.stderr[-2000:]
    assert "[100%]" in done.stdout
