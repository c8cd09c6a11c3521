"""The paper's experiment in lock-step simulation, its report and its pictures."""
