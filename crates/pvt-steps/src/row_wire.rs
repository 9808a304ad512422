//! Rows as bytes.
#![expect(
    clippy::arithmetic_side_effects,
    clippy::cast_possible_truncation,
    reason = "shifts below 64, products of 32 and 65 bits; differences wrap"
)]

use crate::leb128::{NumberError, Reader, put_signed};
use crate::row::{PvtKnot, PvtRow};
use thiserror::Error;

/// Why bytes are no row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RowBytesError {
    /// They end too early.
    #[error("{len} bytes end within a row")]
    Truncated {
        /// Bytes given.
        len: usize,
    },
    /// A number has more than 64 bits, or more bytes than it needs.
    #[error("the number that ends with byte {at} is too long")]
    Number {
        /// Its last byte, from 0.
        at: usize,
    },
    /// A row of less than 0 or 2^32 ticks and more.
    #[error("a row of {ticks} ticks, not 0 to 2^32 - 1")]
    Ticks {
        /// Ticks.
        ticks: i64,
    },
    /// A position or a velocity that no knot has room for.
    #[error("axis {axis}: a position or a velocity past 63 bits")]
    Range {
        /// Index of the axis.
        axis: usize,
    },
}

impl From<NumberError> for RowBytesError {
    fn from(error: NumberError) -> Self {
        match error {
            NumberError::Truncated { len } => Self::Truncated { len },
            NumberError::TooLong { at } => Self::Number { at },
        }
    }
}

/// Bits after the point that rows have on a wire.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_structs, reason = "written as a literal")]
pub struct RowBits {
    /// Of a position in steps; more than 32 are 32.
    pub position: u32,
    /// Of a velocity in steps a tick; more than 56 are 56.
    pub velocity: u32,
}

impl RowBits {
    /// All that a row has.
    pub const EXACT: Self = Self {
        position: PvtKnot::POSITION_BITS,
        velocity: PvtKnot::VELOCITY_BITS,
    };

    /// Bits that are left out of position and velocity.
    const fn left_out(self) -> [u32; 2] {
        [
            PvtKnot::POSITION_BITS.saturating_sub(self.position),
            PvtKnot::VELOCITY_BITS.saturating_sub(self.velocity),
        ]
    }
}

/// Rows of a PVT table as bytes, one after the other, for a controller that makes the steps itself
/// by [`PvtSteps`](crate::PvtSteps): fewer bytes than the [`Segment`](crate::Segment)s of its
/// steps.
///
/// Both ends begin with the same knots and bits. The encoder rounds each knot, by itself, to
/// ```text
/// |position error| <= 2^-(bits.position + 1) steps
/// |velocity error| <= 2^-(bits.velocity + 1) steps a tick
/// ```
/// so that no error adds up; with [`RowBits::EXACT`] rows come back as they were. The steps of the
/// decoded rows are as near to the cubics of these as ever.
///
/// # Bytes
/// Of a row, N axes in order:
///
/// | bytes | what |
/// |---|---|
/// | 1 to 5 | T less that of the row before |
/// | 1 to 10, for each axis | v1 - v0 less that of the row before, in 2^-`bits.velocity` steps a tick |
/// | 1 to 10, for each axis | q1 - q0 - T (v0 + v1)/2, rounded up, in 2^-`bits.position` steps |
///
/// All are LEB128 with the sign in the lowest bit, as the signed ones of a
/// [`Segment`](crate::Segment), and 0 stands before the first row. A
/// row has one spelling.
///
/// # Examples
/// ```
/// use pvt_steps::{PvtKnot, PvtRow, RowBits, RowCodec};
/// let bits = RowBits { position: 20, velocity: 44 };
/// let start = [PvtKnot::at_rest(0)];
/// let (mut sender, mut receiver) = (RowCodec::new(start, bits), RowCodec::new(start, bits));
/// let row = PvtRow { ticks: 1_000_000, knots: [PvtKnot::at_rest(200)] };
/// let mut wire = Vec::new();
/// sender.encode(&row, |byte| wire.push(byte));
/// assert_eq!(wire.len(), 9);
/// assert_eq!(receiver.decode(&wire), Ok((row, [].as_slice())));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RowCodec<const N: usize> {
    bits: RowBits,
    ticks: u32,
    axes: [Axis; N],
}

