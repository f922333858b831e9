"""Polylines with known best times, and random planned ones."""

import shapely

from pin_metaik.mobile import NOMAD_200, PathProblem, random_scene

A = [(0, 0), (3, 0), (3, 3)]
B = [(0, 0), (2, 0), (3, 1.5), (6, 1.5), (6, 4)]
C = [(0, 0), (4, 0), (4, 4)]
BOX = shapely.box(2.6, 0.4, 3.6, 1.4)  # in C's corner


def planned(seed, margin=0.1):
    """A scene and the shortest path through it, with the robot's radius and a margin."""
    scene = random_scene(15, seed, gap=2 * (NOMAD_200.radius + margin) + 0.1)
    return scene, PathProblem.of(scene, NOMAD_200.radius, margin).optimum
