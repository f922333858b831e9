"""One inverse-kinematics solver in a process of its own, in an environment that has it.

    python benchmarks/ik_worker.py NAME

reads requests on stdin and writes answers on stdout, a JSON object a line; ``ik_speed.py`` starts it.
"""

from __future__ import annotations

import gc
import json
import os
import sys
import time
from importlib.metadata import PackageNotFoundError, version
from typing import Any

import numpy as np
from ik_peers import EAIK, SOLVERS, Solver, Unsuitable
from ik_serial import SerialArm


def measured(solver: Solver, poses: list[Any], starts: list[Any]) -> dict[str, list[Any]]:
    """Answers to targets, and what each took in ns: on the wall, and its share of all threads' processor time.

    Processor time is read once for all, because reading it takes a while and the caches with it. The last target is
    solved once more, before the clocks run: that brings code and tables back after another solver has had the machine.
    The garbage collector need not walk through all targets again and again, which would count as somebody's time.
    """
    goals = [solver.goal(np.array(pose)) for pose in poses]
    begins = [solver.start(np.array(x)) for x in starts]
    wall, found = [], []
    gc.freeze()
    solver.solve(goals[-1], begins[-1])
    cpu = time.process_time_ns()
    for goal, begin in zip(goals, begins, strict=True):
        began = time.perf_counter_ns()
        answer = solver.solve(goal, begin)
        wall.append(time.perf_counter_ns() - began)
        found.append(answer)
    cpu = time.process_time_ns() - cpu
    gc.unfreeze()
    answers = [solver.answer(answer) for answer in found]
    return {
        "wall": wall,
        "cpu": [cpu / max(1, len(wall))] * len(wall),
        "x": [None if a.x is None else np.asarray(a.x, dtype=float).tolist() for a in answers],
        "evaluations": [a.evaluations for a in answers],
        "status": [a.status for a in answers],
    }


def reply(name: str, solvers: list[Solver], request: dict[str, Any]) -> dict[str, Any]:
    """The answer to one request; ``solvers`` holds the one that is loaded."""
    try:
        if request["do"] == "version":
            return {"version": version(SOLVERS[name].package)}
        if request["do"] == "load":
            solvers[:] = [SOLVERS[name](SerialArm.from_json(request["arm"]))]
        if request["do"] == "every":
            (solver,) = solvers
            assert isinstance(solver, EAIK)
            return {"every": [list(solver.every(solver.goal(np.array(pose)))) for pose in request["poses"]]}
        return measured(solvers[0], request["poses"], request["starts"])
    except PackageNotFoundError:
        return {"failed": f"{SOLVERS[name].package} is not installed"}
    except Unsuitable as error:
        return {"unsuitable": str(error)}
    except Exception as error:  # whatever it is, the other solvers go on
        return {"failed": f"{type(error).__name__}: {error}"}


def main() -> None:
    # Solvers print as they like: stdout is kept for answers, and what they print goes to stderr.
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    solvers: list[Solver] = []
    for line in sys.stdin:
        answers.write(json.dumps(reply(sys.argv[1], solvers, json.loads(line))) + "\n")
        answers.flush()


if __name__ == "__main__":
    main()
