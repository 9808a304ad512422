//! What an open line carries in both directions, and the verdict on it.

use alloc::{collections::VecDeque, sync::Arc};
use core::{
    fmt, mem,
    pin::Pin,
    task::{Context, Poll, ready},
    time::Duration,
};
use std::{
    io,
    sync::{Mutex, MutexGuard, PoisonError},
    time::SystemTime,
};

use monitor3964r::{Character, Diagnosis, Side, Verdict, diagnose};
use proto3964r::{CharacterError, Config, Line, tokio::Damage};
use tokio::{
    io::{AsyncRead, AsyncWrite, ReadBuf},
    time::Instant,
};

use crate::{
    Port,
    capture::{self, PcapngWriter},
};

/// The gateway's side in a verdict; the partner is B.
const GATEWAY: Side = Side::A;
const PARTNER: Side = Side::B;

/// What a verdict looks back on, from the last character.
const RECENT: Duration = Duration::from_secs(60);

/// From one look at a line that works to the next, unless its station counts faults: a look takes
/// as long as many telegrams.
const UNDISTURBED: Duration = Duration::from_secs(900);

/// Characters that are kept, at most: of a telegram of 32 bytes a second the last three minutes.
const KEPT: usize = 8192;

/// Characters that a verdict looks at, at most: some 50 telegrams of 32 bytes.
const JUDGED: usize = 2048;

/// The same at a line that worked and whose station has counted nothing since: what is longer ago
/// was judged, and a fault is looked at again as a whole.
const GLANCED: usize = 512;

/// Listens to one line.
#[derive(Default)]
pub(crate) struct Tap(Mutex<Record>);

#[derive(Default)]
struct Record {
    /// Of the station; `None` before the port is open, and where nobody listens.
    config: Option<Config>,
    /// When the port was opened, since 1970.
    epoch: Duration,
    heard: VecDeque<Character>,
    /// When the last character of the gateway has left.
    busy_until: Duration,
    /// Something came since the last verdict.
    is_news: bool,
    /// When it was looked at for the last time, and worked, and the faults until then.
    worked_at: Option<(Instant, u64)>,
    /// The last verdict that was told, and when.
    told: Option<(Diagnosis, Instant)>,
    /// What verdicts have taken.
    taken: Duration,
}

/// An open port that is listened to.
pub(crate) struct Tapped {
    port: Port,
    tap: Arc<Tap>,
    begin: Instant,
    /// Time of one character on the wire.
    character: Duration,
    /// Whether what passes is kept.
    is_heard: bool,
}

impl Tap {
    /// Begins anew with an open port; without `is_heard` all of it passes by.
    pub(crate) fn listen(self: &Arc<Self>, port: Port, config: Config, is_heard: bool) -> Tapped {
        let mut record = self.record();
        record.config = is_heard.then_some(config);
        let since_1970 = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
        record.epoch = since_1970.unwrap_or_default();
        record.heard.clear();
        record.busy_until = Duration::ZERO;
        record.worked_at = None;
        let ns = match config.line {
            Line::Instant => 0,
            Line::Paced { character_ns } | Line::Buffered { character_ns } => character_ns,
        };
        Tapped {
            port,
            tap: Arc::clone(self),
            begin: Instant::now(),
            character: Duration::from_nanos(ns.into()),
            is_heard,
        }
    }

    /// The verdict, where that is news: of another kind than the last one, or the same with other
    /// numbers a minute later. `faults` is what the station has counted.
    pub(crate) fn news(&self, faults: u64) -> Option<Diagnosis> {
        let start = Instant::now();
        let (config, mut heard) = {
            let mut record = self.record();
            let worked_at = record.worked_at;
            let is_undisturbed = worked_at
                .is_some_and(|(at, before)| at.elapsed() < UNDISTURBED && faults == before);
            if is_undisturbed || !mem::take(&mut record.is_news) {
                return None;
            }
            let is_calm = worked_at.is_some_and(|(_, before)| faults == before);
            let judged = if is_calm { GLANCED } else { JUDGED };
            let skipped = record.heard.len().saturating_sub(judged);
            (
                record.config?,
                Vec::from_iter(record.heard.iter().skip(skipped).copied()),
            )
        };
        // What was written for a slow wire leaves later than what came meanwhile.
        heard.sort_by_key(|heard| heard.at);
        let last = heard.last().map_or(Duration::ZERO, |last| last.at);
        let from = last.saturating_sub(RECENT);
        let begin = heard.partition_point(|heard| heard.at < from);
        let diagnosis = diagnose(heard.get(begin..).unwrap_or_default(), &config);
        let mut record = self.record();
        record.taken += start.elapsed();
        let works = diagnosis.verdict == Verdict::Works;
        record.worked_at = works.then(|| (Instant::now(), faults));
        let is_news = record.told.is_none_or(|(told, at)| {
            let (told, verdict) = (told.verdict, diagnosis.verdict);
            mem::discriminant(&told) != mem::discriminant(&verdict)
                || (told != verdict && at.elapsed() >= RECENT)
        });
        if !is_news {
            return None;
        }
        record.told = Some((diagnosis, Instant::now()));
        Some(diagnosis)
    }

