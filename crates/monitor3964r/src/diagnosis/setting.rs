//! What a side that cannot be read is set to: its STX, DLE and NAK stand alone on the line, and a
//! receiver at another baud rate reads each of them as the same few characters every time.

use core::{fmt, time::Duration};

use super::delay::ALONE;
use crate::monitor::{Character, Side, since};

/// The baud rate of a side over that of the tap.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum BaudRatio {
    /// 1/8.
    Eighth,
    /// 1/4.
    Quarter,
    /// 1/3.
    Third,
    /// 1/2.
    Half,
    /// 2.
    Double,
    /// 2 or more: how many bits the tap has missed cannot be known.
    DoubleOrMore,
}

impl fmt::Display for BaudRatio {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Eighth => "an eighth of",
            Self::Quarter => "a quarter of",
            Self::Third => "a third of",
            Self::Half => "half",
            Self::Double => "twice",
            Self::DoubleOrMore => "at least twice",
        })
    }
}

/// What differs from what the tap is set to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Setting {
    Parity,
    Rate(BaudRatio),
}

/// What a receiver makes of a part of a character.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Read {
    Good(u8),
    /// With a wrong parity or stop bit; a port without marks reads 00h.
    Damaged(u8),
}

use Read::{Damaged as D, Good as G};

/// What one STX, DLE or NAK reads as.
type Word = &'static [Read];

/// What STX, DLE and NAK of each setting read as, with even, odd and no parity; longer words first.
/// At a whole multiple of its rate a receiver looks where two bits meet, and may take either; there
/// two characters without a pause read as one of half their rate.
const SETTINGS: [(Setting, &[Word]); 7] = [
    (
        Setting::Rate(BaudRatio::Eighth),
        &[&[G(0x80), G(0x80), G(0x80), D(0)], &[D(0), D(0)]],
    ),
    (
        Setting::Rate(BaudRatio::Quarter),
        &[&[G(0x80), D(0)], &[D(0x78), D(0x78)], &[D(0), D(0)]],
    ),
    (
        Setting::Rate(BaudRatio::Third),
        &[&[G(0x1C), D(0x1C)], &[D(0), D(0)], &[D(0xE0)]],
    ),
    (
        Setting::Rate(BaudRatio::Half),
        &[
            &[G(0x00), G(0xE0)],
            &[G(0x66), G(0xE0)],
            &[G(0x00), G(0x80)],
            &[G(0x66), G(0x80)],
            &[D(0x18)],
        ],
    ),
    (
        Setting::Rate(BaudRatio::Double),
        &[&[G(0xF1)], &[G(0xF2)], &[G(0xF8)], &[D(0xF0)], &[D(0xFA)]],
    ),
    // After the one of which it is less certain.
    (
        Setting::Rate(BaudRatio::DoubleOrMore),
        &[&[G(0xFD)], &[G(0xFE)], &[D(0xFC)], &[D(0xFF)]],
    ),
    (Setting::Parity, &[&[D(0x02)], &[D(0x10)], &[D(0x15)]]),
];

/// NAK that ends one job, and STX that begins the next: more words than that are data.
const WORDS: usize = 2;

/// So many characters of a side that no other setting makes are no accident.
const TELLING: u32 = 3;

impl Setting {
    /// The setting with which most of what these sides sent begins with STX, DLE or NAK.
    pub(super) fn of(record: &[Character], sides: &[Side]) -> Option<Self> {
        let fits = SETTINGS.map(|(setting, words)| {
            let fits = sides.iter().map(|&side| Fit::of(record, side, words));
            (setting, fits.reduce(Fit::and))
        });
        let sure = fits.into_iter().filter_map(|(setting, fit)| {
            let fit = fit.filter(Fit::is_sure)?;
            Some((setting, fit.hits))
        });
        // Of equals the last.
        let best = sure.max_by_key(|&(_, hits)| hits);
        best.map(|(setting, _)| setting)
    }
}

/// How well a setting explains what a side sent, in pieces between silences.
#[derive(Clone, Copy, Debug)]
struct Fit {
    /// Pieces that begin with a word.
    hits: u32,
    /// Hits made of one word or two, one of which can be nothing else.
    telling: u32,
    /// At least half of all pieces begin so.
    is_majority: bool,
}

impl Fit {
    fn of(record: &[Character], side: Side, words: &[Word]) -> Self {
        let (mut hits, mut telling, mut misses) = (0_u32, 0_u32, 0_u32);
        let mut rest = record.iter().filter(move |heard| heard.side == side);
        while let Some(burst) = Burst::take(&mut rest, words) {
            hits = hits.saturating_add(burst.is_hit.into());
            misses = misses.saturating_add((!burst.is_hit).into());
            telling = telling.saturating_add((burst.is_whole && burst.is_telling).into());
        }
        Self {
            hits,
            telling,
            is_majority: hits >= misses,
        }
    }

    const fn and(self, other: Self) -> Self {
        Self {
            hits: self.hits.saturating_add(other.hits),
            telling: self.telling.saturating_add(other.telling),
            is_majority: self.is_majority && other.is_majority,
        }
    }

    const fn is_sure(&self) -> bool {
        self.is_majority && self.telling >= TELLING
    }
}

/// What one side sent between two silences.
struct Burst {
    /// It begins with a word.
    is_hit: bool,
    /// It is made of one word or two.
    is_whole: bool,
    /// One of the words can be nothing else.
    is_telling: bool,
}

impl Burst {
    /// Takes the next one; `None` at the end.
    fn take<'c>(
        rest: &mut (impl Iterator<Item = &'c Character> + Clone),
        words: &[Word],
    ) -> Option<Self> {
        let mut before = rest.clone().next()?.at;
        let mut burst = Self {
            is_hit: false,
            is_whole: true,
            is_telling: false,
        };
        let mut left = WORDS;
        let goes_on = |before, next: &Character| since(before, next.at) <= ALONE;
        while rest
            .clone()
            .next()
            .is_some_and(|next| goes_on(before, next))
        {
            let mut words = words.iter().filter(|_| burst.is_whole && left > 0);
            let word = words.find_map(|word| Some((word.len(), spells(rest.clone(), word)?)));
            let len = if let Some((len, is_telling)) = word {
                left = left.saturating_sub(1);
                burst.is_hit = true;
                burst.is_telling |= is_telling;
                len
            } else {
                burst.is_whole = false;
                1
            };
            before = rest.nth(len.checked_sub(1)?)?.at;
        }
        Some(burst)
    }
}

/// Whether the characters begin with this word, and if so, whether that proves anything.
fn spells<'c>(mut heard: impl Iterator<Item = &'c Character>, word: Word) -> Option<bool> {
    let mut is_telling = false;
    let mut before: Option<Duration> = None;
    for &read in word {
        let next = heard.next()?;
        if before.is_some_and(|before| since(before, next.at) > ALONE) {
            return None;
        }
        before = Some(next.at);
        is_telling |= read.is_told_by(next)?;
    }
    Some(is_telling)
}

impl Read {
    /// Whether the character is this one, and if so, whether it can be nothing else.
    fn is_told_by(self, heard: &Character) -> Option<bool> {
        match (self, heard.error) {
            (Self::Good(byte), None) | (Self::Damaged(byte), Some(_)) if heard.byte == byte => {
                Some(byte != 0)
            }
            (Self::Damaged(_), None) if heard.byte == 0 => Some(false),
            _ => None,
        }
    }
}
