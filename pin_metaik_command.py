"""The command ``pin-metaik``, beside the package: Ctrl-C while that is imported, for a second, leaves no traceback."""

from __future__ import annotations

import signal


def run() -> None:
    """Entry point of the command. Until the package is imported, Ctrl-C ends the process as it ends any in a shell."""
    handler = signal.getsignal(signal.SIGINT)
    if handler is signal.default_int_handler:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    from pin_metaik.cli import run as command

    signal.signal(signal.SIGINT, handler)
    command()
