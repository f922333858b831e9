"""The toolbox in the browser: arms, metaheuristics at work, path planning and Stewart platforms to look at and try.

from pin_metaik import gui

with gui.open_toolbox(port=0) as toolbox:
    print(toolbox.url)
    toolbox.wait()
"""

# ruff: noqa: E402  # what is below imports viser and shapely
from pin_metaik.lookup import need

need("the toolbox", "toolbox", "viser", "trimesh", "shapely")

from pin_metaik.gui.toolbox import Toolbox, open_toolbox

__all__ = ["Toolbox", "open_toolbox"]
