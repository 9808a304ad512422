//! The pictures of a run.

mod alignment;
mod jog;

pub(crate) use self::alignment::align;
pub(crate) use self::jog::jog;
