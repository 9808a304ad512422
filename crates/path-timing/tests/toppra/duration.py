"""The time-optimal duration of a line of a polar arm, by toppra (PyPI) at many cells."""

import logging
import sys

import numpy as np
import toppra
import toppra.algorithm
import toppra.constraint

SAMPLES = 4001
CELLS = 4000

logging.disable(logging.CRITICAL)


def duration(x0, y0, x1, y1, v0, v1, a0, a1):
    length = np.hypot(x1 - x0, y1 - y0)
    s = np.linspace(0.0, length, SAMPLES)
    x, y = x0 + (x1 - x0) * s / length, y0 + (y1 - y0) * s / length
    path = toppra.SplineInterpolator(s, np.stack([np.arctan2(y, x), np.hypot(x, y)], axis=1))
    limits = [
        toppra.constraint.JointVelocityConstraint(np.array([[-v0, v0], [-v1, v1]])),
        toppra.constraint.JointAccelerationConstraint(np.array([[-a0, a0], [-a1, a1]])),
    ]
    grid = np.linspace(0.0, length, CELLS + 1)
    optimal = toppra.algorithm.TOPPRA(limits, path, gridpoints=grid)
    return optimal.compute_trajectory(0, 0).duration


for line in sys.stdin:
    print(duration(*map(float, line.split())))
