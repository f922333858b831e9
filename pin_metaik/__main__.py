"""``python -m pin_metaik``: the command line."""

from pin_metaik.cli import run

run()
