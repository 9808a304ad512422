//! Steps along the cubics of PVT tables.

mod axis;
mod joined;
mod leb128;
mod limits;
mod polynomial;
mod quantiser;
mod row;
mod row_wire;
mod run;
mod segment;
mod series;
mod steps;
mod too_fast;
mod wire;

pub use axis::AxisSegments;
pub use joined::JoinedSegments;
pub use limits::{MinIntervals, RowError};
pub(crate) use polynomial::distance;
pub use quantiser::{KnotError, PvtQuantiser};
pub use row::{PvtKnot, PvtRow};
pub use row_wire::{RowBits, RowBytesError, RowCodec};
pub use segment::{Segment, SegmentPlayer};
pub use steps::{PvtSteps, Step};
pub use wire::SegmentError;
