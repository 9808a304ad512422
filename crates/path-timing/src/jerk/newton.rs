//! A Newton step on the squares of the speeds.

use core::ops::Range;

use super::barrier::{Barrier, Utilisation, Walk};
use super::visit_all;
use crate::knot::Equation;
use crate::number::sqrt;
use crate::reciprocals::Reciprocals;
use crate::{Axes, Knot};

/// -Σ log of factors, by few logarithms: those of their products. Infinite where one is not
/// positive.
#[derive(Debug)]
struct Logs {
    sum: f64,
    product: f64,
}

impl Logs {
    const NONE: Self = Self {
        sum: 0.0,
        product: 1.0,
    };

    fn add(&mut self, factor: f64) {
        // Written so that NaN is not positive, too.
        let is_positive = factor > 0.0;
        self.product *= if is_positive { factor } else { 0.0 };
        if !(SMALL..=LARGE).contains(&self.product) {
            self.sum -= libm::log(self.product);
            self.product = 1.0;
        }
    }

    fn total(&self) -> f64 {
        self.sum - libm::log(self.product)
    }
}

/// The weight of the logarithms of the squares.
const POSITIVE: f64 = 0.1;

/// The part of the time's own curvature that a step knows of: with all of it a speed far too low
/// grows by less from step to step. The barriers have most of the curvature where they are near.
const CURVATURE: f64 = 0.3;

/// Products far from the smallest and the largest number.
const SMALL: f64 = 1e-200;
const LARGE: f64 = 1e200;

/// F on one segment, and its derivatives by the speeds at three knots, those of the time apart.
#[derive(Debug)]
struct Block<'a> {
    weight: f64,
    logs: &'a mut Logs,
    time: f64,
    /// Derivative of the weighted time by each speed that is not zero.
    time_slope: f64,
    gradient: [f64; 3],
    /// By the first speed and each, by the second and later ones, by the third.
    first: [f64; 3],
    second: [f64; 2],
    third: f64,
}

impl<'a> Block<'a> {
    const fn new(weight: f64, logs: &'a mut Logs) -> Self {
        Self {
            weight,
            logs,
            time: 0.0,
            time_slope: 0.0,
            gradient: [0.0; 3],
            first: [0.0; 3],
            second: [0.0; 2],
            third: 0.0,
        }
    }

    /// Slope and curvature of a barrier.
    ///
    /// ```text
    /// φ = -log(1 - g²)   φ' = 2g / (1 - g²)   φ" = (2 + 2g²) / (1 - g²)²
    /// ```
    ///
    /// The curvature of g itself is left out: it is small in the squares of the speeds.
    fn barrier(&mut self, value: f64) -> [f64; 2] {
        let square = value * value;
        self.logs.add(1.0 - square);
        let rest = 1.0 / (1.0 - square);
        [2.0 * value * rest, (2.0 + 2.0 * square) * rest * rest]
    }

    fn add_pair(&mut self, [slope, curvature]: [f64; 2], [a, b]: [f64; 2]) {
        let [_, by0, by1] = &mut self.gradient;
        *by0 += slope * a;
        *by1 += slope * b;
        let [own, beside] = &mut self.second;
        *own += curvature * a * a;
        *beside += curvature * a * b;
        self.third += curvature * b * b;
    }
}

impl Barrier for Block<'_> {
    fn limit(&mut self, utilisation: &Utilisation<2>) {
        let terms = self.barrier(utilisation.value);
        self.add_pair(terms, utilisation.by);
    }

    fn step(&mut self, utilisation: &Utilisation<3>) {
        let [slope, curvature] = self.barrier(utilisation.value);
        let [before, a, b] = utilisation.by;
        self.add_pair([slope, curvature], [a, b]);
        let [by_before, ..] = &mut self.gradient;
        *by_before += slope * before;
        for (cell, by) in self.first.iter_mut().zip(utilisation.by) {
            *cell += curvature * before * by;
        }
    }

    fn time(&mut self, ds: f64, [w0, w1]: [f64; 2]) {
        let sum = w0 + w1;
        self.time = self.weight * 2.0 * ds / sum;
        self.time_slope = -self.time / sum;
    }
}

/// The value of F alone.
#[derive(Debug)]
struct Value {
    weight: f64,
    time: f64,
    logs: Logs,
}