    /// What was heard last, as pcapng with its meaning and a verdict; `None` before the port was
    /// open.
    pub(crate) fn pcapng(&self) -> Option<Vec<u8>> {
        let (config, epoch, mut heard) = {
            let record = self.record();
            let heard = Vec::from_iter(record.heard.iter().copied());
            (record.config?, record.epoch, heard)
        };
        heard.sort_by_key(|heard| heard.at);
        let (mut bytes, mut tap) = (Vec::new(), capture::Tap::new(config));
        let mut file = PcapngWriter::new(&mut bytes, epoch).ok()?;
        for piece in capture::pieces(&heard) {
            let steps = piece.iter().flat_map(|&heard| tap.hear(heard));
            let steps: Vec<_> = steps.collect();
            file.piece(piece, &steps).ok()?;
        }
        let last = heard.last().map_or(Duration::ZERO, |last| last.at);
        file.note(last, &tap.verdict().to_string()).ok()?;
        Some(bytes)
    }

    /// What verdicts have taken, in microseconds.
    pub(crate) fn taken_us(&self) -> u64 {
        u64::try_from(self.record().taken.as_micros()).unwrap_or(u64::MAX)
    }

    /// Whether the last verdict that was told names a fault.
    pub(crate) fn is_fault(&self) -> bool {
        let told = self.record().told;
        told.is_some_and(|(told, _)| told.verdict.is_fault())
    }

    fn record(&self) -> MutexGuard<'_, Record> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Record {
    fn push(&mut self, at: Duration, side: Side, byte: u8, error: Option<CharacterError>) {
        if self.heard.len() >= KEPT {
            self.heard.pop_front();
        }
        self.heard.push_back(Character {
            at,
            side,
            byte,
            error,
        });
        self.is_news = true;
    }
}

impl Tapped {
    fn came(&self, bytes: &[u8], error: Option<CharacterError>) {
        if !self.is_heard {
            return;
        }
        let now = self.begin.elapsed();
        let mut record = self.tap.record();
        for &byte in bytes {
            record.push(now, PARTNER, byte, error);
        }
    }

    fn went(&self, bytes: &[u8]) {
        if !self.is_heard {
            return;
        }
        let now = self.begin.elapsed();
        let mut record = self.tap.record();
        for &byte in bytes {
            let at = record.busy_until.max(now) + self.character;
            record.busy_until = at;
            record.push(at, GATEWAY, byte, None);
        }
    }
}

impl AsyncRead for Tapped {
    fn poll_read(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        let before = buffer.filled().len();
        let read = ready!(Pin::new(&mut self.port).poll_read(context, buffer));
        match &read {
            Ok(()) => self.came(buffer.filled().get(before..).unwrap_or_default(), None),
            Err(error) => match Damage::of(error) {
                Some(Damage::Character { byte, error }) => self.came(&[byte], Some(error)),
                // BREAK.
                Some(_) => self.came(&[0], Some(CharacterError::Framing)),
                None => {}
            },
        }
        Poll::Ready(read)
    }
}

impl AsyncWrite for Tapped {
    fn poll_write(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        let len = ready!(Pin::new(&mut self.port).poll_write(context, bytes))?;
        self.went(bytes.get(..len).unwrap_or_default());
        Poll::Ready(Ok(len))
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.port).poll_flush(context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.port).poll_shutdown(context)
    }
}

impl fmt::Debug for Tapped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.port.fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use proto3964r::Priority;

    use super::*;

    /// A tap that has heard `count` telegrams of 32 bytes, 100 ms from one to the next.
    fn heard(tap: &Tap, count: u32) {
        let mut record = tap.record();
        record.config = Some(Config::siemens_3964r(Priority::Low, Line::Instant));
        for number in 0..count {
            let at = Duration::from_millis(100) * number;
            let ms = |ms| at + Duration::from_millis(ms);
            record.push(ms(0), PARTNER, 0x02, None);
            record.push(ms(1), GATEWAY, 0x10, None);
            for byte in [0x41; 32].into_iter().chain([0x10, 0x03, 0x13]) {
                record.push(ms(40), PARTNER, byte, None);
            }
            record.push(ms(41), GATEWAY, 0x10, None);
        }
    }

    #[test]
    fn a_verdict_is_told_once() {
        let tap = Tap::default();
        assert!(tap.news(0).is_none(), "nothing was heard");
        heard(&tap, 3);
        assert_eq!(tap.news(0).map(|told| told.verdict), Some(Verdict::Works));
        assert!(!tap.is_fault());
        heard(&tap, 3);
        assert!(tap.news(0).is_none(), "it still works");
    }

    #[test]
    fn no_more_is_kept_than_there_is_room_for() {
        let tap = Tap::default();
        heard(&tap, 1000);
        assert_eq!(tap.record().heard.len(), KEPT);
        assert_eq!(tap.news(0).map(|told| told.verdict), Some(Verdict::Works));
    }

    #[test]
    #[ignore = "measures"]
    fn what_a_verdict_takes() {
        const TIMES: u32 = 200;
        let long_ago = Instant::now().checked_sub(UNDISTURBED).unwrap();
        for (kind, worked_at) in [("first", None), ("later", Some((long_ago, 0)))] {
            let (tap, mut taken, mut hearing) = (Tap::default(), Duration::ZERO, Duration::ZERO);
            for _ in 0..TIMES {
                let begin = std::time::Instant::now();
                heard(&tap, 1000);
                hearing += begin.elapsed();
                tap.record().worked_at = worked_at;
                let begin = std::time::Instant::now();
                core::hint::black_box(tap.news(0));
                taken += begin.elapsed();
            }
            println!(
                "a {kind} verdict: {:?}; a telegram heard: {:?}",
                taken / TIMES,
                hearing / TIMES / 1000
            );
        }
    }
}
