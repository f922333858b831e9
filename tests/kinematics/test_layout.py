"""A chain in one block of memory: what goes in comes out."""

import pytest
from numpy.testing import assert_array_equal

import pin_metaik as mik
from pin_metaik.kinematics.kernel.layout import chain_in, samples_in, sizes_in

ROBOTS = {"ur5": "tool0", "panda": "panda_hand", "talos": ["gripper_left_base_link", "gripper_right_base_link"]}


@pytest.mark.parametrize("name", ROBOTS)
def test_a_block_gives_back_the_chain_it_was_made_of(name: str) -> None:
    chain = mik.Chain(mik.load_robot(name).model, ROBOTS[name])
    for block, form, samples in (
        (chain.block, chain.form, chain.sample_table.samples),
        (chain.bare, chain.form[:0], None),
    ):
        arm, bounds, entries, reach, packed_form = chain_in(block)
        assert sizes_in(block) == (len(arm.joints), chain.n, len(chain.frames))
        assert_array_equal(packed_form, form)
        for packed, given in zip((*arm, *bounds), (*chain.paths.arrays, *chain.limits.arrays), strict=True):
            assert_array_equal(packed, given)
        assert_array_equal(entries.most[entries.places[:, 0]], chain.limits.upper)
        assert reach.shape == (8,)
        found = samples_in(block)
        assert len(found.x) == (0 if samples is None else len(samples.x))
        if samples is not None:
            for packed, given in zip(found, samples, strict=True):
                assert_array_equal(packed, given)


def test_loops_read_the_bounds_on_reach_that_the_chain_has() -> None:
    chain = mik.Chain(mik.load_robot("ur5").model, "tool0")
    assert_array_equal(chain_in(chain.pose_solver.block).reach, chain.reach(0, True).array)
    assert_array_equal(chain_in(chain.position_solver.block).reach, chain.reach(0, False).array)
