"""Your own DH table: a TOML file, its URDF, and inverse kinematics on it.

python examples/04_your_own_dh_table.py [picture.png]
"""

import sys
import tempfile
from pathlib import Path

import pin_metaik as mik
from pin_metaik.ik import save_arm

TABLE = """
name = "polar_arm"
convention = "standard"     # or "modified" (Craig)
length = "mm"
angle = "deg"

[[joint]]
d = 350
a = 0
alpha = -90
limits = [-170, 170]

[[joint]]
d = 0
a = 0
alpha = 90
limits = [-100, 100]

[[joint]]
type = "prismatic"
theta = 0
a = 0
alpha = 0
limits = [300, 900]
"""


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "polar_arm.toml"
        file.write_text(TABLE)
        robot = mik.load_robot(file)

    print(robot.urdf[:240].rstrip(), "...\n")  # ready for any other URDF tool: pin-metaik urdf polar_arm.toml
    chain = mik.Chain(robot.model, robot.frame)
    result = mik.solve_ik(chain, [0.4, 0.3, 0.6])  # metres, whatever the table's unit
    print(result)
    for name, value in zip(chain.names, result.x, strict=True):
        print(f"  {name}: {value:.4f}")

    if len(sys.argv) > 1:
        save_arm(sys.argv[1], chain, result.q, [0.4, 0.3, 0.6])


if __name__ == "__main__":
    main()
