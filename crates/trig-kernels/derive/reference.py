#!/usr/bin/env python3
"""Writes tests/data/angles.csv: sine and cosine of hard angles, from 400-bit arithmetic.

    python3 derive/reference.py > tests/data/angles.csv

Angles of both precisions as their bits; sine and cosine as sums of two f64, 106 bits.
"""
import random
import struct

from mpmath import mp, mpf

mp.prec = 1600


def bits(x, single):
    return struct.unpack("<I" if single else "<Q", struct.pack("<f" if single else "<d", x))[0]


def value(word, single):
    return struct.unpack("<f" if single else "<d", struct.pack("<I" if single else "<Q", word))[0]


def pair(exact):
    high = float(exact)
    return f"{high!r},{float(exact - mpf(high))!r}"


def angles(single, source):
    bias, fraction = (127, 23) if single else (1023, 52)
    yield from (0.5, 1.0, 3.0)
    # The double that comes closest of all to a multiple of π/2 (Kahan, Muller), and the single.
    yield from ([16367173.0 * 2.0**72] if single else [6381956970095103.0 * 2.0**797])
    for exponent in list(range(-30, 40, 2)) + list(range(40, bias, 8 if single else 40)):
        size = source.getrandbits(fraction) | (exponent + bias) << fraction
        yield value(size, single)
    # Beside quarter turns, in the common range and beyond.
    for shift in range(1, 40 if single else 70):
        exact = mp.pi / 2 * source.randrange(1 << shift, 2 << shift)
        yield value(bits(float(exact), single), single)


def main():
    source = random.Random(7)
    print("# Written by derive/reference.py, which says how: bits of the angle; sine; cosine.")
    for single in (True, False):
        for x in angles(single, source):
            word = f"{bits(x, single):0{8 if single else 16}x}"
            exact = mpf(value(bits(x, single), single))
            print(f"{word},{pair(mp.sin(exact))},{pair(mp.cos(exact))}")


main()
