"""Minimax polynomials whose coefficients are exact in f32 or f64.

Remez' exchange algorithm in 80 digits. Then the coefficients are rounded one after the other, from
the lowest: those above it are fitted again each time, so that they make up for its rounding.
"""
import sys

from mpmath import mp, mpf

mp.dps = 80


def rounded(x, precision):
    """x to the nearest number with that many bits (all of ours are far from subnormal)."""
    with mp.workprec(precision):
        return +x


def solve(function, weight, points, terms):
    """Coefficients whose weighted error alternates between +-E at the points."""
    rows, right = mp.matrix(terms + 1), mp.matrix(terms + 1, 1)
    for i, z in enumerate(points):
        for j in range(terms):
            rows[i, j] = z**j
        rows[i, terms] = (-1) ** i / weight(z)
        right[i] = function(z)
    return list(mp.lu_solve(rows, right))[:terms]


def extrema(error, end, count):
    """Where the error is largest between its changes of sign, `count` of them."""
    steps = 40 * count
    # Denser at both ends, where the extrema of a minimax error crowd.
    grid = [end * (1 - mp.cos(mp.pi * i / steps)) / 2 for i in range(1, steps + 1)]
    values = [error(z) for z in grid]
    peaks, begin = [], 0
    for i in range(1, steps + 1):
        if i == steps or values[i] * values[begin] < 0:
            best = max(range(begin, i), key=lambda k: abs(values[k]))
            peaks.append(refine(error, grid, best))
            begin = i
    # Weights that vanish at zero leave a tiny lobe there at times: keep the largest in a row.
    while len(peaks) > count:
        ends = (0, len(peaks) - 1)
        peaks.pop(min(ends, key=lambda k: abs(error(peaks[k]))))
    return peaks


def refine(error, grid, best):
    """The extremum beside grid[best], by golden section."""
    low, high = grid[max(best - 1, 0)], grid[min(best + 1, len(grid) - 1)]
    ratio = (mp.sqrt(5) - 1) / 2
    for _ in range(60):
        a, b = high - ratio * (high - low), low + ratio * (high - low)
        if abs(error(a)) > abs(error(b)):
            high = b
        else:
            low = a
    return (low + high) / 2


def nodes(end, count):
    """Chebyshev's nodes from 0 to end."""
    return [end * (1 - mp.cos(mp.pi * (2 * i + 1) / (2 * count))) / 2 for i in range(count)]


def minimax(function, weight, end, terms):
    """The real coefficients with the least largest weighted error: Remez' exchange."""
    points = nodes(end, terms + 1)
    for _ in range(30):
        coefficients = solve(function, weight, points, terms)

        def error(z):
            return weight(z) * (mp.polyval(coefficients[::-1], z) - function(z))

        points = extrema(error, end, terms + 1)
        if len(points) <= terms:
            sys.exit("the error changes its sign too seldom")
        sizes = [abs(error(z)) for z in points]
        if max(sizes) - min(sizes) < max(sizes) * mpf(10) ** -9:
            return coefficients
    sys.exit("the exchange does not settle")


def largest_error(function, weight, end, coefficients):
    def error(z):
        return weight(z) * (mp.polyval(coefficients[::-1], z) - function(z))

    return max(abs(error(z)) for z in extrema(error, end, len(coefficients) + 8))


def representable(function, weight, end, terms, precision):
    """Coefficients of that many bits near the best: each makes up for those rounded before it."""
    best = minimax(function, weight, end, terms)
    points = nodes(end, 8 * terms)
    held = []
    while len(held) < terms:
        first = len(held)
        # What the terms from here on have to give, by least squares over Chebyshev's nodes.
        rows, right = mp.matrix(len(points), terms - first), mp.matrix(len(points), 1)
        for i, z in enumerate(points):
            for j in range(first, terms):
                rows[i, j - first] = weight(z) * z**j
            missing = mp.polyval(best[::-1], z) - sum(c * z**k for k, c in enumerate(held))
            right[i] = weight(z) * missing
        held.append(rounded(mp.lu_solve(rows, right)[0], precision))
    return held
