"""The example scenario shows the defaults, and does not drift from them."""

from pathlib import Path

import msgspec

from hal.scenario import Scenario
from sim_backend.defaults import resolved

EXAMPLE = Path(__file__).parent.parent.parent / "deploy" / "scenario.toml"


def test_example_scenario_is_the_default_world():
    example = msgspec.toml.decode(EXAMPLE.read_text(), type=Scenario)
    assert resolved(example) == resolved(Scenario())
