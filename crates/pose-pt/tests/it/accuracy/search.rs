//! A search for the worst case of a figure.

use test_support::{Random, setting};

/// Most numbers that a case is made of.
const NUMBERS: usize = 40;

/// Numbers between 0 and 1 that a case is made of, one after the other.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Draw {
    shares: [f64; NUMBERS],
    next: usize,
}

impl Draw {
    fn new(random: &mut Random) -> Self {
        Self {
            shares: [(); NUMBERS].map(|()| random.share()),
            next: 0,
        }
    }

    /// A case beside this one.
    fn beside(mut self, random: &mut Random) -> Self {
        let size = 10f64.powf(-16.0 * random.share());
        for share in &mut self.shares {
            let moved = *share + size * (2.0 * random.share() - 1.0);
            if (0.0..1.0).contains(&moved) && random.bits().is_multiple_of(2) {
                *share = moved;
            }
        }
        self.next = 0;
        self
    }

    pub(crate) fn within(&mut self, low: f64, high: f64) -> f64 {
        let share = self.shares[self.next];
        self.next += 1;
        low + (high - low) * share
    }

    /// 10^low to 10^high.
    pub(crate) fn size(&mut self, low: f64, high: f64) -> f64 {
        10f64.powf(self.within(low, high))
    }

    pub(crate) fn is_true(&mut self) -> bool {
        self.within(0.0, 1.0) < 0.5
    }
}

/// Half of the cases are new, half beside the worst one. `error` has its result in machine
/// epsilons; `None` for what is no case.
pub(crate) fn search(name: &str, documented: f64, error: impl Fn(&mut Draw) -> Option<f64>) {
    let mut random = Random::new(setting("ACCURACY_SEED", 1));
    let mut worst = (0.0, Draw::new(&mut random));
    for number in 0..setting("ACCURACY_CASES", 20_000) {
        let mut case = if number.is_multiple_of(2) {
            Draw::new(&mut random)
        } else {
            worst.1.beside(&mut random)
        };
        let drawn = case;
        if let Some(error) = error(&mut case).filter(|error| *error > worst.0) {
            worst = (error, drawn);
        }
    }
    println!("{name}: {:.2} machine epsilons", worst.0);
    assert!(worst.0 > 0.2, "{name}: nothing was looked at");
    assert!(
        worst.0 <= documented,
        "{name}: {} at {:?}",
        worst.0,
        worst.1
    );
}
