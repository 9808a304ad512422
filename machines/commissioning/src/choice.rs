//! Which shaper fits the modes that were found.

use core::fmt;

use anyhow::{Context, Result, ensure};
use path_timing::{Impulse, Mode, Shaper, ShaperError};

use crate::Found;

/// Shapers that leave more than this are taken only where none leaves less.
const TOLERANCE: f64 = 0.05;
/// A mode moves by this part of its frequency with the pose and the load.
const BAND: f64 = 0.1;

/// A shaper, what it leaves of the modes, and what it costs.
#[derive(Debug, Clone)]
pub struct Choice {
    name: String,
    shaper: Shaper,
    residual: f64,
    acceleration: f64,
}

type Design = fn(Mode) -> Result<Shaper, ShaperError>;

const DESIGNS: [(&str, Design); 6] = [
    ("ZV", Shaper::zv),
    ("MZV", Shaper::mzv),
    ("ZVD", Shaper::zvd),
    ("EI", Shaper::ei),
    ("2-hump EI", Shaper::two_hump),
    ("3-hump EI", Shaper::three_hump),
];

/// The shaper of a kind for a mode, by the name that a [`Choice`] has; capitals do not matter.
///
/// # Errors
/// Another name, or a mode without a shaper.
pub fn shaper(name: &str, mode: Mode) -> Result<Shaper> {
    let named = DESIGNS
        .iter()
        .find(|(own, _)| own.eq_ignore_ascii_case(name));
    let (_, design) = named.with_context(|| {
        let names = DESIGNS.map(|(own, _)| own).join(", ");
        format!("shaper = {name:?} is none of {names}")
    })?;
    let Mode { hz, damping } = mode;
    design(mode).with_context(|| format!("hz = {hz}, damping = {damping}"))
}

impl Choice {
    /// One of each kind of shaper for the modes of an axis, the best first: of those that leave at
    /// most 5 % of the swing while the frequencies are anywhere within ±10 % the one that smooths
    /// least, in mm at an acceleration in mm/s²; those that leave more come after them. Where there
    /// are two modes or more, shapers for two of them are among it.
    ///
    /// # Errors
    /// No mode, an acceleration that is no number above 0, or modes without a shaper.
    pub fn all(modes: &[Found], acceleration_mm_s2: f64) -> Result<Vec<Self>> {
        let main = modes.first().context("no mode to shape")?;
        ensure!(
            acceleration_mm_s2 > 0.0 && acceleration_mm_s2.is_finite(),
            "acceleration {acceleration_mm_s2} mm/s² is not above 0"
        );
        let of = |name: String, shaper: Shaper| Self {
            name,
            residual: left_of(&shaper, modes),
            shaper,
            acceleration: acceleration_mm_s2,
        };
        let mut all = Vec::new();
        for (name, design) in DESIGNS {
            let mut tried = Vec::new();
            for hz in frequencies(modes) {
                let shaper = design(Mode { hz, ..main.mode })?;
                tried.push(of(format!("{name} at {hz:.1} Hz"), shaper));
            }
            tried.sort_by(Self::order);
            all.extend(tried.into_iter().next());
        }
        if let [first, second, ..] = modes {
            let [a, b] = [first.mode.hz, second.mode.hz];
            let second = Shaper::zv(second.mode)?;
            for (name, design) in DESIGNS.into_iter().take(4) {
                if let Some(shaper) = both(&design(first.mode)?, &second)? {
                    all.push(of(
                        format!("{name} at {a:.1} Hz and ZV at {b:.1} Hz"),
                        shaper,
                    ));
                }
            }
        }
        all.sort_by(Self::order);
        Ok(all)
    }

    /// The shaper.
    #[must_use]
    pub const fn shaper(&self) -> &Shaper {
        &self.shaper
    }

    /// The part of the swing that it leaves at worst.
    #[must_use]
    pub const fn residual(&self) -> f64 {
        self.residual
    }

    /// By how much the tool departs at the acceleration, in mm.
    #[must_use]
    pub fn departure_mm(&self) -> f64 {
        self.shaper.departure(self.acceleration)
    }

    /// Its kind and frequency.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    fn order(&self, other: &Self) -> core::cmp::Ordering {
        let key = |it: &Self| {
            let excess = (it.residual - TOLERANCE).max(0.0);
            (excess, it.departure_mm())
        };
        let ((a, b), (c, d)) = (key(self), key(other));
        a.total_cmp(&c).then(b.total_cmp(&d))
    }
}

/// From below the lowest mode to above the highest, 1 % apart.
fn frequencies(modes: &[Found]) -> impl Iterator<Item = f64> {
    let all = modes.iter().map(|it| it.mode.hz);
    let lowest = all.clone().fold(f64::INFINITY, f64::min) * 0.7;
    let highest = all.fold(0.0, f64::max) * 1.5;
    core::iter::successors(Some(lowest), |hz| Some(hz * 1.01)).take_while(move |hz| *hz <= highest)
}

/// What a shaper leaves of all modes together, each as far as it swings and where it is worst.
fn left_of(shaper: &Shaper, modes: &[Found]) -> f64 {
    let worst = |mode: &Mode| {
        let places = (-10..=10).map(|place| 1.0 + BAND * f64::from(place) / 10.0);
        let left = places.map(|part| {
            shaper.residual(Mode {
                hz: mode.hz * part,
                ..*mode
            })
        });
        left.fold(0.0, f64::max)
    };
    let [left, all] = modes.iter().fold([0.0; 2], |[left, all], it| {
        [left + it.swing() * worst(&it.mode), all + it.swing()]
    });
    left / all
}

/// One after the other; none where there are too many impulses.
fn both(a: &Shaper, b: &Shaper) -> Result<Option<Shaper>> {
    let pairs = a.impulses().iter();
    let pairs = pairs.flat_map(|a| b.impulses().iter().map(move |b| (a, b)));
    let mut impulses: Vec<_> = pairs
        .map(|(a, b)| Impulse {
            time_s: a.time_s + b.time_s,
            amplitude: a.amplitude * b.amplitude,
        })
        .collect();
    impulses.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
    // Two at the same time are one.
    impulses.dedup_by(|next, before| {
        let is_same = next.time_s <= before.time_s;
        if is_same {
            before.amplitude += next.amplitude;
        }
        is_same
    });
    if impulses.len() > Shaper::MAX_IMPULSES {
        return Ok(None);
    }
    Ok(Some(Shaper::from_impulses(&impulses)?))
}

impl fmt::Display for Choice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}: {:.1} % left at worst, departs by {:.3} mm, {:.1} ms longer",
            self.name,
            100.0 * self.residual,
            self.departure_mm(),
            1000.0 * self.shaper.duration_s()
        )
    }
}
