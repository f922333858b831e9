"""Trials: the comparison they belong to, the work items that hold them, the processes that run them, their rows."""
