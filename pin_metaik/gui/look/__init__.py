"""What pages draw: robots, maps, platforms and curves. Nothing here finds an answer."""