impl Barrier for Value {
    fn limit(&mut self, utilisation: &Utilisation<2>) {
        self.logs.add(1.0 - utilisation.value * utilisation.value);
    }

    fn step(&mut self, utilisation: &Utilisation<3>) {
        self.logs.add(1.0 - utilisation.value * utilisation.value);
    }

    fn time(&mut self, ds: f64, [w0, w1]: [f64; 2]) {
        self.time += self.weight * 2.0 * ds / (w0 + w1);
    }
}

/// F with the speeds changed by a part of the step, but for the same number with each part;
/// infinite outside of the limits.
fn value<A: Axes>(limits: &Reciprocals<A>, knots: &[Knot<A>], weight: f64, part: f64) -> f64 {
    let mut value = Value {
        weight,
        time: 0.0,
        logs: Logs::NONE,
    };
    let mut squares = Logs::NONE;
    for knot in knots.iter().filter(|knot| knot.speed > 0.0) {
        let change = part * knot.equation.right / (knot.speed * knot.speed);
        squares.add(1.0 + change);
    }
    let squares = POSITIVE * squares.total();
    if squares.is_infinite() {
        return squares;
    }
    visit_all(limits, knots, speed_after(part), |segment| {
        segment.visit(&mut value);
        value.logs.sum.is_finite()
    });
    value.time + value.logs.total() + squares
}

/// The speed at a knot that has gone a part of its step.
pub(super) fn speed_after<A: Axes>(part: f64) -> impl Fn(&Knot<A>) -> f64 {
    move |knot| {
        let square = knot.speed * knot.speed + part * knot.equation.right;
        sqrt(square.max(0.0))
    }
}

/// Halvings of a step that leaves the limits or makes F no smaller.
const HALVINGS: u32 = 30;

/// The part of the decrease that the gradient promises which is enough.
const ENOUGH: f64 = 0.1;

/// Takes a Newton step, with the speeds of knots outside of a range as they are. The decrease of F
/// that it promised, twice what a whole one brings near the least F; nothing where no part of it
/// makes F smaller.
///
/// With a `stiffness` above 1 the barriers' curvature is that many times larger: where the weight
/// has grown by this factor and F was least before, what is left of a limit falls by it, as it does
/// from one least F to the next.
pub(super) fn step<A: Axes>(
    limits: &Reciprocals<A>,
    knots: &mut [Knot<A>],
    range: &Range<usize>,
    [weight, stiffness]: [f64; 2],
) -> f64 {
    let before = assemble(limits, knots, [weight, stiffness]);
    let promised = solve(knots, range);
    let mut part = 1.0;
    for _ in 0..HALVINGS {
        let decrease = before - value(limits, knots, weight, part);
        if decrease >= ENOUGH * part * promised {
            go(knots, range, part);
            return promised;
        }
        part *= 0.5;
    }
    0.0
}

/// Changes all speeds in a range by a part of the step; at a jump to that of the knot before.
pub(super) fn go<A: Axes>(knots: &mut [Knot<A>], range: &Range<usize>, part: f64) {
    let speed_after = speed_after(part);
    let mut before = 0.0;
    for (index, knot) in knots.iter_mut().enumerate() {
        if !range.contains(&index) {
            // To the last bit.
        } else if index > 0 && knot.ds <= 0.0 {
            knot.speed = before;
        } else {
            knot.speed = speed_after(knot);
        }
        before = knot.speed;
    }
}

/// The Newton system at the present speeds. The value of F.
///
/// ```text
/// ∂F/∂x = (∂F/∂w) / 2w     T: ∂²T/∂x² = (∂²T/∂w²) / 4w² - (∂T/∂w) / 4w³
/// ```
fn assemble<A: Axes>(
    limits: &Reciprocals<A>,
    knots: &mut [Knot<A>],
    [weight, stiffness]: [f64; 2],
) -> f64 {
    for knot in &mut *knots {
        knot.equation = Equation::default();
    }
    let (mut time, mut logs) = (0.0, Logs::NONE);
    let mut walk = Walk::new(0, knots.first().map_or(0.0, |knot| knot.speed));
    while let Some(next) = walk.next_knot(knots) {
        let speed = knots.get(next).map_or(0.0, |knot| knot.speed);
        let Some(segment) = walk.advance(limits, knots, speed) else {
            break;
        };
        let mut block = Block::new(weight, &mut logs);
        segment.visit(&mut block);
        time += block.time;
        // dw/dx
        let scales = segment.knots.map(|index| {
            let speed = knots.get(index).map_or(0.0, |knot| knot.speed);
            if speed > 0.0 { 0.5 / speed } else { 0.0 }
        });
        block.add_to(knots, segment.knots, scales, stiffness);
    }
    time + logs.total()
}