/// The end of the last row, in the wire's units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Axis {
    position: i64,
    velocity: i64,
    /// Of the velocity.
    change: i64,
}

impl Axis {
    fn new(knot: PvtKnot, bits: RowBits) -> Self {
        let [position, velocity] = bits.left_out();
        Self {
            position: rounded(knot.position, position),
            velocity: rounded(knot.velocity, velocity),
            change: 0,
        }
    }

    /// The knot, if it has room for these numbers.
    fn knot(self, bits: RowBits) -> Option<PvtKnot> {
        let [position, velocity] = bits.left_out();
        let widened = |n: i64, bits: u32| Some(n << bits).filter(|wide| wide >> bits == n);
        Some(PvtKnot {
            position: widened(self.position, position)?,
            velocity: widened(self.velocity, velocity)?,
        })
    }

    /// Where it comes to in `ticks` ticks with an even acceleration, rounded down.
    const fn expected(self, velocity: i64, ticks: u32, bits: RowBits) -> i64 {
        let [position_bits, velocity_bits] = bits.left_out();
        let units = PvtKnot::VELOCITY_BITS - velocity_bits;
        let wanted = PvtKnot::POSITION_BITS - position_bits;
        let travel = (self.velocity as i128 + velocity as i128) * ticks as i128;
        // In half velocity units; to a shift to the right, as velocities have 2^24 units more.
        let travel = (travel << wanted) >> (units + 1);
        self.position.wrapping_add(travel as i64)
    }
}

impl<const N: usize> RowCodec<N> {
    /// A wire whose rows begin at these knots.
    #[must_use]
    pub fn new(start: [PvtKnot; N], bits: RowBits) -> Self {
        Self {
            bits,
            ticks: 0,
            axes: start.map(|knot| Axis::new(knot, bits)),
        }
    }

    /// The bytes of the next row, one by one.
    pub fn encode(&mut self, row: &PvtRow<N>, mut put: impl FnMut(u8)) {
        put_signed(i64::from(row.ticks) - i64::from(self.ticks), &mut put);
        self.ticks = row.ticks;
        for (axis, knot) in self.axes.iter_mut().zip(row.knots) {
            let mut to = Axis::new(knot, self.bits);
            to.change = to.velocity.wrapping_sub(axis.velocity);
            put_signed(to.change.wrapping_sub(axis.change), &mut put);
            let expected = axis.expected(to.velocity, row.ticks, self.bits);
            put_signed(to.position.wrapping_sub(expected), &mut put);
            *axis = to;
        }
    }

    /// The row in the front of `bytes`, and the bytes after it.
    ///
    /// # Errors
    /// [`RowBytesError`]: the state is as before then. What decodes may still be refused by
    /// [`PvtSteps`](crate::PvtSteps).
    pub fn decode<'b>(&mut self, bytes: &'b [u8]) -> Result<(PvtRow<N>, &'b [u8]), RowBytesError> {
        let mut reader = Reader::new(bytes);
        let ticks = reader.signed()?.saturating_add(i64::from(self.ticks));
        let ticks = u32::try_from(ticks).map_err(|_| RowBytesError::Ticks { ticks })?;
        let (mut axes, mut knots) = (self.axes, [PvtKnot::default(); N]);
        for (index, (axis, knot)) in axes.iter_mut().zip(&mut knots).enumerate() {
            let change = axis.change.wrapping_add(reader.signed()?);
            let velocity = axis.velocity.wrapping_add(change);
            let expected = axis.expected(velocity, ticks, self.bits);
            *axis = Axis {
                position: expected.wrapping_add(reader.signed()?),
                velocity,
                change,
            };
            let error = RowBytesError::Range { axis: index };
            *knot = axis.knot(self.bits).ok_or(error)?;
        }
        (self.ticks, self.axes) = (ticks, axes);
        Ok((PvtRow { ticks, knots }, reader.rest()))
    }
}

/// n 2^-bits to the nearest that does not leave 64 bits when shifted back.
fn rounded(n: i64, bits: u32) -> i64 {
    match bits.checked_sub(1) {
        Some(less) => ((n >> bits) + ((n >> less) & 1)).min(i64::MAX >> bits),
        None => n,
    }
}
