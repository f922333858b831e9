"""Experiments side by side: papers and their printed tables, reports on the terminal, as Markdown, CSV and figures."""
