"""Mobile robots: shortest paths among polygons, and time-optimal trajectories along them.

from pin_metaik import mobile

scene = mobile.load_scene("ten_obstacles")          # or your own: mobile.Scene(start, goal, polygons, bounds)
plan = mobile.plan_path(scene)                      # the shortest path, proven free; or "ga", "pso", "de" ...
problem = mobile.PathProblem.of(scene, radius=0.23, margin=0.1)
trajectory = mobile.plan_trajectory(mobile.plan_path(problem).path, mobile.NOMAD_200, scene.obstacles)
"""

# ruff: noqa: E402  # the rooms below import shapely
from pin_metaik.lookup import need

need("planning for mobile robots", "mobile", "shapely")

from pin_metaik.mobile.body import configurations, mobile_robot, velocities
from pin_metaik.mobile.curves.curve import Curve
from pin_metaik.mobile.curves.footprint import Contact, Footprint, first_contact
from pin_metaik.mobile.curves.shortest import shortest_curve
from pin_metaik.mobile.curves.through import curve_through
from pin_metaik.mobile.errors import Blocked, LooksLikeDegrees, NoPath, NoRoom, NoTimedPath, Obstructed
from pin_metaik.mobile.motion.fastest import fastest_trajectory
from pin_metaik.mobile.motion.learned import LearnedTurn, learn_turn, load_turn
from pin_metaik.mobile.motion.replanning import plan_in_motion, replan
from pin_metaik.mobile.motion.result import TrajectoryPlan
from pin_metaik.mobile.motion.route import Route
from pin_metaik.mobile.motion.timing import plan_trajectory
from pin_metaik.mobile.motion.trajectory import Samples, State, Trajectory, load_trajectory
from pin_metaik.mobile.motion.vehicle import (
    NOMAD_200,
    NOMAD_200_DRIVER,
    TURTLEBOT3_BURGER,
    TURTLEBOT3_WAFFLE,
    VEHICLES,
    DifferentialDrive,
    SynchroDrive,
    Vehicle,
    load_vehicle,
)
from pin_metaik.mobile.moving.obstacle import MovingObstacle, load_moving
from pin_metaik.mobile.moving.planning import plan_among_moving
from pin_metaik.mobile.moving.waiting import WaitingPath
from pin_metaik.mobile.paths.exact import shortest_path
from pin_metaik.mobile.paths.fitness import FITNESSES, ExactFitness, Fitness, PaperFitness
from pin_metaik.mobile.paths.homotopy import shortest_paths
from pin_metaik.mobile.paths.path import Path
from pin_metaik.mobile.paths.planners.grid import GridAStar
from pin_metaik.mobile.paths.planners.protocol import Found, PathPlanner
from pin_metaik.mobile.paths.planners.registry import PLANNERS
from pin_metaik.mobile.paths.planners.sampling import RandomTree, Roadmap
from pin_metaik.mobile.paths.planning import path_through, plan_alternatives, plan_path, planner_of
from pin_metaik.mobile.paths.problem import PathProblem
from pin_metaik.mobile.paths.result import PathPlan, PathStatus
from pin_metaik.mobile.paths.visibility import Visibility
from pin_metaik.mobile.ros import nav_path, write_nav_path
from pin_metaik.mobile.world.freespace import FreeSpace
from pin_metaik.mobile.world.grids import OccupancyGrid, grid_of, read_grid
from pin_metaik.mobile.world.polygons import read_obstacles, read_polygons
from pin_metaik.mobile.world.random_scene import random_scene
from pin_metaik.mobile.world.scene import Scene, load_scene, scene_names

__all__ = [
    "FITNESSES",
    "NOMAD_200",
    "NOMAD_200_DRIVER",
    "PLANNERS",
    "TURTLEBOT3_BURGER",
    "TURTLEBOT3_WAFFLE",
    "VEHICLES",
    "Blocked",
    "Contact",
    "Curve",
    "DifferentialDrive",
    "ExactFitness",
    "Fitness",
    "Footprint",
    "Found",
    "FreeSpace",
    "GridAStar",
    "LearnedTurn",
    "LooksLikeDegrees",
    "MovingObstacle",
    "NoPath",
    "NoRoom",
    "NoTimedPath",
    "Obstructed",
    "OccupancyGrid",
    "PaperFitness",
    "Path",
    "PathPlan",
    "PathPlanner",
    "PathProblem",
    "PathStatus",
    "RandomTree",
    "Roadmap",
    "Route",
    "Samples",
    "Scene",
    "State",
    "SynchroDrive",
    "Trajectory",
    "TrajectoryPlan",
    "Vehicle",
    "Visibility",
    "WaitingPath",
    "configurations",
    "curve_through",
    "fastest_trajectory",
    "first_contact",
    "grid_of",
    "learn_turn",
    "load_moving",
    "load_scene",
    "load_trajectory",
    "load_turn",
    "load_vehicle",
    "mobile_robot",
    "nav_path",
    "path_through",
    "plan_alternatives",
    "plan_among_moving",
    "plan_in_motion",
    "plan_path",
    "plan_trajectory",
    "planner_of",
    "random_scene",
    "read_grid",
    "read_obstacles",
    "read_polygons",
    "replan",
    "scene_names",
    "shortest_curve",
    "shortest_path",
    "shortest_paths",
    "velocities",
    "write_nav_path",
]
