//! Records from bytes.
#![cfg_attr(target_os = "none", no_std, no_main)]

cortex_m_firmware::smallest_program!(work);

use core::hint::black_box;

use pattern_codec::engraving::Format;

fn work() -> Option<i32> {
    let mut sum = 0;
    for located in Format::default().records(black_box(&[0x02, 0x0F, 0x9E])) {
        sum += located.ok()?.record.pulses().elbow;
    }
    Some(sum)
}
