"""One good call of everything public: what the sweep of odd arguments starts from.

``CALLS`` has an entry for every function, constructor and method that the public modules offer; where a method is
called, ``OWNERS`` makes its object. Everything is small: a good call takes milliseconds.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin

import pin_metaik as mik
from pin_metaik import (
    collision,
    compare,
    export,
    goals,
    kinematics,
    learn,
    mobile,
    optimize,
    reachable,
    robots,
    stewart,
    timing,
)
from pin_metaik import planning as ompl
from pin_metaik.ik import refine
from pin_metaik.mobile.motion.trajectory import Phase
from pin_metaik.mobile.paths.planners.protocol import LineTests

Arguments = Mapping[str, Any]

MODULES = {
    "mik": mik,
    "collision": collision,
    "optimize": optimize,
    "learn": learn,
    "robots": robots,
    "refine": refine,
    "kinematics": kinematics,
    "stewart": stewart,
    "mobile": mobile,
    "goals": goals,
    "compare": compare,
    "timing": timing,
    "reachable": reachable,
    "export": export,
}
REGISTRIES: dict[str, Mapping[str, Any]] = {
    "ALGORITHMS": optimize.ALGORITHMS,
    "TRAINERS": learn.TRAINERS,
    "FITNESSES": mobile.FITNESSES,
}

X6 = (0.1, -1.0, 1.2, 0.3, 0.5, 0.2)
POSE = pin.SE3(pin.rpy.rpyToMatrix(0.0, np.pi / 2, 0.0), np.array([0.3, 0.3, 0.4]))
FEW = optimize.Budget(evaluations=200)
SQUARE = ((2.0, 2.0), (3.0, 2.0), (3.0, 3.0), (2.0, 3.0))
LEVEL = np.eye(4)
LEVEL[2, 3] = 0.23


def half(x: Any) -> Any:
    """Costs (k,) of points (k, n)."""
    return np.square(x).sum(axis=1)


@cache
def ur5() -> mik.Robot:
    return mik.load_robot("ur5")


@cache
def chain() -> mik.Chain:
    return mik.Chain(ur5().model, "tool0")


@cache
def solved() -> mik.IKResult:
    return mik.solve_ik(chain(), POSE)


@cache
def problem() -> mik.IKProblem:
    return mik.IKProblem.of(chain(), POSE)


@cache
def placed() -> goals.Placed:
    return goals.Placed(chain(), chain().reference)


@cache
def closure() -> pin.PointAnchorConstraintModel:
    """Of the hand and the upper arm of ur5."""
    return pin.PointAnchorConstraintModel(chain().model, 6, pin.SE3.Identity(), 2, pin.SE3.Identity())


def near(**more: Any) -> dict[str, Any]:
    """What all goals take that are about a number within bounds."""
    return {"tolerance": 1e-3, "weight": 2.0, **more}


def seen(**more: Any) -> dict[str, Any]:
    """What all of those take that are about a frame."""
    return near(frame="tool0", reference="shoulder_link", **more)


@cache
def table() -> robots.DHTable:
    return robots.DHTable("arm", "standard", (robots.DHRow(a=1.0), robots.DHRow(a=1.0)))


@cache
def timed() -> mik.TimedPath:
    return mik.time_path(arm(), np.array([[0.0, 0.0], [0.3, 0.5], [1.0, 0.2]]))


@cache
def redundant() -> mik.Chain:
    robot = mik.load_robot("panda")
    return mik.Chain(robot, robot.frame)


@cache
def motions() -> mik.SelfMotions:
    q = redundant().q([0.4, 0.3, -0.2, -1.5, 0.5, 1.8, 0.3])
    return mik.self_motions(redundant(), redundant().placements(q)[0])


def world() -> mik.CollisionWorld:
    made = mik.CollisionWorld(two_links())
    made.add(collision.Obstacle("wall", collision.Box((0.1, 1.0, 1.0)), (1.8, 0.0, 0.0)))
    made.attach("tool", collision.Sphere(0.05), "tip", (0.0, 0.0, 0.1))
    return made


@cache
def two_links() -> mik.Robot:
    model, frame, urdf = planar()
    return mik.Robot("arm", model, frame, robots.Description(urdf, Path("arm.urdf")))


@cache
def planar() -> tuple[pin.Model, str, str]:
    """An arm of two links that are boxes."""
    box = '<geometry><box size="0.8 0.1 0.1"/></geometry>'
    link = f'<collision><origin xyz="0.5 0 0"/>{box}</collision>'
    names = ("base", "upper", "lower", "tip")
    links = "".join(f'<link name="{n}">{link if n in ("upper", "lower") else ""}</link>' for n in names)
    limit = '<axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/>'
    joints = "".join(
        f'<joint name="j{i}" type="{kind}"><parent link="{a}"/><child link="{b}"/><origin xyz="{x} 0 0"/>'
        f"{limit if kind == 'revolute' else ''}</joint>"
        for i, (a, b, x, kind) in enumerate(
            zip(names[:-1], names[1:], (0, 1, 1), ("revolute", "revolute", "fixed"), strict=True)
        )
    )
    urdf = f'<robot name="arm">{links}{joints}</robot>'
    return pin.buildModelFromXML(urdf), "tip", urdf


@cache
def arm() -> mik.Chain:
    return mik.Chain(planar()[0], "tip")


@cache
def adapter() -> ompl.Adapter:
    return ompl.Adapter(arm(), world(), [1.0, 0.2])


@cache
def reached() -> mik.Reachability:
    return mik.reachability(arm(), reachable.Grid((1.0, 0.0, 0.0), (1.5, 0.5, 0.0), 0.5))


def solid_axes() -> Any:
    from matplotlib.figure import Figure

    return Figure().add_subplot(projection="3d")


def asking() -> optimize.AskTell:
    return optimize.AskTell(optimize.Box([-1.0, -1.0], [1.0, 1.0]), "gwo", budget=FEW)


def asked() -> optimize.AskTell:
    search = asking()
    search.ask()
    return search


@cache
def data() -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(0)
    X = rng.uniform(-1.0, 1.0, (40, 2))
    return X, X[:, 0] * X[:, 1]


@cache
def regressor() -> learn.Regressor:
    return learn.fit(*data(), hidden=(2,), iterations=5)


@cache
def mechanism() -> stewart.Mechanism:
    made = stewart.load_mechanism("stroke_100")
    task = stewart.DesignTask(
        made.task.ranges, grid=stewart.Grid((3, 3, 3)), algorithm=optimize.ALGORITHMS["pso"](agents=4), evaluations=8
    )
    return stewart.Mechanism("small", made.geometry, made.limits, stewart.Grid((4, 4, 4)), task=task)


@cache
def servos() -> stewart.Mechanism:
    return stewart.load_mechanism("servo_sg90")


@cache
def workspace() -> stewart.Workspace:
    return mechanism().survey()


@cache
def way() -> stewart.Trajectory:
    end = LEVEL.copy()
    end[0, 3] = 0.02
    return stewart.straight(LEVEL, end, 1.0, 5)


@cache
def moving_legs() -> stewart.Motion:
    return stewart.follow(mechanism().geometry, way(), mechanism().limits)


@cache
def fitness() -> stewart.Fitness:
    return stewart.Fitness(mechanism())


@cache
def point() -> np.ndarray:
    return fitness().variables.point(mechanism().geometry, mechanism().limits)


@cache
def dimensions() -> Any:
    return fitness().variables.dimensions(point())


@cache
def closed() -> stewart.ClosedModel:
    return stewart.closed_model(mechanism())


@cache
def lengths() -> np.ndarray:
    return stewart.leg_lengths(mechanism().geometry, LEVEL)


@cache
def scene() -> mobile.Scene:
    return mobile.Scene((0.0, 0.0), (5.0, 4.0), [SQUARE], (-1.0, -1.0, 6.0, 6.0))


@cache
def planning() -> mobile.PathProblem:
    return mobile.PathProblem.of(scene(), 0.2, 0.1)


@cache
def path() -> mobile.Path:
    return planning().optimum


@cache
def route() -> mobile.Route:
    return mobile.Route.along(path(), mobile.NOMAD_200, scene().obstacles)


@cache
def motion() -> mobile.TrajectoryPlan:
    return mobile.plan_trajectory(path(), mobile.NOMAD_200, scene().obstacles)


def curve() -> mobile.Curve:
    return mobile.shortest_curve((0.0, 0.0, 0.0), (2.0, 1.0, 1.0), 0.5)


@cache
def mover() -> mobile.MovingObstacle:
    return mobile.MovingObstacle(mobile.Footprint.disc(0.2), [(0.0, 1.0, 0.0), (5.0, 1.0, 4.0)])


@cache
def waiting() -> mobile.WaitingPath:
    return mobile.plan_among_moving(planning(), [mover()], 1.0, cells=0)


def tests() -> LineTests:
    return LineTests(planning().space, FEW, None, lambda: None)


def routing() -> dict[str, Any]:
    return {"problem": planning(), "tests": tests(), "rng": rng()}


def saved_network() -> Path:
    learn.save_regressor(regressor(), "network.npz")
    return Path("network.npz")


def saved_turn() -> Path:
    turn().save("turn.npz")
    return Path("turn.npz")


def saved_trajectory() -> Path:
    return written("trajectory.json", json.dumps(motion().as_dict(), allow_nan=False))


@cache
def comparison() -> compare.PlannerComparison:
    return compare.compare_planners(planning(), ["exact", "ga"], 1, via=2, budget=FEW)


def turn() -> mobile.LearnedTurn:
    return mobile.learn_turn(mobile.NOMAD_200, hidden=(2,), iterations=3)


@cache
def task() -> compare.Task:
    return compare.Task.at(chain(), np.array([X6]))


def trial(target: int = 0) -> compare.Trial:
    return compare.Trial("ur5", "random", "lm", target, 0, 100, solved=True, met=True, evaluations=9, seconds=0.1)


def suite() -> compare.Suite:
    return compare.Suite(("ur5",), ("random",), ("lm",), tasks=1, seeds=1, budget=50)


@cache
def folder() -> Path:
    """A finished comparison, in the folder one is in."""
    made = Path("comparison")
    compare.compare(suite(), made)
    return made


@cache
def results() -> compare.Results:
    return compare.read_results(folder())


@cache
def figure() -> Any:
    from matplotlib.figure import Figure

    return Figure()


def rng() -> np.random.Generator:
    return np.random.default_rng(0)


def written(name: str, text: str) -> Path:
    """A file in the folder one is in."""
    path = Path(name)
    path.write_text(text, encoding="utf-8")
    return path


TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
DH = """name = "arm"
convention = "standard"
length = "m"
angle = "rad"
[parameters]
l = 1.0
[[joint]]
a = "l"
alpha = 0
d = 0
limits = [-1, 1]
"""

LIMITS = {
    "lower": np.full(6, -3.0),
    "upper": np.full(6, 3.0),
    "velocity": np.full(6, 1.0),
    "rotates": np.full(6, True),
    "multi_turn": np.full(6, False),
    "names": tuple("abcdef"),
}

OWNERS: dict[str, Callable[[], Any]] = {
    "mik.DLS": mik.DLS,
    "mik.AskTell": asking,
    "mik.AskTell.tell": asked,
    "mik.Box": lambda: optimize.Box([-1.0, -1.0], [1.0, 1.0]),
    "mik.Chain": chain,
    "mik.CollisionWorld": world,
    "mik.IKProblem": problem,
    "mik.IKResult": solved,
    "compare.Outcome": lambda: compare.Outcome(Path("folder"), 1, 2, 1, 0, 0.5),
    "compare.Summary": lambda: compare.Summary(2, 1, (10.0, 20.0), None, 0, 0),
    "learn.Clusters": lambda: learn.fuzzy_c_means(data()[0], 2),
    "learn.Training": lambda: regressor().training,
    "mik.IKChoice": lambda: mik.solve_ik_any(chain(), [POSE]),
    "mik.Reachability": reached,
    "mik.BasePlacement": lambda: mik.place_base(arm(), [[1.2, 0.3, 0.0]], budget=optimize.Budget(evaluations=20)),
    "mik.IKBatch": lambda: mik.solve_ik_batch(chain(), [POSE], workers=1),
    "mik.Follower": lambda: mik.Follower(chain()),
    "mik.FollowerStep": lambda: mik.Follower(chain()).step(POSE, X6),
    "mik.IKPath": lambda: mik.solve_ik_path(chain(), [POSE]),
    "mik.IKPath.timed": lambda: mik.solve_ik_path(chain(), [POSE, (0.3, 0.3, 0.42)]),
    "mik.TimedPath": timed,
    "mik.IKSolutions": lambda: mik.solve_ik_all(chain(), POSE),
    "optimize.Result": lambda: optimize.minimize(half, optimize.Box([-1.0], [1.0]), "de", FEW),
    "stewart.Designed": lambda: stewart.design(mechanism()),
    "stewart.TypeDesign": lambda: stewart.compare_types(mechanism(), ["6x6"])[0],
    "mik.SelfMotionCurve": lambda: motions().curves[0],
    "mik.SelfMotions": lambda: motions(),
    "mik.IKSolver": lambda: mik.IKSolver(budget=FEW),
    "mik.Limits": lambda: chain().limits,
    "mik.Search": lambda: optimize.Search(optimize.Box([0.0], [1.0]), rng(), np.empty((0, 1)), FEW),
    "mik.Target": lambda: mik.Target(POSE),
    "goals.CentreOfMass": lambda: goals.CentreOfMass(least=0.0),
    "goals.FramePose": lambda: goals.FramePose("tool0", POSE),
    "goals.Loop": lambda: goals.Loop(closure()),
    "goals.MidRange": lambda: goals.MidRange(0.5),
    "goals.Placed": placed,
    "goals.Posture": lambda: goals.Posture({"elbow_joint": 0.0}),
    "collision.Box": lambda: collision.Box((1.0, 1.0, 1.0)),
    "collision.Capsule": lambda: collision.Capsule(0.1, 1.0),
    "collision.Cone": lambda: collision.Cone(0.1, 1.0),
    "collision.Cylinder": lambda: collision.Cylinder(0.1, 1.0),
    "collision.HalfSpace": collision.HalfSpace,
    "collision.Mesh": lambda: collision.Mesh.read(written("tetra.obj", TRIANGLE)),
    "collision.HeightField": lambda: collision.HeightField((1.0, 1.0), [[0.0, 0.1], [0.1, 0.2]], -0.1),
    "collision.Octree": lambda: collision.Octree([[0.0, 0.0, 0.0], [0.1, 0.0, 0.0]], 0.05),
    "collision.Plane": collision.Plane,
    "collision.PointCloud": lambda: collision.PointCloud([[0.0, 0.0, 0.0], [0.1, 0.0, 0.0]], 0.05),
    "collision.Move": lambda: world().first_contact([1.0, 0.2], [0.1, 0.2]),
    "collision.Sphere": lambda: collision.Sphere(0.1),
    "learn.Network": lambda: learn.Network(2, (2,)),
    "learn.Regressor": regressor,
    "robots.Description": lambda: robots.Description(planar()[2], Path("arm.urdf")),
    "robots.DHTable": table,
    "refine.LM": refine.LM,
    "refine.QP": refine.QP,
    "refine.SDLS": refine.SDLS,
    "refine.Newton": refine.Newton,
    "refine.Transpose": refine.Transpose,
    "stewart.ClosedModel": closed,
    "stewart.Fitness": fitness,
    "stewart.LegLimits": lambda: mechanism().limits,
    "stewart.Mechanism": mechanism,
    "stewart.ServoLimits": lambda: servos().limits,
    "stewart.Servos": lambda: servos().geometry.servos,
    "stewart.Trajectory": way,
    "stewart.Workspace": workspace,
    "mobile.Curve": curve,
    "mobile.DifferentialDrive": lambda: mobile.TURTLEBOT3_BURGER,
    "mobile.Footprint": lambda: mobile.Footprint.rectangle(0.5, 0.3),
    "mobile.SynchroDrive": lambda: mobile.NOMAD_200,
    "mobile.MovingObstacle": mover,
    "mobile.WaitingPath": waiting,
    "mobile.GridAStar": lambda: mobile.GridAStar(5),
    "mobile.RandomTree": mobile.RandomTree,
    "mobile.Roadmap": mobile.Roadmap,
    "compare.PlannerComparison": comparison,
    "mobile.ExactFitness": mobile.ExactFitness,
    "mobile.PaperFitness": mobile.PaperFitness,
    "mobile.FreeSpace": lambda: planning().space,
    "mobile.LearnedTurn": turn,
    "mobile.OccupancyGrid": lambda: mobile.grid_of(np.eye(3)),
    "mobile.Path": path,
    "mobile.PathPlan": lambda: mobile.plan_path(planning()),
    "mobile.PathProblem": planning,
    "mobile.Route": route,
    "mobile.Scene": scene,
    "mobile.Trajectory": lambda: motion().trajectory,
    "mobile.TrajectoryPlan": motion,
    "mobile.Visibility": lambda: planning().visibility,
    "compare.Case": lambda: compare.CASES["random"],
    "compare.Replay": lambda: compare.replay(folder(), "ur5/random/0/lm/0"),
    "compare.Results": results,
    "compare.Search": lambda: compare.Search("lm", None, "lm_chan"),
    "compare.Suite": suite,
    "compare.Task": task,
    "compare.Trial": trial,
}

REFINE = {"starts": np.array([X6]), "evaluations": 50}


def refining() -> Arguments:
    return {"problem": problem(), **REFINE}


# What a search is allowed is the caller's own time: a huge number there is a long search, not a fault.
PATIENT = {"evaluations", "iterations", "budget", "targets", "seeds", "samples", "seconds", "cells", "starts"}

CALLS: dict[str, Callable[[], Arguments]] = {
    # mik
    "mik.DLS": lambda: {"damping": 0.005, "iterations": 100},
    "mik.DLS.descent": dict,
    "mik.DLS.refine": refining,
    "mik.DLS.refine_anywhere": refining,
    "mik.DLS.settle": lambda: {"problem": problem(), "x": np.array(X6), "evaluations": 50},
    "mik.AskTell": lambda: {
        "box": optimize.Box([-1.0], [1.0]),
        "algorithm": "gwo",
        "rng": 0,
        "seeds": [0.5],
        "budget": FEW,
        "keep": 1,
    },
    "mik.AskTell.ask": dict,
    "mik.AskTell.tell": lambda: {"costs": np.zeros(30)},
    "mik.AskTell.stop": dict,
    "mik.Box": lambda: {"lower": [-1.0], "upper": [1.0]},
    "mik.Box.sample": lambda: {"rng": rng(), "count": 3},
    "mik.Box.clip": lambda: {"X": np.zeros((3, 2))},
    "mik.Box.halfway": lambda: {"X": np.zeros((3, 2)), "origin": np.zeros((3, 2))},
    "mik.Box.contains": lambda: {"X": np.zeros((3, 2))},
    "mik.Box.contains_all": lambda: {"X": np.zeros((3, 2))},
    "mik.Budget": lambda: {"evaluations": 100, "seconds": 1.0, "target": 1e-3},
    "mik.Chain": lambda: {
        "model": ur5().model,
        "frame": "tool0",
        "locked": ["elbow_joint"],
        "limits": {"wrist_1_joint": (-1.0, 1.0)},
        "reference": np.zeros(6),
    },
    "mik.Chain.at": lambda: {"q": X6},
    "mik.Chain.q": lambda: {"x": X6, "q0": np.zeros(6)},
    "mik.Chain.x": lambda: {"q": X6},
    "mik.Chain.unwrapped": lambda: {"Q": np.zeros((2, 6))},
    "mik.Chain.configuration": lambda: {"q": X6},
    "mik.Chain.tangent": lambda: {"x": np.array(X6)},
    "mik.Chain.keeps_limits": lambda: {"q": np.array(X6)},
    "mik.Chain.inside": lambda: {"q": np.array(X6)},
    "mik.Chain.branches": lambda: {"pose": POSE.homogeneous, "x0": np.array(X6)},
    "mik.Chain.sample": lambda: {"count": 3, "seed": (0, 1)},
    "mik.Chain.reach": lambda: {"tip": 0, "oriented": True},
    "mik.Chain.placements": lambda: {"q": np.array(X6)},
    "mik.Chain.poses": lambda: {"X": [X6]},
    "mik.CollisionWorld": lambda: {
        "robot": two_links(),
        "obstacles": [],
        "margin": 0.0,
        "srdf": None,
        "simplify": "none",
        "exact": True,
        "padding": {"upper": 0.01, "lower": 0.02},
        "visual": True,
        "watch": None,
    },
    "mik.CollisionWorld.add": lambda: {"obstacle": collision.Obstacle("ball", collision.Sphere(0.1), (3.0, 0.0, 0.0))},
    "mik.CollisionWorld.move": lambda: {"name": "wall", "pose": (1.9, 0.0, 0.0)},
    "mik.CollisionWorld.remove": lambda: {"name": "wall"},
    "mik.CollisionWorld.attach": lambda: {
        "name": "ball",
        "shape": collision.Sphere(0.1),
        "frame": "tip",
        "pose": (0.0, 0.0, 0.1),
        "touching": ["wall"],
        "padding": 0.01,
    },
    "mik.CollisionWorld.detach": lambda: {"name": "tool", "q": [0.1, 0.2]},
    "mik.CollisionWorld.allow": lambda: {"first": "upper", "second": "wall", "reason": "User"},
    "mik.CollisionWorld.check": lambda: {"first": "upper", "second": "wall"},
    "mik.CollisionWorld.write_srdf": lambda: {"path": "written.srdf"},
    "mik.CollisionWorld.in_collision": lambda: {"q": [0.1, 0.2]},
    "mik.CollisionWorld.pairs_in_collision": lambda: {"q": [0.1, 0.2]},
    "mik.CollisionWorld.min_distance": lambda: {"q": [0.1, 0.2], "of": world().obstacles[0].name},
    "mik.CollisionWorld.in_collision_batch": lambda: {"Q": [[0.1, 0.2]], "workers": 1},
    "mik.CollisionWorld.min_distance_batch": lambda: {"Q": [[0.1, 0.2]], "workers": 1},
    "mik.CollisionWorld.clear_between": lambda: {"q0": [1.0, 0.2], "q1": [1.2, 0.4], "resolution": 1e-3},
    "mik.CollisionWorld.first_contact": lambda: {"q0": [1.0, 0.2], "q1": [0.1, 0.2], "resolution": 1e-3},
    "mik.CollisionWorld.clear_between_batch": lambda: {
        "Q0": [[1.0, 0.2]],
        "Q1": [[1.2, 0.4]],
        "resolution": 1e-3,
        "workers": 1,
    },
    "mik.CollisionWorld.first_contact_batch": lambda: {
        "Q0": [[1.0, 0.2]],
        "Q1": [[0.1, 0.2]],
        "resolution": 1e-3,
        "workers": 1,
    },
    "mik.IKProblem.of": lambda: {"chain": chain(), "target": POSE, "world": None},
    "mik.IKProblem.at": lambda: {"q": X6},
    "mik.IKProblem.linearize": lambda: {"x": np.array(X6)},
    "mik.IKProblem.branches": lambda: {"x0": np.array(X6)},
    "mik.IKProblem.boxes": lambda: {"t": 0, "least": 1e-3, "shrink": False},
    "mik.IKProblem.gaps": lambda: {"t": 0},
    "mik.IKProblem.nearest_turns": lambda: {"X": np.array([X6]), "x0": np.array(X6)},
    "mik.IKProblem.near": lambda: {"count": 3},
    "mik.IKProblem.costs": lambda: {"X": np.array([X6])},
    "mik.IKProblem.verdict": lambda: {"q": np.array(X6)},
    "mik.IKProblem.placed": lambda: {"x": np.array(X6)},
    "mik.IKProblem.outcomes": lambda: {"q": np.array(X6)},
    "mik.IKProblem.accepts": lambda: {"q": np.array(X6)},
    "mik.IKResult.verify": dict,
    "compare.Outcome.as_dict": dict,
    "compare.Summary.as_dict": dict,
    "learn.Clusters.as_dict": dict,
    "learn.Training.as_dict": dict,
    "mik.IKBatch.as_dict": dict,
    "mik.IKPath.as_dict": dict,
    "mik.IKPath.timed": lambda: {"velocity": 1.0, "acceleration": [5.0] * 6, "jerk": None},
    "mik.Follower": lambda: {
        "chain": arm(),
        "rate": 200.0,
        "limits": mik.MotionLimits.of(arm()),
        "world": world(),
        "posture": [0.0, 0.5],
        "clearance": 0.02,
    },
    "mik.FollowerStep.as_dict": dict,
    "mik.Follower.step": lambda: {"target": POSE, "q": X6},
    "mik.Follower.move": lambda: {"goal": [0.0] * 6, "q": X6},
    "mik.Follower.stop": lambda: {"q": X6},
    "mik.Follower.reset": dict,
    "mik.Follower.switch": lambda: {"target": POSE, "q": X6, "rng": 0},
    "mik.MotionLimits": lambda: {"velocity": np.ones(2), "acceleration": np.ones(2), "jerk": np.ones(2)},
    "mik.MotionLimits.of": lambda: {"chain": arm(), "velocity": 1.0, "acceleration": [2.0, 3.0], "jerk": 50.0},
    "mik.time_path": lambda: {
        "chain": arm(),
        "q": [[0.0, 0.0], [0.3, 0.5]],
        "velocity": 1.0,
        "acceleration": [2.0, 3.0],
        "jerk": 50.0,
    },
    "mik.TimedPath.sample": lambda: {"every": 0.1},
    "mik.TimedPath.at": lambda: {"t": [0.0, 0.1]},
    "mik.TimedPath.as_dict": lambda: {"every": 0.1},
    "mik.TimedPath.write_csv": lambda: {"file": "timed.csv", "every": 0.1},
    "mik.TimedPath.joint_trajectory": lambda: {"every": 0.1, "frame": "base", "stamp": 1.0},
    "mik.TimedPath.write_joint_trajectory": lambda: {"file": "timed.json", "every": 0.1, "frame": "", "stamp": 0.0},
    "mik.TimedPath.plot": lambda: {"file": "timed.svg"},
    "timing.draw_timed": lambda: {"timed": timed()},
    "mik.IKResult.as_dict": dict,
    "mik.IKSolutions.as_dict": dict,
    "mik.IKSolutions.best": lambda: {"criterion": "nearest", "q0": chain().reference},
    "mik.SelfMotionCurve.as_dict": dict,
    "mik.SelfMotionCurve.best": lambda: {"criterion": "nearest"},
    "mik.SelfMotionCurve.free": lambda: {"world": mik.CollisionWorld(mik.load_robot("panda")), "step": 1.0},
    "mik.SelfMotionCurve.nearest": lambda: {"q": motions().curves[0].base, "weights": {}},
    "mik.SelfMotionCurve.q": lambda: {"t": 0.1},
    "mik.SelfMotionCurve.sample": lambda: {"step": 0.5},
    "mik.SelfMotions.as_dict": dict,
    "mik.SelfMotions.best": lambda: {"criterion": "limits"},
    "mik.SelfMotions.nearest": lambda: {"q": motions().curves[0].base, "weights": {}},
    "mik.gravity_torque": lambda: {"chain": chain(), "payload": 1.0, "at": (0.0, 0.0, 0.1)},
    "mik.self_motions": lambda: {
        "chain": redundant(),
        "target": redundant().placements(redundant().reference)[0].homogeneous,
        "q0": redundant().reference,
        "resolution": 1.0,
        "budget": FEW,
        "watch": None,
    },
    "optimize.Result.as_dict": dict,
    "stewart.Designed.as_dict": dict,
    "stewart.TypeDesign.as_dict": dict,
    "stewart.Workspace.as_dict": dict,
    "mik.IKSolver": lambda: {
        "seeder": "gwo",
        "refiner": "dls",
        "budget": FEW,
        "starts": 3,
        "select": "first",
        "patience": 1_000,
        "trace": False,
    },
    "mik.IKSolver.solve": lambda: {"problem": problem(), "q0": X6, "rng": 0},
    "mik.IKSolver.search": lambda: {"problem": problem(), "q0": X6, "rng": 0, "first": None},
    "mik.Limits": lambda: dict(LIMITS),
    "mik.Limits.bound": lambda: {
        "leader": "elbow_joint",
        "line": (2.0, 0.1),
        "follower": "finger",
        "span": (-1.0, 1.0),
    },
    "mik.Limits.box": dict,
    "mik.Limits.one_turn": dict,
    "mik.Limits.clip": lambda: {"x": np.array(X6)},
    "mik.Limits.nearest_turns": lambda: {"x": np.array(X6), "x0": np.array(X6)},
    "mik.Limits.separation": lambda: {"a": np.array(X6), "b": np.array(X6)},
    "mik.Limits.way": lambda: {"a": np.array(X6), "b": np.array(X6)},
    "mik.Limits.contains": lambda: {"x": np.array(X6), "tolerance": 0.0},
    "mik.Limits.replace": lambda: {"limits": {"elbow_joint": (-1.0, 1.0)}},
    "mik.Search": lambda: {
        "space": optimize.Box([0.0], [1.0]),
        "rng": rng(),
        "seeds": np.empty((0, 1)),
        "budget": FEW,
    },
    "mik.Search.start": lambda: {"count": 3},
    "mik.Target": lambda: {
        "pose": POSE,
        "frame": None,
        "position_tolerance": 1e-5,
        "orientation_tolerance": (1e-3, 1e-3, 1e-3),
        "position_weight": 1.0,
        "orientation_weight": 1.0,
    },
    "mik.Target.at": lambda: {"xyz": (0.3, 0.3, 0.4), "frame": None, "tolerance": 1e-5},
    "mik.Target.facing": lambda: {"rotation": np.eye(3), "frame": None, "tolerance": 1e-5},
    "mik.Target.of": lambda: {"target": POSE},
    "mik.Target.residual": lambda: {"at": placed()},
    "mik.Target.met": lambda: {"at": placed()},
    "mik.Target.jacobian": lambda: {"at": placed()},
    "mik.Target.off": lambda: {"at": placed()},
    "goals.CentreOfMass": lambda: near(polygon=SQUARE, margin=0.1, least=0.0, most=2.0),
    "goals.CentreOfMass.check": lambda: {"chain": chain()},
    "goals.Custom": lambda: near(function=np.sum, derivative=np.sum, least=0.0, most=1.0),
    "goals.Distance": lambda: seen(point=(0.3, 0.3, 0.4), least=0.1, most=0.2),
    "goals.FramePose": lambda: {
        "frame": "tool0",
        "pose": POSE,
        "reference": "shoulder_link",
        "position_tolerance": 1e-5,
        "orientation_tolerance": (1e-3, 1e-3, 1e-3),
        "position_weight": 1.0,
        "orientation_weight": 1.0,
    },
    "goals.FramePose.at": lambda: {
        "frame": "tool0",
        "xyz": (0.3, 0.3, 0.4),
        "reference": "shoulder_link",
        "tolerance": 1e-5,
    },
    "goals.FramePose.check": lambda: {"chain": chain()},
    "goals.InBox": lambda: seen(lower=(0.0, 0.0, 0.0), upper=(1.0, 1.0, 1.0), pose=POSE),
    "goals.LookAt": lambda: seen(point=(0.3, 0.3, 0.4), axis="z"),
    "goals.Loop": lambda: {"closure": closure(), "position_tolerance": 1e-3, "orientation_tolerance": 1e-3},
    "goals.Loop.ends": lambda: {"model": chain().model},
    "goals.Loop.check": lambda: {"chain": chain()},
    "goals.Manipulability": lambda: seen(least=0.1, of="pose"),
    "goals.MidRange": lambda: near(share=0.5),
    "goals.MidRange.check": lambda: {"chain": chain()},
    "goals.OnLine": lambda: seen(point=(0.3, 0.3, 0.4), direction=(1.0, 0.0, 0.0), least=0.0, most=1.0),
    "goals.OnPlane": lambda: seen(point=(0.3, 0.3, 0.4), normal="z", least=0.0, most=1.0),
    "goals.Placed": lambda: {"chain": chain(), "q": np.array(X6)},
    "goals.Placed.pose": lambda: {"frame": "tool0", "reference": "shoulder_link"},
    "goals.Placed.jacobian": lambda: {"frame": "tool0", "reference": "shoulder_link"},
    "goals.Pointing": lambda: seen(axis="z", direction=(0.0, 0.0, -1.0)),
    "goals.Posture": lambda: near(joints={"elbow_joint": 0.5}),
    "goals.Posture.check": lambda: {"chain": chain()},
    "goals.Wish": lambda: {"goal": goals.MidRange(0.5), "weight": 2.0},
    "mik.Target.judge": lambda: {"placement": POSE},
    "mik.load_robot": lambda: {
        "name": "rv7fl",
        "parameters": None,
        "free_flyer": False,
        "planar": False,
        "mimic": True,
    },
    "mik.minimize": lambda: {
        "objective": half,
        "box": optimize.Box([-1.0], [1.0]),
        "algorithm": "gwo",
        "budget": FEW,
        "rng": 0,
        "seeds": [0.5],
        "trace": True,
        "watch": None,
        "keep": 2,
    },
    "mik.robot_names": dict,
    "mik.solve_ik": lambda: {
        "chain": chain(),
        "target": POSE,
        "q0": X6,
        "solver": mik.IKSolver(budget=FEW),
        "world": None,
        "rng": 0,
    },
    "mik.Weighted": lambda: {"criterion": "nearest", "joints": {chain().names[0]: 3.0}},
    "mik.solve_ik_all": lambda: {
        "chain": chain(),
        "target": POSE,
        "q0": X6,
        "limit": 4,
        "apart": 0.01,
        "solver": None,
        "budget": FEW,
        "certify": True,
        "world": None,
        "rng": 0,
        "watch": None,
    },
    "mik.solve_ik_all_batch": lambda: {
        "chain": chain(),
        "targets": [POSE, POSE],
        "q0": X6,
        "limit": 4,
        "apart": 0.01,
        "solver": None,
        "budget": FEW,
        "certify": True,
        "world": None,
        "workers": 1,
        "rng": 0,
        "watch": None,
    },
    "export.exported": lambda: {"chain": chain(), "language": "c"},
    "export.write_export": lambda: {"chain": chain(), "path": "arm.c"},
    "mik.solve_ik_batch": lambda: {
        "chain": chain(),
        "targets": [POSE, POSE],
        "q0": X6,
        "solver": mik.IKSolver(budget=FEW),
        "world": None,
        "workers": 1,
        "rng": 0,
        "watch": None,
    },
    "mik.solve_ik_path": lambda: {
        "chain": arm(),
        "targets": [[1.2, 0.3, 0.0], [1.2, 0.4, 0.0]],
        "q0": [0.1, 0.2],
        "max_step": 0.3,
        "solver": mik.IKSolver(budget=FEW),
        "world": None,
        "reconfigure": False,
        "rng": 0,
        "watch": None,
    },
    "mik.IKChoice.as_dict": dict,
    "mik.solve_ik_any": lambda: {
        "chain": arm(),
        "targets": [[1.2, 0.3, 0.0], [1.2, 0.4, 0.0]],
        "q0": [0.1, 0.2],
        "solver": mik.IKSolver(budget=FEW),
        "world": None,
        "rng": 0,
        "watch": None,
    },
    # reachable
    "mik.Reachability.as_dict": dict,
    "mik.Reachability.at": lambda: {"xyz": [1.2, 0.3, 0.0]},
    "mik.Reachability.save": lambda: {"path": "map.npz"},
    "mik.Reachability.load": lambda: {"path": reached().save("map.npz")},
    "mik.Reachability": lambda: {
        "positions": np.zeros((1, 3)),
        "orientations": np.eye(3)[None],
        "status": np.zeros((1, 1), np.uint8),
        "manipulability": np.zeros((1, 1), np.float32),
        "shape": (1, 1, 1),
        "seconds": 0.0,
    },
    "mik.reachability": lambda: {
        "chain": arm(),
        "grid": [[1.2, 0.3, 0.0]],
        "orientations": None,
        "q0": [0.1, 0.2],
        "solver": mik.IKSolver(budget=FEW),
        "world": None,
        "jobs": None,
        "backend": "loky",
        "scheduler": None,
        "folder": None,
        "rng": 0,
        "watch": None,
    },
    "mik.BasePlacement.as_dict": dict,
    "mik.place_base": lambda: {
        "chain": arm(),
        "targets": [[1.2, 0.3, 0.0]],
        "region": mik.Box([0.0, 0.0, -1.0], [1.0, 1.0, 1.0]),
        "q0": [0.1, 0.2],
        "solver": mik.IKSolver(budget=FEW),
        "world": None,
        "algorithm": "de",
        "budget": optimize.Budget(evaluations=20),
        "rng": 0,
        "watch": None,
    },
    "reachable.Grid": lambda: {"lower": (1.0, 0.0, 0.0), "upper": (1.5, 0.5, 0.0), "spacing": 0.5},
    "reachable.Grid.around": lambda: {"chain": arm(), "spacing": 0.5},
    "reachable.spread_rotations": lambda: {"count": 3},
    "reachable.draw_reachability": lambda: {"figure": figure(), "found": reached(), "slices": 1},
    "reachable.save_reachability": lambda: {"found": reached(), "path": "map.png", "slices": 1},
    # collision
    "collision.Box": lambda: {"size": (1.0, 1.0, 1.0)},
    "collision.Box.geometry": dict,
    "collision.Capsule": lambda: {"radius": 0.1, "length": 1.0},
    "collision.Capsule.geometry": dict,
    "collision.Cone": lambda: {"radius": 0.1, "length": 1.0},
    "collision.Cone.geometry": dict,
    "collision.Cylinder": lambda: {"radius": 0.1, "length": 1.0},
    "collision.Cylinder.geometry": dict,
    "collision.HalfSpace": lambda: {"normal": (0.0, 0.0, 1.0), "offset": 0.0},
    "collision.HalfSpace.geometry": dict,
    "collision.Plane": lambda: {"normal": (0.0, 0.0, 1.0), "offset": 0.0},
    "collision.Plane.geometry": dict,
    "collision.Sphere": lambda: {"radius": 0.1},
    "collision.Sphere.geometry": dict,
    "collision.draw_world": lambda: {
        "axes": solid_axes(),
        "world": world(),
        "Q": [[1.0, 0.2]],
        "targets": [(0.1, 0.2, 0.3)],
    },
    "collision.save_world": lambda: {
        "path": "world.png",
        "world": world(),
        "Q": [[1.0, 0.2]],
        "targets": [(0.1, 0.2, 0.3)],
    },
    "collision.Move.at": lambda: {"fraction": 0.5},
    "collision.Move.as_dict": dict,
    "collision.Mesh": lambda: {
        "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
        "triangles": [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]],
        "name": "tetra",
    },
    "collision.Mesh.read": lambda: {"path": written("tetra.obj", TRIANGLE), "scale": 1.0},
    "collision.Mesh.geometry": dict,
    "collision.HeightField": lambda: {"size": (1.0, 1.0), "heights": [[0.0, 0.1], [0.1, 0.2]], "base": -0.1},
    "collision.HeightField.geometry": dict,
    "collision.Octree": lambda: {"points": [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0]], "resolution": 0.05},
    "collision.Octree.cells": dict,
    "collision.Octree.geometry": dict,
    "collision.PointCloud": lambda: {"points": [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0]], "radius": 0.05},
    "collision.PointCloud.geometry": dict,
    "collision.Obstacle": lambda: {
        "name": "ball",
        "shape": collision.Sphere(0.1),
        "pose": (0.0, 0.0, 1.0),
        "touching": ("base",),
        "padding": {"upper": 0.01},
    },
    "collision.load_scene": lambda: {"source": "table"},
    "collision.scene_names": dict,
    # optimize
    "optimize.make": lambda: {"algorithm": "gwo"},
    # learn
    "learn.Network": lambda: {"inputs": 2, "hidden": (3, 3)},
    "learn.Network.initial": lambda: {"rng": 0},
    "learn.Network.outputs": lambda: {"w": np.zeros(9), "X": data()[0]},
    "learn.Network.jacobian": lambda: {"w": np.zeros(9), "X": data()[0]},
    "learn.Network.gradient": lambda: {"w": np.zeros(9), "X": data()[0], "y": data()[1]},
    "learn.Regressor.predict": lambda: {"X": data()[0]},
    "learn.Regressor.covers": lambda: {"X": data()[0]},
    "learn.Regressor.__call__": lambda: {"X": data()[0]},
    "learn.fit": lambda: {
        "X": data()[0],
        "y": data()[1],
        "hidden": (2,),
        "trainer": "lm",
        "iterations": 3,
        "rng": 0,
        "watch": None,
    },
    "learn.fuzzy_c_means": lambda: {
        "Z": data()[0],
        "clusters": 2,
        "m": 2.0,
        "iterations": 5,
        "tolerance": 1e-6,
        "rng": 0,
        "start": [[0.0, 0.0], [1.0, 1.0]],
        "watch": None,
    },
    "learn.make_trainer": lambda: {"trainer": "lm"},
    "learn.memberships": lambda: {"Z": data()[0], "centres": [[0.0, 0.0], [1.0, 1.0]], "m": 2.0},
    "learn.train": lambda: {
        "trainer": "lm",
        "network": learn.Network(2, (2,)),
        "X": data()[0],
        "y": data()[1],
        "w": np.full(9, 0.1),
        "iterations": 3,
        "watch": None,
    },
    # robots
    "robots.DHRow": lambda: {
        "a": 1.0,
        "alpha": 0.0,
        "d": 0.0,
        "theta": 0.0,
        "type": "revolute",
        "lower": -1.0,
        "upper": 1.0,
        "velocity": 1.0,
        "effort": 1.0,
        "name": "j",
    },
    "robots.DHTable": lambda: {
        "name": "arm",
        "convention": "standard",
        "rows": (robots.DHRow(a=1.0),),
        "base": robots.Placement(),
        "tool": robots.Placement(),
        "description": "",
        "source": "",
    },
    "robots.DHTable.frames": lambda: {"q": [0.1, 0.2]},
    "robots.DHTable.fk": lambda: {"q": [0.1, 0.2]},
    "robots.Description": lambda: {"text": planar()[2], "source": None, "base": "fixed", "mimic": True},
    "robots.Description.free_mimics": dict,
    "robots.Description.loops": dict,
    "robots.Description.geometry": lambda: {"model": planar()[0], "shapes": "collision"},
    "robots.Description.read": dict,
    "robots.Description.tree": dict,
    "robots.Description.model": dict,
    "robots.description_of": lambda: {"model": planar()[0]},
    "robots.Placement": lambda: {"xyz": (0.0, 0.0, 0.0), "rpy": (0.0, 0.0, 0.0)},
    "robots.RobotName": lambda: {"name": "ur5", "source": "example-robot-data", "dof": 6, "frame": "tool0"},
    "robots.read_table": lambda: {"path": written("arm.toml", DH), "parameters": {"l": 2.0}},
    "robots.to_urdf": lambda: {"table": table()},
    "robots.write_urdfs": lambda: {"folder": "urdf"},
    # refiners
    "refine.LM": lambda: {"rule": "chan", "scale": None, "patience": refine.Patience()},
    "refine.LM.refine": refining,
    "refine.QP": lambda: {
        "solver": "osqp",
        "damping": 0.02,
        "largest": 1.0,
        "posture": None,
        "posture_weight": 0.02,
        "tolerance": 1e-5,
        "patience": refine.Patience(),
    },
    "refine.QP.refine": refining,
    "refine.SDLS": lambda: {"largest": 0.7, "patience": refine.Patience()},
    "refine.SDLS.refine": refining,
    "refine.Newton": lambda: {"cutoff": 1e-3, "patience": refine.Patience()},
    "refine.Newton.refine": refining,
    "refine.Patience": lambda: {"iterations": 10, "steps": 4, "share": 0.5},
    "refine.Transpose": lambda: {"patience": refine.Patience(2000, 50, 0.8)},
    "refine.Transpose.refine": refining,
    "refine.make_refiner": lambda: {"refiner": "dls"},
    # stewart
    "stewart.ClosedModel.leg": lambda: {"i": 0},
    "stewart.ClosedModel.configuration": lambda: {"pose": LEVEL},
    "stewart.ClosedModel.pose": lambda: {"q": closed().configuration(LEVEL)},
    "stewart.ClosedModel.residual": lambda: {"q": closed().configuration(LEVEL)},
    "stewart.ClosedModel.forward": lambda: {"coordinates": lengths(), "start": LEVEL},
    "stewart.ClosedModel.rates": lambda: {"pose": LEVEL},
    "stewart.DesignTask": lambda: {
        "ranges": stewart.Ranges(longest=(0.2, 0.3)),
        "index": "gdi",
        "threshold": 0.5,
        "weights": (0.7, 0.3),
        "cube": None,
        "least_workspace": 0.0,
        "joint_gap": 0.0,
        "grid": stewart.Grid((3, 3, 3)),
        "algorithm": "pso",
        "evaluations": 60,
        "seed": 0,
        "from_current": False,
    },
    "stewart.Dexterity": lambda: {"norm": "two", "length": 0.1},
    "stewart.Fitness": lambda: {"mechanism": mechanism()},
    "stewart.Fitness.__call__": lambda: {
        "X": fitness().variables.point(mechanism().geometry, mechanism().limits)[None]
    },
    "stewart.Fitness.cost": lambda: {"x": point(), "fine": False},
    "stewart.Fitness.missing": lambda: {"dimensions": dimensions()},
    "stewart.Fitness.build": lambda: {"dimensions": dimensions()},
    "stewart.Fitness.workspace": lambda: {
        "geometry": mechanism().geometry,
        "limits": mechanism().limits,
        "fine": False,
    },
    "stewart.Fitness.score": lambda: {"workspace": workspace()},
    "stewart.Geometry": lambda: {
        "base_radius": 0.2,
        "platform_radius": 0.1,
        "base_angles": mechanism().geometry.base_angles,
        "platform_angles": mechanism().geometry.platform_angles,
        "legs": mechanism().geometry.legs,
        "reference": (0.0, 0.0, 0.0),
        "base": None,
        "platform": None,
        "servos": servos().geometry.servos,
    },
    "stewart.Geometry.of_joints": lambda: {
        "base": mechanism().geometry.base_joints,
        "platform": mechanism().geometry.platform_joints,
        "legs": mechanism().geometry.legs,
        "reference": (0.0, 0.0, 0.0),
        "servos": servos().geometry.servos,
    },
    "stewart.Grid": lambda: {
        "counts": (3, 3, 3),
        "x": (-0.1, 0.1),
        "y": (-0.1, 0.1),
        "z": (0.2, 0.3),
        "steps": (1, 1, 1),
        "roll": (0.0, 0.0),
        "pitch": (0.0, 0.0),
        "yaw": (0.0, 0.0),
    },
    "stewart.Grid.at": lambda: {"xyz": (0.0, 0.0, 0.2), "steps": (3, 3, 1), "roll": (-0.1, 0.1)},
    "stewart.LegLimits": lambda: {
        "shortest": 0.2,
        "longest": 0.3,
        "base_angle": 1.0,
        "platform_angle": 1.0,
        "distance": 0.0,
        "home": (0.0, 0.0, 0.2),
        "dead_length": 0.05,
        "speed": 0.1,
    },
    "stewart.ServoLimits": lambda: {
        "lowest": -1.0,
        "highest": 1.0,
        "base_angle": 1.0,
        "platform_angle": 1.0,
        "distance": 0.01,
        "home": (0.0, 0.0, 0.115),
        "speed": 5.0,
    },
    "stewart.Servos": lambda: {
        "horn": 0.015,
        "rod": 0.12,
        "directions": (),
        "axes": [(1.0, 0.0, 0.1)] * 6,
        "zeros": [(0.0, 1.0, 0.0)] * 6,
        "branches": 1,
    },
    "stewart.transmission": lambda: {"geometry": servos().geometry, "poses": LEVEL},
    "stewart.velocity_equation": lambda: {"geometry": servos().geometry, "poses": LEVEL},
    "stewart.Mechanism": lambda: {
        "name": "m",
        "geometry": mechanism().geometry,
        "limits": mechanism().limits,
        "grid": stewart.Grid((3, 3, 3)),
        "dexterity": stewart.Dexterity(),
        "task": None,
        "unit": "mm",
        "description": "",
        "source": "",
    },
    "stewart.Mechanism.survey": lambda: {"watch": None},
    "stewart.Ranges": lambda: {
        "base_radius": (0.1, 0.2),
        "platform_radius": 0.1,
        "base_angles": None,
        "platform_angles": None,
        "shortest": 0.2,
        "longest": (0.2, 0.3),
        "base": (((0.1, 0.2), 0.0, 0.0),),
        "platform": None,
        "horn": (0.01, 0.02),
        "rod": 0.12,
        "directions": (0.0, (1.0, 2.0)),
    },
    "stewart.Trajectory": lambda: {"times": way().times, "poses": way().poses, "twists": way().twists},
    "stewart.Trajectory.through": lambda: {"times": way().times, "poses": way().poses},
    "stewart.Trajectory.at": lambda: {"times": [0.1, 0.5]},
    "stewart.Workspace.dexterous": lambda: {"threshold": 0.1},
    "stewart.Workspace.dexterous_volume": lambda: {"threshold": 0.1},
    "stewart.Workspace.position_of": lambda: {"index": np.zeros((1, 3), dtype=int)},
    "stewart.Workspace.poses_of": lambda: {"index": np.zeros((1, 4), dtype=int)},
    "stewart.Workspace.poses": lambda: {"which": workspace().reached},
    "stewart.all_forward": lambda: {"geometry": mechanism().geometry, "coordinates": lengths(), "rng": 0},
    "stewart.best_length": lambda: {"geometry": mechanism().geometry, "poses": LEVEL, "norm": "two"},
    "stewart.characteristic_length": lambda: {
        "geometry": mechanism().geometry,
        "poses": LEVEL,
        "dexterity": stewart.Dexterity(length="best"),
    },
    "stewart.closed_model": lambda: {"mechanism": mechanism()},
    "stewart.compare_types": lambda: {
        "mechanism": mechanism(),
        "types": ("3x3",),
        "runs": 1,
        "rng": 0,
        "watch": None,
    },
    "stewart.conditioning": lambda: {
        "geometry": mechanism().geometry,
        "poses": LEVEL,
        "dexterity": stewart.Dexterity(),
    },
    "stewart.crossings": lambda: {"geometry": mechanism().geometry, "trajectory": way()},
    "stewart.design": lambda: {"mechanism": mechanism(), "rng": 0, "watch": None},
    "stewart.draw": lambda: {"mechanism": mechanism(), "workspace": workspace(), "pose": LEVEL},
    "stewart.draw_above": lambda: {"mechanism": mechanism(), "pose": LEVEL},
    "stewart.draw_motion": lambda: {"motion": moving_legs(), "mechanism": mechanism()},
    "stewart.draw_history": lambda: {"designed": stewart.design(mechanism())},
    "stewart.draw_into": lambda: {
        "figure": figure(),
        "mechanism": mechanism(),
        "workspace": None,
        "pose": LEVEL,
    },
    "stewart.follow": lambda: {
        "geometry": mechanism().geometry,
        "trajectory": way(),
        "limits": mechanism().limits,
        "dexterity": stewart.Dexterity(),
    },
    "stewart.forward": lambda: {"geometry": mechanism().geometry, "coordinates": lengths(), "start": LEVEL},
    "stewart.homogenised": lambda: {
        "geometry": mechanism().geometry,
        "poses": LEVEL,
        "dexterity": stewart.Dexterity(),
    },
    "stewart.inverse": lambda: {"geometry": servos().geometry, "poses": LEVEL, "branches": -1},
    "stewart.jacobian": lambda: {"geometry": mechanism().geometry, "poses": LEVEL},
    "stewart.judge_poses": lambda: {
        "geometry": mechanism().geometry,
        "limits": mechanism().limits,
        "poses": LEVEL,
    },
    "stewart.leg_distances": lambda: {"geometry": mechanism().geometry, "poses": LEVEL},
    "stewart.leg_lengths": lambda: {"geometry": mechanism().geometry, "poses": LEVEL},
    "stewart.leg_vectors": lambda: {"geometry": mechanism().geometry, "poses": LEVEL},
    "stewart.legs_of": lambda: {"connection": mechanism().geometry.connection},
    "stewart.load_mechanism": lambda: {"name": "stroke_100"},
    "stewart.mechanism_names": dict,
    "stewart.new_mechanism": lambda: {
        "type": "6x3",
        "base_radius": 0.2,
        "platform_radius": 0.1,
        "shortest": 0.25,
        "longest": 0.35,
        "name": None,
        "legs": 6,
        "unit": "mm",
    },
    "stewart.new_servo_mechanism": lambda: {
        "type": "6x3",
        "base_radius": 0.06,
        "platform_radius": 0.04,
        "horn": 0.02,
        "rod": 0.11,
        "name": None,
        "legs": 6,
        "unit": "mm",
    },
    "stewart.pose_at": lambda: {"xyz": (0.0, 0.0, 0.2), "rpy": (0.0, 0.0, 0.0)},
    "stewart.read_mechanism": lambda: {"path": stewart.save_mechanism(mechanism(), "saved.toml")},
    "stewart.read_trajectory": lambda: {
        "path": written("way.csv", "time,x,y,z\n0,0,0,1\n1,0,0,2\n"),
        "metres": 1.0,
        "radian": 1.0,
    },
    "stewart.save_mechanism": lambda: {"mechanism": mechanism(), "path": "saved.toml"},
    "stewart.save_motion": lambda: {"motion": moving_legs(), "path": "legs.csv", "metres": 1.0},
    "stewart.save_points": lambda: {"workspace": workspace(), "path": "points.ply", "metres": 1.0},
    "stewart.save_picture": lambda: {"figure": figure(), "path": "saved.svg"},
    "stewart.save_urdf": lambda: {"mechanism": mechanism(), "path": "saved.urdf"},
    "stewart.singularities": lambda: {"workspace": workspace()},
    "stewart.standard_geometry": lambda: {
        "type": "6x6",
        "base_radius": 0.2,
        "platform_radius": 0.1,
        "legs": 6,
        "split": 0.2,
    },
    "stewart.straight": lambda: {"start": LEVEL, "end": LEVEL, "seconds": 1.0, "samples": 5},
    "stewart.survey": lambda: {
        "geometry": mechanism().geometry,
        "limits": mechanism().limits,
        "grid": stewart.Grid((3, 3, 3)),
        "dexterity": stewart.Dexterity(),
        "watch": None,
    },
    "stewart.to_toml": lambda: {"mechanism": mechanism()},
    "stewart.to_urdf": lambda: {"mechanism": mechanism()},
    # mobile
    "mobile.ExactFitness": lambda: {"penalty": 12.0},
    "mobile.ExactFitness.on": lambda: {"space": planning().space, "start": (0.0, 0.0), "goal": (5.0, 4.0)},
    "mobile.PaperFitness": lambda: {
        "penalty": 12.0,
        "detour_penalty": 2.2,
        "detour_limit": 3.0,
        "detour_of": "segment",
    },
    "mobile.PaperFitness.on": lambda: {"space": planning().space, "start": (0.0, 0.0), "goal": (5.0, 4.0)},
    "mobile.FreeSpace.of": lambda: {"scene": scene(), "clearance": 0.1, "join": "round"},
    "mobile.FreeSpace.clearance_of": lambda: {"obstacle": scene().obstacles[0]},
    "mobile.FreeSpace.connects": lambda: {"start": (0.0, 0.0), "goal": (5.0, 4.0)},
    "mobile.FreeSpace.nearly_connects": lambda: {"start": (0.0, 0.0), "goal": (5.0, 4.0)},
    "mobile.FreeSpace.holds": lambda: {"path": path().points},
    "mobile.FreeSpace.distance": lambda: {"path": path().points},
    "mobile.FreeSpace.check": lambda: {"role": "start", "point": (0.0, 0.0)},
    "mobile.LearnedTurn.tangent": lambda: {"v": 0.5, "theta": 1.0},
    "mobile.LearnedTurn.covers": lambda: {"v": 0.5, "theta": 1.0},
    "mobile.LearnedTurn.at": lambda: {"theta": np.array([1.0])},
    "mobile.LearnedTurn.errors": dict,
    "mobile.OccupancyGrid": lambda: {
        "occupied": np.eye(3, dtype=bool),
        "resolution": 0.5,
        "origin": (0.0, 0.0, 0.0),
    },
    "mobile.OccupancyGrid.without_specks": lambda: {"cells": 2},
    "mobile.Path": lambda: {"points": [[0.0, 0.0], [1.0, 1.0]]},
    "mobile.Path.simplified": lambda: {"deviation": 0.1},
    "mobile.Path.straightened": lambda: {"slack": 0.1},
    "mobile.Path.write": lambda: {"file": "path.csv"},
    "mobile.PathPlan.verify": dict,
    "mobile.PathPlan.as_dict": dict,
    "mobile.PathProblem.of": lambda: {"scene": scene(), "radius": 0.1, "margin": 0.1, "join": "round"},
    "mobile.PathProblem.alternatives": lambda: {"count": 2},
    "mobile.PathProblem.box": lambda: {"via": 2},
    "mobile.PathProblem.through": lambda: {"x": np.array([1.0, 2.0])},
    "mobile.Route.along": lambda: {
        "path": path(),
        "vehicle": mobile.NOMAD_200,
        "obstacles": scene().obstacles,
        "radius": 0.1,
        "ends": (0.0, 0.0),
    },
    "mobile.Route.tangents": lambda: {"V": np.zeros((1, len(route().turns)))},
    "mobile.Route.turning": lambda: {"V": np.zeros((1, len(route().turns)))},
    "mobile.Route.straights": lambda: {"V": np.zeros((1, len(route().turns))), "tangents": None},
    "mobile.Route.times": lambda: {"V": np.zeros((1, len(route().turns))), "tangents": None},
    "mobile.Route.lack": lambda: {"V": np.zeros((1, len(route().turns))), "tangents": None},
    "mobile.Route.clear_speed": lambda: {"corner": 0, "obstacles": scene().obstacles, "radius": 0.1},
    "mobile.Scene": lambda: {
        "start": (0.0, 0.0),
        "goal": (5.0, 4.0),
        "obstacles": [SQUARE],
        "bounds": (-1.0, -1.0, 6.0, 6.0),
        "name": "s",
    },
    "mobile.Scene.between": lambda: {"start": (0.0, 1.0), "goal": (4.0, 4.0)},
    "mobile.Scene.as_dict": dict,
    "mobile.Curve": lambda: {"start": (0.0, 0.0, 0.0), "radius": 0.5, "word": "LS", "lengths": (1.0, -1.0)},
    "mobile.Curve.poses": lambda: {"s": [0.1, 0.2]},
    "mobile.Curve.moved": lambda: {"a": np.array([0.1]), "b": np.array([0.2])},
    "mobile.Curve.places": lambda: {"step": 0.1},
    "mobile.Curve.write": lambda: {"file": "curve.csv", "step": 0.1},
    "mobile.DifferentialDrive": lambda: {
        "name": "r",
        "track": 0.3,
        "wheel_speed": 1.0,
        "wheel_acceleration": 1.0,
        "radius": 0.2,
    },
    "mobile.DifferentialDrive.omega_at": lambda: {"v": [0.0, 0.1]},
    "mobile.DifferentialDrive.wheels": lambda: {"v": [0.0, 0.1], "omega": [0.2, 0.3]},
    "mobile.Footprint": lambda: {"corners": [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], "around": 0.1},
    "mobile.Footprint.at": lambda: {"poses": [[0.0, 0.0, 0.0]]},
    "mobile.Footprint.disc": lambda: {"radius": 0.1},
    "mobile.Footprint.rectangle": lambda: {"length": 0.5, "width": 0.3, "behind": 0.1},
    "mobile.State": lambda: {"x": 0.0, "y": 0.0, "heading": 0.0, "v": 0.1, "omega": 0.1},
    "mobile.SynchroDrive.omega_at": lambda: {"v": [0.0, 0.1]},
    "mobile.curve_through": lambda: {
        "path": path(),
        "turning_radius": 0.2,
        "obstacles": [],
        "footprint": mobile.Footprint.disc(0.1),
        "start_heading": 0.1,
        "goal_heading": 0.2,
        "reverse": True,
    },
    "mobile.first_contact": lambda: {
        "motion": curve(),
        "footprint": mobile.Footprint.disc(0.1),
        "obstacles": scene().obstacles,
        "tolerance": 1e-4,
    },
    "mobile.nav_path": lambda: {"of": path(), "frame": "map", "stamp": 1.5, "every": 0.2},
    "mobile.write_nav_path": lambda: {"file": "path.json", "of": path(), "frame": "map", "stamp": 1.5, "every": 0.2},
    "mobile.plan_in_motion": lambda: {
        "path": path(),
        "vehicle": mobile.NOMAD_200,
        "obstacles": scene().obstacles,
        "start": mobile.State(0.0, 0.0, 0.5, 0.2),
        "goal": mobile.State(5.0, 4.0, 0.5),
        "radius": 0.1,
    },
    "mobile.replan": lambda: {
        "scene": scene(),
        "vehicle": mobile.NOMAD_200,
        "start": mobile.State(0.0, 0.0, 0.5, 0.2),
        "goal": mobile.State(5.0, 4.0, 0.5),
        "margin": 0.1,
        "paths": 1,
        "join": "mitre",
    },
    "mobile.shortest_curve": lambda: {
        "start": (0.0, 0.0, 0.0),
        "goal": (1.0, 1.0, 1.0),
        "turning_radius": 0.5,
        "reverse": True,
    },
    "mobile.SynchroDrive": lambda: {
        "name": "r",
        "v_max": 1.0,
        "a_max": 1.0,
        "omega_max": 1.0,
        "alpha_max": 1.0,
        "radius": 0.2,
    },
    "mobile.Trajectory": lambda: {"phases": [Phase(1.0, 0.5)], "start": (0.0, 0.0, 0.0), "v": 0.1},
    "mobile.Trajectory.state": lambda: {"t": 0.1},
    "mobile.Trajectory.poses": lambda: {"s": [0.1, 0.2]},
    "mobile.Trajectory.moved": lambda: {"a": np.array([0.1]), "b": np.array([0.2])},
    "mobile.Trajectory.at": lambda: {"t": [0.1, 0.2]},
    "mobile.Trajectory.sample": lambda: {"dt": 0.5},
    "mobile.Trajectory.write_csv": lambda: {"file": "trajectory.csv", "dt": 0.5},
    "mobile.Trajectory.write_json": lambda: {"file": "trajectory.json", "dt": 0.5},
    "mobile.Trajectory.as_dict": lambda: {"dt": 0.5},
    "mobile.TrajectoryPlan.as_dict": lambda: {"dt": 0.5},
    "mobile.Visibility": lambda: {"space": planning().space},
    "mobile.Visibility.nodes": lambda: {"start": (0.0, 0.0), "goal": (5.0, 4.0)},
    "mobile.Visibility.inside": lambda: {"a": [[0.0, 0.0]], "b": [[1.0, 1.0], [5.0, 4.0]]},
    "mobile.Visibility.between": lambda: {"start": (0.0, 0.0), "goal": (5.0, 4.0)},
    "mobile.configurations": lambda: {"samples": motion().trajectory.sample(0.5)},
    "mobile.velocities": lambda: {"samples": motion().trajectory.sample(0.5)},
    "mobile.fastest_trajectory": lambda: {
        "scene": scene(),
        "vehicle": mobile.NOMAD_200,
        "paths": 1,
        "margins": (0.1,),
        "join": "mitre",
    },
    "mobile.grid_of": lambda: {
        "values": [[0.0, 1.0], [0.0, 0.0]],
        "threshold": 0.5,
        "unknown": "free",
        "unknown_blocks": None,
        "resolution": 0.5,
        "origin": (0.0, 0.0, 0.0),
    },
    "mobile.learn_turn": lambda: {
        "vehicle": mobile.NOMAD_200,
        "design": "log",
        "hidden": (2,),
        "trainer": "lm",
        "iterations": 2,
        "points": np.column_stack((np.linspace(0.1, 1.0, 30), np.linspace(0.1, 3.0, 30))),
        "rng": 0,
        "watch": None,
    },
    "mobile.LearnedTurn.save": lambda: {"file": "turn.npz"},
    "mobile.load_turn": lambda: {"file": saved_turn()},
    "mobile.load_trajectory": lambda: {"file": saved_trajectory()},
    "mobile.Trajectory.exact": dict,
    "mobile.MovingObstacle": lambda: {
        "footprint": mobile.Footprint.disc(0.2),
        "way": [(0.0, 1.0, 0.0), (5.0, 1.0, 4.0)],
        "name": "cart",
    },
    "mobile.MovingObstacle.at": lambda: {"t": [0.0, 1.0]},
    "mobile.MovingObstacle.planes": lambda: {"clearance": 0.1},
    "mobile.MovingObstacle.legs": lambda: {"number": 0},
    "mobile.MovingObstacle.as_dict": dict,
    "mobile.load_moving": lambda: {"source": written("moving.json", json.dumps([mover().as_dict()]))},
    "mobile.plan_among_moving": lambda: {
        "problem": planning(),
        "moving": [mover()],
        "speed": 1.0,
        "start_time": 0.0,
        "cells": 2,
        "places": [[0.0, 3.0]],
        "watch": None,
    },
    "mobile.WaitingPath.at": lambda: {"t": [0.0, 1.0]},
    "mobile.WaitingPath.write": lambda: {"file": "timed.csv"},
    "mobile.WaitingPath.as_dict": dict,
    "mobile.planner_of": lambda: {"method": "rrt"},
    "mobile.GridAStar": lambda: {"cells": 5},
    "mobile.GridAStar.route": routing,
    "mobile.RandomTree": lambda: {"planner": "RRTstar", "range": 1.0, "goal_bias": 0.1},
    "mobile.RandomTree.route": routing,
    "mobile.Roadmap": lambda: {"nearest": 5},
    "mobile.Roadmap.route": routing,
    "compare.PlannerComparison.of": lambda: {"scene": "scene", "method": "ga"},
    "compare.PlannerComparison.as_dict": dict,
    "compare.compare_planners": lambda: {
        "problems": planning(),
        "methods": ["exact", "ga"],
        "runs": 1,
        "fitness": "exact",
        "via": 2,
        "budget": FEW,
        "rng": 0,
        "watch": None,
    },
    "learn.save_regressor": lambda: {"regressor": regressor(), "file": "network.npz"},
    "learn.load_regressor": lambda: {"file": saved_network()},
    "mobile.load_scene": lambda: {
        "source": saved_grid(),
        "start": (0.1, 1.2),
        "goal": (1.2, 0.1),
        "unknown": "free",
        "resolution": 0.5,
        "threshold": 0.5,
        "specks": 1,
    },
    "mobile.load_vehicle": lambda: {"source": "nomad200"},
    "mobile.mobile_robot": lambda: {"vehicle": mobile.NOMAD_200, "height": 0.8},
    "mobile.path_through": lambda: {"problem": planning(), "via": [(5.0, 5.0)]},
    "mobile.plan_alternatives": lambda: {"problem": planning(), "count": 2},
    "mobile.plan_path": lambda: {
        "problem": planning(),
        "method": "de",
        "fitness": "exact",
        "via": 2,
        "budget": FEW,
        "rng": 0,
        "seeded": False,
        "trace": False,
        "watch": None,
    },
    "mobile.plan_trajectory": lambda: {
        "path": path(),
        "vehicle": mobile.NOMAD_200,
        "obstacles": scene().obstacles,
        "method": "dp",
        "radius": 0.1,
        "algorithm": "de",
        "budget": FEW,
        "rng": 0,
        "model": None,
        "watch": None,
    },
    "mobile.random_scene": lambda: {
        "obstacles": 3,
        "rng": 0,
        "size": 10.0,
        "fill": 0.1,
        "gap": 0.1,
        "concave": 0.5,
        "start": (0.5, 0.5),
        "goal": (9.5, 9.5),
    },
    "mobile.read_grid": lambda: {
        "path": saved_grid(),
        "unknown": "free",
        "unknown_blocks": None,
        "threshold": 0.5,
        "resolution": 0.5,
    },
    "mobile.read_obstacles": lambda: {"source": [SQUARE]},
    "mobile.read_polygons": lambda: {"source": [SQUARE]},
    "mobile.scene_names": dict,
    "mobile.shortest_path": lambda: {
        "space": planning().space,
        "start": (0.0, 0.0),
        "goal": (5.0, 4.0),
        "visibility": None,
    },
    "mobile.shortest_paths": lambda: {
        "space": planning().space,
        "start": (0.0, 0.0),
        "goal": (5.0, 4.0),
        "count": 2,
        "visibility": None,
    },
    # compare
    "compare.Case": lambda: {
        "name": "mine",
        "about": "Mine.",
        "draw": compare.CASES["random"].draw,
        "chain": compare.CASES["random"].chain,
        "world": None,
        "judge": compare.CASES["random"].judge,
        "success": "Reached.",
    },
    "compare.Case.lacks": lambda: {"robot": ur5(), "rng": rng()},
    "compare.Case.task": lambda: {"chain": chain(), "world": None, "rng": rng()},
    "compare.Replay.as_dict": dict,
    "compare.Replay.lines": dict,
    "compare.Results.rows": lambda: {"robot": "ur5", "case": "random", "method": "lm"},
    "compare.Results.hopeless": lambda: {"case": "random"},
    "compare.Results.pairs": lambda: {"case": "random", "robot": "ur5"},
    "compare.Results.spent": lambda: {"case": "random", "method": "lm", "robot": "ur5"},
    "compare.Results.costs": lambda: {"case": "random", "robot": "ur5"},
    "compare.Search": lambda: {"name": "lm", "seeder": None, "refiner": "lm_chan", "starts": 1},
    "compare.Search.solve": lambda: {"problem": problem(), "x0": np.array(X6), "budget": 50, "rng": rng()},
    "compare.Suite": lambda: {
        "robots": ("ur5",),
        "cases": ("random",),
        "methods": ("lm",),
        "tasks": 1,
        "seeds": 1,
        "budget": 50,
        "rng": 0,
    },
    "compare.Suite.absent": dict,
    "compare.Suite.work_items": lambda: {"done": frozenset(), "absent": ()},
    "compare.Task.at": lambda: {"chain": chain(), "X": np.array([X6]), "start": None},
    "compare.Trial.row": dict,
    "compare.Trial.from_row": lambda: {"row": trial().row()},
    "compare.compare": lambda: {
        "suite": suite(),
        "folder": folder(),
        "jobs": 1,
        "backend": "loky",
        "scheduler": None,
        "command": "c",
        "watch": None,
    },
    "compare.read_results": lambda: {"folder": folder()},
    "compare.replay": lambda: {"folder": folder(), "name": "ur5/random/0/lm/0"},
    "compare.summarise": lambda: {"trials": [trial()]},
    "compare.write_report": lambda: {"folder": folder()},
    # registries
    "ALGORITHMS.gwo": lambda: {"agents": 30},
    "ALGORITHMS.igwo": lambda: {"agents": 30},
    "ALGORITHMS.mtde": lambda: {
        "agents": 50,
        "patience": 20,
        "a2_initial": 0.001,
        "a2_final": 2.0,
        "scale": 0.5,
        "spread": 0.2,
    },
    "ALGORITHMS.sfla": lambda: {
        "frogs": 200,
        "memeplexes": 20,
        "leaps": 10,
        "leap": 1.3,
        "largest_leap": 1.0,
        "fallbacks": True,
        "leapers": "worst",
    },
    "ALGORITHMS.de": lambda: {"agents": 50, "F": 0.5, "CR": 0.9, "strategy": "rand/1/bin"},
    "ALGORITHMS.pso": lambda: {
        "agents": 40,
        "variant": "constriction",
        "c1": None,
        "c2": None,
        "w_max": 0.9,
        "w_min": 0.4,
        "chi": 0.7298,
        "v_max": 0.5,
    },
    "ALGORITHMS.qpso": lambda: {"agents": 40, "beta_start": 1.0, "beta_end": 0.5},
    "ALGORITHMS.ga": lambda: {
        "agents": 100,
        "crossover_rate": 0.9,
        "mutation_rate": 0.2,
        "elites": 1,
        "selection": "roulette",
        "crossover": "one-point",
    },
    "ALGORITHMS.cmaes": lambda: {"agents": None, "sigma": 0.3, "growth": 2.0},
    "TRAINERS.lm": lambda: {"mu": 0.001, "up": 10.0, "down": 0.1},
    "TRAINERS.minpack": lambda: {"tolerance": 1e-16},
    "TRAINERS.bfgs": lambda: {"tolerance": 1e-12},
    "TRAINERS.rprop": lambda: {"up": 1.2, "down": 0.5, "first": 0.07, "least": 1e-12, "most": 50.0},
    "TRAINERS.scg": lambda: {"sigma": 5e-5, "lamda": 5e-7},
}


def saved_grid() -> Path:
    """An occupancy grid as a file in the folder one is in."""
    file = Path("grid.npy")
    np.save(file, np.eye(3, dtype=np.int8))
    return file


if ompl.installed():  # it has no wheels for some systems
    MODULES["planning"] = ompl
    OWNERS |= {
        "planning.Adapter": adapter,
        "planning.JointPlan": lambda: ompl.plan_joint_move(arm(), world(), [1.0, 0.2], [1.2, 0.4]),
    }
    CALLS |= {
        "planning.Adapter": lambda: {"chain": arm(), "world": world(), "q0": [1.0, 0.2]},
        "planning.Adapter.setup": dict,
        "planning.Adapter.state": lambda: {"q": [1.0, 0.2]},
        "planning.Adapter.q": lambda: {"state": adapter().state([1.0, 0.2])},
        "planning.JointPlan.as_dict": dict,
        "planning.installed": dict,
        "planning.plan_joint_move": lambda: {
            "chain": arm(),
            "world": world(),
            "q0": [1.0, 0.2],
            "goals": [[1.2, 0.4]],
            "planner": "RRTConnect",
            "seconds": 1.0,
            "rng": 0,
        },
    }
