"""Solvers of other packages, through the same protocol; each needs its package."""

from __future__ import annotations

from pin_metaik.compare.methods.peers.ikpy import IKPY
from pin_metaik.compare.methods.peers.peer import Peer
from pin_metaik.compare.methods.peers.pink import PINK
from pin_metaik.compare.methods.peers.toolbox import TOOLBOX
from pin_metaik.compare.methods.peers.trac_ik import TRAC_IK

PEERS: dict[str, Peer] = {peer.name: peer for peer in (IKPY, PINK, TRAC_IK, TOOLBOX)}

__all__ = ["PEERS", "Peer"]
