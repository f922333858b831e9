"""A platform: its joints, its legs and their limits, and its poses."""
