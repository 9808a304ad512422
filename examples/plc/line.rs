//! The line: it hands bytes from one pseudo-terminal to another, damages some and keeps a log.

use core::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::fs::File;
use std::io::{self, BufWriter, ErrorKind, Read, Write};
use std::sync::Mutex;
use std::time::Instant;

/// One byte in `spacing` to `2 spacing` is damaged: at most one in a block, because two can cancel
/// in the BCC.
pub(crate) struct Noise {
    state: u64,
    spacing: u64,
    ahead: u64,
}

impl Noise {
    pub(crate) fn new(seed: u64, spacing: u64) -> Self {
        let mut noise = Self {
            state: seed | 1,
            spacing,
            ahead: 0,
        };
        noise.ahead = spacing + noise.below(spacing);
        noise
    }

    /// Xorshift: the same damage for the same seed.
    fn below(&mut self, limit: u64) -> u64 {
        self.state ^= self.state << 13;
        self.state ^= self.state >> 7;
        self.state ^= self.state << 17;
        self.state.checked_rem(limit).unwrap_or(0)
    }

    /// What arrives for `byte`, and whether it was damaged.
    fn pass(&mut self, byte: u8, out: &mut Vec<u8>) -> bool {
        if self.spacing == 0 || self.ahead > 0 {
            self.ahead = self.ahead.saturating_sub(1);
            out.push(byte);
            return false;
        }
        self.ahead = self.spacing + self.below(self.spacing);
        match self.below(4) {
            0 => {}
            1 => out.extend([byte, byte]),
            _ => out.push(byte ^ (1 << self.below(8))),
        }
        true
    }
}

/// What both directions share.
pub(crate) struct Tap {
    pub(crate) start: Instant,
    pub(crate) log: Mutex<BufWriter<File>>,
    pub(crate) bytes: AtomicUsize,
    pub(crate) damaged: AtomicUsize,
    pub(crate) closed: AtomicBool,
}

impl Tap {
    pub(crate) fn new(log: File) -> Self {
        Self {
            start: Instant::now(),
            log: Mutex::new(BufWriter::new(log)),
            bytes: AtomicUsize::new(0),
            damaged: AtomicUsize::new(0),
            closed: AtomicBool::new(false),
        }
    }

    /// Carries one direction until the tap is closed.
    pub(crate) fn carry(
        &self,
        mut from: impl Read,
        mut to: impl Write,
        direction: char,
        mut noise: Noise,
    ) -> io::Result<()> {
        let mut buffer = [0; 64];
        while !self.closed.load(Ordering::Relaxed) {
            let count = match from.read(&mut buffer) {
                Ok(count) => count,
                Err(error) if error.kind() == ErrorKind::TimedOut => continue,
                Err(error) => return Err(error),
            };
            let mut out = Vec::new();
            for &byte in buffer.iter().take(count) {
                let damaged = noise.pass(byte, &mut out);
                self.damaged
                    .fetch_add(usize::from(damaged), Ordering::Relaxed);
            }
            self.bytes.fetch_add(count, Ordering::Relaxed);
            to.write_all(&out)?;
            self.note(direction, &out)?;
        }
        Ok(())
    }

    fn note(&self, direction: char, bytes: &[u8]) -> io::Result<()> {
        let time = self.start.elapsed().as_secs_f64();
        let mut log = self.log.lock().map_err(|_| ErrorKind::Other)?;
        write!(log, "{time:.6} {direction}")?;
        for byte in bytes {
            write!(log, " {byte:02X}")?;
        }
        writeln!(log)
    }
}
