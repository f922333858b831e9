"""Your own URDF: a file, its joints and limits, a joint held still, a limit of your own.

python examples/03_your_own_urdf.py [picture.png]
"""

import sys
import tempfile
from pathlib import Path

import pin_metaik as mik
from pin_metaik.ik import save_arm

URDF = """
<robot name="crane">
  <link name="ground"/> <link name="mast"/> <link name="trolley"/> <link name="arm"/> <link name="hook"/>
  <joint name="slew" type="continuous">
    <parent link="ground"/> <child link="mast"/> <axis xyz="0 0 1"/>
  </joint>
  <joint name="lift" type="prismatic">
    <parent link="mast"/> <child link="trolley"/> <axis xyz="0 0 1"/>
    <limit lower="0.2" upper="1.5" effort="100" velocity="0.5"/>
  </joint>
  <joint name="luff" type="revolute">
    <parent link="trolley"/> <child link="arm"/> <origin xyz="0.1 0 0"/> <axis xyz="0 1 0"/>
    <limit lower="-1.2" upper="1.2" effort="100" velocity="1"/>
  </joint>
  <joint name="tip" type="fixed"> <parent link="arm"/> <child link="hook"/> <origin xyz="0.8 0 0"/> </joint>
</robot>
"""


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "crane.urdf"
        file.write_text(URDF)
        robot = mik.load_robot(file)

    chain = mik.Chain(robot.model, "hook")
    print(chain)
    result = mik.solve_ik(chain, [0.3, 0.6, 1.4])
    # A continuous joint is (cos, sin) in q and one angle in result.x.
    print(result, "\n  q =", result.q.round(4), "\n  x =", result.x.round(4))

    higher = mik.Chain(robot.model, "hook", limits={"lift": (1.2, 1.5)})
    print("lift kept above 1.2 m:", mik.solve_ik(higher, [0.3, 0.6, 1.4]).x.round(4))

    held = mik.Chain(robot.model, "hook", locked=["slew"])
    stuck = mik.solve_ik(held, [0.3, 0.6, 1.4])
    print(f"slew locked: {stuck.status}, {stuck.position_error:.2f} m away; {stuck.why}")

    if len(sys.argv) > 1:
        save_arm(sys.argv[1], chain, result.q, [0.3, 0.6, 1.4])


if __name__ == "__main__":
    main()
