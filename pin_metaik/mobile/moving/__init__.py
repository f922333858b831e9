"""Moving obstacles, and paths with times among them that wait where that is quicker than a detour."""
