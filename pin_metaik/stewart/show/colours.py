"""The colours of a mechanism."""

STEEL, PLATE, ROD = "#4a4f57", "#e07b1a", "#2f6fb0"
