//! Pattern bytes of an old machine: the records, and where they are not spelt as this crate spells
//! them.
//!
//! `cargo run -p pattern-codec --example spelling`

use pattern_codec::dance::Timing;
use pattern_codec::engraving::{Format, Strictness};

fn main() -> Result<(), Box<dyn core::error::Error>> {
    let format = Format::new().with_strictness(Strictness::Lenient);
    // A zero count with a direction, and bits that a SLOW byte has not.
    let bytes = [0x05, 0x83, 0x02, 0x80, 0x03, 0x00, 0x25, 0x01, 0x01];
    for located in format.records(&bytes) {
        let located = located?;
        if located.is_canonical(&format) {
            println!("{:?}", located.record);
        } else {
            let canonical = format.canonical(located.bytes)?;
            println!(
                "{:?}: {:02X?} for {:02X?}",
                located.record, canonical, located.bytes
            );
        }
    }
    println!("a frame of a dance lasts {} us", Timing::DEFAULT.frame_us());
    Ok(())
}
