//! All tests of the crate: one program, which is linked once.
#![cfg(test)]

mod extremes;
mod score;
mod turns;

use dancer::{Easing, Law};
use proptest::prelude::*;

const EASINGS: [Easing; 4] = [Easing::Linear, Easing::In, Easing::Out, Easing::Smooth];

fn laws() -> impl Strategy<Value = Law> {
    prop::sample::select(&Law::ALL[..])
}

fn easings() -> impl Strategy<Value = Easing> {
    prop::sample::select(&EASINGS[..])
}
