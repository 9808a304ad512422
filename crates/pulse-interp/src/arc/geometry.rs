//! An arc as passages of quadrants, all of them looked at as the first, counter-clockwise.
//!
//! There `a` falls from the axis of departure, `b` rises towards that of arrival:
//! ```text
//! b
//! |   arrival at (0, b)
//! |\
//! |  \     inward: a - 1
//! |   |    outward: b + 1
//! +---+--- a
//!     departure from (a, 0)
//! ```
//! A clockwise arc is mirrored on the line x = y first.

use crate::{Move, Turn};

/// A point within a quadrant, in steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Place {
    pub(super) a: i64,
    pub(super) b: i64,
}

/// The two moves of a quadrant's passage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Quadrant {
    pub(super) inward: Move,
    pub(super) outward: Move,
}

impl Quadrant {
    /// The quadrant that the motion enters next.
    pub(super) const fn next(self, turn: Turn) -> Self {
        match turn {
            Turn::CounterClockwise => Self {
                inward: self.inward.turned(),
                outward: self.outward.turned(),
            },
            Turn::Clockwise => Self {
                inward: self.inward.mirrored().turned().mirrored(),
                outward: self.outward.mirrored().turned().mirrored(),
            },
        }
    }

    /// The move by these signs of a and b.
    pub(super) fn of_signs(self, da: i64, db: i64) -> Option<Move> {
        // Sum of the two moves, each weighted with its sign: a falls inward.
        let along = |of: fn(Move) -> i32| {
            let inward = i64::from(of(self.inward)).wrapping_mul(da.signum());
            let outward = i64::from(of(self.outward)).wrapping_mul(db.signum());
            outward.wrapping_sub(inward)
        };
        Move::of_signs(along(Move::dx), along(Move::dy))
    }
}

/// From where to where an arc goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Sweep {
    pub(super) quadrant: Quadrant,
    /// In the quadrant of the start.
    pub(super) start: Place,
    /// In the quadrant of the end.
    pub(super) end: Place,
    /// Crossings of an axis between the two, 0 to 4.
    pub(super) crossings: u8,
}

impl Sweep {
    pub(super) fn new(start: [i32; 2], end: [i32; 2], turn: Turn) -> Self {
        let place = |[x, y]: [i32; 2]| match turn {
            Turn::CounterClockwise => Place {
                a: i64::from(x),
                b: i64::from(y),
            },
            Turn::Clockwise => Place {
                a: i64::from(y),
                b: i64::from(x),
            },
        };
        let first = match turn {
            Turn::CounterClockwise => Quadrant {
                inward: Move::Left,
                outward: Move::Up,
            },
            Turn::Clockwise => Quadrant {
                inward: Move::Down,
                outward: Move::Right,
            },
        };
        let (departed, start) = turned_until(place(start), |p| p.a > 0 && p.b >= 0);
        let (arrived, end) = turned_until(place(end), |p| p.a >= 0 && p.b > 0);
        let mut quadrant = first;
        for _ in 0..departed {
            quadrant = quadrant.next(turn);
        }
        let mut crossings = arrived.wrapping_sub(departed) & 3;
        if crossings == 0 && !is_ahead(start, end) {
            crossings = 4;
        }
        Self {
            quadrant,
            start,
            end,
            crossings,
        }
    }
}

/// The point in the quadrant where the condition holds, and the quadrant's number.
fn turned_until(mut place: Place, condition: impl Fn(Place) -> bool) -> (u8, Place) {
    // No point but the centre fails in all four quadrants.
    for quadrant in 0..3 {
        if condition(place) {
            return (quadrant, place);
        }
        place = Place {
            a: place.b,
            b: place.a.wrapping_neg(),
        };
    }
    (3, place)
}

/// Whether the angle of `end` is beyond that of `start`, both in one quadrant.
fn is_ahead(start: Place, end: Place) -> bool {
    // Coordinates of at most 2^31: products of at most 2^62.
    start.a.wrapping_mul(end.b) > start.b.wrapping_mul(end.a)
}

/// The rounded distance n at which a path crosses an axis: the least with n (n + 1) >= square.
pub(super) fn rounded_root(square: u64) -> i64 {
    let root = square.isqrt();
    // At most 2^30: the products fit.
    let up = root.wrapping_mul(root.wrapping_add(1)) < square;
    signed(root.wrapping_add(u64::from(up)))
}

/// Of a number far below 2^63.
pub(super) fn signed(number: u64) -> i64 {
    i64::try_from(number).unwrap_or(i64::MAX)
}
