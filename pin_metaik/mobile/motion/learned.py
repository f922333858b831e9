"""Turns learned by a network: tangent lengths for a speed and an angle, and the effect of their errors.

The closed form needs none of this: the tangent length is the speed times a function of the angle. It is here because a
paper planned with it, and because it shows what a network's error of a few millimetres does to a robot.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import array, checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidSetting, MetaIKError
from pin_metaik.files import read_arrays
from pin_metaik.interrupts import wrapped
from pin_metaik.learn import OutsideTraining, Regressor, Trainer, fit
from pin_metaik.learn.files import arrays_of, network_file, numbers, regressor_of, save_arrays
from pin_metaik.lookup import lookup
from pin_metaik.mobile.motion.turn import lead_time
from pin_metaik.mobile.motion.turn_data import coarse_grid, judging_points
from pin_metaik.mobile.motion.turn_errors import TurnErrors, turn_errors
from pin_metaik.mobile.motion.vehicle import SynchroDrive
from pin_metaik.said import warn
from pin_metaik.watching import Watch

DesignName = Literal["paper", "log"]


@dataclass(frozen=True)
class Design:
    """Input and output transformations of the network.

    Attributes:
        inputs: From speeds (n,) and angles (n,) to inputs (n, 2).
        output: From tangent lengths (n,) to outputs (n,).
        tangent: And back.
    """

    inputs: Callable[[Array, Array], Array]
    output: Callable[[Array], Array]
    tangent: Callable[[Array], Array]


# Tangent lengths span three decades and rise like a square root at small angles. Through logarithms both are straight,
# and the mean squared error is one of relative errors, which is what the paper measures.
DESIGNS: dict[str, Design] = {
    "paper": Design(lambda v, theta: np.column_stack((v, theta)), lambda a: a, lambda y: y),
    "log": Design(lambda v, theta: np.column_stack((np.log(v), np.sqrt(theta))), np.log, np.exp),
}


@dataclass(frozen=True)
class TurnReport:
    """Errors of a plan that come from a network.

    Attributes:
        tangent_error: Largest error of a tangent length in the plan, m.
        exact: Corners (from 1) outside its training range, planned with the closed form.
    """

    tangent_error: float
    exact: tuple[int, ...]

    def __str__(self) -> str:
        said = f"the network's tangent lengths are wrong by up to {1e3 * self.tangent_error:.3f} mm"
        if self.exact:
            said += f"; corner {', '.join(map(str, self.exact))} lies outside its training range: closed form there"
        return said


@dataclass(frozen=True, eq=False)
class LearnedTurn:
    """A network in place of the closed form, for one robot.

    Attributes:
        vehicle: The robot it was learned for.
        design: Name of its input and output transformations.
        regressor: The network.
        angles: Smallest and largest angle it was trained with, rad.
        speeds: Smallest and largest speed, m/s.
    """

    vehicle: SynchroDrive
    design: DesignName
    regressor: Regressor
    angles: tuple[float, float]
    speeds: tuple[float, float]

    @checked
    def tangent(self, v: ArrayLike, theta: ArrayLike) -> Array:
        """Tangent lengths (...) in m at speeds (...) in m/s and angles (...) in rad; 0 at speed 0.

        Warns:
            OutsideTraining: Speeds above 0 or angles outside the training range.

        Raises:
            InvalidSetting: Speeds below 0, angles outside [0, pi), or numbers that are not finite.
        """
        v, theta = _together(v, theta)
        if not (np.all((v >= 0) & (v < np.inf)) and np.all((theta >= 0) & (theta < np.pi))):
            raise InvalidSetting("speeds must be finite and at least 0, angles from 0 to below pi")
        moving = v > 0
        asked = ~self.covers(v, theta) & moving
        if asked.any():
            warn(
                f"{asked.sum()} of {asked.size} turns lie outside the training range of {self.speeds[0]:.4g} to "
                f"{self.speeds[1]:.4g} m/s and {np.degrees(self.angles[0]):.4g} to {np.degrees(self.angles[1]):.4g} "
                "degrees: the error there is unknown",
                OutsideTraining,
            )
        lengths = np.zeros(v.shape)
        lengths[moving] = self._predict(v[moving], theta[moving])
        return lengths

    @checked
    def covers(self, v: ArrayLike, theta: ArrayLike) -> NDArray[np.bool_]:
        """Whether speeds (...) and angles (...) lie in the training range."""
        v, theta = _together(v, theta)
        slack = 1 + 1e-9
        fast = (v * slack >= self.speeds[0]) & (v <= self.speeds[1] * slack)
        turned = (theta * slack >= self.angles[0]) & (theta <= self.angles[1] * slack)
        return np.asarray(fast & turned)

    @checked
    def at(self, theta: Array) -> LearnedCorners:
        """The network at the corners of a route, with angles (n,) in rad.

        Warns:
            OutsideTraining: Angles outside the training range: there the closed form is used.
        """
        theta = array("theta", theta, "n")
        known = self.covers(self.speeds[1], theta)
        if not known.all():
            corners = ", ".join(f"{i + 1} ({np.degrees(theta[i]):.3g} degrees)" for i in np.flatnonzero(~known))
            warn(
                f"corner {corners} lies outside the training range of {np.degrees(self.angles[0]):.4g} to "
                f"{np.degrees(self.angles[1]):.4g} degrees: the closed form is used there",
                OutsideTraining,
            )
        return LearnedCorners(self, theta, known, lead_time(theta, self.vehicle))

    def errors(self) -> TurnErrors:
        """Its errors over the paper's test set, for angles from 1 degree on."""
        points = judging_points(self.vehicle)
        true = points[:, 0] * lead_time(points[:, 1], self.vehicle)
        return turn_errors(self._predict(points[:, 0], points[:, 1]), true)

    @checked
    def save(self, file: str | Path) -> None:
        """Write the network, the robot and its training range: ``.npz``; ``load_turn`` reads it.

        Raises:
            InvalidSetting: Another suffix.
            CannotWrite: The file cannot be written.
        """
        robot = self.vehicle
        limits = (robot.v_max, robot.a_max, robot.omega_max, robot.alpha_max, robot.radius)
        own = {"robot": robot.name, "limits": limits, "design": self.design, "range": (*self.angles, *self.speeds)}
        save_arrays(network_file(file), {**arrays_of(self.regressor), **own})

    def _predict(self, v: Array, theta: Array) -> Array:
        design = DESIGNS[self.design]
        v = np.maximum(v, self.speeds[0] / 100)  # the logarithm of nearly nothing
        return design.tangent(self.regressor.predict(design.inputs(v, theta)))


