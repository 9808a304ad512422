"""The shortest durations of smooth paths with limits of jerk, by ipopt (casadi of PyPI).

The parameter's jerk is constant on each of many intervals of equal time, so that its course is exact;
speed, acceleration and jerk of all axes are limited at both ends of each interval. What is found is a
local optimum, from a slow course whose jerk is least.

A line of input: the limits of both axes (speed, acceleration, jerk), then of each axis its slope and
(amplitude, frequency in rad, phase) of each wave. A line of output: the seconds.
"""

import sys

import casadi
import numpy as np

INTERVALS = 300


def axis(numbers, s):
    """Position and its first three derivatives by the parameter."""
    slope, waves = numbers[0], np.reshape(numbers[1:], (-1, 3))
    first, second, third = slope, 0, 0
    for amplitude, rate, phase in waves:
        first += amplitude * rate * casadi.cos(rate * s + phase)
        second -= amplitude * rate**2 * casadi.sin(rate * s + phase)
        third -= amplitude * rate**3 * casadi.cos(rate * s + phase)
    return first, second, third


def demands(axes, s, v, a, j):
    """Speed, acceleration and jerk of each axis."""
    for numbers in axes:
        first, second, third = axis(numbers, s)
        yield first * v, first * a + second * v**2, first * j + 3 * second * v * a + third * v**3


def evenly(axes, limits):
    """A minimum-jerk course from rest to rest, and the shortest time in which it keeps the limits."""
    tau = np.linspace(0, 1, INTERVALS + 1)
    s = tau**3 * (10 - 15 * tau + 6 * tau**2)
    v = 30 * tau**2 * (1 - tau) ** 2
    a = 60 * tau * (1 - tau) * (1 - 2 * tau)
    j = 60 - 360 * tau * (1 - tau)
    most = max(
        (np.max(np.abs(np.array(casadi.DM(demand)))) / limit) ** (1 / power)
        for of_axis in demands(axes, s, v, a, j)
        for power, (demand, limit) in enumerate(zip(of_axis, limits), 1)
    )
    return most, s, v / most, a / most**2, j / most**3


def duration(limits, axes):
    problem = casadi.Opti()
    count = INTERVALS
    total = problem.variable()
    s, v, a = (problem.variable(count + 1) for _ in range(3))
    j = problem.variable(count)
    dt = total / count
    problem.minimize(total)
    problem.subject_to(a[1:] == a[:-1] + j * dt)
    problem.subject_to(v[1:] == v[:-1] + a[:-1] * dt + j * dt**2 / 2)
    problem.subject_to(s[1:] == s[:-1] + v[:-1] * dt + a[:-1] * dt**2 / 2 + j * dt**3 / 6)
    for state, ends in ((s, (0, 1)), (v, (0, 0)), (a, (0, 0))):
        problem.subject_to(state[0] == ends[0])
        problem.subject_to(state[count] == ends[1])
    problem.subject_to(v >= 0)
    for part in (slice(0, count), slice(1, count + 1)):
        for of_axis in demands(axes, s[part], v[part], a[part], j):
            for demand, limit in zip(of_axis, limits):
                problem.subject_to(problem.bounded(-1, demand / limit, 1))
    start_s, *start = evenly(axes, limits)
    problem.set_initial(total, start_s * 1.1)
    for variable, values in zip((s, v, a), start):
        problem.set_initial(variable, values)
    problem.set_initial(j, start[3][:-1])
    problem.solver("ipopt", {"print_time": False}, {"print_level": 0, "sb": "yes", "max_iter": 2000})
    return problem.solve().value(total)


for line in sys.stdin:
    numbers = [float(number) for number in line.split()]
    half = (len(numbers) - 3) // 2
    print(duration(numbers[:3], [numbers[3 : 3 + half], numbers[3 + half :]]), flush=True)