impl Block<'_> {
    /// Adds it to the rows of three knots, by the squares of their speeds.
    fn add_to<A: Axes>(
        &self,
        knots: &mut [Knot<A>],
        [before, here, there]: [usize; 3],
        [b, h, t]: [f64; 3],
        stiffness: f64,
    ) {
        let time = self.time_slope;
        // 2T / W², which is T's second derivative by both speeds and mixed.
        let curvature = CURVATURE * time * time * 2.0 / self.time;
        let bend = 2.0 * CURVATURE * time;
        let [by_before, by_here, by_there] = self.gradient;
        let cell = |barrier: f64, time: f64, scale: f64| (barrier * stiffness + time) * scale;
        if let Some(Knot { equation, .. }) = knots.get_mut(before) {
            let [own, next, after] = self.first;
            equation.diagonal += cell(own, 0.0, b * b);
            equation.next[0] += cell(next, 0.0, b * h);
            equation.next[1] += cell(after, 0.0, b * t);
            equation.right -= by_before * b;
        }
        if let Some(Knot { equation, .. }) = knots.get_mut(here) {
            let [own, next] = self.second;
            equation.diagonal += cell(own, curvature - bend * h, h * h);
            equation.next[0] += cell(next, curvature, h * t);
            equation.right -= (by_here + time) * h;
        }
        if let Some(Knot { equation, .. }) = knots.get_mut(there) {
            // -log x: 0.25 / w² is the square of 0.5 / w.
            let inverse = 4.0 * t * t;
            equation.diagonal += cell(self.third, curvature - bend * t, t * t);
            equation.diagonal += POSITIVE * inverse * inverse * stiffness;
            equation.right += POSITIVE * inverse - (by_there + time) * t;
        }
    }
}

/// Solves the system, by the product of a unit triangle, pivots and its transpose. The product of
/// the right side and the solution. Knots outside of the range, and at rest, stay.
fn solve<A: Axes>(knots: &mut [Knot<A>], range: &Range<usize>) -> f64 {
    let is_own = |(index, knot): &(usize, &mut Knot<A>)| *index == 0 || knot.ds > 0.0;
    let stays = |index: usize, knot: &Knot<A>| !range.contains(&index) || knot.speed <= 0.0;
    let mut promised = 0.0;
    let (mut one, mut two) = (Equation::default(), Equation::default());
    for (index, knot) in knots.iter_mut().enumerate().filter(is_own) {
        if stays(index, knot) {
            knot.equation = Equation {
                diagonal: STIFF,
                ..Equation::default()
            };
        }
        let equation = &mut knot.equation;
        let [beside, after] = equation.next;
        let whole = equation.diagonal;
        let pivot = whole
            - one.next[0] * one.next[0] * one.diagonal
            - two.next[1] * two.next[1] * two.diagonal;
        equation.diagonal = if pivot > whole * LEAST_PIVOT {
            pivot
        } else {
            whole
        };
        let beside = beside - one.next[0] * one.next[1] * one.diagonal;
        equation.next = [beside, after].map(|entry| entry / equation.diagonal);
        equation.right -= one.next[0] * one.right + two.next[1] * two.right;
        promised += equation.right * equation.right / equation.diagonal;
        (two, one) = (one, *equation);
    }
    let [mut next, mut after] = [0.0; 2];
    for (index, knot) in knots.iter_mut().enumerate().filter(is_own).rev() {
        if stays(index, knot) {
            knot.equation.right = 0.0;
        }
        let equation = &mut knot.equation;
        let [beside, beyond] = equation.next;
        equation.right = equation.right / equation.diagonal - beside * next - beyond * after;
        (next, after) = (equation.right, next);
    }
    promised
}

/// A diagonal that leaves nothing of the coupling to a knot.
const STIFF: f64 = 1e150;

/// Least pivot, as a part of the diagonal: of one that is smaller rounding leaves nothing, and
/// divided by it the next ones would grow beyond all numbers. There the step is shorter.
const LEAST_PIVOT: f64 = 1e-12;
