"""The experiments on trajectories: the paper's Table 1, what one job does, and what jobs hand on to each other."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field
from time import perf_counter
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from pin_metaik.arrays import Array
from pin_metaik.compare.papers.paper import Options

if TYPE_CHECKING:  # shapely is an extra
    from pin_metaik.mobile import LearnedTurn


NETS = {"2:5:1": (5,), "2:5:5:1": (5, 5)}
TRAINERS = {"lm": "Levenberg-Marquardt", "bfgs": "quasi-Newton", "rprop": "resilient", "scg": "scaled conj. gradient"}
POINTS = {"grid": "ANN", "fcm": "FCM-ANN", "random": "random points", "chebyshev": "Chebyshev points"}
CONTROLS = ("random", "chebyshev")
CLUSTERING, PIECES = 150, 10  # iterations of fuzzy c-means, and jobs they are made in


class Printed(NamedTuple):
    """Errors as the paper has them: mean and largest in percent, and how many exceed 5 percent."""

    E0: float
    Em: float
    E5: int


# By net, trainer and points; 30,000 iterations. Digits that the print wraps are joined again.
PRINTED = {
    ("2:5:1", "lm", "grid"): Printed(0.3517, 12.1453, 98),
    ("2:5:1", "lm", "fcm"): Printed(0.1346, 7.9507, 29),
    ("2:5:1", "bfgs", "grid"): Printed(0.9871, 20.8609, 346),
    ("2:5:1", "bfgs", "fcm"): Printed(0.4787, 13.985, 154),
    ("2:5:1", "rprop", "grid"): Printed(1.9, 31.1, 1116),
    ("2:5:1", "rprop", "fcm"): Printed(1.9, 32.4, 1505),
    ("2:5:1", "scg", "grid"): Printed(1.0246, 21.6854, 606),
    ("2:5:1", "scg", "fcm"): Printed(0.9670, 22.9967, 419),
    ("2:5:5:1", "lm", "grid"): Printed(0.0306, 0.7532, 0),
    ("2:5:5:1", "lm", "fcm"): Printed(0.0282, 2.5065, 0),
    ("2:5:5:1", "bfgs", "grid"): Printed(0.9817, 21.3661, 656),
    ("2:5:5:1", "bfgs", "fcm"): Printed(0.1540, 7.6604, 31),
    ("2:5:5:1", "rprop", "grid"): Printed(1.6, 26.1, 2062),
    ("2:5:5:1", "rprop", "fcm"): Printed(0.8500, 22.0227, 412),
    ("2:5:5:1", "scg", "grid"): Printed(0.3591, 11.3151, 90),
    ("2:5:5:1", "scg", "fcm"): Printed(0.2245, 6.9177, 58),
}
PRINTED_ITERATIONS, ITERATIONS, QUICK = 30_000, 4000, 200
COUNTS = (1, 100, 1000, 23_779)  # of the speed table
SCENES, TRIED = 3, 100  # random ones, for the plans, and how many are drawn to find them


@dataclass(frozen=True, eq=False)
class NetTrial:
    """A network, trained.

    Attributes:
        net: Its layers, key of NETS.
        trainer: Key of TRAINERS.
        points: Key of POINTS.
        design: ``paper`` or ``log``.
        run: Number, from 0: another start of the weights.
        E0: Mean relative error, percent.
        Em: Largest, percent.
        E5: How many exceed 5 percent.
        F0: Mean error as a share of the longest tangent, percent.
        Fm: Largest, percent.
        n: Test vectors.
        mse: Of the training, scaled data.
        iterations: Made.
        seconds: Of the training.
    """

    net: str
    trainer: str
    points: str
    design: str
    run: int
    E0: float
    Em: float
    E5: int
    F0: float
    Fm: float
    n: int
    mse: float
    iterations: int
    seconds: float


@dataclass(frozen=True)
class SpeedTrial:
    """Time in us for so many tangent lengths by one method."""

    method: str
    count: int
    microseconds: float


@dataclass(frozen=True)
class PlanTrial:
    """A trajectory planned by one method.

    Attributes:
        scene: Its name.
        corners: Of its path.
        method: ``dp``, ``de``, or the network's name.
        time: Of the trajectory, s.
        stop_and_turn: The same path with stops, s.
        tangent_error: Largest error of a tangent length, mm; None without a network.
        end_error: Of the executed trajectory, mm.
        milliseconds: Of planning.
        clear: Whether the executed trajectory keeps the robot's radius from the obstacles.
    """

    scene: str
    corners: int
    method: str
    time: float
    stop_and_turn: float
    tangent_error: float | None
    end_error: float
    milliseconds: float
    clear: bool


@dataclass
class Lab:
    """What jobs hand on: the clustered points, and the networks of the first run."""

    options: Options
    clustered: Array | None = None
    models: dict[str, LearnedTurn] = field(default_factory=dict)

    @property
    def iterations(self) -> int:
        """Of every training."""
        return QUICK if self.options.quick else PRINTED_ITERATIONS if self.options.long else ITERATIONS

    def cluster(self) -> None:
        """A tenth of the clustering."""
        from pin_metaik.mobile.motion.turn_data import clustered_points
        from pin_metaik.mobile.motion.vehicle import NOMAD_200

        steps = max(1, (CLUSTERING // 10 if self.options.quick else CLUSTERING) // PIECES)
        found = clustered_points(NOMAD_200, self.options.generator(100), steps, start=self.clustered)
        self.clustered = found.centres

    def net(self, net: str, trainer: str, points: str, design: str, run: int) -> Callable[[], NetTrial]:
        """Train one network; runs start from other weights, the same for all."""

        def work() -> NetTrial:
            from pin_metaik.mobile.motion.learned import learn_turn
            from pin_metaik.mobile.motion.vehicle import NOMAD_200

            model = learn_turn(
                NOMAD_200,
                design=design,  # type: ignore[arg-type]  # it checks the name itself
                hidden=NETS[net],
                trainer=trainer,
                iterations=self.iterations,
                points=self._points(points),
                rng=self.options.generator(run),
            )
            training = model.regressor.training
            if run == 0 and trainer == "lm" and points not in CONTROLS:
                self.models[f"{net} {points} {design}"] = model
            e = model.errors()
            errors = (e.E0, e.Em, e.E5, e.F0, e.Fm, e.n)
            return NetTrial(
                net, trainer, points, design, run, *errors, training.mse, training.iterations, training.seconds
            )

        return work

    def _points(self, points: str) -> Array:
        from pin_metaik.mobile.motion import turn_data
        from pin_metaik.mobile.motion.vehicle import NOMAD_200

        match points:
            case "grid":
                return turn_data.coarse_grid(NOMAD_200)
            case "random":
                return turn_data.random_points(NOMAD_200, self.options.generator(101))
            case "chebyshev":
                return turn_data.chebyshev_points(NOMAD_200)
        assert self.clustered is not None
        return self.clustered

    def speed(self) -> list[SpeedTrial]:
        """Time every way to compute tangent lengths."""
        from scipy.interpolate import CubicSpline

        from pin_metaik.mobile.motion.turn import lead_time
        from pin_metaik.mobile.motion.turn_data import LARGEST, SLOWEST
        from pin_metaik.mobile.motion.vehicle import NOMAD_200

        knots = np.linspace(0, np.sqrt(LARGEST), 129)
        spline = CubicSpline(knots, lead_time(knots**2, NOMAD_200))
        ways: dict[str, Callable[[Array, Array], Array]] = {
            "step by step": stepped,
            "closed form": lambda v, theta: v * lead_time(theta, NOMAD_200),
            "spline": lambda v, theta: v * spline(np.sqrt(theta)),
        }
        for net in NETS:
            ways[f"ANN {net}"] = _on_columns(self.models[f"{net} grid paper"].regressor.predict)
        rng = self.options.generator(102)
        trials = []
        for count in COUNTS:
            v = NOMAD_200.v_max * rng.uniform(SLOWEST, 1, count)
            theta = rng.uniform(np.radians(1), LARGEST, count)
            for name, way in ways.items():
                if name == "step by step" and count > 1000:
                    continue  # 200 MB, and nothing new
                repeats = 3 + 20_000 // (count + 100)
                trials.append(SpeedTrial(name, count, 1e6 * _time(way, v, theta, repeats)))
        return trials

    def plan(self, name: str, path: Array, obstacles: tuple[object, ...]) -> Callable[[], list[PlanTrial]]:
        """Plan along one path by every method."""

        def work() -> list[PlanTrial]:
            from pin_metaik.learn import OutsideTraining
            from pin_metaik.mobile import NOMAD_200, plan_trajectory

            plan_trajectory(path, NOMAD_200)  # compiles
            trials = []
            for label, method, model in (
                ("dp", "dp", None),
                ("de", "de", None),
                *((f"ANN {key}", "ann", model) for key, model in self.models.items()),
            ):
                with warnings.catch_warnings():
                    warnings.simplefilter("ignore", OutsideTraining)  # where it is, the closed form is used
                    plan = plan_trajectory(
                        path,
                        NOMAD_200,
                        obstacles,
                        method=method,  # type: ignore[arg-type]  # it checks the name itself
                        model=model,
                    )
                wrong = None if plan.learned is None else 1e3 * plan.learned.tangent_error
                ends = (plan.time, plan.stop_and_turn, wrong, 1e3 * plan.end_error, 1e3 * plan.seconds)
                trials.append(PlanTrial(name, len(plan.v), label, *ends, plan.collision_free))
            return trials

        return work


def routes(options: Options) -> dict[str, tuple[Array, tuple[object, ...]]]:
    """Paths to plan along: two bare polylines and random scenes, with a margin of 0.1 m."""
    from pin_metaik import mobile

    found: dict[str, tuple[Array, tuple[object, ...]]] = {
        "A, one corner": (np.array([(0, 0), (3, 0), (3, 3)], dtype=float), ()),
        "B, three corners": (np.array([(0, 0), (2, 0), (3, 1.5), (6, 1.5), (6, 4)]), ()),
    }
    for seed in range(TRIED):
        scene = mobile.random_scene(15, options.generator(103, seed), gap=0.75)
        with suppress(mobile.NoPath):  # mitred corners may close a gap
            problem = mobile.PathProblem.of(scene, mobile.NOMAD_200.radius, 0.1)
            found[f"random {len(found) - 1}"] = (problem.optimum.points, scene.obstacles)
        if len(found) == 2 + SCENES:
            return found
    raise RuntimeError(f"fewer than {SCENES} of {TRIED} random scenes have a way through")


def stepped(v: Array, theta: Array) -> Array:
    """Tangent lengths by integrating every curve in 1000 steps, as one without the closed form would."""
    from pin_metaik.mobile.motion.turn import turn_time
    from pin_metaik.mobile.motion.vehicle import NOMAD_200

    T = turn_time(theta, NOMAD_200)[:, None]
    t = T * np.linspace(0, 1, 1001)  # (n, 1001)
    rate = np.minimum(np.minimum(t, T - t) * NOMAD_200.alpha_max, NOMAD_200.omega_max)
    heading = np.zeros_like(t)
    np.cumsum((rate[:, 1:] + rate[:, :-1]) / 2 * T / 1000, axis=1, out=heading[:, 1:])
    y = np.trapezoid(np.sin(heading), axis=1) * T[:, 0] / 1000
    return np.asarray(v * y / np.sin(theta))  # it leaves along the outgoing line, a tangent length from the corner


def _time(way: Callable[[Array, Array], Array], v: Array, theta: Array, repeats: int) -> float:
    """Least time of a call, s: what else the machine does only adds to it."""
    times = []
    for _ in range(repeats):
        began = perf_counter()
        way(v, theta)
        times.append(perf_counter() - began)
    return min(times)


def _on_columns(predict: Callable[[Array], Array]) -> Callable[[Array, Array], Array]:
    """A function of speeds (k,) and angles (k,) from one of a table (k, 2) of both."""
    return lambda v, theta: predict(np.column_stack((v, theta)))
