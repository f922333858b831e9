"""The reachability map of a chain."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from pin_metaik.arguments import array, checked
from pin_metaik.errors import InvalidSetting
from pin_metaik.ik import IKStatus
from pin_metaik.plain import fields_of
from pin_metaik.reachable.files import STATUSES, read_map, write_map


@dataclass(frozen=True, eq=False)
class Reachability:
    """A map of which of k positions a chain reaches in which of m orientations.

    Attributes:
        positions: (k, 3) m, in the world.
        orientations: (m, 3, 3) of the chain's frame in the world; (0, 3, 3) if any orientation would do: then m is 1.
        status: (k, m) why each search ended, as indices into ``STATUSES``; 0: not looked at.
        manipulability: (k, m) Yoshikawa's measure sqrt(det(J J')) at the solution found, with the rows of J (m and rad)
            of the axes that are not free; NaN without a solution.
        shape: Number of positions along x, y and z of a grid; (k, 1, 1) for a list of positions.
        seconds: Time taken by the call, s.
    """

    positions: NDArray[np.float64]
    orientations: NDArray[np.float64]
    status: NDArray[np.uint8]
    manipulability: NDArray[np.float32]
    shape: tuple[int, int, int]
    seconds: float = 0.0

    @property
    def reached(self) -> NDArray[np.bool_]:
        """(k, m) whether each pose is reached."""
        reached: NDArray[np.bool_] = self.status == STATUSES.index(IKStatus.SOLVED)
        return reached

    @property
    def unreachable(self) -> NDArray[np.bool_]:
        """(k, m) whether it is proved that a pose is out of reach."""
        proved: NDArray[np.bool_] = self.status == STATUSES.index(IKStatus.UNREACHABLE)
        return proved

    @property
    def share(self) -> NDArray[np.float64]:
        """(k,) share of the orientations that is reached at each position: the reachability index."""
        share: NDArray[np.float64] = self.reached.mean(axis=1)
        return share

    @property
    def best(self) -> NDArray[np.float64]:
        """(k,) the greatest manipulability at each position, 0 where nothing is reached."""
        best: NDArray[np.float64] = np.where(self.reached, self.manipulability, 0.0).max(axis=1)
        return best

    @property
    def done(self) -> float:
        """The share of all poses that was looked at; below 1 the work was interrupted."""
        return float((self.status > 0).mean())

    @checked
    def save(self, path: str | Path) -> Path:
        """Write the map as NumPy's compressed ``.npz``, or as ``.parquet``, a table with a row for each pose.

        Raises:
            InvalidSetting: If the suffix is another one.
            MissingExtra: If it is Parquet and pyarrow is not installed.
            CannotWrite: If the file cannot be written.
        """
        names = "positions", "orientations", "status", "manipulability"
        arrays = {name: getattr(self, name) for name in names}
        return write_map(path, {**arrays, "shape": np.array(self.shape), "seconds": np.array(self.seconds)})

    @staticmethod
    @checked
    def load(path: str | Path) -> Reachability:
        """Read what ``save`` has written.

        Raises:
            InvalidSetting: If there is no such file, or it does not hold a map.
            MissingExtra: If it is Parquet and pyarrow is not installed.
        """
        arrays = read_map(path)
        try:
            k, m = arrays["status"].shape
            a, b, c = (int(n) for n in arrays["shape"])
            return Reachability(
                array("positions", arrays["positions"], k, 3),
                array("orientations", arrays["orientations"], "...", 3, 3).reshape(-1, 3, 3),
                arrays["status"].astype(np.uint8),
                arrays["manipulability"].astype(np.float32).reshape(k, m),
                (a, b, c),
                float(arrays["seconds"]),
            )
        except (ValueError, KeyError, TypeError, OverflowError) as error:
            raise InvalidSetting(f"{path} is not a map that Reachability.save has written: {error}") from None

    def at(self, xyz: ArrayLike) -> float:
        """The share of orientations that is reached at the position of the map nearest to xyz (3,).

        Raises:
            InvalidSetting: If that is not a position.
        """
        place = array("xyz", xyz, 3)
        return float(self.share[int(((self.positions - place) ** 2).sum(axis=1).argmin())])

    def as_dict(self) -> dict[str, Any]:
        """Plain values, for JSON: positions in m, the share reached and the best manipulability of each."""
        return fields_of(self, "positions", "shape", "share", "best", "done", "seconds")

    def __str__(self) -> str:
        k, m = self.status.shape
        reached, proved = int(self.reached.sum()), int(self.unreachable.sum())
        counts = f"{reached:,} of {k * m:,} poses reached, {proved:,} proved out of reach"
        return f"{k:,} positions, {m} orientations: {counts}" + (f"; {self.done:.0%} done" if self.done < 1.0 else "")
