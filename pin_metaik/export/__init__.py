"""An arm's inverse kinematics, all solutions for a pose, as standalone source code in C or Python."""

from pin_metaik.export.write import LANGUAGES, exported, write_export

__all__ = ["LANGUAGES", "exported", "write_export"]
