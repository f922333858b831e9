"""Design a 3x3 Stewart platform for a stroke of 100 mm: what is free, what is good, and the file it goes to.

python examples/21_design_a_stewart_platform.py [picture.png]
"""

import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

from pin_metaik import stewart
from pin_metaik.optimize.qpso import QPSO


def main() -> None:
    # Where to start: an octahedron, and legs from 250 to 350 mm.
    mechanism = stewart.Mechanism(
        name="mine",
        geometry=stewart.standard_geometry("3x3", base_radius=0.2, platform_radius=0.05),
        limits=stewart.LegLimits(shortest=0.250, longest=0.350),
        grid=stewart.Grid((60, 60, 60)),
    )
    print(f"start: {mechanism.survey()}")

    # What may change, and by how much. B1 stays where it is; a single number is fixed, a pair is a range.
    b1, *others = mechanism.geometry.base_angles
    wide = np.radians(50)
    task = stewart.DesignTask(
        ranges=stewart.Ranges(
            base_radius=(0.042, 0.315),
            platform_radius=(0.042, 0.158),
            base_angles=(b1, *((angle - wide, angle + wide) for angle in others)),
            platform_angles=tuple((angle - wide, angle + wide) for angle in mechanism.geometry.platform_angles),
        ),
        weights=(0.78, 0.22),  # of dexterity (GDI) and of the volume, as a share of a cube of twice the stroke
        joint_gap=0.042,
        algorithm=QPSO(agents=30),  # or "pso", or any other metaheuristic
        evaluations=900,
    )
    found = stewart.design(replace(mechanism, task=task))
    print(f"found: {found}")
    print(f"       {found.mechanism.survey()}")
    geometry = found.mechanism.geometry
    print(f"       rb {1e3 * geometry.base_radius:.1f} mm, rm {1e3 * geometry.platform_radius:.1f} mm")
    print(f"       B {np.degrees(geometry.base_angles).round(1)}, M {np.degrees(geometry.platform_angles).round(1)}")

    # Best fitness after each generation.
    for designs, fitness in found.history[[0, 4, 9, 19, -1]]:
        print(f"       {designs:4.0f} designs: {fitness:.4f}")

    # A mechanism is a file: read it again, and run it with other settings. Here the base exists already and only the
    # platform is free, and what counts is the room in which the local conditioning index is at least 0.9.
    with tempfile.TemporaryDirectory() as folder:
        file = stewart.save_mechanism(replace(mechanism, task=task), Path(folder) / "mine.toml")
        again = stewart.load_mechanism(file)
    ranges = stewart.Ranges(platform_radius=(0.042, 0.158))
    task = replace(task, ranges=ranges, index="lci", threshold=0.9, weights=(0.0, 1.0), evaluations=90)
    improved = stewart.design(replace(again, task=task)).mechanism
    before, after = (1e6 * m.survey().dexterous_volume(0.9) for m in (again, improved))
    radius = 1e3 * improved.geometry.platform_radius
    print(f"rerun: rm {radius:.1f} mm, {before:.0f} -> {after:.0f} cm3 with a local conditioning index of 0.9 or more")

    if len(sys.argv) > 1:
        stewart.save_picture(stewart.draw(found.mechanism, found.mechanism.survey()), sys.argv[1])


if __name__ == "__main__":
    main()
