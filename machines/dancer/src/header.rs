//! A compiled score as the C header that the firmware includes.

use anyhow::Result;
use pattern_codec::dance::{DataHeader, Sizes};

use crate::MOTORS;
use crate::score::{Choreography, Score};

/// `data.h`, in the packing of the fewest bytes.
///
/// # Errors
/// More bytes than an 8051 addresses.
pub fn header(score: &Score, dance: &Choreography<MOTORS>) -> Result<String> {
    let frames = || dance.frames.iter().copied();
    let header = DataHeader {
        timing: score.timing(),
        threshold: score.threshold(),
        packing: Sizes::of(frames()).smallest(),
        ..DataHeader::DEFAULT
    };
    let mut text = String::new();
    header.write(frames(), &mut text)?;
    Ok(text)
}
