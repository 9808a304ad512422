//! Why a line does not work: a verdict over a record of both directions.

mod conduct;
mod delay;
mod echo;
mod evidence;
mod formula;
mod frames;
mod judge;
mod setting;
mod totals;
mod verdict;

use core::fmt;

use proto3964r::Config;

use crate::monitor::{Character, PerSide, Side};

pub use formula::Formula;
pub use setting::BaudRatio;
pub use totals::Totals;
pub use verdict::Verdict;

use delay::{delay_of, patience_of};
use echo::Echo;
use evidence::Evidence;
use judge::{Case, Late};

/// Answers that come later than this number of acknowledgement delay times are none.
const LATEST: u32 = 4;

/// What is to be said of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub struct Diagnosis {
    /// Why the line does not work, or that it does.
    pub verdict: Verdict,
    /// What looks the same in this record; [`Verdict::measurement`] separates the two.
    pub or: Option<Verdict>,
    /// A second fault, which the first does not explain.
    pub also: Option<Verdict>,
    /// What none of these explains goes wrong as well, more often than on a line with one fault
    /// alone: there is another fault, without a name as long as these last.
    pub more: bool,
    /// Telegrams from A to B.
    pub a: Totals,
    /// Telegrams from B to A.
    pub b: Totals,
}

impl fmt::Display for Diagnosis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.verdict)?;
        if let Some(or) = self.or {
            write!(f, "; or {or}")?;
        }
        if let Some(also) = self.also {
            write!(f, "; and {also}")?;
        }
        if self.more {
            f.write_str("; and more")?;
        }
        if let Some(measurement) = self.verdict.measurement() {
            write!(f, "\nto be sure: {measurement}")?;
        }
        write!(f, "\nA to B: {}\nB to A: {}", self.a, self.b)
    }
}

/// How long each side takes, and how long the other waits for it.
fn delays(record: &[Character], config: &Config) -> PerSide<Option<Late>> {
    let mut delays = PerSide::both(None);
    for side in Side::BOTH {
        let measured = patience_of(record, side.other());
        let latest = measured.unwrap_or_default().max(config.qvz());
        delays[side] = delay_of(record, side, latest.saturating_mul(LATEST)).map(|found| {
            let is_overtaken = found.overtaken * 2 >= found.answers;
            Late {
                delay: found.delay,
                is_overtaken,
                qvz: match measured {
                    Some(measured) => measured,
                    None if is_overtaken && !found.waited.is_zero() => found.waited,
                    None if is_overtaken => found.until_again.max(config.qvz()),
                    None => config.qvz(),
                },
            }
        });
    }
    delays
}

/// Tells from what was heard on both directions of a line why it does not work, with totals.
///
/// The record is in the order of time. Times and check that are expected come from a [`Config`];
/// its other settings do not matter. Over a whole capture this is the verdict; over the last
/// minute of a live tap it is the state of the line. It takes no memory of its own, and time that
/// grows with the length of the record.
///
/// # Examples
/// ```
/// use core::time::Duration;
/// use monitor3964r::{Character, Side, Verdict, diagnose};
/// use proto3964r::{Config, Line, Priority};
///
/// let record = [(0, Side::A, 0x02), (3, Side::B, 0x15), (6, Side::A, 0x02), (9, Side::B, 0x15)]
///     .map(|(ms, side, byte)| Character { at: Duration::from_millis(ms), side, byte, error: None });
/// let config = Config::siemens_3964r(Priority::Low, Line::Instant);
/// let diagnosis = diagnose(&record, &config);
/// assert_eq!(diagnosis.verdict, Verdict::NoReceiveBuffer { refuser: Side::B });
/// assert_eq!(diagnosis.verdict.to_string(), "B answers NAK to STX: no receive buffer");
/// ```
#[must_use]
pub fn diagnose(record: &[Character], config: &Config) -> Diagnosis {
    let evidence = Evidence::of(record, config);
    let case = Case {
        record,
        evidence: &evidence,
        echo: Echo::of(record),
        delays: delays(record, config),
        qvz: config.qvz(),
        check: config.check,
    };
    let (verdict, or) = case.verdict();
    let also = case.also(verdict);
    Diagnosis {
        verdict,
        or,
        also,
        more: case.has_more([Some(verdict), or, also]),
        a: Totals::of(&evidence, Side::A),
        b: Totals::of(&evidence, Side::B),
    }
}
