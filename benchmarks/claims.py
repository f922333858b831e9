"""Whether what is claimed is so: claimed successes by an independent judge, and UNREACHABLE of feasible targets.

    python benchmarks/claims.py [--models 200] [--each 4000] [--robots-each 9000] [--workers 2] [--out PAGE]

Robots by name and random models (see random_models.py): one to forty joints of every kind, up to three frames. Targets
are the poses of configurations that are random, at limits, in corners, at right angles and singular, exact or moved by
the whole tolerance (see feasible.py): all of them can be met. Whoever says otherwise, or claims a success that is none,
or leaves the limits, is wrong.

With ``--kept`` each model is written to a file when it is done, and not done again while the sources are the same.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from functools import cache
from pathlib import Path
from random import Random
from time import process_time
from typing import NamedTuple

import numpy as np
import pinocchio as pin
from feasible import FAMILIES, coordinates, direction
from judge import ROUNDING, Floats, Judge
from proof_soundness import sources
from random_models import random_model
from sections import conditions

import pin_metaik as mik

DEFAULT = 1e-5  # m and rad; tolerances of targets that are arrays
ALONE = 0.05  # of the targets: asked one by one, with tolerances and starts of their own
SLOW = 20  # times fewer targets for chains that no compiled loop takes as a whole: of several frames, with quaternions
FEW = mik.IKSolver(budget=mik.Budget(evaluations=4_000))  # boxes included: enough for proofs to be tried


class Counts(NamedTuple):
    """What came of feasible targets.

    Attributes:
        asked: Targets.
        claimed: Successes claimed.
        false: Of them, not within the tolerances.
        outside: Answers, whatever their status, outside the limits.
        contradicted: Targets called out of reach.
        seconds: Processor time, s.
    """

    asked: int = 0
    claimed: int = 0
    false: int = 0
    outside: int = 0
    contradicted: int = 0
    seconds: float = 0.0

    def __add__(self, other: tuple[float, ...]) -> Counts:  # type: ignore[override]
        return Counts(*(a + b for a, b in zip(self, other, strict=True)))


class Answer(NamedTuple):
    """An answer: the poses asked for (T, 4, 4), their tolerances (m, rad), the configuration, what is said of it."""

    poses: Floats
    tolerances: tuple[float, float]
    q: Floats
    status: mik.IKStatus


@cache
def named(robot: str) -> mik.Chain:
    """The chain of a robot by name."""
    loaded = mik.load_robot(robot)
    return mik.Chain(loaded.model, loaded.frame)


def counted(name: str, count: int) -> Counts:
    """What came of a robot by name, or of random model number ``name``."""
    rng = np.random.default_rng([7, *name.encode()])
    chain = random_model(Random(int(name))).chain() if name.isdigit() else named(name)
    began, judge, counts = process_time(), Judge(chain.model, chain.frame_ids), Counts()
    for answer in answers(chain, count if chain.has_pose_solver else max(1, count // SLOW), rng):
        claims = answer.status is mik.IKStatus.SOLVED
        near, aligned = (tolerance + ROUNDING for tolerance in answer.tolerances)
        misses = claims and any(d > near or a > aligned for d, a in judge.errors(answer.q, answer.poses))
        contradicts = answer.status is mik.IKStatus.UNREACHABLE
        counts += (1, claims, misses, judge.outside(answer.q), contradicts, 0.0)
    return counts._replace(seconds=process_time() - began)


def answers(chain: mik.Chain, count: int, rng: np.random.Generator) -> Iterator[Answer]:
    """Answers to feasible targets: most in batches of poses and of positions, some alone."""
    alone = round(ALONE * count) if chain.has_pose_solver else count
    for _ in range(alone):
        yield answer_alone(chain, rng)
    left = count - alone
    if left:
        poses = np.array([feasible(chain, rng, DEFAULT, DEFAULT)[0] for _ in range(left)])
        whole = left // 2
        for given, aligned in ((poses[:whole], DEFAULT), (poses[whole:, :3, 3], np.inf)):
            batch = mik.solve_ik_batch(chain, given, solver=FEW, workers=1)
            asked = poses[:whole] if given.ndim == 3 else poses[whole:]
            for pose, q, status in zip(asked, batch.q, batch.status, strict=True):
                yield Answer(pose[None], (DEFAULT, aligned), q, status)


def answer_alone(chain: mik.Chain, rng: np.random.Generator) -> Answer:
    """The answer to one target, from a random start, with tolerances of 1e-7 to 0.01."""
    near, aligned = 10.0 ** rng.uniform(-7.0, -2.0, 2)
    poses = feasible(chain, rng, near, aligned)
    tolerances = {"position_tolerance": float(near), "orientation_tolerance": float(aligned)}
    targets = [mik.Target(pin.SE3(pose), frame, **tolerances) for frame, pose in zip(chain.frames, poses, strict=True)]
    start = chain.q(chain.box.sample(rng, 1)[0]) if rng.random() < 0.5 else None
    result = mik.solve_ik(chain, targets, start, solver=FEW)
    return Answer(poses, (float(near), float(aligned)), result.q, result.status)


def feasible(chain: mik.Chain, rng: np.random.Generator, near: float, aligned: float) -> Floats:
    """Poses (T, 4, 4) that one configuration reaches, exactly or by no more than the tolerances (m, rad)."""
    family = str(
        rng.choice(FAMILIES if chain.n <= 10 else FAMILIES[:-1])
    )  # the last takes long to find for many joints
    poses = chain.poses(coordinates(chain, family, rng))[0].copy()
    if rng.random() < 0.5:
        for pose in poses:
            pose[:3, :3] = pose[:3, :3] @ pin.exp3((aligned - ROUNDING) * direction(rng))
            pose[:3, 3] += (near - ROUNDING) * direction(rng)
    return poses


def all_counted(names: dict[str, int], workers: int, kept: Path | None) -> dict[str, Counts]:
    """Counts of each model, less those that a file has already."""
    of = sources()
    lines = kept.read_text(encoding="utf-8").splitlines() if kept is not None and kept.exists() else []
    known = {(name, count): Counts(*counts) for by, name, count, counts in map(json.loads, lines) if by == of}
    with ProcessPoolExecutor(workers) as pool:
        todo = {pool.submit(counted, *one): one for one in names.items() if one not in known}
        for future in as_completed(todo):
            name, count = todo[future]
            known[name, count] = future.result()
            print(f"{name}: {known[name, count]}", flush=True)
            if kept is not None:
                with kept.open("a", encoding="utf-8") as file:
                    file.write(json.dumps([of, name, count, known[name, count]]) + "\n")
    return {name: known[name, count] for name, count in names.items()}


def page(counts: dict[str, Counts]) -> Iterator[str]:
    """The page, paragraph by paragraph."""
    yield "# Claims, judged"
    yield conditions()
    kinds = {
        "robots by name": [n for n in counts if not n.isdigit()],
        "random models": [n for n in counts if n.isdigit()],
    }
    titles = ["models", "feasible targets", "claimed successes", "false", "answers outside limits"]
    titles += ["called out of reach", "processor time, s"]
    table = [f"| | {' | '.join(titles)} |", "|---" + len(titles) * "|---:" + "|"]
    every = {**kinds, "all": [*counts]}
    for kind, names in every.items():
        total = sum((counts[name] for name in names), Counts())
        table.append(
            f"| {kind} | {len(names)} | {total.asked:,} | {total.claimed:,} | {total.false} | {total.outside} "
            f"| {total.contradicted} | {total.seconds:,.0f} |"
        )
    yield "\n".join(table)
    wrong = [name for name, c in counts.items() if c.false or c.outside or c.contradicted]
    if wrong:
        yield "Wrong: " + "; ".join(f"{name}: {counts[name]}" for name in wrong)


def main() -> None:
    """Ask, and write the page."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--models", type=int, default=200)
    parser.add_argument("--each", type=int, default=4_000, help="targets of each random model")
    parser.add_argument("--robots-each", type=int, default=9_000, help="targets of each robot")
    parser.add_argument("--robots", nargs="*", help="by name; default: all")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--kept", type=Path, help="file that finished models are kept in")
    parser.add_argument("--out", type=Path, default=Path(__file__).with_suffix(".md"))
    given = parser.parse_args()
    robots = mik.robot_names() if given.robots is None else given.robots
    names = dict.fromkeys(map(str, range(given.models)), given.each) | dict.fromkeys(robots, given.robots_each)
    found = all_counted(names, given.workers, given.kept)
    given.out.write_text("\n\n".join(page(found)) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
