"""Inverse-kinematics solvers behind one call.

Every solver gets the arm, poses and starts in its own form beforehand: ``solve`` alone is timed. Who has no restarts or
limit of time gets both here.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from ik_closed_forms import Unsuitable, bounds, decomposition, unwrapped
from ik_serial import BASE, TIP, SerialArm
from numpy.typing import NDArray

LIMIT = 0.05  # s a target
TOLERANCE = 1e-5  # m, rad

Floats = NDArray[np.float64]


class Answer(NamedTuple):
    """What a solver found: coordinates (n,), or None, and what it says of it."""

    x: Floats | list[float] | None
    evaluations: int | None = None
    status: str = ""


class Solver:
    """A solver for one arm: ``solve`` is timed, everything else is not.

    Attributes:
        package: What pip knows it by.
    """

    package = ""

    def __init__(self, arm: SerialArm) -> None:
        self.arm = arm
        self.rng = np.random.default_rng(0)

    def goal(self, pose: Floats) -> Any:
        """A pose (4, 4) in the solver's own form."""
        return pose

    def start(self, x: Floats) -> Any:
        """Coordinates (n,) in the solver's own form."""
        return x

    def solve(self, goal: Any, start: Any) -> Any:
        raise NotImplementedError

    def answer(self, found: Any) -> Answer:
        """What ``solve`` returned, as coordinates."""
        return found

    def random(self) -> Floats:
        """Where to start again."""
        return self.rng.uniform(self.arm.lower, self.arm.upper)


class PinMetaik(Solver):
    """``pin_metaik.solve_ik`` with the default solver, on the robot's own model, not on the serial arm."""

    package = "pin-metaik"

    def __init__(self, arm: SerialArm) -> None:
        super().__init__(arm)
        import pin_metaik

        robot = pin_metaik.load_robot(arm.robot)
        self.chain = pin_metaik.Chain(robot.model, robot.frame)
        self.solve_ik = pin_metaik.solve_ik

    def start(self, x: Floats) -> Floats:
        return self.chain.q(x)

    def solve(self, goal: Floats, start: Floats) -> Any:
        return self.solve_ik(self.chain, goal, start)

    def answer(self, found: Any) -> Answer:
        return Answer(found.x, found.evaluations, str(found.status))


class TracIK(Solver):
    """TRAC-IK: Newton with joint limits and SQP race in two threads, with restarts; its tolerance is for each axis."""

    package = "pytracik"

    def __init__(self, arm: SerialArm) -> None:
        super().__init__(arm)
        import pytracik

        tolerance = 0.99 * TOLERANCE / np.sqrt(3.0)
        self.ik = pytracik.ik
        self.handle = pytracik.TRAC_IK(BASE, TIP, arm.urdf(), LIMIT, tolerance, pytracik.SolveType.Speed)

    def goal(self, pose: Floats) -> tuple[float, ...]:
        return *pose[:3, 3].tolist(), *_quaternion(pose[:3, :3]).tolist()

    def solve(self, goal: tuple[float, ...], start: Floats) -> Floats:
        return self.ik(self.handle, start, *goal)

    def answer(self, found: Floats) -> Answer:
        return Answer(found[1:] if found[0] >= 0 else None)


class RoboticsToolbox(Solver):
    """Robotics Toolbox's Levenberg-Marquardt in C++, Chan's damping, 30 steps a start as by default."""

    package = "roboticstoolbox-python"
    damping = 0.1  # of 10, 1, 0.1, 0.01 and 0.001 the one that took fewest steps over four arms
    searches = 100  # in one call; called again while there is time

    def __init__(self, arm: SerialArm) -> None:
        super().__init__(arm)
        from roboticstoolbox import ET, ETS

        parts = []
        for i, kind in enumerate(arm.kinds):
            move = ET.tz if kind == "prismatic" else ET.Rz
            parts += [ET.SE3(arm.origins[i]), move(jindex=i, qlim=[arm.lower[i], arm.upper[i]])]
        self.ets = ETS([*parts, ET.SE3(arm.tip)]).compile()

    def solve(self, goal: Floats, start: Floats) -> Answer:
        end = time.process_time() + LIMIT
        steps = 0
        while True:
            found = self.ets.ik_LM(
                goal, q0=start, slimit=self.searches, tol=0.5 * TOLERANCE**2, k=self.damping, method="chan"
            )
            steps += found.iterations
            if found.success:
                return Answer(found.q, steps)
            if time.process_time() > end:
                return Answer(None, steps)
            start = self.random()


