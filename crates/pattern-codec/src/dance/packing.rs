//! Frames to bytes: raw, as runs, and as runs with masks.

/// How frames stand in memory.
///
/// ```text
/// Raw         N speeds, frame after frame
/// Runs        count 1..=255, N speeds: count equal frames
/// MaskedRuns  count 1..=255, mask of ceil(N/8) bytes, the speeds of the set bits in the order of
///             the motors: count equal frames, in which the other motors keep their speed
/// ```
/// Bit k of mask byte j is motor 8 j + k. Before the first frame every motor rests.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "firmware has to know each of them")]
pub enum Packing {
    /// Every frame, N bytes each.
    #[default]
    Raw,
    /// Runs of equal frames, N + 1 bytes each.
    Runs,
    /// Runs of equal frames, only the speeds that change.
    MaskedRuns,
}

impl Packing {
    /// All packings, in the order of their numbers in a header.
    pub const ALL: [Self; 3] = [Self::Raw, Self::Runs, Self::MaskedRuns];

    /// What a person calls it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Raw => "raw",
            Self::Runs => "runs",
            Self::MaskedRuns => "masked runs",
        }
    }

    /// The bytes of frames.
    ///
    /// ```
    /// use pattern_codec::dance::Packing;
    ///
    /// let frames = [[60, -60, 0]; 25];
    /// let runs: Vec<u8> = Packing::Runs.encode(frames).collect();
    /// assert_eq!(runs, [25, 60, 0xC4, 0]);
    /// let masked: Vec<u8> = Packing::MaskedRuns.encode(frames).collect();
    /// assert_eq!(masked, [25, 0b011, 60, 0xC4]);
    /// ```
    pub fn encode<const N: usize, I>(self, frames: I) -> impl Iterator<Item = u8>
    where
        I: IntoIterator<Item = [i8; N]>,
    {
        self.rows(frames).flatten()
    }

    /// The bytes of frames, run by run.
    pub(super) fn rows<const N: usize, I>(self, frames: I) -> Rows<I::IntoIter, N>
    where
        I: IntoIterator<Item = [i8; N]>,
    {
        const { assert!(N > 0 && N < 256, "1..=255 motors") };
        Rows {
            packing: self,
            frames: frames.into_iter(),
            ahead: None,
            before: [0; N],
        }
    }
}

/// The runs of a sequence of frames; single frames where they are stored raw.
#[derive(Debug, Clone)]
pub(super) struct Rows<I, const N: usize> {
    packing: Packing,
    frames: I,
    /// The frame after the last run.
    ahead: Option<[i8; N]>,
    /// The frame of the last run.
    before: [i8; N],
}

impl<I: Iterator<Item = [i8; N]>, const N: usize> Iterator for Rows<I, N> {
    type Item = Row<N>;

    fn next(&mut self) -> Option<Row<N>> {
        let frame = self.ahead.take().or_else(|| self.frames.next())?;
        let mut count = 1_u8;
        if self.packing != Packing::Raw {
            while count < u8::MAX {
                match self.frames.next() {
                    Some(next) if next == frame => count = count.saturating_add(1),
                    other => {
                        self.ahead = other;
                        break;
                    }
                }
            }
        }
        let before = core::mem::replace(&mut self.before, frame);
        Some(Row {
            packing: self.packing,
            count,
            frame,
            before,
            next: match self.packing {
                Packing::Raw => Part::Speed(0),
                Packing::Runs | Packing::MaskedRuns => Part::Count,
            },
        })
    }
}

/// The bytes of one run.
#[derive(Debug, Clone)]
pub(super) struct Row<const N: usize> {
    packing: Packing,
    count: u8,
    frame: [i8; N],
    before: [i8; N],
    next: Part,
}

/// A byte of a run.
#[derive(Debug, Clone, Copy)]
enum Part {
    Count,
    /// The mask of eight motors, from this one on.
    Mask(usize),
    /// The next speed, of this motor or a later one.
    Speed(usize),
}

impl<const N: usize> Row<N> {
    /// Whether motor and speed stand in the run.
    fn changes(&self) -> impl Iterator<Item = (bool, i8)> {
        let all = self.packing != Packing::MaskedRuns;
        let speeds = self.frame.into_iter().zip(self.before);
        speeds.map(move |(speed, before)| (all || speed != before, speed))
    }

    fn mask(&self, from: usize) -> u8 {
        let bits = self.changes().skip(from).take(8).zip(0..);
        bits.fold(0, |mask, ((changed, _), bit)| {
            mask | u8::from(changed).wrapping_shl(bit)
        })
    }
}

impl<const N: usize> Iterator for Row<N> {
    type Item = u8;

    fn next(&mut self) -> Option<u8> {
        match self.next {
            Part::Count => {
                self.next = match self.packing {
                    Packing::MaskedRuns => Part::Mask(0),
                    Packing::Raw | Packing::Runs => Part::Speed(0),
                };
                Some(self.count)
            }
            Part::Mask(from) => {
                let next = from.saturating_add(8);
                self.next = if next < N {
                    Part::Mask(next)
                } else {
                    Part::Speed(0)
                };
                Some(self.mask(from))
            }
            Part::Speed(from) => {
                let mut motors = (0_usize..).zip(self.changes()).skip(from);
                let (motor, (_, speed)) = motors.find(|(_, (changed, _))| *changed)?;
                drop(motors);
                self.next = Part::Speed(motor.saturating_add(1));
                Some(speed.cast_unsigned())
            }
        }
    }
}
