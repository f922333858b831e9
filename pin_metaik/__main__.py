"""``python -m pin_metaik``: the command line."""

from pin_metaik_command import run

run()
