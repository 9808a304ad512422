"""The time-optimal durations of paths of two axes, by toppra (PyPI) at many cells.

A line of input: the limits (speed and acceleration of both axes), then `line x0 y0 x1 y1` of a polar arm,
or `waves` and of each axis its slope and (amplitude, frequency in rad, phase) of each wave along a length
of 1. A line of output: the seconds, nan where
toppra finds none.
"""

import logging
import sys

import numpy as np
import toppra
import toppra.algorithm
import toppra.constraint

CELLS = 4000

logging.disable(logging.CRITICAL)


def line(x0, y0, x1, y1):
    length = np.hypot(x1 - x0, y1 - y0)
    s = np.linspace(0.0, length, CELLS + 1)
    x, y = x0 + (x1 - x0) * s / length, y0 + (y1 - y0) * s / length
    return s, np.stack([np.arctan2(y, x), np.hypot(x, y)], axis=1)


def waves(*numbers):
    s = np.linspace(0.0, 1.0, CELLS + 1)
    half = len(numbers) // 2
    axes = []
    for slope, *rest in numbers[:half], numbers[half:]:
        of_axis = slope * s
        for amplitude, rate, phase in np.reshape(rest, (-1, 3)):
            of_axis = of_axis + amplitude * np.sin(rate * s + phase)
        axes.append(of_axis)
    return s, np.stack(axes, axis=1)


def duration(v0, v1, a0, a1, s, points):
    limits = [
        toppra.constraint.JointVelocityConstraint(np.array([[-v0, v0], [-v1, v1]])),
        toppra.constraint.JointAccelerationConstraint(np.array([[-a0, a0], [-a1, a1]])),
    ]
    path = toppra.SplineInterpolator(s, points)
    optimal = toppra.algorithm.TOPPRA(limits, path, gridpoints=s)
    trajectory = optimal.compute_trajectory(0, 0)
    return trajectory.duration if trajectory else float("nan")


for words in map(str.split, sys.stdin):
    kind = {"line": line, "waves": waves}[words[4]]
    print(duration(*map(float, words[:4]), *kind(*map(float, words[5:]))), flush=True)
