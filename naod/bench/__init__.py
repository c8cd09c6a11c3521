"""Benchmarks: ours and its peers side by side, interleaved in one run, so that ratios hold."""
