"""The compiled loops of kinematics: numbers in, numbers out. Nothing here knows a chain, a target or a problem.

``layout`` says where every number lies, ``scratch`` what the loops work in, ``entry`` what Python may call. Each of the
others uses those before it: ``forward`` kinematics, ``goals``, ``descent``, ``warm_starts``, ``multistart``; beside
them ``closed_form``; ``pose_solver`` has them all. ``reference`` is the same solver in Pinocchio and NumPy, to be read.
"""
