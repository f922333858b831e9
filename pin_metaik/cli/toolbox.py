"""``pin-metaik toolbox``: arms, metaheuristics, paths and platforms in the browser."""

from __future__ import annotations

import webbrowser
from typing import Annotated

import typer


def toolbox(
    host: Annotated[
        str, typer.Option(help="Address to listen on; from other machines, a browser needs the token that is printed.")
    ] = "127.0.0.1",
    port: Annotated[int, typer.Option(min=0, max=65535, help="Port to listen on; 0 for any that is free.")] = 8080,
    browser: Annotated[bool, typer.Option(help="Open it in the browser of this machine.")] = True,
) -> None:
    """Show the toolbox in the browser until Ctrl-C; nothing leaves this machine."""
    from pin_metaik.gui import open_toolbox

    with open_toolbox(host, port) as opened:
        print(f"the toolbox is at {opened.url} until Ctrl-C", flush=True)
        if browser:
            webbrowser.open(opened.url)
        opened.wait()
