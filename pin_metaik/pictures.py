"""Files of pictures: whether one can be drawn and written, before anything is worked out for it."""

from __future__ import annotations

from pathlib import Path

from pin_metaik.arguments import checked
from pin_metaik.errors import InvalidSetting
from pin_metaik.lookup import need
from pin_metaik.output import writable

FORMATS = (".png", ".svg", ".pdf")


@checked
def picture_file(path: str | Path, *others: str) -> Path:
    """The path of a picture that can be written, before anything is worked out for it.

    Args:
        path: Where to.
        others: Endings that are welcome, too.

    Raises:
        MissingExtra: matplotlib is not installed.
        InvalidSetting: Its ending is none of a picture.
        CannotWrite: It cannot be written.
    """
    need("a picture", "plots", "matplotlib")
    endings = (*FORMATS, *others)
    if Path(path).suffix.lower() not in endings:
        raise InvalidSetting(f"a picture ends in {', '.join(endings)}, got {str(path)!r}")
    return writable(path)
