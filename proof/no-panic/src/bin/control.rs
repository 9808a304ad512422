//! What must not link.

use std::hint::black_box;

use no_panic::no_panic;

#[no_panic]
#[inline(never)]
fn index_of_unknown_size(bytes: &[u8], index: usize) -> u8 {
    bytes[index]
}

fn main() {
    black_box(index_of_unknown_size(black_box(&[1, 2, 3]), black_box(1)));
}
