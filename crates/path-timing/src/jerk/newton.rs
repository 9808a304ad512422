//! A Newton step on the squares of the speeds.

use super::barrier::{Barrier, Utilisation, Walk};
use super::visit_all;
use crate::number::sqrt;
use crate::reciprocals::Reciprocals;
use crate::{Axes, Knot};

/// A knot's row of the Newton system, whose matrix is symmetric with two diagonals on each side.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Equation {
    /// The matrix at the knot; factorised, the pivot.
    diagonal: f64,
    /// The matrix beside it, towards the next two knots; factorised, those of the unit triangle.
    next: [f64; 2],
    /// The right side; solved, the step of the square of the speed.
    pub(super) right: f64,
}

/// F and its derivatives on one segment, by the speeds at three knots.
#[derive(Debug, Default)]
struct Block {
    weight: f64,
    value: f64,
    gradient: [f64; 3],
    hessian: [[f64; 3]; 3],
    /// Derivative of the weighted time by each speed that is not zero.
    time_slope: f64,
}

impl Block {
    fn add(&mut self, slope: f64, curvature: f64, by: [f64; 3]) {
        for (row, (gradient, a)) in self
            .hessian
            .iter_mut()
            .zip(self.gradient.iter_mut().zip(by))
        {
            *gradient += slope * a;
            for (cell, b) in row.iter_mut().zip(by) {
                *cell += curvature * a * b;
            }
        }
    }
}

impl Barrier for Block {
    /// ```text
    /// φ = -log(1 - g²)   φ' = 2g / (1 - g²)   φ" = (2 + 2g²) / (1 - g²)²
    /// ```
    ///
    /// The curvature of g itself is left out: it is small in the squares of the speeds.
    fn limit(&mut self, utilisation: &Utilisation) {
        let square = utilisation.value * utilisation.value;
        let rest = 1.0 / (1.0 - square);
        self.value += if square < 1.0 {
            libm::log(rest)
        } else {
            f64::INFINITY
        };
        let curvature = (2.0 + 2.0 * square) * rest * rest;
        self.add(2.0 * utilisation.value * rest, curvature, utilisation.by);
    }

    fn time(&mut self, ds: f64, [w0, w1]: [f64; 2]) {
        let sum = w0 + w1;
        let time = self.weight * 2.0 * ds / sum;
        self.value += time;
        let by = if w0 <= 0.0 {
            [0.0, 0.0, 1.0]
        } else if w1 <= 0.0 {
            [0.0, 1.0, 0.0]
        } else {
            [0.0, 1.0, 1.0]
        };
        self.time_slope = -time / sum;
        self.add(self.time_slope, 2.0 * time / (sum * sum), by);
    }
}

/// The value of F alone.
#[derive(Debug)]
struct Value {
    weight: f64,
    value: f64,
    /// A product of 1 - g², whose logarithm is taken when it is small.
    product: f64,
}

impl Value {
    /// Adds -log of what is left: infinite where nothing is.
    fn add(&mut self, rest: f64) {
        // Written so that NaN is outside, too.
        let is_inside = rest > 0.0;
        self.product *= if is_inside { rest } else { 0.0 };
        if !(SMALL..=LARGE).contains(&self.product) {
            self.value -= libm::log(self.product);
            self.product = 1.0;
        }
    }
}

impl Barrier for Value {
    fn limit(&mut self, utilisation: &Utilisation) {
        self.add(1.0 - utilisation.value * utilisation.value);
    }

    fn time(&mut self, ds: f64, [w0, w1]: [f64; 2]) {
        self.value += self.weight * 2.0 * ds / (w0 + w1);
    }
}

/// Products far from the smallest and the largest number.
const SMALL: f64 = 1e-200;
const LARGE: f64 = 1e200;

/// F with the speeds changed by a part of the step, but for the same number with each part; infinite outside
/// of the limits.
fn value<A: Axes>(limits: &Reciprocals<A>, knots: &[Knot<A>], weight: f64, part: f64) -> f64 {
    let mut value = Value {
        weight,
        value: 0.0,
        product: 1.0,
    };
    for knot in knots.iter().filter(|knot| knot.speed > 0.0) {
        value.add(1.0 + part * knot.equation.right / (knot.speed * knot.speed));
    }
    let speed_of = |knot: &Knot<A>| {
        let square = knot.speed * knot.speed + part * knot.equation.right;
        sqrt(square.max(0.0))
    };
    visit_all(limits, knots, speed_of, |segment| {
        segment.visit(&mut value);
        value.value.is_finite()
    });
    value.value - libm::log(value.product)
}

/// Halvings of a step that leaves the limits or makes F no smaller.
const HALVINGS: u32 = 30;

/// The part of the decrease that the gradient promises which is enough.
const ENOUGH: f64 = 0.1;

/// Takes a Newton step, with the speeds at the first `fixed` knots as they are. By how much F became
/// smaller; nothing where no part of the step makes it so.
pub(super) fn step<A: Axes>(
    limits: &Reciprocals<A>,
    knots: &mut [Knot<A>],
    fixed: usize,
    weight: f64,
) -> f64 {
    let before = assemble(limits, knots, weight);
    let promised = solve(knots, fixed);
    let mut part = 1.0;
    for _ in 0..HALVINGS {
        let decrease = before - value(limits, knots, weight, part);
        if decrease >= ENOUGH * part * promised {
            go(knots, fixed, part);
            return decrease;
        }
        part *= 0.5;
    }
    0.0
}

