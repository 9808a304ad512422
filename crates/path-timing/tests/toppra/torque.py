"""The time-optimal duration of a line of a two-link arm within the torques of its motors, by toppra."""

import logging
import sys

import numpy as np
import toppra
import toppra.algorithm
import toppra.constraint

SAMPLES = 4001
CELLS = 4000
LINK = 0.3
TORQUES = np.array([30.0, 12.0])

logging.disable(logging.CRITICAL)


def inverse(x, y):
    """The joints of an arm of two links of 0.3 m whose elbow is right of the line to the tool."""
    elbow = np.arccos((x * x + y * y - 2 * LINK * LINK) / (2 * LINK * LINK))
    return np.arctan2(y, x) - elbow / 2, elbow


def inverse_dynamics(load):
    k = (2.0 * 0.12 + load * LINK) * LINK
    delta = 0.02 + 2.0 * 0.12**2 + load * LINK**2
    alpha = 0.03 + 3.0 * 0.15**2 + (2.0 + load) * LINK**2 + delta

    def torques(q, v, a):
        sin, cos = k * np.sin(q[1]), k * np.cos(q[1])
        return np.array([
            (alpha + 2 * cos + 0.08) * a[0] + (delta + cos) * a[1]
            - sin * (2 * v[0] * v[1] + v[1] ** 2),
            (delta + cos) * a[0] + (delta + 0.03) * a[1] + sin * v[0] ** 2,
        ])

    return torques


def duration(x0, y0, x1, y1, load):
    ends = np.array([x0, y0, x1, y1]) / 1000.0
    length = np.hypot(ends[2] - ends[0], ends[3] - ends[1])
    s = np.linspace(0.0, length, SAMPLES)
    x = ends[0] + (ends[2] - ends[0]) * s / length
    y = ends[1] + (ends[3] - ends[1]) * s / length
    path = toppra.SplineInterpolator(s, np.stack(inverse(x, y), axis=1))
    limits = [
        toppra.constraint.JointTorqueConstraint(
            inverse_dynamics(load), np.stack([-TORQUES, TORQUES], axis=1), np.zeros(2)
        ),
        toppra.constraint.JointVelocityConstraint(np.array([[-30.0, 30.0], [-30.0, 30.0]])),
    ]
    grid = np.linspace(0.0, length, CELLS + 1)
    optimal = toppra.algorithm.TOPPRA(limits, path, gridpoints=grid)
    return optimal.compute_trajectory(0, 0).duration


for line in sys.stdin:
    print(duration(*map(float, line.split())))
