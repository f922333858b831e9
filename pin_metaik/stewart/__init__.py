"""General Stewart platforms: analysis and dimensional optimisation, after Inner and Kucuk (TOK 2014).

Their legs are linear actuators, or rods moved by servos. Lengths are in m and angles in rad everywhere but in files,
which say their own units. Poses are those of the point P of the platform in the base frame: ``pin.SE3``, (4, 4), or
many (k, 4, 4).

from pin_metaik import stewart

mechanism = stewart.load_mechanism("stroke_100")     # of the catalogue, or the path of a .toml file
stewart.leg_lengths(mechanism.geometry, stewart.pose_at((0, 0, 0.23)))
mechanism.survey().gdi
stewart.design(mechanism).mechanism
"""

from pin_metaik.figures import save_picture
from pin_metaik.stewart.files.library import load_mechanism, mechanism_names
from pin_metaik.stewart.files.points import save_points
from pin_metaik.stewart.files.reading import read_mechanism
from pin_metaik.stewart.files.ways import read_trajectory, save_motion
from pin_metaik.stewart.files.writing import save_mechanism, to_toml
from pin_metaik.stewart.kinematics.assemblies import Assemblies, all_forward
from pin_metaik.stewart.kinematics.conditioning import Dexterity, best_length, characteristic_length, conditioning
from pin_metaik.stewart.kinematics.forward import Forward, ForwardStatus, forward
from pin_metaik.stewart.kinematics.interference import leg_distances
from pin_metaik.stewart.kinematics.inverse import inverse, leg_lengths, leg_vectors
from pin_metaik.stewart.kinematics.jacobian import homogenised, jacobian, transmission, velocity_equation
from pin_metaik.stewart.kinematics.judging import judge_poses
from pin_metaik.stewart.kinematics.trajectory import Motion, Trajectory, follow, straight
from pin_metaik.stewart.mechanism.mechanism import Mechanism
from pin_metaik.stewart.mechanism.ranges import Ranges
from pin_metaik.stewart.mechanism.task import DesignTask
from pin_metaik.stewart.model.closure import ClosedModel, closed_model
from pin_metaik.stewart.model.urdf import save_urdf, to_urdf
from pin_metaik.stewart.platform.actuation import Links
from pin_metaik.stewart.platform.geometry import Geometry, legs_of
from pin_metaik.stewart.platform.layouts import NAMED, standard_geometry
from pin_metaik.stewart.platform.limits import LegLimits, ServoLimits
from pin_metaik.stewart.platform.poses import pose_at
from pin_metaik.stewart.platform.servos import Servos
from pin_metaik.stewart.platform.states import PoseState
from pin_metaik.stewart.show.curves import draw_history, draw_motion
from pin_metaik.stewart.show.picture import draw, draw_above, draw_into
from pin_metaik.stewart.synthesis.design import Designed, design
from pin_metaik.stewart.synthesis.fitness import Fitness, Score
from pin_metaik.stewart.synthesis.type_designs import TypeDesign, compare_types, new_mechanism, new_servo_mechanism
from pin_metaik.stewart.workspace.grid import Grid
from pin_metaik.stewart.workspace.singularity import Crossing, Singularities, crossings, singularities
from pin_metaik.stewart.workspace.surveying import survey
from pin_metaik.stewart.workspace.workspace import EmptyWorkspace, Verdict, Workspace

__all__ = [
    "NAMED",
    "Assemblies",
    "ClosedModel",
    "Crossing",
    "DesignTask",
    "Designed",
    "Dexterity",
    "EmptyWorkspace",
    "Fitness",
    "Forward",
    "ForwardStatus",
    "Geometry",
    "Grid",
    "LegLimits",
    "Links",
    "Mechanism",
    "Motion",
    "PoseState",
    "Ranges",
    "Score",
    "ServoLimits",
    "Servos",
    "Singularities",
    "Trajectory",
    "TypeDesign",
    "Verdict",
    "Workspace",
    "all_forward",
    "best_length",
    "characteristic_length",
    "closed_model",
    "compare_types",
    "conditioning",
    "crossings",
    "design",
    "draw",
    "draw_above",
    "draw_history",
    "draw_into",
    "draw_motion",
    "follow",
    "forward",
    "homogenised",
    "inverse",
    "jacobian",
    "judge_poses",
    "leg_distances",
    "leg_lengths",
    "leg_vectors",
    "legs_of",
    "load_mechanism",
    "mechanism_names",
    "new_mechanism",
    "new_servo_mechanism",
    "pose_at",
    "read_mechanism",
    "read_trajectory",
    "save_mechanism",
    "save_motion",
    "save_picture",
    "save_points",
    "save_urdf",
    "singularities",
    "standard_geometry",
    "straight",
    "survey",
    "to_toml",
    "to_urdf",
    "transmission",
    "velocity_equation",
]