class Descent(Solver):
    """A differential solver, stepped to convergence; where it stalls it starts again at random.

    Attributes:
        patience: Steps without a tenth of progress that end a start; of 3, 5 and 8 placo took fewest steps in all
            with 3, and pink about as many with 3 as with 5.
    """

    patience = 3

    def place(self, x: Floats) -> None:
        """Put the arm at coordinates (n,)."""
        raise NotImplementedError

    def errors(self) -> tuple[float, float]:
        """Distance and angle to the goal."""
        raise NotImplementedError

    def step(self) -> None:
        """One step towards the goal; RuntimeError when there is none."""
        raise NotImplementedError

    def where(self) -> Floats:
        """Coordinates (n,) of the arm."""
        raise NotImplementedError

    def aim(self, goal: Any) -> None:
        """Take a goal."""
        raise NotImplementedError

    def solve(self, goal: Any, start: Floats) -> Answer:
        end = time.process_time() + LIMIT
        self.aim(goal)
        steps = 0
        while True:
            self.place(start)
            best, idle = np.inf, 0
            while idle < self.patience:
                distance, angle = self.errors()
                if distance <= TOLERANCE and angle <= TOLERANCE:
                    return Answer(self.where(), steps)
                if time.process_time() > end:
                    return Answer(None, steps)
                if distance + angle < 0.9 * best:
                    best, idle = distance + angle, 0
                else:
                    idle += 1
                try:
                    self.step()
                except RuntimeError:
                    break
                steps += 1
            start = self.random()


class PinMetaikQP(PinMetaik):
    """Our QP refiner with daqp, from random starts: the same kind of solver as placo."""

    def __init__(self, arm: SerialArm) -> None:
        super().__init__(arm)
        from pin_metaik import IKSolver
        from pin_metaik.ik.refine.qp import QP

        self.solver = IKSolver(seeder=None, refiner=QP("daqp"))

    def solve(self, goal: Floats, start: Floats) -> Any:
        return self.solve_ik(self.chain, goal, start, solver=self.solver)


class Placo(Descent):
    """placo: a frame task, joint limits in the QP."""

    package = "placo"

    def __init__(self, arm: SerialArm) -> None:
        super().__init__(arm)
        import placo

        self.robot = placo.RobotWrapper("", placo.Flags.ignore_collisions, arm.urdf())
        self.solver = placo.KinematicsSolver(self.robot)
        self.solver.mask_fbase(True)
        self.solver.enable_joint_limits(True)
        self.solver.enable_velocity_limits(False)
        self.task = self.solver.add_frame_task(TIP, np.eye(4))
        self.task.configure("tip", "soft", 1.0, 1.0)
        self.solver.add_regularization_task(1e-6)
        self.position, self.orientation = self.task.position(), self.task.orientation()
        self.base = np.array(self.robot.state.q[:7])  # of the floating base, which is held

    def aim(self, goal: Floats) -> None:
        self.task.T_world_frame = goal

    def place(self, x: Floats) -> None:
        self.robot.state.q = np.concatenate((self.base, self.arm.q(x)))
        self.robot.update_kinematics()

    def errors(self) -> tuple[float, float]:
        self.position.update()  # the solver leaves the errors as they were before its step
        self.orientation.update()
        return self.position.error_norm(), self.orientation.error_norm()

    def step(self) -> None:
        self.solver.solve(True)
        self.robot.update_kinematics()

    def where(self) -> Floats:
        return self.arm.x(self.robot.state.q[7:])


class Pink(Descent):
    """pink with daqp: a frame task, joint limits in the QP and no velocity limits."""

    package = "pin-pink"

    def __init__(self, arm: SerialArm) -> None:
        super().__init__(arm)
        import daqp  # noqa: F401 - qpsolvers finds it
        import pink
        import pinocchio as pin
        from pink.limits import ConfigurationLimit

        self.pin, self.solve_ik = pin, pink.solve_ik
        self.refusals = (pink.exceptions.PinkError,)
        self.model = pin.buildModelFromXML(arm.urdf())
        self.data = self.model.createData()
        self.configuration = pink.Configuration(self.model, self.data, pin.neutral(self.model))
        self.limits = [ConfigurationLimit(self.model, config_limit_gain=1.0)]
        self.task = pink.FrameTask(TIP, position_cost=1.0, orientation_cost=1.0, lm_damping=1e-3)

    def goal(self, pose: Floats) -> Any:
        return self.pin.SE3(pose)

    def aim(self, goal: Any) -> None:
        self.task.set_target(goal)

    def place(self, x: Floats) -> None:
        self.configuration.update(self.arm.q(x))

    def errors(self) -> tuple[float, float]:
        error = self.task.compute_error(self.configuration)
        return float(np.linalg.norm(error[:3])), float(np.linalg.norm(error[3:]))

    def step(self) -> None:
        try:
            velocity = self.solve_ik(self.configuration, [self.task], 1.0, "daqp", limits=self.limits)
        except self.refusals as error:
            raise RuntimeError(str(error)) from None
        self.configuration.integrate_inplace(velocity, 1.0)

    def where(self) -> Floats:
        return self.arm.x(self.configuration.q)


