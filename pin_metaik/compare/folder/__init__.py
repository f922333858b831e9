"""The folder of a comparison: manifest, rows, files of robots, environment, lock."""
