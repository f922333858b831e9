"""Obstacles that move, and paths with times among them: waiting where that is quicker than going round."""
