//! A machine in a plane with a height of its own.

use core::ops::RangeInclusive;

use crate::{Axis, Machine, Number, Refusal};

/// A machine of two axes in a plane, with a third along z: that of a printer, the lift of a pen.
#[derive(Debug, Clone, PartialEq)]
pub struct WithZ<M> {
    machine: M,
    z: RangeInclusive<f64>,
}

impl<M: Machine<2>> WithZ<M> {
    /// With the range of z.
    #[must_use]
    pub const fn new(machine: M, z: RangeInclusive<f64>) -> Self {
        Self { machine, z }
    }
}

impl<M: Machine<2>> Machine<3> for WithZ<M> {
    type Branch = M::Branch;

    fn axes(&self) -> [Axis; 3] {
        let [first, second] = self.machine.axes();
        [first, second, Axis::linear("z", self.z.clone())]
    }

    fn area(&self) -> [RangeInclusive<f64>; 3] {
        let [x, y] = self.machine.area();
        [x, y, f64::NEG_INFINITY..=f64::INFINITY]
    }

    fn inverse<T: Number>(&self, [x, y, z]: [T; 3], branch: M::Branch) -> Result<[T; 3], Refusal> {
        let [first, second] = self.machine.inverse([x, y], branch)?;
        Ok([first, second, z])
    }
}
