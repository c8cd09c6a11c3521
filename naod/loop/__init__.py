"""The loop's step: a pure function of state, observation and time."""
