//! What only the crate itself can see.

use super::Station;

/// Bytes of a station beside its two buffers.
const OVERHEAD: usize = 96;

#[test]
fn size_is_bounded() {
    assert!(size_of::<Station<0, 0>>() <= OVERHEAD);
    assert!(size_of::<Station<1, 2>>() <= 3 + OVERHEAD);
    assert!(size_of::<Station<64>>() <= 2 * 64 + OVERHEAD);
    assert!(size_of::<Station<250, 17>>() <= 250 + 17 + OVERHEAD);
    assert!(size_of::<Station<4096, 1>>() <= 4096 + 1 + OVERHEAD);
}
