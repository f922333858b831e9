"""Collisions: shapes, scenes, and the world that checks them through Pinocchio and coal."""

from pin_metaik.collision.clouds import HeightField, Octree, PointCloud
from pin_metaik.collision.contact import Contact, Distance
from pin_metaik.collision.mesh import Mesh, MeshSize
from pin_metaik.collision.move import Move, MoveStatus
from pin_metaik.collision.obstacle import Obstacle
from pin_metaik.collision.picture import draw_world, save_world
from pin_metaik.collision.scene import load_scene, scene_names
from pin_metaik.collision.shapes import Box, Capsule, Cone, Cylinder, HalfSpace, Plane, Shape, Sphere
from pin_metaik.collision.world import CollisionWorld

__all__ = [
    "Box",
    "Capsule",
    "CollisionWorld",
    "Cone",
    "Contact",
    "Cylinder",
    "Distance",
    "HalfSpace",
    "HeightField",
    "Mesh",
    "MeshSize",
    "Move",
    "MoveStatus",
    "Obstacle",
    "Octree",
    "Plane",
    "PointCloud",
    "Shape",
    "Sphere",
    "draw_world",
    "load_scene",
    "save_world",
    "scene_names",
]
