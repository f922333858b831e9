"""Path planners side by side on a scene of one's own, and a path with waits among obstacles that move.

Needs the extra ``planners``. Prints a table and a timetable.

python examples/34_planners_and_what_moves.py [picture.png]
"""

import sys
from statistics import median

from pin_metaik import compare, mobile

METHODS = ("exact", "astar", "rrt", "rrtstar", "prm", "ga", "pso")


def main():
    scene = mobile.random_scene(12, 7, concave=0.5, gap=0.5)
    problem = mobile.PathProblem.of(scene, radius=0.1)
    found = compare.compare_planners(problem, METHODS, runs=3)
    print(f"{scene.name}: the shortest path is {problem.optimum.length:.3f} m")
    for method in METHODS:
        runs = found.of(scene.name, method)
        gaps = [100 * run.plan.gap for run in runs if run.plan.gap is not None]
        ms = 1e3 * median(run.seconds for run in runs)
        gap = f"{median(gaps):6.2f} % above" if gaps else "none"
        print(f"  {method:8} {len(gaps)} of {len(runs)} free, {gap:15} {ms:7.1f} ms")

    truck = mobile.MovingObstacle(mobile.Footprint.rectangle(3.0, 0.8), [(0, 1.5, 5), (14, 8.5, 5), (28, 1.5, 5)])
    people = mobile.MovingObstacle(mobile.Footprint.disc(0.4), [(0, 9.0, 9.0), (15, 1.0, 1.0)])
    plan = mobile.plan_among_moving(problem, [truck, people], speed=0.8)
    print(plan)
    for t, (x, y) in zip(plan.times, plan.points, strict=True):
        print(f"  {t:7.3f} s  ({x:.3f}, {y:.3f})")
    print(f"  never nearer than {plan.clearance:.3f} m to what moves, which an independent computation says")
    if len(sys.argv) > 1:
        from pin_metaik.mobile import plots

        plots.save(sys.argv[1], lambda figure: plots.draw_timed(figure, plan), plots.size_of(scene))


if __name__ == "__main__":
    main()
