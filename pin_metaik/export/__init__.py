"""An arm's inverse kinematics as source code of its own, for where Python or this package is not."""

from pin_metaik.export.write import LANGUAGES, exported, write_export

__all__ = ["LANGUAGES", "exported", "write_export"]
