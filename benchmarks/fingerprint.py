"""Every answer of fixed questions as digests, so that two trees can be compared to the last bit.

    python benchmarks/fingerprint.py after.json
    PYTHONPATH=OTHER_TREE python benchmarks/fingerprint.py before.json
    python benchmarks/fingerprint.py after.json --against before.json     # reads after.json if it is there

The questions are poses of three families for ten arms and targets that leave something free (``solve_ik``), poses for
twenty robots (``solve_ik_all``), ten paths (``solve_ik_path``) and three scenes (``solve_ik`` in a world). The digest
of an answer is of its status and of the bits of its configurations. The questions of a group have a digest, too, so
that other targets are not taken for other answers. Only names that ``pin_metaik`` has had from the beginning are used.
"""

from __future__ import annotations

import argparse
import json
from collections import Counter
from collections.abc import Callable, Iterator
from hashlib import blake2b
from pathlib import Path
from typing import Any

import numpy as np
from ik_targets import targets
from numpy.typing import NDArray
from rich.progress import track

import pin_metaik as mik
from pin_metaik.collision import load_scene, scene_names

ARMS = ("baxter", "kinova", "panda", "pr2", "talos", "tiago", "ur10", "ur5", "xarm7", "z1")
SOME_SIX = ("aerial_arm", "puma560", "puma_offset", "rv7fl", "rv7fl_paper", "ur3", "bravo7_no_ee", "tiago_no_hand")
OTHERS = ("cobra600", "so101")
FAMILIES = ("random", "near-limit", "singular")
COUNT, COUNT_OF_PARTS, COUNT_OF_ALL, COUNT_IN_WORLD = 1000, 100, 100, 100
POINTS = 200  # of a path
SEED = 20
MARGIN = 0.005  # m
ALL_BUDGET = mik.Budget(evaluations=20_000)  # a redundant arm would take minutes

Answer = tuple[bytes, str]  # digests of what was asked and of what came out
Group = tuple[str, Callable[[], Iterator[Answer]]]


def groups(scale: float = 1.0) -> Iterator[Group]:
    """The groups of questions by name; ``scale`` shrinks the number of questions in each."""

    def some(count: int) -> int:
        return max(1, round(scale * count))

    for robot in ARMS:
        for family in FAMILIES:
            yield f"solve_ik/{robot}/{family}", lambda robot=robot, family=family: poses(robot, family, some(COUNT))
        yield f"solve_ik/{robot}/parts", lambda robot=robot: parts(robot, some(COUNT_OF_PARTS))
    for robot in (*ARMS, *SOME_SIX, *OTHERS):
        yield f"solve_ik_all/{robot}", lambda robot=robot: every(robot, some(COUNT_OF_ALL))
    for robot in ARMS:
        yield f"solve_ik_path/{robot}", lambda robot=robot: path(robot, some(POINTS))
    for scene in scene_names():
        yield f"world/{scene}", lambda scene=scene: in_world(scene, some(COUNT_IN_WORLD))


def poses(robot: str, family: str, count: int) -> Iterator[Answer]:
    """Whole poses, from a random start each."""
    chain = chain_of(robot)
    asked = targets(robot, chain, family, count, SEED)
    for pose, start in zip(asked.poses, asked.starts, strict=True):
        yield answer(lambda: found(mik.solve_ik(chain, pose, chain.q(start))), pose, start)  # noqa: B023


def parts(robot: str, count: int) -> Iterator[Answer]:
    """Positions, orientations, a free axis of each, and tolerances, in turn."""
    chain = chain_of(robot)
    asked = targets(robot, chain, "random", count, SEED + 1)
    kinds: tuple[Callable[[NDArray[np.float64]], Any], ...] = (
        lambda T: T[:3, 3],
        lambda T: mik.Target(T, position_tolerance=np.inf),
        lambda T: mik.Target(T, orientation_tolerance=(1e-5, 1e-5, np.inf)),
        lambda T: mik.Target(T, position_tolerance=(1e-5, np.inf, 1e-5)),
        lambda T: mik.Target(T, position_tolerance=0.01, orientation_tolerance=0.1),
    )
    for i, (pose, start) in enumerate(zip(asked.poses, asked.starts, strict=True)):
        goal = kinds[i % len(kinds)]
        yield answer(lambda: found(mik.solve_ik(chain, goal(pose), chain.q(start))), pose, start)  # noqa: B023


def every(robot: str, count: int) -> Iterator[Answer]:
    """All solutions of a pose, or as many as the budget finds."""
    chain = chain_of(robot)
    for pose in targets(robot, chain, "random", count, SEED + 2).poses:

        def all_of() -> tuple[str, Any]:
            solutions = mik.solve_ik_all(chain, pose, budget=ALL_BUDGET)  # noqa: B023
            return f"{len(solutions)} solutions", solutions.q

        yield answer(all_of, pose)


