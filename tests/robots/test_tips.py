"""The tip that is meant: robots of other people, whose links are named and hang together as theirs do."""

import pytest

from pin_metaik.robots import load_robot
from pin_metaik.robots.library import TIPS, catalogue, example_robots

LIMIT = '<limit lower="-2" upper="2" effort="1" velocity="1"/>'


def tree(*joints: str) -> str:
    """A robot of joints written as "parent child kind joint leader"; the last three can be left out."""
    text, links = "", {}
    for words in joints:
        parent, child, kind, name, leader = [*words.split(), *[""] * 5][:5]
        tag = f'<mimic joint="{leader}"/>' if leader else ""
        links |= dict.fromkeys([parent, child])
        text += (
            f'<joint name="{name or child + "_joint"}" type="{kind or "fixed"}"><parent link="{parent}"/>'
            f'<child link="{child}"/><axis xyz="0 0 1"/>{LIMIT}{tag}</joint>'
        )
    return f'<robot name="r">{"".join(f"<link name={link!r}/>" for link in links)}{text}</robot>'


def limb(first: str, *links: str, kind: str = "revolute") -> list[str]:
    return [f"{parent} {child} {kind}" for parent, child in zip([first, *links], links, strict=False)]


ROBOTS = {
    "Gen3 with a camera": (
        "EndEffector_Link",
        tree(
            *limb("base_link", "Shoulder_Link", "HalfArm1_Link", "ForeArm_Link", "Bracelet_Link"),
            "Bracelet_Link EndEffector_Link",
            "Bracelet_Link camera_link",
            "camera_link camera_depth_frame",
            "camera_link camera_color_frame",
        ),
    ),
    "Franka without a hand": (
        "fr3_link8",
        tree(
            *limb("fr3_link0", "fr3_link1", "fr3_link6", "fr3_link7"),
            "fr3_link6 fr3_link6_sc",
            "fr3_link7 fr3_link7_sc",
            "fr3_link7 fr3_link8",
        ),
    ),
    "Franka with a hand": (
        "fr3_hand_tcp",
        tree(
            *limb("fr3_link0", "fr3_link1", "fr3_link7"),
            "fr3_link7 fr3_link8",
            "fr3_link8 fr3_hand",
            "fr3_hand fr3_hand_tcp",
            "fr3_hand fr3_leftfinger prismatic fr3_finger_joint1",
            "fr3_hand fr3_rightfinger prismatic fr3_finger_joint2 fr3_finger_joint1",
        ),
    ),
    "Jaco": (
        "j2n6s200_end_effector",
        tree(
            *limb("root", "j2n6s200_link_1", "j2n6s200_link_5", "j2n6s200_link_6"),
            "j2n6s200_link_6 j2n6s200_end_effector",
            *limb("j2n6s200_link_6", "j2n6s200_link_finger_1", "j2n6s200_link_finger_tip_1"),
            *limb("j2n6s200_link_6", "j2n6s200_link_finger_2", "j2n6s200_link_finger_tip_2"),
        ),
    ),
    "YuMi": (
        "gripper_l_base",
        tree(
            *limb("yumi_body", "yumi_link_1_l", "yumi_link_6_l", "yumi_link_7_l"),
            "yumi_link_7_l gripper_l_base",
            "gripper_l_base gripper_l_finger_r prismatic gripper_l_joint",
            "gripper_l_base gripper_l_finger_l prismatic gripper_l_joint_m gripper_l_joint",
            *limb("yumi_body", "yumi_link_1_r", "yumi_link_6_r", "yumi_link_7_r"),
            "yumi_link_7_r gripper_r_base",
            "gripper_r_base gripper_r_finger_r prismatic gripper_r_joint",
            "gripper_r_base gripper_r_finger_l prismatic gripper_r_joint_m gripper_r_joint",
        ),
    ),
    "WidowX with a propeller": (
        "ee_gripper_link",
        tree(
            *limb("base_link", "shoulder_link", "upper_arm_link", "forearm_link", "wrist_link", "gripper_link"),
            "gripper_link gripper_prop_link continuous gripper",
            "gripper_link gripper_bar_link",
            "gripper_bar_link fingers_link",
            "fingers_link left_finger_link prismatic left_finger",
            "fingers_link right_finger_link prismatic right_finger left_finger",
            "fingers_link ee_gripper_link",
        ),
    ),
    "WidowX whose links begin with a slash": (
        "/ee_gripper_link",
        tree(
            *limb("/base_link", "/shoulder_link", "/wrist_link", "/gripper_link"),
            "/gripper_link /gripper_prop_link continuous gripper",
            "/gripper_link /left_finger_link prismatic left_finger",
            "/gripper_link /ee_gripper_link",
        ),
    ),
    "Stretch": (
        "link_grasp_center",
        tree(
            *limb("base_link", "link_lift", "link_arm_l1", "link_arm_l0", kind="prismatic"),
            *limb("link_arm_l0", "link_wrist_yaw", "link_wrist_pitch", "link_wrist_roll"),
            "link_wrist_roll link_gripper_s3_body",
            "link_gripper_s3_body link_grasp_center",
            "link_gripper_s3_body link_gripper_finger_left revolute joint_gripper_finger_left",
            "link_gripper_finger_left link_gripper_fingertip_left",
            "link_gripper_fingertip_left link_aruco_fingertip_left",
            *limb("base_link", "link_head_pan", "link_head_tilt"),
            "link_head_tilt camera_link",
        ),
    ),
    "Atlas": (
        "l_hand",
        tree(
            *limb("pelvis", "utorso", "l_clav", "l_scap", "l_larm", "l_hand"),
            "l_hand l_hand_camera_frame",
            "l_hand_camera_frame l_hand_camera_optical_frame",
            *limb("pelvis", "l_uglut", "l_lleg", "l_foot"),
        ),
    ),
    "SO-101": (
        "gripper_frame_link",
        tree(
            *limb("base_link", "shoulder_link", "upper_arm_link", "wrist_link", "gripper_link"),
            "gripper_link gripper_frame_link",
            "gripper_link moving_jaw_so101_v1_link revolute gripper",
        ),
    ),
    "a UR": (
        "tool0",
        tree(
            *limb("base_link", "forearm_link", "wrist_3_link"),
            "wrist_3_link ee_link",
            "wrist_3_link flange",
            "flange tool0",
        ),
    ),
    "a Robotiq gripper on a flange": (
        "flange",
        tree(
            *limb("base_link", "link_1", "link_6"),
            "link_6 flange",
            "flange robotiq_85_base_link",
            "robotiq_85_base_link left_knuckle_link revolute robotiq_85_left_knuckle_joint",
            "robotiq_85_base_link right_knuckle_link revolute r_joint robotiq_85_left_knuckle_joint",
            "left_knuckle_link left_pad revolute l_pad_joint robotiq_85_left_knuckle_joint",
        ),
    ),
    "a palletizer, whose platform is held level by a joint that follows": (
        "tool_link",
        tree(
            "base_link upper revolute j1",
            "upper fore revolute j2",
            "fore platform revolute j3 j2",
            "platform tool_link revolute j4",
        ),
    ),
    "names that say nothing": ("e", tree(*limb("base", "a", "b", "c"), "c d revolute", "d e", "d f_screw")),
    "two fingers and nothing else": ("finger_1", tree("palm_base finger_1 revolute", "palm_base finger_2 revolute")),
    "links named as their joints": ("c", tree("base a revolute a", "a b revolute b", "b c revolute c")),
}


@pytest.mark.parametrize("robot", ROBOTS)
def test_the_tip_is_the_one_that_is_meant(robot):
    tip, urdf = ROBOTS[robot]
    assert load_robot(urdf).frame == tip


def test_no_named_robots_tip_is_a_finger_or_a_camera():
    words = ("finger", "thumb", "jaw", "camera", "optical", "imu")
    hands = ("allegro", "finger_edu")
    for name in (*catalogue(), *example_robots()):
        if not name.startswith(hands) and name not in TIPS and name not in ("alex_psyonic_hands", "pr2"):
            frame = load_robot(name).frame.lower()
            assert not any(word in frame for word in words), (name, frame)


def test_the_catalogue_ends_at_its_tool():
    assert {load_robot(name).frame for name in catalogue()} == {"tool0"}