class IKPy(Solver):
    """ikpy: bounded least squares of scipy, started again at random."""

    package = "ikpy"

    def __init__(self, arm: SerialArm) -> None:
        super().__init__(arm)
        from ikpy.chain import Chain

        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "arm.urdf"
            path.write_text(arm.urdf())
            mask = [False, *(True for _ in arm.names), False]
            self.chain = Chain.from_urdf_file(str(path), base_elements=[BASE], active_links_mask=mask)

    def solve(self, goal: Floats, start: Floats) -> Answer:
        end = time.process_time() + LIMIT
        while True:
            found = self.chain.inverse_kinematics_frame(
                goal, initial_position=[0.0, *start, 0.0], orientation_mode="all", tol=1e-12
            )
            error = self.chain.forward_kinematics(found) - goal
            if np.linalg.norm(error[:3, 3]) <= TOLERANCE and np.linalg.norm(error[:3, :3]) <= TOLERANCE:
                return Answer(found[1:-1])
            if time.process_time() > end:
                return Answer(None)
            start = self.random()


class IKGeo(Solver):
    """ik-geo: closed forms for arms of six turning joints; the first solution that the limits allow."""

    package = "ik-geo"

    def __init__(self, arm: SerialArm) -> None:
        super().__init__(arm)
        from ik_geo import Robot

        if set(arm.kinds) - {"revolute", "continuous"} or arm.n != 6:
            raise Unsuitable("not six turning joints")
        axes, points, method = decomposition(arm.frames)
        ends = [np.zeros(3), *points, arm.frames[-1][:3, 3]]
        self.robot = getattr(Robot, method)(axes.tolist(), np.diff(ends, axis=0).tolist())
        self.turn = arm.frames[-1][:3, :3].T
        self.bounds = bounds(arm)

    def goal(self, pose: Floats) -> tuple[list[list[float]], list[float]]:
        return (pose[:3, :3] @ self.turn).T.tolist(), pose[:3, 3].tolist()  # it reads matrices column by column

    def solve(self, goal: tuple[list[list[float]], list[float]], start: Floats) -> list[float] | None:
        for x, _, _ in self.robot.get_ik_sorted(*goal):
            inside = unwrapped(x, self.bounds)
            if inside is not None:
                return inside
        return None

    def answer(self, found: list[float] | None) -> Answer:
        return Answer(found)


class EAIK(Solver):
    """EAIK: closed forms; of seven joints one is held, at values from all over its range until the limits allow one."""

    package = "eaik"
    values = 256

    def __init__(self, arm: SerialArm) -> None:
        super().__init__(arm)
        from eaik.IK_Homogeneous import HomogeneousRobot

        if set(arm.kinds) - {"revolute", "continuous"} or arm.n not in (6, 7):
            raise Unsuitable("not six or seven turning joints")
        self.bounds = bounds(arm)
        self.robots, self.held = [], None
        if arm.n == 6:
            self.robots = [HomogeneousRobot(arm.frames)]
        else:
            for held in range(7):
                grid = np.linspace(arm.lower[held], arm.upper[held], self.values + 2)[1:-1]
                if HomogeneousRobot(arm.frames, [(held, float(grid[0]))]).hasKnownDecomposition():
                    self.held = held
                    self.robots = [HomogeneousRobot(arm.frames, [(held, float(v))]) for v in self.rng.permutation(grid)]
                    break
        if not self.robots or not self.robots[0].hasKnownDecomposition():
            raise Unsuitable("no decomposition known for its axes")

    def solve(self, goal: Floats, start: Floats) -> list[float] | None:
        return next(self.every(goal), None)

    def every(self, goal: Floats) -> Iterator[list[float]]:
        """All solutions inside the limits."""
        for robot in self.robots:
            found = robot.IK(goal)
            for x, approximate in zip(found.Q, found.is_LS, strict=True):
                inside = unwrapped(x.tolist(), self.bounds)
                if inside is not None and not (approximate and np.abs(robot.fwdKin(x) - goal).max() > 0.5 * TOLERANCE):
                    yield inside

    def answer(self, found: list[float] | None) -> Answer:
        return Answer(found)


SOLVERS: dict[str, type[Solver]] = {
    "pin_metaik": PinMetaik,
    "pin_metaik-qp": PinMetaikQP,
    "roboticstoolbox": RoboticsToolbox,
    "placo": Placo,
    "pytracik": TracIK,
    "ik-geo": IKGeo,
    "eaik": EAIK,
    "pink": Pink,
    "ikpy": IKPy,
}


def _quaternion(R: Floats) -> Floats:
    """Unit quaternion (x, y, z, w) of a rotation matrix (Bar-Itzhack 2000)."""
    K = np.array(
        [
            [R[0, 0] - R[1, 1] - R[2, 2], R[1, 0] + R[0, 1], R[2, 0] + R[0, 2], R[2, 1] - R[1, 2]],
            [R[1, 0] + R[0, 1], R[1, 1] - R[0, 0] - R[2, 2], R[2, 1] + R[1, 2], R[0, 2] - R[2, 0]],
            [R[2, 0] + R[0, 2], R[2, 1] + R[1, 2], R[2, 2] - R[0, 0] - R[1, 1], R[1, 0] - R[0, 1]],
            [R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1], R[0, 0] + R[1, 1] + R[2, 2]],
        ]
    )
    return np.linalg.eigh(K)[1][:, 3]