def path(robot: str, count: int) -> Iterator[Answer]:
    """The poses of a straight way between two configurations; each pose is an answer."""
    chain = chain_of(robot)
    first, last = targets(robot, chain, "random", 2, SEED + 3).starts
    way = first + np.linspace(0.0, 0.25, count)[:, None] * (last - first)
    along = np.array([chain.placements(q)[0].homogeneous for q in chain.q(way)])
    q0 = chain.q(first)
    walked = mik.solve_ik_path(chain, along, q0)
    for pose, q, met in zip(along, walked.q, walked.success, strict=True):
        yield answer(lambda: ("met" if met else "not met", q), pose, q0)  # noqa: B023


def in_world(scene: str, count: int) -> Iterator[Answer]:
    """Whole poses of the Panda's tool among obstacles."""
    robot = mik.load_robot("panda")
    chain = mik.Chain(robot.model, robot.frame)
    world = mik.CollisionWorld(robot, load_scene(scene), margin=MARGIN)
    for pose in targets("panda", chain, "random", count, SEED + 4).poses:
        yield answer(lambda: found(mik.solve_ik(chain, pose, world=world)), pose)  # noqa: B023


def chain_of(robot: str) -> mik.Chain:
    loaded = mik.load_robot(robot)
    return mik.Chain(loaded.model, loaded.frame)


def found(result: mik.IKResult) -> tuple[str, NDArray[np.float64]]:
    return str(result.status), result.q


def answer(ask: Callable[[], tuple[str, NDArray[np.float64]]], *asked: NDArray[np.float64]) -> Answer:
    """Digests of a question and of its answer; an error of the package's family is an answer, too."""
    question = b"".join(np.ascontiguousarray(array).tobytes() for array in asked)
    try:
        status, q = ask()
    except mik.MetaIKError as error:
        return question, type(error).__name__
    return question, f"{status} {digest(np.ascontiguousarray(q).tobytes())}"


def digest(data: bytes) -> str:
    return blake2b(data, digest_size=4).hexdigest()


def fingerprint(scale: float, only: str = "") -> dict[str, dict[str, Any]]:
    """Digests of the questions of each group, of its answers together, and of each of its answers.

    ``only`` is how the names of the groups begin.
    """
    prints: dict[str, dict[str, Any]] = {}
    asked = [(name, ask) for name, ask in groups(scale) if name.startswith(only)]
    for name, ask in track(asked, "groups", transient=True):
        try:
            answers = list(ask())
        except mik.MetaIKError as error:  # a robot or scene that this tree does not have
            prints[name] = {"questions": type(error).__name__, "digest": "", "answers": []}
            continue
        texts = [text for _, text in answers]
        prints[name] = {
            "questions": digest(b"".join(question for question, _ in answers)),
            "digest": digest("\n".join(texts).encode()),
            "answers": texts,
        }
    return prints


def differences(ours: dict[str, dict[str, Any]], theirs: dict[str, dict[str, Any]]) -> Iterator[str]:
    """A line for each group of both that differs: in how many answers, and which statuses became which."""
    for name in sorted(ours.keys() & theirs.keys()):
        one, other = ours[name], theirs[name]
        if one["questions"] != other["questions"]:
            yield f"{name}: other questions"
        elif one["digest"] != other["digest"]:
            yield f"{name}: {_changes(other['answers'], one['answers'])}"


def _changes(before: list[str], after: list[str]) -> str:
    differ = [(old, new) for old, new in zip(before, after, strict=True) if old != new]
    became = Counter((old.rpartition(" ")[0] or old, new.rpartition(" ")[0] or new) for old, new in differ)
    kinds = [
        f"{number} {old} -> {new}" if old != new else f"{number} {old} with another configuration"
        for (old, new), number in became.most_common()
    ]
    return f"{len(differ)} of {len(after)} answers differ: {'; '.join(kinds)}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=Path, help="JSON file for the digests; not computed anew with --against if there")
    parser.add_argument("--against", type=Path, help="JSON file of another tree, to compare with")
    parser.add_argument("--scale", type=float, default=1.0, help="share of the questions of each group")
    parser.add_argument("--only", default="", help="beginning of the names of the groups to ask, such as world/")
    arguments = parser.parse_args()
    if arguments.against is None or not arguments.out.exists():
        arguments.out.write_text(
            json.dumps(fingerprint(arguments.scale, arguments.only), indent=0) + "\n", encoding="utf-8"
        )
    ours = json.loads(arguments.out.read_text(encoding="utf-8"))
    print(f"{sum(len(group['answers']) for group in ours.values()):,} answers in {len(ours)} groups")
    if arguments.against is not None:
        lines = list(differences(ours, json.loads(arguments.against.read_text(encoding="utf-8"))))
        print("\n".join(lines) or "all equal, to the last bit")


if __name__ == "__main__":
    main()
