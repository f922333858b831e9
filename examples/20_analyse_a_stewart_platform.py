"""Analyse a 6x6 Stewart platform: legs, poses, workspace, singularities, and a second opinion by Pinocchio.

python examples/20_analyse_a_stewart_platform.py [picture.png]
"""

import sys

import numpy as np

from pin_metaik import stewart


def main() -> None:
    # Two circles of joints, and which base joint a leg joins to which platform joint. Metres and radians.
    geometry = stewart.Geometry(
        base_radius=0.25,
        platform_radius=0.12,
        base_angles=np.radians([-10, 10, 110, 130, 230, 250]),
        platform_angles=np.radians([-50, 50, 70, 170, 190, 290]),
        legs=[(i, i) for i in range(6)],
    )
    limits = stewart.LegLimits(shortest=0.350, longest=0.470)
    print(geometry)

    # From a pose to the legs, and back: the legs alone have several poses.
    pose = stewart.pose_at((0.03, -0.02, 0.38), np.radians((5, -8, 12)))
    lengths = stewart.leg_lengths(geometry, pose)
    print(f"leg lengths        {(1e3 * lengths).round(2)} mm")
    print(f"forward again      {np.abs(stewart.forward(geometry, lengths).pose - pose).max():.0e} off")
    print(f"all assemblies     {len(stewart.all_forward(geometry, lengths))}, half of them below the base")
    print(f"nearest two legs   {1e3 * stewart.leg_distances(geometry, pose).min():.1f} mm apart")

    # Dexterity: 1 is isotropic, 0 singular. It depends on the norm and on a characteristic length.
    for norm in ("frobenius", "two"):
        print(f"nu, {norm:14} {stewart.conditioning(geometry, pose, stewart.Dexterity(norm)):.4f}")

    # The workspace: level, then with 10 degrees of tilt in every direction.
    level = stewart.survey(geometry, limits, stewart.Grid((60, 60, 60)))
    print(f"level              {level}")
    ten = np.radians((-10, 10))
    tilting = stewart.survey(geometry, limits, stewart.Grid((40, 40, 40), steps=(3, 3, 1), roll=ten, pitch=ten))
    print(f"any tilt, all      {1e6 * tilting.volume:.0f} cm3, {1e6 * tilting.volume_of_all:.0f} cm3")

    # Turning the platform about the vertical, it comes to a pose where the legs cannot hold it.
    turn = stewart.straight(stewart.pose_at((0, 0, 0.38)), stewart.pose_at((0, 0, 0.38), (0, 0, 2.0)), seconds=1.0)
    motion = stewart.follow(geometry, turn, limits)
    (singular,) = stewart.crossings(geometry, turn)
    yaw = np.degrees(np.arctan2(singular.pose[1, 0], singular.pose[0, 0]))
    print(
        f"fastest leg        {np.abs(motion.rates).max():.2f} m/s; {motion.reached.mean():.0%} of the way within limits"
    )
    print(f"singular at        {yaw:.2f} degrees of yaw")

    if len(sys.argv) > 1:
        mechanism = stewart.Mechanism("hexapod", geometry, limits)
        stewart.save_picture(stewart.draw(mechanism, level, pose), sys.argv[1])

    # Somebody else's code: Pinocchio closes the loops of the URDF, and finds the same pose and the same rates.
    closed = stewart.closed_model(stewart.Mechanism("hexapod", geometry, limits))
    found = closed.forward(lengths, stewart.pose_at((0, 0, 0.37)))
    rates = np.abs(closed.rates(pose) - stewart.jacobian(geometry, pose)).max()
    print(f"Pinocchio          pose {np.abs(found - pose).max():.0e} off, Jacobian {rates:.0e}")


if __name__ == "__main__":
    main()
