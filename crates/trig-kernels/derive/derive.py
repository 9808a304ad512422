#!/usr/bin/env python3
"""Derives every constant of this crate and prints the error bounds that go with them.

    pip install mpmath
    python3 derive/derive.py            # writes src/f32/derived.rs and src/f64/derived.rs
    python3 derive/derive.py --check    # fails unless the files are what would be written
    python3 derive/derive.py --near     # all angles that come near a multiple of π/2 (a minute)
"""
import pathlib
import struct
import subprocess
import sys

from minimax import largest_error, representable, rounded
from mpmath import mp, mpf

SOURCE = pathlib.Path(__file__).parent.parent / "src"
HALF_PI = mp.pi / 2
HALF = mpf(1) / 2


class Precision:
    def __init__(self, name, word, bits, quarter_bits, parts, grid, terms, half_end, table):
        self.name, self.word, self.bits = name, word, bits
        # The common range ends at 2^quarter_bits quarter turns.
        self.quarter_bits = quarter_bits
        # The exact parts of π/2, as (integer, power of two).
        self.parts = parts
        # Angles that are added to quarter turns are multiples of 2^-grid.
        self.grid = grid
        # Coefficients of the sine, cosine, arc tangent, and arc tangent of half an angle.
        self.terms = terms
        # Largest square of the tangent of half an angle, or of that less π/4 where it is folded.
        self.half_end = half_end
        # Words of 2/π that the largest exponent needs.
        self.table = table

    def literal(self, x):
        """The shortest decimal that reads back as x, which must be exact."""
        code = "f" if self.bits == 24 else "d"
        value = float(x)
        assert mpf(value) == x, f"{x} is not exact"
        for digits in range(1, 18):
            text = f"{value:.{digits}g}"
            if struct.pack(code, float(text)) == struct.pack(code, value):
                break
        mantissa, _, exponent = text.partition("e")
        mantissa = mantissa if "." in mantissa else mantissa + ".0"
        return mantissa + (f"e{int(exponent)}" if exponent else "")

    def hexadecimal(self, word):
        digits = f"{word:0{self.word // 4}X}"
        return "0x" + "_".join(digits[i : i + 4] for i in range(0, len(digits), 4))

    def quarter(self):
        exact = [mpf(integer) * mpf(2) ** power for integer, power in self.parts]
        return exact + [rounded(HALF_PI - sum(exact), self.bits)]

    def largest_angle(self):
        """Of a reduced angle: n comes from a product that is off by up to 2^(quarter_bits - bits)."""
        return HALF_PI * (HALF + mpf(2) ** (self.quarter_bits - self.bits))

    def polynomials(self):
        sine_terms, cosine_terms, arctan_terms, half_terms = self.terms
        angle = self.largest_angle() ** 2
        yield "SINE", "S", "sin t = t + t³ S(t²)", sine, sine_weight, angle, sine_terms
        yield (
            "COSINE", "C", "cos t = 1 - t²/2 + t⁴ C(t²)",
            cosine, cosine_weight, angle, cosine_terms,
        )
        third = (mpf(1) / 3) ** 2
        yield (
            "ARCTAN", "A", "atan q = q + q³ A(q²)",
            arctan, arctan_weight, third, arctan_terms,
        )
        # Of half an angle of a vector whose length is known.
        yield (
            "HALF_ARCTAN", "A", "atan t = t + t³ A(t²)",
            arctan, arctan_weight, self.half_end, half_terms,
        )


SINGLE = Precision(
    "f32", 32, 24, 13, [(201, -7), (2029, -22), (1297, -34)], 22, (3, 3, 4, 8), mpf(1), 7
)
DOUBLE = Precision(
    "f64", 64, 53, 26, [(6588397, -22), (42501539, -49), (74025357, -80)], 51, (6, 6, 9, 10),
    mp.tan(mp.pi / 8) ** 2, 19,
)


# What is approximated, as a function of z = t², and how its error weighs in the result.
def sine(z):
    t = mp.sqrt(z)
    return (mp.sin(t) / t - 1) / z if z else mpf(-1) / 6


def sine_weight(z):
    t = mp.sqrt(z)
    return z * t / mp.sin(t) if z else z


def cosine(z):
    return (mp.cos(mp.sqrt(z)) - 1 + z / 2) / z**2 if z else mpf(1) / 24


def cosine_weight(z):
    return z**2 / mp.cos(mp.sqrt(z))


def arctan(z):
    q = mp.sqrt(z)
    return (mp.atan(q) / q - 1) / z if z else mpf(-1) / 3


def arctan_weight(z):
    q = mp.sqrt(z)
    return z * q / mp.atan(q) if z else z


def polynomial_lines(p):
    for name, letter, formula, function, weight, end, terms in p.polynomials():
        coefficients = representable(function, weight, end, terms, p.bits)
        error = mp.log(largest_error(function, weight, end, coefficients), 2)
        print(f"{p.name} {formula:32} relative error at most 2^{mp.nstr(error, 5)}")
        limit = mp.nstr(mp.sqrt(end), 5)
        yield f"/// {letter} of `{formula}`, off by at most 2^{mp.nstr(error, 4)} of it for"
        yield f"/// arguments up to {limit}."
        yield f"pub(super) const {name}: [{p.name}; {terms}] = ["
        yield from (f"    {p.literal(c)}," for c in coefficients)
        yield "];"


