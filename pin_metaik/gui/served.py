"""The one page that browsers get: viser's, with the toolbox's title, and with names for what viser leaves without."""

from __future__ import annotations

from http.client import HTTPConnection
from importlib.resources import files

from pin_metaik.gui.words import LOG

TITLE = "pin_metaik toolbox"
SCRIPT = "names.js"
PATIENCE = 10.0  # s


def page_of(port: int) -> bytes:
    """The page of the viser that listens on a port of loopback, with a script that names its inputs."""
    connection = HTTPConnection("127.0.0.1", port, timeout=PATIENCE)
    try:
        connection.request("GET", "/")
        page = connection.getresponse().read()
    finally:
        connection.close()
    script = (files("pin_metaik.gui") / SCRIPT).read_bytes()
    for before, after in (
        (b"<title>Viser</title>", f"<title>{TITLE}</title>".encode()),
        (b"</head>", b"<script>" + script + b"</script></head>"),
    ):
        if page.count(before) != 1:
            LOG.warning("the page of this viser has no %s: it is served as it is", before.decode())
        else:
            page = page.replace(before, after)
    return page
