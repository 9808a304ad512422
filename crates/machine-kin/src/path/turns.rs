//! The axes along a path, each angle at its whole turn.

use core::f64::consts::TAU;

use crate::Axis;

/// Places at which the axes are known; from each to the next an angle turns by less than half a
/// turn.
const ANCHORS: usize = 8;

/// How far an angle turns from a known place before the next is noted, in radians.
const FAR: f64 = 2.4;

/// The largest turn of an angle from one place of the survey to the next, in radians.
pub(super) const MAX_TURN: f64 = 0.6;

/// The whole turns of the angles along a path: what is continuous when it is walked along stays so
/// when places are asked for in any order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Turns<const N: usize> {
    /// Parameter and axes, in their order.
    anchors: [(f64, [f64; N]); ANCHORS],
    used: usize,
}

impl<const N: usize> Turns<N> {
    /// From the axes at the start on.
    pub(super) const fn new(axes: [f64; N]) -> Self {
        Self {
            anchors: [(0.0, axes); ANCHORS],
            used: 1,
        }
    }

    /// Axes whose angles are within half a turn of those at `s`.
    pub(super) fn near(&self, s: f64) -> [f64; N] {
        let known = self.anchors.iter().take(self.used);
        let [(_, first), ..] = self.anchors;
        known
            .take_while(|(at, _)| *at <= s)
            .last()
            .map_or(first, |(_, axes)| *axes)
    }

    /// Takes the axes of the next place in; whether there was room for them.
    pub(super) fn add(&mut self, s: f64, axes: &[Axis; N], positions: &[f64; N]) -> bool {
        let near = self.near(s);
        let mut angles = axes.iter().zip(positions.iter().zip(near));
        let is_far = angles.any(|(axis, (now, near))| axis.is_angle && (now - near).abs() >= FAR);
        if !is_far {
            return true;
        }
        let Some(free) = self.anchors.get_mut(self.used) else {
            return false;
        };
        *free = (s, *positions);
        self.used = self.used.saturating_add(1);
        true
    }
}

/// Positions with each angle at the turn nearest to another.
pub(super) fn at_turns<const N: usize>(
    axes: &[Axis; N],
    mut positions: [f64; N],
    near: &[f64; N],
) -> [f64; N] {
    for (axis, (position, near)) in axes.iter().zip(positions.iter_mut().zip(near)) {
        if axis.is_angle {
            *position += libm::round((near - *position) / TAU) * TAU;
        }
    }
    positions
}
