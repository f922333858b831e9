"""A mechanism with its limits and design task, as a file keeps it."""
