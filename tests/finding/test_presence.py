"""Probabilities in rendered rooms that were not used to fit them."""

import numpy as np
import pytest

from naod.finding.calibration import fitted, gathered, reliability, text_of
from naod.finding.measure import MEASURES
from naod.finding.presence import CHOSEN, WEIGHTS, fitted_weights, log_odds, terms, weights_of

SEEDS = range(500, 506)
"""Each of the things once with and once without the object."""


@pytest.fixture(scope="module")
def samples(tmp_path_factory):
    return gathered(SEEDS, 5, tmp_path_factory.mktemp("rooms"))


def test_what_is_said_is_what_is_true(samples):
    """Always saying one half has a Brier score of 0.25."""
    brier, table = reliability(samples, fitted_weights())
    assert brier < 0.15
    sure = table[4]
    assert sure[2] > 5
    assert abs(sure[0] - sure[1]) < 0.2


def test_a_fit_gives_a_file_that_is_read_back(samples, tmp_path):
    weights = fitted(samples)
    path = tmp_path / "weights.toml"
    path.write_text(text_of(weights))
    text = WEIGHTS.read_text()
    for line in text_of(weights).splitlines():
        assert line.split("=", maxsplit=1)[0] in text
    brier, _ = reliability(samples, weights)
    assert np.isfinite(brier)
    # fitted to these very rooms it can hardly be worse
    assert brier < reliability(samples, fitted_weights())[0] + 0.02


def test_log_odds_are_the_weighted_terms_of_each_case():
    measures = np.random.default_rng(0).uniform(-1.0, 6.0, (8, MEASURES))
    cuts, weights = np.arange(8) % 3, fitted_weights()
    rows = terms(measures)
    expected = np.where(cuts > 0, rows @ weights["cut"], rows @ weights["whole"])
    assert np.allclose(log_odds(measures, cuts, weights_of(True)), expected)
    expected = rows @ weights["unknown"] + CHOSEN
    assert np.allclose(log_odds(measures, cuts, weights_of(False)), expected)
