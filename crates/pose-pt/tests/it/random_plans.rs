//! Tables of random bodies, paths, limits and units, checked by themselves: each limit by the
//! extremes of the cubics that a controller runs, in 32 digits; the distance error at many
//! places; and nothing but an error where a number is none. `PLANS` makes it longer,
//! `PLANS_SEED` another one:
//!
//! ```sh
//! PLANS=200000 cargo test --release -p pose-pt --test it random_plans:: -- --nocapture
//! ```

mod check;
mod linear;
mod scene;

use core::panic::AssertUnwindSafe;
use std::collections::HashMap;
use std::panic::catch_unwind;

use crate::support::table;
use check::{check_run, check_table};
use linear::check_linear;
use path_timing::{FeedCeiling, Knot};
use pose_pt::{Platform, PosePath};
use scene::{Draw, Scene};
use test_support::{Random, setting};

/// Room of the tables.
const ROOM: usize = 400;

/// Seeds and numbers of plans that broke a promise once: a run that was slower at a higher feed,
/// and segments of no time.
const FOUND: [(u64, u64); 2] = [(2, 2076), (2, 6751)];

/// How many plans came to what.
#[derive(Debug, Default)]
struct Counts {
    planned: u32,
    runs: u32,
    refused: HashMap<String, u32>,
}

/// The first word of an error.
fn kind(error: &impl core::fmt::Debug) -> String {
    let text = format!("{error:?}");
    let end = text.find([' ', '(', '{']).unwrap_or(text.len());
    text[..end].to_owned()
}

impl Counts {
    fn refuse(&mut self, error: &impl core::fmt::Debug) {
        *self.refused.entry(kind(error)).or_default() += 1;
    }
}

/// Plans a PVT table, checks it, and runs it at random feeds.
fn plan(scene: &Scene, draw: &mut Draw, counts: &mut Counts) {
    let platform = match Platform::new(scene.locators) {
        Ok(platform) => platform,
        Err(error) => return counts.refuse(&error),
    };
    let path = match PosePath::new(&scene.poses, scene.kind) {
        Ok(path) => path,
        Err(error) => return counts.refuse(&error),
    };
    let mut knots = vec![Knot::default(); ROOM];
    let table = match table::plan(&platform, &path, scene.cut, &mut knots) {
        // Nothing moves.
        Ok(table) if table.is_empty() => return,
        Ok(table) => table,
        Err(error) => return counts.refuse(&error),
    };
    counts.planned += 1;
    check_table(scene, &platform, &table);
    let scale = if draw.one_in(2) {
        1.0
    } else {
        draw.size(-2.0, 0.0)
    };
    let table = table.at_speed(scale).unwrap();
    let mut ceilings = vec![FeedCeiling::default(); ROOM];
    let max = draw.size(-1.0, 1.0);
    let run = table.playback(max, &mut ceilings).unwrap();
    check_run(&platform, &table, run, max, draw);
    counts.runs += 1;
}

/// Runs all plans; those that break a promise are named by their numbers.
fn each_plan(seed: u64, mut plan: impl FnMut(&Scene, &mut Draw)) {
    let mut broken = Vec::new();
    let new = (0..setting("PLANS", 1000)).map(|number| (seed, number));
    for (seed, number) in FOUND.into_iter().chain(new) {
        let mut draw = Draw::new(Random::new((seed << 32) + number));
        let scene = Scene::new(&mut draw);
        let result = catch_unwind(AssertUnwindSafe(|| plan(&scene, &mut draw)));
        if result.is_err() {
            broken.push((number, scene));
        }
    }
    let numbers: Vec<_> = broken.iter().map(|(number, _)| number).collect();
    let first = broken.first();
    assert!(broken.is_empty(), "plans {numbers:?}: {first:#?}");
}

#[test]
fn every_table_keeps_what_it_promises() {
    let mut counts = Counts::default();
    each_plan(setting("PLANS_SEED", 1), |scene, draw| {
        plan(scene, draw, &mut counts);
    });
    println!("{counts:#?}");
    assert!(counts.planned > 100 && counts.runs > 50);
}

#[test]
fn every_linear_table_keeps_what_it_promises() {
    let mut planned = 0;
    each_plan(setting("PLANS_SEED", 1), |scene, _| {
        planned += u32::from(check_linear(scene));
    });
    println!("planned: {planned}");
    assert!(planned > 100);
}
