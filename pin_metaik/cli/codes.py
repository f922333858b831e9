"""Exit codes that the commands share."""

NOT_SOLVED = 1
"""The call made sense, and what it asked for was not found."""
NONSENSE = 2
"""The call makes no sense; nothing was done."""
INTERRUPTED = 130
"""What shells make of Ctrl-C."""
