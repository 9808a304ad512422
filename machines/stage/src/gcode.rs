//! G-code as CAM tools and slicers write it: what moves X or Y is done or refused, the rest is
//! passed over with a note.

mod arc;
mod block;
mod codes;
mod interpreter;
mod program;
mod telegrams;
mod words;

pub(crate) use self::arc::ARC_TOLERANCE_MM;
pub(crate) use self::interpreter::{Command, Interpreter};
pub use self::program::Program;