def constant_lines(p):
    quarter, power = p.quarter(), p.quarter_bits
    left = abs(HALF_PI - sum(quarter[:3]))
    print(f"{p.name} first three parts of π/2 are off by 2^{mp.nstr(mp.log(left, 2), 5)}")
    end = rounded(mpf(2) ** power * HALF_PI * (1 - mpf(2) ** -p.bits), p.bits)
    yield f"/// 2^{power} quarter turns: up to here the products of [`QUARTER`] are exact."
    yield f"pub(super) const COMMON_ANGLE: {p.name} = {p.literal(end)};"
    yield "/// π/2 in four parts; the products of the first three with 2^" + f"{power} are exact."
    yield f"pub(super) const QUARTER: [{p.name}; 4] = ["
    notes = [f"{integer} · 2^{shift}" for integer, shift in p.parts] + ["the rest"]
    yield from (f"    {p.literal(c)}, // {note}" for c, note in zip(quarter, notes))
    yield "];"

    half_pi, atan_half = (
        mp.nint(angle * mpf(2) ** p.grid) / mpf(2) ** p.grid for angle in (HALF_PI, mp.atan(HALF))
    )
    ratio = (HALF_PI - half_pi) / half_pi
    yield f"/// π/2 to a multiple of 2^-{p.grid}, so that sums with [`TWICE_ATAN_HALF`] are exact."
    yield f"pub(super) const HALF_PI: {p.name} = {p.literal(half_pi)};"
    yield "/// What [`HALF_PI`] lacks, as a part of it."
    yield f"pub(super) const HALF_PI_TAIL: {p.name} = {p.literal(rounded(ratio, p.bits))};"
    yield f"/// 2 atan 1/2, its half a multiple of 2^-{p.grid}."
    yield f"pub(super) const TWICE_ATAN_HALF: {p.name} = {p.literal(2 * atan_half)};"
    yield "/// What [`TWICE_ATAN_HALF`] lacks."
    tail = rounded(2 * (mp.atan(HALF) - atan_half), p.bits)
    yield f"pub(super) const TWICE_ATAN_HALF_TAIL: {p.name} = {p.literal(tail)};"


def word_lines(p):
    word = f"u{p.word}"
    high = int(mp.nint(HALF_PI * mpf(2) ** (p.word - 1)))
    yield f"/// π/2 · 2^{p.word - 1}"
    yield f"pub(super) const HALF_PI_WORD: {word} = {p.hexadecimal(high)};"
    with mp.workprec(p.word * (p.table + 2)):
        all_words = int(mp.floor(2 / mp.pi * mpf(2) ** (p.word * p.table)))
    yield "/// The bits of 2/π after a word of zeros."
    yield f"pub(super) const TWO_OVER_PI: [{word}; {p.table + 1}] = ["
    yield "    0,"
    for i in range(p.table):
        part = all_words >> p.word * (p.table - 1 - i) & ((1 << p.word) - 1)
        yield f"    {p.hexadecimal(part)},"
    yield "];"


def derived(p):
    lines = ["//! Written by `derive/derive.py`, which says how. Do not edit.", ""]
    lines.append('#![expect(clippy::approx_constant, reason = "cut off where sums are exact")]')
    lines += [*polynomial_lines(p), "", *constant_lines(p), "", *word_lines(p)]
    text = "\n".join(lines) + "\n"
    rustfmt = ["rustfmt", "--edition", "2024", "--emit", "stdout"]
    return subprocess.run(rustfmt, input=text, capture_output=True, text=True, check=True).stdout


def near(p):
    """The least exact of all reductions: every n, and the float nearest n quarter turns."""
    scale = 240
    half_pi = int(mp.nint(HALF_PI * mpf(2) ** scale))
    parts = [int(part * mpf(2) ** scale) for part in p.quarter()[:3]]
    tail = p.quarter()[3]
    worst = (mpf(0), 0)
    closest = mpf(1)
    for n in range(1, (1 << p.quarter_bits) + 1):
        product = n * half_pi
        shift = product.bit_length() - p.bits
        x = (product + (1 << (shift - 1)) >> shift) << shift
        rest = x - product
        # Nothing to see unless nearly all bits of x cancel.
        if abs(rest) > n << (scale - p.bits - 8):
            continue
        closest = min(closest, abs(mpf(rest)) / mpf(2) ** scale)
        exact = x - n * (parts[0] + parts[1])
        third = n * parts[2]
        angle = rounded(mpf(exact - third) / mpf(2) ** scale, p.bits)
        low = rounded(mpf(exact - third) / mpf(2) ** scale - angle, p.bits)
        low = rounded(low - rounded(n * tail, p.bits), p.bits)
        last_place = mpf(2) ** (int(mp.floor(mp.log(abs(angle), 2))) + 1 - p.bits)
        error = abs(angle + low - mpf(rest) / mpf(2) ** scale) / last_place
        worst = max(worst, (error, n))
    error, n = worst
    print(
        f"{p.name}: of all angles within 2^{p.quarter_bits} quarter turns the closest to a "
        f"multiple of π/2 is 2^{mp.nstr(mp.log(closest, 2), 5)} from it; what is left is off by "
        f"at most {mp.nstr(error, 3)} of its last place ({n} quarter turns)"
    )


def main(arguments):
    if arguments == ["--near"]:
        near(SINGLE)
        near(DOUBLE)
        return
    for p in (SINGLE, DOUBLE):
        path, text = SOURCE / p.name / "derived.rs", derived(p)
        if arguments == ["--check"]:
            if path.read_text() != text:
                sys.exit(f"{path} is not what this script derives")
        else:
            path.write_text(text)


main(sys.argv[1:])
