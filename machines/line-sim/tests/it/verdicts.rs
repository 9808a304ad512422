//! Verdicts on simulated lines: any data and times, either side at fault, one fault or none;
//! captures that begin and end anywhere, and noise on top of the fault.
//!
//! `CASES` lines of each kind from `SEED` on; without them the same few each time. The share of
//! right verdicts:
//! `CASES=400 cargo test --release -p line-sim --test it verdicts::shares -- --ignored --nocapture`.

pub(crate) mod case;
mod kinds;
mod pairs;

use std::env;

use case::{Case, Variation};
use kinds::Example;

/// Seeds of neighbouring cases are far apart.
const STRIDE: u64 = 0x9E37_79B9_7F4A_7C15;

/// Makes a line of a kind.
type Make = fn(Case) -> Example;

fn number(name: &str, usual: u64) -> u64 {
    env::var(name).map_or(usual, |text| text.parse().unwrap())
}

fn seeds() -> impl Iterator<Item = u64> {
    let (first, cases) = (number("SEED", 1), number("CASES", 8));
    (0..cases).map(move |case| first.wrapping_add(case).wrapping_mul(STRIDE))
}

/// Answers that only seem to belong to questions of long before are not late.
#[test]
fn a_bad_receiver_is_no_late_partner() {
    let [.., variation] = Variation::ALL;
    let example = kinds::a_bad_receiver(Case::new(14_727_398_570_297_873_639, variation));
    let found = example.diagnosis();
    assert!((example.is_right)(&found), "{found}");
}

/// The verdicts that are wrong, and those that are right.
fn judge(make: Make, variation: Variation) -> (Vec<String>, usize) {
    let (mut wrong, mut right) = (Vec::new(), 0);
    for seed in seeds() {
        let case = Case::new(seed, variation);
        let example = make(case);
        let found = example.diagnosis();
        // One fault is not told as two.
        if (example.is_right)(&found) && found.also.is_none() && !found.more {
            right += 1;
        } else {
            wrong.push(format!("{case:?}: {found}"));
        }
    }
    (wrong, right)
}

fn check(make: Make) {
    for variation in Variation::ALL {
        let (wrong, _) = judge(make, variation);
        assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
    }
}

macro_rules! kinds {
    ($($name:ident,)*) => {
        $(
            #[test]
            fn $name() {
                check(kinds::$name);
            }
        )*

        const KINDS: &[(&str, Make)] = &[$((stringify!($name), kinds::$name),)*];
    };
}

kinds! {
    nothing_is_wrong,
    noise,
    a_noisy_wire,
    no_parity,
    odd_parity,
    another_rate,
    another_rate_of_the_tap,
    another_parity_of_the_tap,
    an_open_wire,
    both_wires_open,
    a_dead_side,
    a_side_that_dies,
    the_same_priority,
    without_bcc,
    both_without_bcc,
    another_bcc,
    undoubled_dle,
    the_same_damage,
    late_answers,
    late_for_a_short_qvz,
    late_answers_of_3964,
    echo,
    own_echo,
    pauses,
    no_receive_buffer,
    a_bad_receiver,
    a_request_for_an_answer,
}

/// Prints the share of right verdicts of each kind: whole captures, cut ones, noisy ones, both. Of
/// one `KIND`, if that is given, also the wrong ones.
#[test]
#[ignore = "a table to read"]
fn shares() {
    let ratio: (&str, Make) = ("the_ratio_of_a_rate", kinds::the_ratio_of_a_rate);
    let kind = env::var("KIND").ok();
    for (name, make) in KINDS.iter().chain([&ratio]) {
        if kind.as_ref().is_some_and(|kind| kind != name) {
            continue;
        }
        let shares = Variation::ALL.map(|variation| {
            let (wrong, right) = judge(*make, variation);
            if kind.is_some() {
                println!("{}", wrong.join("\n\n"));
            }
            format!("{right:>5} of {:<5}", right + wrong.len())
        });
        println!("{name:<28}{}", shares.join(" "));
    }
}
