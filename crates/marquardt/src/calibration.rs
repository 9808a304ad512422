//! A fit with what it is of.

use core::ops::Deref;

use crate::LeastSquares;

/// A calibrated machine, how well it fits, and what the measurements do not tell.
///
/// All arrays are in the order of the parameters; lengths in the machine's unit, angles in radians.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Calibration<M, P, const N: usize> {
    machine: M,
    parameters: [P; N],
    fit: LeastSquares<N>,
}

impl<M, P: Copy, const N: usize> Calibration<M, P, N> {
    /// A fit, the machine that its changes make, and what its parameters are.
    #[must_use]
    pub const fn new(machine: M, parameters: [P; N], fit: LeastSquares<N>) -> Self {
        Self {
            machine,
            parameters,
            fit,
        }
    }

    /// The calibrated machine.
    #[must_use]
    pub const fn machine(&self) -> &M {
        &self.machine
    }

    /// The parameters.
    #[must_use]
    pub const fn parameters(&self) -> &[P; N] {
        &self.parameters
    }

    /// The parameters that the measurements do not determine, alone or together with others.
    pub fn undetermined(&self) -> impl Iterator<Item = P> + use<M, P, N> {
        let free = self.fit.free();
        self.parameters
            .into_iter()
            .zip(free)
            .filter_map(|(parameter, free)| free.then_some(parameter))
    }
}

impl<M, P, const N: usize> Deref for Calibration<M, P, N> {
    type Target = LeastSquares<N>;

    fn deref(&self) -> &LeastSquares<N> {
        &self.fit
    }
}
