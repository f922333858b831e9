"""Files: mechanisms as TOML, trajectories as CSV, workspaces as points."""
