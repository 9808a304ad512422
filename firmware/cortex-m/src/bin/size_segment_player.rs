//! What plays segments that a PC plans: decoder and player.
#![cfg_attr(target_os = "none", no_std, no_main)]

cortex_m_firmware::smallest_program!(work);

use core::hint::black_box;

use pvt_steps::{Segment, SegmentPlayer};

fn work() -> Option<u32> {
    let (segment, _) = Segment::decode(black_box(&[0x21, 0, 0, 100, 0x80, 0x80, 4])).ok()?;
    let mut player = SegmentPlayer::new();
    black_box(player.load(&segment));
    player.next()
}