/// Changes all speeds but the fixed by a part of the step; at a jump to that of the knot before.
fn go<A: Axes>(knots: &mut [Knot<A>], fixed: usize, part: f64) {
    let mut before = 0.0;
    for (index, knot) in knots.iter_mut().enumerate() {
        if index < fixed {
            // To the last bit.
        } else if index > 0 && knot.ds <= 0.0 {
            knot.speed = before;
        } else if knot.speed > 0.0 {
            knot.speed = sqrt(knot.speed * knot.speed + part * knot.equation.right);
        }
        before = knot.speed;
    }
}

/// The Newton system at the present speeds. The value of F.
///
/// ```text
/// ∂F/∂x = (∂F/∂w) / 2w     T: ∂²T/∂x² = (∂²T/∂w²) / 4w² - (∂T/∂w) / 4w³
/// ```
fn assemble<A: Axes>(limits: &Reciprocals<A>, knots: &mut [Knot<A>], weight: f64) -> f64 {
    for knot in &mut *knots {
        knot.equation = Equation::default();
    }
    let mut total = 0.0;
    let mut walk = Walk::new(0, knots.first().map_or(0.0, |knot| knot.speed));
    while let Some(next) = walk.next_knot(knots) {
        let speed = knots.get(next).map_or(0.0, |knot| knot.speed);
        let Some(segment) = walk.advance(limits, knots, speed) else {
            break;
        };
        let mut block = Block {
            weight,
            ..Block::default()
        };
        segment.visit(&mut block);
        total += block.value;
        let scales = segment.knots.map(|index| {
            let speed = knots.get(index).map_or(0.0, |knot| knot.speed);
            if speed > 0.0 { 0.5 / speed } else { 0.0 }
        });
        let [to_here, here, there] = segment.knots;
        let mut row = |number: usize, index: usize, columns: [Option<usize>; 3]| {
            let values = (
                block.hessian.get(number),
                block.gradient.get(number),
                scales.get(number),
            );
            let (Some(cells), Some(slope), Some(scale), Some(knot)) =
                (values.0, values.1, values.2, knots.get_mut(index))
            else {
                return;
            };
            let cell = |column: Option<usize>| {
                let column =
                    column.and_then(|column| Some((cells.get(column)?, scales.get(column)?)));
                column.map_or(0.0, |(cell, other)| cell * scale * other)
            };
            let equation = &mut knot.equation;
            let [own, next, after] = columns.map(cell);
            equation.diagonal += own;
            equation.next[0] += next;
            equation.next[1] += after;
            equation.right -= slope * scale;
            if number > 0 {
                equation.diagonal -= 2.0 * block.time_slope * scale * scale * scale;
            }
            if number == 2 {
                // -log x: 0.25 / w² is the square of 0.5 / w.
                let inverse = 4.0 * scale * scale;
                equation.diagonal += inverse * inverse;
                equation.right += inverse;
            }
        };
        row(0, to_here, [Some(0), Some(1), Some(2)]);
        row(1, here, [Some(1), Some(2), None]);
        row(2, there, [Some(2), None, None]);
    }
    total
}

/// Solves the system, by the product of a unit triangle, pivots and its transpose. The product of the
/// right side and the solution.
fn solve<A: Axes>(knots: &mut [Knot<A>], fixed: usize) -> f64 {
    let is_own = |(index, knot): &(usize, &mut Knot<A>)| *index == 0 || knot.ds > 0.0;
    let mut promised = 0.0;
    let (mut one, mut two) = (Equation::default(), Equation::default());
    for (index, knot) in knots.iter_mut().enumerate().filter(is_own) {
        let equation = &mut knot.equation;
        if index < fixed || knot.speed <= 0.0 {
            *equation = Equation {
                diagonal: 1.0,
                ..Equation::default()
            };
        }
        let [beside, after] = equation.next;
        let whole = equation.diagonal;
        let pivot = whole
            - one.next[0] * one.next[0] * one.diagonal
            - two.next[1] * two.next[1] * two.diagonal;
        equation.diagonal = pivot.max(whole * LEAST_PIVOT);
        equation.next = [
            (beside - one.next[0] * one.next[1] * one.diagonal) / equation.diagonal,
            after / equation.diagonal,
        ];
        equation.right -= one.next[0] * one.right + two.next[1] * two.right;
        promised += equation.right * equation.right / equation.diagonal;
        (one, two) = (*equation, one);
    }
    let [mut next, mut after] = [0.0; 2];
    for (_, knot) in knots.iter_mut().enumerate().filter(is_own).rev() {
        let equation = &mut knot.equation;
        let [beside, beyond] = equation.next;
        equation.right = equation.right / equation.diagonal - beside * next - beyond * after;
        (next, after) = (equation.right, next);
    }
    promised
}

/// Least pivot, as a part of the diagonal: what rounding leaves of one.
const LEAST_PIVOT: f64 = 1e-14;
