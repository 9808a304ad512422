//! Rows convolved with the impulses of shapers.

use std::hint::black_box;

use no_panic::no_panic;
use path_timing::{Impulse, Row, Shaped, ShapedError, Shaper};

type Given = Result<Row<[f64; 2]>, u8>;

#[no_panic]
#[inline(never)]
fn shaped<'m, I: Iterator<Item = Given>>(
    rows: I,
    shapers: [Shaper; 2],
    memory: &'m mut [Row<[f64; 2]>],
) -> Shaped<'m, I, [f64; 2]> {
    Shaped::new(rows, shapers, memory)
}

#[no_panic]
#[inline(never)]
fn next_row<I: Iterator<Item = Given>>(
    rows: &mut Shaped<'_, I, [f64; 2]>,
) -> Option<Result<Row<[f64; 2]>, ShapedError<u8>>> {
    rows.next()
}

pub fn run() {
    let impulses = black_box(
        [Impulse {
            time_s: 0.1,
            amplitude: 0.5,
        }; 3],
    );
    let shaper = Shaper::from_impulses(&impulses).unwrap_or(Shaper::none());
    let mut given = black_box([Ok(Row::default()), Err(3)]).into_iter().cycle();
    let rows = core::iter::from_fn(move || black_box(given.next()));
    let mut memory = black_box([Row::default(); 16]);
    let mut shaped = shaped(rows, black_box([shaper; 2]), black_box(&mut memory));
    for _ in 0..black_box(8) {
        black_box(next_row(&mut shaped).is_some());
    }
}
