//! Whether a solid lies wholly in the workspace: halved into cells until each is in the ball of
//! its middle's clearance.

use nalgebra::{Point3, RealField, Vector3};

use super::Workspace;
use crate::limits::half;

/// A solid round the base's axis.
#[derive(Debug, Clone, Copy)]
pub(super) enum Solid<T> {
    Cylinder { radius: T },
    Box { half_side: T },
}

impl<T: RealField + Copy> Solid<T> {
    /// Half the side of the box round the solid.
    const fn half_side(&self) -> T {
        match self {
            Self::Cylinder { radius } => *radius,
            Self::Box { half_side } => *half_side,
        }
    }

    /// Whether the solid has a point within `reach` of `middle` along X and Y.
    fn meets(&self, middle: Point3<T>, reach: Vector3<T>) -> bool {
        match self {
            Self::Cylinder { radius } => {
                let x = (middle.x.abs() - reach.x).max(T::zero());
                let y = (middle.y.abs() - reach.y).max(T::zero());
                x.hypot(y) <= *radius
            }
            Self::Box { .. } => true,
        }
    }
}

/// A box of the halving: its place in the tree of halves is a number, whose highest bit is the
/// root and each further bit the lower or the upper half across the longest side.
#[derive(Debug, Clone, Copy)]
struct Cell(u64);

/// 61 halvings: cells 2^-20 of the root along each side.
const DEEPEST: u64 = 1 << 61;

impl Cell {
    const ROOT: Self = Self(1);

    /// Middle and half sides.
    fn extent<T: RealField + Copy>(
        self,
        mut middle: Point3<T>,
        mut reach: Vector3<T>,
    ) -> (Point3<T>, Vector3<T>) {
        let depth = 63 - self.0.leading_zeros();
        for level in (0..depth).rev() {
            let is_upper = (self.0 >> level) & 1 == 1;
            let longest = if reach.x >= reach.y && reach.x >= reach.z {
                Vector3::x()
            } else if reach.y >= reach.z {
                Vector3::y()
            } else {
                Vector3::z()
            };
            let step = reach.component_mul(&longest) * half::<T>();
            reach -= step;
            middle += if is_upper { step } else { -step };
        }
        (middle, reach)
    }

    /// The first half; none where the cell is as small as may be.
    const fn halved(self) -> Option<Self> {
        if self.0 >= DEEPEST {
            None
        } else {
            Some(Self(self.0 << 1))
        }
    }

    /// The cell after this one and all its halves; none after the last.
    const fn next(self) -> Option<Self> {
        let place = self.0 >> self.0.trailing_ones();
        if place == 0 {
            None
        } else {
            Some(Self(place | 1))
        }
    }
}

pub(super) fn covers<T: RealField + Copy>(
    workspace: &Workspace<T>,
    solid: Solid<T>,
    [one, other]: [T; 2],
    resolution: T,
) -> bool {
    let side = solid.half_side();
    let middle = Point3::new(T::zero(), T::zero(), (one + other) * half());
    let reach = Vector3::new(side, side, (one - other).abs() * half());
    let mut cell = Some(Cell::ROOT);
    while let Some(now) = cell {
        let (middle, reach) = now.extent(middle, reach);
        let radius = reach.norm();
        // What is not a number is not covered.
        if !radius.is_finite() {
            return false;
        }
        let is_covered = !solid.meets(middle, reach)
            || (radius <= workspace.clearance(middle) && radius <= workspace.steady(middle));
        cell = if is_covered {
            now.next()
        } else if radius <= resolution {
            return false;
        } else {
            let Some(halved) = now.halved() else {
                return false;
            };
            Some(halved)
        };
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_halves_fill_the_root() {
        let root = (Point3::new(1.0, 2.0, 3.0), Vector3::new(4.0, 2.0, 1.0));
        let (mut cell, mut volume, mut cells) = (Some(Cell::ROOT), 0.0f64, 0);
        while let Some(now) = cell {
            let (middle, reach) = now.extent(root.0, root.1);
            assert!((middle - root.0).abs() <= root.1 - reach);
            // Every third cell is halved, some levels down.
            if now.0 % 3 != 0 && now.0 < 1 << 6 {
                cell = now.halved();
            } else {
                volume += reach.x * reach.y * reach.z;
                cells += 1;
                cell = now.next();
            }
        }
        assert!((volume - 8.0).abs() < 1e-12, "{volume}");
        assert!(cells > 8);
    }
}
