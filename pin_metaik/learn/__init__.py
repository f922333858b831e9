"""Fuzzy c-means, small dense networks and their trainers, for any data."""

from pin_metaik.learn.fcm import Clusters, fuzzy_c_means, memberships
from pin_metaik.learn.files import load_regressor, save_regressor
from pin_metaik.learn.network import Network
from pin_metaik.learn.regressor import OutsideTraining, Regressor, fit
from pin_metaik.learn.trainers import TRAINERS, Trainer, Training, make_trainer, train

__all__ = [
    "TRAINERS",
    "Clusters",
    "Network",
    "OutsideTraining",
    "Regressor",
    "Trainer",
    "Training",
    "fit",
    "fuzzy_c_means",
    "load_regressor",
    "make_trainer",
    "memberships",
    "save_regressor",
    "train",
]
