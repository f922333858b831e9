"""The shortest path among polygons, what a particle swarm finds instead, and the ways round the other side.

python examples/30_shortest_path_among_polygons.py [picture.png]
"""

import sys

from pin_metaik import mobile


def main() -> None:
    # Polygons come as lists, shapely, WKT or GeoJSON; they may overlap, touch and be concave.
    wall = [(3, 0), (4, 0), (4, 4.5), (3, 4.5)]
    hook = [(6, 2), (7.5, 2), (7.5, 8), (5, 8), (5, 7), (6, 7)]
    scene = mobile.Scene(start=(1, 1), goal=(9, 5), obstacles=(wall, hook), bounds=(0, 0, 10, 10))

    # A robot of radius 0.3 m that keeps 0.1 m on top: the shortest path, proven free.
    problem = mobile.PathProblem.of(scene, radius=0.3, margin=0.1)
    plan = mobile.plan_path(problem)
    print(plan)
    print(f"through {len(plan.path.corners)} corners, {plan.clearance:.3f} m from the nearest obstacle")

    # Metaheuristics search for via points; an exact test has the last word, and the optimum is known. Some runs end in
    # an obstacle: that is said, and never shown as a path.
    for method in ("pso", "ga"):
        print(mobile.plan_path(problem, method, via=4, rng=1))

    # The best paths that go another way round.
    for path in problem.alternatives(3):
        print(f"alternative of length {path.length:.3f} through {len(path.corners)} corners")

    # What makes no sense is an error that says what would have worked.
    try:
        mobile.plan_path(scene.between((3.4, 3), None))
    except mobile.Blocked as error:
        print(f"refused: {error}")

    if len(sys.argv) > 1:
        from pin_metaik.mobile import plots

        plots.save(sys.argv[1], lambda figure: plots.draw_plan(figure, plan, problem.alternatives(3)))


if __name__ == "__main__":
    main()