def _together(v: ArrayLike, theta: ArrayLike) -> tuple[Array, Array]:
    """Speeds and angles of a caller, checked and of one shape.

    Raises:
        InvalidSetting: Not numbers, or of shapes that do not go together.
    """
    speeds, angles = array("v", v, "...", finite=False), array("theta", theta, "...", finite=False)
    try:
        shape = np.broadcast_shapes(speeds.shape, angles.shape)
    except ValueError:
        raise InvalidSetting(f"speeds {speeds.shape} and angles {angles.shape} do not go together") from None
    return np.broadcast_to(speeds, shape), np.broadcast_to(angles, shape)


@dataclass(frozen=True, eq=False)
class LearnedCorners:
    """The network at given corners.

    Attributes:
        model: The network.
        theta: Angles (n,), rad.
        known: Whether they are in the training range (n,).
        g: The closed form (n,), s.
    """

    model: LearnedTurn
    theta: Array
    known: NDArray[np.bool_]
    g: Array

    @property
    def slowest(self) -> float:
        """The slowest speed it knows, m/s: below, the robot stops."""
        return self.model.speeds[0]

    def tangents(self, V: Array) -> Array:
        """Tangent lengths (k, n) in m at speeds V (k, n) in m/s, 0 or in the training range."""
        lengths = V * self.g
        asked = (V > 0) & self.known
        lengths[asked] = self.model._predict(V[asked], np.broadcast_to(self.theta, V.shape)[asked])
        return lengths

    def report(self, v: Array) -> TurnReport:
        """The errors at the speeds (n,) of a plan."""
        error = np.abs(self.tangents(v[None])[0] - v * self.g)
        return TurnReport(float(error.max(initial=0.0)), tuple(int(i) + 1 for i in np.flatnonzero(~self.known)))


@checked
def learn_turn(
    vehicle: SynchroDrive,
    *,
    design: DesignName = "log",
    hidden: Sequence[int] = (5, 5),
    trainer: str | Trainer = "lm",
    iterations: int = 300,
    points: Array | None = None,
    rng: int | np.random.Generator | None = 0,
    watch: Watch | None = None,
) -> LearnedTurn:
    """Train a network on exact tangent lengths of turns.

    Args:
        vehicle: The robot.
        design: ``log`` (logarithms of speed and length, square root of the angle) or ``paper`` (no transformation).
        hidden: Neurons of each hidden layer.
        trainer: By name or as an object.
        iterations: Largest number of iterations. After 300, plans miss the goal by millimetres; after 4,000, by tenths
            of a millimetre.
        points: Speeds and angles (n, 2) in m/s and rad to learn from; default: the paper's grid. ``log`` leaves out
            angles below half a degree, as their logarithms diverge.
        rng: Seed or generator of the first weights; ``None`` is a fixed seed.
        watch: Called after every iteration with the number of iterations and the error; returning True ends the
            training.

    Raises:
        UnknownName: No such design or trainer.
        InvalidSetting: Too few points.
    """
    use = lookup("design", design, DESIGNS)
    points = coarse_grid(vehicle) if points is None else array("points", points, "n", 2)
    if design == "log":
        points = points[points[:, 1] >= np.radians(0.5)]
    v, theta = points.T
    alpha = v * lead_time(theta, vehicle)
    angles, speeds = (float(theta.min()), float(theta.max())), (float(v.min()), float(v.max()))
    return wrapped(
        lambda: fit(use.inputs(v, theta), use.output(alpha), hidden, trainer, iterations, rng, watch),
        lambda regressor: LearnedTurn(vehicle, design, regressor, angles, speeds),
    )


@checked
def load_turn(file: str | Path) -> LearnedTurn:
    """A network that ``LearnedTurn.save`` wrote, with the robot that it was learned for.

    Raises:
        InvalidSetting: The file is missing, or does not hold such a network.
    """
    arrays = read_arrays(Path(file), InvalidSetting, "a saved turn")
    if missing := [key for key in ("robot", "limits", "design", "range") if key not in arrays]:
        raise InvalidSetting(f"{file} is not a saved turn: it has no {', '.join(missing)}")
    regressor = regressor_of(arrays, str(file))
    try:
        design = str(arrays["design"])
        lookup("design", design, DESIGNS)
        vehicle = SynchroDrive(str(arrays["robot"]), *numbers(arrays["limits"], 5).tolist())
        least_angle, most_angle, least_speed, most_speed = numbers(arrays["range"], 4).tolist()
    except (MetaIKError, ValueError, TypeError) as error:
        raise InvalidSetting(f"{file} is not a saved turn: {error}") from None
    return LearnedTurn(vehicle, design, regressor, (least_angle, most_angle), (least_speed, most_speed))  # type: ignore[arg-type]
