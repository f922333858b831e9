"""The cases: one file and one line each."""

from __future__ import annotations

from pin_metaik.compare.cases.at_limits import AT_LIMITS
from pin_metaik.compare.cases.boundary import BOUNDARY
from pin_metaik.compare.cases.calibrated import CALIBRATED
from pin_metaik.compare.cases.case import Case
from pin_metaik.compare.cases.cluttered import CLUTTERED
from pin_metaik.compare.cases.cup_upright import CUP_UPRIGHT
from pin_metaik.compare.cases.five_dof import FIVE_DOF
from pin_metaik.compare.cases.just_out_of_reach import JUST_OUT_OF_REACH
from pin_metaik.compare.cases.look_at import LOOK_AT
from pin_metaik.compare.cases.minimal_displacement import MINIMAL_DISPLACEMENT
from pin_metaik.compare.cases.near_limit import NEAR_LIMIT
from pin_metaik.compare.cases.no_solution import NO_SOLUTION
from pin_metaik.compare.cases.out_by import OUT_BY
from pin_metaik.compare.cases.path import PATH
from pin_metaik.compare.cases.random_poses import RANDOM
from pin_metaik.compare.cases.singular import SINGULAR_POSES
from pin_metaik.compare.cases.two_hands import TWO_HANDS
from pin_metaik.compare.cases.whole_body import WHOLE_BODY

CASES: dict[str, Case] = {
    "random": RANDOM,
    "near_limit": NEAR_LIMIT,
    "at_limits": AT_LIMITS,
    "singular": SINGULAR_POSES,
    "boundary": BOUNDARY,
    "no_solution": NO_SOLUTION,
    "just_out_of_reach": JUST_OUT_OF_REACH,
    **OUT_BY,
    "minimal_displacement": MINIMAL_DISPLACEMENT,
    "cluttered": CLUTTERED,
    "five_dof": FIVE_DOF,
    "calibrated": CALIBRATED,
    "path": PATH,
    "look_at": LOOK_AT,
    "cup_upright": CUP_UPRIGHT,
    "two_hands": TWO_HANDS,
    "whole_body": WHOLE_BODY,
}
